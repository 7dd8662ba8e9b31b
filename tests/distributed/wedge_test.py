"""A coordinator whose middleware hangs starts again, also while it has nothing to do.

Environment as of processes.py.
"""
import ctypes
import os
import pathlib
import time

from processes import PATIENCE_S, main, wait_for
from service_case import ServiceCase

PTRACE_SEIZE, PTRACE_INTERRUPT, WALL = 0x4206, 0x4207, 0x40000000
NO_BEAT_S = 20


def ptrace(request, thread):
    libc = ctypes.CDLL(None, use_errno=True)
    libc.ptrace.argtypes = [ctypes.c_long, ctypes.c_long, ctypes.c_void_p, ctypes.c_void_p]
    if libc.ptrace(request, thread, None, None) != 0:
        raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()))


class WedgeTest(ServiceCase):
    DOMAIN = "38"

    def stop_all_but(self, process, names):
        """Stops the threads of the middleware, as a lock that nobody gives back would."""
        stopped = []
        for task in pathlib.Path(f"/proc/{process.pid}/task").iterdir():
            if int(task.name) != process.pid and (task / "comm").read_text().strip() not in names:
                ptrace(PTRACE_SEIZE, int(task.name))
                ptrace(PTRACE_INTERRUPT, int(task.name))
                stopped.append(int(task.name))
        return stopped

    def test_an_idle_coordinator_that_does_not_hear_itself_starts_again(self):
        coordinator = self.start_coordinator()
        self.dispersa("list")
        time.sleep(5)  # it has asked itself
        begun = time.monotonic()
        stopped = self.stop_all_but(coordinator, {"watchdog"})
        self.assertGreater(len(stopped), 5)

        def restarts():
            for thread in list(stopped):  # those that end with the old program wait for whoever has stopped them
                try:
                    if os.waitpid(thread, os.WNOHANG | WALL)[0] == thread and not os.path.exists(
                            f"/proc/{coordinator.pid}/task/{thread}"):
                        stopped.remove(thread)
                except ChildProcessError:
                    stopped.remove(thread)
            return "the coordinator restarts" in self.log.read_text() and not stopped
        wait_for(restarts, "a new start")
        self.assertGreater(time.monotonic() - begun, NO_BEAT_S - 2, "not before it had time to answer")
        self.assertLess(time.monotonic() - begun, PATIENCE_S / 2)
        self.dispersa("list")
        self.assertIsNone(coordinator.poll(), "in the same process")
        self.assertEqual(self.log.read_text().count("the coordinator restarts"), 1)


if __name__ == "__main__":
    main()
