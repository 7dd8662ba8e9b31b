"""A campaign whose cases each meet one sounding of a folder: the same bytes however it is flown, its file and time in
each row, and a case flown again.

Environment as of processes.py.
"""
import csv
import pathlib
import subprocess
import tempfile
import unittest

from processes import BINARIES, Run, main, smoke_text

SOUNDINGS = pathlib.Path(__file__).parents[1] / "data" / "soundings"
CASES = 24


class EnsembleTest(unittest.TestCase):
    def test_bytes_rows_and_replay(self):
        with tempfile.TemporaryDirectory(prefix="dispersa-ensemble-") as folder:
            root = pathlib.Path(folder)
            ensemble = root / "soundings"
            ensemble.mkdir()
            wyoming, igra = ((SOUNDINGS / name).read_text() for name in ("wyoming.txt", "igra.txt"))
            (ensemble / "a.txt").write_text(wyoming.replace("15 Jan 2020", "3 Jul 2019"))
            (ensemble / "b.txt").write_text(igra + igra.replace("01 15 12", "01 16 00").replace("535", "105"))
            text = smoke_text()
            begin, end = text.index("  wind:"), text.index("\n", text.index("  wind:"))
            campaign = root / "campaign.yaml"
            campaign.write_text(text[:begin] + f"  weather: {{ensemble: {ensemble}, draw: by_month}}" + text[end:])

            def flown(name, *arguments):
                run = Run(root / name, "--cases", CASES, "--no-histories", *arguments, campaign=campaign).finish()
                self.assertIn(run.code, (0, 3, 4), run.stderr)
                return run

            alone, beside = flown("alone", "--workers", 0, "--threads", 1), flown("beside", "--workers", 2)
            self.assertEqual(alone.csv(), beside.csv())
            rows = list(csv.DictReader(alone.csv().decode().splitlines()))
            known = {"1": ("a.txt", "2019-07-03T12"), "2": ("b.txt", "2020-01-15T12"), "3": ("b.txt", "2020-01-16T00")}
            for row in rows:
                self.assertEqual((row["sounding_file"], row["sounding_time"]), known[row["input_weather_sounding"]])
            self.assertEqual({row["input_weather_sounding"] for row in rows}, set(known))
            # Each case again, from the folder alone; and the wind of its sounding shows.
            ensemble.rename(root / "gone")
            for case in (0, 7):
                done = subprocess.run([BINARIES / "dispersa", "replay", root / "alone", "--case", str(case)],
                                      capture_output=True, text=True)
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                self.assertIn("reproduced to the last bit", done.stdout)
            (root / "gone").rename(ensemble)
            done = subprocess.run([BINARIES / "dispersa", "plan", campaign], capture_output=True, text=True)
            self.assertIn("b.txt  2020-01-16T00", done.stdout)


if __name__ == "__main__":
    main()
