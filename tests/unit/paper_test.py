"""dispersa paper and dispersa compare as a user calls them, on small campaigns.

DISPERSA_BINARIES and DISPERSA_CAMPAIGNS name the folders of the programs and of the campaigns.
"""
import csv
import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

BINARIES = pathlib.Path(os.environ["DISPERSA_BINARIES"])
CAMPAIGNS = pathlib.Path(os.environ["DISPERSA_CAMPAIGNS"])

SECTIONS = ["claims", "table1", "table2", "fig2", "fig3", "table3", "fig5", "fig6", "fig8", "fig10", "baselines", "lyapunov",
            "completions", "campaigns"]
BASELINES = ["frozen_fuzzy", "pd", "pid", "lqr", "pd_aac", "pid_aac"]


def dispersa(*arguments):
    return subprocess.run([BINARIES / "dispersa", *map(str, arguments)], capture_output=True, text=True)


class StudyTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="dispersa-paper-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def small_campaigns(self):
        """The shipped campaigns with 4 choices of P_n instead of 81, 4 corners instead of 16, and a short search."""
        campaigns = self.folder / "campaigns"
        shutil.copytree(CAMPAIGNS, campaigns)

        def change(name, pattern, replacement):
            text, changes = re.subn(pattern, replacement, (campaigns / name).read_text(), flags=re.MULTILINE)
            self.assertGreater(changes, 0, f"{name} has nothing like {pattern}")
            (campaigns / name).write_text(text)

        change("pn_sweep.yaml", r"values_factor: \[.*\]", "values_factor: [1, 30]")
        change("pn_sweep.yaml", r"cases: \d+", "cases: 4")
        for name in ("aero20.yaml", "aero20_quiet.yaml", "aero20_monte_carlo.yaml"):  # the others are based on these
            change(name, r"^  (drag|lift)_coefficient: .*\n", "")
        change("aero20_quiet.yaml", r"cases: \d+", "cases: 4")
        change("aero20_one_at_a_time_quiet.yaml", r"cases: \d+", "cases: 4")
        reference = re.search(r"^reference: (.*)$", (campaigns / "nominal.yaml").read_text(), re.MULTILINE)[1]
        change(reference, r"population: \d+", "population: 10")
        change(reference, r"generations: \d+", "generations: 2")
        return campaigns

    def test_the_page_is_an_index_of_reports_with_every_figure(self):
        out = self.folder / "paper"
        done = dispersa("paper", "--out", out, "--cases", "2", "--threads", "2", "--campaigns", self.small_campaigns(),
                        "--no-histories", "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout, f"page: {out / 'paper.html'}\n")
        page = (out / "paper.html").read_text()
        self.assertEqual(re.findall(r'<h2 id="(\w+)">', page), SECTIONS)
        self.assertIn("The vehicle is rigid.", page)
        # Readable offline, no number that is none, and nothing that another run on another machine would not write.
        text = re.sub(r"<(style|script)>.*?</\1>", "", page, flags=re.DOTALL)
        for never in (r"\b(nan|inf)\b", "http", "src=", str(self.folder)):
            self.assertNotRegex(text, never)
        links = set(re.findall(r'href="([^"#]*)(?:#(\w+))?"', text))
        for file, anchor in links:
            self.assertIn(f'id="{anchor}"' if anchor else "", (out / (file or "paper.html")).read_text(), file)

        # A result folder and a link for each campaign, and a comparison for each other law, on the same cases.
        def rows(name):
            with open(out / name / "cases.csv", newline="") as stream:
                return list(csv.DictReader(stream))

        def draws(name):
            return [[value for column, value in row.items() if column.startswith("input_")] for row in rows(name)]
        folders = sorted(path.parent.name for path in out.glob("*/results.sqlite"))
        self.assertEqual(folders, sorted(file.split("/")[0] for file, anchor in links if file.endswith("report.html") and not anchor))
        self.assertEqual(len(folders), 18)
        self.assertEqual(len(draws("controllers")), 2)
        for law in BASELINES:
            self.assertEqual(draws(f"controllers_{law}"), draws("controllers"))
            self.assertIn((f"controllers_{law}/compare.html", ""), links)

        # A row for each claim, whose verdict follows from what the folders hold.
        rows_of_claims = re.findall(r'<tr>(<th scope="row">.*?)</tr>', text.split("</h2>")[1])
        claims = {re.sub("<.*?>", "", cells[0]): cells[1:]
                  for cells in (re.findall("<t[hd].*?>(.*?)</t[hd]>", row) for row in rows_of_claims)}
        self.assertEqual(list(claims), ["Table 1", "Table 2", "Fig. 2", "Fig. 3", "Table 3", "Fig. 5", "Figs. 6, 7", "Figs. 8, 9",
                                        "Fig. 10", "Other controllers", "Margins", "The Lyapunov function", "Completions"])
        rms = "metric_pitch_error_rms_deg"
        law, pid = (sorted(float(row[rms]) for row in rows(name)) for name in ("controllers", "controllers_pid"))
        self.assertIn(f"A plain PID, tuned by the same procedure and budget under the same margins, has {sum(pid) / sum(law):.2f} of it, "
                      "the smaller one in 2 of 2 cases", claims["Other controllers"][1])  # medians of two are means
        self.assertIn("not reproduced", claims["Other controllers"][3])
        # Of P_n and 30 P_n at least the last loses control, and the Lyapunov equation's own does not.
        sweep = {(float(row["input_pn_error_factor"]), float(row["input_pn_rate_factor"])): row for row in rows("pn_sweep")}
        self.assertEqual((len(sweep), sweep[1, 1]["outcome"], sweep[30, 30]["outcome"]), (4, "completed", "lost_control"))
        lost = sum(row["outcome"] != "completed" for row in sweep.values())
        self.assertIn(f"Of 4 choices {lost} lose the vehicle", claims["Fig. 5"][1])
        self.assertIn(f"the RMS error is {float(sweep[1, 1][rms]):.4f}°", claims["Fig. 5"][1])
        self.assertRegex(page, r'row" class="n">30</th>.*<b class="lost">×</b></td></tr>\n.*row" class="n">1</th>.*framed">')
        self.assertIn("0 lost; median RMS", claims["Figs. 8, 9"][1])
        self.assertIn("✓ reproduced", claims["Figs. 8, 9"][3])
        # A P_n that was refused: one row each, with the answer to it.
        self.assertEqual(page.count("pitch.adaptation.p_n: is not"), 2)
        # The trajectory and the margins beside the page.
        self.assertGreater(len((out / "trajectory.csv").read_text().splitlines()), 300)
        self.assertIn("PASS: every gate is met", (out / "margins.txt").read_text())

    def test_bad_usage_of_paper(self):
        (self.folder / "mine").write_text("")
        full = dispersa("paper", "--out", self.folder)
        self.assertEqual((full.returncode, full.stderr),
                         (2, f"--out: {self.folder} is not an empty folder, allowed: a folder that is empty or new\n"))
        missing = dispersa("paper", "--out", self.folder / "new", "--campaigns", self.folder)
        self.assertEqual(missing.returncode, 2)
        self.assertEqual(missing.stderr, f"{self.folder / 'nominal.yaml'}:1:1: file not found, "
                                         "allowed: a file that exists\n")
        self.assertFalse((self.folder / "new").exists())

    def fly(self, campaign, cases):
        out = self.folder / campaign
        done = dispersa("run", CAMPAIGNS / f"{campaign}.yaml", "--cases", cases, "--workers", "0", "--out", out, "--quiet")
        self.assertIn(done.returncode, (0, 3, 4), done.stderr)
        return out

    def test_compare_pairs_cases_and_writes_its_page(self):
        adaptive = self.fly("controllers", 3)
        pd = self.fly("controllers_pd", 2)
        out = self.folder / "comparison"
        done = dispersa("--json", "compare", adaptive, pd, "--metric", "pitch_error_rms_deg", "--out", out)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual((out / "compare.json").read_text(), done.stdout)
        report = json.loads(done.stdout)
        self.assertEqual(report["schema"], "dispersa/compare/1")
        pairing = report["pairing"]
        self.assertEqual((pairing["paired"], pairing["pairs"], pairing["only_a"], pairing["changed_inputs"]), (True, 2, 1, []))
        self.assertEqual((report["a"]["autopilot"], report["b"]["autopilot"]), ("adaptive_fuzzy", "pd"))
        self.assertIn("autopilot.name", [change["path"] for change in report["changes"]])

        def values(folder):
            with open(folder / "cases.csv", newline="") as stream:
                return [float(row["metric_pitch_error_rms_deg"]) for row in csv.DictReader(stream)]
        differences = [b - a for a, b in zip(values(adaptive), values(pd))]
        metric = report["metrics"][0]
        self.assertEqual(metric["metric"], "pitch_error_rms_deg")
        self.assertAlmostEqual(metric["median"]["difference"], sum(differences) / 2, delta=1e-12)  # of two
        self.assertEqual(metric["pairs"]["a_better"], sum(difference > 0 for difference in differences))
        page = (out / "compare.html").read_text()
        self.assertIn("controllers_pd against controllers", page)
        self.assertNotRegex(page, r'(src|href)="(?!#)')
        self.assertNotIn("http", page)

        text = dispersa("compare", adaptive, pd)
        self.assertEqual(text.returncode, 0, text.stderr)
        self.assertIn("in all of 2 cases shared. 1 case of A and 0 cases of B have no partner", text.stdout)

        # Other draws: two independent samples.
        other = self.fly("smoke", 2)
        unpaired = json.loads(dispersa("--json", "compare", adaptive, other).stdout)
        self.assertEqual((unpaired["pairing"]["paired"], unpaired["metrics"][0]["pairing"]), (False, "unpaired"))
        unknown = dispersa("compare", adaptive, pd, "--metric", "speed")
        self.assertEqual((unknown.returncode, unknown.stderr),
                         (2, "--metric: 'speed' is not a metric, allowed: a name in cases.csv without its prefix 'metric_'\n"))
        for command in (("compare", adaptive, pd), ("search", CAMPAIGNS / "smoke.yaml")):
            slip = dispersa(*command, "--metric", "pitch_error_peek_deg")
            self.assertEqual((slip.returncode, slip.stderr),
                             (2, "--metric: 'pitch_error_peek_deg' is not a metric (did you mean 'pitch_error_peak_deg'?), "
                                 "allowed: a name in cases.csv without its prefix 'metric_'\n"))


if __name__ == "__main__":
    unittest.main()
