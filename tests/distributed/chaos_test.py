"""The daemons under a hundred kills: coordinators started again while workers live, workers replaced at random.

Environment as of run_test.py. Long: about three minutes.
"""
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

from run_test import BINARIES, CAMPAIGN, ISOLATED, PATIENCE_S, Run, end, isolate, raise_loopback, stored, wait_for

CASES = 400
COORDINATOR_KILLS = 80
WORKER_KILLS = 20
NETWORK = ["--domain", "40", "--address", "127.0.0.1"]


class ChaosTest(unittest.TestCase):
    def setUp(self):
        self.root = pathlib.Path(tempfile.mkdtemp(prefix="dispersa-chaos-"))
        self.processes = []

    def tearDown(self):
        end(self.processes)
        shutil.rmtree(self.root)

    def start(self, program, *arguments):
        with (self.root / "log").open("a") as log:
            self.processes.append(subprocess.Popen([BINARIES / program, *map(str, arguments), *NETWORK],
                                                   stdout=subprocess.DEVNULL, stderr=log))
        return self.processes[-1]

    def start_worker(self):
        return self.start("dispersa-worker", "--peer", "127.0.0.1", "--slots", 1)

    def end(self, process):
        process.kill()
        process.wait()

    def test_every_restart_gets_on_and_the_bytes_are_the_same(self):
        reference = Run(self.root / "reference", "--workers", 0, "--cases", CASES).finish()
        out = self.root / "chaos"
        draws = random.Random(1)
        kills = draws.sample([True] * COORDINATOR_KILLS + [False] * WORKER_KILLS, COORDINATOR_KILLS + WORKER_KILLS)
        workers = [self.start_worker(), self.start_worker()]

        def start_coordinator():
            return self.start("dispersa-coordinator", CAMPAIGN, "--cases", CASES, "--out", out, "--resume")
        coordinator = start_coordinator()
        for of_coordinator in kills:
            before = stored(out)
            if before >= CASES - 10:
                break
            # Killed at any time, also before it has a worker; but every other one must get a result first.
            if draws.random() < 0.5:
                wait_for(lambda: stored(out) > before, f"a result after {before}")
            time.sleep(draws.random() * 0.5)
            if of_coordinator:
                self.end(coordinator)
                coordinator = start_coordinator()
            else:
                self.end(workers.pop(0))
                workers.append(self.start_worker())
        try:
            coordinator.wait(timeout=3 * PATIENCE_S)
        except subprocess.TimeoutExpired:
            self.fail(f"{stored(out)} of {CASES} cases, then nothing:\n{(self.root / 'log').read_text()[-4000:]}")
        self.assertEqual(coordinator.returncode, reference.code, (self.root / "log").read_text()[-4000:])
        self.assertEqual((out / "cases.csv").read_bytes(), reference.csv())
        for worker in workers:
            self.assertEqual(worker.wait(timeout=PATIENCE_S), 0)


if __name__ == "__main__":
    if ISOLATED not in os.environ:
        isolate()
    else:
        raise_loopback()
    sys.dont_write_bytecode = True
    unittest.main()
