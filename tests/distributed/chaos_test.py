"""A service on three hosts whose processes are killed and frozen and whose links are cut and lose packets, while it
flies several campaigns: all bytes are those of a run in one process, and it always gets on again.

Environment as of processes.py. DISPERSA_TROUBLES: how many (default 3; tests/run --long: 1000). DISPERSA_SEED draws
them: another one each time, which is printed.
"""
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

from hosts import Hosts
from processes import (BINARIES, CAMPAIGN, HALF_WAY_CASES, PATIENCE_S, Run, content, end, main, shared_memory_segments,
                       stored, wait_for)

TROUBLES = int(os.environ.get("DISPERSA_TROUBLES", "3"))
SEED = int(os.environ.get("DISPERSA_SEED", random.SystemRandom().randrange(10**6)))
CASES = 4000
OPEN = 2           # campaigns at once, at least
LONGEST_S = 6.0    # a freeze, a cut: beyond the silence after which a worker is lost
STALL_S = 30       # after a trouble something must be stored within
NETWORK = ["--domain", "33", "--insecure"]


class ChaosTest(unittest.TestCase):
    def setUp(self):
        self.cases = CASES
        self.root = pathlib.Path(tempfile.mkdtemp(prefix="dispersa-chaos-"))
        self.segments = shared_memory_segments()
        self.draws = random.Random(SEED)
        self.hosts = Hosts(3)
        self.processes = []
        self.launched = []
        self.counts = {}
        self.longest_stall_s = 0.0

    def tearDown(self):
        end(self.processes)
        self.hosts.close()
        self.assertEqual(shared_memory_segments(), self.segments)
        shutil.rmtree(self.root)

    def start(self, host, program, *arguments):
        with (self.root / "log").open("a") as log:
            process = self.hosts[host].start([BINARIES / program, *arguments, *NETWORK], stdout=log, stderr=log)
        self.processes.append(process)
        return process

    def start_coordinator(self):
        return self.start(0, "dispersa-coordinator", "--data", self.root / "data")

    def start_worker(self, host):
        return self.start(host, "dispersa-worker", "--peer", self.hosts[0].address)

    def client(self, *arguments):
        """Of a host whose link is whole: a client repeats what it asks until it is answered."""
        done = subprocess.run([*self.hosts[0].inside, BINARIES / "dispersa", *map(str, arguments), *NETWORK,
                               "--peer", self.hosts[0].address], capture_output=True, text=True, timeout=2 * PATIENCE_S)
        return done.returncode, done.stdout, done.stderr

    def stored(self):
        """Cases by campaign. What is complete stays so, and is not looked at again."""
        for identity in self.launched:
            if self.counts.get(identity, 0) < self.cases:
                self.counts[identity] = stored(self.root / "data" / identity / "results")
        return self.counts

    def keep_busy(self, campaigns=OPEN):
        while sum(count < self.cases for count in self.stored().values()) < campaigns:
            code, out, error = self.client("launch", CAMPAIGN, "--cases", self.cases, "--seed", len(self.launched) + 1)
            self.assertEqual(code, 0, error)
            self.launched.append(out.strip())

    def trouble(self):
        """One of them, over when this returns."""
        long_s = self.draws.uniform(0.0, LONGEST_S)
        host = self.draws.randrange(3)
        what = self.draws.choices(["kill worker", "freeze worker", "kill coordinator", "freeze coordinator", "cut",
                                   "deafen", "silence", "lose"], weights=[4, 2, 3, 2, 1, 1, 1, 1])[0]
        victim = self.coordinator if "coordinator" in what else self.workers[host]
        if what.startswith("kill"):
            victim.kill()
            victim.wait()
            self.processes.remove(victim)
            if victim is self.coordinator:
                time.sleep(long_s / 3)
                self.coordinator = self.start_coordinator()
            else:
                self.workers[host] = self.start_worker(host)
        elif what.startswith("freeze"):
            victim.send_signal(signal.SIGSTOP)
            time.sleep(long_s)
            victim.send_signal(signal.SIGCONT)
        else:
            link = self.hosts[host]
            {"cut": link.cut, "deafen": lambda: link.drop("in", 100), "silence": lambda: link.drop("out", 100),
             "lose": lambda: [link.drop(way, self.draws.randrange(10, 50)) for way in ("in", "out")]}[what]()
            time.sleep(long_s)
            link.heal()
        return f"{what}, host {host}, {long_s:.1f} s"

    def await_progress(self, before, after):
        """Until more is stored than was when the trouble was over."""
        deadline = time.monotonic() + STALL_S
        while sum(self.stored().values()) <= before:
            self.keep_busy()  # what was still to be flown may have been stored while it was counted
            if time.monotonic() > deadline:
                self.fail(f"nothing was stored for {STALL_S} s after: {after}\n{(self.root / 'log').read_text()[-6000:]}")
            time.sleep(0.05)
        self.longest_stall_s = max(self.longest_stall_s, time.monotonic() - deadline + STALL_S)

    def test_whatever_happens_the_bytes_are_the_same(self):
        print(f"DISPERSA_SEED={SEED} repeats these troubles", flush=True)
        self.coordinator = self.start_coordinator()
        self.workers = [self.start_worker(host) for host in range(3)]
        for _ in range(TROUBLES):
            self.keep_busy()
            what = self.trouble()
            self.keep_busy()
            self.await_progress(sum(self.stored().values()), what)
        self.assert_same_bytes()
        print(f"{TROUBLES} troubles, {len(self.launched)} campaigns; at most {self.longest_stall_s:.1f} s until more was stored")

    def start_again_without(self, *packets):
        """A coordinator that gets none of these packets while it flies starts again, and the bytes are the same."""
        self.cases = HALF_WAY_CASES
        self.coordinator = self.start_coordinator()
        self.workers = [self.start_worker(1)]
        self.keep_busy(campaigns=1)
        wait_for(lambda: sum(self.stored().values()) > 0, "first results")
        self.workers[0].send_signal(signal.SIGSTOP)  # it has not flown all, however long the next line takes
        self.hosts[0].drop("in", 100, *packets)
        self.workers[0].send_signal(signal.SIGCONT)
        wait_for(lambda: "the coordinator restarts" in (self.root / "log").read_text(), "a new start")
        self.hosts[0].heal()
        self.assert_same_bytes()

    def test_a_coordinator_that_hears_nobody_starts_again(self):
        self.start_again_without()

    def test_a_coordinator_that_hears_no_results_starts_again(self):
        # That the worker lives is still heard: discovery and statuses have ports of their own (services/README.md).
        self.start_again_without("udp", "dport", "!=", "{15655,", "15656}")

    @staticmethod
    def before_histories(folder):
        """The summary but for what cases that were flown again add to it."""
        return {key: value for key, value in json.loads((folder / "summary.json").read_text()).items()
                if key not in ("envelope", "nominal")}

    def assert_same_bytes(self):
        """Of all campaigns, at their end; and that nothing has ended by itself. Flying cases again for a report takes twice as
        long as flying them: of what comes of that, the last campaign's."""
        for seed, identity in enumerate(self.launched, 1):
            is_last = identity == self.launched[-1]
            reference = Run(self.root / f"reference{seed}", "--workers", 0, "--cases", self.cases, "--seed", seed,
                            *([] if is_last else ["--no-histories"])).finish()
            code, _, error = self.client("watch", identity)
            self.assertEqual(code, reference.code, error)
            out = self.root / f"fetched{seed}"
            self.assertEqual(self.client("fetch", identity, "--out", out)[0], 0)
            for name in ("cases.csv", *(["summary.json", "report.html"] if is_last else [])):
                self.assertEqual(content(out, name), content(reference.out, name), name)
            self.assertEqual(*(self.before_histories(folder) for folder in (out, reference.out)))
            self.assertTrue((out / "report.html").read_bytes().endswith(b"</html>\n"), "cut off")
            shutil.rmtree(out), shutil.rmtree(reference.out)
        for process in self.processes:
            self.assertIsNone(process.poll(), "an end that nobody asked for")


if __name__ == "__main__":
    main(need_isolation="hosts cannot be made")
