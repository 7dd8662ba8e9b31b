"""tests/suites.cmake lists the suites of a made-up program to ctest, as many as there are, and whatever hinders it fails."""
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

SUITES = pathlib.Path(__file__).resolve().parents[1] / "suites.cmake"
CTEST = pathlib.Path(os.environ.get("CMAKE", "/usr/bin/cmake")).with_name("ctest")
LISTED = """Running main() from a library
Sobol.
  FirstPoints
  IsEven
Of/Pair.
  Flies/0  # GetParam() = 1. of two
Lanes/0.  # TypeParam = double
  Add
Long/Ones.
  Fly/0  # GetParam() = "a [ b; c"
  Fly/twice  # GetParam() = (1, ";")
"""


class Suites(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.program = self.folder / "unit_tests"
        (self.folder / "CTestTestfile.cmake").write_text(
            f'set(label unit)\nset(program "{self.program}")\nset(limit_s 77)\nset(cost_s 3)\nset(singly Long/Ones Pair)\ninclude("{SUITES}")\n')

    def write(self, text):
        self.program.write_text(f"#!/bin/sh\n{text}\n")
        self.program.chmod(0o755)

    def listed(self):
        done = subprocess.run([CTEST, "--test-dir", self.folder, "--show-only=json-v1"], capture_output=True, text=True)
        return json.loads(done.stdout)["tests"] if done.returncode == 0 else done.stderr

    def test_each_suite_is_a_test(self):
        self.write(f"cat <<'END'\n{LISTED}END")
        tests = self.listed()
        self.assertEqual({test["name"]: test["command"][1:] for test in tests},
                         {"unit.Sobol": ["--gtest_filter=Sobol.*"], "unit.Of/Pair": ["--gtest_filter=Of/Pair.*"],
                          "unit.Lanes/0": ["--gtest_filter=Lanes/0.*"],
                          "unit.Long/Ones.Fly/0": ["--gtest_filter=Long/Ones.Fly/0"],
                          "unit.Long/Ones.Fly/twice": ["--gtest_filter=Long/Ones.Fly/twice"]})
        self.assertEqual(len(tests), 5)
        properties = {each["name"]: each["value"] for each in tests[0]["properties"]}
        self.assertEqual((properties["LABELS"], properties["TIMEOUT"], properties["COST"]), (["unit"], 77.0, 3.0))

    def test_a_program_that_is_built_anew_is_asked_anew(self):
        self.write("echo First.")
        self.assertEqual([test["name"] for test in self.listed()], ["unit.First"])
        os.utime(self.folder / "unit_tests_suites.txt", (1, 1))  # older than what follows
        self.write("echo First.; echo Second.")
        self.assertEqual([test["name"] for test in self.listed()], ["unit.First", "unit.Second"])

    def test_a_program_that_is_not_built_or_lists_nothing_is_a_failure(self):
        self.assertEqual([test["name"] for test in self.listed()], ["unit_tests_NOT_BUILT"])
        self.write("echo First.; exit 3")
        for _ in range(2):
            self.assertIn("unit_tests does not list its tests: 3", self.listed())


if __name__ == "__main__":
    unittest.main()
