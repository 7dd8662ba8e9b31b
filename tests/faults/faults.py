"""Puts the faults of faults.yaml into a copy of the sources and sees the test of each die of it.

usage: faults.py BUILD WORK_FOLDER [PATTERN]           every fault, or those in whose name or file the regular expression is found
       faults.py BUILD WORK_FOLDER --draw COUNT SEED   so many, drawn from all
       faults.py --check                               whether each fault still fits its file and names a test that exists
BUILD is a configured build folder, whose compiler and options the copy takes. One build has all faults that can be
switched on at run time (switch.py); the others, and those whose test reads the sources, are put in one at a time. Exit
code 0: every test died of its fault and passed without it.
"""
import concurrent.futures
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import time
import zlib

import yaml

from switch import with_switches

ROOT = pathlib.Path(__file__).resolve().parents[2]
KEPT = ["CMakeLists.txt", "core", "idl", "services", "docker", "campaigns", "tests"]  # what a build reads
BUILD_LIMIT_S = 1800
SWITCHED_BUILD_LIMIT_S = 7200
TEST_LIMIT_S = 900
PATIENCE = (60.0, 10.0)  # with a fault a test takes at most so many seconds, and so often its time without


def all_faults():
    return yaml.safe_load((pathlib.Path(__file__).parent / "faults.yaml").read_text())


def change_of(fault):
    """The file's text, and (begin, end, new text) of the fault; an error where `from` does not stand there exactly once.
    Where the lines of `from` break does not matter: the formatter decides that."""
    pattern = r"\s+".join(map(re.escape, fault["from"].split())).replace(r"\(", r"\(\s*")
    before, after = re.match(r"\s*", fault["from"]).group(), re.search(r"\s*$", fault["from"]).group()
    text = (ROOT / fault["file"]).read_text()
    found = list(re.finditer(f"{re.escape(before)}{pattern}{re.escape(after)}", text))
    if len(found) != 1:
        raise ValueError(f"{fault['fault']}: its text stands {len(found)} times in {fault['file']}")
    return text, (found[0].start(), found[0].end(), fault["to"])


def with_fault(fault):
    text, (begin, end, new) = change_of(fault)
    return text[:begin] + new + text[end:]


def number_of(fault):
    """Of its name, so that another entry changes no source but its own."""
    return zlib.crc32(fault["fault"].encode()) & 0x7FFFFFFF


def problems_of(fault):
    problems = []
    try:
        with_fault(fault)
    except ValueError as error:
        problems.append(str(error))
    if "script" in fault:
        script = ROOT / "tests" / fault["script"]
        if not script.exists():
            problems.append(f"{fault['fault']}: no script {fault['script']}")
        elif "test" in fault and f"    def {fault['test'].rpartition('.')[2]}(self" not in script.read_text():
            problems.append(f"{fault['fault']}: no test {fault['test']} in {fault['script']}")
        return problems
    source = test_source(fault["program"])
    text = source.read_text() if source.exists() else ""
    for test in fault["test"].split(":"):
        suite, _, case = test.removeprefix("*").partition(".")  # * before the suite: its parameters
        declared = rf"^(TYPED_)?TEST(_F|_P)?\({suite}, {'' if case == '*' else case + chr(92) + ')'}"
        if not re.search(declared, text, re.M):
            problems.append(f"{fault['fault']}: no test {test} in {source.relative_to(ROOT)}")
    return problems


def cached(build, name):
    found = re.search(rf"^{name}:\w+=(.*)", (build / "CMakeCache.txt").read_text(), re.M)
    return found.group(1) if found else ""


def quiet(*command, limit_s, env=None):
    """Exit code and what was printed; -1 if it took too long, with the processes that it started."""
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace", env=env,
                          start_new_session=True) as process:
        try:
            text, _ = process.communicate(timeout=limit_s)
            return process.returncode, text
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            return -1, "took too long"


