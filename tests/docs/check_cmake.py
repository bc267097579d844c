"""Every block of CMake in the documentation configures a project against the installed package.

check_cmake.py --prefix FOLDER --scratch FOLDER --cmake CMAKE --cxx COMPILER [--have mpi]

The rule "project: NAME" says which target of the block is to be an executable; it is built too, of one line.
"""

import argparse
import pathlib
import shutil
import subprocess
import sys

from blocks import Fault, all_blocks


def main():
    parser = argparse.ArgumentParser()
    for name in ("prefix", "scratch", "cmake", "cxx"):
        parser.add_argument(f"--{name}", required=True)
    parser.add_argument("--have", action="append", default=[], help="NAME or NAME=..., a package that is there")
    options = parser.parse_args()
    have = {entry.partition("=")[0] for entry in options.have}
    good = True
    for number, block in enumerate(block for block in all_blocks() if block.language == "cmake" and "project" in block.rule):
        if not set(block.rule.get("needs", "").split()) <= have:
            print(f"skipped: {block.where} needs {block.rule['needs']}")
            continue
        folder = pathlib.Path(options.scratch) / str(number)
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        name = block.rule["project"]
        head = f"cmake_minimum_required(VERSION 3.25)\nproject({name} LANGUAGES CXX)\nadd_executable({name} main.cpp)\n"
        (folder / "CMakeLists.txt").write_text(head + block.text, encoding="utf-8")
        (folder / "main.cpp").write_text('#include "surefoot/version.hpp"\nint main() {}\n', encoding="utf-8")
        commands = [[options.cmake, "-S", folder, "-B", folder / "build", f"-DCMAKE_PREFIX_PATH={options.prefix}",
                     f"-DCMAKE_CXX_COMPILER={options.cxx}"], [options.cmake, "--build", folder / "build"]]
        for command in commands:
            done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            if done.returncode:
                print(f"{block.where}:\n{done.stdout}", file=sys.stderr)
                good = False
                break
    return 0 if good else 1


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Fault as fault:
        sys.exit(str(fault))
