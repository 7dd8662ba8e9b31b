"""Checks that no object of the product fuses a multiplication and an addition, except where its source says so.

A source fuses by `Fma` of core/math, which under -DDISPERSA_NO_FMA is `a * b + c`. So whatever is fused in an
object must be gone when the same command compiles the same source with that definition: what is left was
fused by the compiler, or by an intrinsic of which the sources know nothing.

usage: fused.py REPOSITORY COMPILE_COMMANDS.json OBJDUMP [LAUNCHER]
"""
import collections
import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

from product_sources import name_of

# vfmadd231sd, vfnmsub132pd, vfmaddsub213ps, ... and AMD's vfmaddpd.
FUSED = re.compile(r"^\s*[0-9a-f]+:\s+(?:\{\w+\} )?(vfn?m(?:add|sub|addsub|subadd)\w*)\s")
FUNCTION = re.compile(r"^[0-9a-f]+ <(.*)>:$")


def fused(disassembly):
    """{(function, instruction): how often} of what `objdump -d` printed."""
    found, function = collections.Counter(), "?"
    for line in disassembly.splitlines():
        if match := FUNCTION.match(line):
            function = match.group(1)
        elif match := FUSED.match(line):
            found[function, match.group(1)] += 1
    return found


def disassemble(objdump, path):
    return subprocess.run([objdump, "-d", "-C", "--no-show-raw-insn", path],
                          check=True, text=True, capture_output=True).stdout


def unfused(arguments, output):
    """The compiler command that computes Fma in two roundings and writes `output`."""
    changed = list(arguments)
    changed[changed.index("-o") + 1] = str(output)
    return changed + ["-DDISPERSA_NO_FMA"]


def left_fused(entry, objdump, launcher):
    """What is fused in an object although its source did not ask for it; None if there is no object."""
    directory, arguments = pathlib.Path(entry["directory"]), shlex.split(entry["command"])
    compiled = directory / arguments[arguments.index("-o") + 1]
    if not compiled.exists():
        return None
    if not fused(disassemble(objdump, compiled)):
        return {}
    with tempfile.TemporaryDirectory() as folder:
        again = pathlib.Path(folder) / "unfused.o"
        subprocess.run([*launcher, *unfused(arguments, again)], cwd=directory, check=True)
        return fused(disassemble(objdump, again))


def check(root, commands, objdump, launcher=()):
    """Violations, one line each; `commands` is the parsed compile_commands.json."""
    entries = {}
    for entry in commands:
        if (name := name_of(entry, root)) is not None:
            entries.setdefault(name, []).append(entry)
    if not entries:
        return ["no source of core/ in compile_commands.json"]
    problems = []
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        pending = [(name, pool.submit(left_fused, entry, objdump, launcher))
                   for name, same in entries.items() for entry in same]
        for name, left in pending:
            if left.result() is None:
                problems.append(f"{name}: is not built, so nothing is known about it")
                continue
            problems += [f"{name}: {function}: {count} × {instruction} that the source did not ask for"
                         for (function, instruction), count in left.result().items()]
    return problems


if __name__ == "__main__":
    found = check(pathlib.Path(sys.argv[1]), json.loads(pathlib.Path(sys.argv[2]).read_text()), sys.argv[3],
                  sys.argv[4:])
    print("\n".join(found))
    sys.exit(1 if found else 0)
