"""Checks that no program holds a multiplication fused with an alternating addition and subtraction.

No source asks for one: it is what GCC 12's vectorisers make of neighbouring a * b - c and a * b + c, in spite of
-ffp-contract=off. fused.py finds whatever else a compiler fuses, but compiles a part of the product again for it.

usage: vectorised.py OBJDUMP PROGRAM...
"""
import re
import subprocess
import sys

import fused

ALTERNATING = re.compile(r"vfm(?:addsub|subadd)")


def holds_any(objdump, program):
    """Quickly: names in plain words and the places are asked for only of a program that holds one."""
    text = subprocess.run([objdump, "-d", "--no-show-raw-insn", program], check=True, text=True, capture_output=True).stdout
    return ALTERNATING.search(text) is not None


def check(objdump, programs):
    """Violations, one line each."""
    return [f"{program}: {function}: {count} × {instruction} that no source asks for"
            for program in programs if holds_any(objdump, program)
            for (function, instruction), count in fused.fused(fused.disassemble(objdump, program)).items()
            if ALTERNATING.match(instruction)]


if __name__ == "__main__":
    found = check(sys.argv[1], sys.argv[2:])
    print("\n".join(found))
    sys.exit(1 if found else 0)
