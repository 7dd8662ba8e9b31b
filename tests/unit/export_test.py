"""Exports and the gate as a user calls them, on a small campaign.
"""
import csv
import gzip
import json
import os
import pathlib
import re
import shutil
import sqlite3
import subprocess
import time
import unittest
import xml.etree.ElementTree

from programs import BINARIES, CAMPAIGNS, SMOKE, TIMEOUT_S, dispersa, folder_of, run, smoke_text

DEBIAN_PYTHON = "/usr/bin/python3"  # python3-h5py belongs to it


class ExportTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = folder_of(cls)
        cls.results = cls.folder / "results"
        done = dispersa("run", SMOKE, "--workers", "0", "--no-histories", "--quiet", "--out", cls.results)
        assert done.returncode == 0, done.stderr
        with open(cls.results / "cases.csv", newline="") as stream:
            cls.rows = list(csv.DictReader(stream))


class Columns(ExportTest):
    def test_a_table_without_what_is_the_same_in_all_cases(self):
        file = self.folder / "varying.csv"
        done = dispersa("export", self.results, "--format", "csv", "--columns", "varying", "--out", file)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        with open(file, newline="") as stream:
            rows = list(csv.DictReader(stream))
        varying = [name for name in self.rows[0] if not name.startswith(("input_", "metric_"))
                   or len({row[name] for row in self.rows}) > 1]
        self.assertEqual(list(rows[0]), varying)
        self.assertLess(len(varying), len(self.rows[0]))
        self.assertEqual(rows, [{name: row[name] for name in varying} for row in self.rows])
        done = dispersa("export", self.results, "--format", "jsonl", "--columns", "varying", "--out", file)
        self.assertEqual((done.returncode, done.stderr),
                         (2, "--columns: only a CSV file can leave columns out, allowed: --format csv\n"))


class OfAnOlderRelease(ExportTest):
    """tests/data/folder_of_version_2: three cases of the gallery's nike_apache, whose rows hold all inputs."""

    def setUp(self):
        self.old = self.folder / self.id()
        shutil.copytree(pathlib.Path(__file__).parents[1] / "data/folder_of_version_2", self.old)
        self.csv = (self.old / "cases.csv").read_bytes()

    def change(self, sql):
        database = sqlite3.connect(self.old / "results.sqlite")
        database.executescript(sql)
        database.close()

    def exported(self, form):
        file = self.folder / "older"
        done = dispersa("export", self.old, "--format", form, "--out", file)
        return done.returncode, done.stderr, file.read_bytes() if done.returncode == 0 else b""

    def test_is_reported_and_exported_as_it_was(self):
        # Winds of a profile's levels have got a unit in their names since.
        self.csv = re.sub(rb"(input_wind_profile_(?:north|east)_\d+)", rb"\1_m_s", self.csv)
        self.assertEqual(self.exported("csv"), (0, "", self.csv))
        self.assertEqual(json.loads(self.exported("jsonl")[2].splitlines()[0])["input_wind_altitude_m"], 3000)
        self.assertEqual(self.exported("hdf5")[:2], (0, ""))
        done = dispersa("report", self.old, "--no-histories", "--quiet")
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertEqual((self.old / "cases.csv").read_bytes(), self.csv)
        self.assertEqual(json.loads((self.old / "nominal.json").read_text())["inputs"], {})
        self.change("DROP TABLE audits; PRAGMA user_version = 0")  # and of the first version
        self.assertEqual(self.exported("csv"), (0, "", self.csv))

    def test_is_compared_with_one_of_today_that_lacks_constant_columns(self):
        today = self.folder / "today"
        dispersa("run", CAMPAIGNS / "gallery/nike_apache/campaign.yaml", "--cases", "3", "--workers", "0", "--no-histories", "--quiet",
                 "--out", today)
        columns = [len(file.read_text().partition("\n")[0].split(",")) for file in (self.old / "cases.csv", today / "cases.csv")]
        self.assertGreater(columns[0], columns[1] + 350)
        for sides in ((self.old, today), (today, self.old)):
            compared = json.loads(dispersa("compare", *sides, "--json").stdout)
            pairing = compared["pairing"]
            self.assertEqual((pairing["changed_inputs"], pairing["pairs"]), ([], 3), pairing["sentence"])

    def test_a_constant_that_this_release_does_not_know_is_left_out(self):
        self.change("CREATE TABLE nominal (input TEXT PRIMARY KEY, value REAL); INSERT INTO nominal VALUES ('of_an_older_engine', 1)")
        self.assertEqual(self.exported("csv")[:2], (0, ""))
        self.change("ALTER TABLE cases RENAME COLUMN input_cg_factor TO input_of_an_older_engine")
        code, error, _ = self.exported("csv")
        self.assertEqual((code, "this dispersa does not know its input of_an_older_engine" in error), (2, True), error)

    def test_a_changed_row_is_damaged(self):
        self.change("UPDATE cases SET input_cg_factor = 1.01 WHERE case_index = 1")
        code, error, _ = self.exported("csv")
        self.assertEqual((code, "the row of case 1 is damaged" in error), (1, True), error)

    def test_is_not_gone_on_with(self):
        done = dispersa("run", CAMPAIGNS / "gallery/nike_apache/campaign.yaml", "--cases", "3", "--workers", "0", "--resume", "--out", self.old)
        self.assertEqual(done.returncode, 2, done.stderr)


