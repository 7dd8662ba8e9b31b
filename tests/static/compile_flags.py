"""Checks that every source of the product is compiled under the floating-point contract.

usage: compile_flags.py REPOSITORY COMPILE_COMMANDS.json
"""
import json
import pathlib
import shlex
import sys

from product_sources import name_of

MARCH = "-march=x86-64-v3"
# Sources of lanes (core/math/lanes.h) are compiled for this one as well; the program chooses at its start.
LANES, LANES_MARCH = "-DDISPERSA_WIDTHS=", "-march=x86-64-v4"
CONTRACTION = "-ffp-contract=off"
# GCC 12's vectorisers fuse a*b-c and a*b+c in spite of -ffp-contract=off (fused.py).
VECTORISERS = "-fno-tree-vectorize"
# What lets a compiler change values.
FORBIDDEN = {
    "-ffast-math", "-Ofast", "-funsafe-math-optimizations", "-fassociative-math", "-freciprocal-math",
    "-ffinite-math-only", "-fno-signed-zeros", "-fno-trapping-math", "-fcx-limited-range",
    "-fsingle-precision-constant", "-mrecip", "-mfpmath=387", "-fopenmp",
    "-ftree-vectorize", "-ftree-slp-vectorize", "-ftree-loop-vectorize",
}


def violations(arguments):
    """What is wrong with one compiler command. The last of repeated options counts."""
    found = sorted(FORBIDDEN.intersection(arguments))
    march = [a for a in arguments if a.startswith("-march=")]
    contraction = [a for a in arguments if a.startswith("-ffp-contract=")]
    in_lanes = any(a.startswith(LANES) for a in arguments)
    if not march or march[-1] not in ((MARCH, LANES_MARCH) if in_lanes else (MARCH,)):
        found.append(f"lacks {MARCH}")
    if not contraction or contraction[-1] != CONTRACTION:
        found.append(f"lacks {CONTRACTION}")
    if VECTORISERS not in arguments:
        found.append(f"lacks {VECTORISERS}")
    return found


def check(root, commands):
    """Violations, one line each; `commands` is the parsed compile_commands.json."""
    problems, seen = [], 0
    for entry in commands:
        name = name_of(entry, root)
        if name is None:
            continue
        seen += 1
        for violation in violations(shlex.split(entry["command"])):
            problems.append(f"{name}: {violation}")
    return problems if seen else ["no source of core/ in compile_commands.json"]


if __name__ == "__main__":
    found = check(pathlib.Path(sys.argv[1]), json.loads(pathlib.Path(sys.argv[2]).read_text()))
    print("\n".join(found))
    sys.exit(1 if found else 0)
