"""Runs and result folders from Python: the bytes, numbers and verdicts of the program, and its exit codes as exceptions."""
import contextlib
import csv
import fcntl
import io
import json
import math
import os
import re
import shutil
import signal
import sqlite3
import subprocess
import sys
import time
import unittest
import warnings

import numpy

import dispersa
from program import BINARIES, CAMPAIGNS, SMOKE, TIMEOUT_S, folder_of, printed, program

FILES = ("cases.csv", "campaign.yaml", "summary.json", "report.html")


def content(folder, name):
    """A file's bytes; of the report without what differs from run to run."""
    data = (folder / name).read_bytes()
    return re.sub(rb"<!-- run:begin -->.*?<!-- run:end -->", b"", data, flags=re.S) if name == "report.html" else data


def cells(value):
    """A value as cases.csv has it."""
    if isinstance(value, (float, numpy.floating)):
        return "" if math.isnan(value) else float(value)
    return str(value)


class Runs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = folder_of(cls)
        cls.theirs = cls.folder / "theirs"
        program("run", SMOKE, "--workers", "1", "--quiet", "--out", cls.theirs)
        cls.ours = dispersa.run(SMOKE, cls.folder / "ours", workers=0, threads=2)

    def test_the_folder_has_the_programs_bytes(self):
        for name in FILES:
            self.assertEqual(content(self.ours.directory, name), content(self.theirs, name), name)
        for file in (self.theirs / "histories").iterdir():
            self.assertEqual((self.ours.directory / "histories" / file.name).read_bytes(), file.read_bytes(), file.name)

    def test_workers_over_dds(self):
        seen = []
        results = dispersa.run(SMOKE, self.folder / "workers", workers=1, histories=False,
                               progress=lambda *what: seen.append(what))
        self.assertEqual((results.directory / "cases.csv").read_bytes(), (self.theirs / "cases.csv").read_bytes())
        self.assertIn(("smoke", 12, 12), {what[:3] for what in seen})
        execution = json.loads((results.directory / "execution.json").read_text())
        self.assertEqual(len(execution["workers"]), 1)

    def test_probability_has_the_limits_of_clopper_and_pearson(self):
        value = float(numpy.sort(self.ours.metrics["q_max_pa"])[8])
        answer = self.ours.probability("q_max_pa", above=value, confidence_percent=90)
        self.assertEqual({key: answer[key] for key in ("events", "n", "estimate", "left_out")},
                         {"events": 3, "n": 12, "estimate": 0.25, "left_out": 0})
        # Roots of the binomial tail: P(X >= 3 | low) = P(X <= 3 | high) = 0.05.
        def at_most(k, p):
            return sum(math.comb(12, i) * p**i * (1 - p)**(12 - i) for i in range(k + 1))
        self.assertAlmostEqual(1 - at_most(2, answer["low"]), 0.05, 12)
        self.assertAlmostEqual(at_most(3, answer["high"]), 0.05, 12)
        below = self.ours.probability("q_max_pa", below=1e9)
        self.assertEqual((below["events"], below["high"]), (12, 1.0))
        for arguments, message in (
                (("q_mx_pa",), "probability: 'q_mx_pa' is not a metric of these flights (did you mean 'q_max_pa'?), allowed: a "
                               "name of Results.metrics.dtype.names"),
                (("q_max_pa",), "probability: one limit is needed, allowed: above=x or below=x")):
            with self.assertRaises(dispersa.BadInput) as caught:
                self.ours.probability(*arguments)
            self.assertEqual(str(caught.exception), message)

    def test_a_sweep_flies_each_value_and_compares_as_flat_frames(self):
        flown = dispersa.sweep(SMOKE, "dispersions.thrust.three_sigma_percent", [1, 4], self.folder / "sweep", workers=0,
                               histories=False)
        self.assertEqual([results.directory.name for results in flown.values()],
                         ["three_sigma_percent=1", "three_sigma_percent=4"])
        self.assertLess(numpy.std(flown[1].inputs["thrust_factor_stage1"]), numpy.std(flown[4].inputs["thrust_factor_stage1"]))
        compared = dispersa.compare(flown[1], flown[4])
        frame = compared.table()
        self.assertEqual(list(frame["metric"]), [each["metric"] for each in compared["metrics"]])
        self.assertEqual(list(frame["median_p"]), [each["median"]["p"] for each in compared["metrics"]])
        self.assertEqual(list(frame["median_interval_low"]), [each["median"]["interval"][0] for each in compared["metrics"]])
        self.assertEqual(list(compared.table("requirements")["mcnemar_both_meet"]), [12])
        with self.assertRaises(dispersa.BadInput) as caught:
            dispersa.sweep(SMOKE, "dispersions.thrst", [1], self.folder / "none")
        self.assertEqual(str(caught.exception), "key: the campaign has no 'dispersions.thrst', allowed: a key that it has, such as "
                                                "sampling.seed")

    def test_a_sweep_over_two_keys(self):
        keys = ("dispersions.thrust.three_sigma_percent", "sampling.seed")
        flown = dispersa.sweep(SMOKE, keys, [(1, 7), (4, 8)], self.folder / "two_keys", workers=0, histories=False)
        self.assertEqual({pair: (results.directory.name, results.campaign.seed) for pair, results in flown.items()},
                         {(1, 7): ("three_sigma_percent=1,seed=7", 7), (4, 8): ("three_sigma_percent=4,seed=8", 8)})
        self.assertLess(numpy.std(flown[1, 7].inputs["thrust_factor_stage1"]), numpy.std(flown[4, 8].inputs["thrust_factor_stage1"]))
        with self.assertRaises(dispersa.BadInput) as caught:
            dispersa.sweep(SMOKE, keys, [(1, 2, 3)], self.folder / "none")
        self.assertEqual(str(caught.exception), "values: (1, 2, 3) has 3 values, allowed: one for each of 2 keys")

    def test_progress_is_a_bar_for_each_phase(self):
        with contextlib.redirect_stderr(io.StringIO()) as shown:
            dispersa.run(SMOKE, self.folder / "bar", workers=0, progress=True)
        self.assertRegex(shown.getvalue(), r"smoke: 100%\|.*\| 12/12 ")
        self.assertRegex(shown.getvalue(), r"time histories: 100%\|")

    def test_notebooks_show_requirements_and_differences(self):
        page = dispersa.load(SMOKE)._repr_html_()
        self.assertIn("12 cases, seed ", page)
        self.assertIn("<td>wind.azimuth</td><td>wind_azimuth_deg</td>", page)
        self.assertIn("<td>thrust</td><td>thrust_factor_stage1, thrust_factor_stage2, ", page)
        self.assertIn("<td>pitch_error_peak_deg below 1</td><td>0 of 12</td><td>pass</td>", self.ours._repr_html_())
        self.assertIn("metrics, each counted once, ", dispersa.compare(self.ours, self.theirs)._repr_html_())

    def test_dicts_run_too(self):
        tree = dispersa.read(SMOKE)
        tree["sampling"]["cases"] = 2
        results = dispersa.run(tree, self.folder / "dict", workers=0, histories=False)
        self.assertEqual((len(results), results.campaign), (2, dispersa.load(SMOKE, cases=2)))

    def test_columns_are_those_of_cases_csv(self):
        with open(self.theirs / "cases.csv", newline="") as stream:
            rows = list(csv.reader(stream))
        table = self.ours.table()
        self.assertEqual(list(table.dtype.names), rows[0])
        self.assertEqual(list(self.ours.cases.columns), rows[0])
        for i, row in enumerate(rows[1:]):
            expected = [float(cell) if cell and (name.startswith(("input_", "metric_")) or name == "end_time_s") else cell
                        for name, cell in zip(rows[0], row)]
            self.assertEqual([cells(value) for value in table[i]], expected)
            self.assertEqual([cells(value) for value in self.ours.cases.iloc[i]], expected)

    def test_the_worst_case_is_worst_by_the_requirements(self):
        heights = self.ours.metrics["injection_altitude_km"]
        order = numpy.argsort(heights)
        with self.assertRaises(dispersa.BadInput) as caught:
            self.ours.worst("injection_altitude_km")
        self.assertEqual(str(caught.exception), "worst: no direction of 'injection_altitude_km' is worse, allowed: a metric that has "
                                                "a worse direction, or a requirement of the campaign")
        tree = dispersa.read(SMOKE)
        rule = {"metric": "injection_altitude_km", "probability": 0.5, "consumer_risk": 0.4}
        for name, limits, worst in (("within", [{"within": [heights[order[1]], heights[order[-1]] + 50]}], [order[0], order[1]]),
                                    ("above", [{"above": 0}], [order[0], order[1]]), ("below", [{"below": 1e4}], [order[-1], order[-2]]),
                                    ("both", [{"above": 0}, {"below": heights[order[-1]] + 1}], [order[-1], order[-2]])):
            tree["requirements"] = [dict(rule, **{key: [float(x) for x in value] if key == "within" else float(value)
                                                  for key, value in each.items()}) for each in limits]
            results = dispersa.run(tree, self.folder / name, workers=0, histories=False)
            numpy.testing.assert_array_equal(results.metrics["injection_altitude_km"], heights)
            self.assertEqual(results.worst("injection_altitude_km", 2), [int(case) for case in worst], name)
            self.assertEqual([case["case_index"] for case in results.summary["worst_cases"]
                              if case["metric"] == "injection_altitude_km"][:2], [int(case) for case in worst], name)
            last = results.requirements[len(limits) - 1]["worst_completed"]
            self.assertEqual(last, {"case_index": int(worst[0]), "value": heights[worst[0]]}, name)

    def test_verdict_is_a_value(self):
        said = json.loads((self.theirs / "summary.json").read_text())
        self.assertEqual((self.ours.verdict, self.ours.exit_code, self.ours.requirements),
                         ("pass", dispersa.ExitCode.DONE, said["requirements"]))
        tree = dispersa.read(SMOKE)
        tree["requirements"][0]["below"] = 1e-9
        failed = dispersa.run(tree, self.folder / "failed", workers=0, histories=False)
        self.assertEqual((failed.verdict, failed.exit_code), ("fail", 3))

    def test_a_folder_is_what_it_was_when_it_was_opened(self):
        copied = self.folder / "opened"
        shutil.copytree(self.theirs, copied)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder)
        opened = dispersa.results("opened")
        os.chdir("/")
        self.assertEqual((opened.directory, opened.replay(1)["match"]), (copied, True))
        summary = copied / "summary.json"
        text = summary.read_text()
        summary.write_text(text.replace('"verdict": "pass"', '"verdict": "fail"'))
        for results in (opened, dispersa.results(copied)):
            self.assertEqual((results.verdict, results.exit_code), ("pass", 0))
        self.assertEqual(opened.summary, json.loads(text))
        summary.write_bytes(b"\xff{]")
        with self.assertRaisesRegex(dispersa.InternalError, "opened/summary.json is damaged: .*; dispersa.report makes it again"):
            dispersa.results(copied).summary
        summary.unlink()
        self.assertEqual(dispersa.results(copied).summary["verdict"], "pass")

    def test_events(self):
        events = self.ours.events()
        self.assertEqual(len(set(events["case_index"])), len(self.ours))
        one = events[events["case_index"] == 5]
        self.assertEqual(list(one["event"]), [each["event"] for each in printed("fly", SMOKE, "--case", "5")["events"]])
        for name in ("time_s", "altitude_m", "speed_m_s", "qbar_pa", "mass_kg"):
            self.assertEqual(list(one[name]), [each[name] for each in printed("fly", SMOKE, "--case", "5")["events"]])
        self.assertEqual(one["event"][0], "lift_off")
        self.assertEqual(one[one["event"] == "max_q"]["qbar_pa"][0], self.ours.metrics["q_max_pa"][list(self.ours.case_index).index(5)])

    def test_histories_of_the_report(self):
        bands, nominal = self.ours.bands(), self.ours.history()
        self.assertEqual(bands.columns[0], "time_s")
        # Rows of a tenth of a second, of events and of each column's extremes, with nine digits.
        ticks, tenths = (numpy.array([[float(f"{value:.9g}") + 0.0 for value in row] for row in dispersa.fly(SMOKE, step_s=step_s).history.rows])
                         for step_s in (0.01, 0.1))
        ours = {row.tobytes() for row in nominal.rows}
        self.assertLess({row.tobytes() for row in tenths}, ours)
        self.assertLess(ours, {row.tobytes() for row in ticks})
        for extreme in (numpy.nanmin, numpy.nanmax):
            numpy.testing.assert_array_equal(extreme(nominal.rows, axis=0), extreme(ticks, axis=0))
        self.assertLess(len(nominal.rows), len(tenths) + 130)
        with self.assertRaises(dispersa.BadInput):
            self.ours.history(9999)
        for case in (1.9, "1", True):
            with self.assertRaisesRegex(dispersa.BadInput, "case: .* is not a whole number"):
                self.ours.history(case)

    def test_replay(self):
        self.assertEqual(self.ours.replay(5), printed("replay", self.theirs, "--case", "5"))
        changed = dispersa.run(SMOKE, self.folder / "changed", workers=0, histories=False)
        with sqlite3.connect(changed.directory / "results.sqlite") as database:
            database.execute("update cases set digest = (select digest from cases where case_index = 4) where case_index = 3")
        database.close()
        # The row no longer fits its fingerprint: an internal error, as the program says.
        with self.assertRaises(dispersa.InternalError):
            changed.replay(3)
        program("replay", changed.directory, "--case", "3", code=1)

    def test_a_flight_that_differs_is_a_mismatch(self):
        # The campaign of another seed beside the results of this one.
        other = dispersa.run(SMOKE, self.folder / "other", workers=0, histories=False)
        (other.directory / "campaign.yaml").write_text(dispersa.load(SMOKE, seed=5).canonical_yaml)
        with self.assertRaisesRegex(dispersa.ReplayMismatch, "case 2 is not reproduced: .*digest stored ") as caught:
            other.replay(2)
        self.assertEqual(caught.exception.code, 6)
        self.assertIn("digest", {each["name"] for each in caught.exception.differences})
        program("replay", other.directory, "--case", "2", code=6)

    def test_report_again(self):
        copy = dispersa.run(SMOKE, self.folder / "again", workers=0, histories=False)
        (copy.directory / "report.html").unlink()
        dispersa.report(copy.directory)
        for name in FILES:
            self.assertEqual(content(copy.directory, name), content(self.theirs, name), name)

    def test_no_report_of_a_folder_that_another_process_writes(self):
        copy = dispersa.run(SMOKE, self.folder / "written", workers=0, histories=False)
        writer = os.open(copy.directory, os.O_RDONLY)
        self.addCleanup(os.close, writer)
        fcntl.flock(writer, fcntl.LOCK_EX)
        with self.assertRaisesRegex(dispersa.BadInput, "another dispersa process is writing this folder"):
            dispersa.report(copy.directory, histories=False)

    def test_compare(self):
        pd = self.folder / "pd"
        program("run", SMOKE, "--autopilot", CAMPAIGNS / "autopilots/pd.yaml", "--workers", "0", "--no-histories", "--quiet",
                "--out", pd)
        ours = dispersa.compare(self.theirs, pd, out=self.folder / "comparison")
        self.assertEqual(ours, printed("compare", self.theirs, pd))
        self.assertEqual(json.loads((self.folder / "comparison" / "compare.json").read_text()), ours)
        self.assertTrue((self.folder / "comparison" / "compare.html").is_file())
        with self.assertRaisesRegex(dispersa.BadInput, "'pitch' is not a metric"):
            dispersa.compare(self.ours, pd, metrics=["pitch"])

    def test_refusals(self):
        with self.assertRaisesRegex(dispersa.BadInput, "theirs.*resume=True to continue"):
            dispersa.run(SMOKE, self.theirs, workers=0)
        with self.assertRaises(dispersa.BadInput):
            dispersa.results(self.folder / "nothing")
        with self.assertRaisesRegex(TypeError, "unexpected keyword"):
            dispersa.run(SMOKE, thread=1)
        for call in (lambda: self.ours.replay(None), lambda: dispersa.compare(self.ours, self.ours, metrics=[5]),
                     lambda: dispersa.run(SMOKE, self.folder / "never", workers=True),
                     lambda: dispersa.run(SMOKE, self.folder / "never", workers=0, threads=None),
                     lambda: dispersa.run(SMOKE, self.folder / "never", workers=0, resume="no"),
                     lambda: dispersa.margins(SMOKE, frequency_band_percent="15")):
            self.assertRaises(dispersa.BadInput, call)
        for argument in ({"domain": 1}, {"address": "127.0.0.1"}, {"keys": "keys"}, {"insecure": True}, {"priority": 1}):
            with self.assertRaisesRegex(dispersa.BadInput, "may be given only with `peer`"):
                dispersa.run(SMOKE, self.folder / "never", **argument)
        for argument in ({"workers": 1}, {"threads": 1}, {"resume": True}, {"histories": False}, {"envelope": 5}):
            with self.assertRaisesRegex(dispersa.BadInput, "may be given only without `peer`"):
                dispersa.run(SMOKE, self.folder / "never", peer="127.0.0.1", **argument)
        with self.assertRaisesRegex(dispersa.BadInput, "allowed: keys=DIR .*, address=127.0.0.1 .*, or insecure=True on a network"):
            dispersa.run(SMOKE, self.folder / "never", peer="198.51.100.1", domain=88)
        with self.assertRaisesRegex(dispersa.BadInput, "^metrics: 'pitch' is not a metric"):
            dispersa.compare(self.ours, self.ours, metrics=["pitch"])
        with self.assertRaisesRegex(dispersa.BadInput, "priority: 1001 is out of range, allowed: a whole number from -1000 to 1000"):
            dispersa.run(SMOKE, self.folder / "never", peer="127.0.0.1", priority=1001)
        self.assertFalse((self.folder / "never").exists())

    def test_no_worker_is_incomplete(self):
        original = dispersa._results.worker_program
        dispersa._results.worker_program = lambda: "/nowhere/dispersa-worker"
        try:
            with self.assertRaisesRegex(dispersa.Incomplete, "/nowhere/dispersa-worker: no worker can be started") as caught:
                dispersa.run(SMOKE, self.folder / "none", workers=1, histories=False)
        finally:
            dispersa._results.worker_program = original
        self.assertEqual((caught.exception.code, len(caught.exception.results)), (5, 0))
        again = dispersa.run(SMOKE, self.folder / "none", workers=0, histories=False, resume=True)
        self.assertEqual((again.directory / "cases.csv").read_bytes(), (self.theirs / "cases.csv").read_bytes())


