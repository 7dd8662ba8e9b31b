"""Keys are renewed while a service runs: another authority beside the old one, one program after the other, then without the old
one. Keys are revoked by their serial, and their name is issued again.

Environment as of processes.py.
"""
import json
import shutil
import subprocess
import time

from processes import BINARIES, BRIEF, PATIENCE_S, main, wait_for
from security_test import keys
from service_case import ServiceCase

AUTHORITIES = ("identity_ca.pem", "permissions_ca.pem")


class KeysRenewalTest(ServiceCase):
    DOMAIN = "33"

    def setUp(self):
        super().setUp()
        self.log.touch()
        self.authority = self.data / "authority"
        keys("init", self.authority)

    def issue(self, role, name):
        """A copy of new keys, as on their machine, and their folder at the authority, which makes room for others."""
        folder = keys("issue", self.authority, "--role", role, "--name", name)
        copy = self.data / f"{role}-{name}-{time.monotonic_ns()}"
        shutil.copytree(folder, copy)
        shutil.rmtree(folder)
        return copy

    def take_authorities(self, *folders):
        for folder in folders:
            for file in AUTHORITIES:
                shutil.copy(self.authority / "authority" / file, folder)

    def start_with(self, program, folder):
        arguments = {"dispersa-coordinator": ["--data", self.data / "campaigns"], "dispersa-worker": ["--peer", "127.0.0.1"]}[program]
        return self.start(program, *arguments, "--keys", folder)

    def end(self, *processes):
        for process in processes:
            process.terminate()
        for process in processes:
            self.assertEqual(process.wait(timeout=PATIENCE_S), 0)

    def workers(self, client):
        status = json.loads(self.dispersa("status", "--json", "--keys", client))
        return sorted(worker["id"].partition("_")[0] for worker in status["workers"])

    def wait_for_workers(self, client, *names):
        wait_for(lambda: self.workers(client) == list(names), f"the workers {names}")

    def test_an_authority_is_renewed_step_by_step(self):
        coordinator, one, two, ann = (self.issue(role, name) for role, name in
                                      (("coordinator", "main"), ("worker", "one"), ("worker", "two"), ("client", "ann")))
        serving = self.start_with("dispersa-coordinator", coordinator)
        flying = [self.start_with("dispersa-worker", one), self.start_with("dispersa-worker", two)]
        self.wait_for_workers(ann, "one", "two")
        identity = self.dispersa("launch", BRIEF, "--cases", 1000000, "--keys", ann).strip()
        keys("renew", self.authority)
        # Both authorities for the coordinator, while the workers know the old one alone.
        self.take_authorities(coordinator)
        self.end(serving)
        serving = self.start_with("dispersa-coordinator", coordinator)
        self.wait_for_workers(ann, "one", "two")
        # New keys beside old ones, with both authorities everywhere.
        self.take_authorities(one, two, ann)
        self.end(*flying)
        new_two, new_ann, new_coordinator = self.issue("worker", "two"), self.issue("client", "ann"), self.issue("coordinator", "main")
        flying = [self.start_with("dispersa-worker", one), self.start_with("dispersa-worker", new_two)]
        for client in (ann, new_ann):
            self.wait_for_workers(client, "one", "two")
        self.end(serving)
        serving = self.start_with("dispersa-coordinator", new_coordinator)
        for client in (ann, new_ann):
            self.wait_for_workers(client, "one", "two")
        done = self.status_of(identity, new_ann)["done"]
        wait_for(lambda: self.status_of(identity, new_ann)["done"] > done, "more results")
        # Without the old authority, first here and then there: old keys are strangers, new ones meet whoever still believes both.
        keys("retire", self.authority)
        self.take_authorities(new_coordinator)
        self.end(serving)
        serving = self.start_with("dispersa-coordinator", new_coordinator)
        self.wait_for_workers(new_ann, "two")
        self.take_authorities(new_two, new_ann)
        self.end(flying[1])
        self.start_with("dispersa-worker", new_two)
        wait_for(lambda: "two" in self.workers(new_ann), "the worker with the new authority")
        time.sleep(5)
        self.assertNotIn("one", self.workers(new_ann))
        self.dispersa("list", "--keys", ann, code=5)
        self.assertEqual(self.status_of(identity, new_ann)["state"], "flying")

    def status_of(self, identity, client):
        return json.loads(self.dispersa("status", identity, "--json", "--keys", client))["campaigns"][0]

    def test_a_revoked_name_is_issued_again(self):
        coordinator, one, ann, bob = (self.issue(role, name) for role, name in
                                      (("coordinator", "main"), ("worker", "one"), ("client", "ann"), ("client", "bob")))
        self.start_with("dispersa-coordinator", coordinator)
        lost = self.start_with("dispersa-worker", one)
        self.wait_for_workers(ann, "one")
        keys("revoke", self.authority, "--role", "client", "--name", "bob")
        shutil.copy(keys("revoke", self.authority, "--role", "worker", "--name", "one"), coordinator)
        wait_for(lambda: lost.poll() is not None or not self.workers(ann), "the end of the lost keys")
        self.assertIn("its keys are revoked", self.log.read_text())
        wait_for(lambda: "revoked" in self.refusal(bob), "bob's refusal")
        # The same names, other serials.
        again, new_bob = self.issue("worker", "one"), self.issue("client", "bob")
        self.start_with("dispersa-worker", again)
        self.wait_for_workers(new_bob, "one")
        self.start_with("dispersa-worker", one)
        time.sleep(5)
        self.assertEqual(self.workers(new_bob), ["one"], "and no second one")
        self.assertEqual(self.refusal(bob), "the keys of this client are revoked\n")
        listed = json.loads(subprocess.run([BINARIES / "dispersa", "keys", "list", self.authority, "--json"],
                                           capture_output=True, check=True).stdout)["keys"]
        self.assertEqual([(each["name"], each["revoked"]) for each in listed if each["name"] in ("one", "bob")],
                         [("one", True), ("bob", True), ("one", False), ("bob", False)])

    def refusal(self, client):
        try:
            self.dispersa("list", "--keys", client, code=2)
        except AssertionError:
            return ""
        return self.error


if __name__ == "__main__":
    main()
