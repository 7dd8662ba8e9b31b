"""A game day: a service with keys on four hosts, five campaigns of three owners at a time, and everything that goes wrong in
a year. The day begins under the release before, and an upgrade comes while campaigns fly. Processes are killed and frozen, links
are cut and lose packets, the disk is full, a worker forges results, a colleague cancels what is not his, somebody launches more
than he may, strangers send requests without end to the web pages, the authority of the keys is renewed, old campaigns reach the
limit of the disk, and another host takes over on a backup. Sometimes the replaced coordinator was only frozen, and comes back.
One campaign of four has a control law from a shared object.

All bytes are those of a run in one process, nobody touches the campaign of another owner, and nothing is deleted that has not
ended. At its end it prints what happened, for a person to read.

Environment as of processes.py. DISPERSA_MINUTES: how long (default 3; tests/run --long: 60). DISPERSA_SEED draws the troubles.
DISPERSA_KEEP_LOGS: a folder for the logs. DISPERSA_OLDER: the programs of the release before; without it those of today fly
first, and aged.py makes their data those of another engine.
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
import sys
import tempfile
import time
import unittest

import aged
from hosts import Hosts
from processes import BINARIES, PATIENCE_S, SMOKE, Run, content, end, main, stored, wait_for

OLDER = pathlib.Path(os.environ.get("DISPERSA_OLDER", BINARIES))
SOURCE = pathlib.Path(os.environ["DISPERSA_SOURCE"])
ENGINE = json.loads(subprocess.run([BINARIES / "dispersa", "--version", "--json"], capture_output=True, check=True).stdout)["engine"]
MINUTES = float(os.environ.get("DISPERSA_MINUTES", "3"))
SEED = int(os.environ.get("DISPERSA_SEED", random.SystemRandom().randrange(10**6)))
CASES = 600
LONG_CASES = 15_000       # of the campaign that flies while the service is upgraded
TOO_MANY = 20_000         # cases: beyond the quota
OPEN = 5                  # campaigns at once
PAUSE_S = 10.0            # between two troubles: something is flown, too
LINES_A_MINUTE = 30       # of the coordinators' log: the hour is read in five minutes
OWNERS = ("ann", "bob", "carol")
DISK = 700 << 20
KEEP = "150MB"
NETWORK = ["--domain", "37"]
WEB, FIGURES = 9475, 9476  # ports of the coordinator
ANSWERED_S = 5.0           # its probe, while strangers attack its pages
# Memory that it may take under attack: it also flies, and each report that it writes takes some 100 MB. Without limits an
# attack took more than 1 GB; hostile_http_test.py has the strict limit.
MORE_KB = 400 * 1024
IN_THE_MORNING = ("kill a worker", "kill the coordinator", "freeze a worker")
KINDS = ("kill a worker", "kill the coordinator", "freeze a worker", "freeze the coordinator", "cut a link", "lose packets",
         "fill the disk", "a forger", "a stranger's cancel", "the owner's cancel", "more than the quota",
         "hostile requests", "another authority",
         "another host takes over on a backup", "another host takes over, and the first one comes back")
# Arguments: seconds, ports. Bodies, headers and first lines without end, as fast as they are taken and slowly.
HOSTILE = """
import socket, sys, threading, time
end = time.monotonic() + float(sys.argv[1])
def attack(port, head, block, pause_s):
    while time.monotonic() < end:
        try:
            with socket.create_connection(("127.0.0.1", port), timeout=2) as connection:
                connection.sendall(head)
                while time.monotonic() < end:
                    connection.sendall(block)
                    time.sleep(pause_s)
        except OSError:
            time.sleep(0.02)
post = b"POST /login HTTP/1.1\\r\\nHost: localhost\\r\\n"
for head, block in ((post + b"Transfer-Encoding: chunked\\r\\n\\r\\n", b"10000\\r\\n" + bytes(65536) + b"\\r\\n"), (post, b"a:b\\r\\n" * 5000),
                    (b"GET /", b"a" * 65536)):
    for port in map(int, sys.argv[2:]):
        for size, pause_s in ((len(block), 0.0), (1, 0.5), (1, 0.5), (1, 0.5)):
            threading.Thread(target=attack, args=(port, head, block[:size], pause_s)).start()
