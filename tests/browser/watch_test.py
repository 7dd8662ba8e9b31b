"""The page of dispersa watch --web in a browser: at every width and in dark mode it is complete, and it says when
the connection is lost.

watch_test.py CHROMEDRIVER DISPERSA CAMPAIGN
"""
import re
import subprocess
import time

from browser import CAMPAIGN, DISPERSA, ServiceCase, free_port, main

CASES = 200
DOMAIN = "32"
NETWORK = ["--domain", DOMAIN, "--address", "127.0.0.1"]


class WatchInABrowser(ServiceCase):
    network = NETWORK

    def start_coordinator(self):
        return self.start("dispersa-coordinator", "--data", self.folder / "data")

    def launch(self):
        return subprocess.run([DISPERSA, "launch", CAMPAIGN, "--cases", str(CASES), *NETWORK], check=True, timeout=self.patience_s,
                              capture_output=True, text=True).stdout.strip()

    def shown(self, part):
        return self.browser.run("return document.getElementById(arguments[0]).innerText", part)

    def open(self, port):
        # The server may still be on its way.
        self.wait_for(lambda: "watch: " in (self.folder / "log").read_text(), "the page's address")
        self.browser.open(f"http://127.0.0.1:{port}/")

    def test_it_fills_and_fits(self):
        self.start_coordinator()
        port = free_port()
        watch = self.start("dispersa", "watch", self.launch(), "--web", "--port", port)
        self.open(port)
        self.wait_for(lambda: "The campaign waits for workers." in self.shown("progress"), "what it waits for")
        self.assertEqual(self.browser.run("return document.querySelectorAll('#histograms svg').length"), 0)
        self.start("dispersa-worker", "--peer", "127.0.0.1")
        self.wait_for(lambda: watch.poll() is not None, "the end of the watch")
        self.wait_for(lambda: "Exit code" in self.shown("progress"), "the end of the page")
        self.assertIn(f"Exit code {watch.returncode}: ", self.shown("progress"))
        self.assertEqual(self.browser.run("return document.title"), f"smoke done {CASES}/{CASES} – dispersa")
        self.assertRegex(self.shown("requirements"), rf"Pitch error, peak below 1 ° for 80 % of flights[^§]* of {CASES} fail "
                         r"pitch_error_peak_deg \(pass so far\)")
        figures, bars = self.browser.run("return [document.querySelectorAll('#histograms svg.chart').length, "
                                         "document.querySelectorAll('#histograms rect.bar').length]")
        self.assertGreaterEqual(figures, 4)
        self.assertGreater(bars, 5 * figures)
        self.assertRegex(self.shown("histograms"), f"Pitch error, peak: histogram of {CASES} completed flights")
        # It has ended: that nobody is there any more is no loss of the connection.
        time.sleep(1)
        self.assertEqual(self.shown("connection"), "")
        for width in (1400, 800, 500):
            self.browser.devtools("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=False)
            self.assertLessEqual(self.browser.run("return document.documentElement.scrollWidth"), width, "something sticks out")
            outside = self.browser.run("return [...document.querySelectorAll('.badge, .tile, figure, progress')]"
                                       ".map(b => b.getBoundingClientRect()).filter(r => r.left < 0 || r.right > innerWidth).length")
            self.assertEqual(outside, 0)
        self.browser.devtools("Emulation.clearDeviceMetricsOverride")
        paper = "return getComputedStyle(document.body).backgroundColor"
        bright = self.browser.run(paper)
        self.browser.devtools("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark"}])
        self.assertNotEqual(self.browser.run(paper), bright)
        self.browser.devtools("Emulation.setEmulatedMedia", features=[])

    def test_no_script_but_its_own_runs_and_nothing_is_loaded(self):
        self.start_coordinator()
        port = free_port()
        self.start("dispersa", "watch", self.launch(), "--web", "--port", port)
        self.open(port)
        self.wait_for(lambda: self.shown("progress"), "contents")
        self.browser.run("window.refused = []; addEventListener('securitypolicyviolation', e => refused.push(e.effectiveDirective));"
                         "document.body.insertAdjacentHTML('beforeend', '<img src=/x.png onerror=\"window.broken = 1\">"
                         "<p id=styled style=\"color: red\"></p>');"
                         "const s = document.createElement('script'); s.textContent = 'window.broken = 2'; document.body.append(s);"
                         "fetch('http://127.0.0.1:9/').catch(() => {})")
        self.wait_for(lambda: len(self.browser.run("return refused")) >= 4, "the policy")
        self.assertEqual({d.removesuffix("-elem").removesuffix("-attr") for d in self.browser.run("return refused")},
                         {"img-src", "style-src", "script-src", "connect-src"})
        self.assertIsNone(self.browser.run("return window.broken"))
        self.assertNotEqual(self.browser.run("return getComputedStyle(document.getElementById('styled')).color"), "rgb(255, 0, 0)")

    def test_it_says_when_it_is_cut_off_and_goes_on(self):
        coordinator = self.start_coordinator()
        port, identity = free_port(), self.launch()
        watch = self.start("dispersa", "watch", identity, "--web", "--port", port)
        self.open(port)
        self.wait_for(lambda: "The campaign waits for workers." in self.shown("progress"), "contents")
        coordinator.kill()
        coordinator.wait()
        self.wait_for(lambda: re.search("no coordinator has answered at 127.0.0.1:15405 for [0-9]+ s", self.shown("notice")), "the notice")
        self.start_coordinator()
        self.wait_for(lambda: self.shown("notice") == "", "the coordinator's return")
        watch.kill()
        watch.wait()
        self.wait_for(lambda: "The connection to dispersa watch is lost" in self.shown("connection"), "the loss")
        self.assertNotEqual(self.shown("progress"), "", "what was known stays")
        self.start("dispersa", "watch", identity, "--web", "--port", port)
        self.wait_for(lambda: self.shown("connection") == "", "the watch's return")


if __name__ == "__main__":
    main()
