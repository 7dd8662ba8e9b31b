"""Programs with another vendor's DDS (cyclone/) on our topics: an observer gets the stored results, and a worker's
results count.

Environment as of processes.py; DISPERSA_CYCLONE names the folder of the two programs.
"""
import csv
import json
import os
import pathlib
import sqlite3
import subprocess

from processes import BINARIES, CAMPAIGN, PATIENCE_S, main, wait_for
from service_case import ServiceCase

CYCLONE = pathlib.Path(os.environ["DISPERSA_CYCLONE"])
CASES = 40  # fewer than a writer keeps for a reader that is slow (idl/README.md): none may be missed


def number(text):
    """A cell of cases.csv as the bits that it stands for; undefined is None."""
    return float(text) if text else None


class CycloneTest(ServiceCase):
    DOMAIN = "34"
    CASES = CASES

    def start_foreign(self, program, *arguments):
        """A program of cyclone/ and the file that it writes to."""
        out = self.root / f"{self.id()}.{program}"
        with out.open("w") as file, self.log.open("a") as log:
            self.processes.append(subprocess.Popen([CYCLONE / program, self.DOMAIN, *map(str, arguments)], stdout=file,
                                                   stderr=log))
        return self.processes[-1], out

    def take_everybody(self):
        """A program of others does not seal what it says with the secret of this user."""
        self.NETWORK = [*self.NETWORK, "--insecure"]

    def finish(self, process):
        self.assertEqual(process.wait(timeout=2 * PATIENCE_S), 0, self.log.read_text()[-3000:])

    def flown_by_workers(self):
        return [worker["flown"] for worker in json.loads(self.dispersa("status", "--json"))["workers"]]

    def test_an_observer_sees_each_result_once_and_the_end(self):
        self.start_coordinator()
        identity = self.dispersa("launch", CAMPAIGN, "--cases", CASES).strip()
        observer, seen = self.start_foreign("cyclone_observer", identity)
        wait_for(lambda: identity in seen.read_text(), "progress")  # before anybody flies: it misses nothing
        self.start_worker()
        self.dispersa("watch", identity, code=self.reference.code)
        self.finish(observer)
        lines = [json.loads(line) for line in seen.read_text().splitlines()]

        progress = [line["progress"] for line in lines if "progress" in line]
        self.assertEqual({k: progress[-1][k] for k in ("campaign_id", "state", "done", "total", "quarantined", "assigned")},
                         {"campaign_id": identity, "state": "done", "done": CASES, "total": CASES, "quarantined": 0, "assigned": 0})
        done = [each["done"] for each in progress]
        self.assertEqual(done, sorted(done))

        results = [line["result"] for line in lines if "result" in line]
        self.assertEqual({result["flight_id"] for result in results}, {progress[-1]["flight_id"]})
        results.sort(key=lambda result: result["case_index"])
        self.assertEqual([result["case_index"] for result in results], list(range(CASES)))
        with (self.fetch(identity) / "cases.csv").open(newline="") as file:
            rows = list(csv.DictReader(file))
        for row, result in zip(rows, results, strict=True):
            self.assertEqual((row["outcome"], number(row["end_time_s"]), int(row["end_stage"]), row["reason"]),
                             (result["outcome"], result["end_time_s"], result["end_stage"], result["reason"]))
            self.assertEqual([number(v) for k, v in row.items() if k.startswith("input_")], result["inputs"])
            # A result holds metrics of angles too, which no target of this campaign names: the folder has no columns of them.
            measured = [number(v) for k, v in row.items() if k.startswith("metric_")]
            self.assertEqual([v for v in measured if v is not None], [v for v in result["metrics"] if v is not None])
            self.assertEqual(row["digest"], f"{result['digest_high']:016x}{result['digest_low']:016x}")
        with sqlite3.connect(self.fetch(identity) / "results.sqlite") as database:
            stored = database.execute("SELECT case_index, event, time_s, altitude_m, speed_m_s, qbar_pa, mass_kg FROM events "
                                      "ORDER BY case_index, place").fetchall()
        self.assertEqual(stored, [(result["case_index"], *event) for result in results for event in result["events"]])

    def test_a_worker_flies_an_assignment(self):
        self.take_everybody()
        self.start_coordinator()
        identity = self.dispersa("launch", CAMPAIGN, "--cases", CASES).strip()
        foreign, said = self.start_foreign("cyclone_worker", "cyclone-1", BINARIES / "dispersa", self.root / "text.yaml")
        self.finish(foreign)  # alone, so that it is the one that flew
        first, *rest = said.read_text().splitlines()
        cases = int(first.removeprefix("assigned "))
        self.assertEqual(rest, [f"flown {cases}", "stored"])
        self.assertTrue(0 < cases < CASES, cases)
        self.assertEqual(self.status(identity)["done"], cases)
        self.start_worker()
        self.dispersa("watch", identity, code=self.reference.code)
        wait_for(lambda: self.flown_by_workers() == [CASES - cases], "none twice, and the other worker has left")
        self.assert_same_folder(identity, self.reference)


if __name__ == "__main__":
    main()
