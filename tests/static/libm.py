"""Checks that no library of the core calls a transcendental function of libm.

glibc chooses its code by processor, so a call would make results depend on the machine; core/math/functions.h
is the only way to such a function. Correctly rounded or exact ones (sqrt, fma, floor, fmod, ...) are free.

usage: libm.py NM LIBRARY...
"""
import re
import subprocess
import sys

FUNCTIONS = """
    sin cos tan asin acos atan atan2 sincos sinh cosh tanh asinh acosh atanh
    exp exp2 exp10 pow10 expm1 log log2 log10 log1p pow cbrt hypot
    erf erfc lgamma lgamma_r tgamma gamma j0 j1 jn y0 y1 yn
    cabs carg cexp clog cpow csqrt csin ccos ctan casin cacos catan csinh ccosh ctanh casinh cacosh catanh
""".split()
# A float or long double variant, the aliases of -ffinite-math-only, and the vector forms of libmvec.
FORBIDDEN = re.compile(rf"((__)?({'|'.join(FUNCTIONS)})(f|l|f32|f64|f128)?(_finite)?|_ZGV.*)(@.*)?")


def calls(nm_output):
    """(object file, symbol) of each forbidden undefined symbol that `nm` lists."""
    found, member = [], "?"
    for line in nm_output.splitlines():
        if line.endswith(":"):
            member = line[:-1]
        match = re.fullmatch(r"\s*[Uwv] (\S+)", line)
        if match and FORBIDDEN.fullmatch(match.group(1)):
            found.append((member, match.group(1)))
    return found


def check(nm, libraries):
    """Violations, one line each."""
    problems = [] if libraries else ["no library to check"]
    for library in libraries:
        output = subprocess.run([nm, "--undefined-only", library], check=True, text=True, capture_output=True)
        problems += [f"{library}: {member} calls {symbol}" for member, symbol in calls(output.stdout)]
    return problems


if __name__ == "__main__":
    found = check(sys.argv[1], sys.argv[2:])
    print("\n".join(found))
    sys.exit(1 if found else 0)
