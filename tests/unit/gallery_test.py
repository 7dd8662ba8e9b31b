"""The gallery: its files are valid and usual, a few cases fly, and events agree with the published ones.

DISPERSA_GALLERY=all: of all launchers; otherwise three that differ in everything fly, and all are valid.
"""
import os
import pathlib
import sys
import tempfile
import unittest

from programs import BINARIES, CAMPAIGNS, dispersa, run

GALLERY = CAMPAIGNS / "gallery"
TABLE = pathlib.Path(__file__).parent.parent / "tools" / "gallery_table.py"
CONTROLLED = ("vega", "electron", "scout", "falcon9", "falcon9_leo", "ariane5", "soyuz")
LAUNCHERS = (*CONTROLLED, "nike_apache")
# Four solid stages; liquid boosters around a guided core; a flight without control.
FLOWN = LAUNCHERS if os.environ.get("DISPERSA_GALLERY") == "all" else ("scout", "soyuz", "nike_apache")
FURTHER = ("vega", "falcon9", "falcon9_leo", "ariane5", "soyuz")
CASES = 4


class Gallery(unittest.TestCase):
    def test_vehicles_are_valid_and_usual(self):
        for launcher in LAUNCHERS:
            done = dispersa("validate", "--strict", GALLERY / launcher / "vehicle.yaml")
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_cases_complete_with_the_same_bits_in_any_lanes(self):
        for launcher in FLOWN:
            with tempfile.TemporaryDirectory() as folder:
                tables = []
                for lanes in ("1", "4", "8"):
                    out = pathlib.Path(folder) / lanes
                    done = dispersa("run", GALLERY / launcher / "campaign.yaml", "--cases", str(CASES), "--workers", "0",
                                    "--no-histories", "--out", out, env={"DISPERSA_LANES": lanes, "DISPERSA_ISA": "v3"})
                    self.assertIn(done.returncode, (0, 4), done.stderr)  # 4: so few cases decide nothing
                    tables.append((out / "cases.csv").read_bytes())
                self.assertEqual(tables[0], tables[1], launcher)
                self.assertEqual(tables[0], tables[2], launcher)
                self.assertEqual(tables[0].count(b",completed,"), CASES, launcher)
                # A fifth stage has columns, and so have a cluster and boosters. Others do without.
                self.assertEqual(b"_stage5_" in tables[0], launcher in FURTHER, launcher)

    def test_autopilots_meet_the_gates(self):
        for launcher in set(FLOWN) & set(CONTROLLED):
            done = dispersa("margins", GALLERY / launcher / "campaign.yaml")
            self.assertEqual(done.returncode, 0, done.stdout[-400:])

    def test_the_sounding_rocket_has_no_autopilot(self):
        for command in ("margins", "tune", "optimize"):
            out = ["--out", "tuned.yaml"] if command == "tune" else []
            done = dispersa(command, GALLERY / "nike_apache" / "campaign.yaml", *out)
            self.assertEqual(done.returncode, 2, command)
            self.assertIn("'nike_apache' has no autopilot", done.stderr, command)

    def test_events_are_those_of_the_table_and_as_published(self):
        done = run(sys.executable, "-B", TABLE, BINARIES / "dispersa", GALLERY, "--check", *FLOWN)
        self.assertEqual(done.returncode, 0, done.stdout)


if __name__ == "__main__":
    unittest.main()
