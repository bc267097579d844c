"""Tokens and declarations of C++ files, for the checks of this folder.

Reads what clang-format has formatted; knows no types and expands no macros, which is enough for these headers.
"""
import re
import sys
from dataclasses import dataclass, field
from pathlib import Path

TOKEN = re.compile(
    r"""(?P<comment>//[^\n]*|/\*.*?\*/)
      | (?P<directive>^[ \t]*\#(?:\\\n|[^\n])*)
      | (?P<string>R"(?P<mark>[^()\s]{0,16})\(.*?\)(?P=mark)"|"(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)*')
      | (?P<number>\.?\d(?:[eE][+-](?=\d)|'(?=\w)|[\w.])*)
      | (?P<word>[A-Za-z_]\w*)
      | (?P<sign>::|->|\+\+|--|<<|[-+*/%&|^!=<>]=|&&|\|\||\.\.\.|[^\s\w])""",
    re.VERBOSE | re.DOTALL | re.MULTILINE)
CLOSING = {"(": ")", "[": "]", "{": "}"}
TYPES = ("struct", "class", "union", "enum")
NOT_NAMES = ("requires", "noexcept", "decltype", "alignas", "explicit", "sizeof")  # stand before ( but are no function


@dataclass
class Token:
    kind: str  # comment, directive, string, number, word, sign
    text: str
    line: int


@dataclass
class Declaration:
    kind: str  # function, type, variable, alias, concept, enumerator
    name: str
    namespace: str  # "surefoot::detail"
    inside: str  # the type it is a member of, or ""
    public: bool
    tokens: list  # all of it, from its first word to its ; or }
    body: list = field(default_factory=list)  # of a function, between its braces
    parameters: list = field(default_factory=list)  # of a function, their names

    @property
    def first_line(self):
        return self.tokens[0].line

    @property
    def last_line(self):
        return self.tokens[-1].line


def tokens(text):
    result, line, end = [], 1, 0
    for match in TOKEN.finditer(text):
        line += text.count("\n", end, match.start())
        result.append(Token(match.lastgroup if match.lastgroup != "mark" else "string", match.group(), line))
        end = match.start()
    return result


def match_of(code, i):
    """The index of what closes the bracket code[i]."""
    opening, closing, depth = code[i].text, CLOSING[code[i].text], 0
    for j in range(i, len(code)):
        if code[j].text == opening and code[j].kind == "sign":
            depth += 1
        elif code[j].text == closing and code[j].kind == "sign":
            depth -= 1
            if depth == 0:
                return j
    raise ValueError(f"line {code[i].line}: {opening} without its {closing}")


def skip_angles(code, i):
    """The index after the <...> that begins at i."""
    depth = 0
    while i < len(code):
        if code[i].text in CLOSING:
            i = match_of(code, i)
        elif code[i].text == "<":
            depth += 1
        elif code[i].text == ">":
            depth -= 1
            if depth == 0:
                return i + 1
        i += 1
    return i


def outer(code):
    """Indices of the tokens outside all brackets, angle brackets among them; an opening bracket counts as outside."""
    i, angles = 0, 0
    while i < len(code):
        text = code[i].text
        if text == "operator":  # its sign is part of a name
            yield i
            i += 2
            while i < len(code) and (code[i].text != "(" or code[i - 1].text == "operator"):
                i += 1
            continue
        if text == "<":
            angles += 1
        elif text == ">" and angles:
            angles -= 1
        elif not angles:
            yield i
        if code[i].kind == "sign" and text in CLOSING:
            i = match_of(code, i)
        i += 1


def without_template_head(code):
    while code and code[0].text == "template" and len(code) > 1 and code[1].text == "<":
        code = code[skip_angles(code, 1):]
    return code


def parameter_list(code):
    """The index of the ( of the parameters of a function, or None."""
    for i in outer(code):
        text = code[i].text
        if text == "=":
            return None
        if text == "(" and i and code[i - 1].text not in NOT_NAMES:
            before = [token.text for token in code[max(0, i - 4):i]]
            if code[i - 1].kind == "word" or "operator" in before or before[-1:] == [">"]:
                return i
    return None


def parameter_names(code, opening):
    names, piece = [], []
    inner = code[opening + 1:match_of(code, opening)]
    kept = list(outer(inner))
    for i in kept + [None]:
        if i is None or inner[i].text == ",":
            words = [t for t in piece]
            if "=" in [t.text for t in words]:
                words = words[:[t.text for t in words].index("=")]
            if len(words) > 1 and words[-1].kind == "word":
                names.append(words[-1])
            piece = []
        else:
            piece.append(inner[i])
    return names


def function_name(code, opening):
    for i in range(max(0, opening - 4), opening):
        if code[i].text == "operator":
            return "operator" + "".join(token.text for token in code[i + 1:opening])
    return code[opening - 1].text


def type_keyword(code):
    indices = [i for i in outer(code) if code[i].text in TYPES]
    return indices[0] if indices else None


def type_name(code, keyword):
    i = keyword + 1
    while i < len(code):
        if code[i].text == "alignas":
            i = match_of(code, i + 1)
        elif code[i].text == "[":
            i = match_of(code, i)
        elif code[i].kind == "word" and code[i].text not in TYPES:
            return code[i].text
        elif code[i].text not in TYPES:
            break
        i += 1
    return ""


