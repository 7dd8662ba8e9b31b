"""dispersa watch --web over HTTP: the data of the page, who gets them, and the effect of a coordinator's death.

Environment as of processes.py. tests/browser/watch_test.py looks at the page itself.
"""
import csv
import http.client
import json
import math
import pathlib
import re
import signal
import socket
import subprocess
import threading

from processes import CAMPAIGN, PATIENCE_S, main, stored, wait_for
from service_case import ServiceCase

CASES = 60
LONG = 100000  # more than is flown while a test looks
VIEWERS = 32   # as many as a watch serves


class Viewer:
    """A browser as far as the server sees it: gets the events and keeps what the page shows."""

    def __init__(self, port):
        self.parts, self.events, self.connected = {}, [], False
        self.connection = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE_S)
        self.connection.request("GET", "/events")
        self.socket = self.connection.sock  # which the connection forgets: each has one answer
        self.answer = self.connection.getresponse()
        if self.answer.status == 200:
            self.connected = True
            self.thread = threading.Thread(target=self.read, daemon=True)
            self.thread.start()
        else:
            self.close()

    def read(self):
        kind = None
        try:
            for line in self.answer:
                name, _, value = line.decode().rstrip("\n").partition(": ")
                if name == "event":
                    kind = value
                elif kind == "show" and name == "data":
                    self.parts.update(json.loads(value))
                elif not line.strip():
                    self.events.append(kind)
        except (OSError, ValueError, http.client.HTTPException):
            pass  # cut off
        self.connected = False
        self.close()

    def go_away(self):
        self.socket.shutdown(socket.SHUT_RDWR)
        self.thread.join(timeout=PATIENCE_S)

    def close(self):
        self.answer.close()
        self.connection.close()


def text(html):
    return re.sub(r"\s+", " ", re.sub("<[^>]*>", " ", html)).strip()


