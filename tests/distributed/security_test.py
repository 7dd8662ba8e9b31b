"""Keys: a signed campaign has the bytes of a run, and each kind of stranger is refused and logged.

Environment as of processes.py; the strangers are security_probe.cc. Each checks first that the same message gets through
where it is allowed, so that a refusal means something.
"""
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import tempfile
import threading
import time

from processes import BINARIES, CAMPAIGN, ISOLATED, PATIENCE_S, Run, content, main, wait_for
from service_case import ServiceCase

PROBE = BINARIES.parent / "tests" / "security_probe"
CASES = 60
ROLES = ("coordinator", "worker", "client", "observer")
EVERYTHING = "<topics><topic>*</topic></topics><partitions><partition>*</partition></partitions>"


def keys(*arguments, code=0):
    done = subprocess.run([BINARIES / "dispersa", "keys", *map(str, arguments)], capture_output=True, text=True,
                          timeout=PATIENCE_S)
    assert done.returncode == code, done.stdout + done.stderr
    return done.stderr if code else pathlib.Path(done.stdout.split(": ", 1)[1].strip())


class Stranger:
    """One security_probe; `leave` ends it and returns what it saw."""

    def __init__(self, log, *arguments):
        self.log = log
        with log.open("w") as out:
            self.process = subprocess.Popen([PROBE, *map(str, arguments)], stdin=subprocess.PIPE, stdout=out)

    def leave(self):
        self.process.communicate(timeout=PATIENCE_S)
        return json.loads(next(line for line in self.log.read_text().splitlines() if line.startswith("{")))


