"""Coordinators killed at random moments of a campaign with very short flights: it must end.

Environment as of processes.py. DISPERSA_RESTARTS: how many kills (default 3; tests/run --long: 300).
"""
import os
import random
import shutil
import signal
import time

from processes import CAMPAIGN, PATIENCE_S, Run, content, end, main, shared_memory_segments
from service_case import ServiceCase

RESTARTS = int(os.environ.get("DISPERSA_RESTARTS", "3"))
CASES = 400
# Seconds in which a campaign ends: a worker finds it within 2 s, or makes its connection anew within 30 s.
LIMIT_S = PATIENCE_S


class RestartTest(ServiceCase):
    DOMAIN = "37"

    def setUp(self):
        super().setUp()
        self.segments = shared_memory_segments()

    def tearDown(self):
        super().tearDown()
        self.assertEqual(shared_memory_segments(), self.segments)

    def test_a_campaign_always_ends(self):
        reference = Run(self.root / "reference", "--workers", 0, "--cases", CASES).finish()
        draws = random.Random(int(os.environ.get("DISPERSA_SEED", "1")))
        restarts = cycles = 0
        longest = 0.0
        while restarts < RESTARTS:
            cycles += 1
            shutil.rmtree(self.data)
            self.log.write_text("")
            self.processes = []
            for _ in range(2):
                self.start_worker("--peer", "127.0.0.1", "--slots", draws.choice([1, 2]))
            coordinator = self.start_coordinator()
            identity = self.dispersa("launch", CAMPAIGN, "--cases", CASES).strip()
            for _ in range(3):
                time.sleep(draws.random() * 1.0)
                # SIGTERM too: it must not send the workers home.
                coordinator.send_signal(draws.choice([signal.SIGKILL, signal.SIGKILL, signal.SIGTERM]))
                coordinator.wait(timeout=PATIENCE_S)
                restarts += 1
                coordinator = self.start_coordinator()
            begun = time.monotonic()
            self.dispersa("watch", identity, "--quiet", code=reference.code)
            longest = max(longest, time.monotonic() - begun)
            self.assertLess(longest, LIMIT_S, f"cycle {cycles}: {self.log.read_text()[-4000:]}")
            self.assertEqual(content(self.data / identity / "results", "cases.csv"), reference.csv(), f"cycle {cycles}")
            end(self.processes)
        print(f"{restarts} restarts in {cycles} campaigns; the longest wait for an end was {longest:.1f} s")


if __name__ == "__main__":
    main()
