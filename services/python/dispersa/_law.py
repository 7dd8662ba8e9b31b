"""The name and hash of a control law written in Python.

The law decides the flights, so its hash is a part of the flight id. The hash covers the data that decide the law's commands:
bytecode, defaults, closure, attributes and constants, the globals and attributes that it names, and in turn the functions and
objects among these. An object counts by the data that pickle keeps, a module of the user also by its source, a library by name
and version. A law that holds an object which pickle cannot keep is refused. The hash does not see data that a law reads from
elsewhere or changes in flight.
"""
import copyreg
import dis
import functools
import hashlib
import importlib
import operator
import os
import pathlib
import pickle
import sys
import sysconfig
import types
import warnings

import numpy

from ._arguments import refuse

_LIBRARIES = tuple({os.path.realpath(path) + os.sep for key, path in sysconfig.get_paths().items() if "lib" in key})
_SCALARS = (type(None), bool, int, float, complex, str, bytes, type(Ellipsis), type(NotImplemented))
# Of a class: what Python keeps there for itself, and what decides nothing.
_IDLE = ("__dict__", "__weakref__", "__doc__", "__annotations__", "_abc_impl")


def identity(law):
    """(name, SHA-256 in hexadecimal) of a callable. Raises BadInput for one that holds what cannot be seen."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of iterators, which later versions of Python will not pickle
            return name_of(law), _Fingerprint().of(law)
    except RecursionError:
        raise refuse("law: its references are nested too deeply for the hash", "a law with fewer levels of references") from None


def name_of(law):
    """As a report names it."""
    while isinstance(law, functools.partial):
        law = law.func
    name = str(getattr(law, "__qualname__", type(law).__qualname__))
    return name.encode(errors="backslashreplace").decode()


def _is_library(module_name):
    """Whether a module is the interpreter's own, installed beside it, or of this package, by its name."""
    name = module_name or ""
    top = name.partition(".")[0]
    file = getattr(sys.modules.get(name), "__file__", None) or getattr(sys.modules.get(top), "__file__", None)
    if file is None or top == __package__:
        return top == __package__ or top in sys.stdlib_module_names
    file = os.path.realpath(file)
    return file.startswith(_LIBRARIES) or f"{os.sep}dist-packages{os.sep}" in file or f"{os.sep}site-packages{os.sep}" in file


def _version(module_name):
    return getattr(sys.modules.get(module_name.partition(".")[0]), "__version__", "")


