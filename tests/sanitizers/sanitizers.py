"""Runs the distributed smoke campaign with programs built for a sanitizer, and sees that it reports nothing, but faults.

usage: sanitizers.py BUILD WORK_FOLDER address|thread
       sanitizers.py --check    whether each fault of faults.yaml still fits its file
BUILD is a configured build folder: its compiler is taken, and the bytes of its programs are expected. The copy under
WORK_FOLDER is kept, so that the next time only what changed is built. Exit code 0: nothing was reported, and every fault was.
"""
import contextlib
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time

import yaml

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "faults"))
from faults import Copy, with_fault  # noqa: E402

# Options of the compiler and of the sanitizer's runtime. Without NDEBUG: with assertions. The engine itself is compiled with
# -O3 in every build.
SANITIZERS = {
    # -O0 -g1: -O1 -g takes GCC 12 twice as long. Undefined behaviour is a trap, which AddressSanitizer reports as "ILL" with
    # its place: UndefinedBehaviorSanitizer's own runtime, beside the other, writes to no log.
    # new_delete_type_mismatch: Debian's Fast DDS frees some of its objects as another type than it made.
    "address": ("-O0 -g1", "-fsanitize=address,undefined,float-cast-overflow -fsanitize-undefined-trap-on-error",
                {"ASAN_OPTIONS": "new_delete_type_mismatch=0:detect_stack_use_after_return=1:handle_sigill=1"}),
    # detect_deadlocks: Debian's Fast DDS takes its own locks in more than one order.
    "thread": ("-O1 -g", "-fsanitize=thread",
               {"TSAN_OPTIONS": f"detect_deadlocks=0:suppressions={HERE / 'thread.supp'}"}),
}
PATIENCE_S = 300     # for what takes seconds with ordinary programs on an idle machine
BUILD_LIMIT_S = 7200
CAMPAIGN_LIMIT_S = 1800
FAULT_LIMIT_S = 300
SHOWN = 4000         # characters of a report


def all_faults():
    return yaml.safe_load((HERE / "faults.yaml").read_text())


def fixed_addresses():
    """What to put before a command: GCC 12's ThreadSanitizer does not start where a kernel draws addresses from more
    bits than it knows."""
    command = ["setarch", "-R"]
    with contextlib.suppress(FileNotFoundError):
        if subprocess.run([*command, "true"], stderr=subprocess.DEVNULL, check=False).returncode == 0:
            return command
    return []


class Sanitized:
    """The programs of a copy of the sources, built for a sanitizer."""

    def __init__(self, kind, build, work):
        level, flags, self.runtime_options = SANITIZERS[kind]
        self.reference, self.reports = build, work / "reports"
        self.copy = Copy(build, work, f"-DCMAKE_CXX_FLAGS_RELEASE={level}",
                         f"-DCMAKE_CXX_FLAGS={flags} -fno-omit-frame-pointer")
        self.build("programs", "noop_worker")

    def build(self, *targets):
        if problem := self.copy.problem_of_build(*targets, limit_s=BUILD_LIMIT_S):
            raise RuntimeError(problem)

    def run(self, *command, limit_s):
        """Exit code, what was printed, and what the sanitizer reported. Whatever takes too long is killed with its children."""
        shutil.rmtree(self.reports, ignore_errors=True)
        self.reports.mkdir()
        options = {name: f"{value}:log_path={self.reports / 'report'}" for name, value in self.runtime_options.items()}
        with subprocess.Popen([*fixed_addresses(), *command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              errors="replace", start_new_session=True, env=os.environ | options) as process:
            try:
                text, _ = process.communicate(timeout=limit_s)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                text = process.communicate()[0] + "\ntook too long"
        return process.returncode, text, "".join(path.read_text(errors="replace") for path in sorted(self.reports.iterdir()))

    def smoke(self):
        os.environ |= {"DISPERSA_BINARIES": str(self.copy.build / "bin"), "DISPERSA_REFERENCE": str(self.reference / "bin"),
                       "DISPERSA_NOOP_WORKER": str(self.copy.build / "tools/noop_worker"),
                       "DISPERSA_CAMPAIGNS": str(self.copy.source / "campaigns"), "DISPERSA_PATIENCE_S": str(PATIENCE_S)}
        return self.run(sys.executable, "-B", HERE / "smoke_test.py", "-v", limit_s=CAMPAIGN_LIMIT_S)

    def report_of(self, fault):
        """What is reported of a run with the fault in the sources."""
        file = self.copy.source / fault["file"]
        text = file.read_text()
        file.write_text(with_fault(fault))
        try:
            self.build(fault["target"])
            shutil.rmtree(self.copy.source / "results", ignore_errors=True)
            return self.run(self.copy.build / "bin/dispersa", "run", self.copy.source / "campaigns/smoke.yaml", "--workers", "1",
                            "--cases", "40", "--out", self.copy.source / "results", limit_s=FAULT_LIMIT_S)[2]
        finally:
            file.write_text(text)


def main(build, work, kind):
    begun = time.monotonic()

    def say(text):
        print(f"{time.monotonic() - begun:5.0f} s  {text}", flush=True)

    sanitized = Sanitized(kind, build, work)
    say("built")
    code, text, report = sanitized.smoke()
    say(f"smoke campaign: exit code {code}, {'something' if report else 'nothing'} reported")
    is_clean = code == 0 and not report
    if not is_clean:
        print(text[-SHOWN:], report[:SHOWN], sep="\n")
    missed = 0
    for fault in (fault for fault in all_faults() if fault["sanitizer"] == kind):
        report = sanitized.report_of(fault)
        is_caught = fault["report"] in report and pathlib.Path(fault["file"]).name in report
        missed += not is_caught
        say(f"{'caught' if is_caught else 'MISSED'}: {fault['fault']}")
        if not is_caught:
            print(report[:SHOWN])
    sanitized.build("programs")  # without the last fault
    return 0 if is_clean and missed == 0 else 1


if __name__ == "__main__":
    if sys.argv[1:] == ["--check"]:
        for each in all_faults():
            with_fault(each)
        print(f"{len(all_faults())} faults fit")
        sys.exit(0)
    sys.exit(main(*(pathlib.Path(argument).resolve() for argument in sys.argv[1:3]), sys.argv[3]))
