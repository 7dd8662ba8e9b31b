"""The tutorial as an executed notebook: the cells of tutorial.py, each with what it prints, and its pictures."""
import json
import os
import pathlib
import re
import subprocess
import sys
import unittest

from program import CAMPAIGNS, folder_of

TUTORIAL = pathlib.Path(os.environ["DISPERSA_PYTHON_SOURCES"]) / "tutorial"


class Notebook(unittest.TestCase):
    def test_is_the_tutorial_and_runs(self):
        folder = folder_of(type(self))
        (folder / "campaigns").symlink_to(CAMPAIGNS)
        environment = {name: value for name, value in os.environ.items() if name != "MPLBACKEND"}  # the notebook's own
        done = subprocess.run([sys.executable, "-B", TUTORIAL / "notebook.py", "made.ipynb"], cwd=folder, env=environment, text=True,
                              capture_output=True, timeout=500)
        self.assertEqual(done.returncode, 0, done.stderr[-3000:])
        cells = json.loads((folder / "made.ipynb").read_text())["cells"]
        text = (TUTORIAL / "tutorial.py").read_text()
        self.assertEqual([cell["cell_type"] == "markdown" for cell in cells], ["markdown" in head for head in re.findall("(?m)^# %%.*", text)])
        lines = {line for cell in cells for line in "".join(cell["source"]).splitlines()}
        self.assertEqual([line for line in text.splitlines() if not line.startswith("#") and line not in lines | {""}], [])
        outputs = [output for cell in cells for output in cell.get("outputs", [])]
        self.assertIn("completed", "".join("".join(output.get("text", [])) for output in outputs))
        self.assertEqual(sum("image/png" in output.get("data", {}) for output in outputs), 5)


if __name__ == "__main__":
    unittest.main()
