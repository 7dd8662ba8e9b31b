"""A campaign in shares: what `merge` makes of them is what one run makes.
"""
import concurrent.futures
import json
import os
import pathlib
import random
import re
import resource
import shutil
import sqlite3
import subprocess
import time
import unittest

import yaml

from programs import BINARIES, SMOKE, TIMEOUT_S, dispersa, folder_of, smoke_text

CASES = 30
DEPLOY = pathlib.Path(__file__).resolve().parents[2] / "services" / "deploy"


def share(campaign, shard, out, *more):
    return dispersa("run", campaign, "--shard", shard, "--out", out, "--quiet", *more)


def merge(out, *folders, more=("--no-histories", "--quiet"), **options):
    return dispersa("merge", *folders, "--out", out, *more, **options)


def few_files():
    """A merge does not hold all folders open."""
    resource.setrlimit(resource.RLIMIT_NOFILE, (40, 40))


def without_run(page):
    """A report without what depends on when and where it was flown."""
    text = page.read_text()
    parts = text.split("<!-- run:begin -->")
    return parts[0] + "".join(part.split("<!-- run:end -->")[1] for part in parts[1:])


class Shares(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = folder_of(cls)
        cls.campaign = ("--cases", CASES, "--workers", "0")
        cls.whole = cls.folder / "one" / "whole"
        done = dispersa("run", SMOKE, *cls.campaign, "--no-histories", "--quiet", "--out", cls.whole)
        assert done.returncode == 0, done.stderr
        cls.shares = [cls.folder / "three" / str(i) for i in range(3)]
        for i, folder in enumerate(cls.shares):
            done = share(SMOKE, f"{i}/3", folder, *cls.campaign)
            assert done.returncode == 0, done.stderr

    def copied(self, *numbers):
        copies = []
        for number in numbers:
            copies.append(self.folder / self.id() / str(number))
            shutil.copytree(self.shares[number], copies[-1])
        return copies

    def change(self, folder, sql):
        with sqlite3.connect(folder / "results.sqlite") as database:
            database.executescript(sql)

    def read(self, folder, sql):
        with sqlite3.connect(f"file:{folder}/results.sqlite?mode=ro", uri=True) as database:
            return database.execute(sql).fetchall()

    def remove(self, folder, which):
        self.change(folder, "".join(f"DELETE FROM {table} WHERE {which};" for table in ("cases", "events", "execution")))

    def assert_same(self, merged, whole=None):
        whole = whole or self.whole
        tables = [name for name, in self.read(whole, "SELECT name FROM sqlite_master WHERE type = 'table' ORDER BY name")]
        self.assertIn("events", tables)
        for table in tables:
            sql = f"SELECT {'case_index' if table == 'execution' else '*'} FROM {table}"  # not who and when
            self.assertEqual(sorted(map(repr, self.read(merged, sql))), sorted(map(repr, self.read(whole, sql))), table)
        for name in ("cases.csv", "summary.json", "nominal.json", "campaign.yaml"):
            self.assertEqual((merged / name).read_bytes(), (whole / name).read_bytes(), name)
        self.assertEqual(without_run(merged / "report.html"), without_run(whole / "report.html"))

    def assert_refused(self, done, out, *lines):
        self.assertEqual((done.returncode, done.stdout), (2, ""), done.stderr)
        self.assertEqual(done.stderr.splitlines(), list(lines))
        self.assertEqual(list(out.iterdir()) if out.exists() else [], [])

    def test_in_any_order_are_one_run(self):
        out = self.folder / self.id() / "merged"
        done = merge(out, self.shares[2], self.shares[0], self.shares[1])
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(done.stdout.splitlines()[-3:], [
            "VERDICT pass, next: read the report's assumptions and warnings",
            f"report: {out}/report.html", f"result: {out}"])
        self.assert_same(out)
        attempts = [json.loads(line) for line in (out.parent / "dispersa-attempts.jsonl").read_text().splitlines()]
        self.assertEqual([(one["cases"], one["verdict"]) for one in attempts], [(0, ""), (CASES, "pass")])
        self.assertFalse((self.shares[0].parent / "dispersa-attempts.jsonl").exists())
        # It is a folder as any other.
        self.assertEqual(dispersa("replay", out, "--case", CASES - 1, "--quiet").returncode, 0)
        self.assertEqual(dispersa("run", SMOKE, "--cases", CASES + 2, "--workers", "0", "--no-histories", "--quiet", "--out",
                                  out, "--resume").returncode, 0)

    def test_of_any_number_in_any_order_are_one_run(self):
        over_dds = self.folder / self.id() / "dds"
        done = dispersa("run", SMOKE, "--cases", CASES, "--workers", 2, "--no-histories", "--quiet", "--out", over_dds)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_same(over_dds)
        for count in (1, 7, 64):  # 64: more than there are cases
            folders = [self.folder / self.id() / str(count) / str(i) for i in range(count)]
            def fly(folder, count=count):
                return share(SMOKE, f"{folder.name}/{count}", folder, "--cases", CASES, "--threads", 1 + count % 2, "--resume")
            for flights in (random.Random(count).sample(folders, count), folders[:7]):  # some are repeated
                with concurrent.futures.ThreadPoolExecutor(2) as two:
                    for done in two.map(fly, flights):
                        self.assertEqual((done.returncode, done.stderr), (0, ""))
            out = folders[0].parent / "merged"
            done = merge(out, *random.Random(count).sample(folders, count), preexec_fn=few_files)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assert_same(out)

    def test_with_histories(self):
        out, whole = self.folder / self.id() / "merged", self.folder / self.id() / "one" / "whole"
        self.assertEqual(dispersa("run", SMOKE, *self.campaign, "--quiet", "--out", whole).returncode, 0)
        self.assertEqual(merge(out, *self.shares, more=("--quiet",)).returncode, 0)
        self.assert_same(out, whole)
        for file in sorted(whole.glob("histories/*.csv.gz")):
            self.assertEqual((out / "histories" / file.name).read_bytes(), file.read_bytes(), file.name)

    def test_one_that_is_killed_goes_on(self):
        folder, cases = self.folder / self.id(), ("--cases", "1000")
        shares = [folder / "0", folder / "1"]
        command = [BINARIES / "dispersa", "run", SMOKE, "--shard", "1/2", *cases, "--threads", "1", "--out", shares[1], "--quiet"]
        running = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            deadline = time.monotonic() + TIMEOUT_S
            flown = 0
            while flown == 0 and time.monotonic() < deadline:
                time.sleep(0.005)
                if (shares[1] / "results.sqlite").exists():
                    flown = self.read(shares[1], "SELECT count(*) FROM cases")[0][0]
        finally:
            running.kill()
            running.wait()
        flown = self.read(shares[1], "SELECT count(*) FROM cases")[0][0]
        self.assertLess(0, flown)
        self.assertLess(flown, 500)
        self.assertEqual(share(SMOKE, "0/2", shares[0], *cases).returncode, 0)
        self.assert_refused(merge(folder / "merged", *shares), folder / "merged",
                            f"{shares[1]}: holds {flown} of its 500 cases, allowed: the share after its own command with --resume")
        done = share(SMOKE, "1/2", shares[1], *cases, "--resume", "--json")
        self.assertEqual(json.loads(done.stdout),
                         {"schema": "dispersa/share/1", "cases": 500, "flown": 500, "directory": str(shares[1])})
        self.assertEqual(self.read(shares[1], "SELECT min(case_index), max(case_index) FROM cases"), [(500, 999)])
        self.assertEqual(merge(folder / "merged", *shares).returncode, 0)
        done = dispersa("run", SMOKE, *cases, "--workers", 0, "--no-histories", "--quiet", "--out", folder / "one" / "whole")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_same(folder / "merged", folder / "one" / "whole")

    def test_a_merge_goes_on_when_the_disk_has_space(self):
        out = self.folder / self.id() / "merged"
        done = merge(out, *self.shares, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (120_000, 120_000)))
        self.assertEqual(done.returncode, 5, done.stderr)
        self.assertEqual(done.stderr.splitlines()[0], "to continue when the disk has space: the same command with --resume")
        self.assertEqual(merge(out, *self.shares, more=("--no-histories", "--quiet", "--resume")).returncode, 0)
        self.assert_same(out)

    def test_a_merge_goes_on(self):
        out = self.folder / self.id() / "merged"
        self.assertEqual(merge(out, *self.shares).returncode, 0)
        again = merge(out, *self.shares)
        self.assertEqual((again.returncode, again.stderr), (
            2, f"{out}: the folder is not empty, allowed: a new or an empty folder, or --resume to continue a campaign of the same "
            "flight id\n"))
        resumed = ("--no-histories", "--quiet", "--resume")
        self.assertEqual(merge(out, *self.shares, more=resumed).returncode, 0)
        self.assert_same(out)
        # As one that was killed leaves it.
        self.remove(out, "case_index > 12")
        for name in ("cases.csv", "summary.json", "report.html"):
            (out / name).unlink()
        self.assertEqual(merge(out, *self.shares[1:], more=resumed).returncode, 0)
        self.assert_same(out)
        # What is there is not asked for again, and what is in neither is.
        self.remove(out, "case_index IN (4, 25)")
        done = merge(out, self.shares[1], out, more=resumed)
        self.assertEqual((done.returncode, done.stderr), (
            2, "cases 0 to 9: in none of the folders, allowed: every share of the campaign\n"
            "cases 20 to 29: in none of the folders, allowed: every share of the campaign\n"))
        other = self.folder / self.id() / "other"
        self.assertEqual(share(SMOKE, "0/1", other, "--cases", CASES, "--seed", "5").returncode, 0)
        done = merge(out, other, more=resumed)
        ids = [self.read(folder, "SELECT value FROM provenance WHERE key = 'flight_id'")[0][0] for folder in (out, other)]
        self.assertEqual((done.returncode, done.stderr), (
            2, f"{out}: holds results of flight id {ids[0]}, the campaign's is {ids[1]}\n"))
        done = merge(out, out, more=resumed)
        self.assertEqual((done.returncode, done.stderr), (2, f"{out}: nothing to merge with it, allowed: shares beside it\n"))
        share_folder, = self.copied(0)
        done = merge(share_folder, *self.shares, more=resumed)
        self.assertEqual((done.returncode, done.stderr), (
            2, f"{share_folder}: is for cases 0 to 9, this run for all cases, allowed: a folder of its own\n"))

    def test_judges_nothing(self):
        self.assertEqual(sorted(file.name for file in self.shares[1].iterdir()),
                         ["campaign.yaml", "execution.json", "results.sqlite"])
        done = dispersa("report", self.shares[1])
        self.assertEqual((done.returncode, done.stderr), (
            2, f"{self.shares[1]}: is a share of a campaign, which is judged as a whole, allowed: the folder that `dispersa merge` "
            "makes of all shares\n"))
        partial = "incomplete: it is the share of cases 10 to 19, and 10 of 30 cases have a result"
        table, other = self.folder / "table.csv", self.shares[2]
        for command, code, said in (
                (("replay", self.shares[1], "--case", "12"), 0, ""), (("fsck", self.shares[1]), 0, ""),
                (("export", self.shares[1], "--format", "csv", "--out", table), 5, f"warning: {self.shares[1]}: {partial}\n"),
                (("export", self.shares[1], "--format", "junit", "--out", table), 2, done.stderr),
                (("compare", self.shares[1], other), 5, "")):
            told = dispersa(*command, "--quiet")
            self.assertEqual(told.returncode, code, told.stderr)
            if said or code == 0:
                self.assertEqual(told.stderr, said)
        done = share(SMOKE, "0/3", self.folder / self.id(), *self.campaign)
        self.assertEqual(done.stdout.splitlines(), [
            "share: 10 of 10 cases flown, next: 'dispersa merge' when all shares are flown", f"result: {self.folder / self.id()}"])

    def test_what_is_missing_is_refused(self):
        out = self.folder / self.id() / "merged"
        self.assert_refused(merge(out, self.shares[0], self.shares[1]), out,
                            "cases 20 to 29: in none of the folders, allowed: every share of the campaign")
        self.assert_refused(merge(out, self.shares[2], self.shares[0]), out,
                            "cases 10 to 19: in none of the folders, allowed: every share of the campaign")
        half, = self.copied(1)
        self.change(half, "DELETE FROM cases WHERE case_index > 12")
        self.assert_refused(merge(out, self.shares[0], half, self.shares[2]), out,
                            f"{half}: holds 3 of its 10 cases, allowed: the share after its own command with --resume")

    def test_what_is_there_twice_is_refused(self):
        out = self.folder / self.id() / "merged"
        copy, = self.copied(1)
        self.assert_refused(merge(out, *self.shares, copy), out,
                            f"{copy}: cases 10 to 19: in another folder too, allowed: each case in one folder")
        one = self.folder / self.id() / "one"
        self.assertEqual(share(SMOKE, "3/10", one, *self.campaign).returncode, 0)
        self.assert_refused(merge(out, *self.shares, one), out, f"{one}: case 9: in another folder too, allowed: each case in one folder",
                            f"{self.shares[1]}: cases 10 to 11: in another folder too, allowed: each case in one folder")
        self.assert_refused(merge(out, self.whole, self.shares[2]), out,
                            f"{self.shares[2]}: cases 20 to 29: in another folder too, allowed: each case in one folder")

    def test_another_campaign_or_engine_is_refused(self):
        out, other = self.folder / self.id() / "merged", self.folder / self.id() / "other"
        self.assertEqual(share(SMOKE, "1/3", other, *self.campaign, "--seed", "5").returncode, 0)
        ids = [json.loads((self.whole / "summary.json").read_text())["campaign"]["id"]]
        with sqlite3.connect(other / "results.sqlite") as database:
            ids += database.execute("SELECT value FROM provenance WHERE key = 'campaign_id'").fetchone()
        self.assert_refused(merge(out, self.shares[0], other, self.shares[2]), out,
                            f"{other}: holds campaign {ids[1]}, {self.shares[0]} holds {ids[0]}, allowed: shares of one campaign with "
                            "the same --cases and --seed",
                            "cases 10 to 19: in none of the folders, allowed: every share of the campaign")
        old, = self.copied(1)
        self.change(old, "UPDATE provenance SET value = '0.0.9+aa' WHERE key = 'engine'")
        engine = json.loads(dispersa("--version", "--json").stdout)["engine"]
        self.assert_refused(merge(out, self.shares[0], old, self.shares[2]), out,
                            f"{old}: flown by engine 0.0.9+aa, this one is {engine}, allowed: the dispersa that flew it, or all "
                            "shares flown again")

    def test_results_of_other_inputs_leave_no_folder(self):
        out = self.folder / self.id() / "merged"
        forged, = self.copied(1)
        self.change(forged, "UPDATE cases SET case_index = case_index + 100 WHERE case_index < 12;"
                            "UPDATE cases SET case_index = 111 - case_index WHERE case_index > 99")
        self.assert_refused(merge(out, self.shares[0], forged, self.shares[2]), out,
                            f"{forged}/results.sqlite: the row of case 0 is damaged; --resume flies it again, allowed: shares as they "
                            "were flown: of this one by its own command with --resume, or into a new folder")
        other = self.folder / self.id() / "other"  # whole rows, of another seed
        self.assertEqual(share(SMOKE, "1/3", other, *self.campaign, "--seed", "5").returncode, 0)
        shutil.copy(self.shares[1] / "campaign.yaml", other)
        identity, = self.read(self.shares[1], "SELECT value FROM provenance WHERE key = 'campaign_id'")
        self.change(other, f"UPDATE provenance SET value = '{identity[0]}' WHERE key = 'campaign_id'")
        self.assert_refused(merge(out, self.shares[0], other, self.shares[2]), out,
                            f"{other}: 10 of its 10 results are not those of the campaign that it holds, allowed: the share flown again, "
                            "into a new folder")

    def test_damaged_folders_are_refused(self):
        out = self.folder / self.id() / "merged"
        torn, = self.copied(1)
        (torn / "results.sqlite").write_bytes((torn / "results.sqlite").read_bytes()[:9000])
        done = merge(out, self.shares[0], torn, self.shares[2])
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertRegex(done.stderr, rf"^{torn}/results.sqlite: .*, allowed: shares as they were flown: of this one by")
        shutil.rmtree(torn)
        torn, = self.copied(0)
        text = torn / "campaign.yaml"
        text.write_text(text.read_text().replace("probability: 0.8", "probability: 0.1"))
        self.assert_refused(merge(out, torn, *self.shares[1:]), out,
                            f"{text}: is not the campaign that was flown, allowed: the file as the share's command wrote it")
        (torn / "results.sqlite").unlink()
        self.assert_refused(merge(out, torn, *self.shares[1:]), out, f"{torn}: not a result folder: it has no results.sqlite")

    def test_requirements_that_came_after_the_flights_are_told(self):
        """As by a run that goes on with other requirements."""
        folder = self.folder / self.id()
        folder.mkdir()
        asked, whole, out, shares = folder / "asked.yaml", folder / "one" / "whole", folder / "two" / "merged", [folder / "0", folder / "1"]
        for probability in ("0.8", "0.5"):
            asked.write_text(smoke_text().replace("probability: 0.8", f"probability: {probability}"))
            flown = ("--cases", "12", "--resume")
            dispersa("run", asked, *flown, "--workers", "0", "--no-histories", "--quiet", "--out", whole)
            for i in (0, 1):
                done = share(asked, f"{i}/2", shares[i], *flown)
                self.assertEqual((done.returncode, done.stderr), (0, ""))
        done = merge(out, *shares)
        self.assertIn("was not required before the first case was flown", done.stdout)
        self.assertEqual((out / "summary.json").read_bytes(), (whole / "summary.json").read_bytes())

    def test_a_quarantined_case_stays_one(self):
        out = self.folder / self.id() / "merged"
        folder, = self.copied(2)
        self.change(folder, "DELETE FROM cases WHERE case_index = 25; INSERT INTO quarantined VALUES (25, 'it crashed')")
        done = merge(out, folder, *self.shares[:2])
        self.assertEqual(done.returncode, 5, done.stderr)
        self.assertEqual(json.loads((out / "summary.json").read_text())["quarantined"], [{"case_index": 25, "reason": "it crashed"}])

    def test_a_share_goes_on_as_the_share_that_it_is(self):
        copy, = self.copied(1)
        for command, said in ((("--shard", "0/3"), "cases 0 to 9"), (("--shard", "1/2"), "cases 15 to 29"),
                              (("--shard", "17/30"), "case 17"), (("--shard", "0/31"), "no case"), ((), "all cases")):
            done = dispersa("run", SMOKE, *self.campaign, *command, "--out", copy, "--resume", "--quiet")
            self.assertEqual((done.returncode, done.stderr), (
                2, f"{copy}: is for cases 10 to 19, this run for {said}, allowed: a folder of its own\n"))

    def test_what_goes_with_workers_and_verdicts_is_refused(self):
        for option in (("--gate",), ("--open",), ("--fresh", "another design"), ("--no-histories",), ("--envelope", "3")):
            self.assert_refused(share(SMOKE, "0/3", self.folder / self.id(), *option), self.folder / self.id(),
                                f"{option[0]}: a share has no verdict and no report, allowed: `dispersa merge` with {option[0]}")
        self.assert_refused(share(SMOKE, "0/3", self.folder / self.id(), "--workers", 2), self.folder / self.id(),
                            "--workers: a share is flown in this process, without workers, allowed: --threads N, or --workers 0")

    def test_words_that_are_no_share(self):
        for text in ("3/3", "-1/3", "1", "1/", "/3", "1/3x", "1/0", "0/4294967296"):
            done = share(SMOKE, text, self.folder / self.id(), *self.campaign)
            self.assertEqual(done.returncode, 2, text)
            self.assertEqual(done.stderr.splitlines()[0], f"--shard: '{text}', allowed: i/N with 0 <= i < N <= 4294967295")
        done = dispersa("run", SMOKE, "--after", self.whole, "--out", self.folder / self.id())
        self.assertEqual((done.returncode, done.stderr), (2, "--after: only shards are flown in rounds, allowed: --after with --shard\n"))


