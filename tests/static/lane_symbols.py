"""Checks that code for a newer instruction set cannot replace common code.

An inline function that two objects hold is kept once, whichever: one that was compiled for AVX-512 would then run on a
processor without it. So an object of the engine for v4 may define such functions only in the namespaces that are its
own (core/math/lanes.h).

usage: lane_symbols.py NM OBJECT...
"""
import re
import subprocess
import sys

# Weak and unique symbols: what the linker merges.
MERGED = re.compile(r"^[0-9a-f]+ ([WVu]) (.*)$")
OWN = re.compile(r"dispersa::lanes::v4::")
# Not code: the address of the exception handling of the C++ library.
HARMLESS = re.compile(r"^DW\.ref\.__gxx_personality_v0$")


def shared(listing):
    """The merged symbols of `nm -C` that belong to everybody."""
    found = [match.group(2) for match in map(MERGED.match, listing.splitlines()) if match]
    return [name for name in found if not OWN.search(name) and not HARMLESS.match(name)]


def check(nm, objects):
    """Violations, one line each."""
    problems = []
    for path in objects:
        listing = subprocess.run([nm, "-C", path], check=True, text=True, capture_output=True).stdout
        problems += [f"{path}: {name}: is compiled for v4 and may be taken for everybody's" for name in shared(listing)]
    return problems if objects else ["no object to look at"]


if __name__ == "__main__":
    found = check(sys.argv[1], sys.argv[2:])
    print("\n".join(found))
    sys.exit(1 if found else 0)
