"""The web application of a coordinator in a browser: its pages fit at three widths, a campaign's page follows the campaign
without being loaded again, two campaigns are marked and compared.

application_test.py CHROMEDRIVER DISPERSA CAMPAIGN
"""
import subprocess
import time

from browser import CAMPAIGN, DISPERSA, ServiceCase, free_port, main

NETWORK = ["--domain", "30", "--address", "127.0.0.1"]
WIDTHS = (1400, 800, 500)
TOKEN = "a token of a test"


class ApplicationInABrowser(ServiceCase):
    network = NETWORK

    def setUp(self):
        super().setUp()
        self.port = free_port()
        (self.folder / "token").write_text(TOKEN + "\n")
        (self.folder / "token").chmod(0o600)
        self.start("dispersa-coordinator", "--data", self.folder / "data", "--web", self.port, "--web-token", self.folder / "token")

    def dispersa(self, *arguments):
        return subprocess.run([DISPERSA, *map(str, arguments), *NETWORK], timeout=self.patience_s, capture_output=True,
                              text=True).stdout.strip()

    def open(self, path):
        self.browser.open(f"http://127.0.0.1:{self.port}{path}")

    def assert_fits(self, path):
        for width in WIDTHS:
            with self.subTest(path=path, width=width):
                self.browser.devtools("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=False)
                self.open(path)
                wide, shown = self.browser.run("return [document.documentElement.scrollWidth, window.innerWidth]")
                self.assertLessEqual(wide, shown)
        self.browser.devtools("Emulation.clearDeviceMetricsOverride")

    def test_a_campaign_from_its_launch_to_a_trend(self):
        first = self.dispersa("launch", CAMPAIGN, "--cases", 400, "--label", "commit=1a2b3c4")
        time.sleep(1)  # the pages know it in less
        self.open(f"/campaign/{first}")
        self.assertIn("The token is in the file", self.text())
        self.browser.run("document.querySelector('[name=token]').value = arguments[0]; document.querySelector('.login').submit()", TOKEN)
        self.wait_for(lambda: "0 of 400" in self.text(), "the page that was asked for")
        self.browser.run("window.stays = true")
        self.assert_fits(f"/campaign/{first}")
        self.open(f"/campaign/{first}")
        self.browser.run("window.stays = true")
        self.start("dispersa-worker", "--peer", "127.0.0.1")
        self.wait_for(lambda: self.browser.run("return document.querySelectorAll('#histograms svg.chart').length") >= 4, "histograms")
        self.wait_for(lambda: "Open the report" in self.text(), "the end of the campaign")
        self.assertTrue(self.browser.run("return window.stays"), "the page was loaded again")
        self.assertIn("commit=1a2b3c4", self.text())
        second = self.dispersa("launch", CAMPAIGN, "--cases", 30, "--seed", 5, "--label", "commit=5d6e7f8")
        self.dispersa("watch", second, "--quiet")
        time.sleep(1.5)  # the pages are a second old at most
        for path in ("/", f"/campaign/{first}", f"/difference?id={first}&id={second}", "/trend",
                     "/trend?metric=pitch_error_peak_deg"):
            self.assert_fits(path)
        # Two are marked, and no third can be.
        self.open("/")
        self.assertTrue(self.browser.run("return document.querySelector('.campaigns button').disabled"))
        self.browser.run("document.querySelectorAll('.campaigns input').forEach(box => box.click())")
        self.browser.run("document.querySelector('.campaigns button').click()")
        self.wait_for(lambda: "Difference of two campaigns" in self.text(), "the difference")
        self.assertIn("sampling.seed", self.text())
        # The report works in its sandbox.
        self.open(f"/campaign/{first}/report")
        self.assertIn("Dispersion campaign smoke", self.text())
        self.assertGreater(self.browser.run("return document.querySelectorAll('svg.chart').length"), 3)
        self.open("/trend?metric=pitch_error_peak_deg")
        self.assertEqual(self.browser.run("return document.querySelectorAll('svg.trend circle').length"), 4)  # two charts
        self.assertIn("5d6e7f8", self.text())


if __name__ == "__main__":
    main()
