"""Metrics of a campaign's own, through the program: the same bits from every engine, filled in later, refused in place.
"""
import csv
import json
import re
import shutil
import sqlite3
import unittest

from programs import CAMPAIGNS, dispersa, folder_of, smoke_text

CASES = "5"
OWN = {"q_burn1_max_kpa": "max(qbar_pa while burn1) / 1000",
       "deflection_burn2_rms_deg": "rms(deflection_pitch_deg while burn2)",
       "high_q_time_s": "time(qbar_pa > 30000 and burn)",
       "mass_burnout1_kg": "last(mass_kg while burn1)",
       "q_burn2_mean_pa": "mean(qbar_pa while burn2)",
       "altitude_coast_min_m": "min(altitude_m while coast)",
       "yaw_burn3_first_deg": "first(yaw_deg while burn3)",
       "impulse_mn_s": "integral(thrust_n while burn) / 1e6",
       "pitch_at_30_deg": "at(pitch_deg, 30.004)",
       "log_q_max": "max(log(qbar_pa + 1) * exp(-abs(mach)) + sin_deg(alpha_deg))",
       "program_mean_deg": "mean(pitch_program_deg while burn)",
       "lyapunov_never": "max(lyapunov_v while stage > 9)"}


def with_own(text, metrics, required=""):
    items = "".join(f"  - {{name: {name}, expression: '{expression}'}}\n" for name, expression in metrics.items())
    return text.replace("requirements:\n", f"metrics:\n{items}requirements:\n{required}") if metrics else text


