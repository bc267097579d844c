"""Every block of the documentation has a rule, what it is quoted from is compiled, and what runs it exists, as do all
files that pages name.

check_rules.py --build FOLDER [--compile-commands FILE]
"""

import argparse
import json
import pathlib
import re
import subprocess
import sys

from blocks import KEYS, ROOT, Fault, all_blocks, pages


def ctest_cases(build):
    listed = subprocess.run(["ctest", "--test-dir", build, "-N"], capture_output=True, text=True, check=True).stdout
    return set(re.findall(r"^\s*Test\s+#\d+: (\S+)", listed, re.M))


def compiled_files(path):
    if not path or not pathlib.Path(path).is_file():
        return None
    commands = json.loads(pathlib.Path(path).read_text(encoding="utf-8"))
    return {str(pathlib.Path(command["file"]).resolve()) for command in commands}


def commands_of(block):
    lines = (line.split(" #")[0].strip().removeprefix("./") for line in block.text.splitlines())
    return [line for line in lines if line]


def compiled_by_pages(blocks):
    """Files that commands of the pages compile."""
    return {word for block in blocks if block.language == "sh" for word in block.text.split() if word.endswith(".cpp")}


def faults_of(block, cases, compiled):
    if block.quoted:
        path = ROOT / block.quoted
        if f"outside_{path.parent.name}" in cases:
            return
        if compiled is not None and path.suffix == ".cpp" and str(path.resolve()) not in compiled:
            yield f"{block.where}: quotes {block.quoted}, which nothing compiles"
        return
    if block.language not in KEYS:
        yield f"{block.where}: no test knows blocks of '{block.language}' (tests/docs/blocks.py has those it knows)"
    elif block.language not in ("sh", "cpp", "c") and not block.rule:
        yield f"{block.where}: a block of {block.language} needs a comment <!-- test: ... --> above it (tests/docs/blocks.py)"
    for name in filter(None, re.split(r",\s*", block.rule.get("by", ""))):
        if "/" in name:
            text = (ROOT / name).read_text(encoding="utf-8") if (ROOT / name).is_file() else ""
            for command in commands_of(block):
                if not re.search(r"\brun: " + re.escape(command) + "$", text, re.M):
                    yield f"{block.where}: {name} has no line 'run: {command}'"
        elif not name.endswith("?") and name not in cases:
            yield f"{block.where}: there is no CTest case {name}"


def lost_paths():
    """Headers and files of ours that pages name and that are not there."""
    for path in pages():
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            for name in re.findall(r"`((?:surefoot|apps|examples|benchmarks|tests|docs|cmake)/[\w./-]+\.\w+)`", line):
                placeholder = pathlib.Path(name).stem in ("AREA", "NAME")
                if not placeholder and not (ROOT / name).exists() and not (ROOT / "include" / name).exists():
                    yield f"{path.relative_to(ROOT)}:{number}: there is no {name}"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", required=True)
    parser.add_argument("--compile-commands")
    options = parser.parse_args()
    blocks = all_blocks()
    cases, compiled = ctest_cases(options.build), compiled_files(options.compile_commands)
    if compiled is not None:
        compiled |= {str((ROOT / name).resolve()) for name in compiled_by_pages(blocks)}
    faults = [fault for block in blocks for fault in faults_of(block, cases, compiled)] + list(lost_paths())
    counts = {language: sum(block.language == language for block in blocks) for language in KEYS}
    print(", ".join(f"{count} {language}" for language, count in counts.items()))
    print("\n".join(faults), file=sys.stderr)
    return 1 if faults or not blocks else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Fault as fault:
        sys.exit(str(fault))
