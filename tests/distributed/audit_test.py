"""A worker that makes its results up, among honest ones: it is found out, and no bit of it stays.

Environment as of processes.py; DISPERSA_NOOP_WORKER: the program that makes its results up.
"""
import os
import sqlite3
import subprocess

from processes import CAMPAIGN, PATIENCE_S, content, main, wait_for
from service_case import ServiceCase


class AuditTest(ServiceCase):
    DOMAIN = "34"
    CASES = 200

    def test_a_forger_is_expelled_and_its_cases_are_flown_again(self):
        coordinator = self.start("dispersa-coordinator", CAMPAIGN, "--cases", self.CASES, "--out", self.data / "out",
                                 "--audit", 0.02)
        # Alone, it returns whatever it likes until its first result has been flown again.
        forger = self.start(os.environ["DISPERSA_NOOP_WORKER"], stderr=subprocess.DEVNULL)
        self.assertEqual(forger.wait(timeout=PATIENCE_S), 0)
        self.assertRegex(self.log.read_text(), r"\S+ may not fly here any more: case \d+ of campaign \S+, flown again by "
                                               "the coordinator, gives other bits than the worker returned")
        wait_for(lambda: "results of worker" in self.log.read_text(), "removal of what it returned")
        self.start_worker()
        self.assertEqual(coordinator.wait(timeout=2 * PATIENCE_S), self.reference.code, self.log.read_text())
        self.assertRegex(self.log.read_text(), r"\d+ results were flown again and agree")
        for name in ("cases.csv", "summary.json", "report.html"):
            self.assertEqual(content(self.data / "out", name), content(self.reference.out, name), name)
        with sqlite3.connect(f"file:{self.data}/out/results.sqlite?mode=ro", uri=True) as database:
            workers = database.execute("SELECT count(DISTINCT worker), count(*) FROM execution").fetchone()
            self.assertEqual(workers, (1, self.CASES))
            self.assertGreater(database.execute("SELECT count(*) FROM audits").fetchone()[0], 0)


if __name__ == "__main__":
    main()
