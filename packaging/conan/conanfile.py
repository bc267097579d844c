"""Conan 2 recipe: conan create packaging/conan installs the checkout that it lies in."""

from pathlib import Path

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, rmdir


class Surefoot(ConanFile):
    name = "surefoot"
    version = "0.1.0"
    license = "MIT"
    description = (
        "Calibrates walks, finds the physics that a simulator leaves out, "
        "and learns policies that run on the robot"
    )
    package_type = "header-library"
    settings = "os", "compiler", "build_type", "arch"
    requires = "eigen/3.4.0"

    def export_sources(self):
        root = Path(self.recipe_folder).parent.parent
        for pattern in ("CMakeLists.txt", "LICENSE", "cmake/*", "include/*"):
            copy(self, pattern, src=root, dst=self.export_sources_folder)

    def layout(self):
        cmake_layout(self)

    def validate(self):
        check_min_cppstd(self, 20)

    def package_id(self):
        self.info.clear()  # the same headers for every compiler

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        for part in ("TESTS", "APPS", "EXAMPLES", "BENCHMARKS", "INSTALL_COMPILED"):
            toolchain.cache_variables[f"SUREFOOT_{part}"] = False
        toolchain.generate()

    def build(self):
        CMake(self).configure()

    def package(self):
        CMake(self).install()
        rmdir(self, Path(self.package_folder) / "share")  # Conan writes package files of its own
        copy(self, "LICENSE", src=self.source_folder, dst=Path(self.package_folder) / "licenses")

    def package_info(self):
        self.cpp_info.set_property("cmake_file_name", "surefoot")
        self.cpp_info.set_property("cmake_target_name", "surefoot::surefoot")
        self.cpp_info.set_property("pkg_config_name", "surefoot")
        self.cpp_info.bindirs = []
        self.cpp_info.libdirs = []
        if self.settings.os in ("Linux", "FreeBSD"):
            self.cpp_info.system_libs = ["pthread"]
