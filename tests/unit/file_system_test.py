"""Folders on disks and file systems that give less than results need, through the programs as they are started.

file_system_shim.c, compiled here, takes a part of the file system away.
"""
import errno
import pathlib
import resource
import shutil
import subprocess
import unittest

from programs import SMOKE, TIMEOUT_S, folder_of, run

SHIM = pathlib.Path(__file__).with_name("file_system_shim.c")
FULL = "no space left on the disk"
LIMIT = FULL + ": a file has reached its limit (`ulimit -f`, or the file system's)"


class FileSystemTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.root = folder_of(cls).resolve()
        cls.whole = cls.root / "whole"
        cls.flown = cls.dispersa(*cls.flight(cls.whole))
        assert cls.flown.returncode == 0, cls.flown.stderr

    @staticmethod
    def flight(out, *more):
        return ("run", SMOKE, "--cases", "60", "--workers", "0", "--no-histories", "--quiet", "--out", out, *more)

    @classmethod
    def dispersa(cls, *words, environment=None, limit=None, program="dispersa", stdout=subprocess.PIPE):
        def limited():
            if limit is not None:
                resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
        return run(program, *words, env=environment, stdout=stdout, preexec_fn=limited)

    def assert_same(self, out):
        self.assertEqual((out / "cases.csv").read_bytes(), (self.whole / "cases.csv").read_bytes())


