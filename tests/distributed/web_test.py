"""dispersa watch --web: it opens the campaign's page in the coordinator's web application, whose histograms are of the cases that
were flown, for those who come late and after a coordinator's death too.

Environment as of processes.py. tests/browser/application_test.py looks at the page itself.
"""
import csv
import io
import json
import math
import os
import re
import subprocess
import urllib.request

from processes import BINARIES, CAMPAIGN, PATIENCE_S, SMOKE, main, stored, wait_for
from service_case import ServiceCase

CASES = 60
LONG = 100000  # more than is flown while a test looks
PORT = 15633


def bars(part):
    """{title of the metric: [(low, high, count)]} of the figures, with the bins' ends as they are: multiples of a power of two."""
    found = {}
    for figure in part.split("<figure")[1:]:
        bins = []
        for low, high, count in re.findall(r"<title>(\S+) to (\S+): (\S+)</title>", figure):
            width = 2.0 ** round(math.log2(float(high) - float(low)))
            index = round(float(low) / width)
            bins.append((index * width, (index + 1) * width, int(count)))
        found[re.search(r'aria-label="Histogram of ([^"]*)"', figure).group(1)] = bins
    return found


class WebTest(ServiceCase):
    DOMAIN = "33"
    CASES = CASES

    def start_coordinator(self):
        return self.start("dispersa-coordinator", "--data", self.data, "--web", PORT, *self.DAEMON)

    def launch(self, cases, campaign=CAMPAIGN):
        return self.dispersa("launch", campaign, "--cases", cases).strip()

    def part(self, identity):
        """What of the campaign's page changes; empty while there is none."""
        try:
            with urllib.request.urlopen(f"http://127.0.0.1:{PORT}/campaign/{identity}?part=1", timeout=PATIENCE_S) as answer:
                return answer.read().decode()
        except OSError:
            return ""

    def histograms(self, identity):
        part = self.part(identity)
        begin = part.find('<div class="figures" id="histograms">')
        return part[begin:part.find("</div>", begin)] if begin >= 0 else ""

    def test_it_opens_the_page_and_ends_with_the_campaigns_code(self):
        self.start_coordinator()
        identity = self.launch(CASES)
        browser, seen, error = self.data / "browser", self.data / "seen", self.data / "watch"
        browser.write_text(f'#!/bin/sh\nprintf %s "$1" > {seen}\n')
        browser.chmod(0o755)
        with error.open("w") as file:
            watch = self.start("dispersa", "watch", identity[:12], "--web", stderr=file, env={**os.environ, "BROWSER": str(browser)})
        page = f"http://127.0.0.1:{PORT}/campaign/{identity}"
        wait_for(lambda: seen.exists() and seen.read_text() == page, "the browser")
        self.assertIn(f"watch: {page} on the coordinator's machine\n", error.read_text())
        wait_for(lambda: "There is no worker: the campaign waits" in self.part(identity), "the page")
        self.start_worker()
        self.assertEqual(watch.wait(timeout=PATIENCE_S), self.reference.code)
        wait_for(lambda: "Open the report" in self.part(identity), "the end on the page")
        self.assertEqual(self.histograms(identity), "", "what the report shows better")

    def test_a_coordinator_without_pages_is_no_place_for_it(self):
        super().start_coordinator()
        identity = self.launch(1)
        self.dispersa("watch", identity, "--web", code=2)
        self.assertEqual(self.error, "--web: this coordinator serves no pages, allowed: a coordinator that was started with --web\n")

    def test_a_late_reader_and_a_coordinator_that_was_killed_show_the_same(self):
        coordinator = self.start_coordinator()
        identity = self.launch(LONG, SMOKE)
        worker = self.start_worker()
        wait_for(lambda: self.status(identity)["done"] >= 30, "results")
        worker.kill()
        results = self.data / identity / "results"
        wait_for(lambda: not json.loads(self.dispersa("status", "--json"))["workers"], "the worker's end")
        wait_for(lambda: stored(results) == self.status(identity)["done"], "what came is stored")
        wait_for(lambda: f">0 of {stored(results)}</td>" in self.part(identity), "all that was flown")
        before = self.histograms(identity)
        figures = bars(before)
        done = self.dispersa("status", identity, "--json")
        coordinator.kill()
        coordinator.wait()
        self.start_coordinator()
        # From the disk, in another order than they came: the same bins.
        wait_for(lambda: self.histograms(identity) == before, "the same histograms")
        self.dispersa("cancel", identity)
        rows = self.rows_of(identity)
        self.assertEqual(len(rows), json.loads(done)["campaigns"][0]["done"])
        for title, metric in (("Pitch error, peak", "pitch_error_peak_deg"), ("Deflection, peak", "deflection_peak_deg")):
            values = [float(row["metric_" + metric]) for row in rows if row["outcome"] == "completed"]
            self.assertEqual(sum(count for _, _, count in figures[title]), len(values), title)
            for low, high, count in figures[title]:
                self.assertEqual(sum(low <= value < high for value in values), count, (title, low, high))

    def rows_of(self, identity):
        wait_for(lambda: self.status(identity)["state"] == "cancelled", "the end")
        rows = subprocess.run([BINARIES / "dispersa", "export", self.fetch(identity), "--format", "csv", "--out", "-"],
                              capture_output=True, text=True, timeout=PATIENCE_S)
        self.assertEqual(rows.returncode, 5, rows.stderr)  # it lacks cases
        return list(csv.DictReader(io.StringIO(rows.stdout)))


if __name__ == "__main__":
    main()
