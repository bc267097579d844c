"""Every block of C++ and C in the documentation compiles: those of C++ in one translation unit, each in its own namespace.

check_code.py --cxx COMPILER --cc COMPILER --scratch FOLDER [--have mpi=FOLDER:FOLDER] -- FLAGS...
"""

import argparse
import pathlib
import subprocess
import sys

from blocks import Fault, all_blocks


def unit(blocks):
    """One file, with lines that name the page in messages of the compiler."""
    includes, bodies = [], []
    for number, block in enumerate(blocks):
        body, template = [], block.rule.get("code", "").split("\n")
        in_function = "code" not in block.rule or "@" not in [line.strip() for line in template]
        if in_function:
            template = [*(template if "code" in block.rule else []), "@"]
        for line in template:
            if line.strip() == "@":
                # A template that nobody instantiates: names, types and concepts are checked, the library's bodies are not.
                body += ["template <class = void>", "void block() {"] if in_function else []
                body += [f'#line {block.line} "{block.page}"', *block.text.splitlines()]
                body += ["}"] if in_function else []
            else:
                body.append(line)
        includes += [line for line in body if line.startswith("#include")]
        body = ["" if line.startswith("#include") else line for line in body]
        bodies += [f"namespace block_{number} {{", *body, "}"]
    return "\n".join([*dict.fromkeys(includes), *bodies, ""])


def compile_unit(compiler, flags, blocks, path):
    path.write_text(unit(blocks), encoding="utf-8")
    done = subprocess.run([*compiler, "-fsyntax-only", *flags, str(path)], capture_output=True, text=True)
    if done.returncode:
        print(done.stderr, file=sys.stderr)
    return done.returncode == 0


def main():
    parser = argparse.ArgumentParser()
    for name in ("cxx", "cc", "scratch"):
        parser.add_argument(f"--{name}", required=True)
    parser.add_argument("--have", action="append", default=[], help="NAME=include folders, of packages that blocks need")
    parser.add_argument("flags", nargs="*")
    options = parser.parse_args()
    have = {name: folders for name, _, folders in (entry.partition("=") for entry in options.have)}
    scratch = pathlib.Path(options.scratch)
    scratch.mkdir(parents=True, exist_ok=True)

    blocks = [block for block in all_blocks() if block.language in ("cpp", "c") and not block.quoted]
    lacking = [block for block in blocks if block.rule.get("needs", "") not in {"", *have}]
    for block in lacking:
        print(f"skipped: {block.where} needs {block.rule['needs']}")
    folders = [f"-isystem{folder}" for known in have.values() for folder in known.split(":") if folder]
    taken = [block for block in blocks if block.language == "cpp" and block not in lacking]
    good = compile_unit([options.cxx], ["-std=c++20", *options.flags, *folders], taken, scratch / "blocks.cpp")
    for number, block in enumerate(block for block in blocks if block.language == "c"):
        path = scratch / f"block_{number}.c"
        path.write_text(f'#line {block.line} "{block.page}"\n{block.text}', encoding="utf-8")
        done = subprocess.run([options.cc, "-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", "-fsyntax-only", str(path)])
        good &= done.returncode == 0
    print(f"{len(blocks)} blocks")
    return 0 if good else 1


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Fault as fault:
        sys.exit(str(fault))
