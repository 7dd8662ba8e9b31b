"""The probes of a coordinator, /healthz and /readyz, from its start to its end: while it reads its data, hangs, has no space on
its disk, or shuts down.

Environment as of processes.py. Small disks are tmpfs in the mount namespace of this program.
"""
import ctypes
import os
import subprocess
import time
import unittest
import urllib.error
import urllib.request

from processes import BRIEF, ISOLATED, main, wait_for
from service_case import ServiceCase

PORT = 9481
PTRACE_DETACH, PTRACE_SEIZE, PTRACE_INTERRUPT = 17, 0x4206, 0x4207


# A disk that answers late: whoever looks at the file HOLD_AT, or opens it, waits while the file HOLD_WHILE is there.
SLOW_DISK = r"""
#define _GNU_SOURCE
#include <dlfcn.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
static void hold(const char* path) {
  const char *at = getenv("HOLD_AT"), *during = getenv("HOLD_WHILE");
  if (at && during && path && strcmp(path, at) == 0) while (access(during, F_OK) == 0) usleep(20000);
}
#define NEXT(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))
int stat(const char* path, struct stat* s) { hold(path); return NEXT(stat)(path, s); }
int stat64(const char* path, struct stat64* s) { hold(path); return NEXT(stat64)(path, s); }
int open(const char* path, int flags, ...) { hold(path); return NEXT(open)(path, flags | O_LARGEFILE, 0666); }
int open64(const char* path, int flags, ...) { hold(path); return NEXT(open64)(path, flags, 0666); }
"""


def ptrace(request, thread):
    libc = ctypes.CDLL(None, use_errno=True)
    libc.ptrace.argtypes = [ctypes.c_long, ctypes.c_long, ctypes.c_void_p, ctypes.c_void_p]
    if libc.ptrace(request, thread, None, None) != 0:
        raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()))


def probe(path):
    """Status and text of an answer; 0 while nobody listens."""
    try:
        with urllib.request.urlopen(f"http://127.0.0.1:{PORT}{path}", timeout=5) as answer:
            return answer.status, answer.read().decode().strip()
    except urllib.error.HTTPError as error:
        return error.code, error.read().decode().strip()
    except OSError:
        return 0, ""


