"""What messages cost a coordinator: processor time of its process, on loopback. The costs of
tests/distributed/thousand_workers_test.cc.

usage: messages.py BUILD [--keys]
Each figure is a difference of two measurements: workers without cases (statuses and orders alone), workers that return one
result in each report, workers that return many. DDS domain 40, in a network namespace of its own:
unshare -n sh -c "ip link set lo up; python3 tests/benchmarks/messages.py build/release".
"""
import pathlib
import subprocess
import sys
import tempfile
import time

from throughput import cpu_s, stored

WORKERS = 40
IDLE_S = 20.0
SINGLE_CASES, MANY_CASES = 20_000, 100_000
FLIGHT_MS = 20  # above 5 ms each result has a report of its own
STATUSES_PER_S = 2.0
CAMPAIGN = pathlib.Path(__file__).resolve().parents[2] / "campaigns/smoke.yaml"


class Service:
    """A coordinator and its workers that make results up, for one measurement."""

    def __init__(self, build, keys, cases, workers, flight_ms):
        self.folder = tempfile.TemporaryDirectory()
        data = pathlib.Path(self.folder.name) / "data"
        self.cases = cases
        network = {role: ["--domain", "40", "--address", "127.0.0.1"] for role in ("coordinator", "worker", "client")}
        if keys:
            authority = pathlib.Path(self.folder.name) / "authority"
            subprocess.run([build / "bin/dispersa", "keys", "init", authority], check=True, stdout=subprocess.DEVNULL)
            for role in network:
                subprocess.run([build / "bin/dispersa", "keys", "issue", authority, "--role", role, "--name", "one"], check=True,
                               stdout=subprocess.DEVNULL)
                network[role] += ["--keys", authority / "issued" / f"{role}-one"]
        self.coordinator = subprocess.Popen([build / "bin/dispersa-coordinator", "--data", data, "--audit", "0",
                                             *network["coordinator"]], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.crew = [subprocess.Popen([build / "tools/noop_worker", "--flight-ms", str(flight_ms), *network["worker"]],
                                      stderr=subprocess.DEVNULL) for _ in range(workers)]
        if cases:
            launched = subprocess.run([build / "bin/dispersa", "launch", CAMPAIGN, "--cases", str(cases), *network["client"]],
                                      check=True, capture_output=True, text=True)
            self.out = data / launched.stdout.strip() / "results"

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in (self.coordinator, *self.crew):
            process.kill()
            process.wait()
        self.folder.cleanup()

    def cpu_between(self, first, last):
        """Processor seconds and seconds from `first` to `last` stored results, and how many."""
        def at(count):
            while (there := stored(self.out)) < count:
                if self.coordinator.poll() is not None:
                    raise RuntimeError(f"the coordinator ended at {there} of {self.cases} cases")
                time.sleep(0.05)
            return cpu_s([self.coordinator]), time.monotonic(), there
        begin, end = at(first), at(last)
        return [b - a for a, b in zip(begin, end)]


def main(build, keys):
    with Service(build, keys, 0, WORKERS, 0) as service:
        time.sleep(10.0)  # they join
        begin = cpu_s([service.coordinator])
        time.sleep(IDLE_S)
        idle = (cpu_s([service.coordinator]) - begin) / IDLE_S
    with Service(build, keys, 0, 0, 0) as service:
        time.sleep(2.0)
        begin = cpu_s([service.coordinator])
        time.sleep(IDLE_S)
        alone = (cpu_s([service.coordinator]) - begin) / IDLE_S
    status = (idle - alone) / (WORKERS * STATUSES_PER_S)
    print(f"a status with its share of orders: {1e6 * status:.0f} us ({WORKERS} workers without cases take {100 * idle:.1f} % of a "
          f"core, a coordinator alone {100 * alone:.1f} %)", flush=True)
    with Service(build, keys, MANY_CASES, 2, 0) as service:
        cpu, took, flown = service.cpu_between(MANY_CASES // 10, MANY_CASES)
    many = (cpu - (2 * STATUSES_PER_S * status + alone) * took) / flown
    print(f"a result among many in a report: {1e6 * many:.0f} us ({flown / took:.0f} results/s)", flush=True)
    with Service(build, keys, SINGLE_CASES, WORKERS, FLIGHT_MS) as service:
        cpu, took, flown = service.cpu_between(SINGLE_CASES // 5, SINGLE_CASES)
    single = (cpu - (WORKERS * STATUSES_PER_S * status + alone) * took) / flown
    print(f"a result in a report of its own: {1e6 * single:.0f} us ({flown / took:.0f} results/s); so the report takes "
          f"{1e6 * (single - many):.0f} us")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]).resolve(), "--keys" in sys.argv[2:])
