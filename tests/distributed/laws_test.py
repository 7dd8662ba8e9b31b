"""A control law from a shared object on a service: its bytes reach the workers, which run it in a contained process.

Environment as of processes.py; DISPERSA_SOURCE: the repository.
"""
import json
import os
import pathlib
import resource
import shutil
import subprocess
import tempfile

from processes import BINARIES, CAMPAIGN, PATIENCE_S, Run, main, stored, wait_for
from service_case import ServiceCase

SOURCE = pathlib.Path(os.environ["DISPERSA_SOURCE"])
CASES = 24
DIFFERS_BY_WORKER = 20
CRASHES_IN_WORKERS = 27
REFUSAL = (r"the control law pd_test is not deterministic: of case \d+, flown (by worker \S+|here before the campaign) and again by \S+, "
           r"metric_\w+ is '\S+' once and '\S+' again")


class LawsTest(ServiceCase):
    DOMAIN = "37"
    DAEMON = ["--allow-plugins"]

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        include = cls.root / "dispersa"
        include.mkdir()
        shutil.copy(SOURCE / "core/control/control_law.h", include)

    def autopilot(self, behaviour):
        """A PD, of which tests/plugins/law.c says what it does besides."""
        library = self.root / f"law{behaviour}.so"
        subprocess.run(["gcc", "-O2", "-fPIC", "-shared", f"-DDISPERSA_MISBEHAVES={behaviour}", f"-I{self.root}",
                        SOURCE / "tests/plugins/law.c", "-lm", "-o", library], check=True, timeout=PATIENCE_S)
        text = (SOURCE / "campaigns/autopilots/pd.yaml").read_text()
        path = self.root / f"law{behaviour}.yaml"
        path.write_text(text.replace("law: pd", "law: plugin").replace(
            "tick_s:", f"plugin: {{library: {library.name}}}\ntick_s:"))
        return path

    def campaign(self, behaviour):
        reference = Run(pathlib.Path(tempfile.mkdtemp(dir=self.root)), "--workers", 0, "--cases", CASES, "--autopilot",
                        self.autopilot(behaviour)).finish()
        return reference, reference.out / "campaign.yaml"

    def test_a_service_flies_it(self):
        reference, campaign = self.campaign(0)
        self.start_coordinator()
        self.start_worker("--slots", 2)  # alone: nobody else could fly the first cases again
        identity = self.dispersa("launch", campaign).strip()
        self.dispersa("watch", identity, code=reference.code)
        self.assert_same_folder(identity, reference)

    def test_two_workers_that_agree_fly_it(self):
        reference, campaign = self.campaign(0)
        self.start_coordinator()
        for _ in range(2):
            self.start_worker()
        wait_for(lambda: len(json.loads(self.dispersa("status", "--json"))["workers"]) == 2, "two workers")
        identity = self.dispersa("launch", campaign).strip()
        self.dispersa("watch", identity, code=reference.code)
        self.assert_same_folder(identity, reference)
        # Two cases once more than there are.
        self.assertEqual(sum(w["flown"] for w in json.loads(self.dispersa("status", "--json"))["workers"]), CASES + 2)

    def test_a_crash_takes_no_worker_with_it(self):
        reference, campaign = self.campaign(1)
        self.assertEqual(reference.code, 5)
        self.start_coordinator()
        worker = self.start_worker("--slots", 2)
        identity = self.dispersa("launch", campaign).strip()
        self.dispersa("watch", identity, code=5)
        self.assert_same_folder(identity, reference)
        quarantined = json.loads((reference.out / "summary.json").read_text())["quarantined"]
        self.assertGreater(len(quarantined), 0)
        for case in quarantined:
            self.assertRegex(case["reason"], r"^the control law ended by signal 11 \(SIGSEGV\)")
        self.assertIsNone(worker.poll())
        self.assertEqual([w["flown"] for w in json.loads(self.dispersa("status", "--json"))["workers"]], [CASES])

    def test_results_that_differ_by_worker_refuse_the_campaign(self):
        _, campaign = self.campaign(DIFFERS_BY_WORKER)
        self.start_coordinator()
        for _ in range(2):
            self.start_worker()
        wait_for(lambda: len(json.loads(self.dispersa("status", "--json"))["workers"]) == 2, "two workers")
        identity = self.dispersa("launch", campaign).strip()
        self.assertRegex(self.dispersa("watch", identity, code=2), REFUSAL)
        self.assertEqual(self.status(identity)["state"], "failed")
        self.assertRegex(self.status(identity)["problem"], REFUSAL)
        self.assertFalse((self.fetch(identity) / "report.html").exists())

    def test_a_campaign_that_no_worker_can_fly_says_so(self):
        _, campaign = self.campaign(CRASHES_IN_WORKERS)
        self.start_coordinator()
        self.start_worker(preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (777, 777)))
        identity = self.dispersa("launch", campaign).strip()
        wait_for(lambda: self.status(identity)["problem"], "why it does not go on")
        self.assertRegex(self.status(identity)["problem"],
                         r"^no worker here can fly it: the control law pd_test cannot fly the nominal flight: it ended by signal 6")
        self.assertEqual(self.status(identity)["state"], "flying")

    def test_a_campaigns_own_coordinator_compares_with_its_own_flights(self):
        _, campaign = self.campaign(DIFFERS_BY_WORKER)
        coordinator = self.start("dispersa-coordinator", campaign, "--cases", 20000, "--out", self.data / "out", *self.DAEMON)
        self.start_worker()  # alone
        self.assertEqual(coordinator.wait(timeout=PATIENCE_S), 2, self.log.read_text())
        self.assertRegex(self.log.read_text(), REFUSAL)
        self.assertLess(stored(self.data / "out"), 20000)

    def test_a_run_on_local_workers_is_refused_too(self):
        run = Run(self.root / "refused", "--workers", 2, "--cases", 2000, "--autopilot",
                  self.autopilot(DIFFERS_BY_WORKER)).finish()
        self.assertEqual(run.code, 2, run.stderr)
        self.assertRegex(run.stderr, REFUSAL)
        self.assertNotIn("result:", run.stdout)

    def test_without_leave_it_is_refused_on_the_loopback_interface_too(self):
        _, campaign = self.campaign(0)
        words = "plugin.library: the control law is a shared object; this program runs shared objects only with --allow-plugins"
        for network in ["--insecure"], self.NETWORK:
            # Refused before anything is sent.
            refused = subprocess.run([BINARIES / "dispersa-coordinator", campaign, *network, "--out", self.data / "out",
                                      "--json"],
                                     capture_output=True, text=True, timeout=PATIENCE_S)
            self.assertEqual(refused.returncode, 2, refused.stderr)
            self.assertIn(words, refused.stderr)
            error = json.loads(refused.stdout)
            self.assertEqual((error["code"], error["errors"][0]["path"]), (2, "autopilot.plugin.library"))
        self.start_coordinator()
        self.start("dispersa-worker", "--peer", "127.0.0.1")
        identity = self.dispersa("launch", campaign).strip()
        wait_for(lambda: self.status(identity)["problem"], "why it does not go on")
        self.assertIn("no worker here can fly it: ", self.status(identity)["problem"])
        self.assertIn(words, self.status(identity)["problem"])

    def test_workers_of_a_run_take_what_its_campaign_names(self):
        run = Run(self.root / "named", "--workers", 2, "--cases", CASES, "--autopilot", self.autopilot(0)).finish()
        reference, _ = self.campaign(0)
        self.assertEqual(run.code, reference.code, run.stderr)
        self.assertEqual((run.out / "cases.csv").read_bytes(), (reference.out / "cases.csv").read_bytes())


if __name__ == "__main__":
    main()
