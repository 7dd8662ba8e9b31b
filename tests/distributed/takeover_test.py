"""Another host, under another address, takes over on a backup: the cases that the backup lacks are flown again, and the bytes
are those of a run in one process. The first coordinator was only frozen: when it comes back, the worker goes on with the
younger one. When that one dies, it follows the first one again.

Environment as of processes.py.
"""
import json
import pathlib
import shutil
import signal
import subprocess
import tempfile
import unittest

from hosts import Hosts
from processes import BINARIES, PATIENCE_S, SMOKE, Run, content, end, main, settled, stored, wait_for

CASES = 1200  # more than a worker may hold (9 assignments of 64 at most) and fly between two transactions
NETWORK = ["--domain", "34", "--insecure"]  # the game day does this with keys
FIRST, SECOND, WORKERS = 0, 1, 2  # hosts


class TakeOver(unittest.TestCase):
    def setUp(self):
        self.root = pathlib.Path(tempfile.mkdtemp(prefix="dispersa-takeover-"))
        self.processes = []
        self.hosts = Hosts(3)

    def tearDown(self):
        end(self.processes)
        self.hosts.close()
        shutil.rmtree(self.root)

    def log(self, name):
        return (self.root / f"{name}.log").read_text(errors="replace")

    def start(self, host, name, program, *arguments):
        with (self.root / f"{name}.log").open("a") as log:
            self.processes.append(self.hosts[host].start([BINARIES / program, *arguments, *NETWORK], stdout=log, stderr=log))
        return self.processes[-1]

    def start_coordinator(self, host, name):
        return self.start(host, name, "dispersa-coordinator", "--data", self.root / name, "--address", self.hosts[host].address)

    def dispersa(self, host, *arguments):
        """A client of the coordinator on that host; its standard output."""
        done = subprocess.run([*self.hosts[WORKERS].inside, BINARIES / "dispersa", *map(str, arguments), *NETWORK, "--peer",
                               self.hosts[host].address], capture_output=True, text=True, timeout=3 * PATIENCE_S)
        self.assertEqual(done.returncode, 0, f"{arguments}: {done.stderr}\n{self.log('first')[-3000:]}")
        return done.stdout

    def state(self, host, identity):
        return json.loads(self.dispersa(host, "status", identity, "--json"))["campaigns"][0]["state"]

    def workers(self, host):
        return json.loads(self.dispersa(host, "status", "--json"))["workers"]

    def test_another_host_takes_over_and_the_first_one_comes_back(self):
        reference = Run(self.root / "reference", "--workers", 0, "--cases", CASES, "--no-histories", campaign=SMOKE).finish()
        first = self.start_coordinator(FIRST, "first")
        self.start(WORKERS, "worker", "dispersa-worker", "--peer", f"{self.hosts[FIRST].address},{self.hosts[SECOND].address}")
        identity = self.dispersa(FIRST, "launch", SMOKE, "--cases", CASES).strip()
        results, later = self.root / "first" / identity / "results", self.root / "second" / identity / "results"
        wait_for(lambda: stored(results) >= 50, "first results")
        self.dispersa(FIRST, "backup", self.root / "second")
        backed_up = stored(later)
        wait_for(lambda: stored(results) >= backed_up + 50, "results that the backup lacks")
        first.send_signal(signal.SIGSTOP)
        frozen_at = stored(results)
        self.assertLess(frozen_at, CASES, "the campaign is too short for this test")

        second = self.start_coordinator(SECOND, "second")
        wait_for(lambda: len(self.workers(SECOND)) == 1, "the worker follows the younger coordinator")
        first.send_signal(signal.SIGCONT)
        wait_for(lambda: "follows a coordinator that was started later" in self.log("first"), "it hears whom the worker follows")
        mine = settled(results)  # with what was on its way when it was frozen
        self.assertLess(mine, CASES, "it goes on flying")
        wait_for(lambda: self.state(SECOND, identity) == "done", "the second host's campaign")
        self.assertEqual(stored(results), mine, "the first one has flown nothing more")
        self.assertEqual(self.workers(FIRST), [])
        self.assertEqual(stored(later), CASES)
        self.dispersa(SECOND, "fetch", identity, "--out", self.root / "fetched")
        self.assertEqual(content(self.root / "fetched", "cases.csv"), content(reference.out, "cases.csv"))

        second.kill()
        wait_for(lambda: stored(results) > mine, "the worker follows the first one again")


if __name__ == "__main__":
    main(need_isolation="hosts cannot be made")
