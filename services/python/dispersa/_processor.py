"""Refuses a processor on which the extension would end the interpreter with an illegal instruction."""

NEEDED = {"avx2", "fma", "bmi1", "bmi2", "popcnt"}


def check(cpuinfo="/proc/cpuinfo"):
    """ImportError unless the processor is of level x86-64-v3."""
    with open(cpuinfo) as stream:
        flags = next((set(line.split(":", 1)[1].split()) for line in stream if line.startswith("flags")), set())
    if not NEEDED <= flags:
        raise ImportError("dispersa needs a processor of level x86-64-v3 (AVX2, FMA, BMI2: Intel Haswell, AMD Zen, or later)")
