"""Files that a disk or an editor has changed: listed and fetched as damaged, found by `dispersa fsck`, mended where other
files allow it. A coordinator that is drained ends what flies.

Environment as of processes.py.
"""
import json
import signal
import sqlite3
import subprocess

from processes import BINARIES, BRIEF, CAMPAIGN, LOST_CODE, PATIENCE_S, Run, content, main, stored, wait_for
from service_case import ServiceCase

CASES = 12
REPORTS = ("cases.csv", "summary.json", "report.html")


def change(file, old, new):
    data = file.read_bytes()
    assert data.count(old) >= 1, (file, old)
    file.write_bytes(data.replace(old, new, 1))


class FsckCase(ServiceCase):
    def stop(self):
        for process in self.processes:
            process.send_signal(signal.SIGTERM)
        for process in self.processes:
            self.assertEqual(process.wait(timeout=PATIENCE_S), 0)
        self.processes.clear()

    def fsck(self, folder, *arguments, code=0):
        """The problems, as (file within the folder, what, whether it is mended)."""
        command = [BINARIES / "dispersa", "fsck", folder, *arguments]
        text = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE_S)
        found = json.loads(subprocess.run([*command, "--json"], capture_output=True, text=True, timeout=PATIENCE_S).stdout) \
            if not arguments else None
        self.assertEqual(text.returncode, code, text.stdout + text.stderr)
        if found is None:
            return text.stdout.splitlines()
        lines = [f"{one['file']}: {one['what']}, {one['mend']}" for one in found["problems"]]
        self.assertEqual(text.stdout.splitlines(), lines or [f"{folder}: sound"])
        return [(str(one["file"]).removeprefix(f"{folder}/"), one["what"]) for one in found["problems"]]


