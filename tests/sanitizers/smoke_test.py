"""The distributed smoke campaign: what a service meets in a day, in one minute; made to be run under sanitizers.

Environment as of processes.py, its programs those under test; DISPERSA_REFERENCE: the folder of the ordinary programs,
whose bytes are expected; DISPERSA_NOOP_WORKER as of audit_test.py.
"""
import os
import pathlib
import signal
import socket
import sqlite3
import sys
import urllib.request

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "distributed"))
from processes import CAMPAIGN, PATIENCE_S, Run, content, main, wait_for  # noqa: E402
from service_case import ServiceCase  # noqa: E402

REFERENCE = pathlib.Path(os.environ["DISPERSA_REFERENCE"]) / "dispersa"
CASES = 40
FILES = ("cases.csv", "summary.json", "report.html")
ENDLESS = 10**6  # cases: whatever is done while they are flown is done half-way
OTHER_SEED = 7


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class SmokeTest(ServiceCase):
    DOMAIN = "33"
    CASES = CASES
    REFERENCE_PROGRAM = REFERENCE

    def run_dispersa(self, name, *arguments):
        run = Run(self.root / name, "--cases", CASES, *arguments).finish()
        self.assertEqual(run.code, self.reference.code, run.stderr)
        for file in FILES:
            self.assertEqual(content(run.out, file), content(self.reference.out, file), file)

    def test_threads(self):
        self.run_dispersa("threads", "--workers", 0, "--threads", 2)

    def test_workers(self):
        self.run_dispersa("workers", "--workers", 2)

    def start_coordinator(self):
        self.metrics_port, self.web_port = free_port(), free_port()
        return self.start("dispersa-coordinator", "--data", self.data, "--audit", "0.2", "--metrics", self.metrics_port,
                          "--web", self.web_port)

    def page(self, identity):
        address = f"http://127.0.0.1:{self.web_port}/campaign/{identity}?part=1"
        return urllib.request.urlopen(address, timeout=PATIENCE_S).read().decode()

    def done(self, identity):
        return self.status(identity)["done"]

    def wait_for_more(self, identity):
        before = self.done(identity)
        wait_for(lambda: self.done(identity) > before, f"more cases than {before}")

    def finish(self, process):
        self.assertEqual(process.wait(timeout=PATIENCE_S), 0, self.log.read_text()[-3000:])

    def test_service(self):
        coordinator = self.start_coordinator()
        endless = self.dispersa("launch", CAMPAIGN, "--cases", ENDLESS, "--seed", OTHER_SEED).strip()
        finite = self.dispersa("launch", CAMPAIGN, "--cases", CASES).strip()
        # Alone, so that its first result is audited: a worker that makes its results up is expelled.
        self.finish(self.start(os.environ["DISPERSA_NOOP_WORKER"]))
        watcher = self.start("dispersa", "watch", finite, "--web", env={**os.environ, "BROWSER": "true"})
        worker = self.start_worker("--slots", 2)
        self.start_worker()
        self.wait_for_more(endless)
        worker.kill()
        replacement = self.start_worker("--slots", 2)
        self.wait_for_more(endless)
        coordinator.terminate()
        self.finish(coordinator)
        coordinator = self.start_coordinator()
        self.wait_for_more(endless)
        self.assertIn("dispersa_", urllib.request.urlopen(f"http://127.0.0.1:{self.metrics_port}", timeout=PATIENCE_S).read().decode())
        self.dispersa("watch", finite, code=self.reference.code)
        self.assertEqual(watcher.wait(timeout=PATIENCE_S), self.reference.code)
        wait_for(lambda: "Open the report" in self.page(finite), "the end on the page")
        self.assertIn("Workers of this coordinator", self.page(endless))
        self.dispersa("cancel", endless)
        self.assert_same_folder(finite, self.reference)
        self.assert_same_rows(self.fetch(endless))
        replacement.send_signal(signal.SIGTERM)
        self.finish(replacement)
        coordinator.terminate()
        self.finish(coordinator)

    def assert_same_rows(self, out):
        """What was flown of the endless campaign is what the ordinary programs fly."""
        with sqlite3.connect(out / "results.sqlite") as database:
            last, = database.execute("SELECT max(case_index) FROM cases").fetchone()
            reference = Run(self.root / "endless", "--workers", 0, "--cases", last + 1, "--seed", OTHER_SEED, "--no-histories",
                            program=REFERENCE).finish()
            database.execute("ATTACH ? AS reference", [str(reference.out / "results.sqlite")])
            self.assertEqual(database.execute("SELECT * FROM cases EXCEPT SELECT * FROM reference.cases").fetchall(), [])


if __name__ == "__main__":
    main()
