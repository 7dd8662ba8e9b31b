"""Fifty workers that fly nothing and answer at once: none is taken for lost, and each case is stored once.

Environment as of run_test.py; DISPERSA_NOOP_WORKER: the program that makes its results up.
"""
import os
import pathlib
import shutil
import sqlite3
import subprocess
import tempfile
import unittest

from run_test import BINARIES, CAMPAIGN, ISOLATED, PATIENCE_S, end, isolate, raise_loopback, stored, wait_for

CASES = 20_000
WORKERS = 50
NETWORK = ["--domain", "32", "--address", "127.0.0.1"]


class CrowdTest(unittest.TestCase):
    def setUp(self):
        self.root = pathlib.Path(tempfile.mkdtemp(prefix="dispersa-crowd-"))
        self.processes = []

    def tearDown(self):
        end(self.processes)
        shutil.rmtree(self.root)

    def test_fifty_workers_lose_nothing(self):
        out, log = self.root / "out", self.root / "log"
        crew = [subprocess.Popen([os.environ["DISPERSA_NOOP_WORKER"], *NETWORK]) for _ in range(WORKERS)]
        self.processes += crew
        with log.open("w") as stream:
            coordinator = subprocess.Popen([BINARIES / "dispersa-coordinator", CAMPAIGN, "--cases", str(CASES), "--out",
                                            out, *NETWORK], stdout=stream, stderr=stream)
        self.processes.append(coordinator)
        wait_for(lambda: stored(out) == CASES, f"{CASES} results")
        # The campaign is complete; its reports, of results that nobody flew, are not waited for.
        self.assertNotIn("lost", log.read_text())
        with sqlite3.connect(f"file:{out}/results.sqlite?mode=ro", uri=True) as database:
            self.assertEqual(database.execute("SELECT count(*), count(DISTINCT case_index) FROM execution").fetchone(),
                             (CASES, CASES))
            self.assertGreater(database.execute("SELECT count(DISTINCT worker) FROM execution").fetchone()[0], 1)
        for worker in crew:
            self.assertEqual(worker.wait(timeout=PATIENCE_S), 0, "each is told to leave")


if __name__ == "__main__":
    if ISOLATED not in os.environ:
        isolate()
    else:
        raise_loopback()
    unittest.main()
