"""One word per meaning, the field's own: words.py REPOSITORY

Looks for the words of words.toml in public names (all of include/ that is not in an internal namespace, headers of the
face, options of the programs) and in plain text (comments, strings, pages).
"""
import re
import sys
import tomllib
from pathlib import Path

from cpp_source import declarations, finish, headers, tokens
from layers import area_of, is_face

TEXT_FOLDERS = ["include", "apps", "examples", "benchmarks"]
PAGES = ["README.md", "docs/*.md", "examples/**/*.md", "apps/**/*.md", "benchmarks/**/*.md"]
OPTION = re.compile(r"(?<![\w-])--([a-z][a-z0-9-]+)")
INTERNAL = re.compile("(^|::)(detail|diagnosis)(::|$)")


def parts(name):
    return [part.lower() for part in re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+", name)]


def has_word(name, word):
    """Whether the parts of `word` stand side by side among those of `name`."""
    return ("_" + word + "_") in ("_" + "_".join(parts(name)) + "_")


def allowed(entry, name, full_name):
    exceptions = entry.get("except", {})
    if name in exceptions or full_name in exceptions:
        return True
    # held_out lets held_out_rms pass: the exception is itself a run of parts, and the word stands nowhere else.
    rest = "_".join(parts(name))
    for exception in exceptions:
        if "::" not in exception:
            rest = re.sub(rf"(?<![a-z]){'_'.join(parts(exception))}(?![a-z])", "", rest)
    return not any(has_word(rest, word) for word in entry["words"])


def public_names(root):
    """(file, line, area, name, full name)"""
    for header, text in headers(root).items():
        if not area_of(header) or "/detail/" in header or header.endswith(".ipp"):
            continue
        if is_face(header):
            yield f"include/{header}", 1, area_of(header), Path(header).stem, Path(header).stem
        for declaration in declarations(text):
            if INTERNAL.search(declaration.namespace) or not declaration.public:
                continue
            full = f"{declaration.inside}::{declaration.name}" if declaration.inside else declaration.name
            yield f"include/{header}", declaration.first_line, area_of(header), declaration.name, full
            for parameter in declaration.parameters:
                yield f"include/{header}", parameter.line, area_of(header), parameter.text, parameter.text
    for path in sorted((Path(root) / "apps").rglob("*.?pp")):
        name = path.relative_to(root).as_posix()
        for token in tokens(path.read_text()):
            if token.kind == "string":
                for option in OPTION.findall(token.text):
                    yield name, token.line, path.parent.relative_to(root).as_posix(), option.replace("-", "_"), "--" + option


def name_faults(root, entries):
    faults = []
    for file, line, area, name, full in public_names(root):
        for entry in entries:
            if "areas" in entry and area not in entry["areas"]:
                continue
            found = [word for word in entry["words"] if has_word(name, word)]
            if found and not allowed(entry, name, full):
                faults.append(f"{file}:{line}: the name {full} says '{found[0]}', not: {entry['instead']}")
    return faults


def plain_text(root):
    """(file, line, text) of comments, strings and pages"""
    for folder in TEXT_FOLDERS:
        for path in sorted((Path(root) / folder).rglob("*.?pp")):
            for token in tokens(path.read_text()):
                if token.kind in ("comment", "string"):
                    for offset, line in enumerate(token.text.split("\n")):
                        yield path.relative_to(root).as_posix(), token.line + offset, line
    for pattern in PAGES:
        for path in sorted(Path(root).glob(pattern)):
            for number, line in enumerate(path.read_text().split("\n"), 1):
                yield path.relative_to(root).as_posix(), number, line


def text_faults(root, entries):
    compiled = [(re.compile(entry["pattern"], re.IGNORECASE), entry) for entry in entries]
    return [f"{file}:{line}: says '{match.group()}', not: {entry['instead']}"
            for file, line, text in plain_text(root)
            for pattern, entry in compiled if (match := pattern.search(text))]


def check(root):
    words = tomllib.loads((Path(__file__).parent / "words.toml").read_text())
    return name_faults(root, words["name"]) + text_faults(root, words["text"])


if __name__ == "__main__":
    finish("words", check(sys.argv[1]), "no private dialect")
