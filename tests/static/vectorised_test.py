"""vectorised.py finds operations fused by GCC's vectorisers, in programs built for this test."""
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

import fused_test
import vectorised


class VectorisedTest(unittest.TestCase):
    def check(self, compiler, source):
        """Instructions that vectorised.py finds in a shared object of the source, without their operand order."""
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder) / "program.so"
            (pathlib.Path(folder) / "a.cc").write_text(source + "\n")
            subprocess.run(f"{compiler} -shared -fPIC -o {program} a.cc".split(), cwd=folder, check=True)
            lines = vectorised.check(os.environ.get("OBJDUMP", "objdump"), [program])
        for line in lines:
            self.assertRegex(line, r"^\S+/program\.so: \w+\(.*\): \d+ × vf\w+ that no source asks for$")
        return {re.search(r"vfm(addsub|subadd)", line)[0] for line in lines}

    def test_finds_what_either_vectoriser_fuses(self):
        self.assertEqual(self.check(fused_test.FORMERLY, fused_test.STRAIGHT), fused_test.FUSED_STRAIGHT)
        self.assertEqual(self.check(fused_test.FORMERLY, fused_test.LOOP), fused_test.FUSED_LOOP)

    def test_the_contract_and_what_a_source_asks_for_pass(self):
        self.assertEqual(self.check(fused_test.CONTRACT, fused_test.STRAIGHT + fused_test.LOOP.replace("void f", "void g")),
                         set())
        self.assertEqual(self.check(fused_test.CONTRACT,
                                    fused_test.FMA + "double f(double a, double b) { return Fma(a, b, a); }"), set())


if __name__ == "__main__":
    unittest.main()
