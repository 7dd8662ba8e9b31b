"""The web application of a coordinator over HTTP: a campaign while it flies and after, and who may not read it.

Environment as of processes.py.
"""
import json
import pathlib
import re
import subprocess
import unittest
import urllib.error
import urllib.request

from processes import BINARIES, CAMPAIGN, PATIENCE_S, Run, main, wait_for
from service_case import ServiceCase

PORT = 9475


class ApplicationTest(ServiceCase):
    DOMAIN = "33"

    def page(self, path, **headers):
        try:
            request = urllib.request.Request(f"http://127.0.0.1:{PORT}{path}", headers=headers)
            with urllib.request.urlopen(request, timeout=PATIENCE_S) as answer:
                return answer.read().decode()
        except urllib.error.HTTPError as error:
            return f"{error.code}"

    def test_a_campaign_is_seen_while_it_flies_and_after(self):
        reference = Run(self.root / "reference", "--workers", 0, "--cases", 12).finish()
        self.start("dispersa-coordinator", "--data", self.data, "--web", PORT)
        identity = self.dispersa("launch", CAMPAIGN, "--cases", 12, "--label", "commit=1a2b3c4").strip()
        owner = json.loads(self.dispersa("list", "--json"))["campaigns"][0]["owner"]
        wait_for(lambda: identity[:8] in self.page("/"), "the campaign in the list")
        self.assertIn("commit=1a2b3c4", self.page("/?q=" + owner))
        self.assertIn("0 of 1 campaigns", self.page("/?q=nobody-of-this-name"))
        wait_for(lambda: "flying" in self.page(f"/campaign/{identity}?part=1"), "its flight")
        self.assertIn("0 of 12", self.page(f"/campaign/{identity}"))
        self.assertEqual(self.page(f"/campaign/{identity}/report"), "404")
        self.start_worker()
        self.dispersa("watch", identity, code=reference.code)
        wait_for(lambda: "Open the report" in self.page(f"/campaign/{identity[:6]}"), "its report")
        run = re.compile("<!-- run:begin -->.*?<!-- run:end -->", re.S)
        report = (reference.out / "report.html").read_text()
        self.assertEqual(run.sub("", self.page(f"/campaign/{identity}/report")), run.sub("", report))
        verdict = json.loads((reference.out / "execution.json").read_text())["standing_verdict"]
        self.assertIn(f"badge {verdict}", self.page("/"))
        self.assertIn(f"{identity[:8]}", self.page("/trend?metric=pitch_error_peak_deg"))
        for path in (f"/campaign/{identity}/../../state.json", f"/campaign/{identity}/results.sqlite", "/data", "/deleted.jsonl"):
            self.assertEqual(self.page(path), "404", path)
        self.dispersa("delete", identity)
        wait_for(lambda: self.page(f"/campaign/{identity}") == "404", "that it is gone")

    def test_what_is_too_open_is_refused(self):
        token = self.root / "token"
        token.write_text("0123456789abcdef\n")
        token.chmod(0o600)

        def refusal(*arguments):
            done = subprocess.run([BINARIES / "dispersa-coordinator", "--data", self.data, *map(str, arguments), *self.NETWORK],
                                  capture_output=True, text=True, timeout=PATIENCE_S)
            self.assertEqual(done.returncode, 2, done.stderr)
            return done.stderr
        too_open = "--web beyond 127.0.0.1 needs --web-token FILE and --web-behind-tls"
        self.assertIn(too_open, refusal("--web", f"0.0.0.0:{PORT}"))
        self.assertIn(too_open, refusal("--web", f"0.0.0.0:{PORT}", "--web-token", token))
        self.assertIn("--web-behind-tls needs --web-token FILE", refusal("--web", f"0.0.0.0:{PORT}", "--web-behind-tls"))
        self.assertIn("'elsewhere' is no address", refusal("--web", "elsewhere"))
        token.chmod(0o644)
        self.assertIn("other users of this machine can use it", refusal("--web", PORT, "--web-token", token))
        token.chmod(0o600)
        self.start("dispersa-coordinator", "--data", self.data, "--web", f"0.0.0.0:{PORT}", "--web-token", token, "--web-behind-tls")
        over_tls, bearer = {"X-Forwarded-Proto": "https"}, {"Authorization": "Bearer 0123456789abcdef"}

        def answers():
            try:
                return self.page("/", **bearer) == "403"
            except OSError:
                return False
        wait_for(answers, "the refusal of plain HTTP")
        self.assertIn("Campaigns", self.page("/", **bearer, **over_tls))
        self.assertIn("Sign in", self.page("/", **over_tls))


if __name__ == "__main__":
    main()