class SecurityTest(ServiceCase):
    DOMAIN = "34"
    CASES = CASES

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.authority, cls.foreign = cls.root / "ours", cls.root / "foreign"
        for authority in (cls.authority, cls.foreign):
            keys("init", authority)
            for role in ROLES:
                keys("issue", authority, "--role", role, "--name", "one")
        keys("issue", cls.authority, "--role", "worker", "--name", "two")
        cls.own_signer = cls.root / "own_signer.pem"  # certificate and key of a stranger
        subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes",
                        "-subj", "/O=stranger", "-out", cls.own_signer, "-keyout", cls.root / "own_signer.key"],
                       check=True, capture_output=True)
        cls.own_signer.write_text(cls.own_signer.read_text() + (cls.root / "own_signer.key").read_text())
        if ISOLATED in os.environ:
            # As on most machines there is another interface, which a program on all of them prefers to loopback.
            for command in ("link add eth0 type veth peer name eth1", "addr add 192.0.2.9/24 dev eth0", "link set eth0 up",
                            "link set eth1 up"):
                subprocess.run(["ip", *command.split()], check=True)

    def setUp(self):
        super().setUp()
        self.log.touch()

    def folder(self, role, name="one", authority=None):
        return (authority or self.authority) / "issued" / f"{role}-{name}"

    def copy(self, role, name="one"):
        return pathlib.Path(shutil.copytree(self.folder(role, name), tempfile.mkdtemp(dir=self.root) + "/keys"))

    def start_coordinator(self):
        return self.start("dispersa-coordinator", "--data", self.data, "--keys", self.folder("coordinator"))

    def start_worker(self, name="one", *arguments):
        return self.start("dispersa-worker", "--peer", "127.0.0.1", "--slots", 2, "--keys", self.folder("worker", name),
                          *arguments)

    def client(self, *arguments, code=0, role="client"):
        return self.dispersa(*arguments, "--keys", self.folder(role), code=code)

    def test_a_worker_does_not_follow_a_coordinator_with_revoked_keys(self):
        keys("issue", self.authority, "--role", "coordinator", "--name", "stolen")
        self.start("dispersa-coordinator", "--data", self.data, "--keys", self.folder("coordinator", "stolen"))
        own = self.copy("worker")
        worker = self.start("dispersa-worker", "--peer", "127.0.0.1", "--keys", own)
        self.client("launch", CAMPAIGN, "--cases", 1000000)
        done = lambda: json.loads(self.client("list", "--json"))["campaigns"][0]["done"]
        wait_for(done, "results")
        shutil.copy(keys("revoke", self.authority, "--role", "coordinator", "--name", "stolen"), own)
        wait_for(lambda: "the keys of this coordinator are revoked" in self.log.read_text(), "what the worker says")
        wait_for(lambda: done() == (time.sleep(2), done())[1], "it flies nothing more")
        self.assertIsNone(worker.poll())

    def stranger(self, *arguments):
        # Of one kind of complaint one a second is logged.
        time.sleep(max(0.0, self.log.stat().st_mtime + 1.5 - time.time()))
        stranger = Stranger(pathlib.Path(tempfile.mkstemp(dir=self.root, prefix="stranger-")[1]), *arguments)
        self.processes.append(stranger.process)
        return stranger

    def wait_logged(self, pattern):
        try:
            wait_for(lambda: re.search(pattern, self.log.read_text()), pattern)
        except AssertionError as error:
            raise AssertionError(f"{error}; logged is:\n{self.log.read_text()[-3000:]}") from None

    @staticmethod
    def forge_permissions(folder, certificate, key):
        """The folder's permissions with everything allowed and signed by another, whom the folder's owner believes."""
        document = subprocess.run(["openssl", "smime", "-verify", "-text", "-in", folder / "permissions.p7s", "-CAfile",
                                   folder / "permissions_ca.pem"], check=True, capture_output=True, text=True).stdout
        rules = (f"<allow_rule><domains><id_range><min>0</min><max>99</max></id_range></domains><publish>{EVERYTHING}"
                 f"</publish><subscribe>{EVERYTHING}</subscribe></allow_rule>")
        document = re.sub("<allow_rule>.*</allow_rule>", rules, document, flags=re.DOTALL)
        (folder / "permissions.xml").write_text(document)
        forged = folder / "forged.p7s"
        subprocess.run(["openssl", "smime", "-sign", "-text", "-in", folder / "permissions.xml", "-out", forged,
                        "-signer", certificate, "-inkey", key], check=True, capture_output=True)
        with (folder / "permissions_ca.pem").open("a") as believed:
            believed.write(pathlib.Path(certificate).read_text())
        return forged

    def that_lies_to_itself(self, role, name="one"):
        """Genuine keys of a stranger whose own middleware does not hold it back.

        The middleware reads the permissions twice: to obey them, then to show them to others. Here the first reading
        gets forged ones that allow everything, and the second the genuine ones.
        """
        folder = self.copy(role, name)
        shown, genuine = folder / "permissions.p7s", folder / "genuine.p7s"
        forged = self.forge_permissions(folder, self.own_signer, self.own_signer)
        shown.rename(genuine)
        os.mkfifo(shown)

        def serve():
            with shown.open("wb") as out:  # waits for the first reading to begin
                genuine.replace(shown)
                out.write(forged.read_bytes())
        threading.Thread(target=serve, daemon=True).start()
        return folder

    def test_a_signed_campaign_has_the_bytes_of_a_run_and_restarts_do_no_harm(self):
        coordinator = self.start_coordinator()
        self.start_worker()
        identity = self.client("launch", CAMPAIGN, "--cases", CASES).strip()
        wait_for(lambda: json.loads(self.client("status", identity, "--json"))["campaigns"][0]["done"] > 0, "a result")
        coordinator.send_signal(signal.SIGKILL)
        coordinator.wait()
        self.start_coordinator()
        self.start_worker("two")
        self.client("watch", identity, code=self.reference.code)
        out = self.root / "signed"
        self.client("fetch", identity, "--out", out)
        for name in ("cases.csv", "summary.json", "report.html", "campaign.yaml"):
            self.assertEqual(content(out, name), content(self.reference.out, name), name)
        wait_for(lambda: len(json.loads(self.client("status", "--json"))["workers"]) == 2, "both workers")
        names = {w["id"].partition("_")[0] for w in json.loads(self.client("status", "--json"))["workers"]}
        self.assertEqual(names, {"one", "two"})
        for role in ("coordinator", "client"):
            self.assertEqual(subprocess.run([BINARIES / "dispersa-coordinator", "--health", *self.NETWORK, "--keys",
                                             self.folder(role)], timeout=PATIENCE_S).returncode, 0)
        self.assertNotIn("refused", self.log.read_text())

    # Each stranger stays until the coordinator has logged its refusal; had it been let in, it would have matched by then.
    def assert_refused(self, pattern, *arguments):
        stranger = self.stranger(*arguments)
        try:
            self.wait_logged(pattern)
        finally:
            seen = stranger.leave()
        self.assertEqual((seen["created"], seen["matched"]), (True, 0), seen)

    def assert_let_in(self, *arguments, logged):
        stranger = self.stranger(*arguments)
        try:
            self.wait_logged(logged)
        finally:
            seen = stranger.leave()
        self.assertGreater(seen["matched"], 0, seen)

    def publish(self, topic, name, *arguments):
        return ["publish", f"dispersa/{topic}", f"w{name}" if name else "", self.DOMAIN, "--named", name or "nobody", *arguments]

    def test_who_has_no_keys_of_this_authority_is_refused(self):
        self.start_coordinator()
        self.assert_let_in(*self.publish("WorkerStatusV2", "one_good", "--keys", self.folder("worker")),
                           logged="worker one_good joined")
        self.assert_refused("participant from [0-9a-f]{24}( at 127.0.0.1)? is refused: it has no keys",
                            *self.publish("WorkerStatusV2", "one_unsigned"))
        # The foreign authority has the same names.
        self.assert_refused("participant from [0-9a-f]{24}.* is refused: its keys are of another authority, expired or damaged",
                            *self.publish("WorkerStatusV2", "one_foreign", "--keys", self.folder("worker", authority=self.foreign)))
        self.assertNotRegex(self.log.read_text(), "one_(unsigned|foreign) joined")

    def test_keys_that_have_expired_are_refused_by_the_others(self):
        subprocess.run([PROBE, "issue", self.authority, "worker", "expired", "-20", "-4"], check=True, timeout=PATIENCE_S)
        self.start_coordinator()
        self.assert_refused("is refused: its keys are of another authority, expired or damaged",
                            *self.publish("WorkerStatusV2", "expired_a", "--keys", self.folder("worker", "expired"),
                                          "--hours-ago", 12))

    def test_a_role_says_what_it_may_and_nothing_else(self):
        self.start_coordinator()
        # By its own middleware already.
        honest = self.stranger(*self.publish("ReportV3", "", "--keys", self.folder("observer"))).leave()
        self.assertEqual((honest["created"], honest["problem"]),
                         (False, "cannot create a writer of dispersa/ReportV3; if the keys are of an older release, issue them again"))
        # And by the coordinator's, if its own does not mind.
        for role, topic, name in (("observer", "ReportV3", ""), ("observer", "RequestV1", "one_a"), ("client", "ReportV3", "one_b"),
                                  ("worker", "RequestV1", "one_c")):
            with self.subTest(role=role, topic=topic):
                self.assert_refused(rf"Error checking create remote writer .*dispersa/{topic} topic not found in allow rule",
                                    *self.publish(topic, name, "--keys", self.that_lies_to_itself(role)))

    def test_a_worker_speaks_for_itself_alone(self):
        self.start_coordinator()
        self.assert_refused("Error checking create remote writer .*wtwo_a partition not found in rule",
                            *self.publish("WorkerStatusV2", "two_a", "--keys", self.that_lies_to_itself("worker")))
        # In its own partition with another's name.
        self.assert_let_in("publish", "dispersa/WorkerStatusV2", "wone_b", self.DOMAIN, "--named", "two_b", "--keys",
                           self.folder("worker"),
                           logged="WorkerStatusV2 from [0-9a-f]{24} is refused: it names a worker or client that its keys are not for")
        self.assertNotIn("joined", self.log.read_text())

    def test_nobody_signs_permissions_for_himself(self):
        self.start_coordinator()
        # With the key of his identity, which the authority of identities has signed.
        own = self.copy("worker")
        forged = self.forge_permissions(own, own / "identity.pem", own / "identity.key")
        with (own / "permissions_ca.pem").open("a") as believed:
            believed.write((own / "identity_ca.pem").read_text())
        # With an authority of his own that has the same name.
        other, foreign = self.copy("observer"), self.foreign / "authority"
        forged_by_other = self.forge_permissions(other, foreign / "permissions_ca.pem", foreign / "permissions_ca.key")
        for name in ("permissions_ca.pem", "governance.p7s"):
            shutil.copy(foreign / name, other / name)
        for folder, permissions in ((own, forged), (other, forged_by_other)):
            permissions.replace(folder / "permissions.p7s")
            before = self.log.read_text().count("Error validating remote permissions")
            stranger = self.stranger(*self.publish("ReportV3", "", "--keys", folder))
            wait_for(lambda: self.log.read_text().count("Error validating remote permissions") > before, "refusal")
            seen = stranger.leave()
            self.assertEqual((seen["created"], seen["matched"]), (True, 0))

    def as_client(self, name, *arguments, code=0):
        """Standard output, or what it says of its refusal."""
        done = subprocess.run([BINARIES / "dispersa", *map(str, arguments), *self.NETWORK, "--keys",
                               self.folder("client", name)], capture_output=True, text=True, timeout=3 * PATIENCE_S)
        self.assertEqual(done.returncode, code, f"{done.stdout}{done.stderr}\n{self.log.read_text()[-3000:]}")
        return done.stderr if code else done.stdout

    def test_a_campaign_belongs_to_the_keys_that_launched_it(self):
        for name, may in (("ann", ["--may", "run"]), ("bob", []), ("eve", ["--may", "read"]), ("ops", ["--may", "administer"])):
            keys("issue", self.authority, "--role", "client", "--name", name, *may)
        self.assertIn("--may read with --role worker, allowed: --may with --role client",
                      keys("issue", self.authority, "--role", "worker", "--name", "x", "--may", "read", code=2))
        self.start("dispersa-coordinator", "--data", self.data, "--keys", self.folder("coordinator"), "--quota", "campaigns=1")
        campaign = [CAMPAIGN, "--cases", "3"]
        identity = self.as_client("ann", "launch", *campaign, "--label", "commit=1a2b").strip()
        short = identity[:8]
        listed = json.loads(self.as_client("eve", "list", "--json"))["campaigns"][0]
        self.assertEqual((listed["owner"], listed["labels"]), ("ann", ["commit=1a2b"]))
        self.assertIn("  of ann", self.as_client("eve", "list"))
        self.assertIn("  of ann", self.as_client("bob", "status", identity))
        for name, may, change in (("bob", "run", "cancel"), ("bob", "run", "delete"), ("eve", "read", "cancel")):
            self.assertIn(f"campaign {short} belongs to 'ann': the keys of '{name}' may {may} and cannot {change} it, allowed: ",
                          self.as_client(name, change, identity, code=2))
        self.assertIn("the keys of 'eve' may read, and `dispersa launch` needs the right to run",
                      self.as_client("eve", "launch", *campaign, code=2))
        self.assertIn("`dispersa backup` needs the right to administer",
                      self.as_client("bob", "backup", self.root / "no-backup", code=2))
        self.assertIn("'ann' would have 2 campaigns that have not ended, allowed: at most 1",
                      self.as_client("ann", "launch", CAMPAIGN, "--cases", 4, code=2))
        self.assertIn("cannot change the priority of it", self.as_client("bob", "launch", *campaign, "--priority", 3, code=2))
        self.assertEqual(self.as_client("bob", "launch", *campaign).strip(), identity)
        # Its own middleware lets it speak as an administrator; the coordinator's does not.
        copy = self.that_lies_to_itself("client", "eve")
        self.assert_refused("Error checking create remote writer .*w_administer_eve_1 partition not found in rule",
                            *self.publish("RequestV1", "_administer_eve_1", "--keys", copy))
        self.as_client("ops", "cancel", identity)
        self.as_client("ann", "launch", *campaign)
        self.start_worker()
        three = Run(self.root / "alone" / "three", "--workers", 0, "--cases", 3).finish()
        self.as_client("eve", "watch", identity, "--quiet", code=three.code)
        self.as_client("eve", "fetch", identity, "--out", self.root / "of-ann")
        self.assertEqual(content(self.root / "of-ann", "cases.csv"), content(three.out, "cases.csv"))
        self.assertEqual(self.as_client("ops", "backup", self.root / "backup").strip(),
                         f"backup of 1 campaign: {self.root / 'backup'}")
        self.as_client("ann", "delete", identity)

    def test_a_worker_gives_no_orders(self):
        worker = self.start_worker("two", "--uuid", "x")
        orders = [*self.publish("OrdersV1", "two_x"), "--as-coordinator", "--keys"]  # to leave
        self.assert_refused("Error checking create remote writer .*dispersa/OrdersV1 topic not found in allow rule",
                            *orders, self.that_lies_to_itself("worker"))
        self.assertIsNone(worker.poll())
        coordinator = self.stranger(*orders, self.folder("coordinator"))
        self.assertEqual(worker.wait(timeout=PATIENCE_S), 0)
        self.assertEqual(coordinator.leave()["matched"], 1)

    def test_an_observer_hears_results_and_nothing_else_and_says_nothing(self):
        hear = ["subscribe", "dispersa/ResultV2", "", self.DOMAIN, "--keys"]
        # Another observer, in the coordinator's place, is who could be told made-up results.
        listening = self.stranger(*hear, self.folder("observer"), "--as-coordinator")
        lying = self.stranger(*self.publish("ResultV2", "", "--keys", self.that_lies_to_itself("observer")))
        wait_for(lambda: re.search("Error checking create remote writer .*dispersa/ResultV2 topic not found in allow rule",
                                   listening.log.read_text()), "refusal")
        self.assertEqual((lying.leave()["matched"], listening.leave()["matched"]), (0, 0))

        self.start_coordinator()
        results = self.stranger(*hear, self.folder("observer"))
        progress = self.stranger("subscribe", "dispersa/ProgressV1", "", self.DOMAIN, "--keys", self.folder("observer"))
        self.start_worker()
        self.start_worker("two", "--uuid", "x")
        self.wait_logged("worker two_x joined")
        reports = self.stranger("subscribe", "dispersa/OrdersV1", "wtwo_x", self.DOMAIN, "--keys", self.that_lies_to_itself("observer"))
        self.wait_logged("Error checking create remote reader .*dispersa/OrdersV1 topic not found in allow rule")
        orders = self.stranger("subscribe", "dispersa/OrdersV1", "wtwo_x", self.DOMAIN, "--keys", self.that_lies_to_itself("worker"))
        self.wait_logged("Error checking create remote reader .*wtwo_x partition not found in rule")
        for observer in (results, progress):
            wait_for(lambda: "matched\n" in observer.log.read_text(), "an observer who hears")
        identity = self.client("launch", CAMPAIGN, "--cases", CASES).strip()
        self.client("watch", identity, code=self.reference.code)
        self.assertEqual([each.leave()["samples"] for each in (reports, orders)], [0, 0])
        self.assertGreater(results.leave()["samples"], 0)
        self.assertGreater(progress.leave()["samples"], 0)

    def start_error(self, program, *arguments):
        """What a program that must not start says."""
        done = subprocess.run([BINARIES / program, *map(str, arguments)], capture_output=True, text=True, timeout=PATIENCE_S)
        self.assertEqual(done.returncode, 2, done.stderr)
        return done.stderr

    def test_damaged_or_wrong_keys_are_told(self):
        def with_change(file, change):
            folder = self.copy("worker")
            change(folder / file)
            return folder
        subprocess.run([PROBE, "issue", self.authority, "worker", "past", "-20", "-4"], check=True, timeout=PATIENCE_S)
        subprocess.run([PROBE, "issue", self.authority, "worker", "future", "4", "30"], check=True, timeout=PATIENCE_S)
        how = "give a folder that `dispersa keys issue` made"

        def take(other, authority=None):
            return lambda file: shutil.copy(self.folder(other, authority=authority) / file.name, file)
        for folder, problem in (
            (self.root / "none", f"none: no folder: {how}"),
            (self.authority, f"ours: the folder of the authority, which signs and does not speak: give one of {self.authority}/issued"),
            (self.folder("observer"), "keys of the observer 'one'; here those of a worker are needed"),
            (self.folder("coordinator"), "keys of the coordinator 'one'; here those of a worker are needed"),
            (self.folder("worker", "past"), r"identity.pem: expired on \d{4}-\d\d-\d\d \d\d:\d\d UTC: issue new keys"),
            (self.folder("worker", "future"), r"identity.pem: is valid from \d{4}-.* UTC on: the clock of this machine may be wrong"),
            (with_change("identity.key", pathlib.Path.unlink), "identity.key: file not found, allowed: a folder with all files that `dispersa keys issue` made"),
            (with_change("identity.pem", lambda file: file.write_text("x")), "identity.pem: no certificate in PEM"),
            (with_change("identity.key", take("observer")), "identity.key: not the key of identity.pem"),
            (with_change("identity_ca.pem", take("worker", self.foreign)), "identity.pem: not signed by identity_ca.pem"),
            (with_change("permissions.p7s", take("observer")), "permissions.p7s: not the permissions of the owner of identity.pem"),
            (with_change("permissions.p7s", lambda file: file.write_text(file.read_text().replace("ReportV3", "OrdersV1"))),
             "permissions.p7s: the signature does not fit: damaged, or of another authority"),
            (with_change("governance.p7s", take("worker", self.foreign)),
             "governance.p7s: the signature does not fit: damaged, or of another authority"),
        ):
            with self.subTest(problem=problem):
                self.assertRegex(self.start_error("dispersa-worker", "--peer", "127.0.0.1", "--domain", self.DOMAIN, "--keys", folder),
                                 f"{problem}\n$")
        for program, arguments in (("dispersa-coordinator", ["--data", self.data]), ("dispersa", ["list"])):
            self.assertIn("keys of the worker 'one'; here those of a", self.start_error(program, *arguments, "--keys", self.folder("worker")))

    def test_an_authority_overwrites_nothing(self):
        before = {path: path.read_bytes() for path in self.authority.rglob("*") if path.is_file()}
        self.assertEqual(keys("init", self.authority, code=2),
                         f"{self.authority}/authority: there is an authority already, and it is not overwritten, allowed: another folder\n")
        self.assertEqual(keys("issue", self.authority, "--role", "worker", "--name", "one", code=2),
                         f"{self.folder('worker')}: these keys exist already and are not overwritten, allowed: another name, or to "
                         "remove the folder first\n")
        for name in ("a_b", "a/b", "-a", ".", "a" * 32):
            self.assertEqual(keys("issue", self.authority, "--role", "worker", f"--name={name}", code=2),
                             f"'{name}' cannot be the name of keys, allowed: 1 to 31 letters, digits and '-', the first no '-'\n")
        self.assertIn("the authority is valid for fewer days than the keys would be",
                      keys("issue", self.authority, "--role", "worker", "--name", "late", "--days", 5000, code=2))
        self.assertEqual(keys("issue", self.root, "--role", "worker", "--name", "a", code=2),
                         f"{self.root}: no authority, allowed: a folder that `dispersa keys init` made\n")
        self.assertEqual({path: path.read_bytes() for path in self.authority.rglob("*") if path.is_file()}, before)
        for path in self.authority.rglob("*"):
            if path.suffix == ".key":
                self.assertEqual(path.stat().st_mode & 0o777, 0o600, path)
        # Nothing secret of the authority leaves it.
        secrets = [path.read_text().splitlines()[1] for path in (self.authority / "authority").glob("*.key")]
        for path in (self.authority / "issued").rglob("*"):
            for secret in secrets:
                self.assertFalse(path.is_file() and secret in path.read_text(), path)

    def test_beyond_loopback_only_with_keys(self):
        for program, arguments in (
            ("dispersa-coordinator", ["--data", self.data]),
            ("dispersa-coordinator", ["--data", self.data, "--address", "10.1.2.3"]),
            ("dispersa-coordinator", ["--health", "--address", "10.1.2.3"]),
            ("dispersa-worker", ["--peer", "10.1.2.3"]),
            ("dispersa-worker", ["--peer", "127.0.0.1", "--address", "10.1.2.3"]),
            ("dispersa-worker", ["--peer", "10.1.2.3", "--address", "127.0.0.1"]),
            ("dispersa", ["list", "--peer", "127.0.0.1.example.org"]),
            ("dispersa", ["watch", "0", "--address", "10.1.2.3"]),
        ):
            with self.subTest(program=program, arguments=arguments):
                self.assertIn("a network beyond this machine needs keys, allowed: --keys DIR with a folder that "
                              "`dispersa keys issue` made, --address 127.0.0.1 for this machine alone, or --insecure on a "
                              "network that you trust\n", self.start_error(program, *arguments, "--domain", self.DOMAIN))
        self.assertIn("--keys and --insecure exclude each other",
                      self.start_error("dispersa", "list", "--insecure", "--keys", self.folder("client")))

    def run_without_address(self, program, *arguments):
        with self.log.open("a") as log:
            self.processes.append(subprocess.Popen([BINARIES / program, *map(str, arguments), "--domain", self.DOMAIN],
                                                   stdout=log, stderr=log))
        return self.processes[-1]

    def assert_worker_is_listed(self, *arguments):
        def listed():
            done = subprocess.run([BINARIES / "dispersa", "status", "--domain", self.DOMAIN, *map(str, arguments)],
                                  capture_output=True, text=True, timeout=PATIENCE_S)
            return "worker " in done.stdout
        wait_for(listed, "a worker")

    def test_a_peer_on_this_machine_means_the_loopback_interface(self):
        self.run_without_address("dispersa-coordinator", "--data", self.data, "--address", "127.0.0.1")
        self.run_without_address("dispersa-worker", "--peer", "localhost")
        self.assert_worker_is_listed()
        self.assertNotIn("no keys", self.log.read_text())

    def test_insecure_is_said_and_warned_of(self):
        self.run_without_address("dispersa-coordinator", "--data", self.data, "--insecure")
        self.wait_logged(r"\[warning\] no keys \(--insecure\): everyone on this network can read, join and forge")
        self.run_without_address("dispersa-worker", "--peer", "127.0.0.1", "--insecure")
        self.assert_worker_is_listed("--insecure")

    def test_keys_on_all_interfaces(self):
        self.run_without_address("dispersa-coordinator", "--data", self.data, "--keys", self.folder("coordinator"))
        self.run_without_address("dispersa-worker", "--peer", "127.0.0.1", "--keys", self.folder("worker"))
        self.assert_worker_is_listed("--keys", self.folder("client"))
        # Who forgot his keys is told so: by the coordinator's greeting, which Fast DDS 3 does not send him, or by its absence.
        forgot = subprocess.run([BINARIES / "dispersa", "list", "--insecure", "--domain", self.DOMAIN], capture_output=True, text=True, timeout=PATIENCE_S)
        self.assertEqual(forgot.returncode, 5)
        self.assertRegex(forgot.stderr, r"is refused: it has keys, and we have none to show \(--keys\)|"
                                        r"a coordinator with keys answers only clients with keys \(--keys\)")


if __name__ == "__main__":
    main()
