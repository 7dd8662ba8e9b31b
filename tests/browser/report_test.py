"""report.html in a browser: pointer, click, zoom and the marking of a case in all charts, and the page without script.

report_test.py CHROMEDRIVER DISPERSA CAMPAIGN
"""

import pathlib
import re
import subprocess

from browser import CAMPAIGN, DISPERSA, BrowserCase, main

CASES = 40


class ReportInABrowser(BrowserCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.folder = pathlib.Path(cls.temporary.name, "result")
        subprocess.run([DISPERSA, "run", CAMPAIGN, "--cases", str(CASES), "--workers", "0", "--out", str(cls.folder),
                        "--quiet"], check=False, timeout=300, stdout=subprocess.DEVNULL)
        cls.page = cls.folder / "report.html"
        with open(cls.folder / "cases.csv", encoding="utf-8") as file:
            names = file.readline().strip().split(",")
            cls.rows = [dict(zip(names, line.strip().split(","))) for line in file]

    def setUp(self):
        self.browser.open(self.page.as_uri())
        self.browser.run("window.copied = []; navigator.clipboard.writeText = async text => { copied.push(text); }; "
                         "window.problems = []; addEventListener('error', e => problems.push(e.message));")

    def tearDown(self):
        self.assertEqual(self.browser.run("return problems"), [])

    def where(self, case, x_metric, y_metric=None):
        """On the screen: the case's place by the values of cases.csv and the axes that the chart states."""
        selector = f'svg[data-mx="{x_metric}"]' + (f'[data-my="{y_metric}"]' if y_metric else "")
        chart = self.browser.run(
            "const s = document.querySelector(arguments[0]); s.scrollIntoView({block: 'center'}); "
            "const m = s.getScreenCTM(); return {x: s.dataset.x, y: s.dataset.y, a: m.a, d: m.d, e: m.e, f: m.f}", selector)

        def at(axis, value):
            low, high, start, end = map(float, axis.split()[:4])
            return start + (end - start) * (value - low) / (high - low)

        x = at(chart["x"], float(self.rows[case]["metric_" + x_metric]))
        if y_metric:
            y = at(chart["y"], float(self.rows[case]["metric_" + y_metric]))
        else:
            y = 0.5 * sum(map(float, chart["y"].split()[2:4]))
        return chart["a"] * x + chart["e"], chart["d"] * y + chart["f"]

    def lonely_case(self, metric):
        """The case with the largest value, as nothing is nearer to its place."""
        return max(range(CASES), key=lambda case: float(self.rows[case]["metric_" + metric]))

    def test_the_pointer_names_the_case_and_its_values(self):
        case = self.lonely_case("apogee_km")
        self.browser.pointer(self.where(case, "perigee_km", "apogee_km"))
        lines = self.browser.run("const t = document.getElementById('tip'); return t.hidden ? '' : t.textContent").split("\n")
        self.assertEqual(lines[0], f"case {case}")
        for line, metric in zip(lines[1:3], ("perigee_km", "apogee_km")):
            value = float(re.search(r": (\S+) km", line).group(1))
            self.assertAlmostEqual(value, float(self.rows[case]["metric_" + metric]), delta=1e-5 * abs(value))
        self.assertEqual(lines[3], f"click copies: dispersa replay . --case {case}")

    def test_a_case_is_marked_in_every_chart_and_table(self):
        case = self.lonely_case("pitch_error_peak_deg")
        self.browser.pointer(self.where(case, "pitch_error_peak_deg"))
        charts, marked = self.browser.run(
            "const c = [...document.querySelectorAll('svg[data-mx]')];"
            "return [c.length, c.filter(s => s.querySelector('.marks path')).length]")
        self.assertGreater(charts, 8)
        self.assertEqual(marked, charts)
        self.assertEqual(
            self.browser.run("return [...document.querySelectorAll('tr.hit code[data-case]')].map(c => c.dataset.case)"
                             ".every(c => +c === arguments[0])", case), True)
        self.assertGreater(self.browser.run("return document.querySelectorAll('tr.hit').length"), 0)
        # Its time history is the thick one.
        strong = self.browser.run("return [...document.querySelectorAll('path.strong')].map(p => +p.dataset.case)")
        self.assertEqual(set(strong), {case})
        # Where it is marked is where its value lies.
        x, _ = self.where(case, "perigee_km", "apogee_km")
        self.browser.run("document.getElementById('find').value = arguments[0]; "
                         "document.getElementById('find').dispatchEvent(new Event('input'))", case)
        shown = self.browser.run("const r = document.querySelector('svg[data-mx=perigee_km] .hit').getBoundingClientRect();"
                                 "return r.x + r.width / 2")
        self.assertAlmostEqual(shown, x, delta=1.0)

    def test_a_click_copies_the_command_and_keeps_the_mark(self):
        case = self.lonely_case("apogee_km")
        x, y = self.where(case, "perigee_km", "apogee_km")
        self.browser.pointer((x, y), "down", "up")
        self.assertEqual(self.browser.run("return copied"), [f"dispersa replay . --case {case}"])
        self.assertIn("copied", self.browser.run("return document.getElementById('tip').textContent"))
        self.browser.pointer((5, 5))
        self.assertGreater(self.browser.run("return document.querySelectorAll('.marks path').length"), 8)
        command = self.browser.run("return copied")[0].split()
        again = subprocess.run([DISPERSA] + command[1:], cwd=self.folder, timeout=60, stdout=subprocess.DEVNULL)
        self.assertEqual(again.returncode, 0)

    def test_a_drag_zooms_and_a_double_click_returns(self):
        case = self.lonely_case("apogee_km")
        x, y = self.where(case, "perigee_km", "apogee_km")
        ticks = "return [...document.querySelectorAll('svg[data-mx=perigee_km] .ticks text')].map(t => t.textContent)"
        before = self.browser.run(ticks)
        self.browser.pointer((x - 40, y + 40), "down", (x + 20, y + 5), (x + 30, y - 3), "up")
        inside = self.browser.run(ticks)
        self.assertNotEqual(inside, before)
        self.assertGreater(len(inside), 3)
        view = self.browser.run("const v = document.querySelector('svg[data-mx=perigee_km] .plot').viewBox.baseVal;"
                                "return [v.width, v.height]")
        whole = self.browser.run("const p = document.querySelector('svg[data-mx=perigee_km] .plot');"
                                 "return [+p.getAttribute('width'), +p.getAttribute('height')]")
        self.assertLess(view[0], 0.5 * whole[0])
        # The case answers where the zoom has put it.
        place = self.browser.run(
            "document.getElementById('find').value = arguments[0]; "
            "document.getElementById('find').dispatchEvent(new Event('input'));"
            "const r = document.querySelector('svg[data-mx=perigee_km] .hit').getBoundingClientRect();"
            "return [r.x + r.width / 2, r.y + r.height / 2]", case)
        self.browser.pointer((place[0] + 3, place[1]))
        self.assertTrue(self.browser.run("return document.getElementById('tip').textContent").startswith(f"case {case}\n"))
        self.assertEqual(self.browser.run("return copied"), [])
        self.browser.pointer((place[0], place[1]), "down", "up", "down", "up")
        self.assertEqual(self.browser.run(ticks), before)

    def test_every_width_shows_the_whole_page(self):
        for width in (1400, 800, 500):
            self.browser.devtools("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1,
                                  mobile=False)
            wide = self.browser.run("return document.documentElement.scrollWidth")
            self.assertLessEqual(wide, width, "something sticks out")
            badges = self.browser.run("return [...document.querySelectorAll('.badge')].map(b => b.getBoundingClientRect())"
                                      ".filter(r => r.left < 0 || r.right > innerWidth).length")
            self.assertEqual(badges, 0)
        self.browser.devtools("Emulation.clearDeviceMetricsOverride")

    def test_no_text_of_a_picture_is_cut_or_lies_on_another(self):
        for width in (1400, 420):
            self.browser.devtools("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1,
                                  mobile=False)
            pictures, bad = self.browser.run("""
                const bad = [], shown = [...document.querySelectorAll('svg.chart, svg.map')].filter(s => s.getClientRects().length);
                const beyond = (a, b) => a.left < b.left - 2 || a.right > b.right + 2 || a.top < b.top - 2 || a.bottom > b.bottom + 2;
                const over = (a, b) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > 2 &&
                                       Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 4;
                for (const svg of shown) {
                  const frame = svg.getBoundingClientRect();
                  const texts = [...svg.querySelectorAll('text')].map(t => [t.textContent, t.getBoundingClientRect()]);
                  texts.forEach(([name, at], i) => {
                    if (beyond(at, frame)) bad.push([svg.getAttribute('aria-label'), name, 'cut']);
                    for (const [other, there] of texts.slice(0, i))
                      if (over(at, there)) bad.push([svg.getAttribute('aria-label'), name, other]);
                  });
                }
                return [shown.length, bad]""")
            self.assertGreater(pictures, 20)
            self.assertEqual(bad, [])
        self.browser.devtools("Emulation.clearDeviceMetricsOverride")
        # Beside the first table: the vehicle, the ascent and the least margin; the map has a track and coasts.
        parts = ["svg.vehicle .grain", "svg.chart .line-0", "a[href='#of-pitch_error_peak_deg']"]
        self.assertEqual(self.browser.run("return arguments[0].filter(p => !document.querySelector('.glance ' + p))", parts), [])
        self.assertEqual(self.browser.run("return ['.coast', '.line-1', '.cover', '.place'].filter("
                                          "p => !document.querySelector('svg.map ' + p))"), [])

    def test_it_is_whole_without_script(self):
        text = "return [document.body.innerText, document.querySelectorAll('svg.chart path').length]"
        # What the script adds is taken away again; what is left must be the page as it came.
        scripted = self.browser.run("document.querySelectorAll('.hint, #tip').forEach(e => e.remove()); " + text)
        self.browser.devtools("Emulation.setScriptExecutionDisabled", value=True)
        self.browser.open(self.page.as_uri())
        self.browser.devtools("Emulation.setScriptExecutionDisabled", value=False)
        self.assertEqual(self.browser.run("return document.querySelectorAll('.hint, .marks').length"), 0)
        self.assertEqual(self.browser.run(text), scripted)
        self.browser.run("window.problems = []")

    def test_print_numbers_its_pages_and_shows_no_pointer(self):
        self.browser.run("document.getElementById('find').value = 1; "
                         "document.getElementById('find').dispatchEvent(new Event('input'))")
        self.browser.devtools("Emulation.setEmulatedMedia", media="print")
        shown = self.browser.run("return ['.hint', '#tip', '.marks', 'nav'].map(s => "
                                 "getComputedStyle(document.querySelector(s)).display)")
        self.browser.devtools("Emulation.setEmulatedMedia", media="")
        self.assertEqual(shown, ["none"] * 4)
        pdf = self.browser.devtools("Page.printToPDF", preferCSSPageSize=True)["data"]
        self.assertGreater(len(pdf), 50000)


if __name__ == "__main__":
    main()
