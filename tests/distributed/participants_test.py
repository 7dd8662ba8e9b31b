"""Three hundred real workers on three hosts, all started at once, and one coordinator: they join, and join again when it was
killed. A campaign completes with the bytes of a run in one process, and clients get answers. Prints what all of it takes.

Environment as of processes.py. DISPERSA_PARTICIPANTS: how many (default 300; a host has UDP ports for 104 programs).
DISPERSA_WITH_KEYS: everything is encrypted. DISPERSA_KILLS: how often the coordinator is killed (default 1).
"""
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import time
import unittest

from hosts import Hosts
from processes import BINARIES, CAMPAIGN, PATIENCE_S, Run, content, end, main, stored, wait_for

PARTICIPANTS = int(os.environ.get("DISPERSA_PARTICIPANTS", "300"))
WITH_KEYS = bool(os.environ.get("DISPERSA_WITH_KEYS"))
HOSTS = 3
CASES = PARTICIPANTS // 5  # so many fly side by side at most: each flight would have a host of its own elsewhere
KILLS = int(os.environ.get("DISPERSA_KILLS", "1"))
JOIN_S = float(os.environ.get("DISPERSA_JOIN_S", "60"))  # until all have joined
ANSWER_S = 8.0      # the patience of a health probe
IDLE_S = 15.0
MOST_PSS_MB = 40.0  # of a worker: its share of what it has loaded


def cpu_s(process):
    fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def memory_mb(process, name):
    text = pathlib.Path(f"/proc/{process.pid}/smaps_rollup").read_text()
    return int(text.partition(f"\n{name}:")[2].split()[0]) / 1024


def threads(process):
    return int(pathlib.Path(f"/proc/{process.pid}/status").read_text().partition("Threads:")[2].split()[0])


def mean(values):
    values = list(values)
    return sum(values) / len(values)


