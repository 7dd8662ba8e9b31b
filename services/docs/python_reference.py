"""The reference of the Python package as Markdown, from the docstrings and signatures of the package as it is built.

    PYTHONPATH=build/release/python python3 python_reference.py > reference.md

Nothing is listed here: what a module calls public is described, in the order in which it is written.
"""
import ast
import dataclasses
import functools
import importlib
import inspect
import re
import sys
import textwrap

WIDTH = 64  # of a call, so that a phone shows it whole
MODULES = ("dispersa", "dispersa.plot")


def public(module):
    """(name, value) of what a module calls public: as its parts are imported, and in the order of their sources."""
    names = getattr(module, "__all__", None) or [
        name for name, value in vars(module).items()
        if not name.startswith("_") and getattr(value, "__module__", None) == module.__name__]

    imported = list(sys.modules)

    def place(item):
        value = inspect.unwrap(item[1])
        of = value.__module__
        return (of == module.__name__, imported.index(of), inspect.getsourcelines(value)[1])
    return sorted(((name, getattr(module, name)) for name in names), key=place)


def signature(name, value):
    """A call as code, a parameter a line where it is long."""
    given = inspect.signature(value)
    plain = [parameter for parameter in given.parameters.values() if parameter.name != "self"]
    parts, keyword = [], False
    for parameter in plain:
        if parameter.kind is parameter.KEYWORD_ONLY and not keyword:
            parts.append("*")
            keyword = True
        parts.append(str(parameter.replace(annotation=parameter.empty)))
    line = f"{name}({', '.join(parts)})"
    if len(line) > WIDTH:
        body = textwrap.fill(", ".join(parts), WIDTH, initial_indent="    ", subsequent_indent="    ",
                             break_long_words=False, break_on_hyphens=False)
        line = f"{name}(\n{body})"
    return f"```python\n{line}\n```"


class Links:
    """Names of classes and their methods in a text, as links to where they are described."""

    def __init__(self, names):
        longest_first = sorted(map(re.escape, names), key=len, reverse=True)
        self._names = re.compile(r"\b(" + "|".join(longest_first) + r")\b(?![\w(])")

    def text(self, docstring, here=""):
        """A docstring as Markdown: prose is escaped, code stays."""
        paragraphs = []
        for paragraph in re.split(r"\n\s*\n", inspect.cleandoc(docstring or "")):
            if paragraph and all(line.startswith("    ") for line in paragraph.splitlines()):
                paragraphs.append("```python\n" + textwrap.dedent(paragraph) + "\n```")
                continue
            parts = re.split(r"(`[^`]*`)", paragraph)
            paragraphs.append("".join(part if i % 2 else self._prose(part, here) for i, part in enumerate(parts)))
        return "\n\n".join(paragraphs)

    def _prose(self, text, here):
        parts = self._names.split(text)
        return "".join((part if part == here else f"[{escaped(part)}](#{anchor(part)})") if i % 2 else escaped(part)
                       for i, part in enumerate(parts))


def escaped(text):
    return re.sub(r"([\\*_<\[\]])", r"\\\1", text)


def anchor(name):
    return name.lower().replace(".", "-").replace("_", "-")


def heading(level, title, name):
    return f"{'#' * level} {title} {{#{anchor(name)}}}"


def fields(cls):
    """(name, what stands below it) of a dataclass's fields, or of an enumeration's values."""
    if issubclass(cls, int):
        return [(name, f"`{value.value}`") for name, value in cls.__members__.items()]
    if not dataclasses.is_dataclass(cls):
        return []
    below = {}
    body = ast.parse(textwrap.dedent(inspect.getsource(cls))).body[0].body
    for node, after in zip(body, body[1:] + [None]):
        if isinstance(node, ast.AnnAssign):
            below[node.target.id] = (after.value.value if isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant)
                                     else "")
    return [(field.name, below.get(field.name, "")) for field in dataclasses.fields(cls)]


def members(cls):
    """(name, value) of its own public methods and properties, in the order of its sources."""
    return [(name, value) for name, value in vars(cls).items()
            if not name.startswith("_") and (inspect.isfunction(value) or isinstance(value, (property, functools.cached_property)))]


def describe_class(name, cls, links):
    lines = [heading(3, name, name), ""]
    if issubclass(cls, BaseException):
        bases = [base.__name__ for base in cls.__bases__]
        lines += [links.text(f"Of {' and '.join(bases)}." + (f" `code` is {cls.code:d}." if hasattr(cls, "code") else "")), ""]
    lines += [links.text(cls.__doc__, name), ""]
    found = [(field, links.text(text)) for field, text in fields(cls)]
    found += [(member, links.text(value.__doc__, name)) for member, value in members(cls) if not inspect.isfunction(value)]
    if found:
        lines += ["| attribute | |", "|---|---|"]
        lines += [f"| `{member}` | {' '.join(text.split()).replace('|', chr(92) + '|')} |" for member, text in found]
        lines += [""]
    for member, value in members(cls):
        if inspect.isfunction(value):
            lines += [heading(4, f"{name}.{member}", f"{name}.{member}"), "", signature(f"{name}.{member}", value), "",
                      links.text(value.__doc__, name), ""]
    return lines


def page():
    modules = [importlib.import_module(name) for name in MODULES]
    everything = [pair for module in modules for pair in public(module)]
    classes = [(name, value) for name, value in everything if inspect.isclass(value)]
    links = Links([name for name, _ in classes] + [f"{name}.{member}" for name, value in classes
                                                   for member, method in members(value) if inspect.isfunction(method)])
    lines = ["# Reference of the Python package", "", "What the package says of itself: `help(dispersa.run)` shows the same.", ""]
    for module in modules:
        names = public(module)
        lines += [heading(2, module.__name__, module.__name__), "", links.text(module.__doc__), ""]
        for name, value in names:
            full = f"{module.__name__}.{name}"
            if inspect.isclass(value):
                continue
            lines += [heading(3, full, full), "", signature(full, value), "", links.text(value.__doc__), ""]
        here = [(name, value) for name, value in names if inspect.isclass(value)]
        errors = [pair for pair in here if issubclass(pair[1], BaseException)]
        for title, group in (("What they return", [pair for pair in here if pair not in errors]), ("Exceptions", errors)):
            if group:
                lines += [heading(2, title, title.replace(" ", "-")), ""]
            for name, value in group:
                lines += describe_class(name, value, links)
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.stdout.write(page())