class Schedulers(unittest.TestCase):
    """The shipped files, as far as their shell goes: each task's environment is the scheduler's."""

    def setUp(self):
        self.folder = folder_of(self)
        self.environment = {"PATH": f"{BINARIES}:{os.environ['PATH']}"}

    def assert_merged(self, folders):
        done = merge(self.folder / "merged", *folders)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(len((self.folder / "merged/cases.csv").read_text().splitlines()), 1 + 12)

    def test_a_slurm_array(self):
        script = DEPLOY / "slurm_array.sbatch"
        missing = subprocess.run(["bash", script], capture_output=True, text=True, env=self.environment, timeout=TIMEOUT_S)
        self.assertNotEqual(missing.returncode, 0)
        self.assertIn("submit with --array=0-49", missing.stderr)
        for task in ("1", "0", "1"):  # and one that is queued again
            done = subprocess.run(["bash", script], capture_output=True, text=True, timeout=TIMEOUT_S, env={
                **self.environment, "SLURM_ARRAY_TASK_ID": task, "SLURM_ARRAY_TASK_COUNT": "2", "SLURM_CPUS_PER_TASK": "1",
                "CAMPAIGN": str(SMOKE), "SHARES": str(self.folder / "shares")})
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_merged(sorted((self.folder / "shares").iterdir()))

    def test_an_indexed_job_of_kubernetes(self):
        job = yaml.safe_load((DEPLOY / "kubernetes_shares.yaml").read_text())["spec"]
        container, = job["template"]["spec"]["containers"]
        self.assertEqual({one["name"]: one["value"] for one in container["env"]}, {"SHARES": str(job["completions"])})
        shell, option, command = container["command"]
        command = command.replace("/campaigns/table3.yaml", str(SMOKE)).replace("/data", str(self.folder))
        for index in ("0", "1", "2"):
            done = subprocess.run([shell, option, command], capture_output=True, text=True, timeout=TIMEOUT_S,
                                  env={**self.environment, "JOB_COMPLETION_INDEX": index, "SHARES": "3"})
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_merged(sorted((self.folder / "shares").iterdir()))

    def test_the_rules_of_snakemake(self):
        commands = re.findall(r'(?m)^    shell: "(.*)"$', (DEPLOY / "Snakefile").read_text())
        shares = [str(self.folder / str(i)) for i in range(16)]
        for i, folder in enumerate(shares):
            command = commands[1].replace("{wildcards.i}", str(i)).replace("{output}", folder).replace("table3.yaml", str(SMOKE))
            self.assertEqual(subprocess.run(command.split(), env=self.environment, stdout=subprocess.DEVNULL, timeout=TIMEOUT_S).returncode, 0)
        command = commands[0].replace("{input}", " ".join(shares)).replace("{output}", str(self.folder / "merged"))
        self.assertEqual(subprocess.run(command.split() + ["--no-histories"], env=self.environment, stdout=subprocess.DEVNULL,
                                        timeout=TIMEOUT_S).returncode, 0)