class Participants(unittest.TestCase):
    def setUp(self):
        self.root = pathlib.Path(tempfile.mkdtemp(prefix="dispersa-participants-"))
        self.processes, self.workers = [], []
        self.hosts = Hosts(HOSTS)
        self.network = {role: ["--domain", "33", "--insecure"] for role in ("coordinator", "worker", "client")}
        if WITH_KEYS:
            authority = self.root / "authority"
            subprocess.run([BINARIES / "dispersa", "keys", "init", authority], check=True, capture_output=True)
            for role in self.network:
                subprocess.run([BINARIES / "dispersa", "keys", "issue", authority, "--role", role, "--name", "one"], check=True,
                               capture_output=True)
                self.network[role] = ["--domain", "33", "--keys", authority / "issued" / f"{role}-one"]

    def tearDown(self):
        end(self.processes)
        self.hosts.close()
        shutil.rmtree(self.root)

    def start(self, host, program, role, *arguments):
        with (self.root / f"{role}.log").open("a") as log:
            # The coordinator shares the processor of this machine with all those workers, and would have its own elsewhere.
            priority = ["nice", "-n", "10"] if role == "worker" else []
            self.processes.append(self.hosts[host].start([*priority, BINARIES / program, *arguments, *self.network[role]],
                                                         stdout=log, stderr=log))
        return self.processes[-1]

    def dispersa(self, *arguments):
        """Its standard output. Repeated while the coordinator does not answer; the seconds of the last try."""
        deadline = time.monotonic() + PATIENCE_S
        while True:
            begun = time.monotonic()
            done = subprocess.run([*self.hosts[0].inside, BINARIES / "dispersa", *map(str, arguments), *self.network["client"],
                                   "--peer", self.hosts[0].address], capture_output=True, text=True, timeout=3 * PATIENCE_S)
            if done.returncode == 0:
                return done.stdout, time.monotonic() - begun
            self.assertLess(time.monotonic(), deadline, f"{arguments}: {done.returncode} {done.stderr}")

    def joined(self):
        return len(json.loads(self.dispersa("status", "--json")[0])["workers"])

    def health_s(self):
        begun = time.monotonic()
        done = subprocess.run([*self.hosts[0].inside, BINARIES / "dispersa-coordinator", "--health",
                               *self.network["coordinator"]], capture_output=True, text=True, timeout=3 * PATIENCE_S)
        self.assertEqual(done.returncode, 0, done.stderr)
        return time.monotonic() - begun

    def start_coordinator(self):
        return self.start(0, "dispersa-coordinator", "coordinator", "--data", self.root / "data")

    def start_crowd(self):
        self.workers = [self.start(number % HOSTS, "dispersa-worker", "worker", "--peer", self.hosts[0].address)
                        for number in range(PARTICIPANTS)]

    def await_crowd(self, coordinator, begun, what):
        """Clients ask meanwhile, with keys of their own."""
        before = sum(map(cpu_s, self.workers))
        wait_for(lambda: coordinator.poll() is not None or self.joined() == PARTICIPANTS, f"{PARTICIPANTS} workers")
        self.assertIsNone(coordinator.poll(), self.log()[-3000:])
        took_s = time.monotonic() - begun
        print(f"{what}: {PARTICIPANTS} workers joined after {took_s:.1f} s; the coordinator took {cpu_s(coordinator):.1f} s of a "
              f"core and {memory_mb(coordinator, 'Rss'):.0f} MB, the workers {sum(map(cpu_s, self.workers)) - before:.1f} s")
        self.assertEqual([worker.returncode for worker in self.workers if worker.poll() is not None], [])
        self.assertLess(took_s, JOIN_S)

    def log(self):
        return (self.root / "coordinator.log").read_text(errors="replace")

    def test_a_crowd_joins_at_once_and_again(self):
        coordinator, begun = self.start_coordinator(), time.monotonic()
        self.start_crowd()
        self.await_crowd(coordinator, begun, "first start")
        for _ in range(KILLS):
            coordinator.kill()
            coordinator.wait()
            coordinator, begun = self.start_coordinator(), time.monotonic()
            self.await_crowd(coordinator, begun, "after a kill")
        self.assertNotIn("restarts", self.log())

    def test_a_campaign_of_three_hundred_workers(self):
        reference = Run(self.root / "reference", "--workers", 0, "--cases", CASES, "--no-histories").finish()
        coordinator, begun = self.start_coordinator(), time.monotonic()
        self.start_crowd()
        self.await_crowd(coordinator, begun, "first start")
        before, at = [cpu_s(each) for each in (coordinator, *self.workers)], time.monotonic()
        time.sleep(IDLE_S)
        shares = [(cpu_s(each) - b) / (time.monotonic() - at)
                  for each, b in zip((coordinator, *self.workers), before)]
        print(f"without cases: the coordinator takes {100 * shares[0]:.1f} % of a core and "
              f"{memory_mb(coordinator, 'Rss'):.0f} MB, a worker {100 * mean(shares[1:]):.2f} % of a core")

        flying, at = cpu_s(coordinator), time.monotonic()
        identity = self.dispersa("launch", CAMPAIGN, "--cases", CASES)[0].strip()
        answers = {"health": [], "list": [], "status": []}
        results = self.root / "data" / identity / "results"
        while stored(results) < CASES:
            answers["health"].append(self.health_s())
            answers["list"].append(self.dispersa("list")[1])
            answers["status"].append(self.dispersa("status", identity, "--json")[1])
            self.assertLess(time.monotonic() - at, 10 * PATIENCE_S, self.log()[-3000:])
        took_s = time.monotonic() - at
        self.assertLess(max(map(max, answers.values())), ANSWER_S, answers)
        print(f"{CASES} cases in {took_s:.0f} s; the coordinator took {cpu_s(coordinator) - flying:.1f} s of a core")
        print("answers: " + ", ".join(f"{name} at most {max(all_s):.2f} s of {len(all_s)}" for name, all_s in answers.items()))
        print(f"a worker that has flown: {mean(memory_mb(each, 'Rss') for each in self.workers):.1f} MB resident, of which "
              f"{mean(memory_mb(each, 'Pss') for each in self.workers):.1f} MB its share (code is shared on a host), "
              f"{mean(map(threads, self.workers)):.0f} threads")
        self.assertLess(max(memory_mb(each, "Pss") for each in self.workers), MOST_PSS_MB)
        wait_for(lambda: json.loads(self.dispersa("status", identity, "--json")[0])["campaigns"][0]["state"] == "done", "its report")
        out = self.root / "fetched"
        self.dispersa("fetch", identity, "--out", out)
        self.assertEqual(content(out, "cases.csv"), content(reference.out, "cases.csv"))
        self.assertEqual(self.joined(), PARTICIPANTS)
        self.assertNotIn("is lost", self.log())


if __name__ == "__main__":
    main(need_isolation="hosts cannot be made")
