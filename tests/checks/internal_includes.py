"""Programs use the public face of the library alone: internal_includes.py REPOSITORY

Looks at apps/, examples/ and benchmarks/, but for those listed below, for headers that lie in a room (any folder below
that of an area) and for what the library declares in its internal namespaces.
"""
import re
import sys
from pathlib import Path

from cpp_source import declarations, finish, headers, tokens
from layers import includes, is_face, room_of

PROGRAMS = ["apps", "examples", "benchmarks"]
EXCEPT = ["benchmarks/blind/all_at_once/",  # what effects find without the search is made of what the search is made of
          "benchmarks/forest/descent_benchmark.cpp"]  # two ways down a tree, between which no program chooses
INTERNAL = re.compile("surefoot::(.*::)?(detail|diagnosis)")
NAMED = re.compile(r"(?<![\w:])(?:namespace \w+=|namespace )?(surefoot::)?((?:\w+::)*(?:detail|diagnosis))(?:::(\w+))?(?!\w)")


def sources(root):
    for folder in PROGRAMS:
        for path in sorted((Path(root) / folder).rglob("*")):
            name = path.relative_to(root).as_posix()
            if path.suffix in (".cpp", ".hpp", ".ipp", ".h") and not any(name.startswith(part) for part in EXCEPT):
                yield name, path.read_text()


def internal_names(root):
    return {declaration.name for text in headers(root).values() for declaration in declarations(text)
            if INTERNAL.match(declaration.namespace) and not declaration.inside}


def code_lines(text):
    """(line, its code without comments and blanks but those between words)"""
    lines = {}
    for token in tokens(text):
        if token.kind in ("word", "sign"):
            before = lines.get(token.line, "")
            gap = " " if token.kind == "word" and re.search(r"\w$", before) else ""
            lines[token.line] = before + gap + token.text
    return lines.items()


def check(root):
    internal, faults = internal_names(root), []
    for name, text in sources(root):
        for _, target, line in includes(text):
            if target.startswith("surefoot/") and (target.endswith(".ipp") or (room_of(target) and not is_face(target))):
                faults.append(f"{name}:{line}: includes {target}, which is internal")
        for line, code in code_lines(text):
            for match in NAMED.finditer(code):
                whole = match.group()
                # Without surefoot:: it may be a program's own detail: not if the library declares that name there.
                if (match.group(1) and (match.group(3) or "namespace" in whole)) or match.group(3) in internal:
                    faults.append(f"{name}:{line}: names {whole}, which is internal")
    return faults


if __name__ == "__main__":
    finish("internal_includes", check(sys.argv[1]), "no program uses anything internal")
