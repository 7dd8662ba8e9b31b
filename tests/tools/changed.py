#!/usr/bin/env python3
"""Tests that a change can reach, the nearest first.

    changed.py targets BUILD [COMMIT]    what ninja has to build for them
    changed.py tests BUILD [COMMIT]      their numbers, as `ctest -I` takes them; on stderr which are left out

The change is that of the work tree since COMMIT (default: HEAD). A source of tests, or a script, uses the rooms whose headers
it includes, or whose programs it starts (STARTED). It is reached by a changed room that one of these links, directly or
through others (DISPERSA_LINKS_* in CMakeLists.txt). Its distance is the number of links between. The nearest run, up to
SECONDS on all cores by the times of earlier runs; `tests/run` alone runs all.
"""
import collections
import json
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/static"))
import layering  # noqa: E402

SECONDS = 75
NEVER_FLOWN_S = 1.0  # of a test of which no time is known
PROGRAMS = ["dispersa", "dispersa-coordinator", "dispersa-foreign", "dispersa-worker"]
# Rooms at the top of what the scripts of a folder start, and what has to be built for them.
STARTED = {
    "distributed": (["cli", "coordinator", "worker"], [*PROGRAMS, "noop_worker", "faulty_worker", "security_probe"]),
    "plugins": (["cli", "foreign", "worker", "containment"], PROGRAMS),
    "python": (["python"], [*PROGRAMS, "python"]),
    "install": (["cli", "coordinator", "python"], ["all"]),
    "docs": (["cli", "coordinator", "worker"], PROGRAMS),
    "unit": (["cli"], PROGRAMS),
    "compilers": (["cases", "campaign_yaml"], ["same_flights", "engine_library"]),
}
ALWAYS = "static"  # a folder whose checks read the sources themselves
LONG = "long"

Group = collections.namedtuple("Group", "file distance")


def changed_files(root, commit):
    def git(*arguments):
        return subprocess.run(["git", "-c", "safe.directory=*", "-C", root, *arguments], check=True, text=True,
                              capture_output=True).stdout.split("\0")[:-1]
    return git("diff", "--name-only", "-z", commit, "--") + git("ls-files", "--others", "--exclude-standard", "-z")


def room_of(file):
    """The room of a source of the product; None for other files."""
    parts = pathlib.PurePath(file).parts
    if file.endswith(".md"):
        return None
    if parts[0] == "idl":
        return "idl"
    return parts[1] if parts[0] in ("core", "services") and len(parts) > 2 else None


def distances(table, room):
    """{room: links between}, of each room that this one links, and 0 of itself."""
    found, layer = {}, {room}
    while layer:
        found.update(dict.fromkeys(layer, 1 + max(found.values(), default=-1)))
        layer = {link for each in layer for link in table.get(each, ())} - set(found)
    return found


def included(root, file, seen=None):
    """Rooms whose headers a source of tests includes, itself or through headers of tests, and those headers."""
    seen = set() if seen is None else seen
    rooms = set()
    for name in re.findall(r'^\s*#include "([^"]+)"', (root / file).read_text(), re.M):
        if name.startswith("tests/") or (root / file).parent.joinpath(name).is_file():
            header = name if name.startswith("tests/") else str(pathlib.PurePath(file).parent / name)
            if header not in seen and (root / header).is_file():
                seen.add(header)
                rooms |= included(root, header, seen)[0]
        else:
            rooms |= {room_of(name)} - {None}
    return rooms, seen


def imported(root, file, seen=None):
    """Scripts beside a script that it imports."""
    seen = set() if seen is None else seen
    for name in re.findall(r"^(?:import|from) (\w+)", (root / file).read_text(), re.M):
        beside = str(pathlib.PurePath(file).parent / f"{name}.py")
        if beside not in seen and (root / beside).is_file():
            seen.add(beside)
            imported(root, beside, seen)
    return seen