def bars(histograms):
    """{title of the metric: [(low, high, count)]} of the figures, with the bins' ends as they are: multiples of a power of two."""
    found = {}
    for figure in histograms.split("<figure>")[1:]:
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

    def watch(self, identity, *arguments):
        """A watch with a page; its port is self.port."""
        error = self.data / f"watch{len(self.processes)}"
        with error.open("w") as file:
            watch = self.start("dispersa", "watch", identity, "--web", *arguments, stderr=file)
        wait_for(lambda: "\n" in error.read_text() or watch.poll() is not None, "the page's address")
        self.port = int(re.match(r"watch: http://127\.0\.0\.1:(\d+)/\n", error.read_text()).group(1))
        return watch

    def get(self, path="/", method="GET", **headers):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE_S)
        connection.request(method, path, headers=headers)
        answer = connection.getresponse()
        answer.text = answer.read().decode() if answer.status != 200 or path == "/" else ""
        connection.close()
        return answer

    def viewer(self):
        viewer = Viewer(self.port)
        self.assertTrue(viewer.connected)
        wait_for(lambda: viewer.parts, "the first event")
        return viewer

    def assert_histograms(self, viewer, rows):
        """Those that are shown are of these cases."""
        figures = bars(viewer.parts["histograms"])
        completed = [row for row in rows if row["outcome"] == "completed"]
        for title, metric in (("Pitch error, peak", "pitch_error_peak_deg"), ("Deflection, peak", "deflection_peak_deg")):
            values = [float(row["metric_" + metric]) for row in completed]
            self.assertEqual(sum(count for _, _, count in figures[title]), len(values), title)
            for low, high, count in figures[title]:
                self.assertEqual(sum(low <= value < high for value in values), count, (title, low, high))

    def test_it_fills_for_every_browser_and_ends_with_the_campaigns_code(self):
        self.start_coordinator()
        identity = self.dispersa("launch", CAMPAIGN, "--cases", CASES).strip()
        watch = self.watch(identity[:12])
        viewers = [self.viewer() for _ in range(3)]
        wait_for(lambda: "histograms" in viewers[0].parts, "the first tally")
        self.assertIn("The campaign waits for", text(viewers[0].parts["progress"]))
        self.assertEqual(viewers[0].parts["workers"], "<p>There is no worker.</p>\n")
        viewers[2].go_away()
        self.start_worker()
        wait_for(lambda: watch.poll() is not None, "the end of the watch")
        self.assertEqual(watch.returncode, self.reference.code)
        wait_for(lambda: not any(viewer.connected for viewer in viewers[:2]), "the end of the page")

        summary = json.loads((self.reference.out / "summary.json").read_text())
        with (self.reference.out / "cases.csv").open(newline="") as file:
            rows = list(csv.DictReader(file))
        for viewer in viewers[:2]:
            self.assertEqual(viewer.events[-1], "end")
            self.assertEqual(viewer.parts["title"], f"smoke done {CASES}/{CASES} – dispersa")
            self.assertIn(f"done Exit code {self.reference.code}:", text(viewer.parts["progress"]))
            requirement = summary["requirements"][0]
            self.assertIn("Pitch error, peak below 1 ° for 80 % of flights, consumer risk 10 % pitch_error_peak_deg "
                          f"{requirement['failures']} of {CASES} fail pitch_error_peak_deg (",
                          text(viewer.parts["requirements"]))
            self.assert_histograms(viewer, rows)

    def test_a_late_watch_and_a_coordinator_that_was_killed_show_the_same(self):
        coordinator = self.start_coordinator()
        identity = self.dispersa("launch", CAMPAIGN, "--cases", LONG).strip()
        worker = self.start_worker()
        wait_for(lambda: self.status(identity)["done"] >= 30, "results")
        worker.kill()
        results = self.data / identity / "results"
        wait_for(lambda: not json.loads(self.dispersa("status", "--json"))["workers"], "the worker's end")
        wait_for(lambda: stored(results) == self.status(identity)["done"], "what came is stored")
        done = stored(results)

        watch = self.watch(identity)
        viewer = self.viewer()
        wait_for(lambda: f" of {done} fail " in viewer.parts.get("requirements", ""), "all that was flown before")
        before = dict(viewer.parts)

        coordinator.kill()
        wait_for(lambda: re.fullmatch(r"no coordinator has answered at 127\.0\.0\.1:15655 for \d+ s; this page shows the state before\. watch tries again\.",
                                      viewer.parts["notice"]), "the notice")
        self.assertEqual(viewer.parts["histograms"], before["histograms"], "what was known stays")
        self.start_coordinator()
        wait_for(lambda: viewer.parts["notice"] == "" and "flying" in viewer.parts["progress"], "the coordinator's return")
        # From the disk, in another order than they came: the same bins. For who has watched on and for who comes now.
        again = self.watch(identity)
        for other in (viewer, self.viewer()):
            wait_for(lambda: all(other.parts.get(part) == before[part] for part in ("requirements", "histograms")), "the same tally")
        self.dispersa("cancel", identity)
        self.assertEqual([each.wait(timeout=PATIENCE_S) for each in (watch, again)], [5, 5])
        wait_for(lambda: not viewer.connected, "the end of the page")
        self.assertIn("cancelled Exit code 5: incomplete.", text(viewer.parts["progress"]))

    def test_it_is_for_this_machine_alone(self):
        self.start_coordinator()
        identity = self.dispersa("launch", CAMPAIGN).strip()
        watch = self.watch(identity)
        page = self.get()
        self.assertEqual(page.status, 200)
        self.assertRegex(page.headers["Content-Security-Policy"],
                         "^default-src 'none'; style-src 'sha256-[A-Za-z0-9+/]{43}='; script-src 'sha256-[A-Za-z0-9+/]{43}='; "
                         "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'$")
        self.assertNotRegex(page.text, "https?:|//[a-z]+\\.|src=|<link|@import|url\\(")
        for host in ("localhost", "localhost:9000", "127.0.0.1"):
            self.assertEqual(self.get(Host=host).status, 200, host)
        for host in ("rebound.example", f"rebound.example:{self.port}", "127.0.0.1.example", "", "localhost@x"):
            for path in ("/", "/events"):
                refused = self.get(path, Host=host)
                self.assertEqual((refused.status, refused.text), (403, "This page is at 127.0.0.1 and localhost only.\n"), host)
        self.assertEqual(self.get("/", "POST").status, 404)
        self.assertEqual(self.get("/../etc/passwd").status, 404)
        # Elsewhere nobody listens, and nobody else gets the port.
        listening = {line.split()[1] for line in pathlib.Path("/proc/net/tcp").read_text().splitlines()[1:] if line.split()[3] == "0A"}
        self.assertIn(f"0100007F:{self.port:04X}", listening)
        self.assertNotIn(f"00000000:{self.port:04X}", listening)
        taken = self.start("dispersa", "watch", identity, "--web", "--port", self.port, stderr=subprocess.PIPE, text=True)
        self.assertEqual(taken.communicate(timeout=PATIENCE_S)[1], f"--port: port {self.port} of 127.0.0.1: Address already in use\n")
        self.assertEqual(taken.returncode, 2)
        # Interrupted, it lets go.
        viewer = self.viewer()
        watch.send_signal(signal.SIGINT)
        self.assertEqual(watch.wait(timeout=PATIENCE_S), 130)
        wait_for(lambda: not viewer.connected, "the end of the page")
        self.assertNotIn("end", viewer.events)
        self.watch(identity, "--port", self.port)

    def test_so_many_browsers_and_no_more(self):
        self.start_coordinator()
        identity = self.dispersa("launch", CAMPAIGN).strip()
        self.watch(identity)
        viewers = [self.viewer() for _ in range(VIEWERS)]
        self.assertEqual(self.get("/events").status, 503)
        self.assertEqual(self.get().status, 200)
        for viewer in viewers[:2]:
            viewer.go_away()
        wait_for(lambda: Viewer(self.port).connected, "the place of one that went away")


if __name__ == "__main__":
    main()
