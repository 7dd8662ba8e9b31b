"""A control law from a shared object on a service: its bytes reach the workers, which run it in a contained process.

Environment as of processes.py; DISPERSA_SOURCE: the repository.
"""
import collections
import contextlib
import hashlib
import json
import os
import pathlib
import re
import resource
import shutil
import subprocess
import tempfile
import time
import unittest.mock

from processes import BINARIES, CAMPAIGN, PATIENCE_S, Run, main, parent_and_name, smoke_text, wait_for
from service_case import ServiceCase

SOURCE = pathlib.Path(os.environ["DISPERSA_SOURCE"])
CASES = 16
PRINTS = 13
DIFFERS_BY_WORKER = 20
CRASHES_IN_WORKERS = 27
REFUSAL = (r"the control law pd_test is not deterministic: of case \d+, flown (by worker \S+|here before the campaign) and again by \S+, "
           r"metric_\w+ is '\S+' once and '\S+' again")
IS_SLOW = 28
NEIGHBOUR = "a-neighbours-campaign"  # its name


def carriers(of):
    """Processes below a process that have a law loaded."""
    found, parents = [], {}
    for folder in pathlib.Path("/proc").iterdir():
        if not folder.name.isdigit():
            continue
        try:
            parents[int(folder.name)] = parent_and_name(folder.name)[0]
            if "dispersa-control-law" in (folder / "maps").read_text():
                found.append(int(folder.name))
        except OSError:
            continue

    def is_below(pid):
        return pid == of or (pid in parents and is_below(parents[pid]))
    return list(filter(is_below, found))


def found_in(pid, secrets):
    """Which secrets are anywhere in a process's memory."""
    found = set()
    with open(f"/proc/{pid}/mem", "rb", 0) as memory:
        for begin, end, rights in re.findall(r"^(\w+)-(\w+) (\S+)", pathlib.Path(f"/proc/{pid}/maps").read_text(), re.MULTILINE):
            try:
                memory.seek(int(begin, 16))
                part = memory.read(int(end, 16) - int(begin, 16)) if "r" in rights else b""
            except (OSError, OverflowError, ValueError):
                continue
            found |= {name for name, forms in secrets.items() if any(form in part for form in forms)}
    return found


