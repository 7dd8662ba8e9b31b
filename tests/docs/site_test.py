"""The docs site: every page is there, every link and anchor has a target, nothing is loaded from elsewhere, and every key,
metric, exit code and limit can be looked up.
"""
import html.parser
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest
import urllib.parse

BINARIES = pathlib.Path(os.environ["DISPERSA_BINARIES"])
SERVICES = pathlib.Path(__file__).resolve().parents[2] / "services"
BUILD = SERVICES / "docs" / "build.py"
PAGES = ["index", "first-campaign", "your-vehicle", "your-control-law", "reading-the-report", "cluster", "commands",
         "exit-codes", "glossary", "schemas", "input-files", "metrics", "limits", "anti-features", "words", "floating-point",
         "dependencies", "testing", "unreleased", "core/index", "core/campaign_yaml/index", "core/statistics/index", "services/python/index",
         "services/python/tutorial/tutorial", "services/python/reference"]
# What a page makes a browser load.
LOADS = {("script", "src"), ("img", "src"), ("link", "href"), ("iframe", "src"), ("source", "src"), ("video", "src"),
         ("audio", "src"), ("object", "data"), ("use", "href")}


class Page(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.links, self.loads, self.anchors, self.words, self.rows = [], [], set(), [], []
        self.codes, self.inside = set(), set()
        self.feed(text)

    def handle_data(self, data):
        self.words += data.split()
        if "code" in self.inside:
            self.codes.add(data)
        if "td" in self.inside:
            self.rows[-1][-1] += data

    def handle_endtag(self, tag):
        self.inside.discard(tag)

    def handle_starttag(self, tag, attributes):
        self.inside.add(tag)
        if tag == "tr":
            self.rows.append([])
        elif tag == "td":
            self.rows[-1].append("")
        for name, value in attributes:
            if name == "id" or (tag == "a" and name == "name"):
                self.anchors.add(value)
            if tag == "a" and name == "href":
                self.links.append(value)
            if name == "class" and "mermaid" in (value or "").split():  # the theme would load what draws it
                self.loads.append("https://unpkg.com")
            if (tag, name) in LOADS:
                self.loads.append(value)


def problems(site):
    """What is wrong with the links and loads of a folder of pages."""
    pages = {path.resolve(): Page(path.read_text()) for path in site.rglob("*.html")}
    found = []
    for path, page in pages.items():
        where = path.relative_to(site.resolve())
        for load in page.loads:
            target = urllib.parse.urlsplit(load)
            if target.scheme or target.netloc:
                if target.scheme != "data":
                    found.append(f"{where} loads {load}")
            elif not (path.parent / urllib.parse.unquote(target.path)).exists():
                found.append(f"{where} loads {load}, which is missing")
        for link in page.links:
            target = urllib.parse.urlsplit(link)
            if target.scheme or target.netloc:
                continue
            to = (path.parent / urllib.parse.unquote(target.path)).resolve() if target.path else path
            if to.is_dir():
                to = to / "index.html"
            if not to.exists():
                found.append(f"{where} links to {link}, which is missing")
            elif target.fragment and to in pages and urllib.parse.unquote(target.fragment) not in pages[to].anchors:
                found.append(f"{where} links to {link}, which has no such anchor")
    for sheet in site.rglob("*.css"):
        for url in re.findall(r"url\(\s*['\"]?([^)'\"]+)", sheet.read_text()):
            if re.match(r"(https?:)?//", url):
                found.append(f"{sheet.relative_to(site)} loads {url}")
    return found


def schema_keys(schema, found):
    """The names of all keys of a schema, without units."""
    if isinstance(schema, list):
        for part in schema:
            schema_keys(part, found)
    elif isinstance(schema, dict):
        found.update(schema.get("properties", {}))
        for part in schema.values():
            schema_keys(part, found)
    return found


# Rows of the page of limits, and the constants of the sources that they state.
LIMITS = {
    "cases of a campaign": ("core/campaign/campaign_fields.cc", "kMaxCases"),
    "bytes of a Latin hypercube": ("core/campaign/campaign_fields.cc", "kMaxDesignBytes"),
    "dispersions of a Sobol design": ("core/random/sobol.h", "kMaxDimensions"),
    "replicates": ("core/campaign/campaign_fields.cc", "kMaxReplicates"),
    "interim analyses": ("core/campaign/campaign_fields.cc", "kMaxLooks"),
    "attempts that share": ("core/campaign/campaign_fields.cc", "kMaxAttempts"),
    "custom metrics": ("core/flight/own_metrics.h", "kMaxOwnMetrics"),
    "stages of a vehicle": ("core/math/stages.h", "kMaxStages"),
    "boosters": ("core/vehicle/boosters.h", "kMaxBoosters"),
    "nozzles of a stage": ("core/vehicle/nozzle_layout.h", "kListedNozzles"),
    "nozzles of a vehicle": ("core/vehicle/nozzle_layout.h", "kFurtherNozzles"),
    "jettisoned bodies": ("core/vehicle/bodies.h", "kMaxJettisons"),
    "modes that fly": ("core/vehicle/structure_beam.h", "kMostFlownModes"),
    "elements of a beam": ("core/structure/beam_mesh.h", "kMostElements"),
    "corners of a thrust curve": ("core/vehicle/thrust_curve.h", "kThrustCurveCorners"),
    "rows of a mass table": ("core/vehicle/mass_table.cc", "kMost"),
    "seconds of simulated time": ("core/flight/flight_course.h", "kTimeLimit_s"),
    "bytes of an input file": ("core/campaign_yaml/parse_yaml.cc", "kMaxBytes"),
    "keys of a map": ("core/campaign_yaml/parse_yaml.cc", "kMaxKeys"),
    "bytes of a key": ("core/campaign_yaml/parse_yaml.cc", "kMaxKeyBytes"),
    "levels of maps": ("core/campaign_yaml/parse_yaml.cc", "kMaxDepth"),
    "bytes of a plug-in": ("core/campaign_yaml/named_files.cc", "kLargestFileOfBytes"),
    "characters of a result folder": ("core/results/database.cc", "kLongestPath"),
    "slots of a worker": ("services/transport/validity.h", "kMaxSlots"),
    "workers of a coordinator with keys": ("services/transport/doors.h", "kMostWithKeys", "kForWorkers"),
    "workers of a coordinator without keys": ("services/transport/doors.h", "kMost", "kForWorkers"),
    "clients and observers of a coordinator with keys": ("services/transport/doors.h", "kMostWithKeys", "kForOthers"),
    "clients and observers of a coordinator without keys": ("services/transport/doors.h", "kMost", "kForOthers"),
    "cases of a launched campaign": ("services/coordinator/service.h", "kDefaultMaxCases"),
    "labels of a campaign": ("services/coordinator/catalogue.h", "kMaxLabels"),
    "priority": ("services/coordinator/front_desk.cc", "kMostPriority"),
}


def constant(text, name):
    """The value of a constant of a C++ source: a number, or one shifted."""
    value, = re.findall(rf"\b{name} = (?:std::\w+\{{(\d+)\}}|(\d[\de.]*))(?: << (\d+))?[,;]", text)
    return int(float(value[0] or value[1])) << int(value[2] or 0)


class SiteTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="dispersa-site-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.site = cls.folder / "docs"
        of_python = ["--package", os.environ["DISPERSA_PACKAGE"]] if os.environ.get("DISPERSA_PACKAGE") else []
        done = subprocess.run(["/usr/bin/python3", "-B", BUILD, "--programs", BINARIES, "--out", cls.site, *of_python],
                              capture_output=True, text=True, timeout=900)
        assert done.returncode == 0, done.stdout + done.stderr

    def test_the_pages_are_there(self):
        for page in PAGES:
            self.assertTrue((self.site / f"{page}.html").exists(), page)

    def test_links_lead_somewhere_and_nothing_is_loaded_from_elsewhere(self):
        self.assertEqual([], problems(self.site))

    def test_every_command_is_shown(self):
        text = (self.site / "commands.html").read_text()
        for command in ("validate", "init", "schema", "run", "keys", "compare"):
            self.assertIn(f'id="dispersa-{command}"', text)

    def test_the_python_tutorial_is_shown_whole(self):
        shown = "".join(Page((self.site / "services/python/tutorial/tutorial.html").read_text()).words)
        for line in (SERVICES / "python" / "tutorial" / "tutorial.py").read_text().splitlines():
            if not line.startswith("# %%"):
                words = re.sub("`", "", line.lstrip("# ")) if line.startswith("#") else line
                self.assertIn("".join(words.split()), shown)
        self.assertIn("tutorial/tutorial.html", Page((self.site / "services/python/index.html").read_text()).links)

    def test_the_target_is_the_build_folders_docs(self):
        """What README.md names; of a build elsewhere its own."""
        build = SERVICES.parent / "build" if BINARIES.is_relative_to(SERVICES.parent) else BINARIES.parent
        self.assertEqual(os.environ["DISPERSA_DOCS"], str(build / "docs"))
        self.assertIn("`build/docs/index.html`", (SERVICES.parent / "README.md").read_text())

    @unittest.skipUnless(os.environ.get("DISPERSA_PACKAGE"), "no Python package was built")
    def test_the_python_reference_describes_the_package(self):
        page = Page((self.site / "services/python/reference.html").read_text())
        self.assertLessEqual({"dispersa-run", "dispersa-plot-bands", "campaign-fly", "results", "badinput"}, page.anchors)
        self.assertIn("angular accelerations, rad/s²", " ".join(page.words))

    def test_every_page_can_search_without_a_server(self):
        for page in self.site.rglob("*.html"):
            script, = re.findall(r"location.protocol === 'file:' && document.write\('<script src=\"([^\"]*)\">", page.read_text())
            self.assertTrue((page.parent / script).is_file(), page)

    def page(self, name):
        return Page((self.site / f"{name}.html").read_text())

    def test_every_key_is_found(self):
        """The schemas know the keys too, by another way."""
        codes = self.page("input-files").codes
        kinds = sorted((self.site / "schemas").glob("*.json"))
        self.assertEqual(len(kinds), 5)
        stems = {code[:-2] for code in codes if code.endswith("_*")}
        for kind in kinds:
            keys = schema_keys(json.loads(kind.read_text()), set())
            self.assertGreater(len(keys), 10)
            missing = {key for key in keys if key not in codes and not any(key.startswith(f"{stem}_") and key[len(stem) + 1:] in codes for stem in stems)}
            self.assertEqual(missing, set(), kind.name)

    def test_every_metric_is_found(self):
        """The shells' completion knows the metrics too."""
        names = subprocess.run([BINARIES / "dispersa", "completion", "words", "search", "x", "--metric", ""], capture_output=True,
                               text=True, timeout=60, check=True).stdout.split()
        self.assertGreater(len(names), 70)
        wholes = {re.sub(r"_(stage\d|coast)(?=_|$)", "", name) for name in names}
        self.assertEqual(wholes - self.page("metrics").codes, set())

    def test_every_exit_code_is_found(self):
        text = (SERVICES / "program" / "exit_code.h").read_text()
        codes = set(re.findall(r"kExit\w+ = (\d+),", text))
        self.assertIn("130", codes)
        self.assertEqual(codes, {row[0] for row in self.page("exit-codes").rows if row})

    def test_every_limit_is_found_and_true(self):
        rows = [row for row in self.page("limits").rows if len(row) == 2 and row[1].replace(",", "").isdigit()]
        self.assertEqual(len(rows), len(LIMITS))
        for words, (source, *names) in LIMITS.items():
            text = (SERVICES.parent / source).read_text()
            row, = [row for row in rows if row[0].startswith(words)]
            self.assertEqual(int(row[1].replace(",", "")), math.prod(constant(text, name) for name in names), row[0])

    def test_the_least_numbers_of_cases_are_the_binomials(self):
        """By another way than the program's: n grows until the risk is small enough."""
        def needed(probability, risk, failures):
            n = failures + 1
            while sum(math.comb(n, k) * (1 - probability)**k * probability**(n - k) for k in range(failures + 1)) > risk:
                n += 1
            return n

        risks = (0.2, 0.1, 0.05, 0.01)
        rows = [row for row in self.page("input-files").rows if len(row) == 5 and row[0].endswith(" %") and ", " in row[1]]
        self.assertEqual([row[0] for row in rows], ["50 %", "90 %", "95 %", "99 %", "99.73 %", "99.9 %"])
        for row in rows:
            probability = float(row[0][:-2]) / 100
            for risk, cell in zip(risks, row[1:], strict=True):
                self.assertEqual(cell, f"{needed(probability, risk, 0)}, {needed(probability, risk, 1)}", (row[0], risk))

    def test_schemas_can_be_taken(self):
        self.assertTrue((self.site / "schemas" / "campaign.json").exists())


class CheckTest(unittest.TestCase):
    """The check itself can fail."""

    def found(self, body):
        with tempfile.TemporaryDirectory() as name:
            site = pathlib.Path(name)
            (site / "other.html").write_text('<h1 id="here">x</h1>')
            (site / "index.html").write_text(body)
            return problems(site)

    def test_good_links(self):
        self.assertEqual([], self.found('<a href="other.html#here">x</a><a href="https://example.org">y</a>'))

    def test_a_dead_link(self):
        self.assertEqual(["index.html links to gone.html, which is missing"], self.found('<a href="gone.html">x</a>'))

    def test_a_dead_anchor(self):
        self.assertEqual(["index.html links to other.html#there, which has no such anchor"],
                         self.found('<a href="other.html#there">x</a>'))

    def test_a_missing_picture(self):
        self.assertEqual(["index.html loads a.png, which is missing"], self.found('<img src="a.png">'))

    def test_a_foreign_script(self):
        self.assertEqual(["index.html loads https://example.org/x.js"], self.found('<script src="https://example.org/x.js"></script>'))


if __name__ == "__main__":
    unittest.main()
