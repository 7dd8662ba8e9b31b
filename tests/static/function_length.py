"""Checks that no function of the product has more than 100 lines, from its head to its closing brace.

A long function has stages: each of them has a purpose, and a function of that name.

usage: function_length.py REPOSITORY [LINES]
"""
import pathlib
import re
import sys

import product_sources

LIMIT = 100
# Functions that may be longer, and folders with such functions. One that is not needed fails.
EXEMPT = {
    "MakeRows": "a table: a row for each dispersion",
    "core/guidance": "the corrector, written with its equations",
}

IGNORED = re.compile(r"""//[^\n]*|/\*.*?\*/|R"(?P<mark>[^(\s]*)\(.*?\)(?P=mark)"|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])+'"""
                     r"""|^[ \t]*\#(?:\\\n|[^\n])*|\b(?:public|private|protected)\s*:""", re.DOTALL | re.MULTILINE)
SCOPE = re.compile(r"(?:inline )?namespace\b|extern\b *$|(?:class|struct|union)\b(?!.*\()")


def blank(text):
    """The text without comments, literals, directives and access specifiers, with its line ends."""
    text = re.sub(r"(?<=[0-9a-fA-F])'(?=[0-9a-fA-F])", "_", text)
    return IGNORED.sub(lambda match: re.sub(r"[^\n]", " ", match.group()), text)


def without_template(head):
    """The head of a declaration without `template <...>` before it."""
    while match := re.match(r"template\s*<", head):
        depth, end = 1, match.end()
        while depth and end < len(head):
            depth += {"<": 1, ">": -1}.get(head[end], 0)
            end += 1
        head = head[end:].lstrip()
    return head


def function_name(head):
    """The name of the function whose body follows this head; None where no function's body does."""
    head = without_template(head.strip())
    name = re.match(r"[^(=]*?(operator\s*\(\s*\)|operator[^\w\s(]+|~?\w+)\s*\(", head)
    if not name or name.group(1) in ("alignas", "decltype"):
        return None
    # A brace in a constructor's list of members is a value.
    if re.search(r"\)\s*(?:noexcept\s*)?:[^:]", head) and re.search(r"\w>?\s*$", head):
        return None
    return name.group(1)


def functions(text):
    """(name, first line, number of lines) of each function that has a body, outside of others."""
    text = blank(text)
    found, inside, begin, parentheses = [], [], 0, 0  # inside: of each open brace, what it opens
    for at, character in enumerate(text):
        if character in "()":
            parentheses += 1 if character == "(" else -1
        elif character == "{":
            within_function = any(opened != "scope" for opened in inside)
            head = text[begin:at]
            if within_function or parentheses:
                inside.append("value")
            elif SCOPE.match(without_template(head.strip())):
                inside.append("scope")
                begin = at + 1
            elif name := function_name(head):
                inside.append((name, begin + len(head) - len(head.lstrip())))
            else:
                inside.append("value")
        elif character == "}":
            opened = inside.pop()
            if isinstance(opened, tuple):
                first = text.count("\n", 0, opened[1]) + 1
                found.append((opened[0], first, text.count("\n", opened[1], at) + 1))
            if opened != "value":
                begin = at + 1
        elif character == ";" and not parentheses and all(opened == "scope" for opened in inside):
            begin = at + 1
    return found


def check(root, limit=LIMIT, exempt=EXEMPT):
    """Violations, one line each."""
    problems, needed, seen = [], set(), 0
    for folder in product_sources.FOLDERS:
        for path in sorted(path for path in (root / folder).rglob("*") if path.suffix in (".cc", ".h")):
            name = path.relative_to(root)
            for function, line, lines in functions(path.read_text()):
                seen += 1
                if lines <= limit:
                    continue
                reasons = {key for key in exempt if key == function or name.is_relative_to(key)}
                needed |= reasons
                if not reasons:
                    problems.append(f"{name}:{line}: {function} has {lines} lines, {limit} are allowed")
    problems += [f"function_length.py: the exemption {key} is not needed" for key in exempt if key not in needed]
    return problems if seen else ["no function in " + " and ".join(product_sources.FOLDERS)]


if __name__ == "__main__":
    found = check(pathlib.Path(sys.argv[1]), *map(int, sys.argv[2:]))
    print("\n".join(found))
    sys.exit(1 if found else 0)
