"""The reference of the docs site: every public name is in it, and docstrings give shapes, units and errors."""
import ast
import importlib.util
import inspect
import os
import pathlib
import re
import unittest

import dispersa
import dispersa.plot

SOURCES = pathlib.Path(os.environ["DISPERSA_PYTHON_SOURCES"])
SPEC = importlib.util.spec_from_file_location("python_reference", SOURCES.parent / "docs" / "python_reference.py")
REFERENCE = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(REFERENCE)
UNIT = re.compile(r"_(s|ms|deg|rad|m|km|percent|kg|n|pa|1_s2|1_s|rad_s2|rad_s|sigma)$")
# Neither takes anything that could be wrong.
HARMLESS = {"dispersa.worker_program", "dispersa.plot.style", "dispersa.plot.label", "dispersa.validate"}


def declared():
    """(name with module, syntax tree) of every function, and of every method and property of every class."""
    for module in (dispersa, dispersa.plot):
        file = pathlib.Path(module.__file__)
        for node in ast.parse((file.parent / f"{file.stem}.pyi").read_text()).body:
            if isinstance(node, ast.FunctionDef):
                yield f"{module.__name__}.{node.name}", getattr(module, node.name), node
            elif isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                for member in node.body:
                    if isinstance(member, ast.FunctionDef) and not member.name.startswith("_"):
                        yield f"{node.name}.{member.name}", inspect.getattr_static(getattr(module, node.name), member.name), member


def arrays(annotation):
    return annotation is not None and re.search(r"\b(_Floats|_Structured|NDArray|_Panels)\b", ast.unparse(annotation))


class Reference(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.page = REFERENCE.page()
        cls.headings = set(re.findall(r"^#+ (\S+) \{#", cls.page, re.MULTILINE))

    def test_every_public_name_appears(self):
        for name in dispersa.__all__:
            value = getattr(dispersa, name)
            self.assertIn(name if inspect.isclass(value) else f"dispersa.{name}", self.headings)
        for name, _, node in declared():
            if any(isinstance(each, ast.Name) and each.id == "property" for each in node.decorator_list):
                self.assertRegex(self.page, rf"\n\| `{node.name}` \| \S", name)
            else:
                self.assertIn(name, self.headings)
        for name in ("INCOMPLETE", "REPLAY_MISMATCH"):
            self.assertIn(f"| `{name}` | `{int(dispersa.ExitCode[name])}` |", self.page)
        self.assertIn("| `path` | The value's path in its file", self.page)
        for row in re.findall(r"^\| `.*$", self.page, re.MULTILINE):
            self.assertRegex(row, r"^\| `\w+` \| (?!`+python).{5,} \|$|^\| `[A-Z_]+` \| `\d+` \|$")

    def test_every_docstring_is_there(self):
        names = [value for name in dispersa.__all__ for value in [getattr(dispersa, name)]]
        for value in names + [value for _, value, _ in declared()]:
            self.assertTrue(inspect.getdoc(value), value)
        plain = " ".join(re.sub(r"[\\`#]|\]\([^)]*\)|\[", "", self.page).split())
        for name, value, _ in declared():
            first = re.split(r"(?<=[.:])\s", inspect.getdoc(value))[0]
            self.assertIn(" ".join(re.sub(r"[\\`#\[]|\]\([^)]*\)", "", first).split()), plain, name)

    def test_arrays_have_shapes(self):
        found = [(name, value) for name, value, node in declared() if arrays(node.returns)]
        self.assertGreater(len(found), 4)
        for name, value in found:
            self.assertRegex(inspect.getdoc(value), r"shape\s\(", name)
        for value in (dispersa.History, dispersa.Flights, dispersa.Results):
            self.assertRegex(inspect.getdoc(value), r"shape\s\(")

    def test_numbers_have_units(self):
        count = 0
        for name, value, node in declared():
            for each in node.args.args + node.args.kwonlyargs:
                if each.annotation is not None and ast.unparse(each.annotation) == "float":
                    self.assertRegex(each.arg, UNIT, name)
                    count += 1
        self.assertGreater(count, 2)
        self.assertRegex(inspect.getdoc(dispersa.Campaign.plan), r"in the\s+unit of its name")
        self.assertIn("rad/s²", inspect.getdoc(dispersa.Campaign.fly))

    def test_what_takes_something_says_what_it_raises(self):
        for name, value, node in declared():
            own = [each.arg for each in node.args.args + node.args.kwonlyargs if each.arg != "self"]
            if own and not isinstance(value, property) and name not in HARMLESS and name != "Flights.history":
                self.assertIn("Raises", inspect.getdoc(value), name)

    def test_prose_stays_prose(self):
        """What Markdown would take for emphasis or a tag is escaped; code is not."""
        links = REFERENCE.Links(["Results"])
        self.assertEqual(links.text("NAME_min, _p01 of Results: `a_b`, <c>\n\n    x = y_z * 2\n\nEnd."),
                         "NAME\\_min, \\_p01 of [Results](#results): `a_b`, \\<c>\n\n```python\nx = y_z * 2\n```\n\nEnd.")


if __name__ == "__main__":
    unittest.main()
