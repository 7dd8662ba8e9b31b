"""Writes the tutorial as a notebook, with what each of its cells prints and draws:

    notebook.py OUT.ipynb

Run it with the package on PYTHONPATH, in the folder that has `campaigns/`. Packages: python3-nbformat, python3-nbclient,
python3-ipykernel.
"""
import os
import pathlib
import sys

import nbclient
import nbformat

from cells import cells

TUTORIAL = pathlib.Path(__file__).with_name("tutorial.py")


def notebook():
    """The notebook, not yet executed. Names of cells are their numbers, so that two are equal."""
    new = {True: nbformat.v4.new_markdown_cell, False: nbformat.v4.new_code_cell}
    made = nbformat.v4.new_notebook(cells=[new[is_text](body) for is_text, body in cells(TUTORIAL.read_text(encoding="utf-8"))])
    made.metadata.kernelspec = {"name": "python3", "display_name": "Python 3", "language": "python"}
    for number, cell in enumerate(made.cells):
        cell.id = f"cell-{number}"
    return made


if __name__ == "__main__":
    os.environ["PYDEVD_DISABLE_FILE_VALIDATION"] = "1"  # or each kernel prints a warning of the debugger
    book = nbclient.NotebookClient(notebook(), timeout=600, record_timing=False).execute()
    nbformat.write(book, sys.argv[1])
