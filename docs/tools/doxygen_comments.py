"""Input filter of Doxygen: shows it the comments of a header as the library writes them.

The comment that opens a header documents the file. A comment behind a member or an enumerator documents that. Lines
indented in a comment are code. All other text is plain: nothing in it is a command or a tag.
"""

import re
import sys

COMMENT = re.compile(r"^(\s*)///? ?(.*)$")
BEHIND = re.compile(r"^(  \s*\S.*?(?:;|,|\b\w+|\)))  // (.*)$")  # code, two spaces, comment


def plain(text):
    return re.sub(r"([\\@<>&#%\"])", r"\\\1", text)


def block(indent, lines):
    """Lines of one comment, code in it marked as such."""
    result = []
    in_code = False
    for i, line in enumerate(lines):
        code = line.startswith("  ")
        text = line if code else plain(line)
        if code and not in_code:
            text = "@code{.cpp} " + text
        blank_inside = in_code and not line and any(following.startswith("  ") for following in lines[i + 1 : i + 2])
        in_code = code or blank_inside
        if in_code and not blank_inside and not (i + 1 < len(lines) and goes_on(lines, i + 1)):
            text += " @endcode"
            in_code = False
        result.append(f"{indent}/// {text}")
    return result


def goes_on(lines, i):
    return lines[i].startswith("  ") or (not lines[i] and i + 1 < len(lines) and lines[i + 1].startswith("  "))


def translate(source):
    result = []
    i = 0
    at_top = True
    while i < len(source):
        found = COMMENT.match(source[i])
        wanted = found and (at_top or source[i].lstrip().startswith("///"))
        if wanted:
            indent, lines = found.group(1), []
            while i < len(source) and (next_line := COMMENT.match(source[i])):
                lines.append(next_line.group(2))
                i += 1
            comment = block(indent, lines)
            if at_top:
                comment[0] = comment[0].replace("/// ", "/// @file\n/// ", 1)
            result += comment
            at_top = False
            continue
        at_top = False
        behind = BEHIND.match(source[i])
        if behind:
            result.append(f"{behind.group(1)}  ///< {plain(behind.group(2))}")
            while i + 1 < len(source) and re.match(r"^\s{12,}// ", source[i + 1]):
                i += 1
                result.append("      ///< " + plain(source[i].strip()[3:]))
        else:
            result.append(source[i])
        i += 1
    return result


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as file:
        print("\n".join(translate(file.read().splitlines())))
