"""A program ends well and prints what the documentation shows of it: check_printed.py PROGRAM

Blocks of text with the rule "prints: NAME" are held against the program of that name, line by line; "..." stands for
any number of lines.
"""

import pathlib
import re
import subprocess
import sys

from blocks import Fault, all_blocks


def main(program):
    done = subprocess.run([program], stdout=subprocess.PIPE, text=True)
    print(done.stdout)
    if done.returncode:
        return done.returncode
    shown = [block for block in all_blocks() if block.rule.get("prints") == pathlib.Path(program).name]
    for block in shown:
        lines = [".*" if line.strip() == "..." else re.escape(line) for line in block.text.splitlines()]
        pattern = "\n".join(lines).replace(".*\n", "(?:.*\n)*")
        if not re.search("^" + pattern + "$", done.stdout, re.M):
            print(f"{block.where}: the program prints something else", file=sys.stderr)
            return 1
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1]))
    except Fault as fault:
        sys.exit(str(fault))
