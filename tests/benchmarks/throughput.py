"""What one coordinator bears: results a second, its CPU, memory, disk and network, with workers that make their results up
at once.

usage: throughput.py BUILD [CASES [WORKERS]]     (200000 cases, 2 workers; 20000 cases at least)
On loopback, in DDS domain 36. The figures are of the time between the first and the last stored result. The bytes of the
network are those of the whole loopback interface: use a namespace of its own,
unshare -n sh -c "ip link set lo up; python3 tests/benchmarks/throughput.py build/release".
"""
import os
import pathlib
import sqlite3
import subprocess
import sys
import tempfile
import time

NETWORK = ["--domain", "36", "--address", "127.0.0.1"]
LIMIT_S = 900


def cpu_s(processes):
    """User and system time that they have used."""
    ticks = 0
    for process in processes:
        fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
        ticks += int(fields[11]) + int(fields[12])
    return ticks / os.sysconf("SC_CLK_TCK")


def resident_mb(process):
    status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
    return int(status.partition("VmRSS:")[2].split()[0]) / 1024


def loopback_bytes():
    line = next(line for line in pathlib.Path("/proc/net/dev").read_text().splitlines() if line.strip().startswith("lo:"))
    return int(line.partition(":")[2].split()[0])


def disk_mb(out):
    return sum(file.stat().st_size for file in pathlib.Path(out).rglob("*") if file.is_file()) / 1e6


def stored(out):
    try:
        with sqlite3.connect(f"file:{out}/results.sqlite?mode=ro", uri=True) as database:
            return database.execute("SELECT coalesce(max(rowid), 0) FROM execution").fetchone()[0]
    except sqlite3.OperationalError:
        return 0


def measure(build, cases, workers, data, processes):
    coordinator = subprocess.Popen([build / "bin/dispersa-coordinator", "--data", data, "--audit", "0", *NETWORK],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    processes.append(coordinator)
    campaign = pathlib.Path(__file__).resolve().parents[2] / "campaigns/smoke.yaml"
    launched = subprocess.run([build / "bin/dispersa", "launch", campaign, "--cases", str(cases), *NETWORK], check=True,
                              capture_output=True, text=True)
    out = data / launched.stdout.strip() / "results"
    crew = [subprocess.Popen([build / "tools/noop_worker", *NETWORK]) for _ in range(workers)]
    processes += crew
    deadline = time.monotonic() + LIMIT_S

    def wait_for(count):
        while (there := stored(out)) < count:
            if time.monotonic() > deadline or coordinator.poll() is not None:
                raise RuntimeError(f"{there} of {cases} cases")
            time.sleep(0.1)
        return there, time.monotonic(), cpu_s([coordinator]), cpu_s(crew), loopback_bytes()

    first, last = wait_for(1), wait_for(cases)
    flown, took_s, coordinator_s, crew_s, sent = (b - a for a, b in zip(first, last))
    print(f"{cases} cases, {workers} workers: {flown / took_s:.0f} results/s; CPU of a case: coordinator "
          f"{1e6 * coordinator_s / flown:.1f} us, workers {1e6 * crew_s / flown:.1f} us; the coordinator's memory "
          f"{resident_mb(coordinator):.0f} MB; network {sent / flown:.0f} bytes a case; disk {disk_mb(out):.0f} MB; "
          f"a worker's memory {max(map(resident_mb, crew)):.0f} MB")


def main(build, cases=200_000, workers=2):
    processes = []
    with tempfile.TemporaryDirectory() as folder:
        try:
            measure(build, cases, workers, pathlib.Path(folder) / "data", processes)
        finally:
            for process in processes:
                process.kill()
                process.wait()


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]).resolve(), *map(int, sys.argv[2:4]))
