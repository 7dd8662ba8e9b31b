"""A wheel of the Python package, made by pip from the sources alone, in an environment of its own."""
import pathlib
import shutil
import tempfile
import unittest

from installed import BUILD, SOURCE, copy_sources, environment, run

PATIENCE_S = 1500
PYTHON = "/usr/bin/python3"  # the one that has scikit-build

USE = """
import pathlib, sys
import dispersa.plot
campaign = pathlib.Path(sys.prefix) / "share/dispersa/campaigns/table3.yaml"
results = dispersa.run(campaign, "results", cases=200, histories=False)
print(dispersa.__file__, dispersa.worker_program(), len(results.cases), sep="\\n")
dispersa.plot.exceedance(results, "pitch_error_peak_deg").figure.savefig("plot.png")
"""


def files_below(folder):
    return {file for file in folder.rglob("*") if not file.is_dir() and "__pycache__" not in file.parts}


class Wheel(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="dispersa-wheel-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def done(self, *command, **options):
        options = {"cwd": self.folder, "timeout": PATIENCE_S, **options}
        finished = run(*command, **options)
        self.assertEqual(finished.returncode, 0, finished.stdout[-3000:] + finished.stderr[-3000:])
        return finished.stdout

    def test_made_installed_used_and_removed(self):
        copy_sources(self.folder / "source")
        self.done(PYTHON, "-m", "pip", "wheel", "--no-build-isolation", "--no-deps", "--no-index", "--wheel-dir", ".",
                  "./source/services/python")
        shutil.rmtree(self.folder / "source")
        wheel, = self.folder.glob("dispersa-*.whl")

        # NumPy is the system's.
        self.done(PYTHON, "-m", "venv", "--system-site-packages", "there")
        there = self.folder / "there"
        before = files_below(there)
        self.done(there / "bin/pip", "install", "--no-index", "--no-deps", wheel)
        self.assertIn("numpy", self.done(there / "bin/pip", "show", "dispersa"))

        user = environment(there)
        said = self.done(there / "bin/python", "-B", "-c", USE, env=user).splitlines()
        self.assertTrue(said[0].startswith(f"{there}/lib/"), said)
        self.assertEqual(said[1:], ["None", "200"])
        self.assertEqual(self.done("dispersa", "--version", env=user), self.done(BUILD / "bin/dispersa", "--version"))
        self.assertTrue((self.folder / "plot.png").read_bytes().startswith(b"\x89PNG"))
        here = run(BUILD / "bin/dispersa", "run", SOURCE / "campaigns/table3.yaml", "--cases", 200, "--workers", 0, "--no-histories",
                   "--quiet", "--out", self.folder / "here")
        self.assertEqual(here.returncode, 4, here.stderr)
        self.assertEqual((self.folder / "here/cases.csv").read_bytes(), (self.folder / "results/cases.csv").read_bytes())

        self.done(there / "bin/pip", "uninstall", "--yes", "dispersa")
        self.assertEqual(files_below(there), before)


if __name__ == "__main__":
    unittest.main()
