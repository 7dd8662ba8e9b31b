"""Files, and dicts that stand in for files."""
import collections.abc
import contextlib
import dataclasses
import json
import os
import pathlib

from . import _core
from .errors import BadInput


class Tree(dict):
    """The content of a file, to be read and edited: dicts, lists, numbers, texts. `folder`: the folder to which file names
    in it are relative."""

    folder = "."

    def __or__(self, other):
        merged = super().__or__(other)
        return merged if merged is NotImplemented else _in_folder(merged, self.folder)

    def copy(self):
        """A shallow copy with the same folder."""
        return self | {}


def _in_folder(value, folder):
    tree = Tree(value)
    tree.folder = folder
    return tree


def read(path, inlined=False):
    """Reads a file of any kind as a Tree of dicts, lists and scalars.

    `inlined`: the contents of the named files replace their names, so that an autopilot's gains or a stage's masses can be
    edited too. Raises BadInput for a file that is not YAML, or not a map of keys.
    """
    value = _core.read_tree(os.fspath(path), inlined)
    if not isinstance(value, dict):
        raise BadInput([(os.fspath(path), 1, 1, "", "is no map of keys", "a campaign, vehicle, reference, autopilot or scenario")])
    return _in_folder(value, os.path.dirname(os.path.abspath(path)))


def _plain(value):
    """NumPy's scalars and arrays, tuples, paths and what is like a dict as what JSON has."""
    if isinstance(value, collections.abc.Mapping):
        return dict(value)
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise TypeError(f"{type(value).__name__} has no place in a file")


def text_of(tree):
    """A dict as text that YAML reads, every number as the shortest that reads back to the same bits."""
    try:
        text = json.dumps(tree, default=_plain, ensure_ascii=False, allow_nan=False, indent=1) + "\n"
        text.encode()
        return text
    except (TypeError, ValueError, RecursionError) as error:
        raise BadInput(f"the campaign is no tree of dicts, lists, texts and finite numbers: {error}") from None


def source(what, base=None):
    """(name, text or None) of a path, a dict, or a Campaign."""
    if hasattr(what, "canonical_yaml"):
        return what.name, what.canonical_yaml
    if isinstance(what, collections.abc.Mapping):
        folder = pathlib.Path(base if base is not None else getattr(what, "folder", "."))
        return str(folder / "<dict>"), text_of(what)
    return os.fspath(what), None


def without_place(problem, name, text):
    """A problem of a dict: its path tells where, not a line of the text that stands in for it."""
    return dataclasses.replace(problem, line=0, column=0) if text is not None and problem.file == name else problem


@contextlib.contextmanager
def placed(name, text):
    """Problems of a dict are raised without lines."""
    try:
        yield
    except BadInput as error:
        raise BadInput([without_place(problem, name, text) for problem in error.problems]) from None


def write(tree, path):
    """Writes a tree as a YAML file for `dispersa`. File names in it are not changed; they are relative to the file's folder.
    Raises BadInput for a value that a file cannot hold, and OSError if the file cannot be written."""
    pathlib.Path(path).write_text(text_of(tree), encoding="utf-8")
