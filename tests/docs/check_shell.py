"""Every shell block of the documentation runs, in a scratch folder that looks like the repository after a build.

check_shell.py --bin FOLDER --scratch FOLDER [--page README.md ... | --but README.md ...]

Blocks of a page run one after the other and share a folder; build/release/bin holds the programs that the tests built.
Files (toml, csv, json) are written as they stand, for the commands to read. Of every command, run or not, each --option
must be in its --help. A block that needs what was not built is skipped and says so.
"""

import argparse
import contextlib
import functools
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile

from blocks import ROOT, Fault, all_blocks

SECONDS = 150  # for one block
SHOWN = 25  # last lines of a block that fails


def make_folder(folder, programs):
    """What a reader has in front of them: the sources, and programs in build/release/bin."""
    shutil.rmtree(folder, ignore_errors=True)
    (folder / "build/release/bin").mkdir(parents=True)
    for entry in ROOT.iterdir():
        if entry.name not in ("build", "results", ".git"):
            (folder / entry.name).symlink_to(entry)
    for program in programs.iterdir():
        if program.is_file():
            (folder / "build/release/bin" / program.name).symlink_to(program)


def quick(block):
    text = block.text
    for edit in block.rule.get("quick", []):
        parts = edit[2:].split(edit[1]) if edit[:1] == "s" else []
        if len(parts) != 3 or parts[2] or parts[0] not in text:
            raise Fault(f"{block.where}: '{edit}' changes nothing; wanted is s/OLD/NEW/ with OLD as it stands in the block")
        text = text.replace(parts[0], parts[1])
    return text


def script_of(block):
    rule = block.rule
    text = ""
    if "file" in rule:
        text = f"mkdir -p \"$(dirname {rule['file']})\"\ncat > {rule['file']} <<'END_OF_BLOCK'\n{block.text}END_OF_BLOCK\n"
    elif block.language == "sh" and "by" not in rule:
        text = quick(block)
    return "\n".join([*rule.get("first", []), text, *rule.get("then", [])])


def missing(block, programs):
    return [name for name in block.rule.get("needs", "").split() if not (programs / name).exists()]


def run(block, folder):
    environment = dict(os.environ, PATH=f"{folder}/build/release/bin:{os.environ['PATH']}")
    environment.setdefault("SUREFOOT_RECORDINGS", str(folder / "recordings"))
    with tempfile.TemporaryFile("w+") as told:  # not a pipe: what a block leaves running would hold it open
        process = subprocess.Popen(["bash", "-euo", "pipefail", "-c", script_of(block)], cwd=folder, env=environment,
                                   stdin=subprocess.DEVNULL, stdout=told, stderr=subprocess.STDOUT,
                                   start_new_session=True)
        late = ""
        try:
            process.wait(timeout=SECONDS)
        except subprocess.TimeoutExpired:
            late = f"took more than {SECONDS} s"
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        failed = late or (f"exit code {process.returncode}" if process.wait() else "")
        told.seek(0)
        return failed and failed + ":\n" + "\n".join(told.read().splitlines()[-SHOWN:])


def attempt(block, folder):
    """Runs it as often as its rule allows until it succeeds; what is wrong with the last run."""
    for _ in range(int(block.rule.get("tries", 1))):
        before = os.times()
        fault = run(block, folder)
        after = os.times()
        cpu_s = after.children_user - before.children_user
        print(f"{after.elapsed - before.elapsed:6.1f} s {cpu_s:6.1f} CPU s  {block.where}{' failed' if fault else ''}", flush=True)
        if not fault:
            break
    return fault


@functools.cache
def help_of(*command):
    done = subprocess.run([*command, "--help"], capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=20)
    return done.stdout + done.stderr


def wrong_options(block, folder):
    """Of every command of a program or script of ours: options that its --help or its text does not know."""
    for line in block.text.replace("\\\n", " ").splitlines():
        words = line.split(" #")[0].split()
        if not words:
            continue
        name = words[0].removeprefix("./")
        program, script = folder / "build/release/bin" / pathlib.Path(name).name, folder / name
        options = [word.split("=")[0] for word in words[1:] if word.startswith("--")]
        if script.suffix == ".sh":
            known = script.read_text(encoding="utf-8") if script.is_file() else ""
            if not os.access(script, os.X_OK):
                yield f"there is no script {name}"
        elif program.exists() and options:
            subcommand = words[1:2] if re.fullmatch(r"[a-z][a-z0-9]*", words[1]) else []
            known = help_of(str(program), *subcommand)
        else:
            continue
        for option in options:
            if not re.search(re.escape(option) + r"(?![\w-])", known):
                yield f"{name} has no option {option}"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--bin", required=True)
    parser.add_argument("--scratch", required=True)
    parser.add_argument("--page", action="append", help="only these pages")
    parser.add_argument("--but", action="append", default=[], help="all pages but these")
    options = parser.parse_args()
    programs, scratch = pathlib.Path(options.bin).resolve(), pathlib.Path(options.scratch).resolve()
    faults, count, page, folder = [], 0, None, None
    for block in all_blocks():
        if block.quoted or block.language in ("cpp", "c", "cmake") or "prints" in block.rule:
            continue
        if (options.page and block.page not in options.page) or block.page in options.but:
            continue
        if block.page != page:
            page, folder = block.page, scratch / block.page.replace("/", "_")
            make_folder(folder, programs)
        if block.language == "sh":
            faults += [f"{block.where}: {fault}" for fault in wrong_options(block, folder)]
        if missing(block, programs):
            print(f"skipped: {block.where} needs {', '.join(missing(block, programs))}")
            continue
        if script_of(block).strip():
            count += 1
            fault = attempt(block, folder)
            if fault:
                faults.append(f"{block.where}: {fault}")
    print(f"{count} blocks run")
    if count == 0:
        raise Fault("no block was run: is the page spelt right?")
    print("\n".join(faults), file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Fault as fault:
        sys.exit(str(fault))
