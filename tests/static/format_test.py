"""Makes C++ files in and out of layout, and checks the messages of tests/format about them."""
import pathlib
import subprocess
import tempfile
import unittest

FORMAT = pathlib.Path(__file__).resolve().parents[1] / "format"


class Format(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        (self.root / ".clang-format").write_text((FORMAT.parents[1] / ".clang-format").read_text())
        (self.root / "tests").mkdir()
        self.script = self.root / "tests/format"
        self.script.write_text(FORMAT.read_text())
        self.script.chmod(0o755)
        self.git("init", "--quiet")
        self.git("config", "user.name", "nobody")
        self.git("config", "user.email", "nobody@example.invalid")
        self.write("good.cc", "int main() { return 0; }\n")
        self.write("bad.h", "inline int   Two( ) {return 2;}\n")
        self.write("text.md", "int   x ;\n")
        self.git("add", ".")

    def git(self, *arguments):
        return subprocess.run(["git", "-C", self.root, *arguments], text=True, capture_output=True, check=False)

    def write(self, name, text):
        (self.root / name).write_text(text)

    def format(self, *arguments):
        done = subprocess.run([self.script, *arguments], cwd=self.root, text=True, capture_output=True, check=False)
        return done.returncode, done.stderr

    def test_names_what_is_not_formatted_and_changes_nothing(self):
        self.assertEqual(self.format("--check"), (1, "tests/format: not formatted, run tests/format: bad.h\n"))
        self.assertEqual((self.root / "bad.h").read_text(), "inline int   Two( ) {return 2;}\n")

    def test_formats_every_listed_file(self):
        self.assertEqual(self.format(), (0, ""))
        self.assertEqual((self.root / "bad.h").read_text(), "inline int Two() { return 2; }\n")
        self.assertEqual(self.format("--check"), (0, ""))

    def test_looks_at_the_files_that_it_is_given_alone(self):
        self.assertEqual(self.format("--check", "good.cc", "text.md"), (0, ""))
        self.assertEqual(self.format("--check", "bad.h")[0], 1)

    def test_an_absent_file_is_an_error(self):
        self.assertEqual(self.format("--check", "absent.cc")[0], 1)

    def test_the_hook_stops_a_commit(self):
        self.assertEqual(self.format("--hook"), (0, ""))
        refused = self.git("commit", "--quiet", "-m", "first")
        self.assertNotEqual(refused.returncode, 0)
        self.assertIn("bad.h", refused.stderr)
        self.format()
        self.git("add", ".")
        self.assertEqual(self.git("commit", "--quiet", "-m", "first").returncode, 0)

    def test_a_hook_that_is_there_is_kept(self):
        hook = self.root / ".git/hooks/pre-commit"
        hook.parent.mkdir(exist_ok=True)
        hook.write_text("#!/bin/sh\n")
        code, told = self.format("--hook")
        self.assertEqual(code, 2)
        self.assertIn("exists; add this line to it: tests/format --check", told)
        self.assertEqual(hook.read_text(), "#!/bin/sh\n")


if __name__ == "__main__":
    unittest.main()
