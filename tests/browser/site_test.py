"""The docs site in a browser, opened from its folder: at any width nothing is cut off, pictures are there, and the
search works.

site_test.py CHROMEDRIVER DISPERSA CAMPAIGN
"""
import pathlib
import subprocess
import tempfile
import time

from browser import DISPERSA, BrowserCase, main

BUILD = pathlib.Path(__file__).resolve().parents[2] / "services" / "docs" / "build.py"
PATIENCE_S = 60
# What reaches beyond the window and does not scroll by itself; pictures that are not there.
STICKS_OUT = """
const width = document.documentElement.clientWidth, found = [];
const scrolls = e => e && e !== document.body && (getComputedStyle(e).overflowX !== "visible" || scrolls(e.parentElement));
for (const image of document.images) if (!image.naturalWidth) found.push(image.src);
if (document.documentElement.scrollWidth > width + 1) found.push("the page");
for (const e of document.querySelectorAll("article *")) {
  const box = e.getBoundingClientRect();
  if (box.width > 0 && box.right > width + 1 && !scrolls(e)) found.push(e.tagName + ": " + e.textContent.slice(0, 60));
}
return found.slice(0, 3);"""
SEARCH = """
const toggle = document.querySelector("[data-md-toggle=search]");
toggle.checked = true;
toggle.dispatchEvent(new Event("change"));
const query = document.querySelector("[data-md-component=search-query]");
query.focus();
query.value = arguments[0];
query.dispatchEvent(new Event("keyup"));"""
FOUND = "return [...document.querySelectorAll('.md-search-result__link')].map(link => link.href)"


class SiteInABrowser(BrowserCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.site = pathlib.Path(tempfile.mkdtemp(dir=cls.temporary.name)) / "docs"
        subprocess.run(["/usr/bin/python3", "-B", BUILD, "--programs", pathlib.Path(DISPERSA).parent, "--out", cls.site],
                       check=True, timeout=280)

    def open(self, page):
        self.browser.open((self.site / page).as_uri())

    def test_nothing_sticks_out(self):
        for width in (1200, 500):
            self.browser.devtools("Emulation.setDeviceMetricsOverride", width=width, height=1000, deviceScaleFactor=1, mobile=False)
            for page in sorted(self.site.rglob("*.html")):
                self.open(page)
                self.assertEqual(self.browser.run(STICKS_OUT), [], f"{page.relative_to(self.site)} at {width} px")

    def test_the_search_finds_from_a_folder(self):
        for page in ("index.html", "core/control/index.html"):
            self.open(page)
            time.sleep(2)  # before the theme has its index, it may miss the words and never look again
            self.browser.run(SEARCH, "quarantined")
            found, end = [], time.monotonic() + PATIENCE_S
            while not found and time.monotonic() < end:
                time.sleep(0.1)
                found = self.browser.run(FOUND)
            self.assertTrue(found)
            for link in found:
                self.assertTrue(link.startswith(self.site.as_uri()), link)


if __name__ == "__main__":
    main()