class FileLimit(FileSystemTest):
    """`ulimit -f`: the system sends SIGXFSZ, which ends a program without a word."""

    def test_a_run_says_so_and_goes_on_without_the_limit(self):
        sizes = [(self.whole / name).stat().st_size for name in ("campaign.yaml", "cases.csv", "report.html")]
        # In its first file, in the database, in the index of the database's log, in the report.
        for limit in (min(sizes) // 2, min(sizes) + 1000, 20000, max(sizes) - 1000):
            with self.subTest(limit=limit):
                out = self.root / f"limited{limit}"
                done = self.dispersa(*self.flight(out), limit=limit)
                self.assertEqual(done.returncode, 5, done.stderr)
                self.assertIn(LIMIT, done.stderr)
                again = self.dispersa(*self.flight(out, "--resume"))
                self.assertEqual(again.returncode, 0, again.stderr)
                self.assert_same(out)

    def test_an_export_says_so_and_leaves_no_file(self):
        index = 40000  # the index of the database's log, which a reader makes too, has 32768 bytes
        for form in ("csv", "jsonl", "hdf5"):
            with self.subTest(form=form):
                file = self.root / f"export.{form}"
                export = ("export", self.whole, "--format", form, "--out", file)
                self.assertEqual(self.dispersa(*export).returncode, 0)
                size = file.stat().st_size
                self.assertGreater(size, index + 1000)
                file.unlink()
                # HDF5 keeps its last bytes until it closes the file.
                for limit in (index, (index + size) // 2, size - 8):
                    done = self.dispersa(*export, limit=limit)
                    self.assertEqual((done.returncode, done.stderr), (5, f"{file}: {LIMIT}\n"), limit)
                    self.assertEqual(list(self.root.glob("export.*")), [])
                done = self.dispersa(*export, limit=1000)
                self.assertEqual((done.returncode, done.stderr), (5, f"{self.whole}/results.sqlite: {LIMIT}\n"))

    def test_each_program_prints_into_a_file_that_is_full(self):
        for program in ("dispersa", "dispersa-worker", "dispersa-coordinator"):
            with self.subTest(program=program), open(self.root / "printed", "w") as stream:
                done = self.dispersa("--help", program=program, limit=16, stdout=stream)
                self.assertEqual((done.returncode, done.stderr), (5, f"standard output cannot be written: {LIMIT}\n"))


class Lacking(FileSystemTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.shim = cls.root / "shim.so"
        subprocess.run(["cc", "-shared", "-fPIC", "-Wall", "-Werror", "-o", cls.shim, SHIM, "-ldl"], check=True, timeout=TIMEOUT_S)

    def fly(self, name, lacks, error, *more):
        folder = self.root / name
        folder.mkdir(exist_ok=True)
        return folder / "out", self.dispersa(*self.flight(folder / "out", *more), environment={
            "LD_PRELOAD": str(self.shim), "DISPERSA_TEST_FOLDER": str(folder), "DISPERSA_TEST_LACKS": lacks,
            "DISPERSA_TEST_ERRNO": str(error)})

    def test_a_folder_or_files_that_cannot_be_synced_fly(self):
        for lacks in ("folder_sync", "sync"):
            for error in (errno.EINVAL, errno.ENOTSUP, errno.ENOSYS):
                with self.subTest(lacks=lacks, error=errno.errorcode[error]):
                    out, done = self.fly(f"{lacks}{error}", lacks, error)
                    self.assertEqual((done.returncode, done.stderr), (0, ""))
                    self.assert_same(out)
        # A disk that fails is no such file system.
        _, done = self.fly("broken", "sync", errno.EIO)
        self.assertEqual(done.returncode, 2)
        self.assertIn("out/campaign.yaml: cannot be written: Input/output error", done.stderr)

    def test_a_file_system_without_locks_or_shared_memory_is_refused_at_once(self):
        for lacks, error, file, words in (
                ("locks", errno.ENOLCK, "results.sqlite.tmp", "cannot lock files: No locks available"),
                ("locks", errno.ENOTSUP, "results.sqlite.tmp", "cannot lock files: Operation not supported"),
                ("locks", errno.ENOSYS, "results.sqlite.tmp", "cannot lock files: Function not implemented"),
                ("flock", errno.ENOLCK, "", "cannot lock files: No locks available"),
                ("flock", errno.ENOTSUP, "", "cannot lock files: Operation not supported"),
                ("mapping", errno.ENODEV, "results.sqlite.tmp", "cannot share memory between processes: No such device"),
                ("mapping", errno.EINVAL, "results.sqlite.tmp", "cannot share memory between processes: Invalid argument")):
            with self.subTest(lacks=lacks, error=errno.errorcode[error]):
                out, done = self.fly(f"{lacks}{error}", lacks, error)
                self.assertEqual((done.returncode, done.stderr), (2, (
                    f"{out / file}: its file system {words}, allowed: a folder on a file system with locks and shared memory, "
                    "such as a disk of this machine\n")))

    def test_a_folder_that_came_to_such_a_file_system_is_refused_too(self):
        for lacks, error, what in (("locks", errno.ENOLCK, "lock files"), ("mapping", errno.ENODEV, "share memory")):
            with self.subTest(lacks=lacks):
                folder = self.root / f"came{lacks}"
                shutil.copytree(self.whole, folder / "out")
                out, done = self.fly(folder.name, lacks, error, "--resume")
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertIn(f"{out}/results.sqlite: its file system cannot {what}", done.stderr)

    def test_memory_that_is_used_up_is_not_the_file_system(self):
        _, done = self.fly("memory", "mapping", errno.ENOMEM)
        self.assertNotIn("file system", done.stderr)

    def test_a_path_that_is_too_long_for_sqlite_is_refused(self):
        for size, code in ((480, 0), (600, 2)):
            with self.subTest(size=size):
                out = self.root
                while len(str(out)) < size - 120:
                    out /= "a" * 100
                out /= "b" * (size - len(str(out)) - 1)
                self.assertEqual(len(str(out)), size)
                done = self.dispersa(*self.flight(out))
                self.assertEqual(done.returncode, code, done.stderr)
                if code == 0:
                    self.assert_same(out)
                else:
                    self.assertEqual(done.stderr, f"{out}/results.sqlite.tmp: its path has 619 characters, too many for SQLite, "
                                                  "allowed: at most 504\n")


if __name__ == "__main__":
    unittest.main()
