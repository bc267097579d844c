"""The fields of a struct of options as a Markdown table, read from its header.

It reads what the headers of this library look like: one field per line, its comment behind it or above it, a comment
above several fields that have their own as a heading, units in brackets.
"""

import re

FIELD = re.compile(r"^  (?P<type>[\w:<>, \[\]()&]+?) (?P<name>\w+)(?: = (?P<value>.+?)|(?P<braces>\{.*\}))?;\s*(?:// (?P<comment>.*))?$")
SEVERAL = re.compile(r"^  (?P<type>[\w:]+(?:<[\w:<>, ]+>)?) (?P<names>\w+(?: = [^,;{]+)?(?:, \w+(?: = [^,;{]+)?)+);\s*(?:// (?P<comment>.*))?$")
UNIT = re.compile(r"(?<!\w)\[([^\]+()]+)\]")
UNIT_BY_NAME = {"seconds": "s", "ns": "ns", "nanoseconds": "ns", "bytes": "byte"}


class NoSuchStruct(Exception):
    pass


def body_of(text, name):
    found = re.search(rf"^struct {name} \{{\n(.*?)^\}};", text, re.M | re.S)
    if not found:
        raise NoSuchStruct(f"there is no struct {name} that its own lines close")
    return found.group(1).split("\n")


def joined(lines):
    """Statements that were wrapped stand on one line again; functions are left out."""
    result = []
    i = 0
    while i < len(lines):
        line = lines[i]
        while line.strip() and not line.lstrip().startswith("//") and not re.search(r"[;{]\s*(//.*)?$", line):
            if re.search(r",\s*//", line) or i + 1 >= len(lines):
                break
            i += 1
            line += " " + lines[i].strip()
        if re.search(r"\) (const )?\{$", line):
            while i < len(lines) and lines[i] != "  }":
                i += 1
        elif not re.search(r"\) const \{.*\}$", line):
            result.append(line)
        i += 1
    return result


def fields(path, name):
    """[(heading or None, type, name, default, comment)]"""
    result = []
    above = []
    for line in joined(body_of(path.read_text(encoding="utf-8"), name)):
        if not line.strip():
            above = []
            continue
        comment = re.match(r"^(\s*)///? ?(.*)$", line)
        if comment:
            if len(comment.group(1)) > 4 and result:  # goes on behind the field above
                result[-1][4] += " " + comment.group(2)
            else:
                above.append(comment.group(2))
            continue
        several = SEVERAL.match(line)
        if several:
            for one in several["names"].split(", "):
                name, _, value = one.partition(" = ")
                result.append([None, several["type"], name, value, several["comment"] or " ".join(above)])
            above = []
            continue
        field = FIELD.match(line)
        if not field or field["type"].split()[0] in ("using", "static", "enum", "struct", "return"):
            above = []
            continue
        value = field["value"] or field["braces"] or ""
        text = field["comment"] or ""
        heading = " ".join(above) if above and text else None
        result.append([heading, field["type"], field["name"], value, text or " ".join(above)])
        above = []
    return result


def unit_and_meaning(name, comment):
    units = UNIT.findall(comment)
    unit = units[0] if len(units) == 1 else UNIT_BY_NAME.get(name.split("_")[-1], "") if not units else ", ".join(units)
    return unit, re.sub(r"\s+([,;.])", r"\1", " ".join(UNIT.sub("", comment).split())).lstrip(",; ")


def cell(text):
    return text.replace("|", "\\|").replace("<", "&lt;")


def code(text):
    return f"`{text}`" if text else ""


def markdown(path, name, defaults=True):
    rows = ["| field | type | unit | " + ("default | " if defaults else "") + "meaning |",
            "| --- | --- | --- | " + ("--- | " if defaults else "") + "--- |"]
    for heading, kind, field, value, comment in fields(path, name):
        if heading:
            rows.append(f"| *{cell(heading)}* | | | " + ("| " if defaults else "") + "|")
        unit, meaning = unit_and_meaning(field, comment)
        value = re.sub(r"std::numeric_limits<double>::infinity\(\)", "infinity", value)
        value = re.sub(r"std::numeric_limits<double>::quiet_NaN\(\)", "NaN", value)
        middle = f"{code(value)} | " if defaults else ""
        rows.append(f"| `{field}` | {code(kind)} | {cell(unit)} | {middle}{cell(meaning)} |")
    if len(rows) == 2:
        raise NoSuchStruct(f"{path}: struct {name} has no field that could be read")
    return "\n".join(rows)
