"""What the tests of programs share: runs and daemons as processes, what they leave behind, and namespaces of their own.

DISPERSA_BINARIES and DISPERSA_CAMPAIGNS name the folders of the programs and of the campaigns.
"""
import contextlib
import fcntl
import json
import os
import pathlib
import re
import shutil
import socket
import sqlite3
import struct
import subprocess
import sys
import time
import unittest

BINARIES = pathlib.Path(os.environ["DISPERSA_BINARIES"])
CAMPAIGNS = pathlib.Path(os.environ["DISPERSA_CAMPAIGNS"])
SMOKE = str(CAMPAIGNS / "smoke.yaml")
BRIEF = str(CAMPAIGNS.parent / "tests/data/brief/smoke.yaml")  # its flights take half of the time
# Of most tests, to which no flight matters: all are lost after seconds, so the campaign's verdict is `fail`.
CAMPAIGN = str(CAMPAIGNS.parent / "tests/data/brief/lost.yaml")
LOST_CODE = 3  # its exit code
ISOLATED = "DISPERSA_TEST_ISOLATED"
PATIENCE_S = int(os.environ.get("DISPERSA_PATIENCE_S", "180"))  # for what takes seconds on an idle machine
# Lost flights of a campaign in which something is to happen half-way: a worker of one slot does not fly them between two
# transactions (0.5 s).
HALF_WAY_CASES = 5000


def _isolate():
    """Starts this program again with its own loopback interface and its own mounts, if that is permitted."""
    for unshare in (["unshare", "-n", "-m"], ["unshare", "-r", "-n", "-m"]):
        if shutil.which("unshare") and subprocess.run([*unshare, "true"], stderr=subprocess.DEVNULL).returncode == 0:
            os.environ[ISOLATED] = "1"
            os.execvp(unshare[0], [*unshare, sys.executable, "-B", *sys.argv])


def _raise_loopback():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
        name = struct.pack("16sh", b"lo", 0) + bytes(22)
        flags = struct.unpack("16sh", fcntl.ioctl(s, 0x8913, name)[:18])[1]  # SIOCGIFFLAGS
        fcntl.ioctl(s, 0x8914, struct.pack("16sh", b"lo", flags | 1) + bytes(22))  # SIOCSIFFLAGS, IFF_UP


def lost_text(name, more=""):
    """CAMPAIGN under this name, with what differs, for any folder."""
    return f"schema: dispersa/campaign/1\nname: {name}\nbased_on: {CAMPAIGN}\n{more}"


def smoke_text(name="smoke"):
    """campaigns/smoke.yaml under this name, for any folder."""
    text = (CAMPAIGNS / "smoke.yaml").read_text().replace("\nname: smoke\n", f"\nname: {name}\n")
    return re.sub(r": ((?:vehicles|references|autopilots)/)", rf": {CAMPAIGNS}/\1", text)


def is_running(pid):
    """False for a zombie too: nobody may wait for the orphans of a killed parent."""
    try:
        return pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


def parent_and_name(pid):
    text = pathlib.Path(f"/proc/{pid}/stat").read_text()
    return int(text.rpartition(")")[2].split()[1]), text.partition("(")[2].rpartition(")")[0]


def end(processes):
    """Kills those of a test's processes that still run, and waits for all."""
    for process in processes:
        if process.poll() is None:
            process.kill()
        process.wait()


def wait_for(condition, what):
    deadline = time.monotonic() + PATIENCE_S
    while not condition():
        if time.monotonic() > deadline:
            raise AssertionError(f"{what}: not within {PATIENCE_S} s")
        time.sleep(0.02)


def shared_memory_segments():
    return {p.name for p in pathlib.Path("/dev/shm").iterdir() if p.name.startswith(("fastrtps", "fastdds"))}


def stored(out):
    """Number of cases in the database of a result folder; 0 while there is none."""
    try:
        with contextlib.closing(sqlite3.connect(f"file:{out}/results.sqlite?mode=ro", uri=True)) as database:
            return database.execute("SELECT count(*) FROM cases").fetchone()[0]
    except sqlite3.OperationalError:
        return 0


def settled(out):
    """Number of cases in the database of a result folder, once none has come for two seconds: results that wait in a
    coordinator's sockets are stored in batches, after other messages that came later."""
    number, since = stored(out), time.monotonic()
    while time.monotonic() < since + 2:
        time.sleep(0.05)
        now = stored(out)
        if now != number:
            number, since = now, time.monotonic()
    return number


def content(folder, name):
    """A file's bytes; of the report without what differs from run to run."""
    data = (folder / name).read_bytes()
    return re.sub(rb"<!-- run:begin -->.*?<!-- run:end -->", b"", data, flags=re.S) if name == "report.html" else data


class Run:
    """One `dispersa run` into a folder."""

    def __init__(self, out, *arguments, program="dispersa", campaign=CAMPAIGN):
        self.out = out
        command = [BINARIES / program, "run", campaign, "--out", out, *map(str, arguments)]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def finish(self):
        self.stdout, self.stderr = self.process.communicate(timeout=3 * PATIENCE_S)
        self.code = self.process.returncode
        return self

    def execution(self):
        return json.loads((self.out / "execution.json").read_text())

    def stored(self):
        return stored(self.out)

    def wait_half_way(self, cases):
        wait_for(lambda: self.stored() > 0 or self.process.poll() is not None, "first results")
        if self.process.poll() is not None:
            raise AssertionError(f"ended too early: {self.finish().stderr}")
        if not 0 < self.stored() < cases:
            raise AssertionError("not half-way: the campaign is too short for this test")

    def workers(self):
        return [w["pid"] for w in self.execution()["workers"] if w["ended_utc"] is None]

    def csv(self):
        return (self.out / "cases.csv").read_bytes()


def main(need_isolation=None):
    """What each of these programs ends with: its tests, in namespaces of its own where the system permits it.

    need_isolation: why the program cannot do without; it then ends with this text.
    """
    if ISOLATED in os.environ:
        _raise_loopback()
    else:
        _isolate()
        if need_isolation:
            sys.exit(f"no namespace of its own: {need_isolation}")
        print("no namespace of its own: the loopback interface is shared", file=sys.stderr)
    unittest.main()
