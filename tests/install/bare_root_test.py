"""The Debian package on a bare Debian 12: installed by apt, used, removed. Needs root and debootstrap (long-packages.txt).

Packages come from where this machine has its own from.
"""
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

from installed import BUILD, CPACK, run

PATIENCE_S = 1500


def mirror():
    """The first archive among apt's sources that has the main part of Debian 12."""
    lists = [pathlib.Path("/etc/apt/sources.list"), *sorted(pathlib.Path("/etc/apt/sources.list.d").glob("*.list")),
             *sorted(pathlib.Path("/etc/apt/sources.list.d").glob("*.sources"))]
    for file in lists:
        text = file.read_text() if file.is_file() else ""
        for block in text.split("\n\n"):
            uri = re.search(r"^URIs:\s*(\S+)", block, re.MULTILINE)
            if uri and re.search(r"^Suites:.*\bbookworm(\s|$)", block, re.MULTILINE):
                return uri[1]
        if found := re.search(r"^deb\s+(?:\[.*?\]\s+)?(\S+)\s+bookworm\s+.*\bmain\b", text, re.MULTILINE):
            return found[1]
    return None


@unittest.skipUnless(os.geteuid() == 0 and shutil.which("debootstrap"), "needs root and debootstrap (tests/long-packages.txt)")
@unittest.skipUnless(mirror(), "this machine's apt has no source of Debian 12")
class BareRoot(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="dispersa-root-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        done = run(CPACK, "--config", BUILD / "CPackConfig.cmake", "-G", "DEB", "-B", cls.folder / "out", cwd=cls.folder)
        assert done.returncode == 0, done.stdout + done.stderr
        package, = (cls.folder / "out").glob("*.deb")
        cls.root = cls.folder / "root"
        done = run("debootstrap", "--variant=minbase", "bookworm", cls.root, mirror(), timeout=PATIENCE_S)
        assert done.returncode == 0, done.stdout[-2000:] + done.stderr
        # As the machine's own apt: its sources, keys, proxies.
        shutil.copytree("/etc/apt", cls.root / "etc/apt", dirs_exist_ok=True)
        for file in ("etc/resolv.conf", "etc/hosts"):
            shutil.copy(f"/{file}", cls.root / file)
        shutil.copy(package, cls.root / "tmp/dispersa.deb")

    def inside(self, script, code=0):
        """A shell in the root, with /proc and /dev in a mount namespace that ends with it."""
        command = f"mount -t proc proc {self.root}/proc; mount --rbind /dev {self.root}/dev; exec chroot {self.root} /bin/sh -euc \"$1\""
        environment = {"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "HOME": "/root", "LANG": "C.UTF-8",
                       "DEBIAN_FRONTEND": "noninteractive"}
        environment.update({key: value for key, value in os.environ.items() if key.lower().endswith("_proxy")})
        done = subprocess.run(["unshare", "--mount", "--propagation", "private", "sh", "-euc", command, "sh", script],
                              capture_output=True, text=True, timeout=PATIENCE_S, env=environment, stdin=subprocess.DEVNULL)
        self.assertEqual(done.returncode, code, done.stdout[-3000:] + done.stderr[-3000:])
        return done.stdout

    def test_installed_used_and_removed(self):
        before = self.inside("find /usr /etc /opt -xdev | sort")
        self.assertNotIn("dispersa", before)
        self.inside("apt-get update; apt-get install --yes --no-install-recommends /tmp/dispersa.deb")
        self.assertIn("install ok installed", self.inside("dpkg --status dispersa"))

        said = self.inside("for program in dispersa dispersa-coordinator dispersa-worker; do $program --version; done")
        self.assertEqual(len({line.split()[1] for line in said.splitlines()}), 1, said)
        self.inside("cd; dispersa run /usr/share/dispersa/campaigns/table3.yaml --cases 8 --workers 2 --no-histories --quiet "
                    "--out results || [ $? = 4 ]")
        cases = self.inside("cat ~/results/cases.csv").splitlines()
        self.assertEqual(len(cases), 9)
        # The same bytes as here.
        here = run(BUILD / "bin/dispersa", "run", self.root / "usr/share/dispersa/campaigns/table3.yaml", "--cases", 8, "--workers", 0,
                   "--no-histories", "--quiet", "--out", self.folder / "here")
        self.assertEqual(here.returncode, 4, here.stderr)
        self.assertEqual((self.folder / "here/cases.csv").read_text().splitlines(), cases)
        self.inside("zcat /usr/share/man/man1/dispersa-run.1.gz | grep -q '^.SH SYNOPSIS'")
        self.inside("test -f /usr/share/zsh/vendor-completions/_dispersa; test -f /usr/share/doc/dispersa/copyright; "
                    "bash -c 'source /usr/share/bash-completion/completions/dispersa; complete -p dispersa-worker'")

        self.inside("apt-get purge --yes dispersa")
        left = set(self.inside("find /usr /etc /opt -xdev -iname '*dispersa*'").splitlines())
        self.assertEqual(left, set())


if __name__ == "__main__":
    unittest.main()