def mirror(origin, target, text_of):
    """Makes `target` like `origin`, with text_of(file) in place of a file's text where that is not None. What is the same
    already keeps its time: the object of a fault that was taken out again is older than its source and must stay so."""
    files = [origin] if origin.is_file() else [file for file in origin.rglob("*") if file.is_file()]
    wanted = {target / file.relative_to(origin) for file in files} if origin.is_dir() else {target}
    for stale in set(target.rglob("*")) - wanted if target.is_dir() else ():
        if stale.is_file():
            stale.unlink()
    for file in files:
        copy = target / file.relative_to(origin) if origin.is_dir() else target
        text = text_of(file)
        wanted_bytes = file.read_bytes() if text is None else text.encode()
        if not copy.is_file() or copy.read_bytes() != wanted_bytes:
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_bytes(wanted_bytes)
            shutil.copymode(file, copy)


class Copy:
    """The sources and a build of their own, of two engines; with further options of CMake."""

    def __init__(self, build, work, *options, text_of=lambda file: None):
        self.source, self.build = work, work / "build/release"  # as the sources have it, so that a cache serves both
        self.python = cached(build, "DISPERSA_PYTHON") or sys.executable  # the package's module is one interpreter's
        self.mirror(text_of)
        code, text = quiet("cmake", "-S", self.source, "-B", self.build, "-G", "Ninja",
                           *(f"-D{name}={cached(build, name)}" for name in ("CMAKE_BUILD_TYPE", "CMAKE_CXX_COMPILER")),
                           "-DDISPERSA_BUILD_TESTS=ON", "-DDISPERSA_ENGINES=v3 1;v3 4", *options,
                           limit_s=BUILD_LIMIT_S)
        if code != 0:
            raise RuntimeError(text)

    def mirror(self, text_of):
        for name in KEPT:
            mirror(ROOT / name, self.source / name, text_of)

    def problem_of_build(self, *targets, limit_s=BUILD_LIMIT_S):
        code, text = quiet("cmake", "--build", self.build, "--target", *targets, "--", "-k", "0", limit_s=limit_s)
        return "" if code == 0 else f"does not build: {text}"

    def outcome(self, program, test, script, number=0, limit_s=TEST_LIMIT_S):
        """"passes", "dies", or why neither can be said; and in how many seconds. With the fault of that number."""
        env = {**os.environ, "DISPERSA_FAULT": str(number), "DISPERSA_BINARIES": str(self.build / "bin"),
               "PYTHONPATH": str(self.build / "python"), "DISPERSA_PYTHON_SOURCES": str(self.source / "services/python"),
               "DISPERSA_CAMPAIGNS": str(self.source / "campaigns"), "DISPERSA_SOURCE": str(self.source),
               "DISPERSA_BUILD": str(self.build)}
        if script and test:
            command = [self.python, "-B", self.source / "tests" / script, test]
        elif script:
            command = [sys.executable, "-B", self.source / "tests" / script, self.build, "clang++-16"]
        else:
            command = [self.build / "tests" / program, f"--gtest_filter={test}"]
        start = time.monotonic()
        code, text = quiet(*command, limit_s=limit_s, env=env)
        if "Running 0 tests from 0 test suites" in text:
            return f"no test {test}", 0.0
        return "passes" if code == 0 else "dies", time.monotonic() - start


class Switched:
    """A copy whose build has every fault that can be switched on at run time. Of the tests it has those that are run."""

    def __init__(self, build, work, faults):
        self.faults = {number_of(fault): fault for fault in faults
                       if fault["file"].endswith((".cc", ".h")) and not reads_sources(fault)}
        self.tests = {test_source(fault["program"]) for fault in faults if "script" not in fault}
        self.lines = {}  # of each file those that are there because of faults
        self.copy = Copy(build, work, f"-DCMAKE_CXX_FLAGS=-w -include {work / 'tests/faults/fault_switch.h'}",
                         "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG", text_of=self.text_of)

    def text_of(self, file):
        if file.name.endswith("_test.cc") and file not in self.tests:
            return ""
        name = str(file.relative_to(ROOT))
        changes = {number: change_of(fault)[1] for number, fault in self.faults.items() if fault["file"] == name}
        if not changes:
            return None
        text, self.lines[name], unfit = with_switches(file.read_text(), changes)
        self.drop(unfit)
        return text

    def drop(self, numbers):
        for number in numbers:
            print(f"alone   {self.faults.pop(number)['fault']}: it has no form at run time", flush=True)

    def make(self, targets):
        """Builds; a fault that does not compile is left out."""
        while problem := self.copy.problem_of_build(*targets, limit_s=SWITCHED_BUILD_LIMIT_S):
            blamed = self.blamed(problem)
            if not blamed:
                raise RuntimeError("\n".join(problem.splitlines()[-60:]))
            self.drop(blamed)
            self.copy.mirror(self.text_of)

    def blamed(self, problem):
        """The faults at whose lines the compiler's errors point, or else the notes below them."""
        found = set()
        for error in re.split(r"^(?=\S+:\d+:\d+: (?:fatal )?error:)", problem, flags=re.M)[1:]:
            places = re.findall(rf"{re.escape(str(self.copy.source))}/(\S+?):(\d+)", error)
            for some in (places[:1], places):
                hits = [numbers for file, line in some for first, last, numbers in self.lines.get(file, ())
                        if first <= int(line) <= last]
                if hits:
                    found |= set(min(hits, key=len)) & self.faults.keys()
                    break
        return found