class Stages(unittest.TestCase):
    def test_a_vehicle_of_two_stages(self):
        """Columns depend on the vehicle's number of stages."""
        folder = folder_of(type(self))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", dispersa.InputWarning)
            campaign = dispersa.load(CAMPAIGNS / "gallery/electron/campaign.yaml", cases=3)
            ours = dispersa.run(campaign, folder / "ours", workers=0, histories=False)
        self.assertEqual(ours.campaign.stages, 2)
        with open(ours.directory / "cases.csv", newline="") as stream:
            rows = list(csv.reader(stream))
        self.assertEqual(list(ours.cases.columns), rows[0])
        flights = campaign.fly_many(histories=False)
        numpy.testing.assert_array_equal(flights.metrics.view("f8"), ours.metrics.view("f8"))
        self.assertEqual(dispersa.compare(ours, ours), printed("compare", ours.directory, ours.directory))
        with self.assertRaises(dispersa.BadInput):
            dispersa.compare(ours, ours, metrics=["pitch_error_peak_stage9_deg"])


class Studies(unittest.TestCase):
    def test_margins(self):
        said = json.loads(program("margins", SMOKE, "--json", "--cases", "3"))
        self.assertEqual(dispersa.margins(dispersa.load(SMOKE), cases=3), said)
        self.assertTrue(said["passed"])

    def test_search(self):
        theirs = printed("search", SMOKE, "--metric", "pitch_error_peak_deg", "--below", "0.12", "--flights", "60", "--seed", "3")
        ours = dispersa.search(SMOKE, "pitch_error_peak_deg", below=0.12, flights=60, seed=3)
        self.assertEqual(ours, theirs)
        self.assertNotEqual(ours["random_flights"], 0)
        for arguments, options, message in (
                ((), {"below": 1.0}, "metric: below and above need one, allowed: a name of metric_names"),
                (("pitch_error_peek_deg",), {}, "metric: 'pitch_error_peek_deg' is not a metric (did you mean 'pitch_error_peak_deg'?), "
                                                "allowed: a name of metric_names"),
                (("q_max_pa",), {"below": 1.0, "above": 2.0}, "below, above: both are given, allowed: one of them"),
                (("q_max_pa",), {"below": 1.0, "flights": 19}, "flights: 19 is out of range, allowed: a whole number from 20 to 1000000")):
            with self.assertRaises(dispersa.BadInput) as caught:
                dispersa.search(SMOKE, *arguments, **options)
            self.assertEqual(str(caught.exception), message)

    def test_tune(self):
        file = folder_of(type(self)) / "tuned.yaml"
        arguments = ("tune", SMOKE, "--seed", "5", "--cases", "1", "--evaluations", "64", "--out", file)
        theirs = printed(*arguments)
        written = file.read_text()
        ours = dispersa.tune(SMOKE, file, seed=5, cases=1, evaluations=64)
        self.assertEqual(ours, theirs)
        self.assertEqual(file.read_text().split("# which tried")[1], written.split("# which tried")[1])
        self.assertEqual(ours.yaml, file.read_text())
        self.assertEqual(ours.exit_code, 0 if ours["feasible"] else 3)

    def test_optimize(self):
        folder = folder_of(type(self))
        theirs = printed("optimize", CAMPAIGNS / "slv4_500km.yaml", "--seed", "2", "-o", folder / "theirs.yaml")
        ours = dispersa.optimize(CAMPAIGNS / "slv4_500km.yaml", folder / "ours.yaml", seed=2)
        self.assertEqual({**ours, "reference": ""}, {**theirs, "reference": ""})
        self.assertEqual((folder / "ours.yaml").read_text(), ours.yaml)
        self.assertEqual(ours.yaml, (folder / "theirs.yaml").read_text())
        self.assertEqual((folder / "ours.csv").read_bytes(), (folder / "theirs.csv").read_bytes())
        self.assertTrue(ours.reached and ours.exit_code == 0 and ours.statement == "")


