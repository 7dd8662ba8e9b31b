"""test_namespaces.py finds violations in made-up trees."""
import pathlib
import tempfile
import unittest

import test_namespaces

SOURCE = """// What it tests.
#include <gtest/gtest.h>

namespace dispersa::{name} {{

{body}
}}  // namespace dispersa::{name}
"""


def source(name, body="TEST(Sum, IsRight) {}\n"):
    return SOURCE.format(name=name, body=body)


class TestNamespacesTest(unittest.TestCase):
    def check(self, files):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in files.items():
                (root / "tests" / name).parent.mkdir(parents=True, exist_ok=True)
                (root / "tests" / name).write_text(text)
            return test_namespaces.check(root)

    def test_accepts_sources_in_their_namespaces(self):
        self.assertEqual(self.check({
            "unit/a_test.cc": source("a_test", "#define LONG 1\nTEST(Sum, IsRight) {}\n#undef LONG\n"),
            "unit/b_test.cc": source("b_test", "TEST(Sum, IsLeft) {}\n"),
            "verification/a_test.cc": source("a_test"),
        }), [])

    def test_finds_a_source_in_the_common_namespace(self):
        text = source("a_test").replace("dispersa::a_test", "dispersa")
        self.assertEqual(self.check({"unit/a_test.cc": text}), [
            "tests/unit/a_test.cc:1: is not in one `namespace dispersa::a_test`, opened and closed on lines of their own"])

    def test_finds_the_namespace_of_another_source(self):
        self.assertEqual(self.check({"unit/a_test.cc": source("b_test")}), [
            "tests/unit/a_test.cc:1: is not in one `namespace dispersa::a_test`, opened and closed on lines of their own"])

    def test_finds_a_helper_that_nobody_uses(self):
        helpers = "constexpr double kUsed = 1.0, kOther = 2.0;\nstd::vector<int> Made(int n) { return {n}; }\n"
        test = "TEST(Sum, IsRight) { EXPECT_EQ(kUsed, kOther); }\n"
        self.assertEqual(self.check({"unit/a_test.cc": source("a_test", helpers + test)}),
                         ["tests/unit/a_test.cc:7: declares Made, which nobody uses"])
        self.assertEqual(self.check({"unit/a_test.cc": source("a_test", helpers + test.replace("kUsed", "Made(1)[0]"))}),
                         ["tests/unit/a_test.cc:6: declares kUsed, which nobody uses"])

    def test_finds_what_stands_outside(self):
        self.assertEqual(self.check({"unit/a_test.cc": source("a_test") + "int after;\n"}),
                         ["tests/unit/a_test.cc:9: stands outside the source's namespace"])
        text = source("a_test").replace("\nnamespace dispersa", "\nusing namespace std;\nnamespace dispersa")
        self.assertEqual(self.check({"unit/a_test.cc": text}),
                         ["tests/unit/a_test.cc:4: stands outside the source's namespace"])

    def test_finds_a_macro_that_stays(self):
        self.assertEqual(self.check({"unit/a_test.cc": source("a_test", "#define LONG 1\n")}),
                         ["tests/unit/a_test.cc:6: defines LONG, and no #undef takes it back"])

    def test_finds_a_test_that_another_source_of_the_folder_has(self):
        self.assertEqual(self.check({"unit/a_test.cc": source("a_test"), "unit/b_test.cc": source("b_test")}),
                         ["tests/unit/b_test.cc: Sum.IsRight is a test of tests/unit/a_test.cc already"])

    def test_finds_a_tree_without_tests(self):
        self.assertEqual(self.check({}), ["no tests/*/*_test.cc"])


if __name__ == "__main__":
    unittest.main()
