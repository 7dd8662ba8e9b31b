"""A bare Debian, for tests that build dispersa or install its package there. Needs root and debootstrap
(long-packages.txt); packages come from where this machine has its own from.
"""
import os
import pathlib
import platform
import re
import shutil
import subprocess
import unittest

from installed import BUILD, CPACK, run

PATIENCE_S = 1500
HERE = platform.freedesktop_os_release().get("VERSION_CODENAME", "")  # this machine's release of Debian
# Processes and mounts of what runs so end with it, and it with the test.
CONTAINED = ["setpriv", "--pdeathsig", "KILL", "unshare", "--mount", "--propagation", "private", "--pid", "--fork", "--kill-child"]


def mirror():
    """The first archive among apt's sources that has the main part of this machine's Debian."""
    lists = [pathlib.Path("/etc/apt/sources.list"), *sorted(pathlib.Path("/etc/apt/sources.list.d").glob("*.list")),
             *sorted(pathlib.Path("/etc/apt/sources.list.d").glob("*.sources"))]
    for file in lists:
        text = file.read_text() if file.is_file() else ""
        for block in text.split("\n\n"):
            uri = re.search(r"^URIs:\s*(\S+)", block, re.MULTILINE)
            if uri and re.search(rf"^Suites:.*\b{HERE}(\s|$)", block, re.MULTILINE):
                return uri[1]
        if found := re.search(rf"^deb\s+(?:\[.*?\]\s+)?(\S+)\s+{HERE}\s+.*\bmain\b", text, re.MULTILINE):
            return found[1]
    return None


def where_possible(test):
    """Skips a class of tests where no bare root can be made."""
    test = unittest.skipUnless(mirror(), "this machine's apt has no source of Debian")(test)
    return unittest.skipUnless(os.geteuid() == 0 and shutil.which("debootstrap"),
                               "needs root and debootstrap (tests/long-packages.txt)")(test)


class BareRoot:
    def __init__(self, folder, suite=HERE):
        """Makes `folder`/root, this release of Debian without anything but apt."""
        self.path = folder / "root"
        done = run(*CONTAINED, "debootstrap", "--variant=minbase", suite, self.path, mirror(), timeout=PATIENCE_S)
        assert done.returncode == 0, done.stdout[-2000:] + done.stderr
        # As the machine's own apt: its sources, keys, proxies.
        shutil.copytree("/etc/apt", self.path / "etc/apt", dirs_exist_ok=True)
        if suite != HERE:
            shutil.rmtree(self.path / "etc/apt/sources.list.d")
            (self.path / "etc/apt/sources.list").write_text(f"deb {mirror()} {suite} main\n")
        for file in ("etc/resolv.conf", "etc/hosts"):
            shutil.copy(f"/{file}", self.path / file)

    def take_package(self):
        """/tmp/dispersa.deb: of this machine's build."""
        done = run(CPACK, "--config", BUILD / "CPackConfig.cmake", "-G", "DEB", "-B", self.path.parent / "out", cwd=self.path.parent)
        assert done.returncode == 0, done.stdout + done.stderr
        package, = (self.path.parent / "out").glob("*.deb")
        shutil.copy(package, self.path / "tmp/dispersa.deb")

    def inside(self, script, *, network=True, timeout=PATIENCE_S):
        """A finished shell of root's, its output as text; without `network` on a loopback of its own."""
        # A root of its own: in one that chroot made, no user namespace can be made, which tests do.
        command = (f"mount --bind {self.path} {self.path}; cd {self.path}; mount -t proc proc proc; mount --rbind /dev dev; "
                   f"mount -t tmpfs tmpfs dev/shm; {'' if network else 'ip link set lo up; '}"
                   'pivot_root . .; umount -l .; cd /; exec /bin/sh -euc "$1"')
        environment = {"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "HOME": "/root", "LANG": "C.UTF-8",
                       "DEBIAN_FRONTEND": "noninteractive"}
        environment.update({key: value for key, value in os.environ.items() if key.lower().endswith("_proxy")})
        return subprocess.run([*CONTAINED, *([] if network else ["--net"]), "sh", "-euc", command, "sh", script],
                              capture_output=True, text=True, timeout=timeout, env=environment, stdin=subprocess.DEVNULL)
