"""dispersa run as processes: the same bytes whatever dies, and nothing left behind.

Environment as of processes.py.
"""
import json
import os
import pathlib
import re
import shlex
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

from processes import (BINARIES, CAMPAIGN, HALF_WAY_CASES, ISOLATED, PATIENCE_S, Run, is_running, main, parent_and_name,
                       shared_memory_segments, stored, wait_for)


class RunCase(unittest.TestCase):
    cases = 60

    @classmethod
    def setUpClass(cls):
        cls.segments = shared_memory_segments()
        cls.root = pathlib.Path(tempfile.mkdtemp(prefix="dispersa-run-"))
        cls.reference = Run(cls.root / "reference", "--workers", 0, "--cases", cls.cases, "--no-histories").finish()
        if cls.reference.code not in (0, 3, 4):
            raise AssertionError(f"reference: exit code {cls.reference.code}\n{cls.reference.stderr}")

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.root)

    def setUp(self):
        self.runs = []

    def tearDown(self):
        for run in self.runs:
            if run.process.poll() is None:
                run.process.kill()
                run.finish()
            pids = run.execution()["pids"] if (run.out / "execution.json").exists() else []
            wait_for(lambda: not any(map(is_running, pids)), f"end of the processes {pids}")
        self.assertEqual(shared_memory_segments(), self.segments)

    def run_dispersa(self, name, *arguments, cases=None, histories=False, **options):
        run = Run(self.root / name, "--cases", cases or self.cases, *arguments, *([] if histories else ["--no-histories"]),
                  **options)
        self.runs.append(run)
        return run

    def assert_same(self, run):
        self.assertEqual(run.code, self.reference.code, run.stderr)
        self.assertEqual(run.csv(), self.reference.csv())
        self.assertEqual((run.out / "summary.json").read_bytes(), (self.reference.out / "summary.json").read_bytes())
        self.assertEqual(run.stdout.splitlines()[-1], f"result: {run.out}")


