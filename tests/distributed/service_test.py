"""A coordinator with --data and its clients: launched campaigns end with the bytes of a run, also if any process is
killed.

Environment as of processes.py.
"""
import json
import signal
import socket
import subprocess

from processes import BINARIES, CAMPAIGN, LOST_CODE, PATIENCE_S, SMOKE, Run, main, stored, wait_for
from service_case import ServiceCase

CASES = 60
MORE = 300


class ServiceTest(ServiceCase):
    DOMAIN = "36"
    CASES = CASES

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.more_reference = Run(cls.root / "more", "--workers", 0, "--cases", MORE).finish()

    def test_launch_watch_fetch(self):
        self.start_coordinator()
        self.start_worker("--slots", 2)
        identity = self.dispersa("launch", CAMPAIGN, "--cases", CASES).strip()
        self.assertRegex(identity, "^[0-9a-f]{64}$")
        self.dispersa("watch", identity[:10], code=self.reference.code)
        out = self.assert_same_folder(identity, self.reference)
        self.assertEqual(subprocess.run([BINARIES / "dispersa", "replay", out, "--case", "1", "--quiet"],
                                        stdout=subprocess.DEVNULL).returncode, 0)
        status = json.loads(self.dispersa("status", "--json"))
        self.assertEqual(status["schema"], "dispersa/status/1")
        campaign = status["campaigns"][0]
        self.assertEqual({k: campaign[k] for k in ("id", "name", "state", "done", "total", "quarantined")},
                         {"id": identity, "name": "smoke", "state": "done", "done": CASES, "total": CASES, "quarantined": 0})
        self.assertEqual([(w["slots"], w["state"]) for w in status["workers"]], [(2, "ready")])
        # The same again is there already.
        self.assertEqual(self.dispersa("launch", CAMPAIGN, "--cases", CASES).strip(), identity)
        self.assertEqual(self.status(identity)["state"], "done")
        self.assertEqual(subprocess.run([BINARIES / "dispersa-coordinator", "--health", *self.NETWORK]).returncode, 0)

    def test_more_cases_of_the_same_flights_take_over_what_is_flown(self):
        self.start_coordinator()
        worker = self.start_worker()
        few = self.dispersa("launch", CAMPAIGN, "--cases", CASES // 2).strip()
        self.dispersa("watch", few, code=LOST_CODE)
        many = self.dispersa("launch", CAMPAIGN, "--cases", CASES).strip()
        self.assertNotEqual(few, many)
        self.dispersa("watch", many, code=self.reference.code)
        self.assert_same_folder(many, self.reference)
        flown = json.loads(self.dispersa("status", "--json"))["workers"][0]["flown"]
        self.assertEqual(flown, CASES, "half of them twice?")
        worker.send_signal(signal.SIGTERM)
        self.assertEqual(worker.wait(timeout=PATIENCE_S), 0)

    def test_a_domain_whose_ports_are_all_taken_works_through_others(self):
        first = 7400 + 250 * int(self.DOMAIN)
        taken = []
        for port in range(first + 10, first + 250):
            taken.append(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
            taken[-1].bind(("127.0.0.1", port))
            self.addCleanup(taken[-1].close)
        self.start_coordinator()
        self.start_worker()
        identity = self.dispersa("launch", CAMPAIGN, "--cases", MORE).strip()
        self.assertIn(f"UDP ports {first + 10} to {first + 217} are all taken; port ", self.error)
        self.dispersa("watch", identity, code=self.more_reference.code)
        self.assertEqual(subprocess.run([BINARIES / "dispersa-coordinator", "--health", *self.NETWORK]).returncode, 0)

    def test_cancel_keeps_what_was_flown_and_launch_goes_on(self):
        self.start_coordinator()
        identity = self.dispersa("launch", CAMPAIGN, "--cases", CASES).strip()
        self.assertIn("no workers", self.dispersa("status"))
        self.dispersa("fetch", identity, "--out", self.root / "none", code=5)
        self.assertRegex(self.error, "^campaign [0-9a-f]{8} is (waiting|flying): its results can be fetched when it has ended\n$")
        self.dispersa("cancel", identity)
        self.assertEqual(self.status(identity)["state"], "cancelled")
        self.dispersa("watch", identity, code=5)
        self.dispersa("launch", CAMPAIGN, "--cases", CASES)
        self.start_worker("--slots", 2)
        self.dispersa("watch", identity, code=self.reference.code)
        self.assert_same_folder(identity, self.reference)
        self.dispersa("cancel", identity, code=2)
        self.assertEqual(self.error, f"campaign {identity[:8]} is done and cannot be cancelled\n")
        self.dispersa("status", "zz", code=2)
        self.assertEqual(self.error, "no campaign, or more than one, has the id 'zz'\n")

    def test_elastic_workers(self):
        # A worker that is there before the coordinator waits for it and says so.
        worker = self.start_worker("--idle-exit", 15)  # a busy machine may take seconds to launch
        lost = subprocess.run([BINARIES / "dispersa-worker", "--peer", "127.0.0.1", "--patience", "1", *self.NETWORK],
                              capture_output=True, text=True, timeout=PATIENCE_S)
        self.assertEqual(lost.returncode, 5)
        self.assertIn("no coordinator has answered at 127.0.0.1:16405 for 1 s; the worker ends", lost.stderr)
        self.start_coordinator()
        identity = self.dispersa("launch", CAMPAIGN, "--cases", MORE).strip()
        self.dispersa("watch", identity, code=self.more_reference.code)
        self.assertEqual(worker.wait(timeout=PATIENCE_S), 0, "idle")

    def test_daemons_that_cannot_go_on_say_so_as_an_object(self):
        self.start_coordinator()
        wait_for(lambda: subprocess.run([BINARIES / "dispersa-coordinator", "--health", *self.NETWORK],
                                        stderr=subprocess.DEVNULL).returncode == 0, "health")
        busy = socket.create_server(("127.0.0.1", 0))
        self.addCleanup(busy.close)
        other, here = ["--domain", "35", "--address", "127.0.0.1"], ["--address", "127.0.0.1"]
        coordinator, worker = "dispersa-coordinator", "dispersa-worker"
        for code, words, *command in (
                (2, "another dispersa process is writing", coordinator, "--data", self.data, *other),
                (2, "UDP port", coordinator, "--data", self.root / "more", *self.NETWORK),
                (2, "metrics: port", coordinator, "--data", self.root / "more", "--metrics", busy.getsockname()[1], *other),
                (2, "give one of --data, --health and --drain", coordinator, *other),
                (2, "give one of --data, --health and --drain", coordinator, "--data", self.root / "more", "--health", *other),
                (2, "needs keys", coordinator, "--data", self.root / "more"),
                (5, "does not answer", coordinator, "--health", *other),
                (2, "peer '127.0.0.1:x'", worker, "--peer", "127.0.0.1:x", *here),
                (2, "needs keys", worker, "--peer", "192.0.2.1"),
                (5, "no coordinator has answered", worker, "--peer", "127.0.0.1", "--patience", 1, *other)):
            with self.subTest(words=words):
                ended = subprocess.run([BINARIES / command[0], *map(str, command[1:]), "--json"], capture_output=True,
                                       text=True, timeout=PATIENCE_S)
                self.assertEqual(ended.returncode, code, ended.stderr)
                error = json.loads(ended.stdout)
                self.assertEqual((error["schema"], error["code"]), ("dispersa/error/1", code))
                first = next(each for each in error["errors"] if words in each["path"] + each["message"])
                self.assertIn(first["message"], ended.stderr)

    def test_several_clients_at_once_and_one_that_dies(self):
        self.start_coordinator()
        commands = [[BINARIES / "dispersa", "launch", CAMPAIGN, "--cases", str(cases), *self.NETWORK]
                    for cases in (CASES, MORE, CASES, 200)]
        clients = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for command in commands]
        ids = [client.communicate(timeout=PATIENCE_S)[0].strip() for client in clients]
        self.assertEqual([client.returncode for client in clients], [0, 0, 0, 0])
        self.assertEqual(ids[0], ids[2], "the same campaign is one campaign")
        self.assertEqual(len(set(ids)), 3)
        watchers = [self.start("dispersa", "watch", identity) for identity in ids]
        dying = self.start("dispersa", "launch", CAMPAIGN, "--cases", 250)
        for process in (dying, watchers[0]):
            process.kill()
            process.wait()
        self.start_worker("--slots", 2)
        self.assertEqual([watcher.wait(timeout=PATIENCE_S) for watcher in watchers[1:3]],
                         [self.more_reference.code, self.reference.code])
        self.assert_same_folder(ids[0], self.reference)
        self.assert_same_folder(ids[1], self.more_reference)

    def test_a_higher_priority_goes_first_and_the_standings_show(self):
        self.start_coordinator()
        low = self.dispersa("launch", SMOKE, "--cases", 20000).strip()
        high = self.dispersa("launch", CAMPAIGN, "--cases", MORE, "--priority", 3).strip()
        self.start_worker("--slots", 2)
        # When the last case of the one is stored, little was flown of the other; while the first gets its report, more is.
        wait_for(lambda: self.status(high)["done"] == MORE, "all cases of the first")
        self.assertLess(self.status(low)["done"], 2000)
        self.dispersa("watch", high, code=self.more_reference.code)
        campaigns = {c["id"]: c for c in json.loads(self.dispersa("list", "--json"))["campaigns"]}
        self.assertEqual((campaigns[high]["priority"], campaigns[low]["priority"]), (3, 0))
        self.assertEqual((campaigns[high]["state"], campaigns[low]["state"]), ("done", "flying"))
        wait_for(lambda: self.status(low)["done"] > 0, "first results")
        campaign = self.status(low)
        for standing in campaign["requirements"]:
            self.assertLessEqual(standing["failures"], standing["n"])
            self.assertGreater(standing["n"], 0)
            self.assertIn(standing["so_far"], ("pass", "fail", "inconclusive", "study"))
        self.assertEqual({r["metric"] for r in campaign["requirements"]},
                         {r["metric"] for r in json.loads((self.reference.out / "summary.json").read_text())["requirements"]})
        self.assertRegex(self.dispersa("status", low), rf"(?m)^{low[:12]}  flying +\d+/20000 +20\d\d-\d\d-\d\d \d\d:\d\dZ  smoke\b")
        self.dispersa("cancel", low)
        out = self.root / "cancelled"
        self.dispersa("fetch", low, "--out", out)
        self.assertEqual(stored(out), self.status(low)["done"])

    def test_without_a_coordinator_a_client_says_so(self):
        done = subprocess.run([BINARIES / "dispersa", "list", *self.NETWORK], capture_output=True, text=True, timeout=PATIENCE_S)
        self.assertEqual(done.returncode, 5)
        self.assertEqual(done.stderr, "no coordinator has answered at 127.0.0.1:16405 for 15 s; a coordinator with keys answers only clients with keys (--keys), one without keys only clients of its own user\n")


if __name__ == "__main__":
    main()
