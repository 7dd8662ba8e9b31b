"""Checks that docker/runtime-packages.txt names the packages of the libraries that the programs load, no more
and no fewer.

usage: runtime_packages.py LIST PROGRAM...
"""
import pathlib
import re
import subprocess
import sys

# The packages on the list depend on them: what runs C++ at all, and the core of SUNDIALS 7.
BASE = {"libc6", "libgcc-s1", "libstdc++6", "libsundials-core7", "libopenmpi40"}


def listed_packages(text):
    """The lines of a list with comments: the names that a package has on one system or another."""
    lines = re.sub(r"#.*", "", text).splitlines()
    return {frozenset(re.split(r"[\s|]+", line.strip())) for line in lines if line.strip()}


def needed_libraries(program):
    """Names of the libraries that a program asks the loader for."""
    output = subprocess.run(["readelf", "--dynamic", program], check=True, text=True, capture_output=True).stdout
    return set(re.findall(r"\(NEEDED\).*\[(.*)\]", output))


def owners(libraries):
    """{library: the Debian package of it for x86-64 programs, or None}. One question for all: each reads every package's list."""
    found = subprocess.run(["dpkg-query", "--search", *(f"*/x86_64-linux-gnu/{library}" for library in sorted(libraries))], text=True,
                           capture_output=True).stdout
    packages = {}
    for line in found.splitlines():
        packages.setdefault(line.rpartition("/")[2], line.split(":")[0])
    return {library: packages.get(library) for library in libraries}


def check(listed, needed):
    """Violations, one line each; `needed` maps libraries to packages."""
    problems = [f"{library} belongs to {package or 'no package'}, which is not listed"
                for library, package in sorted(needed.items()) if package not in BASE.union(*listed)]
    return problems + [f"{' | '.join(sorted(names))} is listed but no program loads it"
                       for names in sorted(listed, key=sorted) if names.isdisjoint(needed.values())]


if __name__ == "__main__":
    libraries = set().union(*(needed_libraries(program) for program in sys.argv[2:]))
    found = check(listed_packages(pathlib.Path(sys.argv[1]).read_text()), owners(libraries))
    print("\n".join(found))
    sys.exit(1 if found else 0)