class Whole(RunCase):
    """Nothing interrupts the campaign."""

    def test_a_campaign_can_be_extended_and_never_shrinks(self):
        self.assertIn(self.run_dispersa("extended", "--workers", 1, cases=self.cases // 2).finish().code, (0, 3, 4))
        for cases in (self.cases, self.cases // 2):
            extended = self.run_dispersa("extended", "--workers", 1, "--resume", cases=cases).finish()
            self.assertEqual(extended.code, self.reference.code, extended.stderr)
            self.assertEqual(extended.csv(), self.reference.csv())
            # The summary is that of a campaign flown at once; that it was read before is no part of it.
            self.assertEqual(*((run.out / "summary.json").read_bytes() for run in (extended, self.reference)))
        fewer = extended
        self.assertIn(f"{fewer.out} holds more cases than the {self.cases // 2} asked for: "
                      f"the campaign is extended to {self.cases}", fewer.stderr)

    def test_resume_starts_what_was_never_begun(self):
        self.assert_same(self.run_dispersa("new", "--workers", 2, "--resume").finish())

    def test_resume_starts_what_was_killed_before_it_began(self):
        out = self.root / "stillborn"
        out.mkdir()
        for name in ("campaign.yaml", "campaign.yaml.tmp", "results.sqlite.tmp", "results.sqlite.tmp-wal"):
            (out / name).write_text("half")
        self.assert_same(self.run_dispersa("stillborn", "--workers", 2, "--resume").finish())
        self.assertEqual([p.name for p in out.iterdir() if ".tmp" in p.name], [])

    def test_a_folder_of_another_flight_id_is_not_touched(self):
        before = sorted((p.name, p.read_bytes()) for p in self.reference.out.iterdir() if p.is_file())
        run = self.run_dispersa("reference", "--resume", "--seed", 999).finish()
        self.assertEqual(run.code, 2)
        self.assertRegex(run.stderr, f"{re.escape(str(run.out))}: holds results of flight id [0-9a-f]{{64}}, "
                                     "the campaign's is [0-9a-f]{64}\n$")
        self.assertEqual(run.stdout, "")
        run = self.run_dispersa("reference").finish()
        self.assertEqual(run.code, 2)
        self.assertRegex(run.stderr, f"{re.escape(str(run.out))}: the folder is not empty, allowed: a new or an empty "
                                     "folder, or --resume to continue a campaign of the same flight id\n$")
        after = sorted((p.name, p.read_bytes()) for p in self.reference.out.iterdir() if p.is_file())
        self.assertEqual(before, after)

    def test_a_folder_that_cannot_be_written_is_bad_usage(self):
        (self.root / "file").write_text("")
        run = self.run_dispersa("file/out").finish()
        self.assertEqual(run.code, 2, run.stderr)
        self.assertIn(str(run.out), run.stderr)

    def test_a_missing_worker_program_is_reported(self):
        lonely = self.root / "lonely"
        lonely.mkdir()
        shutil.copy(BINARIES / "dispersa", lonely)
        run = self.run_dispersa("no-workers", "--workers", 2, program=lonely / "dispersa").finish()
        self.assertEqual(run.code, 5)
        self.assertIn(f"{lonely}/dispersa-worker: no worker can be started: No such file or directory", run.stderr)
        self.assertEqual(run.execution()["problem"],
                         f"{lonely}/dispersa-worker: no worker can be started: No such file or directory")

    def test_workers_that_end_at_once_are_not_replaced_for_ever(self):
        hopeless = self.root / "hopeless"
        hopeless.mkdir()
        shutil.copy(BINARIES / "dispersa", hopeless)
        (hopeless / "dispersa-worker").write_text("#!/bin/sh\nexit 7\n")
        (hopeless / "dispersa-worker").chmod(0o755)
        run = self.run_dispersa("hopeless-run", "--workers", 2, program=hopeless / "dispersa").finish()
        self.assertEqual(run.code, 5, run.stderr)
        self.assertRegex(run.execution()["problem"],
                         "^1[12] workers ended in a row without a result, the last one with exit code 7$")

    def test_json_is_the_summary_with_the_folder(self):
        run = self.run_dispersa("json", "--workers", 2, "--json", "--quiet", cases=20, histories=True).finish()
        self.assertEqual(run.stderr, "")
        printed = json.loads(run.stdout)
        self.assertEqual(printed.pop("directory"), str(run.out))
        self.assertEqual(printed, json.loads((run.out / "summary.json").read_text()))

    def test_progress_goes_to_stderr(self):
        self.assertRegex(self.reference.stderr, rf"(?m)^\S+: {self.cases}/{self.cases} \(100 %\), .*/s, .*, in process$")
        self.assertEqual(self.reference.stdout.splitlines()[-1], f"result: {self.reference.out}")


class HalfWay(RunCase):
    """Something happens while the campaign is flown, by one worker in most tests."""
    cases = HALF_WAY_CASES

    def test_three_workers_give_the_same_bytes(self):
        rows = self.reference.csv().splitlines()
        self.assertEqual(len(rows), self.cases + 1)
        self.assertEqual([int(row.split(b",")[0]) for row in rows[1:]], list(range(self.cases)))
        run = self.run_dispersa("workers3", "--workers", 3)
        wait_for(lambda: (run.out / "execution.json").exists() and len(run.workers()) == 3, "three workers")
        for pid in run.workers():
            self.assertEqual(parent_and_name(pid), (run.process.pid, "dispersa-worker"))
        self.assert_same(run.finish())
        self.assertEqual(len(run.execution()["workers"]), 3)

    def end_worker(self, name, how):
        """How the worker that was sent this signal half-way ended. It is the only one, so nothing ends without another."""
        run = self.run_dispersa(name, "--workers", 1)
        run.wait_half_way(self.cases)
        (victim,) = run.workers()
        os.kill(victim, how)
        self.assert_same(run.finish())
        ends = {w["pid"]: w["end"] for w in run.execution()["workers"]}
        self.assertEqual(len(ends), 2, "not replaced, or more than once")
        return ends[victim]

    def test_a_worker_killed_half_way(self):
        self.assertEqual(self.end_worker("kill", signal.SIGKILL), "signal 9 (Killed)")

    def test_a_worker_that_crashes_half_way(self):
        # The case that it flew is blamed, flown again alone, and not quarantined.
        self.assertEqual(self.end_worker("crash", signal.SIGSEGV), "signal 11 (Segmentation fault)")

    def test_a_worker_that_stops_beating_is_killed_and_replaced(self):
        self.assertEqual(self.end_worker("stop", signal.SIGSTOP), "signal 9 (Killed)")

    def test_the_whole_run_killed_and_resumed(self):
        run = self.run_dispersa("killed", "--workers", 1)
        run.wait_half_way(self.cases)
        pids = run.execution()["pids"]
        self.assertEqual(len(pids), 2)
        run.process.kill()
        run.finish()
        wait_for(lambda: not any(map(is_running, pids)), "end of the workers")
        stored = run.stored()
        self.assertGreater(stored, 0)
        self.assertLess(stored, self.cases)
        resumed = self.run_dispersa("killed", "--workers", 1, "--resume").finish()
        self.assert_same(resumed)
        self.assertEqual(resumed.execution()["cases_before"], stored)
        self.assertEqual(resumed.execution()["cases_flown"], self.cases - stored)

    def test_an_interrupted_run_tells_how_to_go_on(self):
        for number, workers in ((signal.SIGINT, 1), (signal.SIGTERM, 0)):
            run = self.run_dispersa(f"interrupted{number}", "--workers", workers)
            run.wait_half_way(self.cases)
            run.process.send_signal(number)
            asked = time.monotonic()
            run.finish()
            self.assertLess(time.monotonic() - asked, 10.0)
            self.assertEqual(run.code, 130, run.stderr)
            self.assertEqual(run.stdout, "")
            command = (f"dispersa run {shlex.quote(CAMPAIGN)} --cases {self.cases} --workers {workers} "
                       f"--out {run.out} --resume")
            self.assertEqual(run.stderr.splitlines()[-1], f"interrupted; to continue: {command}")
            self.assertTrue(0 < run.stored() < self.cases)
        arguments = shlex.split(command)
        resumed = subprocess.run([BINARIES / arguments[0], *arguments[1:], "--no-histories"], capture_output=True,
                                 timeout=3 * PATIENCE_S)
        self.assertEqual(resumed.returncode, self.reference.code)
        self.assertEqual(run.csv(), self.reference.csv())

    def test_a_full_disk_is_incomplete(self):
        disk = self.root / "disk"
        disk.mkdir()
        campaign_size = (self.reference.out / "campaign.yaml").stat().st_size
        subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={campaign_size + 500_000}", "tmpfs", disk], check=True)
        try:
            run = self.run_dispersa("disk/out", "--workers", 2).finish()
            self.assertEqual(run.code, 5, run.stderr)
            self.assertRegex(run.stderr, "no space left on the disk\n"
                                         "to continue when the disk has space: dispersa run .* --resume\n$")
            subprocess.run(["mount", "-o", "remount,size=1g", disk], check=True)
            self.assert_same(self.run_dispersa("disk/out", "--workers", 2, "--resume").finish())
        finally:
            self.runs.clear()
            subprocess.run(["umount", "-l", disk], check=True)


if ISOLATED not in os.environ:
    del HalfWay.test_a_full_disk_is_incomplete  # it mounts a small disk


if __name__ == "__main__":
    main()
