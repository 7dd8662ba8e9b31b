"""The Debian package on a bare Debian: installed by apt, used, removed."""
import pathlib
import shutil
import tempfile
import unittest

from bare_root import BareRoot, where_possible
from installed import BUILD, run


@where_possible
class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="dispersa-root-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.root = BareRoot(cls.folder)
        cls.root.take_package()

    def inside(self, script):
        done = self.root.inside(script)
        self.assertEqual(done.returncode, 0, done.stdout[-3000:] + done.stderr[-3000:])
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
        here = run(BUILD / "bin/dispersa", "run", self.root.path / "usr/share/dispersa/campaigns/table3.yaml", "--cases", 8, "--workers", 0,
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
