"""What a review board reads: the first page of reports on one screen and one sheet, the printed report, the page of a
comparison, and the data of every chart by keyboard.

board_test.py CHROMEDRIVER DISPERSA CAMPAIGN
"""
import json
import pathlib
import re
import subprocess

from browser import CAMPAIGN, DISPERSA, BrowserCase, main

CAMPAIGNS = pathlib.Path(CAMPAIGN).parent
SCREEN = (1400, 900)
SHEET_PX = (688, 1009)  # A4 within the margins of page.css, at 96 px an inch
LARGEST_BYTES = 1_200_000
MOST_PAGES = 12
SEVEN = """assumptions:
  - The wind profile is that of the worst month, in every flight.
  - The vehicle is rigid.
  - Thrust misalignments of the stages are independent.
requirements:
  - {{id: GNC-001, metric: pitch_error_peak_deg, below: {pitch}, probability: 0.9973, consumer_risk: 0.10,
     rationale: The clearance of the fairing at separation allows half a degree., source: SRD 3.2.1}}
  - {{id: GNC-002, metric: pitch_error_rms_deg, below: 0.05, probability: 0.5, consumer_risk: 0.10}}
  - {{id: GNC-003, metric: deflection_limit_cycle_deg, below: 0.2, probability: 0.9973, consumer_risk: 0.10, source: SRD 3.2.3}}
  - {{id: GNC-004, metric: yaw_error_peak_deg, below: {yaw}, probability: 0.9973, consumer_risk: 0.10, rationale: As pitch.}}
  - {{id: GNC-005, metric: roll_error_peak_deg, below: 1, probability: 0.9973, consumer_risk: 0.10}}
  - {{id: GNC-006, metric: deflection_peak_deg, below: 4, probability: 0.99, consumer_risk: 0.10,
     rationale: Half of the stroke of the nozzle is left for what is not modelled., source: SRD 3.2.6}}
  - {{id: LOADS-01, metric: q_max_pa, below: 120000, probability: 0.9973, consumer_risk: 0.10}}
"""