class LawsTest(ServiceCase):
    DOMAIN = "37"
    DAEMON = ["--allow-plugins"]

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        include = cls.root / "dispersa"
        include.mkdir()
        shutil.copy(SOURCE / "core/control/control_law.h", include)
        cls.references = {}

    def autopilot(self, behaviour):
        """A PD, of which tests/plugins/law.c says what it does besides."""
        library = self.root / f"law{behaviour}.so"
        subprocess.run(["gcc", "-O2", "-fPIC", "-shared", f"-DDISPERSA_MISBEHAVES={behaviour}", f"-I{self.root}",
                        SOURCE / "tests/plugins/law.c", "-lm", "-o", library], check=True, timeout=PATIENCE_S)
        path = self.root / f"law{behaviour}.yaml"
        path.write_text((SOURCE / "tests/data/brief/pd.yaml").read_text().replace("law: pd", "law: plugin").replace(
            "tick_s:", f"plugin: {{library: {library.name}}}\ntick_s:"))
        return path

    def campaign(self, behaviour):
        """Its run in one process, flown once for all tests, and its file."""
        if behaviour not in self.references:
            self.references[behaviour] = Run(self.root / f"reference{behaviour}", "--workers", 0, "--cases", CASES, "--autopilot",
                                             self.autopilot(behaviour), campaign=CAMPAIGN).finish()
        reference = self.references[behaviour]
        return reference, reference.out / "campaign.yaml"

    def test_a_service_flies_it(self):
        reference, campaign = self.campaign(0)
        self.start_coordinator()
        self.start_worker("--slots", 2)  # alone: nobody else could fly the first cases again
        identity = self.dispersa("launch", campaign).strip()
        self.dispersa("watch", identity, code=reference.code)
        self.assert_same_folder(identity, reference)

    def test_logs_as_json_are_objects_with_their_campaign_and_a_law_prints_no_other_line(self):
        reference, campaign = self.campaign(PRINTS)
        self.start("dispersa-coordinator", "--data", self.data, *self.DAEMON, "--log", "json")
        self.start_worker("--log", "json")
        identity = self.dispersa("launch", campaign).strip()
        self.dispersa("watch", identity, code=reference.code)
        lines = [json.loads(line) for line in self.log.read_text().splitlines()]
        for line in lines:
            self.assertEqual(list(line)[:4], ["time", "level", "program", "message"])
            self.assertLessEqual(set(line), {"time", "level", "program", "message", "campaign", "request"})
        self.assertIn(("dispersa-worker", "info", "a control law prints: a law prints this"),
                      {(line["program"], line["level"], line["message"]) for line in lines})
        of_campaign = [line for line in lines if line["message"].startswith("campaign smoke ")]
        self.assertGreater(len(of_campaign), 2)
        self.assertEqual({line.get("campaign") for line in of_campaign}, {identity})
        launched = next(line for line in of_campaign if "launched by" in line["message"])
        self.assertRegex(launched["request"], r"^launch \d+ of [0-9a-f]{32}$")
        self.assertNotIn("request", next(line for line in lines if " joined: " in line["message"]))

    def test_an_end_is_an_object_of_the_log(self):
        for program, arguments in (("dispersa-coordinator", ["--data", self.data, "--keys", self.data]),
                                   ("dispersa-worker", ["--peer", "127.0.0.1:x"])):
            ended = subprocess.run([BINARIES / program, *arguments, "--log", "json"], capture_output=True, text=True, timeout=PATIENCE_S)
            self.assertEqual(ended.returncode, 2)
            line = json.loads(ended.stderr)
            self.assertEqual((line["level"], line["program"]), ("error", program))

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
        identity = self.launch(campaign)
        self.assertRegex(" ".join(self.dispersa("watch", identity, code=2).split()), REFUSAL)
        self.assertEqual(self.status(identity)["state"], "refused")
        self.assertRegex(self.status(identity)["problem"], REFUSAL)
        self.assertFalse((self.fetch(identity) / "report.html").exists())

    def test_a_worker_refuses_a_law_that_does_not_pass_its_check(self):
        _, campaign = self.campaign(CRASHES_IN_WORKERS)
        self.start_coordinator()
        # Nobody is there to check it: the launch does not wait for ever.
        began = time.monotonic()
        identity = self.dispersa("launch", campaign).strip()
        self.assertEqual(self.error, "waiting for a check\n")
        self.assertTrue(30 <= time.monotonic() - began < 60)
        self.assertEqual((self.status(identity)["state"], self.status(identity)["checked"]), ("flying", False))
        watch = self.start("dispersa", "watch", identity)
        self.start_worker(preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (777, 777)))
        self.assertEqual(watch.wait(timeout=PATIENCE_S), 2)
        words = "the control law pd_test cannot fly the nominal flight: it ended by signal 6"
        self.assertEqual(self.status(identity)["state"], "refused")
        self.assertTrue(self.status(identity)["problem"].startswith(words))
        # Launched again it is checked again; the launch hears of it.
        self.dispersa("launch", campaign, code=2)
        self.assertTrue(self.error.startswith(words), self.error)

    def test_a_run_on_local_workers_is_refused_too(self):
        run = Run(self.root / "refused", "--workers", 2, "--cases", 2000, "--autopilot",
                  self.autopilot(DIFFERS_BY_WORKER), campaign=CAMPAIGN).finish()
        self.assertEqual(run.code, 2, run.stderr)
        self.assertRegex(run.stderr, REFUSAL)
        self.assertNotIn("result:", run.stdout)

    def launch(self, campaign):
        """Its id. The launch waits for the check, and may learn of a refusal."""
        done = subprocess.run([BINARIES / "dispersa", "launch", campaign, *self.NETWORK], capture_output=True, text=True,
                              timeout=PATIENCE_S)
        self.assertIn(done.returncode, (0, 2), done.stderr)
        return hashlib.sha256(campaign.read_bytes()).hexdigest()

    # ---- secrets ----

    def slow_campaign(self, name, autopilot):
        text = re.sub(r"(?m)^autopilot: .*$", f"autopilot: {autopilot}", smoke_text(name))
        path = self.root / f"{name}.yaml"
        path.write_text(text)
        return path

    def keyed(self):
        """The arguments of coordinator, worker and client with keys, and the scalars of both daemons' keys."""
        authority, folders, secrets = self.data / "authority", {}, {}
        subprocess.run([BINARIES / "dispersa", "keys", "init", authority], check=True, capture_output=True)
        for role in ("coordinator", "worker", "client"):
            subprocess.run([BINARIES / "dispersa", "keys", "issue", authority, "--role", role, "--name", "one"], check=True,
                           capture_output=True)
            folders[role] = ["--keys", authority / "issued" / f"{role}-one"]
            key = authority / "issued" / f"{role}-one/identity.key"
            der = subprocess.run(["openssl", "pkey", "-in", key, "-outform", "DER"], check=True, capture_output=True).stdout
            scalar = re.search(b"\x04\x20(.{32})", der, re.DOTALL)[1]
            # As in the file, as a number of limbs, as text.
            if role != "client":
                secrets[role] = (scalar, scalar[::-1], key.read_bytes().splitlines()[2])
        return folders, secrets

    def search_the_memory_of_a_law(self, folders, secrets):
        slow, pd = self.autopilot(IS_SLOW), SOURCE / "campaigns/autopilots/pd.yaml"
        coordinator = self.start("dispersa-coordinator", "--data", self.data, *self.DAEMON, *folders["coordinator"])
        worker = self.start_worker(*folders["worker"])
        self.dispersa("launch", self.slow_campaign(NEIGHBOUR, pd), "--cases", 200000, *folders["client"])
        wait_for(lambda: '"done": 0' not in self.dispersa("list", "--json", *folders["client"]), "the neighbour flies")
        secrets = {**secrets, "neighbour": (NEIGHBOUR.encode(),)}
        # The daemons have them: so the search finds what is there.
        self.assertEqual(found_in(coordinator.pid, secrets), set(secrets) - {"worker"})
        self.assertEqual(found_in(worker.pid, secrets), set(secrets) - {"coordinator"})
        launch = self.start("dispersa", "launch", self.slow_campaign("slow", slow), *folders["client"])
        searched = collections.Counter()

        def is_searched():
            """The client's own look at the law ends at once; the worker's check is there for all ten searches."""
            for pid in carriers(os.getpid()):
                with contextlib.suppress(FileNotFoundError):  # it ended meanwhile
                    self.assertEqual(found_in(pid, secrets), set(), pid)
                    searched[pid] += 1
            return max(searched.values(), default=0) >= 10
        wait_for(is_searched, "a law that runs is searched ten times")
        launch.kill()
        # A check under way keeps nobody from ending.
        coordinator.terminate()
        self.assertEqual(coordinator.wait(timeout=5), 0)

    def test_no_law_finds_a_key_in_its_memory(self):
        self.search_the_memory_of_a_law(*self.keyed())

    def test_no_law_finds_the_users_secret_in_its_memory(self):
        home = pathlib.Path(tempfile.mkdtemp(dir=self.root))
        (home / ".dispersa").mkdir(mode=0o700)
        (home / ".dispersa/secret").touch(mode=0o600)
        (home / ".dispersa/secret").write_bytes(os.urandom(32))
        self.enterContext(unittest.mock.patch.dict(os.environ, HOME=str(home)))
        self.search_the_memory_of_a_law({role: [] for role in ("coordinator", "worker", "client")},
                                        {"user": ((home / ".dispersa/secret").read_bytes(),)})

    def test_without_leave_it_is_refused_on_the_loopback_interface_too(self):
        _, campaign = self.campaign(0)
        words = "plugin.library: the control law is a shared object; this program runs shared objects only with --allow-plugins"
        self.start_coordinator()
        self.start("dispersa-worker", "--peer", "127.0.0.1")
        identity = self.dispersa("launch", campaign).strip()
        wait_for(lambda: self.status(identity)["problem"], "why it does not go on")
        self.assertIn("no worker here can fly it: ", self.status(identity)["problem"])
        self.assertIn(words, self.status(identity)["problem"])

    def test_workers_of_a_run_take_what_its_campaign_names(self):
        run = Run(self.root / "named", "--workers", 2, "--cases", CASES, "--autopilot", self.autopilot(0),
                  campaign=CAMPAIGN).finish()
        reference, _ = self.campaign(0)
        self.assertEqual(run.code, reference.code, run.stderr)
        self.assertEqual((run.out / "cases.csv").read_bytes(), (reference.out / "cases.csv").read_bytes())


if __name__ == "__main__":
    main()