class DataFolder(FsckCase):
    DOMAIN = "39"

    def setUp(self):
        super().setUp()
        self.start_coordinator()
        self.start_worker("--slots", 2)
        self.identity = self.dispersa("launch", CAMPAIGN, "--cases", CASES).strip()
        self.dispersa("watch", self.identity, code=LOST_CODE)
        self.whole = self.fetch(self.identity)
        self.folder = self.data / self.identity

    def test_a_sound_folder_and_none(self):
        busy = subprocess.run([BINARIES / "dispersa", "fsck", self.data], capture_output=True, text=True)
        self.assertEqual(busy.returncode, 2)
        self.assertIn("another dispersa process is writing this folder", busy.stderr)
        self.stop()
        self.assertEqual(self.fsck(self.data), [])
        self.assertEqual(self.fsck(self.whole), [])
        for folder, words in ((self.root / "none", "is no folder"), (self.whole / "histories", "holds no results and no campaigns")):
            other = subprocess.run([BINARIES / "dispersa", "fsck", folder], capture_output=True, text=True)
            self.assertEqual(other.returncode, 2)
            self.assertIn(words, other.stderr)

    def test_a_verdict_that_was_edited_is_none(self):
        self.stop()
        change(self.folder / "state.json", b'"verdict": "fail"', b'"verdict": "pass"')
        problem = [(f"{self.identity}/state.json", "does not fit its checksum")]
        self.assertEqual(self.fsck(self.data, code=1), problem)
        self.start_coordinator()
        entry = self.status(self.identity)
        self.assertEqual((entry["state"], entry["verdict"], entry["code"], entry["done"]), ("damaged", None, 1, CASES))
        self.assertIn("state.json does not fit its checksum: stop the coordinator, and let `dispersa fsck DATA --repair`",
                      entry["problem"])
        self.dispersa("watch", self.identity, code=1)
        for command in (["fetch", self.identity, "--out", self.root / "never"], ["launch", CAMPAIGN, "--cases", CASES],
                        ["cancel", self.identity], ["repair", self.identity, "--worker", "w"]):
            self.dispersa(*command, code=1)
            self.assertIn("does not fit its checksum", self.error)
        self.stop()
        self.assertEqual(self.fsck(self.data, code=1), problem, "a coordinator has not written it")
        self.assertEqual(self.fsck(self.data, "--repair"),
                         [f"{self.folder}/state.json: does not fit its checksum, mended: --repair makes it anew from the "
                          "results; owner, labels and priority are lost"])
        self.assertEqual(self.fsck(self.data), [])
        self.start_coordinator()
        self.dispersa("watch", self.identity, code=LOST_CODE)
        again = self.fetch(self.identity)
        for name in REPORTS:
            self.assertEqual(content(again, name), content(self.whole, name), name)

    def test_what_flew_half_is_made_anew_as_cancelled(self):
        many = self.dispersa("launch", BRIEF, "--cases", 5000).strip()
        wait_for(lambda: stored(self.data / many / "results") > 0, "results")
        self.stop()
        count = stored(self.data / many / "results")
        state = self.data / many / "state.json"
        for damage in (state.read_bytes()[:100], None):
            state.unlink() if damage is None else state.write_bytes(damage)
            self.fsck(self.data, "--repair")
            self.start_coordinator()
            entry = self.status(many)
            self.assertEqual((entry["name"], entry["state"], entry["done"], entry["total"], entry["code"]),
                             ("smoke", "cancelled", count, 5000, 5))
            self.stop()

    def test_a_report_that_was_cut_is_neither_fetched_nor_lost(self):
        summary = self.folder / "results" / "summary.json"
        cut = summary.read_bytes()[:-40]
        summary.write_bytes(cut)
        out = self.root / "cut"
        self.dispersa("fetch", self.identity, "--out", out, code=1)
        self.assertIn("summary.json is not as it was written at the coordinator: nothing was written; stop it, and let "
                      "`dispersa fsck DATA --repair` mend it", self.error)
        self.assertFalse(out.exists())
        self.stop()
        sums = self.folder / "results" / "SHA256SUMS"
        self.assertEqual(subprocess.run(["sha256sum", "-c", "--quiet", self.whole / "SHA256SUMS"], cwd=self.whole).returncode, 0)
        self.assertEqual(self.fsck(self.data, code=1), [(f"{self.identity}/results/summary.json", "is not as it was written")])
        text = sums.read_bytes()
        sums.write_bytes(text[:-30])
        self.assertEqual([name.rpartition("/")[2] for name, _ in self.fsck(self.data, code=1)], ["SHA256SUMS"])
        sums.unlink()  # as of a release that wrote none
        self.assertEqual(len(self.fsck(self.data, code=1)), 1, "it is no JSON")
        sums.write_bytes(text)
        (self.folder / "results" / "report.html.gz").write_bytes(b"no page")
        self.fsck(self.data, "--repair")
        self.assertEqual(self.fsck(self.data), [])
        self.start_coordinator()
        again = self.fetch(self.identity)
        for name in REPORTS:
            self.assertEqual(content(again, name), content(self.whole, name), name)

    def test_rows_that_were_changed_fly_again(self):
        self.stop()
        with sqlite3.connect(self.folder / "results" / "results.sqlite") as rows:
            rows.execute("UPDATE cases SET metric_q_max_pa = 1.0 WHERE case_index IN (3, 5)")
        rows.close()
        self.assertEqual(self.fsck(self.data, code=1),
                         [(f"{self.identity}/results/results.sqlite", "2 rows are not as written")])
        self.fsck(self.data, "--repair")
        self.start_coordinator()
        self.start_worker("--slots", 2)
        wait_for(lambda: self.status(self.identity)["state"] == "done", "the end")
        again = self.fetch(self.identity)
        for name in REPORTS:
            self.assertEqual(content(again, name), content(self.whole, name), name)

    def test_files_of_the_coordinator(self):
        self.stop()
        (self.data / "epoch").write_text("-5\n")
        (self.data / "expelled.json").write_text('{"version": 2, "expelled": {}, "checksum": "0"}\n')
        (self.folder / "campaign.yaml").write_text("name: another\n")
        found = [(f"epoch", "is not as it was written"), ("expelled.json", "is not as it was written"),
                 (f"{self.identity}/campaign.yaml", "is not the campaign that was flown")]
        self.assertEqual(self.fsck(self.data, code=1), found)
        refused = subprocess.run([BINARIES / "dispersa-coordinator", "--data", self.data, *self.NETWORK], capture_output=True,
                                 text=True, timeout=PATIENCE_S)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("epoch: is damaged: it is not a whole JSON object, allowed: the file of a backup; or none", refused.stderr)
        self.assertEqual([": mended" in line or ", mended: " in line for line in self.fsck(self.data, "--repair", code=1)],
                         [True, False, True], "nobody knows who was expelled")
        self.assertEqual(self.fsck(self.data, code=1), found[1:2])
        refused = subprocess.run([BINARIES / "dispersa-coordinator", "--data", self.data, *self.NETWORK], capture_output=True,
                                 text=True, timeout=PATIENCE_S)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("expelled.json: is damaged: it does not fit its checksum", refused.stderr)
        (self.data / "expelled.json").unlink()
        self.assertEqual(self.fsck(self.data), [])