def reached(root, table, files, sources):
    """A Group of each source of tests that the changed files reach, the nearest first."""
    rooms = {room_of(file) for file in files} - {None}
    # Build files, campaigns, data and tools: who reads them is not known.
    is_any = any(not room_of(file) and not file.startswith("tests/") and not file.endswith(".md") for file in files)
    is_any = is_any or any(re.match(r"tests/(data|plugins/law\.c|tools/|CMakeLists|suites\.cmake)", file) for file in files)
    links = {room: distances(table, room) for room in table}
    groups = []
    for source in sources:
        folder = pathlib.PurePath(source).parts[1]
        if source.endswith(".cc"):
            used, with_it = included(root, source)
            if folder == "unit":  # <room>_<topic>_test.cc: it may use the whole program by its name alone
                name = pathlib.PurePath(source).name
                used |= {"cli"} if name.startswith("cli_") else set()
        else:
            used, with_it = set(STARTED.get(folder, ([], []))[0]), imported(root, source)
        found = [links[room][to] for room in used for to in rooms if to in links.get(room, {})]
        if source in files or with_it & set(files) or folder == ALWAYS:
            found.append(0)
        if folder == "docs" and any(file.endswith(".md") for file in files):
            found.append(0)
        if is_any:
            found.append(9)
        if found:
            groups.append(Group(source, min(found)))
    return sorted(groups, key=lambda group: (group.distance, group.file))


def within(groups, seconds_of, seconds):
    """The nearest groups whose tests take so many seconds in all; of one distance the shortest first, at least the nearest."""
    kept, sum_s = [], 0.0
    for group in sorted(groups, key=lambda group: (group.distance, seconds_of(group.file))):
        sum_s += seconds_of(group.file)
        if sum_s <= seconds or not kept:
            kept.append(group)
    return kept


class Tests:
    """The tests that ctest knows in a build folder, each with its source."""

    def __init__(self, root, build):
        listed = subprocess.run(["ctest", "--test-dir", build, "--show-only=json-v1"], check=True, capture_output=True, text=True)
        self.suites = {}
        for source in sorted((root / "tests").glob("*/*_test.cc")):
            for suite in re.findall(r"^(?:TYPED_)?TEST(?:_F|_P)?\((\w+),", source.read_text(), re.M):
                self.suites.setdefault(f"{source.parent.name}.{suite}", str(source.relative_to(root)))
        costs = build / "Testing/Temporary/CTestCostData.txt"
        self.cost_s = {}
        for line in costs.read_text().split("---")[0].splitlines() if costs.exists() else ():
            name, _, seconds = line.rsplit(" ", 2)
            self.cost_s[name] = float(seconds)
        self.of = collections.defaultdict(list)  # (number, name) by source
        for number, test in enumerate(json.loads(listed.stdout)["tests"], 1):
            labels = next((each["value"] for each in test.get("properties", []) if each["name"] == "LABELS"), [])
            if LONG not in labels:
                self.of[self.source_of(root, test)].append((number, test["name"]))
        self.of.pop(None, None)

    def source_of(self, root, test):
        for word in map(str, test.get("command", [])):
            if word.endswith((".py", "same_flights_from", "tests/format")) and str(root / "tests") in word:
                return os.path.relpath(word, root)
            if word.endswith("/same_flights"):  # with the engine of another compiler
                return "tests/compilers/same_flights_from"
        label, _, rest = test["name"].partition(".")
        return next((self.suites[f"{label}.{word}"] for word in re.split(r"[./]", rest) if f"{label}.{word}" in self.suites), None)

    def seconds_of(self, source):
        return sum(self.cost_s.get(name, NEVER_FLOWN_S) for _, name in self.of[source])


def targets_of(groups):
    found = set()
    for group in groups:
        folder = pathlib.PurePath(group.file).parts[1]
        if group.file.endswith(".cc"):
            found.add(f"{folder}_tests")
        elif folder != ALWAYS:
            found.update(STARTED.get(folder, ([], PROGRAMS))[1])
    return sorted(found)


def main():
    what, build, commit = sys.argv[1], pathlib.Path(sys.argv[2]), (sys.argv[3:] or ["HEAD"])[0]
    files = changed_files(ROOT, commit)
    tests = Tests(ROOT, build)
    groups = reached(ROOT, layering.link_table((ROOT / "CMakeLists.txt").read_text()), files, sorted(tests.of)) if files else []
    kept = within(groups, tests.seconds_of, SECONDS * 2 * (os.cpu_count() or 1))
    if what == "targets":
        print(" ".join(targets_of(kept)))
        return
    print("0,0,0," + ",".join(str(number) for group in kept for number, _ in tests.of[group.file]) if kept else "none")
    left = collections.Counter(pathlib.PurePath(group.file).parts[1] for group in set(groups) - set(kept))
    print(f"{len(files)} changed files reach {len(groups)} of {len(tests.of)} sources of tests"
          + (f"; left to tests/run, as farther away: {', '.join(f'{n} of {folder}' for folder, n in sorted(left.items()))}"
             if left else ""), file=sys.stderr)


if __name__ == "__main__":
    main()
