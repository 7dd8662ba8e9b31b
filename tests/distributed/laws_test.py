"""A control law from a shared object on a service: its bytes reach the workers, who contain what it does.

Environment as of processes.py; DISPERSA_SOURCE: the repository.
"""
import json
import os
import pathlib
import shutil
import subprocess

from processes import BINARIES, CAMPAIGN, PATIENCE_S, Run, main
from service_case import ServiceCase

SOURCE = pathlib.Path(os.environ["DISPERSA_SOURCE"])
CASES = 24


class LawsTest(ServiceCase):
    DOMAIN = "37"

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
        reference = Run(self.root / f"reference{behaviour}", "--workers", 0, "--cases", CASES, "--autopilot",
                        self.autopilot(behaviour)).finish()
        return reference, reference.out / "campaign.yaml"

    def test_a_service_flies_it(self):
        reference, campaign = self.campaign(0)
        self.start_coordinator()
        self.start_worker("--slots", 2)
        identity = self.dispersa("launch", campaign).strip()
        self.dispersa("watch", identity, code=reference.code)
        self.assert_same_folder(identity, reference)

    def test_a_crash_takes_no_worker_with_it(self):
        reference, campaign = self.campaign(1)
        self.assertEqual(reference.code, 5)
        self.start_coordinator()
        worker = self.start_worker("--slots", 2)
        identity = self.dispersa("launch", campaign).strip()
        self.dispersa("watch", identity, code=5)
        self.assert_same_folder(identity, reference)
        given_up = json.loads((reference.out / "summary.json").read_text())["quarantined"]
        self.assertGreater(len(given_up), 0)
        for case in given_up:
            self.assertRegex(case["reason"], r"^the control law ended by signal 11 \(SIGSEGV\)")
        self.assertIsNone(worker.poll())
        self.assertEqual([w["flown"] for w in json.loads(self.dispersa("status", "--json"))["workers"]], [CASES])

    def test_beyond_the_loopback_interface_it_has_to_be_allowed(self):
        _, campaign = self.campaign(0)
        # Refused before anything is sent.
        refused = subprocess.run([BINARIES / "dispersa-coordinator", campaign, "--insecure", "--out", self.data / "out"],
                                 capture_output=True, text=True, timeout=PATIENCE_S)
        self.assertEqual(refused.returncode, 2, refused.stderr)
        self.assertIn("plugin.library: the control law is a shared object, which is run here only where --allow-plugins "
                      "says so", refused.stderr)


if __name__ == "__main__":
    main()
