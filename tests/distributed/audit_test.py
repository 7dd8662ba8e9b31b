"""A worker that makes its results up, among honest ones: it is found out, and no bit of it stays.

Environment as of processes.py; DISPERSA_NOOP_WORKER: the program that makes its results up.
"""
import json
import os
import re
import sqlite3
import subprocess
import time

from processes import CAMPAIGN, PATIENCE_S, SMOKE, main, wait_for
from security_test import keys
from service_case import ServiceCase


class AuditTest(ServiceCase):
    DOMAIN = "34"
    CASES = 200

    def test_a_forger_is_expelled_and_its_cases_are_flown_again(self):
        self.start("dispersa-coordinator", "--data", self.data / "data", "--audit", 0.02)
        identity = self.dispersa("launch", CAMPAIGN, "--cases", self.CASES).strip()
        # Alone, it returns whatever it likes until its first result has been flown again.
        forger = self.start(os.environ["DISPERSA_NOOP_WORKER"], stderr=subprocess.DEVNULL)
        self.assertEqual(forger.wait(timeout=PATIENCE_S), 0)
        self.assertRegex(self.log.read_text(), r"\S+ may not fly here any more: case \d+ of campaign \S+, flown again by "
                                               "the coordinator, gives other bits than the worker returned")
        wait_for(lambda: "results of worker" in self.log.read_text(), "removal of what it returned")
        self.start_worker()
        self.dispersa("watch", identity, "--quiet", code=self.reference.code)
        self.assertRegex(self.log.read_text(), r"\d+ results were flown again and agree")
        out = self.assert_same_folder(identity, self.reference)
        with sqlite3.connect(f"file:{out}/results.sqlite?mode=ro", uri=True) as database:
            workers = database.execute("SELECT count(DISTINCT worker), count(*) FROM execution").fetchone()
            self.assertEqual(workers, (1, self.CASES))
            self.assertGreater(database.execute("SELECT count(*) FROM audits").fetchone()[0], 0)

    def test_a_forger_ends_no_honest_worker_of_its_keys(self):
        """Its second process expels its host, its third the keys; somebody readmits them."""
        authority = self.data / "authority"
        keys("init", authority)
        folders = {role: keys("issue", authority, "--role", role, "--name", name, *may) for role, name, may in
                   (("coordinator", "main", ()), ("worker", "node1", ()), ("client", "ops", ("--may", "administer")))}

        def forger(host):
            process = self.start(os.environ["DISPERSA_NOOP_WORKER"], "--keys", folders["worker"], stderr=subprocess.DEVNULL,
                                 env={**os.environ, "DISPERSA_NOOP_HOST": host})
            process.wait(timeout=PATIENCE_S)
            return self.liars()[-1]

        def ask(*arguments, code=0):
            return self.dispersa(*arguments, "--keys", folders["client"], code=code)

        def state():
            return json.loads(ask("status", identity, "--json"))["campaigns"][0]
        self.start("dispersa-coordinator", "--data", self.data / "data", "--keys", folders["coordinator"], "--audit", 0.02)
        identity = ask("launch", SMOKE, "--cases", 100000).strip()
        honest = [self.start_worker("--keys", folders["worker"]) for _ in range(2)]
        wait_for(lambda: state()["done"] > 500, "results of the honest ones")
        liars = [forger("rack7")]
        flown = state()
        self.assertGreater(flown["done"], 500, "only what the forger returned is removed")
        wait_for(lambda: state()["done"] > flown["done"] + 200, "more of their results")
        self.assertEqual([worker.poll() for worker in honest], [None, None])
        rates = [state()["rate_per_s"] for _ in range(6) if not time.sleep(0.05)]
        self.assertLess(max(rates), 1e6)
        self.assertEqual(ask("readmit").split()[0], liars[0])
        liars.append(forger("rack7"))
        self.assertIn("node1@rack7 may not fly here any more: 2 of its processes there returned false results", self.log.read_text())
        forger("rack7")  # is refused before it has a case
        self.assertEqual(len(self.liars()), 2)
        self.assertEqual([worker.poll() for worker in honest], [None, None])
        liars.append(forger("rack8"))
        self.assertEqual([worker.wait(timeout=PATIENCE_S) for worker in honest], [5, 5])
        self.assertIn("node1 may not fly here any more: 3 of its processes returned false results", self.log.read_text())
        wait_for(lambda: state()["done"] == 0, "removal of what these keys returned")
        self.assertIn("nobody with the name 'node2' is expelled", self.refused(ask, "readmit", "node2"))
        self.assertEqual(ask("readmit", "node1"), "readmitted: node1\n")
        self.assertEqual(ask("readmit"), "nobody is expelled\n")
        again = self.start_worker("--keys", folders["worker"])
        wait_for(lambda: state()["done"] > 100, "results of a readmitted host")
        self.assertIsNone(again.poll())
        liars.append(forger("rack7"))
        self.assertEqual(ask("readmit").split("  ")[0], liars[3], "the lies before are forgiven")
        ask("cancel", identity)
        out = self.data / "out"
        ask("fetch", identity, "--out", out)
        with sqlite3.connect(f"file:{out}/results.sqlite?mode=ro", uri=True) as database:
            workers = {row[0] for row in database.execute("SELECT DISTINCT worker FROM execution")}
        self.assertEqual(len(set(liars)), 4)
        self.assertFalse(workers & set(liars))

    def liars(self):
        return re.findall(r"(node1_\w+) may not fly here any more", self.log.read_text())

    def refused(self, ask, *arguments):
        ask(*arguments, code=2)
        return self.error


if __name__ == "__main__":
    main()