"""
PROBE = "import sys, urllib.request; urllib.request.urlopen(f'http://127.0.0.1:{sys.argv[1]}/healthz', timeout=float(sys.argv[2]))"


def memory_kb(process, name):
    return int(re.search(rf"{name}:\s+(\d+)", pathlib.Path(f"/proc/{process.pid}/status").read_text()).group(1))


class GameDay(unittest.TestCase):
    def setUp(self):
        self.root = pathlib.Path(tempfile.mkdtemp(prefix="dispersa-gameday-"))
        self.draws = random.Random(SEED)
        self.begun = time.monotonic()
        self.journal = []
        self.processes, self.mounts = [], []
        self.hosts = Hosts(4)  # a worker on each of the first three; coordinators on the first and the last
        self.at = 0            # the host of the coordinator
        self.programs = OLDER
        self.authority = self.root / "authority"
        self.held = {}         # by role and name: the folder of keys on its own machine
        self.keys("init", self.authority)
        self.issue_all()
        self.token = self.root / "token"
        self.token.write_text("0123456789abcdef\n")
        self.token.chmod(0o600)
        self.with_law = self.campaign_with_law()
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
        subprocess.run([self.programs / "dispersa", "keys", *map(str, arguments)], check=True, capture_output=True,
                       timeout=PATIENCE_S)

    def issue(self, role, name, *may):
        self.keys("issue", self.authority, "--role", role, "--name", name, *may)
        folder = self.root / "machines" / f"{role}-{name}-{time.monotonic_ns()}"
        shutil.move(self.authority / "issued" / f"{role}-{name}", folder)
        self.held[role, name] = folder

    def issue_all(self):
        for role, name, *may in (("coordinator", "main"), ("worker", "one"), ("worker", "two"), ("worker", "three"),
                                 *(("client", owner, "--may", "run") for owner in OWNERS), ("client", "reader", "--may", "read"),
                                 ("client", "ops", "--may", "administer")):
            self.issue(role, name, *may)

    def campaign_with_law(self):
        """Its file, written out by a run: a law that is compiled here."""
        (self.root / "dispersa").mkdir()
        shutil.copy(SOURCE / "core/control/control_law.h", self.root / "dispersa")
        subprocess.run(["gcc", "-O2", "-fPIC", "-shared", f"-I{self.root}", SOURCE / "tests/plugins/law.c", "-lm", "-o",
                        self.root / "law.so"], check=True, timeout=PATIENCE_S)
        autopilot = self.root / "law.yaml"
        autopilot.write_text((SOURCE / "tests/data/brief/pd.yaml").read_text().replace("law: pd", "law: plugin").replace(
            "tick_s:", "plugin: {library: law.so}\ntick_s:"))
        run = Run(self.root / "law", "--workers", 0, "--cases", 1, "--no-histories", "--autopilot", autopilot, campaign=SMOKE).finish()
        return run.out / "campaign.yaml"

    def make_disk(self, name):
        folder = self.root / name
        folder.mkdir()
        subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={DISK}", "disk", folder], check=True)
        self.mounts.append(folder)
        return folder

    def note(self, text):
        self.journal.append(f"{time.strftime('%H:%M:%S', time.gmtime())}  {text}")

    def start(self, host, program, *arguments):
        path = program if "/" in str(program) else self.programs / program
        with self.log_of("coordinators" if "coordinator" in str(program) else "workers").open("a") as log:
            process = self.hosts[host].start([path, *arguments, *NETWORK], stdout=log, stderr=log)
        self.processes.append(process)
        return process

    def start_coordinator(self):
        return self.start(self.at, "dispersa-coordinator", "--data", self.data, "--keys", self.held["coordinator", "main"],
                          "--keep", KEEP, "--quota", f"campaigns=4,cases={TOO_MANY - 1}", "--quota", "carol:places=2",
                          "--audit", 0.02, "--allow-plugins", "--web", WEB, "--web-token", self.token, "--metrics", FIGURES)

    def peers(self):
        return f"{self.hosts[0].address},{self.hosts[-1].address}"

    def start_worker(self, host):
        return self.start(host, "dispersa-worker", "--allow-plugins", "--peer", self.peers(), "--keys",
                          self.held["worker", ("one", "two", "three")[host]])

    def restart(self, coordinator=True, workers=True):
        ending = [self.coordinator] * coordinator + self.workers * workers
        for process in ending:
            process.terminate()
        for process in ending:
            process.wait(timeout=PATIENCE_S)
            self.processes.remove(process)
        if coordinator:
            self.coordinator = self.start_coordinator()
        if workers:
            self.workers = [self.start_worker(host) for host in range(3)]

    def client(self, name, *arguments):
        done = subprocess.run([*self.hosts[0].inside, self.programs / "dispersa", *map(str, arguments), *NETWORK, "--peer",
                               self.hosts[self.at].address, "--keys", self.held["client", name]], capture_output=True, text=True,
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
            mine = {"owner": OWNERS[self.seeds % len(OWNERS)], "seed": self.seeds, "cases": CASES,
                    "file": SMOKE if self.seeds % 4 else self.with_law}
            open_ones.append(self.launch(mine))

    def launch(self, mine):
        identity = self.ask(mine["owner"], "launch", mine["file"], "--cases", mine["cases"], "--seed", mine["seed"], "--label",
                            f"commit={mine['seed']}").strip()
        self.campaigns[identity] = mine
        return identity

    def check_ended(self):
        """Campaigns that are done have the bytes of a run in one process, and belong to whoever launched them."""
        listed = self.listed()
        for identity, mine in self.campaigns.items():
            each = listed.get(identity)
            if mine.get("checked"):
                continue
            if each is None:  # the limit was reached before it was looked at
                self.assertEqual(self.deleted()[identity]["state"], "done", "it had ended")
                mine["checked"] = True
                self.note(f"campaign {identity[:8]} of {mine['owner']} has ended and is deleted at the limit of the disk")
                continue
            self.assertEqual(each["owner"], mine["owner"])
            self.assertIn(each["state"], ("waiting", "flying", "reporting", "done"), each)
            if each["state"] != "done":
                continue
            was_flown_before = each.get("engine", ENGINE) != ENGINE
            reference = Run(self.root / "runs" / str(mine["seed"]), "--workers", 0, "--cases", mine["cases"], "--seed",
                            mine["seed"], "--no-histories", campaign=mine["file"],
                            program=(OLDER if was_flown_before else self.programs) / "dispersa").finish()
            out = self.root / "fetched" / identity
            if self.client("reader", "fetch", identity, "--out", out)[0] != 0:
                continue  # away, or deleted meanwhile: the next look tells
            files = [content(folder, "cases.csv") for folder in (out, reference.out)]
            if was_flown_before:  # and reported by the release of today: some of its columns have other names
                files = [file.partition(b"\n")[2] for file in files]
            self.assertEqual(*files, f"seed {mine['seed']}")
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

    def epoch(self):
        return json.loads((self.data / "epoch").read_text())["epoch"]

    def take_over(self, comes_back):
        """Another host starts on a backup; the first one is dead, or only frozen."""
        first, first_data, earlier = self.coordinator, self.data, self.epoch()
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
        wait_for(lambda: self.epoch() > earlier, "a larger number of the start")
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

    def attack_pages(self, seconds):
        """The coordinator answers its probe meanwhile, and its memory stays."""
        inside = self.hosts[self.at].inside
        pathlib.Path(f"/proc/{self.coordinator.pid}/clear_refs").write_text("5")  # the peak from now on
        before = memory_kb(self.coordinator, "VmRSS")
        attack = subprocess.Popen([*inside, sys.executable, "-c", HOSTILE, str(seconds), str(WEB), str(FIGURES)])
        while attack.poll() is None:
            subprocess.run([*inside, sys.executable, "-c", PROBE, str(FIGURES), str(ANSWERED_S)], check=True, timeout=PATIENCE_S)
        self.assertLess(memory_kb(self.coordinator, "VmHWM") - before, MORE_KB)

    def take_authorities(self, *whose):
        for key in whose:
            for file in ("identity_ca.pem", "permissions_ca.pem"):
                shutil.copy(self.authority / "authority" / file, self.held[key])

    def renew_the_authority(self):
        """As the page about keys says: both authorities everywhere, then new keys, then the new authority alone."""
        def three_joined():
            return {"one", "two", "three"} <= {worker["id"].partition("_")[0] for worker in
                                               json.loads(self.ask("reader", "status", "--json"))["workers"]}
        self.keys("renew", self.authority)
        for step in ("both", "new keys", "alone"):
            if step == "new keys":
                self.issue_all()
            if step == "alone":
                self.keys("retire", self.authority)
            self.take_authorities(*self.held)
            self.restart(workers=False)
            wait_for(three_joined, f"the workers, {step}")
            self.restart(coordinator=False)
            wait_for(three_joined, f"the workers again, {step}")

    def upgrade(self):
        """What is done stays done; what flew stays as unfinished beside the same campaign, which its owner launches again."""
        wait_for(self.is_any_done, "a campaign that is done")
        before = self.listed()
        cases = {identity: self.fetched_cases(identity) for identity, each in before.items() if each["state"] == "done"}
        flying = self.launch({"owner": "ann", "seed": 0, "cases": LONG_CASES, "file": SMOKE})
        wait_for(lambda: stored(self.data / flying / "results") > 0, "its first results")
        self.restart_with_today()
        after = self.listed()
        for identity, stored_before in cases.items():
            if identity in self.deleted():  # at the limit of the disk
                continue
            self.assertEqual(after[identity]["state"], "done", after[identity])
            self.assertEqual(self.fetched_cases(identity), stored_before)
        for identity, each in after.items():
            if each["state"] == "unfinished":
                self.assertEqual(self.launch(self.campaigns[identity]), identity)
        counts = {state: sum(each["state"] == state for each in after.values()) for state in ("done", "unfinished")}
        self.assertGreater(min(counts.values()), 0, counts)
        self.assertEqual(after[flying]["state"], "unfinished")
        engines = {each["engine"] for each in self.listed().values() if each["engine"]}
        self.assertEqual(len(engines), 2, engines)
        self.note(f"upgraded: {counts['done']} done under the release before stay, {counts['unfinished']} are launched again")

    def restart_with_today(self):
        for process in [self.coordinator, *self.workers]:
            process.terminate()
            process.wait(timeout=PATIENCE_S)
            self.processes.remove(process)
        if OLDER == BINARIES:
            aged.age(self.data)
        self.programs = BINARIES
        if OLDER != BINARIES:
            self.issue_all()  # keys of release 0.1.0 do not allow the topics of today
        self.coordinator = self.start_coordinator()
        self.workers = [self.start_worker(host) for host in range(3)]

    def fetched_cases(self, identity):
        out = self.root / "fetched" / identity
        self.ask("reader", "fetch", identity, "--out", out)
        cases = content(out, "cases.csv")
        shutil.rmtree(out)
        return cases

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
            self.issue("worker", name)
            forger = self.start(1, os.environ["DISPERSA_NOOP_WORKER"], "--peer", self.peers(), "--keys", self.held["worker", name])
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
                    if self.client(self.campaigns[identity]["owner"], "cancel", identity)[0] == 0:
                        self.launch(self.campaigns[identity])
                    break
        elif kind == "hostile requests":
            self.attack_pages(seconds)
        elif kind == "another authority":
            self.renew_the_authority()
        elif kind == "more than the quota":
            owner = self.draws.choice(OWNERS)
            code, _, error = self.client(owner, "launch", SMOKE, "--cases", TOO_MANY, "--seed", 999)
            self.assertIn(code, (2, 5))
            if code == 2:
                self.assertIn(f"allowed: at most {TOO_MANY - 1}; wait, or launch fewer", error)
        else:
            self.take_over("comes back" in kind)

    def is_any_done(self):
        self.check_ended()
        self.keep_busy()
        return any(each["state"] == "done" for each in self.listed().values())

    def test_a_day(self):
        print(f"DISPERSA_SEED={SEED} repeats these troubles", flush=True)
        self.coordinator = self.start_coordinator()
        self.workers = [self.start_worker(host) for host in range(3)]
        self.keep_busy()
        for kind in IN_THE_MORNING:
            self.note(f"under the release before: {kind}")
            self.trouble(kind)
            self.check_ended()
            self.keep_busy()
        self.note("an upgrade")
        self.upgrade()
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
            self.assertIn(line["state"], ("done", "unfinished"))
            self.assertEqual(line["owner"], self.campaigns[line["id"].partition("-")[0]]["owner"])
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
