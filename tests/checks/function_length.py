"""No function of include/ is longer than a page: function_length.py REPOSITORY

Counts the lines from the first of its signature (template<...> above it included) to its closing brace; lambdas count
to the function that they stand in.
"""
import sys

from cpp_source import declarations, finish, headers

MOST_LINES = 80


def is_lambda(declaration):
    texts = [token.text for token in declaration.tokens]
    return "=" in texts and any(texts[i] == "]" and texts[i + 1] in ("(", "{") for i in range(len(texts) - 1))


def check(root):
    faults = []
    for header, text in headers(root).items():
        for declaration in declarations(text):
            lines = declaration.last_line - declaration.first_line + 1
            if lines > MOST_LINES and (declaration.kind == "function" or
                                       (declaration.kind == "variable" and is_lambda(declaration))):
                faults.append(f"include/{header}:{declaration.first_line}: {declaration.name} has {lines} lines, more than {MOST_LINES}")
    return faults


if __name__ == "__main__":
    finish("function_length", check(sys.argv[1]), f"no function has more than {MOST_LINES} lines")
