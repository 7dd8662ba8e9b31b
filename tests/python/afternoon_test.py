"""The tasks of an analyst's afternoon, in order: a shipped campaign is edited, checked, planned, flown on workers,
viewed and compared, its worst case is flown again, and it is reported. Also a thousand histories in memory.
"""
import json
import os
import pathlib
import unittest

import matplotlib.pyplot as pyplot
import numpy

import dispersa
import dispersa.plot
from program import CAMPAIGNS, folder_of, printed, program

# Where pictures are to be looked at; else they end with the test.
PICTURES = os.environ.get("DISPERSA_PICTURES")
METRIC = "pitch_error_peak_deg"


class Afternoon(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = folder_of(cls)
        cls.addClassCleanup(pyplot.close, "all")
        cls.tree = dispersa.read(CAMPAIGNS / "table3.yaml", inlined=True)
        cls.tree["name"] = "afternoon"
        cls.tree["sampling"]["cases"] = 60
        cls.tree["dispersions"]["wind"]["max_speed_m_s"] = 75.0
        for gains in cls.tree["autopilot"]["pitch"]["gains"]:
            gains["kp_1_s2"] *= 1.1
        cls.campaign = dispersa.load(cls.tree)
        cls.seen = []
        cls.results = dispersa.run(cls.campaign, cls.folder / "edited", workers=2, progress=lambda *what: cls.seen.append(what))

    def test_1_what_was_edited_is_what_is_loaded(self):
        shipped = dispersa.load(CAMPAIGNS / "table3.yaml", cases=60)
        self.assertEqual((self.campaign.cases, self.campaign.name), (60, "afternoon"))
        self.assertNotEqual(self.campaign.flight_id, shipped.flight_id)
        ours, theirs = self.campaign.plan(), shipped.plan()
        self.assertEqual(set(ours["wind_max_speed_m_s"]), {75.0})
        self.assertTrue(numpy.array_equal(ours["drag_factor"], theirs["drag_factor"]))
        # Without the edits it is the shipped one, inlined or not.
        tree = dispersa.read(CAMPAIGNS / "table3.yaml", inlined=True)
        tree["sampling"]["cases"] = 60
        self.assertEqual(dispersa.load(tree), shipped)

    def test_2_errors_are_objects(self):
        tree = dispersa.read(CAMPAIGNS / "table3.yaml", inlined=True)
        self.assertTrue(dispersa.validate(tree))
        tree["dispersions"]["wind"]["max_speed_m_s"] = -75.0
        tree["autopilot"]["pitch"]["gains"][2]["kp_1_s"] = tree["autopilot"]["pitch"]["gains"][2].pop("kp_1_s2")
        validation = dispersa.validate(tree)
        self.assertFalse(validation)
        self.assertLessEqual({"dispersions.wind.max_speed_m_s", "autopilot.pitch.gains[2].kp_1_s"},
                             {problem.path for problem in validation.errors})
        wind, = (problem for problem in validation.errors if problem.path.startswith("dispersions.wind"))
        self.assertIn("-75", wind.message)
        self.assertTrue(wind.allowed)

    def test_3_progress_was_told(self):
        phases = list(dict.fromkeys(phase for phase, *_ in self.seen))
        self.assertEqual(phases[0], "afternoon")
        self.assertIn(("afternoon", 60, 60), {what[:3] for what in self.seen})
        done = [done for phase, done, *_ in self.seen if phase == "afternoon"]
        self.assertEqual(done, sorted(done))
        execution = json.loads((self.results.directory / "execution.json").read_text())
        self.assertEqual(len(execution["workers"]), 2)

    def test_4_results_as_arrays_and_as_a_table(self):
        peak = self.results.metrics[METRIC]
        self.assertEqual((peak.shape, peak.dtype), ((60,), numpy.float64))
        table = self.results.cases
        self.assertEqual(table.shape[0], 60)
        numpy.testing.assert_array_equal(table["metric_" + METRIC], peak)
        numpy.testing.assert_array_equal(table["input_thrust_factor_stage1"], self.campaign.plan()["thrust_factor_stage1"])
        self.assertAlmostEqual(table["metric_" + METRIC].describe()["mean"],
                               self.results.summary["metrics"][METRIC]["mean"], delta=1e-12)

    def test_5_bands(self):
        ax = dispersa.plot.bands(self.results, "pitch_error_deg")
        file = pathlib.Path(PICTURES or self.folder) / "afternoon_bands.png"
        ax.figure.savefig(file)
        self.assertGreater(pyplot.imread(file)[:, :, :3].std(), 0.03)

    def test_6_two_controllers(self):
        other = dispersa.run(self.tree, self.folder / "pd", autopilot=CAMPAIGNS / "autopilots/pd.yaml", workers=2, histories=False)
        numpy.testing.assert_array_equal(other.inputs, self.results.inputs)
        compared = dispersa.compare(self.results, other, metrics=[METRIC, "pitch_error_rms_deg"], out=self.folder / "compared")
        self.assertTrue(compared["pairing"]["paired"])
        rms, = (each for each in compared["metrics"] if each["metric"] == "pitch_error_rms_deg")
        self.assertGreater(rms["ratio"]["median"], 2.0)
        self.assertTrue((self.folder / "compared" / "compare.html").is_file())

    def test_7_the_worst_case_again(self):
        worst, second = self.results.worst(METRIC, 2)
        peak = self.results.metrics[METRIC]
        self.assertEqual((peak[worst], peak[second]), tuple(numpy.sort(peak)[:-3:-1]))
        shown = [case["case_index"] for case in self.results.summary["worst_cases"] if case["metric"] == METRIC]
        self.assertEqual(self.results.worst(METRIC, len(shown)), shown)
        flight = self.results.campaign.fly(worst, step_s=0.01)  # every tick
        self.assertEqual(flight.metrics[METRIC], peak[worst])
        said = printed("replay", self.results.directory, "--case", worst, "--history", self.folder / "worst.csv")
        self.assertEqual((flight.digest, self.results.digest[worst]), (said["digest"], said["stored_digest"]))
        theirs = numpy.genfromtxt(self.folder / "worst.csv", delimiter=",", skip_header=1)
        numpy.testing.assert_array_equal(flight.history.rows, theirs)
        self.assertAlmostEqual(numpy.nanmax(numpy.abs(flight.history["pitch_error_deg"])), peak[worst], delta=1e-9)
        for name in ("pitch_launch", "injection_altitude"):
            with self.assertRaisesRegex(dispersa.BadInput, f"worst: '{name}' is not a metric of these flights"):
                self.results.worst(name)
        with self.assertRaisesRegex(dispersa.BadInput, r"flights \(did you mean 'pitch_error_peak_deg'\?\), allowed"):
            self.results.worst("pitch_error_peek_deg")

    def test_8_report(self):
        again = dispersa.report(self.results)
        self.assertIn("Dispersion campaign afternoon", again.report.read_text())
        self.assertEqual(again.verdict, "inconclusive")  # so few cases decide nothing
        program("report", self.results.directory, "--quiet", code=int(again.exit_code))

    def test_9_a_thousand_histories_in_one_call(self):
        campaign = dispersa.load(CAMPAIGNS / "table3.yaml", cases=1000)
        flights = campaign.fly_many(columns=["time_s", "pitch_error_deg"], step_s=1.0)
        rows = flights.histories
        self.assertEqual((len(flights), rows.shape), (1000, (flights.offsets[-1], 2)))
        one = flights[613].history
        self.assertTrue(numpy.shares_memory(one["pitch_error_deg"], rows))
        self.assertFalse(rows.flags.owndata or one.rows.flags.owndata)
        self.assertEqual(type(rows.base).__name__, "PyCapsule")
        frame = one.frame()
        self.assertTrue(numpy.shares_memory(frame["pitch_error_deg"].to_numpy(), rows))
        kept, expected = one["pitch_error_deg"], one["pitch_error_deg"].copy()
        del flights, rows, one, frame, campaign  # the column alone keeps the memory
        numpy.testing.assert_array_equal(kept, expected)


if __name__ == "__main__":
    unittest.main()