class _Fingerprint:
    """A hash over values and what they refer to, each of them once."""

    def __init__(self):
        self._hash = hashlib.sha256()
        self._seen = {}
        self._modules = {}  # of the user, by name
        self._names = set()  # that code has

    def of(self, law):
        self._add("python", sys.implementation.cache_tag)
        self._visit(law)
        self._named_in_modules()
        return self._hash.hexdigest()

    def _add(self, *texts):
        for text in texts:
            data = text if isinstance(text, bytes) else str(text).encode(errors="surrogatepass")
            self._hash.update(len(data).to_bytes(8, "little") + data)

    def _visit(self, value):
        kind = type(value)
        if kind in _SCALARS or isinstance(value, numpy.generic) and not isinstance(value, numpy.void):
            self._add(kind.__name__, repr(value))
            return
        if kind is tuple:  # whether equal ones are one object decides nothing
            self._add("tuple")
            self._all(value)
            return
        if id(value) in self._seen:
            self._add("again", self._seen[id(value)][0])
            return
        self._seen[id(value)] = (len(self._seen), value)  # kept, so that the id stays its own
        self._add(kind.__qualname__)
        if kind is types.CodeType:
            self._code(value)
        elif kind is types.ModuleType or isinstance(value, types.ModuleType):
            self._module(value)
        elif kind is types.FunctionType:
            self._function(value)
        elif isinstance(value, type):
            self._class(value)
        elif kind is list:
            self._all(value)
        elif kind is dict or kind is types.MappingProxyType:
            self._all(value.items())
        elif isinstance(value, (set, frozenset)):
            self._add(*sorted(self._apart(item) for item in value))
            self._fields(getattr(value, "__dict__", {}))
        elif kind is numpy.ndarray:
            self._add(repr(value.dtype), value.shape)
            self._visit(value.tolist() if value.dtype.hasobject else value.tobytes())
        elif kind is memoryview:
            self._add(value.format, value.shape, value.tobytes())
        elif kind is types.MethodType:
            self._all((value.__func__, value.__self__))
        elif isinstance(value, (staticmethod, classmethod)):
            self._visit(value.__func__)
        elif isinstance(value, functools.cached_property):
            self._visit(value.func)
        elif isinstance(value, property):
            self._all((value.fget, value.fset))
        else:
            self._pickled(value)

    def _all(self, values):
        self._add(len(values))
        for value in values:
            self._visit(value)

    def _fields(self, fields):
        for name in sorted(fields):
            self._add(name)
            self._visit(fields[name])

    def _apart(self, value):
        """The hash of a value whose place among others decides nothing."""
        other = _Fingerprint()
        other._seen, other._modules, other._names = dict(self._seen), self._modules, self._names
        other._visit(value)
        return other._hash.hexdigest()

    def _of_library(self, value):
        """Something of a library, by its name and the library's version."""
        self._add(value.__module__, value.__qualname__, _version(value.__module__))

    def _pickled(self, value):
        """Adds the data that pickle keeps of a value."""
        reduce = copyreg.dispatch_table.get(type(value))
        try:
            kept = reduce(value) if reduce else value.__reduce_ex__(4)
        except RecursionError:
            raise
        except Exception:
            raise _unseen(value) from None
        if isinstance(kept, str):
            self._global(value, kept)
        else:  # function, arguments, state, and iterators over items
            self._all([list(part) if i in (3, 4) and part is not None else part for i, part in enumerate(kept)])

    def _global(self, value, name):
        """A value of which pickle keeps a name alone."""
        module = pickle.whichmodule(value, name)
        try:
            found = operator.attrgetter(name)(sys.modules[module])
        except (AttributeError, KeyError):
            found = None
        if found is value and _is_library(module):
            self._add(module, name, _version(module))
        elif getattr(value, "__dict__", None):
            self._fields(vars(value))
        else:
            raise _unseen(value)

    def _class(self, value):
        if _is_library(value.__module__):
            self._of_library(value)
            return
        self._all((type(value), value.__bases__))
        self._fields({name: each for name, each in vars(value).items() if name not in _IDLE})

    def _module(self, module):
        name = module.__name__
        self._add(name)
        if _is_library(name):
            self._add(_version(name))
            return
        self._modules[name] = module
        file = pathlib.Path(getattr(module, "__file__", None) or "")
        self._add(file.read_bytes() if file.is_file() else "no source")

    def _named_in_modules(self):
        """Which attributes of the user's modules are meant cannot be seen: those that have a name that the code has."""
        done = set()
        while True:
            # What is visited may name more, and refer to more modules.
            found = sorted((module, name) for module, values in self._modules.items()
                           for name in self._names & vars(values).keys() if (module, name) not in done)
            if not found:
                return
            for module, name in found:
                self._add(module, name)
                self._visit(vars(self._modules[module])[name])
            done.update(found)

    def _function(self, function):
        # Those that a library makes as it runs have more to them than a name.
        if _is_library(function.__module__) and "<" not in function.__qualname__:
            self._of_library(function)
            return
        self._visit(function.__code__)
        self._all((function.__defaults__, function.__kwdefaults__, function.__dict__))
        for cell in function.__closure__ or ():
            if cell == types.CellType():  # not bound yet
                self._add("empty")
            else:
                self._visit(cell.cell_contents)
        for name in _names(function.__code__):
            if name in function.__globals__:
                self._add(name)
                self._visit(function.__globals__[name])
        for name, level in _imports(function.__code__):
            self._imported(name, level, function.__globals__.get("__package__"))

    def _imported(self, name, level, package):
        """Imports now what the law would import in flight."""
        try:
            module = importlib.import_module("." * level + name, package)
        except Exception:  # whatever it raises: the law will see
            self._add("cannot be imported", name)
        else:
            self._visit(module)

    def _code(self, code):
        self._names.update(code.co_names, (each for each in code.co_consts if isinstance(each, str)))
        self._add(code.co_code, getattr(code, "co_exceptiontable", b""), code.co_names, code.co_varnames, code.co_freevars,
                  code.co_cellvars, code.co_argcount, code.co_posonlyargcount, code.co_kwonlyargcount, code.co_flags)
        # A docstring decides nothing, but it cannot be told from another first constant.
        self._all(code.co_consts)


def _unseen(value):
    kind = f"{type(value).__module__}.{type(value).__qualname__}".removeprefix("builtins.")
    return refuse(f"law: it holds a '{kind}', whose state cannot be seen", "functions, and objects that pickle can keep")


def _codes(code):
    """A function's code, and that of those inside it."""
    yield code
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            yield from _codes(constant)


def _names(code):
    """Names of globals and attributes."""
    return sorted({name for each in _codes(code) for name in each.co_names})


def _imports(code):
    """(module, level) of each import."""
    found = set()
    for each in _codes(code):
        before = [None, None]  # IMPORT_NAME takes level and names, which are loaded before it
        for step in dis.get_instructions(each):
            if step.opname == "IMPORT_NAME":
                found.add((step.argval, before[0]))
            before = [before[1], step.argval]
    return sorted(found)
