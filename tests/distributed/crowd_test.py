"""Fifty workers that return results at once without flying: none is taken for lost, and each case is stored once.

Environment as of processes.py; DISPERSA_NOOP_WORKER: the program that makes its results up.
"""
import os
import sqlite3
import subprocess

from processes import CAMPAIGN, main, stored, wait_for
from service_case import ServiceCase

FLOWN = 20_000
WORKERS = 50


class CrowdTest(ServiceCase):
    DOMAIN = "32"

    def test_fifty_workers_lose_nothing(self):
        crew = [self.start(os.environ["DISPERSA_NOOP_WORKER"], stderr=subprocess.DEVNULL) for _ in range(WORKERS)]
        # Their results are made up, so the audit that is on by default would expel every one of them.
        self.start("dispersa-coordinator", "--data", self.data / "data", "--audit", 0)
        out = self.data / "data" / self.dispersa("launch", CAMPAIGN, "--cases", FLOWN).strip() / "results"
        wait_for(lambda: stored(out) == FLOWN, f"{FLOWN} results")
        # The campaign is complete; its reports, of results that nobody flew, are not waited for.
        self.assertNotIn("lost", self.log.read_text())
        with sqlite3.connect(f"file:{out}/results.sqlite?mode=ro", uri=True) as database:
            self.assertEqual(database.execute("SELECT count(*), count(DISTINCT case_index) FROM execution").fetchone(),
                             (FLOWN, FLOWN))
            self.assertGreater(database.execute("SELECT count(DISTINCT worker) FROM execution").fetchone()[0], 1)
        self.assertEqual([worker.poll() for worker in crew], [None] * WORKERS, "each stays for the next campaign")


if __name__ == "__main__":
    main()