class Rounds(unittest.TestCase):
    """A campaign that stops when it is decided."""

    def setUp(self):
        self.folder = folder_of(self)
        self.campaign = self.folder / "decided.yaml"
        # It is missed in about 13 of 100 flights: the first look cannot tell.
        self.campaign.write_text(smoke_text().replace("below: 1, probability: 0.8", "below: 0.0905, probability: 0.8")
                                 + "verdicts: {looks: 3, stop: when_decided}\n")

    def flown(self, *more):
        return ("--cases", "120", "--workers", "0", *more)

    def identity(self, folder):
        with sqlite3.connect(f"file:{folder}/results.sqlite?mode=ro", uri=True) as database:
            return database.execute("SELECT value FROM provenance WHERE key = 'campaign_id'").fetchone()[0]

    def assert_a_share_is_none(self, folder):
        told = dispersa("export", folder, "--format", "csv", "--out", self.folder / "table.csv", "--quiet")
        self.assertEqual((told.returncode, told.stderr), (
            5, f"warning: {folder}: incomplete: it is the share of cases 40 to 59, and 20 of 120 cases have a result\n"))

    def test_of_shares_end_where_one_run_ends(self):
        whole = self.folder / "one" / "whole"
        done = dispersa("run", self.campaign, *self.flown("--no-histories", "--quiet"), "--out", whole)
        self.assertEqual(done.returncode, 0, done.stderr)
        out, rounds, code, after = self.folder / "merged" / "0", 0, 5, ()
        while code == 5 and rounds < 4:
            shares = [self.folder / f"round{rounds}" / str(i) for i in range(2)]
            for i, folder in enumerate(shares):
                told = share(self.campaign, f"{i}/2", folder, *self.flown(*after))
                self.assertEqual((told.returncode, told.stderr), (0, ""))
            if rounds == 1:  # a round of its own is no campaign
                self.assert_a_share_is_none(shares[0])
                told = merge(self.folder / "none", *shares)
                self.assertEqual((told.returncode, told.stderr), (
                    2, "cases 0 to 39: in none of the folders, allowed: every share of the campaign\n"))
            if rounds < 2:  # the folder of the rounds before grows, or is one of those that are merged
                told = merge(out, *shares, more=("--no-histories", "--resume"))
            else:
                before, out = out, self.folder / "merged" / "1"
                told = merge(out, before, *shares, more=("--no-histories",))
            code, after, rounds = told.returncode, ("--after", out), rounds + 1
            if code == 5:
                self.assertIn(f"\nVERDICT incomplete, next: fly cases {40 * rounds} to {40 * rounds + 39} with 'dispersa run CAMPAIGN "
                              f"--shard i/N --after {out}', then 'dispersa merge SHARES --out {out} --resume'\n", told.stdout)
        self.assertEqual(rounds, 3)
        self.assertEqual(code, done.returncode)
        self.assertEqual((out / "cases.csv").read_bytes(), (whole / "cases.csv").read_bytes())
        self.assertEqual((out / "summary.json").read_bytes(), (whole / "summary.json").read_bytes())
        identity = self.identity(out)
        told = share(SMOKE, "0/2", self.folder / "more", *self.flown("--after", out))
        self.assertRegex(told.stderr, rf"^--after {out}: holds campaign {identity}, this one is [0-9a-f]{{64}}, allowed: a merged folder "
                         r"of this campaign\n$")
        told = share(self.campaign, "0/2", self.folder / "more", *self.flown("--after", self.folder / "round1" / "0"))
        self.assertEqual((told.returncode, told.stderr), (
            2, f"--after {self.folder}/round1/0: cases are missing in it, allowed: a folder that merge wrote\n"))
        told = share(self.campaign, "0/2", self.folder / "more", *self.flown("--after", out))
        self.assertEqual((told.returncode, told.stderr), (2, f"--after {out}: its campaign needs no further cases, allowed: the verdict in its report\n"))


if __name__ == "__main__":
    unittest.main()
