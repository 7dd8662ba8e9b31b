"""The two commands of README.md on a bare Debian 12 and a bare Debian 13: the same sources, the same bytes. Then the Debian
package that is made there, on another bare root of the same release.
"""
import hashlib
import pathlib
import shutil
import tempfile
import unittest

from bare_root import BareRoot, where_possible
from installed import BUILD, SOURCE, copy_sources, run

PATIENCE_S = 6000
CAMPAIGNS = ("table3", "table3_flexible", "table3_turbulence", "stuck_nozzle", "full", "orbit", "gallery/vega/campaign", "gallery/soyuz/campaign")
FLY = ("--cases", "8", "--no-histories", "--quiet")


def digest(folder):
    return hashlib.sha256((folder / "cases.csv").read_bytes()).hexdigest()


@where_possible
class TwoSystems(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="dispersa-systems-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def inside(self, root, script):
        done = root.inside(script, timeout=PATIENCE_S)
        self.assertEqual(done.returncode, 0, done.stdout[-3000:] + done.stderr[-3000:])
        return done.stdout

    def digests_here(self):
        found = {}
        for name in CAMPAIGNS:
            out = self.folder / "here" / name.replace("/", "_")
            done = run(BUILD / "bin/dispersa", "run", SOURCE / f"campaigns/{name}.yaml", "--workers", "0", *FLY, "--out", out)
            self.assertIn(done.returncode, (0, 3, 4), done.stderr)
            found[name] = digest(out)
        return found

    def both_commands(self, suite):
        (self.folder / suite).mkdir()
        root = BareRoot(self.folder / suite, suite)
        copy_sources(root.path / "src")
        self.inside(root, "apt-get update; apt-get install --yes --no-install-recommends git; cd /src; "
                          "campaigns/run smoke --quiet --out /smoke/results")
        self.inside(root, "cd /src; tests/run -R '^(unit|distributed.run)'")
        found = {}
        for name in CAMPAIGNS:
            out = f"/results/{name.replace('/', '_')}"
            self.inside(root, f"cd /src; build/release/bin/dispersa run campaigns/{name}.yaml --workers 2 {' '.join(FLY)} --out {out} || "
                              "[ $? = 3 -o $? = 4 ]")
            found[name] = digest(root.path / out[1:])
        self.inside(root, "cd /src; cpack --config build/release/CPackConfig.cmake -G DEB -B /out")

        (self.folder / f"{suite}-user").mkdir()
        user = BareRoot(self.folder / f"{suite}-user", suite)
        package, = (root.path / "out").glob("*.deb")
        shutil.copy(package, user.path / "tmp/dispersa.deb")
        self.inside(user, "apt-get update; apt-get install --yes --no-install-recommends /tmp/dispersa.deb; "
                          "dispersa run /usr/share/dispersa/campaigns/smoke.yaml --workers 2 --quiet --out /smoke/results")
        self.assertEqual(digest(user.path / "smoke/results"), digest(root.path / "smoke/results"))
        return found

    def test_both_commands_and_the_same_bytes(self):
        here = self.digests_here()
        for suite in ("bookworm", "trixie"):
            with self.subTest(suite):
                self.assertEqual(self.both_commands(suite), here)


if __name__ == "__main__":
    unittest.main()
