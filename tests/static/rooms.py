"""Every room is in the tables of the architecture page once, and nothing else is.

    rooms.py REPOSITORY

The rooms are those of the table of links (DISPERSA_LINKS_* in CMakeLists.txt).
"""
import pathlib
import re
import sys

import layering

PAGE = "services/docs/pages/architecture.md"


def rooms_on_page(text):
    """The first cells of the tables with the head `| room | purpose |`, in their order."""
    tables = re.findall(r"^\| room \| purpose \|\n\|[-|]+\|\n((?:\|.*\n?)*)", text, re.MULTILINE)
    return [name for table in tables for name in re.findall(r"^\| `(\w+)` \|", table, re.MULTILINE)]


def check(root):
    """The violations as lines of text."""
    rooms = set(layering.link_table((root / "CMakeLists.txt").read_text()))
    listed = rooms_on_page((root / PAGE).read_text())
    return ([f"{PAGE}: the room {name} of CMakeLists.txt is missing" for name in sorted(rooms - set(listed))] +
            [f"{PAGE}: {name} is no room of CMakeLists.txt" for name in sorted(set(listed) - rooms)] +
            [f"{PAGE}: {name} is listed {listed.count(name)} times" for name in sorted(set(listed))
             if listed.count(name) > 1])


if __name__ == "__main__":
    found = check(pathlib.Path(sys.argv[1]))
    print("\n".join(found))
    sys.exit(1 if found else 0)
