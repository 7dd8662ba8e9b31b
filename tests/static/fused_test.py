"""fused.py finds operations that compilers fused, in objects built for this test."""
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

import fused

OBJDUMP = os.environ.get("OBJDUMP", "objdump")
# What fuses against the wish of -ffp-contract=off is GCC 12, so it is GCC that compiles here. Later ones keep it.
FORMERLY = "g++ -O3 -march=x86-64-v3 -ffp-contract=off"
GCC = subprocess.run(["g++", "-dumpversion"], check=True, capture_output=True, text=True).stdout.strip()
FUSED_STRAIGHT, FUSED_LOOP = ({"vfmsubadd"}, {"vfmaddsub"}) if GCC == "12" else (set(), set())
CONTRACT = f"{FORMERLY} -fno-tree-vectorize"

STRAIGHT = """
    void f(const double* a, const double* b, double* out) {
      const double x = a[0] * b[0], y = a[1] * b[1], z = a[2] * b[2];
      out[0] = x + z; out[1] = x - z; out[2] = y + z; out[3] = y - z;
    }"""
LOOP = """
    void f(const double* __restrict a, const double* __restrict b, double* __restrict out, int n) {
      for (int i = 0; i < n; ++i) {
        out[2 * i] = a[2 * i] * b[2 * i] - out[2 * i];
        out[2 * i + 1] = a[2 * i + 1] * b[2 * i + 1] + out[2 * i + 1];
      }
    }"""
FMA = """
    static inline double Fma(double a, double b, double c) {
    #ifdef DISPERSA_NO_FMA
      return a * b + c;
    #else
      return __builtin_fma(a, b, c);
    #endif
    }"""


class FusedTest(unittest.TestCase):
    def check(self, compiler, source):
        """Instructions that fused.py finds in the source's object, without their operand order."""
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "core").mkdir()
            (root / "core/a.cc").write_text(source + "\n")
            command = f"{compiler} -o a.o -c core/a.cc"
            subprocess.run(command.split(), cwd=root, check=True)
            entry = {"directory": folder, "file": "core/a.cc", "command": command}
            lines = fused.check(root, [entry], OBJDUMP)
        for line in lines:
            self.assertRegex(line, r"^core/a\.cc: \w+\(.*\): \d+ × vf\w+ that the source did not ask for$")
        return {re.search(r"vfn?m(addsub|subadd|add|sub)", line)[0] for line in lines}

    def test_the_former_flags_let_the_vectorisers_fuse(self):
        self.assertEqual(self.check(FORMERLY, STRAIGHT), FUSED_STRAIGHT)
        self.assertEqual(self.check(FORMERLY, LOOP), FUSED_LOOP)

    def test_one_vectoriser_is_enough_to_fuse(self):
        self.assertEqual(self.check(f"{FORMERLY} -fno-tree-slp-vectorize", LOOP), FUSED_LOOP)

    def test_the_contract_fuses_nothing(self):
        self.assertEqual(self.check(CONTRACT, STRAIGHT), set())
        self.assertEqual(self.check(CONTRACT, LOOP), set())

    def test_finds_plain_contraction(self):
        self.assertEqual(self.check(f"{CONTRACT} -ffp-contract=fast",
                                    "double f(double a, double b, double c) { return c - a * b; }"), {"vfnmadd"})

    def test_a_source_may_say_that_it_fuses(self):
        self.assertEqual(self.check(CONTRACT, FMA + "double f(double a, double b) { return Fma(a, b, a); }"),
                         set())

    def test_a_source_that_fuses_hides_no_other_fusion(self):
        self.assertEqual(self.check(f"{CONTRACT} -ffp-contract=fast", FMA + """
            double f(double a, double b) { return Fma(a, b, a); }
            double g(double a, double b) { return a * b - a; }"""), {"vfmadd", "vfmsub"})
        self.assertEqual(self.check(FORMERLY, FMA + "double g(double a) { return Fma(a, a, a); }" + STRAIGHT),
                         FUSED_STRAIGHT)

    def test_finds_a_fusion_of_which_the_definition_knows_nothing(self):
        self.assertEqual(self.check(CONTRACT, "double f(double a, double b) { return __builtin_fma(a, b, a); }"),
                         {"vfmadd"})

    def test_an_object_that_is_missing_and_an_empty_list_fail(self):
        entry = {"directory": "/nowhere", "file": "core/a.cc", "command": "c++ -o a.o -c core/a.cc"}
        self.assertEqual(fused.check(pathlib.Path("/nowhere"), [entry], OBJDUMP),
                         ["core/a.cc: is not built, so nothing is known about it"])
        self.assertEqual(fused.check(pathlib.Path("/nowhere"), [], OBJDUMP),
                         ["no source of core/ in compile_commands.json"])

    def test_instructions(self):
        for instruction in ("vfmadd231sd", "vfnmsub132pd", "vfmaddsub213ps", "vfmsubadd231pd", "vfmaddpd"):
            self.assertEqual(fused.fused(f"0000 <f>:\n   4:\t{instruction} %xmm0,%xmm1,%xmm2\n"),
                             {("f", instruction): 1})
        for instruction in ("vaddsubpd", "vmulpd", "vfixupimmpd"):
            self.assertFalse(fused.fused(f"0000 <f>:\n   4:\t{instruction} %xmm0,%xmm1,%xmm2\n"))


if __name__ == "__main__":
    unittest.main()
