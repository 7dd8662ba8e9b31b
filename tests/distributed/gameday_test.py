"""A game day: a service with keys on four hosts, five campaigns of three owners at a time, and everything that goes wrong in
a year. Processes are killed and frozen, links are cut and lose packets, the disk is full, a worker forges results, a colleague
cancels what is not his, somebody launches more than he may, old campaigns reach the limit of the disk, and another host takes
over on a backup. Sometimes the replaced coordinator was only frozen, and comes back.

All bytes are those of a run in one process, nobody touches the campaign of another owner, and nothing is deleted that has not
ended. At its end it prints what happened, for a person to read.

Environment as of processes.py. DISPERSA_MINUTES: how long (default 3; tests/run --long: 60). DISPERSA_SEED draws the troubles.
DISPERSA_KEEP_LOGS: a folder for the logs.
"""
import errno
import json
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

from hosts import Hosts
from processes import BINARIES, CAMPAIGN, PATIENCE_S, Run, content, end, main, stored, wait_for

MINUTES = float(os.environ.get("DISPERSA_MINUTES", "3"))
SEED = int(os.environ.get("DISPERSA_SEED", random.SystemRandom().randrange(10**6)))
CASES = 600
TOO_MANY = 20_000         # cases: beyond the quota
OPEN = 5                  # campaigns at once
PAUSE_S = 10.0            # between two troubles: something is flown, too
LINES_A_MINUTE = 30       # of the coordinators' log: the hour is read in five minutes
OWNERS = ("ann", "bob", "carol")
DISK = 700 << 20
KEEP = "100MB"
NETWORK = ["--domain", "37"]
KINDS = ("kill a worker", "kill the coordinator", "freeze a worker", "freeze the coordinator", "cut a link", "lose packets",
         "fill the disk", "a forger", "a stranger's cancel", "the owner's cancel", "more than the quota",
         "another host takes over on a backup", "another host takes over, and the first one comes back")


