"""Workers in which a rule of the program breaks: what they hold is flown by others, and a second one ends a run.

Environment as of processes.py; DISPERSA_FAULTY_WORKER: dispersa-worker with such a fault in one campaign.
"""
import json
import os
import shutil
import subprocess

from processes import BINARIES, PATIENCE_S, Run, lost_text, main
from service_case import ServiceCase

FAULT = "tests/tools/faulty_worker.cc:"
FAULTY = os.environ["DISPERSA_FAULTY_WORKER"]
CASES = 40


class FaultTest(ServiceCase):
    DOMAIN = "54"

    def campaign(self, name):
        """A file of the campaign under another name."""
        file = self.root / f"{name}.yaml"
        file.write_text(lost_text(name))
        return file

    def test_the_cases_of_the_first_one_are_flown_by_others(self):
        self.start_coordinator()
        flawed, sound = [self.dispersa("launch", self.campaign(name), "--cases", CASES, "--seed", seed).strip()
                         for seed, name in enumerate(("flawed", "sound"), 1)]
        worker = self.start(FAULTY, env={**os.environ, "DISPERSA_FAULTY_CAMPAIGN": "flawed"})
        self.assertEqual(worker.wait(timeout=PATIENCE_S), 1)
        self.assertIn(FAULT, self.log.read_text())
        self.assertIn("leaves with a fault of its own in the campaign flawed: engine fault: ", self.log.read_text())
        self.assertEqual(self.status(flawed)["state"], "flying")
        self.start_worker()
        for identity, name, seed in ((flawed, "flawed", 1), (sound, "sound", 2)):
            reference = Run(self.root / name, "--workers", 0, "--cases", CASES, "--seed", seed,
                            campaign=self.campaign(name)).finish()
            self.dispersa("watch", identity, code=reference.code)
            self.assertEqual(self.status(identity)["quarantined"], 0)
            self.assert_same_folder(identity, reference)

    def test_a_run_replaces_the_first_one_and_ends_with_the_second(self):
        programs = self.data / "bin"
        programs.mkdir()
        shutil.copy(BINARIES / "dispersa", programs / "dispersa")
        shutil.copy(FAULTY, programs / "dispersa-worker")
        done = subprocess.run([programs / "dispersa", "run", self.campaign("flawed"), "--workers", "1", "--out",
                               self.data / "out"], capture_output=True, text=True, timeout=PATIENCE_S,
                              env={**os.environ, "DISPERSA_FAULTY_CAMPAIGN": "flawed"})
        self.assertEqual(done.returncode, 5, done.stderr)
        self.assertIn(FAULT, done.stderr)
        workers = json.loads((self.data / "out/execution.json").read_text())["workers"]
        self.assertEqual(len(workers), 2, done.stderr)
        self.assertEqual(workers[0]["end"], "exit code 1")


if __name__ == "__main__":
    main()
