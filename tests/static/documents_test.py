"""documents.py counts long sentences and finds a wrong changelog in made-up trees."""
import pathlib
import tempfile
import unittest

import documents

LONG = "word " * 26 + "end."
SHORT = "word " * 24 + "end."


class DocumentsTest(unittest.TestCase):
    def check(self, counts="", page=LONG, changelog="# Changelog\n"):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / documents.COUNTS).parent.mkdir(parents=True)
            (root / documents.COUNTS).write_text("page,long_sentences\n" + counts)
            (root / "page.md").write_text(page)
            (root / "CHANGELOG.md").write_text(changelog)
            return documents.check(root)

    def test_a_sentence_has_25_words(self):
        self.assertEqual([26 + 1, 24 + 1], [len(words) for words in documents.sentences(f"{LONG} {SHORT}")])
        self.assertEqual(1, documents.count(f"{LONG} {SHORT}"))

    def test_code_tables_and_headings_do_not_count(self):
        for text in (f"```\n{LONG}\n```\n", f"| {LONG} |\n", f"# {LONG}\n", f"`{LONG}`\n", f"<!-- {LONG} -->\n"):
            self.assertEqual(0, documents.count(text), text)
        self.assertEqual(0, documents.count(f"- {SHORT[:-1]}\n- {SHORT[:-1]}\n"))

    def test_the_count_may_not_rise(self):
        self.assertEqual(self.check(), ["page.md: 1 sentences of more than 25 words, allowed: 0"])
        self.assertEqual(self.check("page.md,1\n"), [])
        self.assertEqual(self.check("page.md,2\n", SHORT), [])

    def test_record_only_lowers(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / documents.COUNTS).parent.mkdir(parents=True)
            (root / documents.COUNTS).write_text("page,long_sentences\na.md,3\nb.md,1\ngone.md,4\n")
            (root / "a.md").write_text(LONG)
            (root / "b.md").write_text(f"{LONG} {LONG}")
            documents.record(root)
            self.assertEqual((root / documents.COUNTS).read_text(), "page,long_sentences\na.md,1\nb.md,1\n")

    def test_a_changelog_has_dated_releases_of_thirty_lines(self):
        self.assertEqual(self.check(page="", changelog="# Changelog\n\n## 0.1.0, 2026-11-27\n\n" + "- x\n" * 30), [])
        self.assertEqual(self.check(page="", changelog="\n## 0.1.0, 2026-11-27\n\n" + "- x\n" * 31),
                         ["CHANGELOG.md: 0.1.0, 2026-11-27 has 31 lines, allowed: 30"])
        self.assertIn("'Unreleased' is no release", self.check(page="", changelog="\n## Unreleased\n")[0])


if __name__ == "__main__":
    unittest.main()
