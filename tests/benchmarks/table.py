"""One table of what the core costs on this machine: flights side by side, their right-hand side, ascents, the
optimiser, campaigns in process and over DDS, memory and instructions.

usage: table.py BUILD [OLD_BUILD]
BUILD is a build folder with the benchmarks and programs; OLD_BUILD, one of another commit, gives the ratio of its
flight. Medians of five turns; callgrind counts only where valgrind is installed.
"""
import json
import os
import pathlib
import platform
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
TURNS = 5
CASES = 400


def output(*command):
    return subprocess.run(command, check=True, text=True, capture_output=True).stdout


def processor():
    model = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text())
    return model.group(1) if model else platform.machine()


def benchmarks(program, wanted):
    """{name: median ms an item} of a Google Benchmark program; an iteration without items is one."""
    report = json.loads(output(program, f"--benchmark_filter={wanted}", "--benchmark_format=json",
                               f"--benchmark_repetitions={TURNS}", "--benchmark_report_aggregates_only=true"))
    found = {}
    for row in report["benchmarks"]:
        if row["aggregate_name"] != "median":
            continue
        per_unit = {"ns": 1e-6, "us": 1e-3, "ms": 1.0, "s": 1e3}[row["time_unit"]]
        rate = row.get("items_per_second")
        found[row["run_name"].split("/min_time")[0]] = 1e3 / rate if rate else row["cpu_time"] * per_unit
    return found


def campaign(dispersa, *arguments):
    """Flights a second of a campaign of CASES cases, its start and its report included."""
    rates = []
    for _ in range(TURNS):
        with tempfile.TemporaryDirectory() as folder:
            begin = time.monotonic()
            # Its verdict is the exit code.
            subprocess.run([dispersa, "run", ROOT / "campaigns/table3.yaml", "--cases", str(CASES), "--quiet",
                            "--out", f"{folder}/out", *arguments], capture_output=True, timeout=1800, check=False)
            rates.append(CASES / (time.monotonic() - begin))
    return statistics.median(rates)


def peak_memory_mb(dispersa):
    """Of one process that flies side by side on one thread."""
    with tempfile.TemporaryDirectory() as folder:
        child = subprocess.Popen([dispersa, "run", ROOT / "campaigns/smoke.yaml", "--quiet", "--out", f"{folder}/out",
                                  "--workers", "0", "--threads", "1"], stdout=subprocess.DEVNULL,
                                 stderr=subprocess.DEVNULL)
        _, _, usage = os.wait4(child.pid, 0)
        return usage.ru_maxrss / 1024.0


def instructions(dispersa):
    """Millions a flight in process on one thread, by callgrind: what 16 cases take beyond 8, histories and report included."""
    def count(cases):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={folder}/profile", dispersa,
                                   "run", ROOT / "campaigns/table3.yaml", "--cases", str(cases), "--quiet", "--out",
                                   f"{folder}/out", "--workers", "0", "--threads", "1"],
                                  text=True, capture_output=True, timeout=1800, check=False)
            return int(re.search(r"Collected : (\d+)", done.stderr).group(1))
    return (count(16) - count(8)) / 8e6


def main(build, old_build=None):
    programs = build / "benchmarks"
    dispersa = build / "bin/dispersa"
    compiler = re.search(r"CMAKE_CXX_COMPILER:\w+=(.*)", (build / "CMakeCache.txt").read_text()).group(1)
    print(f"machine   {processor()}, {os.cpu_count()} processors")
    print(f"compiler  {output(compiler, '--version').splitlines()[0]}")
    print(f"commit    {output('git', '-C', str(ROOT), 'rev-parse', '--short', 'HEAD').strip()}")
    print(f"load      {os.getloadavg()[0]:.2f} over the minute before\n")
    rows = []
    flights = benchmarks(programs / "flight_benchmark", "^(Flight|Flights|RightHandSide)(/|$)")
    one = flights.pop("Flight")
    rows.append(("flight, one lane", one, "ms", None))
    if old_build:
        old = benchmarks(old_build / "benchmarks/flight_benchmark", "^Flight(/|$)")["Flight"]
        rows.append(("flight of the other build", old, "ms", one / old))
    rows.append(("right-hand side alone", 1e6 * flights.pop("RightHandSide"), "ns", None))
    for name, ms in flights.items():
        rows.append((f"flight, {name.removeprefix('Flights/').replace('/', ', lanes ')}", ms, "ms", one / ms))
    ascents = benchmarks(programs / "ascent_benchmark", ".")
    for name, ms in ascents.items():
        lanes = name.startswith("Ascents/")
        label = f"ascent, lanes {name.split('/')[1]}" if lanes else "optimisation of slv4_500km, one thread"
        rows.append((label, ms, "ms", ascents["Ascents/1"] / ms if lanes else None))
    inside = campaign(dispersa, "--workers", "0", "--threads", "2")
    rows.append((f"table3, {CASES} cases, in process, 2 threads", inside, "flights/s", None))
    over = campaign(dispersa, "--workers", "2")
    rows.append((f"table3, {CASES} cases, over DDS, 2 workers", over, "flights/s", over / inside))
    rows.append(("memory of a process that flies", peak_memory_mb(dispersa), "MB", None))
    if shutil.which("valgrind"):
        rows.append(("instructions a flight, in process", instructions(dispersa), "M", None))
    for label, value, unit, ratio in rows:
        print(f"{label:<44} {value:>10.3f} {unit:<10}" + (f" {ratio:6.2f} x" if ratio else ""))


if __name__ == "__main__":
    main(*(pathlib.Path(argument) for argument in sys.argv[1:]))
