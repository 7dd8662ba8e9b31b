"""A coordinator's disk: it is full, somebody else has the database open, or old campaigns must go.

Environment as of processes.py. The full disk is a tmpfs in the mount namespace of this program.
"""
import errno
import json
import os
import resource
import sqlite3
import subprocess
import unittest

from processes import BINARIES, CAMPAIGN, ISOLATED, LOST_CODE, PATIENCE_S, SMOKE, Run, main, stored, wait_for
from service_case import ServiceCase

CASES = 12
MANY = 300
DISK = 128 << 20  # histories and page of smoke.yaml take about 20 MB


class StorageTest(ServiceCase):
    DOMAIN = "38"
    CASES = MANY

    def results(self, identity):
        return self.data / identity / "results"

    def fill(self, leave=0):
        """Takes the space that is left but for so many bytes."""
        file = self.data / "filling"
        with file.open("wb") as out:
            while True:
                space = os.statvfs(self.data)
                try:
                    os.posix_fallocate(out.fileno(), 0, space.f_bavail * space.f_frsize - leave)
                    return file
                except OSError as error:  # the coordinator has written meanwhile
                    if error.errno != errno.ENOSPC:
                        raise

    def wait_until_it_waits(self, identity):
        wait_for(lambda: ": no space left on the disk; it " in (self.status(identity)["problem"] or ""),
                 "the words that say so")

    @unittest.skipUnless(ISOLATED in os.environ, "no mount namespace of its own")
    def test_a_full_disk_delays_campaigns_and_costs_no_byte(self):
        subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={DISK}", "disk", self.data], check=True)
        self.addCleanup(subprocess.run, ["umount", "--lazy", self.data], check=True)
        coordinator = self.start_coordinator()
        flying = self.dispersa("launch", SMOKE, "--cases", CASES).strip()
        wait_for(lambda: stored(self.results(flying)) == 0 and (self.results(flying) / "results.sqlite").exists(), "a flying campaign")
        filling = self.fill()
        self.start_worker()
        self.wait_until_it_waits(flying)
        # Nothing is promised to a client that could not be kept.
        self.dispersa("launch", CAMPAIGN, "--cases", MANY, code=5)
        self.assertRegex(self.error, "no space left on (the disk|device)")
        self.assertEqual([each["id"] for each in json.loads(self.dispersa("list", "--json"))["campaigns"]], [flying])
        self.assertEqual(stored(self.results(flying)), 0)
        filling.unlink()
        self.dispersa("watch", flying)
        self.assertIsNone(self.status(flying)["problem"])
        self.assertEqual(stored(self.fetch(flying)), CASES)
        # All results find space, and the report does not.
        reference = Run(self.root / "other", "--workers", 0, "--cases", CASES, "--seed", 7, campaign=SMOKE).finish()
        filling = self.fill(leave=6 << 20)
        other = self.dispersa("launch", SMOKE, "--cases", CASES, "--seed", 7).strip()
        self.wait_until_it_waits(other)
        self.assertEqual((self.status(other)["state"], stored(self.results(other))), ("reporting", CASES))
        filling.unlink()
        self.dispersa("watch", other, code=reference.code)
        self.assert_same_folder(other, reference)
        self.assertIsNone(coordinator.poll())

    def test_descriptors_that_run_out_delay_a_campaign(self):
        coordinator = self.start_coordinator()
        self.start_worker()
        first = self.dispersa("launch", CAMPAIGN, "--cases", 20).strip()
        self.dispersa("watch", first, code=LOST_CODE)
        usual = resource.prlimit(coordinator.pid, resource.RLIMIT_NOFILE)
        few = len(os.listdir(f"/proc/{coordinator.pid}/fd")) + 3
        resource.prlimit(coordinator.pid, resource.RLIMIT_NOFILE, (few, usual[1]))
        identity = self.dispersa("launch", CAMPAIGN, "--cases", MANY).strip()
        wait_for(lambda: "too many files are open" in (self.status(identity)["problem"] or ""), "the words that say so")
        self.assertEqual(self.status(identity)["state"], "waiting")
        self.assertRegex(self.status(identity)["problem"], "; it continues by itself$")
        resource.prlimit(coordinator.pid, resource.RLIMIT_NOFILE, usual)
        self.dispersa("watch", identity, code=self.reference.code)
        self.assert_same_folder(identity, self.reference)
        self.assertIsNone(coordinator.poll())

    def test_a_campaign_whose_database_somebody_reads_is_fetched_whole(self):
        self.start_coordinator()
        identity = self.dispersa("launch", CAMPAIGN, "--cases", MANY).strip()
        wait_for((self.results(identity) / "results.sqlite").exists, "a flying campaign")
        reader = sqlite3.connect(f"file:{self.results(identity)}/results.sqlite?mode=ro", uri=True, isolation_level=None)
        self.addCleanup(reader.close)
        reader.execute("BEGIN")
        self.assertEqual(reader.execute("SELECT count(*) FROM cases").fetchone(), (0,))
        self.start_worker()
        self.dispersa("watch", identity, code=self.reference.code)
        self.assertEqual(reader.execute("SELECT count(*) FROM cases").fetchone(), (0,), "what it has begun to read")
        self.assertGreater((self.results(identity) / "results.sqlite-wal").stat().st_size, 0, "the reader holds the log back")
        out = self.assert_same_folder(identity, self.reference)
        self.assertEqual(stored(out), self.status(identity)["done"])
        # A report from it has all rows, too.
        subprocess.run([BINARIES / "dispersa", "report", out, "--quiet"], stdout=subprocess.DEVNULL)
        self.assertEqual((out / "cases.csv").read_bytes(), self.reference.csv())

    def start_keeping(self, *limits):
        return self.start("dispersa-coordinator", "--data", self.data, *(f"--keep={limit}" for limit in limits))

    def test_old_campaigns_go_by_age_and_size_and_leave_a_line(self):
        coordinator = self.start_keeping("90d", "1TB")
        ended = []
        for seed in (1, 2):
            ended.append(self.dispersa("launch", CAMPAIGN, "--cases", 20, "--seed", seed).strip())
            self.dispersa("cancel", ended[-1])
        waiting = self.dispersa("launch", CAMPAIGN, "--cases", MANY).strip()

        def assert_left_by(limits, expected):
            """Old campaigns go at the start, and perhaps after the first answers."""
            nonlocal coordinator
            coordinator.terminate()
            self.assertEqual(coordinator.wait(timeout=PATIENCE_S), 0)
            coordinator = self.start_keeping(*limits)
            wait_for(lambda: {each["id"] for each in json.loads(self.dispersa("list", "--json"))["campaigns"]} == expected,
                     f"{expected} and no other")
        assert_left_by(["90d", "1TB"], {*ended, waiting})
        assert_left_by(["0.00001d"], {waiting})  # less than a second
        lines = [json.loads(line) for line in (self.data / "deleted.jsonl").read_text().splitlines()]
        self.assertEqual([(line["id"], line["state"]) for line in lines], [(each, "cancelled") for each in ended])
        self.assertEqual({path.name for path in self.data.iterdir() if path.is_dir()}, {waiting})
        # A size that one campaign has already: nothing that has not ended goes.
        assert_left_by(["0.001MB"], {waiting})
        self.start_worker()
        self.dispersa("watch", waiting, code=self.reference.code)
        self.assert_same_folder(waiting, self.reference)
        assert_left_by(["0.001MB"], set())


if __name__ == "__main__":
    main()
