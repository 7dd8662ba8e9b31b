"""lane_symbols.py finds functions that the linker might take from code for a newer processor."""
import os
import pathlib
import subprocess
import tempfile
import unittest

import lane_symbols

SOURCE = """
namespace dispersa::lanes::v4 { template <class T> __attribute__((noinline)) T Own(T x) { return x + x; } }
inline __attribute__((noinline)) double Common(double x) { return x * x; }
double Use(double x) { return dispersa::lanes::v4::Own(x)%s; }
"""


class LaneSymbolsTest(unittest.TestCase):
    def check(self, call):
        with tempfile.TemporaryDirectory() as folder:
            source, compiled = pathlib.Path(folder, "a.cc"), pathlib.Path(folder, "a.o")
            source.write_text(SOURCE % call)
            subprocess.run([os.environ.get("CXX", "c++"), "-O2", "-c", source, "-o", compiled], check=True)
            return lane_symbols.check(os.environ.get("NM", "nm"), [str(compiled)])

    def test_accepts_what_is_its_own(self):
        self.assertEqual(self.check(""), [])

    def test_finds_what_is_everybodys(self):
        found = self.check(" + Common(x)")
        self.assertEqual(len(found), 1)
        self.assertIn("Common(double): is compiled for v4", found[0])

    def test_no_object_is_no_success(self):
        self.assertEqual(lane_symbols.check("nm", []), ["no object to look at"])


if __name__ == "__main__":
    unittest.main()
