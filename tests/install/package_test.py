"""The Debian package made by CPack: its files, its metadata, and its use when unpacked."""
import gzip
import pathlib
import re
import shutil
import tempfile
import unittest

from installed import BUILD, CPACK, SOURCE, environment, run


@unittest.skipUnless(shutil.which("dpkg-shlibdeps") and shutil.which("dpkg-deb"), "not a Debian system (tests/packages.txt)")
class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="dispersa-package-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        # Compressed for speed: what is tested is what is in it.
        done = run(CPACK, "--config", BUILD / "CPackConfig.cmake", "-G", "DEB", "-B", cls.folder / "out",
                   "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=gzip", cwd=cls.folder)
        assert done.returncode == 0, done.stdout + done.stderr
        cls.package, = (cls.folder / "out").glob("*.deb")
        cls.root = cls.folder / "root"
        assert run("dpkg-deb", "--extract", cls.package, cls.root).returncode == 0

    def field(self, name):
        return run("dpkg-deb", "--field", self.package, name).stdout.strip()

    def test_what_it_says_of_itself(self):
        self.assertEqual(self.field("Package"), "dispersa")
        self.assertEqual(self.package.name, f"dispersa_{self.field('Version')}_amd64.deb")
        self.assertEqual((self.field("Architecture"), self.field("Section")), ("amd64", "science"))
        self.assertTrue(self.field("Description").startswith("Monte Carlo dispersion service for launch vehicles\n"))

    def test_it_depends_on_what_the_programs_load(self):
        # spdlog's says besides which fmt it was built with.
        names = {re.sub(r"-fmt\d+$", "", word.split()[0]) for word in self.field("Depends").split(",")}
        listed = [line for line in (SOURCE / "docker/runtime-packages.txt").read_text().splitlines()
                  if line and not line.startswith("#")]
        self.assertEqual([line for line in listed if names.isdisjoint(line.split(" | "))], [])

    def test_files_of_root_where_debian_has_them(self):
        lines = run("dpkg-deb", "--contents", self.package).stdout.splitlines()
        files = {line.split(maxsplit=5)[5]: line.split()[:2] for line in lines}
        self.assertEqual({owner for _, owner in files.values()}, {"root/root"})
        for name in ("bin/dispersa", "bin/dispersa-coordinator", "bin/dispersa-worker", "share/dispersa/campaigns/gate"):
            self.assertEqual(files[f"./usr/{name}"][0], "-rwxr-xr-x", name)
        for name in ("share/dispersa/campaigns/table3.yaml", "share/dispersa/campaigns/winds/vandenberg_worst_month.csv",
                     "share/doc/dispersa/copyright", "share/bash-completion/completions/dispersa",
                     "share/zsh/vendor-completions/_dispersa", "share/fish/vendor_completions.d/dispersa.fish"):
            self.assertIn(f"./usr/{name}", files)
        if (BUILD / "manual").is_dir():
            page = gzip.decompress((self.root / "usr/share/man/man1/dispersa.1.gz").read_bytes()).decode()
            self.assertIn(".SH NAME\ndispersa \\- Monte Carlo", page)

    def test_it_flies_unpacked(self):
        campaigns = self.root / "usr/share/dispersa/campaigns"
        done = run(self.root / "usr/bin/dispersa", "fly", campaigns / "table3.yaml", "--case", "3", env=environment(self.root / "usr"))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("outcome  completed", done.stdout)


if __name__ == "__main__":
    unittest.main()
