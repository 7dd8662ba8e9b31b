"""The picture of a report on the first pages shows the parts of today's report."""
import os
import pathlib
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "services" / "docs"))
import picture  # noqa: E402

DISPERSA = pathlib.Path(os.environ["DISPERSA_BINARIES"]) / "dispersa"


class PictureTest(unittest.TestCase):
    def test_it_shows_the_parts_of_todays_report(self):
        with tempfile.TemporaryDirectory(prefix="dispersa-picture-") as folder:
            today = picture.parts(picture.fly(DISPERSA, folder, "--cases", "20", "--no-histories"))
        self.assertEqual(picture.PARTS.read_text(), today, "services/docs/picture.py makes the picture and its list anew")

    def test_another_column_is_another_part(self):
        page = '<body><h1>A</h1><th scope="col">Margin</th><nav><a href="#x">B</a></nav><h2>C</h2><h2>D</h2>'
        self.assertEqual(picture.parts(page), "h1: A\nth: Margin\nnav: B\nh2: C\n")
        self.assertNotEqual(picture.parts(page), picture.parts(page.replace("Margin", "Distance")))

    def test_the_first_pages_show_it(self):
        for page in ("README.md", "services/docs/pages/index.md"):
            self.assertIn("images/table3_report.png)", (SOURCE / page).read_text())


if __name__ == "__main__":
    unittest.main()
