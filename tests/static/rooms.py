"""Every module is in the tables of the architecture page once, with what it never does, and nothing else is. Every path
that the page names is there.

    rooms.py REPOSITORY

The modules are those of the table of links (DISPERSA_LINKS_* in CMakeLists.txt).
"""
import pathlib
import re
import sys

import layering

PAGE = "services/docs/pages/architecture.md"


def modules_on_page(text):
    """The names of the rows of the tables with the head `| module | purpose | never |` that say something in every cell."""
    tables = re.findall(r"^\| module \| purpose \| never \|\n\|[-|]+\|\n((?:\|.*\n?)*)", text, re.MULTILINE)
    return [name for table in tables for name in re.findall(r"^\| `(\w+)` \| [^|]+ \| [^|]+ \|$", table, re.MULTILINE)]


def check(root):
    """The violations as lines of text."""
    modules = set(layering.link_table((root / "CMakeLists.txt").read_text()))
    text = (root / PAGE).read_text()
    listed = modules_on_page(text)
    paths = re.findall(r"`((?:core|services|idl|campaigns|docker|tests)/[\w./-]*)`", text)
    return ([f"{PAGE}: the module {name} of CMakeLists.txt is missing" for name in sorted(modules - set(listed))] +
            [f"{PAGE}: {name} is no module of CMakeLists.txt" for name in sorted(set(listed) - modules)] +
            [f"{PAGE}: {name} is listed {listed.count(name)} times" for name in sorted(set(listed))
             if listed.count(name) > 1] +
            [f"{PAGE}: {path} does not exist" for path in sorted(set(paths)) if not (root / path).exists()])


if __name__ == "__main__":
    found = check(pathlib.Path(sys.argv[1]))
    print("\n".join(found))
    sys.exit(1 if found else 0)
