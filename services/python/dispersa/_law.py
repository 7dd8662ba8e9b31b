"""The name and hash of a control law written in Python.

A campaign that is flown with one is not the campaign without it, nor that with another one, so the law's hash goes into the
flight id. It is taken over what can be seen to decide what the law does: its bytecode, defaults, closure and constants, the
globals and attributes that it names, and functions and objects among these in turn. Libraries go in by name and version.
What a law reads from elsewhere, and what it changes as it flies, cannot be seen.
"""
import functools
import hashlib
import os
import sys
import sysconfig
import types

import numpy

_LIBRARIES = tuple({os.path.realpath(path) + os.sep for key, path in sysconfig.get_paths().items() if "lib" in key})


def identity(law):
    """(name, SHA-256 in hexadecimal) of a callable."""
    return name_of(law), _Fingerprint().of(law)


def name_of(law):
    """As a report names it."""
    while isinstance(law, functools.partial):
        law = law.func
    return getattr(law, "__qualname__", type(law).__qualname__)


def _is_library(module_name):
    """Whether a module is the interpreter's own or installed beside it, by its name."""
    top = sys.modules.get((module_name or "builtins").partition(".")[0])
    file = getattr(top, "__file__", None)
    if file is None:
        return module_name != "__main__"
    file = os.path.realpath(file)
    return file.startswith(_LIBRARIES) or f"{os.sep}dist-packages{os.sep}" in file or f"{os.sep}site-packages{os.sep}" in file


class _Fingerprint:
    """A hash over values and what they refer to, each of them once."""

    def __init__(self):
        self._hash = hashlib.sha256()
        self._seen = {}

    def of(self, law):
        self._add("python", sys.implementation.cache_tag)
        self._visit(law)
        return self._hash.hexdigest()

    def _add(self, *texts):
        for text in texts:
            data = text if isinstance(text, bytes) else str(text).encode()
            self._hash.update(len(data).to_bytes(8, "little") + data)

    def _visit(self, value):
        if value is None or isinstance(value, (bool, int, float, complex, str, bytes, type(Ellipsis), numpy.generic)):
            self._add(type(value).__name__, repr(value))
            return
        if id(value) in self._seen:
            self._add("again", self._seen[id(value)][0])
            return
        self._seen[id(value)] = (len(self._seen), value)  # kept, so that the id stays its own
        self._add(type(value).__qualname__)
        if isinstance(value, types.CodeType):
            self._code(value)
        elif isinstance(value, numpy.ndarray) and not value.dtype.hasobject:
            self._add(value.dtype.str, value.shape, value.tobytes())
        elif isinstance(value, (list, tuple)):
            self._all(value)
        elif isinstance(value, (set, frozenset)):
            self._add(*sorted(_Fingerprint().of(item) for item in value))
        elif isinstance(value, dict):
            for key, item in value.items():
                self._all((key, item))
        elif isinstance(value, functools.partial):
            self._all((value.func, value.args, value.keywords))
        elif isinstance(value, types.MethodType):
            self._all((value.__func__, value.__self__))
        elif isinstance(value, (staticmethod, classmethod)):
            self._visit(value.__func__)
        elif isinstance(value, property):
            self._all((value.fget, value.fset))
        elif isinstance(value, types.ModuleType):
            self._add(value.__name__, getattr(value, "__version__", ""))
        elif isinstance(value, types.FunctionType) and not _is_library(value.__module__):
            self._function(value)
        elif isinstance(value, type) and not _is_library(value.__module__):
            self._all(value.__bases__)
            self._fields({name: each for name, each in vars(value).items() if name not in ("__dict__", "__weakref__", "__doc__")})
        else:
            self._add(getattr(value, "__module__", "") or "", getattr(value, "__qualname__", ""))
            if not isinstance(value, (type, types.FunctionType, types.BuiltinFunctionType)):
                self._visit(type(value))
                self._fields(getattr(value, "__dict__", {}))
                self._fields({name: getattr(value, name) for cls in type(value).__mro__
                              for name in _slots(cls) if hasattr(value, name)})

    def _all(self, values):
        self._add(len(values))
        for value in values:
            self._visit(value)

    def _fields(self, fields):
        for name in sorted(fields):
            self._add(name)
            self._visit(fields[name])

    def _function(self, function):
        self._visit(function.__code__)
        self._all((function.__defaults__, function.__kwdefaults__))
        for cell in function.__closure__ or ():
            try:
                self._visit(cell.cell_contents)
            except ValueError:  # not bound yet
                self._add("empty")
        names = _names(function.__code__)
        for name in names:
            value = function.__globals__.get(name)
            if name in function.__globals__:
                self._add(name)
                self._visit(value)
            if isinstance(value, types.ModuleType) and not _is_library(value.__name__):
                # Which of its attributes are meant cannot be seen: those that have a name that the code has.
                self._fields({each: vars(value)[each] for each in names if each in vars(value)})

    def _code(self, code):
        self._add(code.co_code, code.co_names, code.co_varnames, code.co_freevars, code.co_argcount,
                  code.co_kwonlyargcount, code.co_flags)
        # A docstring decides nothing, but it cannot be told from another first constant.
        self._all(code.co_consts)


def _names(code):
    """Of globals and attributes, in a function and those inside it."""
    names = set(code.co_names)
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            names |= set(_names(constant))
    return sorted(names)


def _slots(cls):
    slots = vars(cls).get("__slots__", ())
    return (slots,) if isinstance(slots, str) else slots
