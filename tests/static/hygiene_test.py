"""hygiene.py finds violations in made-up trees."""
import pathlib
import subprocess
import tempfile
import unittest

import hygiene


class HygieneTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)

    def check(self, name, content):
        (self.root / name).parent.mkdir(parents=True, exist_ok=True)
        (self.root / name).write_bytes(content.encode() if isinstance(content, str) else content)
        return hygiene.check(self.root)

    def test_accepts_clean_files(self):
        self.assertEqual(self.check("README.md", "See `core/work/x.h`, ../home/y and $HOME/root/z: 7612.6 m/s ±3σ\n"),
                         [])

    def test_finds_paths_of_one_machine(self):
        self.assertEqual(self.check("a.md", "data in /" + "home/jane/data\n"), ["a.md:1: path of one machine"])

    def test_finds_markers(self):
        self.assertEqual(self.check("a.cc", "// TO" + "DO: later\n"), ["a.cc:1: unfinished marker"])
        self.assertEqual(self.check("a.cc", "<" * 7 + " HEAD\n"), ["a.cc:1: conflict marker"])

    def test_finds_bad_text(self):
        self.assertEqual(self.check("a.cc", "int a; \n"), ["a.cc:1: trailing white space"])
        self.assertEqual(self.check("a.cc", "int a;\r\n"), ["a.cc:1: carriage return"])
        self.assertEqual(self.check("a.cc", "int a;"), ["a.cc: no newline at the end"])
        self.assertEqual(self.check("a.cc", b"\xff\n"),
                         ["a.cc: not UTF-8: 'utf-8' codec can't decode byte 0xff in position 0: invalid start byte"])

    def test_finds_a_script_that_does_not_parse(self):
        problems = self.check("tool", "#!/usr/bin/env bash\nif true; then\n")
        self.assertEqual(len(problems), 1)
        self.assertRegex(problems[0], r"^tool: .*syntax error: unexpected end of file$")

    def test_leaves_foreign_data_alone(self):
        self.assertEqual(self.check("tests/data/atmosphere/table.txt", "1 2 \r\n"), [])

    def test_reads_only_files_under_version_control(self):
        subprocess.run(["git", "-C", self.root, "init", "--quiet"], check=True)
        self.assertEqual(self.check("a.cc", "int a; \n"), [])
        subprocess.run(["git", "-C", self.root, "add", "a.cc"], check=True)
        self.assertEqual(hygiene.check(self.root), ["a.cc:1: trailing white space"])


if __name__ == "__main__":
    unittest.main()
