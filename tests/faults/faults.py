"""Puts each fault of faults.yaml into a copy of the sources, builds its test and sees it die.

usage: faults.py BUILD WORK_FOLDER [PATTERN]   every fault, or those in whose name or file the regular expression is found
       faults.py --check                       whether each fault still fits its file and names a test that exists
BUILD is a configured build folder, whose compiler and options the copy takes. Exit code 0: every test died of its
fault and passed without it.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
KEPT = ["CMakeLists.txt", "core", "idl", "services", "docker", "campaigns", "tests"]  # what a build reads
BUILD_LIMIT_S = 1800
TEST_LIMIT_S = 900


def all_faults():
    return yaml.safe_load((pathlib.Path(__file__).parent / "faults.yaml").read_text())


def with_fault(fault):
    """The file's text with the fault in it; an error where `from` does not stand there exactly once. Where the lines of
    `from` break does not matter: the formatter decides that."""
    pattern = r"\s+".join(map(re.escape, fault["from"].split())).replace(r"\(", r"\(\s*")
    before, after = re.match(r"\s*", fault["from"]).group(), re.search(r"\s*$", fault["from"]).group()
    text = (ROOT / fault["file"]).read_text()
    found = list(re.finditer(f"{re.escape(before)}{pattern}{re.escape(after)}", text))
    if len(found) != 1:
        raise ValueError(f"{fault['fault']}: its text stands {len(found)} times in {fault['file']}")
    return text[:found[0].start()] + fault["to"] + text[found[0].end():]


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
    label, _, name = fault["program"].partition("_")
    source = ROOT / "tests" / label / f"{name}.cc"
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
    """Exit code and what was printed; -1 if it took too long."""
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=limit_s,
                              errors="replace", check=False, env=env)
    except subprocess.TimeoutExpired:
        return -1, "took too long"
    return done.returncode, done.stdout


def mirror(origin, target):
    """Makes `target` like `origin`. What is the same already keeps its time: the object of a fault that was taken out
    again is older than its source and must stay so."""
    files = [origin] if origin.is_file() else [file for file in origin.rglob("*") if file.is_file()]
    wanted = {target / file.relative_to(origin) for file in files} if origin.is_dir() else {target}
    for stale in set(target.rglob("*")) - wanted if target.is_dir() else ():
        if stale.is_file():
            stale.unlink()
    for file in files:
        copy = target / file.relative_to(origin) if origin.is_dir() else target
        if not copy.is_file() or copy.read_bytes() != file.read_bytes():
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(file, copy)


class Copy:
    """The sources and a build of their own, of two engines; with further options of CMake."""

    def __init__(self, build, work, *options):
        self.source, self.build = work, work / "build/release"  # as the sources have it, so that a cache serves both
        for name in KEPT:
            mirror(ROOT / name, self.source / name)
        code, text = quiet("cmake", "-S", self.source, "-B", self.build, "-G", "Ninja",
                           *(f"-D{name}={cached(build, name)}" for name in ("CMAKE_BUILD_TYPE", "CMAKE_CXX_COMPILER")),
                           "-DDISPERSA_BUILD_TESTS=ON", "-DDISPERSA_ENGINES=v3 1;v3 4", *options,
                           limit_s=BUILD_LIMIT_S)
        if code != 0:
            raise RuntimeError(text)

    def problem_of_build(self, *targets, limit_s=BUILD_LIMIT_S):
        code, text = quiet("cmake", "--build", self.build, "--target", *targets, limit_s=limit_s)
        return "" if code == 0 else "does not build: " + "\n".join(text.splitlines()[-20:])

    def outcome(self, program, test, script):
        """"passes", "dies", or why neither can be said."""
        if problem := self.problem_of_build(*program.split()):
            return problem
        if script and test:
            # The package's module is one interpreter's.
            python = cached(self.build, "DISPERSA_PYTHON") or sys.executable
            code, _ = quiet(python, "-B", self.source / "tests" / script, test, limit_s=TEST_LIMIT_S,
                            env={**os.environ, "DISPERSA_BINARIES": str(self.build / "bin"),
                                 "PYTHONPATH": str(self.build / "python"),
                                 "DISPERSA_PYTHON_SOURCES": str(self.source / "services/python"),
                                 "DISPERSA_CAMPAIGNS": str(self.source / "campaigns"),
                                 "DISPERSA_SOURCE": str(self.source), "DISPERSA_BUILD": str(self.build)})
            return "passes" if code == 0 else "dies"
        if script:
            code, _ = quiet(sys.executable, "-B", self.source / "tests" / script, self.build, "clang++-16",
                            limit_s=TEST_LIMIT_S)
            return "passes" if code == 0 else "dies"
        code, text = quiet(self.build / "tests" / program, f"--gtest_filter={test}", limit_s=TEST_LIMIT_S)
        if "Running 0 tests from 0 test suites" in text:
            return f"no test {test}"
        return "passes" if code == 0 else "dies"


def main(build, work, pattern=""):
    copy = Copy(build, work)
    faults = [fault for fault in all_faults() if re.search(pattern, fault["fault"] + " " + fault["file"])]
    tests = [(fault["program"], fault.get("test"), fault.get("script")) for fault in faults]
    sound = {test: copy.outcome(*test) for test in dict.fromkeys(tests)}
    survived = 0
    for fault, test in zip(faults, tests):
        file = copy.source / fault["file"]
        text = file.read_text()
        file.write_text(with_fault(fault))
        before, after = sound[test], copy.outcome(*test)
        file.write_text(text)
        is_caught = before == "passes" and after == "dies"
        survived += not is_caught
        print(f"{'caught ' if is_caught else 'MISSED '} {fault['fault']}: {fault['program']} {fault.get('test') or fault['script']} "
              f"{before} without it, {after} with it", flush=True)
    print(f"{len(faults)} faults, {survived} missed")
    return 1 if survived or not faults else 0


if __name__ == "__main__":
    if sys.argv[1:] == ["--check"]:
        found = [problem for fault in all_faults() for problem in problems_of(fault)]
        print("\n".join(found) or f"{len(all_faults())} faults fit")
        sys.exit(1 if found else 0)
    sys.exit(main(*(pathlib.Path(argument).resolve() for argument in sys.argv[1:3]), *sys.argv[3:]))