def brace_kind(statement):
    """What a { after these tokens opens: namespace, type, function or value."""
    code = without_template_head(statement)
    texts = [token.text for token in code]
    if "namespace" in texts[:2] or (texts[:1] == ["extern"] and len(code) == 2):
        return "namespace"
    parameters = parameter_list(code)
    keyword = type_keyword(code)
    if keyword is not None and (parameters is None or keyword < parameters) and "=" not in texts[:keyword]:
        return "type"
    if texts[-1:] == ["requires"]:
        return "value"
    if texts[-1:] == [")"]:
        depth = 0
        for i in range(len(code) - 1, -1, -1):
            depth += (texts[i] == ")") - (texts[i] == "(")
            if depth == 0:
                break
        if i and texts[i - 1] == "requires":
            return "value"
    if parameters is None:
        return "value"
    after = code[match_of(code, parameters) + 1:]
    if any(after[i].text == ":" for i in outer(after)) and after[-1].text not in (")", "}"):
        return "value"  # of a member, before the body of a constructor
    return "function"


def variable_names(code):
    names, last, in_value = [], None, False
    for i in outer(code):
        token = code[i]
        if token.text == ",":
            if not in_value and last:
                names.append(last)
            last, in_value = None, False
        elif token.text in ("=", "{", "[", ":", ";") and not in_value and i:
            if last:
                names.append(last)
            last, in_value = None, True
        elif token.kind == "word" and not in_value:
            last = token
    return names


def declarations(text):
    """All declarations at the level of namespaces and types."""
    code = [token for token in tokens(text) if token.kind not in ("comment", "directive")]
    result = []
    _scope(code, 0, "", "", True, result)
    return result


def _enumerators(code, namespace, inside, public, result):
    fresh = True
    for i in outer(code):
        if code[i].text == ",":
            fresh = True
        elif fresh and code[i].kind == "word":
            result.append(Declaration("enumerator", code[i].text, namespace, inside, public, [code[i]]))
            fresh = False


def _scope(code, i, namespace, inside, public, result):
    start = i
    while i < len(code):
        text = code[i].text if code[i].kind == "sign" else ""
        if text == "}":
            return i
        if text == ":" and code[i - 1].text in ("public", "private", "protected") and start == i - 1:
            public = code[i - 1].text == "public"
            start = i + 1
        elif text == ";":
            if i > start:
                _plain(code[start:i + 1], namespace, inside, public, result)
            start = i + 1
        elif text in ("(", "["):
            i = match_of(code, i)
        elif text == "{":
            end, statement = match_of(code, i), code[start:i]
            kind = brace_kind(statement)
            if kind == "namespace":
                names = [t.text for t in statement if t.kind == "word" and t.text not in ("namespace", "inline")]
                deeper = "::".join(([namespace] if namespace else []) + names)
                _scope(code, i + 1, deeper, "", True, result)
                start = end + 1
            elif kind == "type":
                head = without_template_head(statement)
                keyword = type_keyword(head)
                name = type_name(head, keyword)
                result.append(Declaration("type", name, namespace, inside, public, code[start:end + 1]))
                within = f"{inside}::{name}" if inside else name
                if head[keyword].text == "enum":
                    _enumerators(code[i + 1:end], namespace, within, public, result)
                else:
                    _scope(code, i + 1, namespace, within, public and head[keyword].text != "class", result)
            elif kind == "function":
                head = without_template_head(statement)
                opening = parameter_list(head)
                result.append(Declaration("function", function_name(head, opening), namespace, inside, public,
                                          code[start:end + 1], code[i + 1:end], parameter_names(head, opening)))
                start = end + 1
            i = end
        i += 1
    return i


def _plain(statement, namespace, inside, public, result):
    code = without_template_head(statement)
    if not code or code[0].text in ("friend", "static_assert", ";") or code[0].text == "}":
        return

    def add(kind, name, **more):
        result.append(Declaration(kind, name, namespace, inside, public, statement, **more))

    texts = [token.text for token in code]
    if texts[0] in ("using", "typedef"):
        if "=" in texts:
            add("alias", texts[1])
        return
    if "concept" in texts[:2]:
        add("concept", texts[texts.index("concept") + 1])
        return
    if type_keyword(code) is not None:
        keyword = type_keyword(code)
        if "{" not in texts:  # a forward declaration
            add("type", type_name(code, keyword))
            return
        if texts[-2] == "}":  # declared already, with its braces
            return
    opening = parameter_list(code)
    if opening is not None and code[-2].text != "}":
        add("function", function_name(code, opening), parameters=parameter_names(code, opening))
        return
    for name in variable_names(code):
        add("variable", name.text)


def headers(root):
    """All files of include/surefoot: path from include/ -> text."""
    include = Path(root) / "include"
    return {path.relative_to(include).as_posix(): path.read_text()
            for path in sorted(include.rglob("*.?pp")) if path.suffix in (".hpp", ".ipp")}


def finish(name, faults, well):
    """Ends a check: prints its faults, one a line, and fails; or says in one line that all is well."""
    for fault in faults:
        print(fault)
    if faults:
        sys.exit(f"{name}: {len(faults)} faults")
    print(well)