class Interruption(unittest.TestCase):
    SCRIPT = """
import sys, dispersa
print("ready", flush=True)
try:
    dispersa.run(sys.argv[1], sys.argv[2], cases=100000, workers=int(sys.argv[3]), histories=False,
                 progress=lambda phase, done, *_: print("flying", done, flush=True))
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""

    def interrupt(self, workers):
        folder = folder_of(type(self)) / "results"
        process = subprocess.Popen([sys.executable, "-c", self.SCRIPT, str(SMOKE), str(folder), workers],
                                   stdout=subprocess.PIPE, text=True)
        try:
            done = 0
            while done < 20:
                word, *numbers = process.stdout.readline().split()
                done = int(numbers[0]) if word == "flying" else 0
            process.send_signal(signal.SIGINT)
            begin = time.monotonic()
            said, _ = process.communicate(timeout=30)
            self.assertEqual(said.split()[-1], "interrupted")
            self.assertLess(time.monotonic() - begin, 10.0)
            self.assertEqual(process.returncode, 0)
        finally:
            process.kill()
            process.wait()
        left = dispersa.results(folder)
        self.assertGreater(len(left), 0)
        self.assertEqual((left.verdict, left.exit_code), ("incomplete", dispersa.ExitCode.INCOMPLETE))
        self.assertIn("incomplete", repr(left))
        self.assertEqual({each["verdict"] for each in left.requirements}, {"inconclusive"})
        self.assertEqual(json.loads((folder / "execution.json").read_text())["problem"], "interrupted")

    def test_in_process(self):
        self.interrupt("0")

    def test_workers(self):
        self.interrupt("1")


class Service(unittest.TestCase):
    DOMAIN = 18  # no `dispersa run` takes it (private_domain.cc)

    def test_a_coordinator_flies_it(self):
        folder = folder_of(type(self))
        programs = []
        deadline = time.monotonic() + TIMEOUT_S / 2

        def hurry(*_):
            if time.monotonic() > deadline:
                raise TimeoutError("the coordinator does not end")

        try:
            for name, arguments in (("dispersa-coordinator", ["--data", folder / "data"]),
                                    ("dispersa-worker", ["--peer", "127.0.0.1"])):
                programs.append(subprocess.Popen(
                    [str(BINARIES / name), *map(str, arguments), "--domain", str(self.DOMAIN), "--address", "127.0.0.1"],
                    stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))
            results = dispersa.run(SMOKE, folder / "fetched", peer="127.0.0.1", domain=self.DOMAIN, address="127.0.0.1",
                                   progress=hurry)
        finally:
            for each in programs:
                each.terminate()
            for each in programs:
                each.wait(timeout=20)
        local = dispersa.run(SMOKE, folder / "local", workers=0, histories=False)
        self.assertEqual((results.directory / "cases.csv").read_bytes(), (local.directory / "cases.csv").read_bytes())
        self.assertEqual(results.exit_code, 0)


if __name__ == "__main__":
    unittest.main()