class BoardInABrowser(BrowserCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.root = pathlib.Path(cls.temporary.name)
        table3 = (CAMPAIGNS / "table3.yaml").read_text(encoding="utf-8")
        head = re.sub(r"(?m)^(vehicle|reference|autopilot): (.*)$", rf"\1: {CAMPAIGNS}/\2", table3.split("requirements:")[0])
        cls.texts = {name: head + SEVEN.format(pitch=pitch, yaw=yaw)
                     for name, pitch, yaw in (("met", 0.5, 1), ("tight", 0.1, 0.1))}
        cls.run_campaign("undecided", cls.texts["met"], 300)
        cls.run_campaign("failed", cls.texts["tight"], 300)
        cls.run_campaign("changed", cls.texts["tight"], 300)
        cls.run_campaign("changed", cls.texts["met"], 300, "--resume")
        other = cls.texts["met"].replace("adaptive_fuzzy", "pd")
        cls.run_campaign("other", other, 300)
        subprocess.run([DISPERSA, "compare", "undecided/r", "other/r", "--out", "compare"], cwd=cls.root, check=True, timeout=300,
                       stdout=subprocess.DEVNULL)

    @classmethod
    def run_campaign(cls, name, text, cases, *options):
        """Each in a folder of its own, as the attempts of a folder are one another's."""
        (cls.root / name).mkdir(exist_ok=True)
        file = cls.root / name / "campaign.yaml"
        file.write_text(text, encoding="utf-8")
        subprocess.run([DISPERSA, "run", str(file), "--cases", str(cases), "--workers", "0", "--out", str(cls.root / name / "r"),
                        "--quiet", *options], check=False, timeout=600, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def show(self, name, width=SCREEN[0], height=SCREEN[1], media=""):
        self.browser.devtools("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)
        self.browser.devtools("Emulation.setEmulatedMedia", media=media)
        page = self.root / name / ("compare.html" if name == "compare" else "r/report.html")
        self.browser.open(page.as_uri())
        self.browser.run("window.copied = []; navigator.clipboard.writeText = async text => { copied.push(text); };")
        return page

    def tearDown(self):
        self.browser.devtools("Emulation.setEmulatedMedia", media="")
        self.browser.devtools("Emulation.clearDeviceMetricsOverride")

    def test_seven_requirements_are_on_the_first_screen(self):
        for name, badge in (("undecided", "inconclusive"), ("failed", "fail"), ("changed", "post hoc")):
            with self.subTest(name):
                self.show(name)
                self.assertIn(badge, self.browser.run("return document.querySelector('.headline .badge').textContent"))
                rows, bottom = self.browser.run(
                    "return [document.querySelectorAll('table.judged tbody tr').length,"
                    " document.querySelector('header').getBoundingClientRect().bottom]")
                self.assertEqual(rows, 7)
                self.assertLessEqual(bottom, SCREEN[1])

    def test_the_first_page_is_one_sheet(self):
        for name in ("undecided", "failed", "changed"):
            with self.subTest(name):
                self.show(name, *SHEET_PX, media="print")
                self.assertLessEqual(self.browser.run("return document.querySelector('header').getBoundingClientRect().height"),
                                     SHEET_PX[1])
                self.assertNotEqual(self.browser.run("return getComputedStyle(document.querySelector('.sign')).display"), "none")

    def test_shared_advice_is_said_once(self):
        self.show("undecided")
        header = self.browser.run("return document.querySelector('header').innerText")
        self.assertEqual(header.count("new campaign needs"), 1)
        self.assertIn("To decide all 5 inconclusive requirements", header)

    def test_the_first_table_answers_in_numbers(self):
        for name in ("undecided", "failed"):
            self.show(name)
            columns = self.browser.run("return [...document.querySelectorAll('table.judged thead th')].map(c => c.innerText)")
            self.assertEqual(columns, ["Verdict", "Requirement", "Failures", "Shown", "Required", "Nominal", "Median", "Worst (case)",
                                       "Bound", "Margin"])
            rows = self.browser.run("return [...document.querySelectorAll('table.judged tbody tr')]"
                                    ".map(r => [...r.children].map(c => c.innerText))")
            for row in rows:
                self.assertRegex(row[2], r"^\d+ of 300$")
                self.assertRegex(row[3], r"^[≥≤] [\d.]+ %$")
                self.assertRegex(row[7], r"^[\d.e-]+ \(\d+\)$")
                for number in (row[5], row[6], row[9]):  # three digits, or two of the distance to the limit
                    self.assertLessEqual(len(re.sub(r"e.*|\D", "", number).strip("0")), 4, row)

    def test_a_title_leads_to_its_chart(self):
        self.show("failed")
        self.assertEqual(self.browser.run(
            "return [...document.querySelectorAll('table.judged a[href^=\"#of-\"]')]"
            ".filter(a => !document.querySelector(a.getAttribute('href'))).map(a => a.innerText)"), [])

    def test_table3_is_at_most_twelve_pages(self):
        self.run_campaign("table3", re.sub(r"(?m)^(vehicle|reference|autopilot): (.*)$", rf"\1: {CAMPAIGNS}/\2",
                                           (CAMPAIGNS / "table3.yaml").read_text(encoding="utf-8")), 5000)
        page = self.show("table3")
        self.assertLessEqual(page.stat().st_size, LARGEST_BYTES)
        self.assertIn("5000 cases", self.browser.run("return document.querySelector('header').innerText"))
        self.assertLessEqual(self.browser.pages_of_print(), MOST_PAGES)

    def test_other_pages_print_on_few_sheets(self):
        for name in ("undecided", "failed", "changed", "compare"):
            with self.subTest(name):
                self.show(name)
                self.assertLessEqual(self.browser.pages_of_print(), MOST_PAGES)

    def test_every_width_shows_the_whole_page(self):
        for name in ("undecided", "changed", "compare"):
            for width in (1400, 800, 500):
                with self.subTest(name=name, width=width):
                    self.show(name, width)
                    self.assertLessEqual(self.browser.run("return document.documentElement.scrollWidth"), width)

    def said(self):
        return self.browser.run("const s = document.getElementById('said'); return s.hidden ? '' : s.textContent")

    def test_the_keyboard_reaches_the_data_of_every_chart(self):
        for name in ("undecided", "compare"):
            self.show(name)
            charts = self.browser.run("return document.querySelectorAll('svg.chart').length")
            self.assertGreater(charts, 8)
            for chart in range(charts):
                with self.subTest(name=name, chart=chart):
                    self.browser.run("const c = document.querySelectorAll('svg.chart')[arguments[0]];"
                                     "c.scrollIntoView({block: 'center'}); c.focus()", chart)
                    self.browser.keys("ArrowRight")
                    first = self.said()
                    self.browser.keys("End")
                    self.assertRegex(first, r"\d")
                    self.assertNotEqual(self.said(), first)
            self.browser.keys("Escape")
            self.assertEqual(self.said(), "")

    def test_the_keyboard_reads_what_is_drawn(self):
        self.show("undecided")
        # Of the exceedance: its last step is the largest value.
        self.browser.run("const c = document.querySelectorAll('svg.chart[data-mx=pitch_error_peak_deg]')[1];"
                         "c.scrollIntoView({block: 'center'}); c.focus()")
        self.browser.keys("ArrowRight", "ArrowDown", "End")
        text = self.said()
        self.assertTrue(text.startswith("cases: share of cases beyond this "), text)
        self.browser.keys("ArrowRight")  # nothing is beyond the last
        self.assertEqual(self.said(), text)
        summary = json.loads((self.root / "undecided/r/summary.json").read_text(encoding="utf-8"))
        largest = summary["metrics"]["pitch_error_peak_deg"]["max"]
        self.assertAlmostEqual(float(re.search(r"at Pitch error, peak, ° ([\d.]+)", text).group(1)), largest, delta=0.01 * largest)

    def test_the_keyboard_names_a_case_and_copies_its_command(self):
        self.show("undecided")
        self.browser.run("const c = document.querySelector('svg.chart[data-mx=perigee_km]');"
                         "c.scrollIntoView({block: 'center'}); c.focus()")
        self.browser.keys("End")
        case = int(re.search(r"\ncase (\d+)", self.said()).group(1))
        self.browser.keys("Enter")
        self.assertEqual(self.browser.run("return copied"), [f"dispersa replay . --case {case}"])
        with open(self.root / "undecided/r/cases.csv", encoding="utf-8") as file:
            at = file.readline().strip().split(",").index("metric_perigee_km")
            perigees = [float(line.split(",")[at]) for line in file]
        self.assertEqual(case, max(range(len(perigees)), key=perigees.__getitem__))

    def test_tab_goes_from_chart_to_chart(self):
        self.show("compare")
        self.browser.run("document.querySelectorAll('svg.chart')[0].focus()")
        self.browser.keys("Tab")
        self.assertTrue(self.browser.run("return document.activeElement === document.querySelectorAll('svg.chart')[1]"))


if __name__ == "__main__":
    main()
