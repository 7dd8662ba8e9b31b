"""runtime_packages.py finds libraries without their package and packages without use."""
import unittest

import runtime_packages


class RuntimePackagesTest(unittest.TestCase):
    def test_reads_lists_and_programs(self):
        self.assertEqual(runtime_packages.listed_packages("# why\nliba1\nlibb2 | libb3  # more\n"),
                         {frozenset({"liba1"}), frozenset({"libb2", "libb3"})})
        self.assertIn("libc.so.6", runtime_packages.needed_libraries("/bin/ls"))
        self.assertEqual(runtime_packages.owners({"libc.so.6", "libnosuch.so.1", "libgcc_s.so.1"}),
                         {"libc.so.6": "libc6", "libnosuch.so.1": None, "libgcc_s.so.1": "libgcc-s1"})

    def test_accepts_what_fits(self):
        self.assertEqual(runtime_packages.check({frozenset({"liba0", "liba1"})}, {"liba.so.1": "liba1", "libc.so.6": "libc6"}), [])

    def test_finds_what_does_not(self):
        self.assertEqual(runtime_packages.check({frozenset({"libb2", "libb3"})}, {"liba.so.1": "liba1", "libz.so.9": None}),
                         ["liba.so.1 belongs to liba1, which is not listed",
                          "libz.so.9 belongs to no package, which is not listed",
                          "libb2 | libb3 is listed but no program loads it"])


if __name__ == "__main__":
    unittest.main()
