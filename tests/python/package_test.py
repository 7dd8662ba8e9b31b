"""The package itself: the declarations of its .pyi files, its installation, and its message about a processor that
is too old.
"""
import ast
import dataclasses
import importlib
import inspect
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import dispersa
import dispersa.plot
from program import BINARIES, SMOKE, folder_of

PACKAGE = pathlib.Path(dispersa.__file__).parent


def declared_in(path):
    """{name: syntax tree of its last definition} of the public names that a .pyi file declares."""
    names = {}
    for node in ast.parse(path.read_text()).body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            names[node.name] = node
        elif isinstance(node, ast.AnnAssign):
            names[node.target.id] = node
        elif isinstance(node, ast.ImportFrom):
            names.update({alias.asname: node for alias in node.names if alias.asname})
    return {name: node for name, node in names.items() if not name.startswith("_") or name == "__version__"}


def parameters(function):
    """[(name, kind, has a default)] of a function."""
    kinds = inspect.Parameter
    kind_names = {kinds.POSITIONAL_OR_KEYWORD: "plain", kinds.KEYWORD_ONLY: "keyword", kinds.VAR_KEYWORD: "rest"}
    return [(p.name, kind_names[p.kind], p.default is not kinds.empty) for p in inspect.signature(function).parameters.values()]


def declared_parameters(node):
    """The same of a .pyi file's."""
    plain, keyword = node.args.args, node.args.kwonlyargs
    defaults = [False] * (len(plain) - len(node.args.defaults)) + [True] * len(node.args.defaults)
    return ([(each.arg, "plain", has) for each, has in zip(plain, defaults)]
            + [(each.arg, "keyword", default is not None) for each, default in zip(keyword, node.args.kw_defaults)]
            + ([(node.args.kwarg.arg, "rest", False)] if node.args.kwarg else []))


class Declarations(unittest.TestCase):
    def test_every_public_name_has_one_and_the_other_way_round(self):
        for module in ("dispersa", "dispersa.plot", "dispersa.errors"):
            loaded = importlib.import_module(module)
            declarations = PACKAGE / f"{module.partition('.')[2] or '__init__'}.pyi"
            declared = declared_in(declarations)
            public = set(getattr(loaded, "__all__", ())) | {"__version__"} if module == "dispersa" else {
                name for name, value in vars(loaded).items()
                if not name.startswith("_") and not inspect.ismodule(value)
                and (getattr(value, "__module__", module) == module)}
            self.assertEqual(set(declared), public, module)
            for name, node in declared.items():
                value = getattr(loaded, name)
                with self.subTest(f"{module}.{name}"):
                    if isinstance(node, ast.FunctionDef) and name != "style":
                        self.assertEqual(declared_parameters(node), parameters(value))
                    if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
                        self.assertTrue(value.__doc__, "a docstring")
                    if isinstance(node, ast.ClassDef) and not issubclass(value, (BaseException, int)):
                        self.check_class(node, value)

    def check_class(self, node, value):
        members = {each.name: each for each in node.body if isinstance(each, ast.FunctionDef)}
        fields = {each.target.id for each in node.body if isinstance(each, ast.AnnAssign)}
        for name, each in members.items():
            # A sequence iterates by its items.
            self.assertTrue(hasattr(value, name) or name == "__iter__", name)
            if not each.decorator_list and name in vars(value) and name != "__bool__":
                self.assertEqual(declared_parameters(each), parameters(vars(value)[name]), name)
        public = {name for name in vars(value) if not name.startswith("_")}
        self.assertLessEqual(public, set(members) | fields, "in the module only")
        if dataclasses.is_dataclass(value):
            self.assertEqual({each.name for each in dataclasses.fields(value)}, fields)

    def test_objects_have_the_declared_fields(self):
        declared = declared_in(PACKAGE / "__init__.pyi")
        campaign = dispersa.load(SMOKE, cases=2)
        flights = campaign.fly_many(1)
        for value in (flights, flights[0], flights[0].history):
            node = declared[type(value).__name__]
            fields = {each.target.id for each in node.body if isinstance(each, ast.AnnAssign)}
            self.assertEqual(fields, {name for name in vars(value) if not name.startswith("_")}, type(value).__name__)

    def test_marked_as_typed(self):
        self.assertTrue((PACKAGE / "py.typed").is_file())


class Processor(unittest.TestCase):
    def test_too_old(self):
        with tempfile.NamedTemporaryFile("w") as cpuinfo:
            cpuinfo.write("processor: 0\nflags\t\t: fpu sse4_2 popcnt\n")
            cpuinfo.flush()
            with self.assertRaisesRegex(ImportError, "x86-64-v3"):
                dispersa._processor.check(cpuinfo.name)


class Unbuilt(unittest.TestCase):
    def test_says_what_to_build(self):
        package = folder_of(type(self)) / "dispersa"
        shutil.copytree(PACKAGE, package, ignore=shutil.ignore_patterns("_core*", "__pycache__"))
        done = subprocess.run([sys.executable, "-c", "import dispersa"], capture_output=True, text=True,
                              env={**os.environ, "PYTHONPATH": str(package.parent)})
        version = "{}.{}".format(*sys.version_info)
        self.assertIn(f"ImportError: the extension of dispersa is not built for Python {version}; `cmake --build build/release "
                      "--target python` builds it, with the packages of docker/packages.txt and tests/packages.txt\n",
                      done.stderr)


class Installation(unittest.TestCase):
    def test_found_with_its_worker_wherever_the_prefix_is(self):
        prefix = folder_of(type(self)) / "prefix"
        build = BINARIES.parent
        done = subprocess.run(["cmake", "--install", str(build), "--prefix", str(prefix)], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        moved = prefix.rename(prefix.with_name("moved"))
        package, = moved.glob("lib/*/*/dispersa")
        self.assertEqual({path.name for path in package.iterdir()},
                         {path.name for path in PACKAGE.iterdir()} - {"__pycache__"})
        script = ("import dispersa, sys; r = dispersa.run(sys.argv[1], sys.argv[2], cases=2, workers=1, histories=False); "
                  "print(dispersa.worker_program(), len(r))")
        done = subprocess.run([sys.executable, "-B", "-c", script, str(SMOKE), str(moved / "results")], capture_output=True,
                              text=True, timeout=120, env={**os.environ, "PYTHONPATH": str(package.parent)})
        self.assertEqual((done.returncode, done.stdout), (0, f"{moved}/bin/dispersa-worker 2\n"), done.stderr)


if __name__ == "__main__":
    unittest.main()
