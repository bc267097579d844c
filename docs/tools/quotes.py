"""Writes quotes of compiled files and tables of options into the pages, so that they read the same everywhere.

    python3 docs/tools/quotes.py           brings README.md and docs/*.md up to date
    python3 docs/tools/quotes.py --check   names the pages that are not, and exits with 1

Between such a comment and the line <!-- end --> stands what it asks for:

    <!-- [quote: name](../examples/guides/own_problem.cpp) -->   the lines between the two lines "// [name]" of that file
    <!-- [quote](../examples/minimal/main.cpp) -->               the whole file
    <!-- [options: RfpiOptions](../include/surefoot/...) -->     the fields of that struct: name, type, unit, default, meaning
    <!-- [fields: Diagnosis](../include/surefoot/...) -->        the same without defaults
    <!-- [face: diagnose](../include/surefoot/diagnose) -->      the public headers of that area, and how each opens
"""

import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import options_table  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
QUOTE = re.compile(r"^(<!-- \[(quote|options|fields|face)(?:: ([^\]]+))?\]\((?:\.\./)*([^)#]+)\) -->\n)(.*?)^<!-- end -->$", re.M | re.S)
LANGUAGES = {".cpp": "cpp", ".hpp": "cpp", ".c": "c", ".toml": "toml", ".sh": "sh", ".json": "json", ".txt": "cmake"}


class Fault(Exception):
    pass


def quoted(path, name):
    lines = path.read_text(encoding="utf-8").splitlines()
    if name:
        mark = f"// [{name}]"
        at = [i for i, line in enumerate(lines) if line.strip() == mark]
        if len(at) != 2:
            raise Fault(f"{path}: needs two lines '{mark}' around what is quoted, has {len(at)}")
        lines = lines[at[0] + 1 : at[1]]
    lines = [line for line in lines if not re.fullmatch(r"\s*// \[\w+\]", line)]
    indent = min(len(line) - len(line.lstrip()) for line in lines if line.strip())
    return "\n".join(line[indent:] for line in lines).strip("\n")


EFFECT_FACE = ["effect.hpp", "catalogue.hpp", "named_effect.hpp"]  # of diagnose/effects; the other headers there are effects


def opening(path):
    """The first sentence of a header."""
    lines = []
    for line in path.read_text(encoding="utf-8").splitlines():
        if not line.startswith("//"):
            break
        lines.append(line.removeprefix("//").strip())
    words = re.sub(r" \([^()]*\d{4}[^()]*\)", "", " ".join(lines))  # without the source of a method
    sentence = re.match(r"(.*?)[.](\s|$)", words)
    return (sentence[1] if sentence else words).replace("|", "\\|")


def face(folder):
    headers = sorted(folder.glob("*.hpp"))
    if (folder / "effects").is_dir():
        headers += [folder / "effects" / name for name in EFFECT_FACE]
    rows = [f"| `{header.relative_to(ROOT / 'include')}` | {opening(header)} |" for header in headers]
    return "\n".join(["| header | what |", "| --- | --- |", *rows])


def moved(name, target, comment):
    """Where a struct is now, if it has left the header that the page names."""
    declaration = f"\nstruct {name} {{\n"
    if (ROOT / target).is_file() and declaration in (ROOT / target).read_text(encoding="utf-8"):
        return target, comment
    headers = (ROOT / "include").rglob("*.hpp")
    homes = [str(path.relative_to(ROOT)) for path in headers if declaration in path.read_text(encoding="utf-8")]
    return (homes[0], comment.replace(target, homes[0])) if len(homes) == 1 else (target, comment)


def fresh(found):
    comment, what, name, target, _ = found.groups()
    if what in ("options", "fields"):
        target, comment = moved(name, target, comment)
    path = ROOT / target
    if not path.exists():
        raise Fault(f"there is no file {target}, wanted by '{comment.strip()}'")
    if what == "quote":
        text = f"```{LANGUAGES.get(path.suffix, 'text')}\n{quoted(path, name)}\n```"
    elif what == "face":
        text = face(path)
    else:
        text = options_table.markdown(path, name, defaults=what == "options")
    return f"{comment}\n{text}\n\n<!-- end -->"


def main(check):
    stale = 0
    for page in [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]:
        text = page.read_text(encoding="utf-8")
        begun = len(re.findall(r"^<!-- \[(?:quote|options|fields|face)", text, re.M))
        if begun != len(QUOTE.findall(text)):
            raise Fault(f"{page.relative_to(ROOT)}: a quote has no line <!-- end -->, or its comment is not [quote: name](../file)")
        now = QUOTE.sub(fresh, text)
        if now == text:
            continue
        stale += 1
        if check:
            print(f"{page.relative_to(ROOT)} does not quote what is there now: python3 docs/tools/quotes.py", file=sys.stderr)
        else:
            page.write_text(now, encoding="utf-8")
            print(page.relative_to(ROOT))
    return 1 if check and stale else 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:] == ["--check"]))
    except (Fault, options_table.NoSuchStruct) as fault:
        sys.exit(f"quotes.py: {fault}")