class GameDay(unittest.TestCase):
    def setUp(self):
        self.root = pathlib.Path(tempfile.mkdtemp(prefix="dispersa-gameday-"))
        self.draws = random.Random(SEED)
        self.begun = time.monotonic()
        self.journal = []
        self.processes, self.mounts = [], []
        self.hosts = Hosts(4)  # a worker on each of the first three; coordinators on the first and the last
        self.at = 0            # the host of the coordinator
        self.authority = self.root / "authority"
        self.keys("init", self.authority)
        for role, name, *may in (("coordinator", "main"), ("worker", "one"), ("worker", "two"), ("worker", "three"),
                                 *(("client", owner, "--may", "run") for owner in OWNERS), ("client", "reader", "--may", "read"),
                                 ("client", "ops", "--may", "administer")):
            self.keys("issue", self.authority, "--role", role, "--name", name, *may)
        self.data = self.make_disk("data")
        self.campaigns = {}  # by id: owner, seed; and what became of it
        self.seeds = 0
        self.forgers = 0

    def tearDown(self):
        end(self.processes)
        self.hosts.close()
        for mount in self.mounts:
            subprocess.run(["umount", "--lazy", mount], check=True)
        if folder := os.environ.get("DISPERSA_KEEP_LOGS"):
            for name in ("coordinators.log", "workers.log"):
                shutil.copy(self.root / name, folder)
            pathlib.Path(folder, "journal").write_text("\n".join(self.journal) + "\n")
        shutil.rmtree(self.root)

    def keys(self, *arguments):
        subprocess.run([BINARIES / "dispersa", "keys", *map(str, arguments)], check=True, capture_output=True, timeout=PATIENCE_S)

    def folder(self, role, name):
        return self.authority / "issued" / f"{role}-{name}"

    def make_disk(self, name):
        folder = self.root / name
        folder.mkdir()
        subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={DISK}", "disk", folder], check=True)
        self.mounts.append(folder)
        return folder

    def note(self, text):
        self.journal.append(f"{time.strftime('%H:%M:%S', time.gmtime())}  {text}")

    def start(self, host, program, *arguments):
        path = program if "/" in str(program) else BINARIES / program
        with self.log_of("coordinators" if "coordinator" in str(program) else "workers").open("a") as log:
            process = self.hosts[host].start([path, *arguments, *NETWORK], stdout=log, stderr=log)
        self.processes.append(process)
        return process

    def start_coordinator(self):
        return self.start(self.at, "dispersa-coordinator", "--data", self.data, "--keys", self.folder("coordinator", "main"),
                          "--keep", KEEP, "--quota", f"campaigns=4,cases={TOO_MANY - 1}", "--quota", "carol:places=2",
                          "--audit", 0.02)

    def peers(self):
        return f"{self.hosts[0].address},{self.hosts[-1].address}"

    def start_worker(self, host):
        return self.start(host, "dispersa-worker", "--peer", self.peers(), "--keys",
                          self.folder("worker", ("one", "two", "three")[host]))

    def client(self, name, *arguments):
        done = subprocess.run([*self.hosts[0].inside, BINARIES / "dispersa", *map(str, arguments), *NETWORK, "--peer",
                               self.hosts[self.at].address, "--keys", self.folder("client", name)], capture_output=True, text=True,
                              timeout=3 * PATIENCE_S)
        return done.returncode, done.stdout, done.stderr

    def ask(self, name, *arguments):
        """An answer, repeated while the coordinator is away or starts."""
        deadline = time.monotonic() + 2 * PATIENCE_S
        while True:
            code, out, error = self.client(name, *arguments)
            if code == 0:
                return out
            if time.monotonic() > deadline or code != 5:
                self.fail(f"{name} {arguments}: {code}: {error}\n{self.log()[-4000:]}")
            time.sleep(0.5)

    def log_of(self, whose):
        return self.root / f"{whose}.log"

    def log(self):
        """Of the coordinators."""
        return self.log_of("coordinators").read_text(errors="replace")

    def deleted(self):
        """Lines about deleted campaigns, by id."""
        file = self.data / "deleted.jsonl"
        return {line["id"]: line for line in map(json.loads, file.read_text().splitlines())} if file.exists() else {}

    def listed(self):
        return {each["id"]: each for each in json.loads(self.ask("reader", "list", "--json"))["campaigns"]}

    # What the owners do.

    def keep_busy(self):
        open_ones = [i for i, each in self.campaigns.items() if not each.get("checked")]
        while len(open_ones) < OPEN:
            self.seeds += 1
            owner = OWNERS[self.seeds % len(OWNERS)]
            identity = self.ask(owner, "launch", CAMPAIGN, "--cases", CASES, "--seed", self.seeds, "--label",
                                f"commit={self.seeds}").strip()
            self.campaigns[identity] = {"owner": owner, "seed": self.seeds}
            open_ones.append(identity)

    def check_ended(self):
        """Campaigns that are done have the bytes of a run in one process, and belong to whoever launched them."""
        listed = self.listed()
        for identity, mine in self.campaigns.items():
            each = listed.get(identity)
            if mine.get("checked"):
                continue
            if each is None:  # the limit was reached before it was looked at
                self.assertEqual(self.deleted()[identity]["state"], "done")
                mine["checked"] = True
                self.note(f"campaign {identity[:8]} of {mine['owner']} has ended and is deleted at the limit of the disk")
                continue
            self.assertEqual(each["owner"], mine["owner"])
            self.assertIn(each["state"], ("waiting", "flying", "reporting", "done"), each)
            if each["state"] != "done":
                continue
            reference = Run(self.root / "runs" / str(mine["seed"]), "--workers", 0, "--cases", CASES, "--seed", mine["seed"],
                            "--no-histories").finish()
            out = self.root / "fetched" / identity
            if self.client("reader", "fetch", identity, "--out", out)[0] != 0:
                continue  # away, or deleted meanwhile: the next look tells
            self.assertEqual(content(out, "cases.csv"), content(reference.out, "cases.csv"), f"seed {mine['seed']}")
            self.assertTrue((out / "report.html").read_bytes().endswith(b"</html>\n"), "cut off")
            shutil.rmtree(out), shutil.rmtree(self.root / "runs")
            mine["checked"] = True
            self.note(f"campaign {identity[:8]} of {mine['owner']} is done: the bytes of a run in one process")

    # What goes wrong.

    def kill(self, process):
        process.kill()
        process.wait()
        self.processes.remove(process)

    @staticmethod
    def stored_in(data):
        """Rows by campaign that has some."""
        return {folder: rows for folder in data.glob("*/results") if (rows := stored(folder))}

    def take_over(self, comes_back):
        """Another host starts on a backup; the first one is dead, or only frozen."""
        first, first_data, earlier = self.coordinator, self.data, int((self.data / "epoch").read_text())
        backup = self.root / "backup"
        self.ask("ops", "backup", backup)
        if comes_back:
            first.send_signal(signal.SIGSTOP)
        else:
            self.kill(first)
        self.at = len(self.hosts) - 1 - self.at
        self.data = self.make_disk(f"data{self.draws.getrandbits(64):016x}")
        shutil.copytree(backup, self.data, dirs_exist_ok=True)
        shutil.rmtree(backup)
        self.coordinator = self.start_coordinator()
        wait_for(lambda: int((self.data / "epoch").read_text()) > earlier, "a larger number of the start")
        if comes_back:
            wait_for(lambda: len(json.loads(self.ask("reader", "status", "--json"))["workers"]) >= 3, "the workers follow")
            said = len(self.log())
            first.send_signal(signal.SIGCONT)
            wait_for(lambda: "follows a coordinator that was started later" in self.log()[said:], "it hears who leads")
            time.sleep(2.0)  # what was on its way to it before is stored
            rows = self.stored_in(first_data)
            time.sleep(3.0)
            # It may delete old campaigns of its own disk.
            self.assertLessEqual(self.stored_in(first_data).items(), rows.items(), "the first one flies no more")
            self.kill(first)
        subprocess.run(["umount", "--lazy", first_data], check=True)
        self.mounts.remove(first_data)

    def trouble(self, kind):
        seconds = self.draws.uniform(1.0, 6.0)
        host = self.draws.randrange(3)
        if kind == "kill a worker":
            self.kill(self.workers[host])
            self.workers[host] = self.start_worker(host)
        elif kind == "kill the coordinator":
            self.kill(self.coordinator)
            self.coordinator = self.start_coordinator()
        elif kind.startswith("freeze"):
            victim = self.coordinator if "coordinator" in kind else self.workers[host]
            victim.send_signal(signal.SIGSTOP)
            time.sleep(seconds)
            victim.send_signal(signal.SIGCONT)
        elif kind in ("cut a link", "lose packets"):
            link = self.hosts[1 + host % 2]
            if kind == "cut a link":
                link.cut()
            else:
                link.drop("in", 40), link.drop("out", 40)
            time.sleep(seconds)
            link.heal()
        elif kind == "fill the disk":
            filling = self.data / "filling"
            with filling.open("wb", buffering=0) as out:  # beside a service that writes
                try:
                    while True:
                        out.write(bytes(1 << 16))
                except OSError as error:
                    self.assertEqual(error.errno, errno.ENOSPC)
            time.sleep(seconds + 2.0)
            filling.unlink()
        elif kind == "a forger":
            self.forgers += 1
            name = f"forger{self.forgers}"
            self.keys("issue", self.authority, "--role", "worker", "--name", name)
            forger = self.start(1, os.environ["DISPERSA_NOOP_WORKER"], "--peer", self.peers(), "--keys",
                                self.folder("worker", name))
            deadline = time.monotonic() + 3 * PATIENCE_S
            while not re.search(rf"{name}\S* may not fly here any more", self.log()):
                self.assertLess(time.monotonic(), deadline, f"{name} is not expelled\n{self.log()[-4000:]}")
                self.check_ended()  # else all may be flown and wait for their reports: it would get no case
                self.keep_busy()
            forger.wait(timeout=PATIENCE_S)
            self.processes.remove(forger)
        elif kind == "a stranger's cancel":
            identity, mine = next((i, each) for i, each in self.campaigns.items() if not each.get("checked"))
            stranger = next(owner for owner in OWNERS if owner != mine["owner"])
            for command in ("cancel", "delete"):
                code, _, error = self.client(stranger, command, identity)
                self.assertIn(code, (2, 5))
                if code == 2:
                    self.assertIn(f"belongs to '{mine['owner']}': the keys of '{stranger}' may run and cannot {command} it", error)
        elif kind == "the owner's cancel":
            for identity, each in self.listed().items():
                if each["state"] in ("waiting", "flying"):
                    owner, seed = self.campaigns[identity]["owner"], self.campaigns[identity]["seed"]
                    if self.client(owner, "cancel", identity)[0] == 0:
                        self.ask(owner, "launch", CAMPAIGN, "--cases", CASES, "--seed", seed)
                    break
        elif kind == "more than the quota":
            owner = self.draws.choice(OWNERS)
            code, _, error = self.client(owner, "launch", CAMPAIGN, "--cases", TOO_MANY, "--seed", 999)
            self.assertIn(code, (2, 5))
            if code == 2:
                self.assertIn(f"allowed: at most {TOO_MANY - 1}; wait, or launch fewer", error)
        else:
            self.take_over("comes back" in kind)

    def test_a_day(self):
        print(f"DISPERSA_SEED={SEED} repeats these troubles", flush=True)
        self.coordinator = self.start_coordinator()
        self.workers = [self.start_worker(host) for host in range(3)]
        self.keep_busy()
        done = []
        while time.monotonic() - self.begun < 60.0 * MINUTES or len(done) < len(KINDS):
            if len(done) % len(KINDS) == 0:
                order = self.draws.sample(KINDS, len(KINDS))
            kind = order[len(done) % len(KINDS)]
            self.note(kind)
            self.trouble(kind)
            done.append(kind)
            self.check_ended()
            self.keep_busy()
            time.sleep(PAUSE_S if MINUTES >= 10 else 1.0)
            for process in [self.coordinator, *self.workers]:
                self.assertIsNone(process.poll(), f"an end that nobody asked for, after: {kind}\n{self.log()[-4000:]}")
        while any(not each.get("checked") for each in self.campaigns.values()):
            self.check_ended()
            time.sleep(1)
        # What the limit of the disk has deleted had ended, and its owner is remembered.
        deleted = self.deleted()
        for line in deleted.values():
            self.assertEqual((line["state"], line["owner"]), ("done", self.campaigns[line["id"]]["owner"]))
        if MINUTES >= 10:
            self.assertTrue(deleted, "the limit was not reached")
        self.assertEqual({name.partition("_")[0] for name in json.loads((self.data / "expelled.json").read_text())["expelled"]},
                         {f"forger{i + 1}" for i in range(self.forgers)})
        lines = self.log().splitlines()
        print("\n".join(self.journal))
        print(f"{len(done)} troubles, {len(self.campaigns)} campaigns of {len(OWNERS)} owners, {len(deleted)} deleted at the limit, "
              f"{self.forgers} forgers expelled, {len(lines)} lines of log")
        self.assertLess(len(lines), 200 + LINES_A_MINUTE * MINUTES, "a log that nobody can read")


if __name__ == "__main__":
    main(need_isolation="hosts cannot be made")