class ResultFolder(FsckCase):
    DOMAIN = "39"

    def test_the_folder_of_a_run(self):
        run = Run(self.root / "run", "--workers", 0, "--cases", CASES).finish()
        whole = {name: content(run.out, name) for name in REPORTS}
        self.assertEqual(self.fsck(run.out), [])
        (run.out / "cases.csv").write_text("case_index\n" + "1\n" * 99)
        (run.out / "nominal.json").unlink()
        self.assertEqual(self.fsck(run.out, code=1),
                         [("cases.csv", "is not as it was written"), ("nominal.json", "is not as it was written")])
        self.fsck(run.out, "--repair")
        self.assertEqual(self.fsck(run.out), [])
        self.assertEqual({name: content(run.out, name) for name in REPORTS}, whole)
        change(run.out / "campaign.yaml", b"smoke", b"smoky")
        self.assertEqual(self.fsck(run.out, code=1), [("campaign.yaml", "is not the campaign that was flown")])
        self.fsck(run.out, "--repair", code=1)
        change(run.out / "campaign.yaml", b"smoky", b"smoke")
        database = (run.out / "results.sqlite").read_bytes()
        for damage in (database[:20000], b"no database", database[:5000] + bytes(3000) + database[8000:]):
            (run.out / "results.sqlite").write_bytes(damage)
            self.assertEqual([name for name, _ in self.fsck(run.out, code=1)], ["results.sqlite"])


class Drain(FsckCase):
    DOMAIN = "39"

    def drain(self, *arguments, **options):
        return subprocess.Popen([BINARIES / "dispersa-coordinator", "--drain", *map(str, arguments), *self.NETWORK],
                                stderr=subprocess.PIPE, text=True, **options)

    def test_what_flies_ends_and_what_waits_stays_stored(self):
        nobody = self.drain()
        self.assertIn("does not answer", nobody.communicate(timeout=PATIENCE_S)[1])
        self.assertEqual(nobody.returncode, 5)
        coordinator = self.start_coordinator()
        flying = [self.dispersa("launch", CAMPAIGN, "--cases", 300, "--seed", seed).strip() for seed in range(1, 9)]
        waiting = self.dispersa("launch", CAMPAIGN, "--cases", 10, "--seed", 9).strip()
        wait_for(lambda: all(self.status(each)["state"] == "flying" for each in flying), "eight of them")
        drained = self.drain("--data", self.data)
        said = drained.stderr.readline()  # the coordinator has answered: what is launched before it still would be taken
        self.assertIn("draining: 8 campaigns fly or get their reports, 1 wait for the next coordinator", said)
        self.assertEqual(self.dispersa_code("launch", CAMPAIGN, "--seed", 10), 5)
        self.assertIn("the coordinator is drained and takes no campaign, ask again when the next one has started", self.error)
        self.assertIsNone(coordinator.poll(), "it waits for its campaigns")
        self.assertEqual(self.status(waiting)["state"], "waiting")
        self.start_worker("--slots", 2)
        self.assertEqual(coordinator.wait(timeout=PATIENCE_S), 0)
        words = drained.communicate(timeout=PATIENCE_S)[1]
        self.assertEqual(drained.returncode, 0, words)
        states = {json.loads((self.data / each / "state.json").read_text())["state"] for each in flying}
        self.assertEqual(states, {"done"})
        self.assertEqual(json.loads((self.data / waiting / "state.json").read_text())["state"], "waiting")
        self.start_coordinator()
        self.dispersa("watch", waiting, code=LOST_CODE)

    def dispersa_code(self, *arguments):
        done = subprocess.run([BINARIES / "dispersa", *map(str, arguments), *self.NETWORK], capture_output=True, text=True,
                              timeout=PATIENCE_S)
        self.error = done.stderr
        return done.returncode


if __name__ == "__main__":
    main()