class ProbesTest(ServiceCase):
    DOMAIN = "34"
    DAEMON = ["--metrics", PORT]

    def wait_for_answer(self, path, expected):
        wait_for(lambda: probe(path) == expected, f"{expected} of {path} in place of {probe(path)}")

    def slow_disk(self, name):
        """From now on a coordinator waits at this file of its data until the file is gone that is returned."""
        shim, during = self.root / "slow_disk.so", self.root / "slow"
        subprocess.run(["cc", "-shared", "-fPIC", "-x", "c", "-", "-o", shim, "-ldl"], input=SLOW_DISK, text=True, check=True)
        during.touch()
        for key, value in (("LD_PRELOAD", shim), ("HOLD_AT", self.data / name), ("HOLD_WHILE", during)):
            os.environ[key] = str(value)
            self.addCleanup(os.environ.pop, key, None)
        return during

    def start_on_it(self):
        coordinator = self.start_coordinator()
        os.environ.pop("LD_PRELOAD")  # of no other program
        return coordinator

    def test_a_coordinator_that_starts_and_ends_is_alive_and_not_ready(self):
        (self.data / "expelled.json").write_text("{}")
        slow = self.slow_disk("expelled.json")
        coordinator = self.start_on_it()
        self.wait_for_answer("/readyz", (503, "it starts and reads its campaigns"))
        self.assertEqual(probe("/healthz"), (200, "ok"))
        self.assertEqual(probe("/metrics"), (503, "it has no figures yet"))
        slow.unlink()
        self.wait_for_answer("/readyz", (200, "ok"))
        self.assertIn("no workers", self.dispersa("status"))
        self.assertEqual(probe("/healthz"), (200, "ok"))
        coordinator.terminate()
        seen = set()
        while coordinator.poll() is None:
            seen.add(("healthz", *probe("/healthz")))
            seen.add(("readyz", *probe("/readyz")))
        self.assertEqual(coordinator.returncode, 0)
        self.assertLessEqual(seen, {("healthz", 200, "ok"), ("readyz", 200, "ok"), ("readyz", 503, "it shuts down"),
                                    ("healthz", 0, ""), ("readyz", 0, "")})
        self.assertIn(("readyz", 503, "it shuts down"), seen)

    def test_a_coordinator_that_hangs_is_neither_alive_nor_ready_until_it_goes_on(self):
        coordinator = self.start_coordinator()
        self.wait_for_answer("/readyz", (200, "ok"))
        ptrace(PTRACE_SEIZE, coordinator.pid)  # its first thread alone
        ptrace(PTRACE_INTERRUPT, coordinator.pid)
        begun = time.monotonic()
        os.waitpid(coordinator.pid, 0)
        self.assertEqual(probe("/healthz"), (200, "ok"), "one missing beat is no death")
        wait_for(lambda: probe("/healthz")[0] == 503, "the probe's notice")
        self.assertRegex(probe("/healthz")[1], r"^it has not heard itself for 1\d s$")
        self.assertRegex(probe("/readyz")[1], r"^it has not heard itself for 1\d s$")
        self.assertTrue(8 < time.monotonic() - begun < 18, time.monotonic() - begun)
        ptrace(PTRACE_DETACH, coordinator.pid)
        self.wait_for_answer("/healthz", (200, "ok"))
        self.wait_for_answer("/readyz", (200, "ok"))
        self.assertNotIn("the coordinator restarts", self.log.read_text())

    def test_a_coordinator_that_drains_is_not_ready(self):
        coordinator = self.start_coordinator()
        self.wait_for_answer("/readyz", (200, "ok"))
        draining = self.start("dispersa-coordinator", "--drain", *self.DAEMON[2:])
        self.wait_for_answer("/readyz", (503, "it is drained, and takes no campaign"))
        self.assertEqual((draining.wait(timeout=60), coordinator.wait(timeout=60)), (0, 0), self.log.read_text())

    def assert_ends_in_time(self, coordinator):
        begun = time.monotonic()
        coordinator.terminate()
        self.assertEqual(coordinator.wait(timeout=30), 0, self.log.read_text())
        self.assertLess(time.monotonic() - begun, 5.0)

    def test_a_coordinator_ends_in_time_while_it_reads_its_data(self):
        (self.data / "expelled.json").write_text("{}")
        self.slow_disk("expelled.json")
        coordinator = self.start_on_it()
        self.wait_for_answer("/healthz", (200, "ok"))
        self.assert_ends_in_time(coordinator)

    def test_a_coordinator_ends_in_time_while_it_opens_a_campaign(self):
        self.slow_disk("dispersa-attempts.jsonl")  # read when a campaign is opened
        coordinator = self.start_on_it()
        self.dispersa("launch", BRIEF)
        time.sleep(1)
        self.assertIn('"state": "waiting"', self.dispersa("list", "--json"))
        self.assert_ends_in_time(coordinator)
        self.assertIn("what goes on is not waited for", self.log.read_text())

    def on_a_small_disk(self, option):
        subprocess.run(["mount", "-t", "tmpfs", "-o", option, "disk", self.data], check=True)
        self.addCleanup(subprocess.run, ["umount", "--lazy", self.data], check=True)

    @unittest.skipUnless(ISOLATED in os.environ, "no mount namespace of its own")
    def test_a_full_disk_is_not_ready_until_it_has_space(self):
        self.on_a_small_disk("size=8m")
        self.start_coordinator()
        self.wait_for_answer("/readyz", (200, "ok"))
        (self.data / "filling").write_bytes(bytes(8 << 20 >> 1))
        time.sleep(2)
        self.assertEqual(probe("/readyz"), (200, "ok"), "half of it is free")
        with (self.data / "filling").open("ab") as filling:
            space = os.statvfs(self.data)
            os.posix_fallocate(filling.fileno(), 4 << 20, space.f_bavail * space.f_frsize - (512 << 10))
        self.wait_for_answer("/readyz", (503, f"{self.data}: no space left on the disk: less than 1 MB is free"))
        self.assertEqual(probe("/healthz"), (200, "ok"), "a start again makes no space")
        (self.data / "filling").unlink()
        self.wait_for_answer("/readyz", (200, "ok"))

    @unittest.skipUnless(ISOLATED in os.environ, "no mount namespace of its own")
    def test_a_disk_without_inodes_is_not_ready_until_it_has_some(self):
        self.on_a_small_disk("nr_inodes=60")
        self.start_coordinator()
        self.wait_for_answer("/readyz", (200, "ok"))
        (self.data / "fillings").mkdir()
        for n in range(os.statvfs(self.data).f_favail - 3):
            (self.data / "fillings" / str(n)).touch()
        self.wait_for_answer("/readyz", (503, f"{self.data}: no space left on the disk: 3 more files can be made"))
        for file in (self.data / "fillings").iterdir():
            file.unlink()
        self.wait_for_answer("/readyz", (200, "ok"))


if __name__ == "__main__":
    main()
