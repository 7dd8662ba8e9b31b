"""`dispersa init` for a new user: each starting point is complete, commented and valid, and it flies."""
import json
import shutil
import unittest

from programs import dispersa, folder_of

FILES = ["README.md", "autopilot.yaml", "campaign.yaml", "reference.yaml", "schemas", "trajectory.yaml", "vehicle.yaml"]


class InitTest(unittest.TestCase):
    def setUp(self):
        self.folder = folder_of(self)

    @classmethod
    def setUpClass(cls):
        cls.made = folder_of(cls)
        for name in ("slv4", "vega"):
            done = dispersa("init", cls.made / name, "--from", name)
            assert done.returncode == 0, done.stderr

    def init(self, name="slv4"):
        """A copy of what `init --from` wrote."""
        made = self.folder / "made"
        shutil.copytree(self.made / name, made)
        self.assertEqual(FILES, sorted(path.name for path in made.iterdir()))
        return made

    def flies(self, made):
        """Strictly valid, and 20 cases end with a verdict, not with an error."""
        yaml_files = sorted(path.name for path in made.glob("*.yaml"))
        done = dispersa("validate", "--strict", *yaml_files, cwd=made)
        self.assertEqual(0, done.returncode, done.stdout)
        done = dispersa("run", "campaign.yaml", "--cases", 20, "--workers", 0, "--no-histories", "--quiet", "--out", "results",
                        cwd=made)
        self.assertEqual(4, done.returncode, done.stderr)  # 20 are too few
        self.assertEqual(21, len((made / "results" / "cases.csv").read_text().splitlines()))

    def test_what_it_writes_flies(self):
        self.flies(self.init())

    def test_vega_flies(self):
        self.flies(self.init("vega"))

    def test_every_key_of_the_first_of_its_kind_has_a_comment(self):
        made = self.init()
        for name in ("campaign.yaml", "autopilot.yaml", "trajectory.yaml", "vehicle.yaml"):
            explained, plain = set(), set()
            for line in (made / name).read_text().splitlines():
                code, hash_, _ = line.partition("#")
                # A key on a line of its own; in braces stand those that were explained, or say what they are.
                key = code.strip().removeprefix("- ").partition(":")[0]
                if not code.strip() or key.startswith(("{", "[")):
                    continue
                (explained if hash_ else plain).add(key)
            # Names and shapes say what they are; so does what stands under a comment that explains the list or map.
            obvious = {"requirements", "sampling", "dispersions", "name", "vehicle", "autopilot", "distribution", "schema", "gains", "law", "yaw", "pitch", "seed",
                       "reference", "longitude_deg", "diameter_m", "top_station_m", "bottom_station_m", "outer_diameter_m",
                       "burning_time_s", "rate_limit_deg_s", "pitch_yaw_arm_m", "roll_arm_m", "specific_impulse_s", "per",
                       "three_sigma_percent", "axial_load_g", "lateral_load_g", "velocity_per_m_s", "altitude_per_km",
                       "flight_path_angle_per_deg", "transonic_mach_high", "three_sigma_deg"}
            self.assertEqual(set(), plain - explained - obvious, name)

    def test_editors_find_the_schema_of_each_file(self):
        made = self.init()
        for name, kind in (("campaign", "campaign"), ("vehicle", "vehicle"), ("autopilot", "autopilot"),
                           ("reference", "reference"), ("trajectory", "campaign")):
            first = (made / f"{name}.yaml").read_text().splitlines()[0]
            self.assertEqual(f"# yaml-language-server: $schema=schemas/{kind}.json", first)
            json.loads((made / "schemas" / f"{kind}.json").read_text())

    def test_a_folder_in_use_is_refused_and_stays(self):
        (self.folder / "mine.txt").write_text("mine")
        done = dispersa("init", self.folder)
        self.assertEqual(2, done.returncode)
        self.assertEqual(f"'{self.folder}' is not empty, allowed: a folder that is new or empty\n", done.stderr)
        self.assertEqual(["mine.txt"], [path.name for path in self.folder.iterdir()])

    def test_a_file_in_its_place_is_refused(self):
        (self.folder / "made").write_text("mine")
        done = dispersa("init", self.folder / "made")
        self.assertEqual(2, done.returncode)
        self.assertEqual(f"'{self.folder / 'made'}' is a file, allowed: a folder that is new or empty\n", done.stderr)

    def test_an_unknown_start_is_refused(self):
        done = dispersa("init", self.folder / "made", "--from", "vegas")
        self.assertEqual(2, done.returncode)
        self.assertEqual("--from: there is no 'vegas' (did you mean 'vega'?), allowed: one of slv4, vega, electron, scout",
                         done.stderr.splitlines()[0])

    def test_an_empty_folder_will_do(self):
        (self.folder / "made").mkdir()
        done = dispersa("--json", "init", self.folder / "made", "--from", "scout")
        self.assertEqual(0, done.returncode, done.stderr)
        report = json.loads(done.stdout)
        self.assertEqual(("dispersa/init/1", "scout"), (report["schema"], report["from"]))
        made = self.folder / "made"
        self.assertEqual({str(path.relative_to(made)) for path in made.rglob("*") if path.is_file()}, set(report["files"]))
        done = dispersa("validate", "--strict", "campaign.yaml", "trajectory.yaml", cwd=self.folder / "made")
        self.assertEqual(0, done.returncode, done.stdout)


if __name__ == "__main__":
    unittest.main()
