"""libm.py finds calls of libm in libraries built for this test."""
import os
import pathlib
import subprocess
import tempfile
import unittest

import libm

CXX = os.environ.get("CXX", "c++")
NM = os.environ.get("NM", "nm")


class LibmTest(unittest.TestCase):
    def check(self, source):
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "a.cc").write_text(f"#include <cmath>\n#include <random>\n{source}\n")
            subprocess.run([CXX, "-O2", "-std=c++20", "-fno-math-errno", "-c", "a.cc"], cwd=folder, check=True)
            subprocess.run(["ar", "rcs", "liba.a", "a.o"], cwd=folder, check=True)
            return [line.split("liba.a: ")[1] for line in libm.check(NM, [f"{folder}/liba.a"])]

    def test_accepts_exact_functions_and_own_ones(self):
        self.assertEqual(self.check("""
            namespace dispersa { double Sin(double); }
            double f(double x) {
              return dispersa::Sin(std::sqrt(std::floor(x))) + std::fmod(x, 2.0) + std::ldexp(x, 3);
            }"""), [])

    def test_finds_each_call(self):
        self.assertEqual(self.check("""
            double f(double x) { return std::sin(x); }
            float g(float x) { return std::pow(x, 2.5f); }
            long double h(long double x) { return std::log1p(x); }"""),
            ["a.o calls log1pl", "a.o calls powf", "a.o calls sin"])

    def test_finds_calls_through_the_standard_library(self):
        self.assertEqual(self.check("""
            double f(std::mt19937& g) { return std::normal_distribution<double>()(g); }"""), ["a.o calls log"])

    def test_an_empty_list_of_libraries_fails(self):
        self.assertEqual(libm.check(NM, []), ["no library to check"])

    def test_names(self):
        for symbol in ("atan2", "atan2f", "sincosl", "__exp_finite", "cexp", "_ZGVdN4v_sin", "erfc", "pow@GLIBC_2.29"):
            self.assertTrue(libm.FORBIDDEN.fullmatch(symbol), symbol)
        for symbol in ("Sleef_finz_sind1_u10purecfma", "sqrt", "floor", "fma", "modf", "login", "_ZN8dispersa3SinEd"):
            self.assertFalse(libm.FORBIDDEN.fullmatch(symbol), symbol)


if __name__ == "__main__":
    unittest.main()
