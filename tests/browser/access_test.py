"""Every kind of page against axe-core (who reads with a keyboard, a screen reader, weak eyes) and html-validate (what the
standard of HTML allows), light and dark. Both are npm packages, which the test installs in a folder of its own.

access_test.py CHROMEDRIVER DISPERSA CAMPAIGN
"""
import json
import pathlib
import subprocess

from browser import CAMPAIGN, DISPERSA, ServiceCase, free_port, main

PACKAGES = ("axe-core@4", "html-validate@9")
TOKEN = "a token of a test"
NETWORK = ["--domain", "31", "--address", "127.0.0.1"]
# Long lines are a page's own affair; what concerns forms of writing only is not asked for.
RULES = {"extends": ["html-validate:standard"], "rules": {"long-title": "off", "no-inline-style": "off", "no-trailing-whitespace": "off"}}
AXE = """return axe.run(document, {resultTypes: ["violations"]}).then(found => found.violations.map(
    one => one.id + ": " + one.help + ": " + one.nodes.slice(0, 3).map(node => node.html.slice(0, 150)).join(" | ")))"""


class Access(ServiceCase):
    network = NETWORK

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.root = pathlib.Path(cls.temporary.name)
        tools = cls.root / "tools"
        subprocess.run(["npm", "install", "--silent", "--no-audit", "--no-fund", "--prefix", tools, *PACKAGES], check=True, timeout=300)
        cls.axe = (tools / "node_modules/axe-core/axe.min.js").read_text(encoding="utf-8")
        cls.validate = [tools / "node_modules/.bin/html-validate", "--formatter", "json", "--config", cls.root / "rules.json"]
        (cls.root / "rules.json").write_text(json.dumps({"root": True, **RULES}))

    def dispersa(self, *arguments):
        return subprocess.run([DISPERSA, *map(str, arguments)], cwd=self.folder, timeout=600, capture_output=True, text=True, check=False)

    def check(self, what, url):
        for scheme in ("light", "dark"):
            self.browser.devtools("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
            self.browser.open(url)
            self.browser.run("document.querySelectorAll('details').forEach(each => { each.open = true; })")
            self.browser.run(self.axe)
            with self.subTest(page=what, scheme=scheme):
                self.assertEqual(self.browser.run(AXE), [])
        file = self.folder / f"{what}.html"
        file.write_text(self.browser.call("GET", "/source") if url.startswith("http") else pathlib.Path(url[7:]).read_text(encoding="utf-8"),
                        encoding="utf-8")
        said = subprocess.run([*self.validate, file], capture_output=True, text=True, timeout=120, check=False).stdout
        found = [f"{one['line']}:{one['column']}: {one['ruleId']}: {one['message']}" for page in json.loads(said or "[]") for one in page["messages"]]
        with self.subTest(page=what):
            self.assertEqual(found[:20], [])

    def test_pages_of_files(self):
        campaigns = pathlib.Path(CAMPAIGN).parent
        for name, cases in (("smoke", 12), ("table3", 300), ("pn_sweep", 9), ("orbit", 20)):
            self.dispersa("run", campaigns / f"{name}.yaml", "--cases", cases, "--workers", 0, "--out", name)
            self.check(name, (self.folder / name / "report.html").as_uri())
        self.dispersa("run", campaigns / "table3.yaml", "--autopilot", campaigns / "autopilots/pid.yaml", "--cases", 300, "--workers", 0,
                      "--out", "pid")
        self.dispersa("compare", "table3", "pid", "--out", "compared")
        self.check("compare", (self.folder / "compared/compare.html").as_uri())

    def test_pages_of_the_application(self):
        port = free_port()
        (self.folder / "token").write_text(TOKEN + "\n")
        (self.folder / "token").chmod(0o600)
        self.start("dispersa-coordinator", "--data", self.folder / "data", "--web", port, "--web-token", self.folder / "token")
        site = f"http://127.0.0.1:{port}"
        done = self.dispersa("launch", CAMPAIGN, "--label", "commit=1a2b3c4", *NETWORK).stdout.strip()
        self.check("login", site + "/")
        self.browser.run("document.querySelector('[name=token]').value = arguments[0]; document.querySelector('.login').submit()", TOKEN)
        self.check("waiting", f"{site}/campaign/{done}")
        self.start("dispersa-worker", "--peer", "127.0.0.1")
        self.dispersa("watch", done, *NETWORK)
        other = self.dispersa("launch", CAMPAIGN, "--seed", 5, "--label", "commit=5d6e7f8", *NETWORK).stdout.strip()
        self.dispersa("watch", other, *NETWORK)
        for what, path in (("list", "/"), ("campaign", f"/campaign/{done}"), ("difference", f"/difference?id={done}&id={other}"),
                           ("trends", "/trend"), ("trend", "/trend?metric=pitch_error_peak_deg")):
            self.check(what, site + path)


if __name__ == "__main__":
    main()
