"""The fenced blocks of the documentation, each with the rule by which a test tries it.

A block is quoted from a compiled file (docs/tools/quotes.py), or its rule stands in a comment right above it, as one
line or as several:

    <!-- test: quick: s/--budget 180/--budget 1/ -->

    <!-- test
    first: surefoot-calibrate simulate --final-only --out walks.csv
    quick: s/--sequences 60/--sequences 5/
    -->

| language | without a comment | keys |
| --- | --- | --- |
| sh | run in a scratch folder that looks like the repository; all blocks of a page share one | quick, first, then, needs, tries, by |
| cpp, c | compiled as the body of a function | code (the lines after it; "@" is where the block goes), needs |
| toml, json, csv, text | not allowed | file (written to that name beside the shell blocks), then (a command that reads it); or prints |
| cmake | not allowed | project (configured against the installed package), by |

quick: s/OLD/NEW/, what the test shortens; first, then: commands before and after; needs: programs or packages without
which the block is skipped; tries: how often it may be run, for programs that keep time with each other on a computer that
stalls now and then; by: CTest cases that run the same, or a workflow of CI that has each line as a step;
prints: the program whose output this is ("..." stands for lines left out).
"""

import dataclasses
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]
FENCE = re.compile(r"^( *)```(\w*)\n(.*?)^\1```$", re.M | re.S)
RULE = re.compile(r"<!-- test(?::(?P<line>.*?)|\n(?P<lines>.*?))-->\s*\Z", re.S)
QUOTE = re.compile(r"<!-- \[quote(?:: [^\]]+)?\]\((?:\.\./)*(?P<file>[^)#]+)\) -->\s*\Z")
SEVERAL = ("quick", "first", "then")
KEYS = {
    "sh": {"quick", "first", "then", "needs", "tries", "by"},
    "cpp": {"code", "needs"},
    "c": {"code"},
    "cmake": {"project", "by", "needs"},
    "toml": {"file", "then", "needs"},
    "json": {"file", "then", "needs"},
    "csv": {"file", "then", "needs"},
    "text": {"file", "then", "prints", "needs"},
}


class Fault(Exception):
    pass


@dataclasses.dataclass
class Block:
    page: str  # path in the repository
    line: int  # of its first line
    language: str
    text: str
    quoted: str = ""  # the file it is quoted from
    rule: dict = dataclasses.field(default_factory=dict)

    @property
    def where(self):
        return f"{self.page}:{self.line}"


def pages():
    """README.md, the pages of docs/, and every README.md of a folder."""
    found = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")), ROOT / "CHANGELOG.md"]
    for folder in ("apps", "benchmarks", "examples", "packaging", "tests"):
        found += sorted((ROOT / folder).rglob("README.md"))
    return found


def rule_of(text, language, where):
    rule = {}
    lines = text.strip("\n").split("\n")
    for i, line in enumerate(lines):
        key, colon, value = line.strip().partition(":")
        if not colon or key not in KEYS.get(language, ()):
            raise Fault(f"{where}: the rule '{line.strip()}' is none of a {language} block ({', '.join(sorted(KEYS.get(language, ())))})")
        if key == "code":
            rule[key] = "\n".join([value.strip(), *lines[i + 1 :]]).strip("\n")
            break
        if key in SEVERAL:
            rule.setdefault(key, []).append(value.strip())
        else:
            rule[key] = value.strip()
    return rule


def blocks_of(path):
    page = str(path.relative_to(ROOT))
    text = path.read_text(encoding="utf-8")
    for found in FENCE.finditer(text):
        indent, language, body = found.groups()
        line = text.count("\n", 0, found.start()) + 2
        block = Block(page, line, language, re.sub(f"^{indent}", "", body, flags=re.M))
        above = text[: found.start()].rstrip()
        quote = QUOTE.search(above[above.rfind("<!--") :]) if "<!--" in above else None
        rule = RULE.search(above[above.rfind("<!-- test") :]) if "<!-- test" in above else None
        if quote:
            block.quoted = quote["file"]
        elif rule:
            block.rule = rule_of(rule["line"] or rule["lines"], language, block.where)
        yield block


def all_blocks():
    return [block for path in pages() for block in blocks_of(path)]
