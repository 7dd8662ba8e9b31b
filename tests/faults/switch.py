"""Writes faults into the text of a C++ source so that one build has them all: each stands behind
`dispersa_fault(number)` (fault_switch.h) and works in a process whose DISPERSA_FAULT is its number.

A fault in a function makes a second body of it. Elsewhere (constants, tables, default values) it makes a choice of two
expressions.
"""
import collections
import re

NO_CODE = re.compile(r"""//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])+'"""
                     r"""|^[ \t]*\#(?:\\\n|[^\n])*""", re.S | re.M)
# What stands before the brace of a function's body.
SIGNATURE = re.compile(r"\)\s*(const|noexcept|override|final|mutable|&&?|->\s*[\w:<>*&, ]+|\s)*$")


class Unfit(Exception):
    """The fault has no form at run time here."""


def blanked(text):
    """The text with spaces for comments, strings and the preprocessor's lines."""
    return NO_CODE.sub(lambda found: re.sub(r"[^\n]", " ", found.group()), text)


def smallest(text, begin, end, new):
    """The change without what is the same before and after it."""
    while begin < end and new and text[begin] == new[0]:
        begin, new = begin + 1, new[1:]
    while begin < end and new and text[end - 1] == new[-1]:
        end, new = end - 1, new[:-1]
    return begin, end, new


def blocks_around(code, begin, end):
    """The brackets around a place, from outside to inside: (position of the opening one, of the closing one)."""
    found, open_ones = [], []
    for position, letter in enumerate(code):
        if letter in "{([":
            open_ones.append(position)
        elif letter in "})]":
            opening = open_ones.pop()
            if opening < begin and end <= position:
                found.append((opening, position))
    return sorted(found)


def body_around(code, blocks):
    """The outermost function body, without its braces."""
    for opening, closing in blocks:
        header = code[max(code.rfind(mark, 0, opening) for mark in ";{}") + 1:opening]
        after_list = not header.strip() and code[:opening].rstrip().endswith("}")  # Constructor() : member{value} {
        if code[opening] == "{" and (SIGNATURE.search(header) or after_list):
            return opening + 1, closing
    return None


def value_around(code, blocks, begin, end):
    """The element of a list, the argument or the value in a declaration."""
    opening, closing = blocks[-1] if blocks else (-1, len(code))
    depth, separator = 0, opening
    for position in range(opening + 1, closing):
        depth += (code[position] in "{([") - (code[position] in "})]")
        if depth == 0 and re.match(r"[,;]|(?<![=<>!])=(?!=)", code[position:position + 2]):
            if position >= end:
                closing = position
                break
            separator = position
    if separator < 0 or code[separator] == ";" or (code[separator] == "{" and ";" in code[opening:closing]):
        raise Unfit
    return separator + 1, closing


def place_of(code, begin, end):
    """What is written anew for a change there: (begin, end, whether it is a function's body)."""
    blocks = blocks_around(code, begin, end)
    body = body_around(code, blocks)
    return (*(body or value_around(code, blocks, begin, end)), body is not None)


def with_switches(text, changes):
    """For changes {number: (begin, end, new text)}: the text with a switch for each, the lines [(first, last, numbers)]
    that are there because of them, and the numbers that have no such form."""
    code, places, unfit = blanked(text), collections.defaultdict(list), []
    for number, change in changes.items():
        begin, end, new = smallest(text, *change)
        try:
            places[place_of(code, begin, end)].append((number, begin, end, new))
        except Unfit:
            unfit.append(number)
    written, last, lines = "", 0, []
    for (first, after, is_body), choices in sorted(places.items()):
        if first < last:  # inside of what was just written
            unfit += [choice[0] for choice in choices]
            continue
        if not is_body:  # a value that a process chooses is no constant expression
            declaration = max(last, code.rfind(";", 0, first) + 1)
            written += text[last:declaration]
            constant = re.sub(r"\b(static|inline) constexpr\b", "inline const", text[declaration:first])
            written, last = written + constant.replace("constexpr ", "const "), first
        written += text[last:first]
        start = written.count("\n") + 1
        for number, begin, end, new in choices:
            faulty, line = text[first:begin] + new + text[end:after], written.count("\n") + 1
            written += f"if (dispersa_fault({number})) {{{faulty}\n}} else " if is_body else \
                f"(dispersa_fault_of_value({number}) ? ({faulty}) : "
            lines.append((line, written.count("\n") + 1, [number]))
        written += f"{{{text[first:after]}\n}}" if is_body else f"({text[first:after]})" + ")" * len(choices)
        lines.append((start, written.count("\n") + 1, [choice[0] for choice in choices]))
        last = after
    return written + text[last:], lines, unfit
