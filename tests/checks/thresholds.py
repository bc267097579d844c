"""No threshold without a name and a reason where a diagnosis is decided: thresholds.py REPOSITORY

In diagnose/verdict, diagnose/selection and diagnose/log_doctor a number in the body of a function may be 0, 1 or 2 (also negative), a factor
of a half, a factor of 100 (a share in percent), a guard against division by zero (1e-300 and smaller), a size in
brackets, or hexadecimal (the label of a stream of random numbers). Any other stands in a field of a criteria struct or
in a constexpr, whose line or the comment above it says why it is what it is.
"""
import sys

from cpp_source import declarations, finish, headers, tokens

ROOMS = ["surefoot/diagnose/verdict/", "surefoot/diagnose/selection/", "surefoot/diagnose/log_doctor/"]
SMALLEST_THRESHOLD = 1e-300


def value_of(token):
    return float(token.text.replace("'", "").lower().rstrip("ulfz"))


def is_plain(code, i):
    """Whether the number code[i] is none that anyone chose."""
    if code[i].text.startswith("0x"):
        return True
    value = value_of(code[i])
    around = [code[j].text for j in (i - 1, i + 1) if 0 <= j < len(code)]
    if value in (0, 1, 2) or value <= SMALLEST_THRESHOLD:
        return True
    if around == ["[", "]"] or (around == ["<", ">"] and code[i - 2].kind == "word"):
        return True  # a size: double sums[3], Vec<3>
    return value in (0.5, 100) and "*" in around and not {"<", ">", "<=", ">="} & set(around)


def statement_of(code, i):
    """The tokens from the start of the statement that code[i] stands in up to it."""
    start = i
    while start > 0 and code[start - 1].text not in (";", "{", "}"):
        start -= 1
    return code[start:i]


def is_explained(lines, first, last):
    """Whether one of these lines has a comment, or the one above them is one."""
    return any("//" in lines[number - 1] for number in range(first, last + 1)) or \
        (first > 1 and lines[first - 2].strip().startswith("//"))


def numbers_with_reason(code, lines):
    """Faults (line, reason) of numbers in fields and constants."""
    for i, token in enumerate(code):
        if token.kind == "number" and not is_plain(code, i):
            if not is_explained(lines, code[0].line, code[-1].line):
                yield token.line, f"{token.text} without a reason: no comment in its line or above"


def check_text(text):
    lines = text.split("\n")
    for declaration in declarations(text):
        if declaration.kind == "variable":
            yield from numbers_with_reason(declaration.tokens, lines)
        elif declaration.kind == "function":
            code = declaration.tokens
            for i, token in enumerate(code):
                if token.kind != "number" or is_plain(code, i):
                    continue
                before = [t.text for t in statement_of(code, i)]
                if "constexpr" not in before:
                    yield token.line, f"{token.text} without a name, in {declaration.name}()"
                elif not is_explained(lines, statement_of(code, i)[0].line, token.line):
                    yield token.line, f"{token.text} without a reason: no comment in its line or above"


def check(root):
    return [f"include/{header}:{line}: {reason}" for header, text in headers(root).items()
            if any(header.startswith(room) for room in ROOMS) for line, reason in check_text(text)]


if __name__ == "__main__":
    finish("thresholds", check(sys.argv[1]), "every threshold has a name and a reason")