class BeforeTheLastInput(ExportTest):
    """tests/data/folder_of_version_5: three cases of the gallery's nike_apache, before the input weather_sounding."""

    def test_is_reported_and_exported_as_it_was(self):
        old, file = self.folder / "version_5", self.folder / "version_5.csv"
        shutil.copytree(pathlib.Path(__file__).parents[1] / "data/folder_of_version_5", old)
        stored = (old / "cases.csv").read_bytes()
        done = dispersa("export", old, "--format", "csv", "--out", file)
        self.assertEqual((done.returncode, done.stderr, file.read_bytes()), (0, "", stored))
        done = dispersa("report", old, "--no-histories", "--quiet")
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertEqual((old / "cases.csv").read_bytes(), stored)
        database = sqlite3.connect(old / "results.sqlite")
        database.executescript("UPDATE nominal SET value = 1.01 WHERE input = 'cg_factor'")
        database.close()
        done = dispersa("export", old, "--format", "csv", "--out", file)
        self.assertEqual((done.returncode, "the row of case 0 is damaged" in done.stderr), (1, True), done.stderr)


class Compared(ExportTest):
    def test_the_tail_of_each_metric_is_that_on_its_worse_side(self):
        sides = [self.folder / seed for seed in ("5", "6")]
        for side in sides:
            dispersa("run", SMOKE, "--cases", "120", "--seed", side.name, "--workers", "0", "--no-histories", "--quiet",
                     "--out", side)
        shown = {line.partition(" ")[0]: line[99:110].strip() for line in reversed(dispersa("compare", *sides).stdout.splitlines())}
        metrics = json.loads(dispersa("compare", *sides, "--json").stdout)["metrics"]
        for metric in metrics:
            worse = "p01" if metric["worse"] == "smaller" else "p99"
            tail = next(each for each in metric["tails"] if each["percentile"] == worse)
            self.assertAlmostEqual(float(shown[metric["metric"]]), tail["difference"], delta=1e-3 * abs(tail["difference"]))


