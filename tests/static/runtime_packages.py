"""Checks that docker/runtime-packages.txt names the packages of the libraries that the programs load, no more
and no fewer.

usage: runtime_packages.py LIST PROGRAM...
"""
import pathlib
import re
import subprocess
import sys

# In every Debian image that runs C++ at all; the packages on the list depend on them.
BASE = {"libc6", "libgcc-s1", "libstdc++6"}


def listed_packages(text):
    """Package names of a list with comments."""
    return set(re.sub(r"#.*", "", text).split())


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
                for library, package in sorted(needed.items()) if package not in listed | BASE]
    return problems + [f"{package} is listed but no program loads it"
                       for package in sorted(listed - set(needed.values()))]


if __name__ == "__main__":
    libraries = set().union(*(needed_libraries(program) for program in sys.argv[2:]))
    found = check(listed_packages(pathlib.Path(sys.argv[1]).read_text()), owners(libraries))
    print("\n".join(found))
    sys.exit(1 if found else 0)
