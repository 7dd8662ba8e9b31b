"""No green without proof: exit codes, badges and the ledger of attempts, as a user meets them.
"""
import json
import re
import shutil
import unittest
import xml.etree.ElementTree

from programs import CAMPAIGNS, dispersa, folder_of, smoke_text

REQUIREMENT = re.compile(r"requirements:\n.*", re.S)
RUN = re.compile(rb"<!-- run:begin -->.*?<!-- run:end -->", re.S)
MET = "{metric: pitch_error_peak_deg, below: 1, probability: 0.8, consumer_risk: 0.10}"
BROKEN = "{metric: pitch_error_peak_deg, below: 1.0e-9, probability: 0.8, consumer_risk: 0.10}"


class EvidenceTest(unittest.TestCase):
    def setUp(self):
        self.root = folder_of(self)
        self.count = 0

    def campaign(self, *requirements, sampling=None, more=""):
        """The smoke campaign with other requirements."""
        stated = "requirements:\n" + "".join(f"  - {one}\n" for one in requirements) if requirements else ""
        text = REQUIREMENT.sub(stated + more, smoke_text())
        if sampling:
            text = re.sub(r"sampling: .*", f"sampling: {sampling}", text)
        self.count += 1
        file = self.root / f"campaign{self.count}.yaml"
        file.write_text(text)
        return file

    def fly(self, campaign, name, *arguments):
        done = dispersa("run", campaign, "--workers", "0", "--no-histories", "--quiet", "--out", self.root / "results" / name,
                             *arguments)
        self.assertNotIn(done.returncode, (1, 2), done.stderr)
        return done.returncode

    def execution(self, name):
        return json.loads((self.root / "results" / name / "execution.json").read_text())

    def junit(self, name):
        file = self.root / "junit.xml"
        dispersa("export", self.root / "results" / name, "--format", "junit", "--out", file)
        suite = xml.etree.ElementTree.parse(file).getroot().find("testsuite")
        return suite, [int(suite.get(key)) for key in ("failures", "errors", "skipped")]

    def page(self, name):
        return (self.root / "results" / name / "report.html").read_text()

    def test_a_requirement_that_was_loosened_or_dropped_after_flights(self):
        self.assertEqual(self.fly(self.campaign(BROKEN), "out"), 3)
        self.assertEqual(self.fly(self.campaign(MET), "out", "--resume"), 7)
        self.assertEqual(self.execution("out")["standing_verdict"], "not_evidence")
        self.assertIn('<span class="badge post-hoc">', self.page("out"))
        self.assertNotIn('<span class="badge pass">', self.page("out"))
        suite, counts = self.junit("out")
        self.assertEqual(counts[0], 0)
        self.assertEqual(counts[1], 2)  # the new one and the one that is gone
        self.assertIn("Its last verdict: fail", xml.etree.ElementTree.tostring(suite, encoding="unicode"))
        # A report made again is no way out, nor is leaving it out.
        self.assertEqual(dispersa("report", self.root / "results/out", "--no-histories", "--quiet").returncode, 7)
        self.assertEqual(self.fly(self.campaign(), "out", "--resume"), 7)
        # Edited in the folder itself.
        self.assertEqual(self.fly(self.campaign(BROKEN), "edited"), 3)
        stored = self.root / "results/edited/campaign.yaml"
        stored.write_text(re.sub(r"below: 0?1?\.?0*1?e-0?9|below: 1e-09|below: 1\.0e-9", "below: 1", stored.read_text()))
        self.assertEqual(dispersa("report", self.root / "results/edited", "--no-histories", "--quiet").returncode, 7)
        # In a folder of its own: the same cases were flown under the first.
        self.assertEqual(self.fly(self.campaign(MET), "elsewhere"), 7)
        # With flights that nobody saw it is evidence.
        self.assertEqual(self.fly(self.campaign(MET), "new", "--seed", "77"), 0)

    def test_words_and_order_are_no_change(self):
        other = "{metric: yaw_error_peak_deg, below: 5, probability: 0.8, consumer_risk: 0.10}"
        self.assertEqual(self.fly(self.campaign(MET, other), "out"), 0)
        worded = other.replace("}", ", id: REQ-2, rationale: the fairing, source: spec 4.2}")
        self.assertEqual(self.fly(self.campaign(worded, MET), "out", "--resume"), 0)
        summary = json.loads((self.root / "results/out/summary.json").read_text())
        self.assertEqual([summary["requirements"][0][key] for key in ("id", "rationale", "source")],
                         ["REQ-2", "the fairing", "spec 4.2"])
        self.assertAlmostEqual(summary["requirements"][0]["attained_risk"], 0.8 ** 12)
        self.assertIn("REQ-2", self.page("out"))
        self.assertIn("the fairing", self.page("out"))
        self.assertIn("vehicle slv4 (slv4.yaml)", self.page("out"))
        suite, _ = self.junit("out")
        self.assertTrue(suite.find("testcase").get("name").startswith("REQ-2: yaw_error_peak_deg below 5"))
        self.assertEqual(dispersa("report", self.root / "results/out", "--no-histories", "--quiet").returncode, 0)

    def test_nothing_required(self):
        vehicle = self.root / "unlimited.yaml"
        vehicle.write_text(re.sub(r"(?m)^limits:.*\n(?:  .*\n)*", "", (CAMPAIGNS / "vehicles/slv4.yaml").read_text()))
        nothing = self.campaign()
        nothing.write_text(re.sub(r"vehicle: .*", f"vehicle: {vehicle}", nothing.read_text()))
        self.assertEqual(self.fly(nothing, "out"), 0)
        self.assertEqual(self.execution("out")["standing_verdict"], "nothing_judged")
        self.assertIn('<span class="badge nothing-judged">⊘ nothing judged</span>', self.page("out"))
        self.assertEqual(self.fly(nothing, "out", "--resume", "--gate"), 7)
        self.assertEqual(dispersa("report", self.root / "results/out", "--no-histories", "--quiet", "--gate").returncode, 7)
        self.assertEqual(self.junit("out")[1], [0, 0, 1])

    def test_a_study(self):
        study = "{method: sobol, cases: 16, seed: 3}"
        every, broken = (one.replace("probability: 0.8, consumer_risk: 0.10", "every_case: true") for one in (MET, BROKEN))
        self.assertEqual(self.fly(self.campaign(every, sampling=study), "met"), 0)
        self.assertEqual(self.junit("met")[1][:2], [0, 0])
        self.assertEqual(json.loads((self.root / "results/met/summary.json").read_text())["verdict"], "study")
        self.assertEqual(self.fly(self.campaign(broken, sampling=study.replace("3", "4")), "broken"), 3)
        self.assertEqual(self.fly(self.campaign(MET, sampling=study.replace("3", "5")), "share"), 7)
        self.assertEqual(self.junit("share")[1][1], 1)
        self.assertEqual(self.fly(self.campaign(BROKEN, sampling=study.replace("3", "6")), "both"), 3)

    def test_seeds_until_one_passes(self):
        # Half of the flights meet it: 12 flights without a failure are luck.
        self.assertEqual(self.fly(self.campaign(BROKEN), "first"), 3)
        before = self.fly(self.campaign(BROKEN), "first again")
        self.assertEqual(before, 3)
        self.assertEqual(len(self.execution("first again")["attempts"]), 1, "the same campaign is the same attempt")
        self.assertEqual(self.fly(self.campaign(BROKEN), "second", "--seed", "2"), 3)
        attempts = self.execution("second")["attempts"]
        self.assertEqual([(one["seed"], one["cases"], one["verdict"]) for one in attempts],
                         [(20260101, 12, "fail"), (2, 12, "fail")])
        self.assertIn("Attempt 2 at this design. Earlier ones here: seed 20260101, 12 flights: fail.", self.page("second"))
        # Another limit has no history with another seed; the same one with fewer cases has.
        self.assertEqual(self.fly(self.campaign(MET), "other limit", "--seed", "3"), 0)
        self.assertEqual(self.fly(self.campaign(MET), "too few", "--seed", "4", "--cases", "3"), 4)
        ledger = (self.root / "results/dispersa-attempts.jsonl").read_text().splitlines()
        self.assertEqual({json.loads(line)["seed"] for line in ledger}, {20260101, 2, 3, 4})

    def test_the_smallest_number_of_cases_that_passes(self):
        # A limit that some flights break: the first 40 decide nothing or fail, and some first n of them pass alone.
        flown = self.fly(self.campaign(MET), "scout", "--cases", "40", "--seed", "9")
        self.assertEqual(flown, 0)
        with open(self.root / "results/scout/cases.csv", encoding="utf-8") as stream:
            header = stream.readline().strip().split(",")
            column = header.index("metric_pitch_error_peak_deg")
            peaks = [float(line.split(",")[column]) for line in stream]
        # Above all of the first 11 and below a quarter of the others.
        limit = max(peaks[:11]) * (1 + 1e-9)
        if sum(peak >= limit for peak in peaks) == 0:
            self.skipTest("no flight is above the first eleven")
        shutil.rmtree(self.root / "results")
        tight = MET.replace("below: 1,", f"below: {limit!r},").replace("0.8", "0.82")
        self.assertIn(self.fly(self.campaign(tight), "all", "--cases", "40", "--seed", "9"), (0, 3, 4))
        stood = self.execution("all")["standing_verdict"]
        fewer = self.fly(self.campaign(tight.replace("0.82", "0.82")), "fewer", "--cases", "12", "--seed", "9")
        self.assertEqual(fewer == 0, stood == "pass")

    def test_a_reason_to_start_anew(self):
        self.assertEqual(self.fly(self.campaign(MET, BROKEN), "first"), 3)
        reason = "the actuator was measured again"
        self.assertEqual(self.fly(self.campaign(MET), "fresh", "--fresh", reason), 0)
        self.assertIn(reason, self.page("fresh"))
        self.assertIn("seed 20260101, 12 flights: fail", self.page("fresh"))
        suite, _ = self.junit("fresh")
        told = suite.find("system-out").text
        self.assertIn(reason, told)
        self.assertIn("fail", told)

    def test_bytes_depend_on_the_campaign_alone(self):
        self.assertEqual(self.fly(self.campaign(MET), "first", "--seed", "5"), 0)
        self.assertIn(self.fly(self.campaign(MET), "late"), (0, 7))
        shutil.move(self.root / "results", self.root / "elsewhere")
        self.assertEqual(self.fly(self.campaign(MET), "alone"), 0)
        late, alone = self.root / "elsewhere/late", self.root / "results/alone"
        for name in ("cases.csv", "summary.json"):
            self.assertEqual((late / name).read_bytes(), (alone / name).read_bytes(), name)
        pages = [RUN.sub(b"", (folder / "report.html").read_bytes()) for folder in (late, alone)]
        self.assertEqual(*pages)
        self.assertIn("Earlier designs in this folder, of any vehicle: 1, of which 0 with this seed.", self.page_of_another_design())
        # A folder that was extended has the summary of one flown at once.
        self.fly(self.campaign(MET), "extended", "--seed", "6", "--cases", "4")
        self.fly(self.campaign(MET), "extended", "--seed", "6", "--resume")
        shutil.move(self.root / "results", self.root / "again")
        self.fly(self.campaign(MET), "at once", "--seed", "6")
        for name in ("cases.csv", "summary.json"):
            self.assertEqual((self.root / "again/extended" / name).read_bytes(),
                             (self.root / "results/at once" / name).read_bytes(), name)

    def page_of_another_design(self):
        other = self.campaign(MET)
        other.write_text(other.read_text().replace("three_sigma_percent: 6.7", "three_sigma_percent: 6.8"))
        self.fly(other, "other", "--seed", "8")
        return self.page("other")


if __name__ == "__main__":
    unittest.main()
