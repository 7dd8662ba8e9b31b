"""The tutorial, cell by cell as a reader runs it, and the plots: files with content, and errors that name the
mistake.
"""
import os
import pathlib
import re
import subprocess
import sys
import unittest

import matplotlib.pyplot as pyplot
import numpy

import dispersa
import dispersa.plot
from program import CAMPAIGNS, SMOKE, folder_of

TUTORIAL = pathlib.Path(os.environ["DISPERSA_PYTHON_SOURCES"]) / "tutorial" / "tutorial.py"
# Where pictures are to be looked at; else they end with the test.
PICTURES = os.environ.get("DISPERSA_PICTURES")


class Tutorial(unittest.TestCase):
    def test_runs_from_end_to_end(self):
        folder = folder_of(type(self))
        (folder / "campaigns").symlink_to(CAMPAIGNS)
        done = subprocess.run([sys.executable, "-B", "-W", "error::UserWarning", str(TUTORIAL)], cwd=folder, text=True,
                              capture_output=True, timeout=300)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        for line in ("completed", "table3: 120 of 120 2 workers", "flown with a Python law, 'damped', which is not here", "inconclusive 4 ", "/tutorial/table3/report.html", "margins met: True", "target reached: True"):
            self.assertIn(line, done.stdout)
        self.assertIn("dispersions.wind.max_speed_m_s | ", done.stdout)
        for name in ("history", "ground_track", "bands", "exceedance", "drivers"):
            picture = pyplot.imread(folder / "tutorial" / f"{name}.png")
            self.assertGreater(picture[:, :, :3].std(), 0.03, name)
        if PICTURES:
            for file in (folder / "tutorial").glob("*.png"):
                (pathlib.Path(PICTURES) / file.name).write_bytes(file.read_bytes())

    def test_has_cells(self):
        cells = re.split(r"^# %%.*$", TUTORIAL.read_text(), flags=re.MULTILINE)
        self.assertGreater(len(cells), 15)
        for cell in cells:
            compile(cell, "cell", "exec")


class Plots(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = folder_of(cls)
        cls.addClassCleanup(pyplot.close, "all")
        cls.results = dispersa.run(CAMPAIGNS / "table3.yaml", folder / "results", cases=40, workers=0)
        cls.flights = cls.results.campaign.fly_many(8)

    def test_bands_show_the_reports_numbers(self):
        ax = dispersa.plot.bands(self.results, "pitch_error_deg")
        bands = self.results.bands()
        median, = (line for line in ax.get_lines() if line.get_label() == "median")
        numpy.testing.assert_array_equal(median.get_ydata(), bands["pitch_error_deg_p50"])
        self.assertEqual((ax.get_xlabel(), ax.get_ylabel()), ("time since lift-off, s", "pitch error, °"))
        self.assertEqual([text.get_text() for text in ax.get_legend().get_texts()], ["min–max", "1–99 %", "median", "nominal"])
        self.assertEqual([text.get_text() for text in ax.texts], ["S1", "S2", "S3", "coast", "S4"])

    def test_bands_of_flights(self):
        ax = dispersa.plot.bands(self.flights, "altitude_m")
        median, = (line for line in ax.get_lines() if line.get_label() == "median")
        self.assertGreater(numpy.nanmax(median.get_ydata()), 400e3)

    def test_exceedance(self):
        ax = dispersa.plot.exceedance(self.results, "pitch_error_peak_deg")
        curve, limit = ax.get_lines()
        self.assertEqual(curve.get_ydata()[0], 39 / 40)
        self.assertEqual(limit.get_xdata()[0], 0.5)
        self.assertEqual(ax.get_xlabel(), "Pitch error, peak, °")

    def test_drivers(self):
        axes = dispersa.plot.drivers(self.results, "pitch_error_peak_deg", count=2)
        # Of so few flights few inputs have a share whose interval does not hold 0, and only those are named.
        self.assertEqual(len(axes), min(2, len(self.results.summary["drivers"]["pitch_error_peak_deg"])))
        self.assertEqual(len(axes[0].get_lines()[0].get_xdata()), 40)
        with self.assertRaisesRegex(dispersa.BadInput, "the report names none of 'apogee'"):
            dispersa.plot.drivers(self.results, "apogee")

    def test_history_and_ground_track(self):
        axes = dispersa.plot.history(self.flights, ["altitude_m", "qbar_pa"])
        self.assertEqual([ax.get_ylabel() for ax in axes], ["altitude, m", "qbar, Pa"])
        ax, = dispersa.plot.history(self.flights[0], "altitude_m", labels=["damped"])
        self.assertEqual([text.get_text() for text in ax.get_legend().get_texts()], ["damped"])
        ax = dispersa.plot.ground_track(self.flights[0])
        self.assertEqual([text.get_text() for text in ax.get_legend().get_texts()], ["end", "lift-off"])
        with self.assertRaisesRegex(dispersa.BadInput, "a flight without a history"):
            dispersa.plot.ground_track(self.results.campaign.fly(history=False))

    def test_what_cannot_be_drawn(self):
        plot, campaign = dispersa.plot, self.results.campaign
        flight, none, bare = campaign.fly(1), campaign.fly_many(0), campaign.fly_many(2, histories=False)
        timeless = campaign.fly_many(2, columns=["altitude_m"])
        for draw, said in ((lambda: plot.history([], "altitude_m"), "there are no flights"),
                           (lambda: plot.history(flight, []), "0 columns"),
                           (lambda: plot.history(flight, "nope"), "the history has no column 'nope'"),
                           (lambda: plot.history([flight, flight], "altitude_m", labels=["one"]), "labels: 1 for 2 flights"),
                           (lambda: plot.history(flight, ["altitude_m", "qbar_pa"], axes=pyplot.figure().gca()), "2 columns, 1 axes"),
                           (lambda: plot.bands(none, "altitude_m"), "there are no flights"),
                           (lambda: plot.bands(bare, "altitude_m"), "a flight without a history"),
                           (lambda: plot.bands(timeless, "altitude_m"), "no column 'time_s'"),
                           (lambda: plot.bands(None, "altitude_m"), "bands: of Results or Flights, not of a NoneType"),
                           (lambda: plot.bands([flight], "altitude_m"), "bands: of Results or Flights"),
                           (lambda: plot.ground_track(none), "there are no flights"),
                           (lambda: plot.ground_track(timeless), "no column 'longitude_deg'")):
            with self.assertRaisesRegex(dispersa.BadInput, said):
                draw()
        self.assertEqual(len(plot.bands(campaign.fly_many(2, law=lambda tick: numpy.nan), "altitude_m").get_lines()), 1)

    def test_what_is_not_there(self):
        with self.assertRaisesRegex(dispersa.BadInput, "the report has none of 'roll'"):
            dispersa.plot.bands(self.results, "roll")
        with self.assertRaisesRegex(dispersa.BadInput, "'pitch' is not a metric of this vehicle"):
            dispersa.plot.exceedance(self.results, "pitch")
        with self.assertRaisesRegex(dispersa.BadInput, r"vehicle \(did you mean 'pitch_error_peak_deg'\?\)$"):
            dispersa.plot.exceedance(self.results, "pitch_error_peek_deg")


if __name__ == "__main__":
    unittest.main()
