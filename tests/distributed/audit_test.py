"""A worker that makes its results up, among honest ones: it is found out, and no bit of it stays.

Environment as of run_test.py; DISPERSA_NOOP_WORKER: the program that makes its results up.
"""
import os
import pathlib
import shutil
import sqlite3
import subprocess
import tempfile
import unittest

from run_test import BINARIES, CAMPAIGN, ISOLATED, PATIENCE_S, Run, end, isolate, raise_loopback, wait_for

CASES = 200
NETWORK = ["--domain", "34", "--address", "127.0.0.1"]


class AuditTest(unittest.TestCase):
    def setUp(self):
        self.root = pathlib.Path(tempfile.mkdtemp(prefix="dispersa-audit-"))
        self.processes = []

    def tearDown(self):
        end(self.processes)
        shutil.rmtree(self.root)

    def start(self, *command):
        log = self.root / f"log{len(self.processes)}"
        with log.open("w") as stream:
            self.processes.append(subprocess.Popen(list(map(str, command)) + NETWORK, stdout=stream, stderr=stream))
        self.processes[-1].log = log
        return self.processes[-1]

    def test_a_forger_is_expelled_and_its_cases_are_flown_again(self):
        reference = Run(self.root / "reference", "--workers", 0, "--cases", CASES).finish()
        out = self.root / "out"
        coordinator = self.start(BINARIES / "dispersa-coordinator", CAMPAIGN, "--cases", CASES, "--out", out,
                                 "--audit", 0.02)
        # Alone, it returns whatever it likes until its first result has been flown again.
        forger = self.start(os.environ["DISPERSA_NOOP_WORKER"])
        self.assertEqual(forger.wait(timeout=PATIENCE_S), 0)
        self.assertRegex(coordinator.log.read_text(), r"worker \S+ is refused: case \d+ of campaign \S+, flown again by "
                                                      "the coordinator, gives other bits than the worker returned")
        wait_for(lambda: "results of worker" in coordinator.log.read_text(), "removal of what it returned")
        self.start(BINARIES / "dispersa-worker", "--peer", "127.0.0.1")
        self.assertEqual(coordinator.wait(timeout=2 * PATIENCE_S), reference.code, coordinator.log.read_text())
        self.assertRegex(coordinator.log.read_text(), r"\d+ results were flown again and agree")
        for name in ("cases.csv", "summary.json", "report.html"):
            self.assertEqual((out / name).read_bytes(), (reference.out / name).read_bytes(), name)
        with sqlite3.connect(f"file:{out}/results.sqlite?mode=ro", uri=True) as database:
            workers = database.execute("SELECT count(DISTINCT worker), count(*) FROM execution").fetchone()
            self.assertEqual(workers, (1, CASES))
            self.assertGreater(database.execute("SELECT count(*) FROM audits").fetchone()[0], 0)


if __name__ == "__main__":
    if ISOLATED not in os.environ:
        isolate()
    else:
        raise_loopback()
    unittest.main()
