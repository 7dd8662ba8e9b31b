"""`cmake --install`: the tree is complete, and works wherever it is moved."""
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

from installed import BUILD, SOURCE, environment, install, run


class Tree(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="dispersa-install-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.prefix = cls.folder / "moved here"
        install(cls.prefix)
        cls.share = cls.prefix / "share/dispersa"

    def dispersa(self, *arguments, **options):
        return run(self.prefix / "bin/dispersa", *arguments, env=environment(self.prefix), cwd=self.folder, **options)

    def test_a_shipped_campaign_flies(self):
        done = self.dispersa("run", self.share / "campaigns/table3.yaml", "--cases", 8, "--workers", 1, "--no-histories",
                             "--quiet", "--out", self.folder / "results")
        self.assertIn(done.returncode, (0, 3, 4), done.stderr)
        self.assertEqual(len((self.folder / "results/cases.csv").read_text().splitlines()), 9)
        again = self.dispersa("export", self.folder / "results", "--format", "markdown", "--out", "-")
        self.assertIn("# table3: ", again.stdout, again.stderr)

    def test_every_file_that_a_campaign_names_is_there(self):
        kinds = ("campaign", "vehicle", "autopilot", "reference", "scenario")
        files = [file for file in sorted(self.share.rglob("*.yaml"))
                 if re.search(rf"^schema: dispersa/({'|'.join(kinds)})/", file.read_text(), re.MULTILINE)]
        self.assertGreater(len(files), 50)
        done = self.dispersa("validate", "--quiet", *files)
        self.assertEqual((done.returncode, done.stdout), (0, ""), done.stderr)
        # Nothing is left behind but what only a repository has use for.
        ours = set(run("git", "-c", "safe.directory=*", "-C", SOURCE, "ls-files", "campaigns").stdout.split())
        there = {str(file.relative_to(self.share)) for file in (self.share / "campaigns").rglob("*") if file.is_file()}
        self.assertEqual(ours - there, {"campaigns/run"})

    def test_the_gate_finds_the_program(self):
        done = run(self.share / "campaigns/gate", self.share / "campaigns/smoke.yaml", self.folder / "gate", "--workers", "0",
                   env={**environment(self.prefix), "PATH": "/usr/bin:/bin"})
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue((self.folder / "gate/requirements.xml").is_file())

    def test_documents_and_their_links(self):
        documents = self.prefix / "share/doc/dispersa"
        for name in ("README.md", "CHANGELOG.md", "LICENSE", "copyright", "core/campaign_yaml/README.md"):
            self.assertTrue((documents / name).is_file(), name)
        for document in documents.rglob("*.md"):
            if "services/docs/" in str(document):
                continue  # its links are of the site that is made of it (tests/docs)
            text = re.sub(r"```.*?```", "", document.read_text(), flags=re.DOTALL)
            for link in re.findall(r"\]\(([^)#:]+?\.md)(?:#[^)]*)?\)", text):
                self.assertTrue((document.parent / link).exists(), f"{document}: {link}")

    def test_man_pages_and_completion(self):
        if not (BUILD / "manual").is_dir():
            self.skipTest("the man pages are part of a whole build")
        pages = {page.name for page in (self.prefix / "share/man/man1").iterdir()}
        commands = [line.split("\t")[0] for line in self.dispersa("completion", "words", "").stdout.splitlines()]
        self.assertEqual(pages, {f"dispersa{end}.1.gz" for end in
                                 ["", "-coordinator", "-worker", "-keys-init", "-keys-issue", "-keys-list", "-keys-renew", "-keys-retire", "-keys-revoke",
                                  *["-" + name for name in commands]]})
        for place in ("bash-completion/completions/dispersa-worker", "fish/vendor_completions.d/dispersa.fish",
                      "zsh/site-functions/_dispersa"):
            self.assertTrue((self.prefix / "share" / place).is_file(), place)
        self.assertEqual(self.dispersa("completion", "bash").stdout,
                         (self.prefix / "share/bash-completion/completions/dispersa").read_text())
        text = subprocess.run(["zcat", self.prefix / "share/man/man1/dispersa-run.1.gz"], capture_output=True, text=True,
                              check=True).stdout
        for part in (".SH NAME\ndispersa-run \\- fly a campaign", ".SH SYNOPSIS\n.B dispersa\n", "\\-\\-workers", ".SH \"EXIT STATUS\""):
            self.assertIn(part, text)

    def test_nothing_names_the_build(self):
        for file in sorted(self.prefix.rglob("*")):
            if not file.is_file() or file.suffix == ".png":
                continue
            self.assertFalse(re.search(re.escape(str(BUILD)).encode() + rb"[/\0]", file.read_bytes()), file)
        for program in (self.prefix / "bin").iterdir():
            dynamic = run("readelf", "--dynamic", program).stdout
            self.assertNotRegex(dynamic, r"RUNPATH|RPATH", program)


if __name__ == "__main__":
    unittest.main()