def reads_sources(fault):
    """Its test needs no program of the build, but the sources as they are."""
    return "script" in fault and "test" not in fault


def test_source(program):
    label, _, name = program.partition("_")
    return ROOT / "tests" / label / f"{name}.cc"


def program_of(fault):
    """What is built and run: that of its label has all tests."""
    return fault["program"] if "script" in fault else fault["program"].partition("_")[0] + "_tests"


def outcome_alone(copy, fault, limit_s):
    """With the fault's text in its file."""
    file = copy.source / fault["file"]
    text = file.read_text()
    file.write_text(with_fault(fault))
    problem = "" if reads_sources(fault) else copy.problem_of_build(*program_of(fault).split())
    outcome = problem[-2000:] or copy.outcome(*test_of(fault), limit_s=limit_s)[0]
    file.write_text(text)
    return outcome


def test_of(fault):
    return program_of(fault), fault.get("test"), fault.get("script")


def judged(fault, before, after):
    is_caught = before == "passes" and after == "dies"
    print(f"{'caught ' if is_caught else 'MISSED '} {fault['fault']}: {fault['program']} {fault.get('test') or fault['script']} "
          f"{before} without it, {after} with it", flush=True)
    return is_caught


def main(build, work, pattern="", *drawn):
    if pattern == "--draw":
        count, seed = map(int, drawn)
        faults = random.Random(seed).sample(all_faults(), count)
    else:
        faults = [fault for fault in all_faults() if re.search(pattern, fault["fault"] + " " + fault["file"])]
    switched = Switched(build, work, faults)
    copy = switched.copy
    switched.make(sorted({program for fault in faults for program in program_of(fault).split()}))
    by_text = [fault for fault in faults if reads_sources(fault)]
    at_run_time = list(switched.faults.values())
    alone = [fault for fault in faults if fault not in at_run_time and fault not in by_text]

    def limit_s(fault):
        return PATIENCE[0] + PATIENCE[1] * sound[test_of(fault)][1]

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        tests = list(dict.fromkeys(map(test_of, at_run_time + alone)))
        sound = dict(zip(tests, pool.map(lambda test: copy.outcome(*test), tests)))
        after = pool.map(lambda fault: copy.outcome(*test_of(fault), number_of(fault), limit_s(fault))[0], at_run_time)
        caught = [judged(fault, sound[test_of(fault)][0], found) for fault, found in zip(at_run_time, after)]
    caught += [judged(fault, sound[test_of(fault)][0], outcome_alone(copy, fault, limit_s(fault))) for fault in alone]
    if by_text:
        copy.mirror(lambda file: None)
        sound |= {test: copy.outcome(*test) for test in set(map(test_of, by_text))}
    caught += [judged(fault, sound[test_of(fault)][0], outcome_alone(copy, fault, limit_s(fault))) for fault in by_text]
    print(f"{len(faults)} faults, {len(at_run_time)} of them in one build, {len(alone)} built alone; {caught.count(False)} missed")
    return 0 if caught and all(caught) else 1


if __name__ == "__main__":
    if sys.argv[1:] == ["--check"]:
        found = [problem for fault in all_faults() for problem in problems_of(fault)]
        print("\n".join(found) or f"{len(all_faults())} faults fit")
        sys.exit(1 if found else 0)
    sys.exit(main(*(pathlib.Path(argument).resolve() for argument in sys.argv[1:3]), *sys.argv[3:]))
