"""A coordinator of a new engine on the data folder of an older one: what is done stays done, and nothing flies twice.

The folder is one of today that aged.py changes. Environment as of processes.py.
"""
import json
import signal
import sqlite3
import subprocess
import urllib.request

import aged
from processes import BINARIES, BRIEF, CAMPAIGN, LOST_CODE, PATIENCE_S, main, stored, wait_for
from service_case import ServiceCase

CASES = 20
MANY = 5000  # more than fly until the coordinator is stopped


class UpgradeTest(ServiceCase):
    DOMAIN = "35"
    PORT = 18535

    def setUp(self):
        super().setUp()
        version = subprocess.run([BINARIES / "dispersa", "--version", "--json"], capture_output=True, text=True)
        self.engine = json.loads(version.stdout)["engine"]

    def start_coordinator(self):
        return self.start("dispersa-coordinator", "--data", self.data, "--web", self.PORT)

    def stop(self):
        for process in self.processes:
            process.send_signal(signal.SIGTERM)
        for process in self.processes:
            self.assertEqual(process.wait(timeout=PATIENCE_S), 0)
        self.processes.clear()

    def upgrade(self):
        self.stop()
        aged.age(self.data)
        self.start_coordinator()
        self.start_worker("--slots", 2)

    def listed(self):
        return json.loads(self.dispersa("list", "--json"))["campaigns"]

    def local(self, *arguments, code=0):
        """Runs a command that needs no coordinator."""
        done = subprocess.run([BINARIES / "dispersa", *map(str, arguments)], capture_output=True, text=True,
                              timeout=PATIENCE_S)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def launched(self, *arguments):
        return self.dispersa("launch", *arguments).strip()

    def launch_and_watch(self, campaign=CAMPAIGN, code=LOST_CODE):
        identity = self.launched(campaign, "--cases", CASES)
        self.dispersa("watch", identity, code=code)
        return identity

    def test_what_is_done_never_needs_its_engine(self):
        self.start_coordinator()
        self.start_worker("--slots", 2)
        identity = self.launch_and_watch()
        before = self.fetch(identity)
        self.stop()
        # An older engine had an input that this one does not know.
        with sqlite3.connect(self.data / identity / "results" / "results.sqlite") as rows:
            rows.execute("INSERT INTO nominal VALUES ('of_an_older_engine', 1.0)")
        rows.close()
        self.upgrade()
        self.assertEqual([(c["id"], c["state"], c["done"], c["engine"]) for c in self.listed()],
                         [(identity, "done", CASES, aged.ENGINE)])
        self.assertIn(f"engine {aged.ENGINE}", self.dispersa("list"))
        self.dispersa("watch", identity, code=LOST_CODE)
        after = self.fetch(identity)
        for name in ("cases.csv", "summary.json", "report.html"):
            self.assertEqual((before / name).read_bytes(), (after / name).read_bytes(), name)

        refused = self.dispersa("repair", identity, "--worker", "node1", code=2)
        self.assertEqual(refused, "")
        self.assertIn(f"was flown by engine {aged.ENGINE} and cannot be repaired by engine {self.engine}", self.error)
        self.assertEqual(self.status(identity)["state"], "done")

    def test_folders_of_another_engine(self):
        self.start_coordinator()
        self.start_worker("--slots", 2)
        identity = self.launch_and_watch(BRIEF, code=0)  # a page with all its parts
        self.upgrade()
        out, page = self.fetch(identity), "report.html"
        self.local("compare", out, out)
        self.local("export", out, "--format", "csv", "--out", self.data.parent / "cases.csv")
        histories = {file: file.read_bytes() for file in (out / "histories").iterdir()}
        summary = json.loads((out / "summary.json").read_text())
        done = self.local("report", out)
        self.assertIn(f"flown by engine {aged.ENGINE}, and this one, {self.engine}, flew nothing: the stored histories "
                      "are drawn", done.stderr)
        self.assertNotIn("flights", done.stderr.replace("flew", ""), "no flight is repeated")
        self.assertEqual({file: file.read_bytes() for file in (out / "histories").iterdir()}, histories)
        again = json.loads((out / "summary.json").read_text())
        for event in summary["events"]:
            for name in ("time_s", "altitude_m", "speed_m_s", "qbar_pa", "mass_kg"):
                event[name]["nominal"] = None
        self.assertEqual(again, {**summary, "engine": aged.ENGINE, "nominal": None,  # it was not flown
                                 "campaign": {**summary["campaign"], "flight_id": aged.FLIGHT}})
        html = (out / page).read_text()
        self.assertIn(f"page by engine <code>{self.engine[:12]}</code>, which flew nothing", html)
        self.assertNotIn("without time histories", html)
        # Histories that somebody has changed are not drawn, and not removed.
        changed = out / "histories" / "nominal.csv.gz"
        changed.write_bytes(changed.read_bytes()[:-1])
        self.assertIn("it has no stored histories that are whole", self.local("report", out).stderr)
        self.assertIn("without time histories", (out / page).read_text())
        self.local("report", out, "--no-histories")
        self.assertEqual({file.name for file in (out / "histories").iterdir()}, {file.name for file in histories})

    def test_a_new_engine_flies_the_same_campaign_beside_the_old_flight(self):
        self.start_coordinator()
        self.start_worker("--slots", 2)
        identity = self.launch_and_watch()
        self.upgrade()
        self.assertEqual(self.launch_and_watch(), identity, "it stops no pipeline")
        old = f"{identity}-{aged.ENGINE.partition('+')[2]}"
        self.assertEqual({(c["id"], c["engine"], c["state"]) for c in self.listed()},
                         {(identity, self.engine, "done"), (old, aged.ENGINE, "done")})
        self.assertEqual(self.status(identity[:8])["engine"], self.engine, "the short id is that of the present flight")
        for name in (old, f"{identity[:8]}-{aged.ENGINE.partition('+')[2][:3]}"):
            self.assertEqual(self.status(name)["id"], old)
        engines = [json.loads((self.fetch(name) / "summary.json").read_text())["engine"] for name in (identity, old)]
        self.assertEqual(engines, [self.engine, self.engine], "the old report is as it was written")
        page = f"http://127.0.0.1:{self.PORT}/campaign/{old}"
        self.assertIn(aged.ENGINE.encode(), urllib.request.urlopen(page, timeout=PATIENCE_S).read())
        self.launch_and_watch()
        self.assertEqual(len(self.listed()), 2, "launched again it is there already")
        self.stop()
        self.start_coordinator()
        self.assertEqual(len(self.listed()), 2, "over a restart")
        self.dispersa("delete", old)
        self.assertEqual([c["id"] for c in self.listed()], [identity])

    def test_what_lacks_its_report_alone_gets_it_without_a_flight(self):
        self.start_coordinator()
        self.start_worker("--slots", 2)
        identity = self.launch_and_watch()
        before = json.loads((self.fetch(identity) / "summary.json").read_text())
        self.stop()
        aged.age(self.data)
        state = self.data / identity / "state.json"
        state.write_text(aged.sealed({**json.loads(state.read_text()), "state": "reporting", "verdict": ""}))
        for name in ("SHA256SUMS", "summary.json", "report.html.gz"):
            (self.data / identity / "results" / name).unlink()
        self.start_coordinator()
        self.dispersa("watch", identity, code=LOST_CODE)
        entry = self.status(identity)
        self.assertEqual((entry["verdict"], entry["engine"], entry["done"]), ("fail", aged.ENGINE, CASES))
        after = json.loads((self.fetch(identity) / "summary.json").read_text())
        self.assertEqual((after["engine"], after["requirements"]), (aged.ENGINE, before["requirements"]))
        attempts = [json.loads(line) for line in (self.data / "dispersa-attempts.jsonl").read_text().splitlines()]
        self.assertEqual(attempts[-1]["engine"], aged.ENGINE)

    def test_what_flew_keeps_its_cases_and_says_which_engine_it_needs(self):
        self.start_coordinator()
        self.start_worker("--slots", 1)
        identity = self.launched(BRIEF, "--cases", MANY)
        results = self.data / identity / "results"
        wait_for(lambda: stored(results) > 100, "results")
        flight = json.loads((self.data / identity / "state.json").read_text())["flight_id"]
        self.upgrade()
        count = stored(results)
        entry = self.status(identity)
        self.assertEqual((entry["state"], entry["done"], entry["total"], entry["code"]), ("unfinished", count, MANY, 5))
        self.assertEqual(entry["problem"],
                         f"{count} of {MANY} cases are stored, flown by engine {aged.ENGINE}, and this coordinator has engine "
                         f"{self.engine}: start that one again to go on, or launch the campaign again to fly all cases anew")
        self.dispersa("watch", identity, code=5)
        self.assertEqual(stored(self.fetch(identity)), count)
        # The older engine again: the campaign goes on where it was.
        self.stop()
        aged.age_results(results, self.engine, flight)
        self.start_coordinator()
        wait_for(lambda: self.status(identity)["state"] == "flying", "the flight of before")
        self.assertEqual((self.status(identity)["done"], self.status(identity)["problem"]), (count, None))
        # And the new one once more, with which the campaign is launched again.
        self.upgrade()
        self.assertEqual(self.status(identity)["state"], "unfinished")
        self.assertEqual(self.launched(BRIEF, "--cases", MANY), identity)
        wait_for(lambda: self.status(identity)["state"] == "flying", "the flight beside")
        states = {c["engine"]: (c["state"], c["done"]) for c in self.listed()}
        self.assertEqual(states[aged.ENGINE], ("unfinished", count))


if __name__ == "__main__":
    main()
