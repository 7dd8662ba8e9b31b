"""core/flight/engine_version.cmake: changes that change the engine version, and changes that do not."""
import hashlib
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

CMAKE = os.environ.get("CMAKE", "cmake")
SCRIPT = pathlib.Path(__file__).parents[2] / "core/flight/engine_version.cmake"


class EngineVersionTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.write("core/flight/fly.cc", "int a;\n")
        self.write("core/math/table.h", "int b;\n")

    def write(self, name, text):
        (self.root / name).parent.mkdir(parents=True, exist_ok=True)
        (self.root / name).write_text(text)

    def version(self):
        output = self.root / "version.cc"
        subprocess.run([CMAKE, "-D", f"ROOT={self.root}", "-D", "VERSION=1.2.3", "-D", f"OUTPUT={output}",
                        "-P", SCRIPT], check=True)
        return re.search(r'return "(.*)";', output.read_text()).group(1)

    def test_is_the_digest_of_sorted_digests(self):
        lines = ""
        for name in ("core/flight/fly.cc", "core/math/table.h"):
            lines += f"{hashlib.sha256((self.root / name).read_bytes()).hexdigest()}  {name}\n"
        self.assertEqual(self.version(), "1.2.3+" + hashlib.sha256(lines.encode()).hexdigest()[:12])

    def test_changes_with_what_decides_a_case(self):
        versions = [self.version()]
        self.write("core/flight/fly.cc", "int c;\n")
        versions.append(self.version())
        self.write("core/campaign_yaml/load.cc", "")
        versions.append(self.version())
        (self.root / "core/math/table.h").rename(self.root / "core/math/tables.h")
        versions.append(self.version())
        self.assertEqual(len(set(versions)), 4, versions)

    def test_ignores_what_only_reads_results(self):
        before = self.version()
        for name in ("core/pages/page.cc", "core/statistics/mean.cc", "services/cli/main.cc", "core/math/README.md"):
            self.write(name, "x\n")
        self.assertEqual(self.version(), before)


if __name__ == "__main__":
    unittest.main()
