"""Coordinators killed at random moments of a campaign with very short flights: it must end.

Environment as of processes.py. DISPERSA_RESTARTS: how many kills (default 15; tests/run --long: 300).
"""
import os
import pathlib
import re
import random
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

from processes import BINARIES, CAMPAIGNS, PATIENCE_S, Run, content, end, main, shared_memory_segments, smoke_text, stored

RESTARTS = int(os.environ.get("DISPERSA_RESTARTS", "15"))
CASES = 400
# Seconds in which a campaign ends: a worker finds it within 2 s, or makes its connection anew within 30 s.
LIMIT_S = PATIENCE_S
NETWORK = ["--domain", "37", "--address", "127.0.0.1"]


def write_tiny_campaign(folder):
    """The campaign of the tests with a vehicle that its first second of flight breaks."""
    vehicle, changed = re.subn(r"(?m)^limits: .*$", "limits: {axial_load_g: 0.5, terminate: true}",
                               (CAMPAIGNS / "vehicles/slv4.yaml").read_text())
    assert changed == 1
    (folder / "vehicle.yaml").write_text(vehicle)
    (folder / "tiny.yaml").write_text(smoke_text().replace(f"{CAMPAIGNS}/vehicles/slv4.yaml", str(folder / "vehicle.yaml")))
    return folder / "tiny.yaml"


class RestartTest(unittest.TestCase):
    def setUp(self):
        self.root = pathlib.Path(tempfile.mkdtemp(prefix="dispersa-restart-"))
        self.processes = []
        self.segments = shared_memory_segments()

    def tearDown(self):
        end(self.processes)
        self.assertEqual(shared_memory_segments(), self.segments)
        shutil.rmtree(self.root)

    def start(self, program, *arguments):
        with (self.root / "log").open("a") as log:
            self.processes.append(subprocess.Popen([BINARIES / program, *map(str, arguments), *NETWORK],
                                                   stdout=subprocess.DEVNULL, stderr=log))
        return self.processes[-1]

    def dispersa(self, *arguments, code=0):
        done = subprocess.run([BINARIES / "dispersa", *map(str, arguments), *NETWORK], capture_output=True, text=True, timeout=LIMIT_S)
        self.assertEqual(done.returncode, code, f"{done.stderr}{(self.root / 'log').read_text()[-4000:]}")
        return done.stdout.strip()

    def test_a_campaign_always_ends(self):
        campaign = write_tiny_campaign(self.root)
        reference = Run(self.root / "reference", "--workers", 0, "--cases", CASES, campaign=campaign).finish()
        draws = random.Random(int(os.environ.get("DISPERSA_SEED", "1")))
        restarts = cycles = 0
        longest = 0.0
        while restarts < RESTARTS:
            cycles += 1
            data = self.root / "data"
            shutil.rmtree(data, ignore_errors=True)
            (self.root / "log").write_text("")
            self.processes = []
            for _ in range(2):
                self.start("dispersa-worker", "--peer", "127.0.0.1", "--slots", draws.choice([1, 2]))
            coordinator = self.start("dispersa-coordinator", "--data", data)
            identity = self.dispersa("launch", campaign, "--cases", CASES)
            for _ in range(3):
                time.sleep(draws.random() * 1.0)
                # SIGTERM too: it must not send the workers home.
                coordinator.send_signal(draws.choice([signal.SIGKILL, signal.SIGKILL, signal.SIGTERM]))
                coordinator.wait(timeout=PATIENCE_S)
                restarts += 1
                coordinator = self.start("dispersa-coordinator", "--data", data)
            begun = time.monotonic()
            try:
                self.dispersa("watch", identity, "--quiet", code=reference.code)
            except subprocess.TimeoutExpired:
                self.fail(f"cycle {cycles}: {stored(data / identity / 'results')} of {CASES} cases, then nothing:\n"
                          f"{(self.root / 'log').read_text()[-4000:]}")
            longest = max(longest, time.monotonic() - begun)
            self.assertEqual(content(data / identity / "results", "cases.csv"), reference.csv(), f"cycle {cycles}")
            end(self.processes)
        print(f"{restarts} restarts in {cycles} campaigns; the longest wait for an end was {longest:.1f} s")


if __name__ == "__main__":
    main()