class Incomplete(ExportTest):
    """The folder of a run that was killed, and a copy of it without the database's log."""
    CASES = 30000

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.killed = cls.folder / "killed"
        flight = subprocess.Popen([BINARIES / "dispersa", "run", SMOKE, "--cases", str(cls.CASES), "--workers", "0",
                                   "--no-histories", "--quiet", "--out", cls.killed], stdout=subprocess.DEVNULL)
        deadline = time.monotonic() + TIMEOUT_S
        while cls.stored() == 0 and flight.poll() is None and time.monotonic() < deadline:
            time.sleep(0.02)
        flight.kill()
        flight.wait()
        cls.flown = cls.stored()
        assert 0 < cls.flown < cls.CASES
        cls.words = f"incomplete: {cls.flown} of {cls.CASES} cases have a result"
        cls.copy = cls.folder / "copy"
        shutil.copytree(cls.killed, cls.copy, ignore=shutil.ignore_patterns("*-wal", "*-shm"))

    @classmethod
    def stored(cls):
        try:
            with sqlite3.connect(f"file:{cls.killed}/results.sqlite?mode=ro", uri=True) as database:
                return database.execute("SELECT count(*) FROM cases").fetchone()[0]
        except sqlite3.OperationalError:
            return 0

    def export(self, form):
        file = self.folder / f"incomplete.{form}"
        done = dispersa("export", self.killed, "--format", form, "--out", file, "--quiet")
        self.assertEqual((done.returncode, done.stderr), (5, f"warning: {self.killed}: {self.words}\n"), form)
        return file

    def test_an_export_says_what_is_missing_and_writes_it_where_it_has_a_place(self):
        self.assertEqual(self.export("csv").read_text().count("\n"), self.flown + 1)
        self.assertEqual(self.export("jsonl").read_text().count("\n"), self.flown)
        self.assertEqual(json.loads(self.export("geojson").read_text())["incomplete"], self.words)
        self.assertIn(f"; {self.words}</description>", self.export("kml").read_text())
        self.assertIn(f'<error type="incomplete" message="{self.words.removeprefix("incomplete: ")}"/>', self.export("junit").read_text())
        read = run(DEBIAN_PYTHON, "-c", f"import h5py; print(h5py.File({str(self.export('hdf5'))!r}).attrs['incomplete'].decode())")
        self.assertEqual(read.stdout, self.words + "\n", read.stderr)
        done = dispersa("export", self.killed, "--format", "csv", "--out", self.folder / "incomplete.csv", "--json")
        self.assertEqual((done.returncode, json.loads(done.stdout)["incomplete"]), (5, self.words))

    def test_a_comparison_says_what_is_missing(self):
        out = self.folder / "comparison"
        side = f"B ({self.killed.name}) is {self.words}"
        done = dispersa("compare", self.results, self.killed, "--out", out)
        self.assertEqual((done.returncode, done.stderr), (5, f"warning: {side}\n"))
        self.assertIn(f"{self.flown} of {self.flown} flights completed, {self.CASES - self.flown} cases missing\n", done.stdout)
        self.assertIn(f"<li>{side}.</li>", (out / "compare.html").read_text())
        done = dispersa("compare", self.killed, self.results, "--json")
        told = json.loads(done.stdout)
        self.assertEqual((done.returncode, told["incomplete"]), (5, [side.replace("B", "A", 1)]))
        self.assertEqual((told["a"]["cases"], told["a"]["flown"]), (self.CASES, self.flown))
        done = dispersa("compare", self.results, self.results, "--json")
        self.assertEqual((done.returncode, done.stderr, json.loads(done.stdout)["incomplete"]), (0, "", []))

    def test_markdown_says_what_is_missing(self):
        file = self.folder / "missing.md"
        done = dispersa("export", self.killed, "--format", "markdown", "--out", file)
        self.assertEqual((done.returncode, done.stderr), (5, f"warning: {self.killed}: {self.words}\n"))
        self.assertIn("# smoke: incomplete\n", file.read_text())

    def test_a_folder_without_any_case_is_refused(self):
        words = (f"{self.copy}: incomplete: 0 of {self.CASES} cases have a result; copy results.sqlite-wal too if this is a copy, "
                 f"or fly the cases: `dispersa run CAMPAIGN --out {self.copy} --resume`")
        for command in (("export", self.copy, "--format", "csv", "--out", self.folder / "none.csv"),
                        ("compare", self.results, self.copy), ("compare", self.copy, self.results),
                        ("report", self.copy, "--no-histories"), ("replay", self.copy, "--case", "0")):
            done = dispersa(*command)
            self.assertEqual((done.returncode, done.stdout, done.stderr), (5, "", words + "\n"), command)
            told = json.loads(dispersa(*command, "--json").stdout)
            self.assertEqual((told["schema"], told["code"], told["errors"][0]["message"]), ("dispersa/error/1", 5, words))
        self.assertFalse((self.folder / "none.csv").exists())

    def test_one_case_of_it_is_flown_again(self):
        with sqlite3.connect(f"file:{self.killed}/results.sqlite?mode=ro", uri=True) as database:
            first, = database.execute("SELECT min(case_index) FROM cases").fetchone()
        done = dispersa("replay", self.killed, "--case", first)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_a_campaign_that_stopped_because_it_was_decided_lacks_nothing(self):
        campaign = self.folder / "decided.yaml"
        campaign.write_text(smoke_text() + "verdicts: {looks: 3, stop: when_decided}\n")
        out = self.folder / "apart" / "decided"
        done = dispersa("run", campaign, "--cases", "300", "--workers", "0", "--no-histories", "--quiet", "--out", out, "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertLess(len((out / "cases.csv").read_text().splitlines()), 200)
        done = dispersa("export", out, "--format", "csv", "--out", self.folder / "decided.csv")
        self.assertEqual((done.returncode, done.stderr), (0, ""))


class Ending(ExportTest):
    def test_the_last_lines_say_what_to_do_next(self):
        done = dispersa("report", self.results, "--no-histories", "--quiet")
        self.assertEqual(done.stdout.splitlines()[-3:], [
            "VERDICT pass, next: read the report's assumptions and warnings",
            f"report: {self.results}/report.html", f"result: {self.results}"])

    def test_the_report_in_a_browser(self):
        browser, seen = self.folder / "browser", self.folder / "seen"
        browser.write_text(f'#!/bin/sh\nprintf %s "$1" > {seen}.part && mv {seen}.part {seen}\n')
        browser.chmod(0o755)
        command = ("report", self.results, "--no-histories", "--quiet", "--open")
        done = dispersa(*command, env={"BROWSER": str(browser)})
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        deadline = time.monotonic() + 30.0
        while not seen.exists() and time.monotonic() < deadline:
            time.sleep(0.02)
        self.assertEqual(seen.read_text(), f"{self.results}/report.html")
        done = dispersa(*command, env={"BROWSER": "no-such-browser"})
        self.assertEqual(done.returncode, 0)
        self.assertIn(f"no-such-browser: No such file or directory; open {self.results}/report.html yourself",
                      done.stderr)


class Markdown(ExportTest):
    def test_says_what_reviewers_read(self):
        done = dispersa("export", self.results, "--format", "markdown", "--out", "-")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        lines = done.stdout.splitlines()
        self.assertEqual(lines[0], "# smoke: pass")
        self.assertIn("- **pitch\\_error\\_peak\\_deg**: ", done.stdout)
        self.assertIn("| `dispersa replay . --case ", done.stdout)
        self.assertNotRegex(done.stdout, r"\b(None|nan|inf)\b")
        heads = [at for at, line in enumerate(lines) if set(line) == {"|", "-"}]
        self.assertEqual(len(heads), 3)
        for at in heads:
            self.assertEqual(lines[at - 1].count("|"), lines[at].count("|"))

    def test_the_gate_leaves_what_a_pipeline_attaches(self):
        artifacts = self.folder / "artifacts"
        environment = {"DISPERSA": str(BINARIES / "dispersa")}
        done = run(CAMPAIGNS / "gate", SMOKE, artifacts, "--workers", "0", env=environment)
        self.assertEqual(done.returncode, 0, done.stderr)
        suite = xml.etree.ElementTree.parse(artifacts / "requirements.xml").getroot().find("testsuite")
        # The vehicle's own limits, which nobody required, are no test that passed.
        self.assertEqual([suite.get(key) for key in ("tests", "failures", "errors", "skipped")], ["1", "0", "0", "0"])
        self.assertIn("Load check: 0 of ", suite.find("system-out").text)
        self.assertIn("smoke: pass", (artifacts / "report.md").read_text())
        self.assertTrue((artifacts / "results" / "report.html").is_file())
        # A limit that no flight keeps: everything is attached all the same, and the pipeline stops.
        campaigns = self.folder / "campaigns"
        shutil.copytree(CAMPAIGNS, campaigns)
        failing = campaigns / "smoke.yaml"
        failing.write_text(re.sub(r"below: [\d.]+", "below: 1.0e-9", failing.read_text()))
        done = run(CAMPAIGNS / "gate", failing, self.folder / "failed", "--workers", "0", env=environment)
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn("**fail**", (self.folder / "failed" / "report.md").read_text())
        self.assertEqual(run(CAMPAIGNS / "gate", env=environment).returncode, 2)


class Hdf5(ExportTest):
    def setUp(self):
        self.file = self.folder / "results.h5"
        done = dispersa("export", self.results, "--format", "hdf5", "--out", self.file)
        self.assertEqual(done.returncode, 0, done.stderr)

    def column(self, name):
        return [float(row[name]) if row[name] else float("nan") for row in self.rows]

    def test_the_same_results_give_the_same_bytes(self):
        again = self.folder / "again.h5"
        dispersa("export", self.results, "--format", "hdf5", "--out", again)
        self.assertEqual(self.file.read_bytes(), again.read_bytes())
        self.assertFalse((self.folder / "again.h5.tmp").exists())

    def test_h5py_reads_every_column(self):
        script = """
import h5py, json, math, sys
with h5py.File(sys.argv[1]) as file:
    text = lambda values: [value.decode() for value in values]
    numbers = lambda values: [None if math.isnan(value) else value for value in values]
    print(json.dumps({
        "schema": file.attrs["schema"].decode(), "engine": file.attrs["engine"].decode(),
        "case_index": file["cases/case_index"][:].tolist(), "outcome": text(file["cases/outcome"][:]),
        "digest": text(file["cases/digest"][:]), "unit": file["metrics/q_max_pa"].attrs["unit"].decode(),
        "columns": {group + "_" + name: numbers(file[key][name][:]) for key, group in (("inputs", "input"), ("metrics", "metric"))
                    for name in file[key]}}))
"""
        done = run(DEBIAN_PYTHON, "-I", "-c", script, self.file)
        self.assertEqual(done.returncode, 0, done.stderr)
        read = json.loads(done.stdout)
        self.assertEqual((read["schema"], read["unit"]), ("dispersa/hdf5/1", "Pa"))
        self.assertEqual(read["case_index"], [int(row["case_index"]) for row in self.rows])
        self.assertEqual(read["outcome"], [row["outcome"] for row in self.rows])
        self.assertEqual(read["digest"], [row["digest"] for row in self.rows])
        names = {name for name in self.rows[0] if re.match("(input|metric)_", name)}
        self.assertEqual(set(read["columns"]), names)
        for name in names:
            self.assertEqual(read["columns"][name], [float(row[name]) if row[name] else None for row in self.rows], name)

    @unittest.skipUnless(shutil.which("octave-cli"), "octave is not installed (tests/long-packages.txt)")
    def test_octave_opens_it(self):
        done = run(shutil.which("octave-cli"), "--norc", "--eval",
                   f"d = load('-hdf5', '{self.file}'); printf('%.17g\\n', d.metrics.q_max_pa); printf('%d\\n', d.cases.case_index);")
        self.assertEqual(done.returncode, 0, done.stderr)
        numbers = [float(word) for word in done.stdout.split()]
        self.assertEqual(numbers, self.column("metric_q_max_pa") + self.column("case_index"))

    def test_a_place_that_cannot_be_written(self):
        done = dispersa("export", self.results, "--format", "hdf5", "--out", self.folder / "none" / "results.h5")
        self.assertEqual(done.returncode, 2)
        self.assertEqual(done.stderr, f"--out: {self.folder / 'none' / 'results.h5'} cannot be written: there is no folder "
                                      f"{self.folder / 'none'}, allowed: a file in a folder that exists\n")

    def test_without_histories_it_has_none(self):
        done = run(DEBIAN_PYTHON, "-I", "-c", "import h5py, sys; print(sorted(h5py.File(sys.argv[1])))", self.file)
        self.assertEqual(done.stdout, "['cases', 'inputs', 'metrics', 'nominal']\n", done.stderr)


class Hdf5Histories(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = folder_of(cls)
        cls.results = cls.folder / "results"
        done = dispersa("run", SMOKE, "--workers", "0", "--quiet", "--out", cls.results)
        assert done.returncode == 0, done.stderr

    def export(self):
        return dispersa("export", self.results, "--format", "hdf5", "--out", self.folder / "results.h5")

    def test_every_written_history_is_there(self):
        done = self.export()
        self.assertEqual(done.returncode, 0, done.stderr)
        script = """
import h5py, json, math, sys
with h5py.File(sys.argv[1]) as file:
    print(json.dumps({history: {name: [None if math.isnan(value) else value for value in data[:]] for name, data in columns.items()}
                      for history, columns in file["histories"].items()}))
    print(json.dumps([file["histories"][path].attrs["unit"].decode() for path in
                      ("nominal/altitude_m", "nominal/mach", "bands/altitude_m_p50", "bands/flights")]))
"""
        done = run(DEBIAN_PYTHON, "-I", "-c", script, self.folder / "results.h5")
        self.assertEqual(done.returncode, 0, done.stderr)
        read, units = map(json.loads, done.stdout.splitlines())
        self.assertEqual(units, ["m", "", "m", ""])
        files = {file.name.removesuffix(".csv.gz"): file for file in (self.results / "histories").glob("*.csv.gz")}
        self.assertEqual(set(read), set(files))
        self.assertGreaterEqual(len(files), 4, "nominal, bands and two cases")
        for history, file in files.items():
            with gzip.open(file, "rt", newline="") as stream:
                rows = list(csv.DictReader(stream))
            self.assertEqual(set(read[history]), set(rows[0]))
            for name in rows[0]:
                self.assertEqual(read[history][name], [float(row[name]) if row[name] else None for row in rows],
                                 f"{history} {name}")

    def test_a_damaged_history_is_named(self):
        history = self.results / "histories" / "nominal.csv.gz"
        whole = history.read_bytes()
        try:
            for damaged in (whole[:-9], gzip.compress(b"time_s,mach\n0,1\n1\n"), gzip.compress(b"time_s\nx\n")):
                history.write_bytes(damaged)
                done = self.export()
                self.assertEqual(done.returncode, 1)
                self.assertIn(f"{history}: no history, or damaged; `dispersa report` writes it anew", done.stderr)
                self.assertFalse((self.folder / "results.h5.tmp").exists())
        finally:
            history.write_bytes(whole)


if __name__ == "__main__":
    unittest.main()
