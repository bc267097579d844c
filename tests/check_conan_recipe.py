"""Runs packaging/conan/conanfile.py with stand-ins for what it takes from Conan, and looks at the package it makes.

check_conan_recipe.py FOLDER_OF_RECIPE SCRATCH_FOLDER. What Conan itself checks beyond that is not tested.
"""

import fnmatch
import importlib.util
import shutil
import subprocess
import sys
import types
from pathlib import Path
from types import SimpleNamespace

recipe_folder, scratch = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
shutil.rmtree(scratch, ignore_errors=True)


def copy(recipe, pattern, src, dst):
    found = [f for f in Path(src).rglob("*") if f.is_file() and fnmatch.fnmatch(f.relative_to(src).as_posix(), pattern)]
    assert found, f"the recipe copies {pattern}, but {src} has no such file"
    for file in found:
        target = Path(dst) / file.relative_to(src)
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(file, target)


class CMakeToolchain:
    def __init__(self, recipe):
        recipe.cache_variables = self.cache_variables = {}

    def generate(self):
        pass


class CMake:
    def __init__(self, recipe):
        self.recipe = recipe

    def configure(self):
        options = [f"-D{name}={value}" for name, value in self.recipe.cache_variables.items()]
        folders = ["-S", self.recipe.source_folder, "-B", self.recipe.build_folder]
        subprocess.run(["cmake", *folders, *options], check=True)

    def install(self):
        prefix = ["--prefix", self.recipe.package_folder]
        subprocess.run(["cmake", "--install", self.recipe.build_folder, *prefix], check=True, stdout=subprocess.DEVNULL)


def stand_in(name, **members):
    module = types.ModuleType(name)
    vars(module).update(members)
    sys.modules[name] = module


stand_in("conan", ConanFile=object)
stand_in("conan.tools")
stand_in("conan.tools.build", check_min_cppstd=lambda recipe, least: None)
stand_in("conan.tools.cmake", CMake=CMake, CMakeToolchain=CMakeToolchain, cmake_layout=lambda recipe: None,
         CMakeDeps=lambda recipe: SimpleNamespace(generate=lambda: None))
stand_in("conan.tools.files", copy=copy, rmdir=lambda recipe, folder: shutil.rmtree(folder))

sys.dont_write_bytecode = True
spec = importlib.util.spec_from_file_location("conanfile", recipe_folder / "conanfile.py")
module = importlib.util.module_from_spec(spec)
spec.loader.exec_module(module)

recipe = module.Surefoot()
recipe.recipe_folder = recipe_folder
recipe.export_sources_folder = recipe.source_folder = scratch / "source"
recipe.build_folder, recipe.package_folder = scratch / "build", scratch / "package"
recipe.settings = SimpleNamespace(os="Linux")
recipe.info = SimpleNamespace(clear=lambda: None)
recipe.cpp_info = SimpleNamespace(set_property=lambda name, value: None)
for step in ("export_sources", "layout", "validate", "generate", "build", "package", "package_id", "package_info"):
    getattr(recipe, step)()

packed = sorted(f.relative_to(recipe.package_folder).as_posix() for f in recipe.package_folder.rglob("*") if f.is_file())
repository = recipe_folder.parent.parent
wanted = sorted(f.relative_to(repository).as_posix() for f in (repository / "include").rglob("*.[hi]pp")) + ["licenses/LICENSE"]
assert packed == wanted, f"packed but not wanted, or the other way round: {set(packed) ^ set(wanted)}"
print(f"{recipe.name} {recipe.version}: {len(packed)} files")
