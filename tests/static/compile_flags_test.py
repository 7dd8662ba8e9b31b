"""compile_flags.py finds commands that break the floating-point contract."""
import pathlib
import unittest

import compile_flags

GOOD = "c++ -O3 -march=x86-64-v3 -ffp-contract=off -fno-tree-vectorize -o a.o -c a.cc"


def check(command, file="/src/core/math/a.cc"):
    entry = {"directory": "/build", "file": file, "command": command}
    return compile_flags.check(pathlib.Path("/src"), [entry])


class CompileFlagsTest(unittest.TestCase):
    def test_accepts_the_contract(self):
        self.assertEqual(check(GOOD), [])

    def test_finds_missing_options(self):
        self.assertEqual(check("c++ -c a.cc"), ["core/math/a.cc: lacks -march=x86-64-v3",
                                                "core/math/a.cc: lacks -ffp-contract=off",
                                                "core/math/a.cc: lacks -fno-tree-vectorize"])

    def test_the_last_option_counts(self):
        self.assertEqual(check(GOOD + " -ffp-contract=fast -march=native"),
                         ["core/math/a.cc: lacks -march=x86-64-v3", "core/math/a.cc: lacks -ffp-contract=off"])

    def test_sources_of_lanes_may_be_for_a_newer_processor(self):
        newer = GOOD + " -march=x86-64-v4"
        self.assertEqual(check(newer), ["core/math/a.cc: lacks -march=x86-64-v3"])
        self.assertEqual(check(newer + " -DDISPERSA_WIDTHS=8"), [])
        self.assertEqual(check(GOOD + " -march=native -DDISPERSA_WIDTHS=8"), ["core/math/a.cc: lacks -march=x86-64-v3"])

    def test_finds_value_changing_options(self):
        self.assertEqual(check(GOOD + " -ffast-math"), ["core/math/a.cc: -ffast-math"])
        self.assertEqual(check(GOOD + " -ftree-slp-vectorize"), ["core/math/a.cc: -ftree-slp-vectorize"])

    def test_services_count_and_tests_do_not(self):
        self.assertEqual(check(GOOD + " -Ofast", "/src/services/worker/a.cc"), ["services/worker/a.cc: -Ofast"])
        self.assertEqual(check("c++ -c a.cc", "/src/tests/unit/a.cc"),
                         ["no source of core/ in compile_commands.json"])

    def test_a_module_that_is_one_source_counts(self):
        self.assertEqual(check(GOOD + " -Ofast", "/src/build/core/math/CMakeFiles/m.dir/Unity/unity_0_cxx.cxx"),
                         ["core/math: -Ofast"])
        self.assertEqual(check(GOOD + " -Ofast", "/src/build/tests/CMakeFiles/m.dir/Unity/unity_0_cxx.cxx"),
                         ["no source of core/ in compile_commands.json"])


if __name__ == "__main__":
    unittest.main()
