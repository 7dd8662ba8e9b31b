"""What tests of one coordinator share: its programs as processes, started and ended by the test.

Environment as of processes.py.
"""
import json
import pathlib
import shutil
import subprocess
import tempfile
import unittest

from processes import BINARIES, PATIENCE_S, Run, content, end


class ServiceCase(unittest.TestCase):
    DOMAIN: str  # of the class that tests; no other's
    CASES = 0    # of the reference, a run without workers whose bytes are expected; 0: there is none
    REFERENCE_PROGRAM = "dispersa"
    DAEMON: list = []  # what its daemons are told besides

    @classmethod
    def setUpClass(cls):
        cls.NETWORK = ["--domain", cls.DOMAIN, "--address", "127.0.0.1"]
        cls.root = pathlib.Path(tempfile.mkdtemp(prefix="dispersa-service-"))
        if cls.CASES:
            cls.reference = Run(cls.root / "reference", "--workers", 0, "--cases", cls.CASES,
                                program=cls.REFERENCE_PROGRAM).finish()

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.root)

    def setUp(self):
        self.data = pathlib.Path(tempfile.mkdtemp(dir=self.root, prefix="data-"))
        self.log = self.data.parent / f"{self.data.name}.log"
        self.processes = []

    def tearDown(self):
        end(self.processes)

    def start(self, program, *arguments, **options):
        """With its output in the log, unless the options of Popen say otherwise."""
        with self.log.open("a") as log:
            options = {"stdout": log, "stderr": log, **options}
            self.processes.append(subprocess.Popen([BINARIES / program, *map(str, arguments), *self.NETWORK], **options))
        return self.processes[-1]

    def start_coordinator(self):
        return self.start("dispersa-coordinator", "--data", self.data, *self.DAEMON)

    def start_worker(self, *arguments, **options):
        return self.start("dispersa-worker", *self.DAEMON, *arguments, **options)

    def dispersa(self, *arguments, code=0):
        """Runs a client command; its standard output."""
        done = subprocess.run([BINARIES / "dispersa", *map(str, arguments), *self.NETWORK], capture_output=True, text=True,
                              timeout=3 * PATIENCE_S)
        self.assertEqual(done.returncode, code, f"{arguments}: {done.stdout}{done.stderr}\n{self.log.read_text()[-3000:]}")
        self.error = done.stderr
        return done.stdout

    def status(self, identity):
        return json.loads(self.dispersa("status", identity, "--json"))["campaigns"][0]

    def fetch(self, identity):
        out = pathlib.Path(tempfile.mkdtemp(dir=self.root))
        self.assertEqual(self.dispersa("fetch", identity, "--out", out), f"result: {out}\n")
        return out

    def assert_same_folder(self, identity, reference):
        out = self.fetch(identity)
        for name in ("cases.csv", "summary.json", "report.html", "campaign.yaml"):
            self.assertEqual(content(out, name), content(reference.out, name), name)
        self.assertEqual(sorted(p.name for p in (out / "histories").iterdir()),
                         sorted(p.name for p in (reference.out / "histories").iterdir()))
        return out