class OwnMetrics(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = folder_of(cls)
        cls.text = smoke_text()
        cls.plain = cls.write("plain", {})
        cls.own = cls.write("own", OWN)
        cls.without = cls.flown(cls.plain, "without")
        cls.reference = cls.flown(cls.own, "reference")

    @classmethod
    def write(cls, name, metrics, required=""):
        path = cls.folder / f"{name}.yaml"
        path.write_text(with_own(cls.text, metrics, required))
        return path

    @classmethod
    def flown(cls, campaign, name, *options, code=4, workers=0, **environment):
        out = cls.folder / name / "out"  # a root of its own: campaigns beside one another are attempts at one design
        done = dispersa("run", campaign, "--cases", CASES, "--workers", workers, "--no-histories", "--quiet", "--out", out,
                        *options, env=environment)
        assert done.returncode == code, done.stderr
        return out

    @staticmethod
    def rows(folder):
        with open(folder / "cases.csv", newline="") as stream:
            return list(csv.DictReader(stream))

    def without_own(self, folder):
        return self.without_columns(self.rows(folder))

    def test_the_same_bytes_from_every_engine(self):
        for lanes in ("1", "4", "8"):
            out = self.flown(self.own, f"lanes{lanes}", DISPERSA_LANES=lanes, DISPERSA_ISA="v3")
            self.assertEqual((out / "cases.csv").read_bytes(), (self.reference / "cases.csv").read_bytes(), lanes)
        out = self.flown(self.own, "workers", workers=2)
        for name in ("cases.csv", "summary.json", "report.html"):
            self.assertEqual(self.content(out / name), self.content(self.reference / name), name)

    @staticmethod
    def content(file):
        """Without what a report says of its run: when, how long, by whom."""
        return re.sub(rb"<!-- run:begin -->.*?<!-- run:end -->", b"", file.read_bytes(), flags=re.S)

    def test_beside_every_other_capability(self):
        """Guidance, bending, restarts with jettisons, every dispersion at once, flights that a limit ends."""
        ending = self.folder / "ending"  # limits that some of the flights break, and that end them
        shutil.copytree(CAMPAIGNS, ending)
        vehicle = (ending / "vehicles/slv4.yaml").read_text()
        limits = re.search(r"^limits:.*$", vehicle, re.M).group()
        (ending / "vehicles/slv4.yaml").write_text(vehicle.replace(limits, "limits: {axial_load_g: 3.0, terminate: true}"))
        for campaign in (CAMPAIGNS / "orbit.yaml", CAMPAIGNS / "table3_flexible.yaml", CAMPAIGNS / "full.yaml",
                         CAMPAIGNS / "gallery/vega/campaign.yaml", ending / "table3.yaml"):
            plain = f"schema: dispersa/campaign/1\nbased_on: {campaign}\nwithout: [requirements]\n"
            with self.subTest(campaign=campaign):
                rows = {}
                for name, lanes in (("plain", "8"), ("one", "1"), ("eight", "8")):
                    text = plain if name == "plain" else plain + "metrics:\n" + "".join(
                        f"  - {{name: {metric}, expression: '{expression}'}}\n" for metric, expression in OWN.items()
                        if metric != "lyapunov_never")
                    path = self.folder / "beside.yaml"
                    path.write_text(text)
                    out = self.folder / "beside" / f"{campaign.parent.name}-{campaign.stem}-{name}" / "out"
                    done = dispersa("run", path, "--cases", "3", "--workers", "0", "--no-histories", "--quiet", "--out", out,
                                    env={"DISPERSA_LANES": lanes, "DISPERSA_ISA": "v3"})
                    self.assertIn(done.returncode, (0, 3, 4), done.stderr)
                    rows[name] = self.rows(out)
                self.assertEqual(rows["one"], rows["eight"])
                self.assertEqual(self.without_columns(rows["eight"]), rows["plain"])
                for row in rows["eight"]:
                    # A lost flight keeps what it measured until its end.
                    self.assertGreater(float(row["metric_q_burn1_max_kpa"]), 10)
                    self.assertEqual(row["metric_deflection_burn2_rms_deg"] == "",
                                     row["metric_deflection_rms_stage2_deg"] == "" if "metric_deflection_rms_stage2_deg" in row
                                     else float(row["end_time_s"]) < 60, row["outcome"])
        self.assertEqual({row["outcome"] for row in rows["eight"]}, {"structural_limit"})

    @staticmethod
    def without_columns(rows):
        return [{key: value for key, value in row.items() if key.removeprefix("metric_") not in OWN} for row in rows]

    def test_they_change_nothing_of_a_flight(self):
        self.assertEqual(self.without_own(self.reference), self.rows(self.without))
        summary, plain = (json.loads((folder / "summary.json").read_text()) for folder in (self.reference, self.without))
        self.assertEqual(summary["campaign"]["flight_id"], plain["campaign"]["flight_id"])
        self.assertNotEqual(summary["campaign"]["id"], plain["campaign"]["id"])

    def test_values_are_those_of_the_built_in_metrics_and_of_the_vehicle(self):
        for row in self.rows(self.reference):
            self.assertAlmostEqual(float(row["metric_q_burn1_max_kpa"]) * 1000 / float(row["metric_q_max_pa"]), 1, 4)
            self.assertGreater(float(row["metric_high_q_time_s"]), 0)
            self.assertEqual(row["metric_lyapunov_never"], "")
        said = json.loads(dispersa("fly", self.own, "--case", "3", "--json").stdout)
        row = self.rows(self.reference)[3]
        self.assertEqual({name: repr(said["metrics"][name]) for name in OWN if name != "lyapunov_never"},
                         {name: repr(float(row[f"metric_{name}"])) for name in OWN if name != "lyapunov_never"})
        self.assertIsNone(said["metrics"]["lyapunov_never"])

    def test_added_to_a_flown_campaign_they_are_filled_by_flying_again(self):
        out = self.flown(self.plain, "filled")
        before = (out / "cases.csv").read_bytes()
        digests = [row["digest"] for row in self.rows(out)]
        done = dispersa("run", self.own, "--cases", CASES, "--workers", "0", "--no-histories", "--out", out, "--resume")
        self.assertIn(f"{out}: 5 cases are flown again for the campaign's own metrics", done.stderr)
        for name in ("cases.csv", "campaign.yaml"):
            self.assertEqual((out / name).read_bytes(), (self.reference / name).read_bytes(), name)
        self.assertEqual([row["digest"] for row in self.rows(out)], digests)
        # A part of them is a change of columns alone, and so are none.
        self.flown(self.write("fewer", {"high_q_time_s": OWN["high_q_time_s"]}), "filled", "--resume")
        self.assertEqual([row["metric_high_q_time_s"] for row in self.rows(out)],
                         [row["metric_high_q_time_s"] for row in self.rows(self.reference)])
        self.flown(self.plain, "filled", "--resume")
        self.assertEqual((out / "cases.csv").read_bytes(), before)

    def test_a_damaged_flight_is_not_filled(self):
        out = self.flown(self.plain, "conflict")
        with sqlite3.connect(out / "results.sqlite") as database:
            # As a flight of another machine would be whose bits differ: the row is whole, its digest another.
            database.execute("UPDATE cases SET digest = '0123456789abcdef0123456789abcdef' WHERE case_index = 2")
        done = dispersa("run", self.own, "--cases", CASES, "--workers", "0", "--no-histories", "--out", out, "--resume")
        self.assertIn("case 2 is damaged; it is flown again", done.stderr)
        self.assertEqual((out / "cases.csv").read_bytes(), (self.reference / "cases.csv").read_bytes())

    def test_a_requirement_is_judged_and_its_expression_is_part_of_it(self):
        required = "  - {metric: high_q_time_s, below: %s, probability: 0.3, consumer_risk: 0.4}\n"
        passes = self.flown(self.write("passes", OWN, required % 1000), "passes")
        verdicts = {r["metric"]: r["verdict"] for r in json.loads((passes / "summary.json").read_text())["requirements"]}
        self.assertEqual(verdicts["high_q_time_s"], "pass")
        self.flown(self.write("fails", OWN, required % 1), "fails", code=3)
        other = {**OWN, "high_q_time_s": "time(qbar_pa > 90000)"}
        dispersa("run", self.write("passes", other, required % 1000), "--cases", CASES, "--workers", "0", "--no-histories",
                 "--quiet", "--out", passes, "--resume")
        joint = json.loads((passes / "summary.json").read_text())["joint"]
        self.assertNotEqual(joint["requirements_id"], joint["registered_requirements_id"])

    def test_reports_and_exports_have_them(self):
        self.assertEqual(json.loads((self.reference / "summary.json").read_text())["metrics"]["q_burn1_max_kpa"]["unit"], "kPa")
        self.assertIn(OWN["q_burn1_max_kpa"], (self.reference / "report.html").read_text())
        lines = self.folder / "lines.jsonl"
        self.assertEqual(dispersa("export", self.reference, "--format", "jsonl", "--out", lines).returncode, 0)
        self.assertIn("metric_mass_burnout1_kg", json.loads(lines.read_text().splitlines()[0]))
        self.assertEqual(dispersa("export", self.reference, "--format", "hdf5", "--out", self.folder / "own.h5").returncode, 0)

    def test_replay_has_the_same_bits(self):
        done = dispersa("replay", self.reference, "--case", "4", "--json")
        self.assertTrue(json.loads(done.stdout)["match"], done.stdout)

    def test_compare_takes_those_that_mean_the_same(self):
        other = self.flown(self.write("other", {**OWN, "high_q_time_s": "time(qbar_pa > 20000)"}), "other")
        compared = dispersa("compare", self.reference, other, "--out", self.folder / "compared", "--json")
        names = {metric["metric"] for metric in json.loads(compared.stdout)["metrics"]}
        self.assertIn("q_burn1_max_kpa", names)
        self.assertNotIn("high_q_time_s", names)
        asked = dispersa("compare", self.reference, other, "--metric", "high_q_time_s", "--out", self.folder / "asked")
        self.assertEqual((asked.returncode, asked.stderr),
                         (2, "--metric: 'high_q_time_s' has another expression in each campaign, allowed: a metric that means "
                             "the same in both\n"))
        lacks = dispersa("compare", self.reference, self.without, "--metric", "high_q_time_s", "--out", self.folder / "lacks")
        self.assertEqual((lacks.returncode, lacks.stderr),
                         (2, f"--metric: {self.without}: 'high_q_time_s' is not a metric, allowed: a metric that both campaigns "
                             "have\n"))

    def test_search_finds_them(self):
        found = dispersa("search", self.own, "--metric", "high_q_time_s", "--below", "1", "--flights", "20", "--json")
        self.assertEqual(json.loads(found.stdout)["metric"], "high_q_time_s", found.stderr)
        wrong = dispersa("search", self.own, "--metric", "high_q_tim_s", "--below", "1")
        self.assertEqual((wrong.returncode, wrong.stderr),
                         (2, "--metric: 'high_q_tim_s' is not a metric (did you mean 'high_q_time_s'?), allowed: a name in "
                             "cases.csv without its prefix 'metric_'\n"))

    def test_a_text_that_was_changed_after_the_flights_is_refused(self):
        changed = self.folder / "changed"
        shutil.copytree(self.reference, changed)
        text = (changed / "campaign.yaml").read_text()
        (changed / "campaign.yaml").write_text(text.replace("30000", "20000"))
        done = dispersa("report", changed)
        self.assertEqual((done.returncode, done.stderr),
                         (2, f"{changed}: the metrics of its campaign.yaml are not those that were measured, allowed: `dispersa run "
                             f"CAMPAIGN --out {changed} --resume`, which flies the cases again\n"))


if __name__ == "__main__":
    unittest.main()
