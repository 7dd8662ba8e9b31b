"""One table of what the core costs on this machine: flights side by side and their floor, ascents, the optimiser, the
tuner, campaigns in process and over DDS, memory and instructions.

usage: table.py BUILD [OLD_BUILD]
       table.py --instructions BUILD
       table.py --capabilities BUILD
BUILD is a build folder with the benchmarks (target by_hand) and programs; OLD_BUILD, one of another commit, gives ratios. What is
compared is measured in turn, so that a change of the machine's load meets both: medians of five turns, ratios with
their least and greatest. Callgrind counts where valgrind is installed; --instructions counts and does nothing else.
--capabilities counts flights of shipped campaigns with and without guidance, own metrics, bending and dispersed masses.
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
TABLE3 = ROOT / "campaigns/table3.yaml"
TURNS = 5
CASES = 400
EVALUATIONS = 64  # the fewest that the tuner takes
VERDICTS = (0, 3, 4, 7)  # exit codes of a campaign that has flown


def output(*command):
    return subprocess.run(command, check=True, text=True, capture_output=True).stdout


def processor():
    model = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text())
    return model.group(1) if model else platform.machine()


def benchmarks(program, wanted):
    """{name: ms of CPU an item} of a Google Benchmark program; an iteration without items is one."""
    report = json.loads(output(program, f"--benchmark_filter={wanted}", "--benchmark_format=json"))
    found = {}
    for row in report["benchmarks"]:
        per_unit = {"ns": 1e-6, "us": 1e-3, "ms": 1.0, "s": 1e3}[row["time_unit"]]
        rate = row.get("items_per_second")
        found[row["name"].split("/min_time")[0]] = 1e3 / rate if rate else row["cpu_time"] * per_unit
    return found


def in_turn(*measurements, turns=TURNS):
    """Each measurement's {name: value} of every turn, one after the other: [{name: [values]}]."""
    found = [{} for _ in measurements]
    for _ in range(turns):
        for values, measure in zip(found, measurements):
            for name, value in measure().items():
                values.setdefault(name, []).append(value)
    return found


def ratio(above, below):
    """Of what was measured in the same turns."""
    each = sorted(a / b for a, b in zip(above, below))
    return f"{statistics.median(each):.2f} ({each[0]:.2f} to {each[-1]:.2f})"


def peak_memory_mb(pid):
    try:
        status = pathlib.Path(f"/proc/{pid}/status").read_text()
    except OSError:
        return 0.0  # it has ended
    peak = re.search(r"VmHWM:\s*(\d+) kB", status)
    return int(peak.group(1)) / 1024.0 if peak else 0.0


def campaign(dispersa, *arguments):
    """Flights a second of a campaign of CASES cases, its start and its report included, and the greatest memory of a
    worker, or of the program where it flies itself."""
    with tempfile.TemporaryDirectory() as folder:
        begin = time.monotonic()
        # Its verdict is the exit code.
        run = subprocess.Popen([dispersa, "run", TABLE3, "--cases", str(CASES), "--quiet", "--out", f"{folder}/out",
                                *arguments], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        peak = 0.0
        while run.poll() is None:
            children = pathlib.Path(f"/proc/{run.pid}/task/{run.pid}/children")
            pids = children.read_text().split() if children.exists() else []
            peak = max([peak, *(peak_memory_mb(pid) for pid in pids or [run.pid])])
            time.sleep(0.02)
            if time.monotonic() - begin > 1800:
                run.kill()
        return {"flights/s": CASES / (time.monotonic() - begin), "MB": peak}


def tuner(dispersa):
    """Seconds of a search of EVALUATIONS designs on one thread."""
    with tempfile.TemporaryDirectory() as folder:
        begin = time.monotonic()
        done = subprocess.run([dispersa, "tune", TABLE3, "--evaluations", str(EVALUATIONS), "--threads", "1", "--quiet",
                               "--out", f"{folder}/found.yaml"], capture_output=True, timeout=1800, check=False)
        if done.returncode not in (0, 3):  # 3: so few designs need not hold one that meets the constraints
            raise RuntimeError(done.stderr.decode())
        return {"s": time.monotonic() - begin}


def instructions(dispersa, campaign_file=TABLE3, few=4, many=12):
    """Millions a flight in process on one thread: what `many` cases take beyond `few`. A build that cannot leave
    histories out flies each case twice; both count as flights."""
    told = output(dispersa, "run", "--help")
    options = [*(["--threads", "1"] if "--threads" in told else []),
               *(["--no-histories"] if "--no-histories" in told else [])]

    def count(cases):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={folder}/profile", dispersa,
                                   "run", campaign_file, "--cases", str(cases), "--quiet", "--out", f"{folder}/out",
                                   "--workers", "0", *options],
                                  text=True, capture_output=True, timeout=1800, check=False)
            if done.returncode not in VERDICTS:
                raise RuntimeError(f"{campaign_file}: {done.stderr}")
            return int(re.search(r"Collected : (\d+)", done.stderr).group(1))
    flights = (many - few) * (1 if "--no-histories" in told else 2)
    return (count(many) - count(few)) / flights / 1e6


# Of campaigns' own metrics, which are looked at in every tick.
OWN_METRICS = ["{name: high_q_time_s, expression: 'time(qbar_pa > 30000)'}",
               "{name: altitude_burn1_km, expression: 'last(altitude_m while burn1) / 1000'}",
               "{name: pitch_mean_deg, expression: 'mean(pitch_deg while burn)'}",
               "{name: beta_felt_deg, expression: 'max(abs(beta_deg) while qbar_pa > 1000)'}",
               "{name: impulse_mn_s, expression: 'integral(thrust_n) / 1e6'}",
               "{name: deflection_yaw_rms_deg, expression: 'rms(deflection_yaw_deg while burn2)'}",
               "{name: speed_burn2_m_s, expression: 'last(inertial_velocity_m_s while burn2)'}",
               "{name: axial_min_g, expression: 'min(axial_load_g while burn)'}",
               "{name: roll_rate_max_deg_s, expression: 'max(abs(p_deg_s))'}",
               "{name: pitch_at_30_deg, expression: 'at(pitch_deg, 30)'}"]

# Three sigma of a new motor (structure_near_modes_test).
DISPERSED_MASSES = """  dry_mass: {distribution: normal, three_sigma_percent: 3, per: stage}
  propellant_load: {distribution: normal, three_sigma_percent: 1, per: stage}
  payload_mass: {distribution: normal, three_sigma_kg: 20, element: payload and equipment}
"""


def capabilities(dispersa):
    """What a flight with a capability takes beside one without it, of the same vehicle and dispersions. The campaigns
    are edited in a copy."""
    with tempfile.TemporaryDirectory() as folder:
        campaigns = pathlib.Path(folder) / "campaigns"
        shutil.copytree(ROOT / "campaigns", campaigns)

        def compare(what, name, edit, of_with=None):
            """`edit` makes of the campaign one without the capability, `of_with` one with it (none: it is one)."""
            source = campaigns / name
            text = source.read_text()
            counted = []
            for change in (edit, of_with or (lambda same: same)):
                copy = source.with_name("measured_" + source.name)
                copy.write_text(change(text))
                counted.append(instructions(dispersa, copy, few=4, many=8))
            without, having = counted
            print(f"{what:<16} {name:<34} {without:>8.1f} M {having:>8.1f} M  x {having / without:.2f}", flush=True)

        print(f"{'capability':<16} {'campaign':<34} {'without':>10} {'with':>10}")
        for found in sorted(campaigns.rglob("*.yaml")):
            text = found.read_text()
            if "schema: dispersa/campaign/" in text and re.search(r"^guidance:.*closed_loop", text, re.M):
                compare("guidance", str(found.relative_to(campaigns)),
                        lambda text: re.sub(r"^guidance:.*\n", "", text, flags=re.M))
        for count in (1, len(OWN_METRICS)):
            metrics = "".join(f"  - {metric}\n" for metric in OWN_METRICS[:count])
            compare("own metrics: %d" % count, "table3.yaml", lambda text: text,
                    lambda text: text.replace("requirements:\n", f"metrics:\n{metrics}requirements:\n", 1))
        # With its own autopilot: the rigid vehicle has no rate gyros.
        compare("bending", "table3_flexible.yaml", lambda text: TABLE3.read_text())
        for name in ("table3.yaml", "table3_flexible.yaml"):
            compare("dispersed masses", name, lambda text: text,
                    lambda text: text.replace("dispersions:\n", "dispersions:\n" + DISPERSED_MASSES, 1))


def label_of(name):
    what, isa, lanes = name.split("/")
    words = {"Flights": "flight", "BareFlight": "flight's steps alone", "RightHandSide": "right-hand side, of a lane"}
    return f"{words[what]}, {isa}, {lanes} lane{'s' * (lanes != '1')}"


def main(build, old_build=None):
    programs = build / "benchmarks"
    dispersa = build / "bin/dispersa"
    compiler = re.search(r"CMAKE_CXX_COMPILER:\w+=(.*)", (build / "CMakeCache.txt").read_text()).group(1)
    print(f"machine   {processor()}, {os.cpu_count()} processors")
    print(f"compiler  {output(compiler, '--version').splitlines()[0]}")
    print(f"commit    {output('git', '-C', str(ROOT), 'describe', '--always', '--dirty').strip()}")
    print(f"load      {os.getloadavg()[0]:.2f} over the minute before\n")

    def row(label, values, unit, remark="", scale=1.0):
        print(f"{label:<44} {scale * statistics.median(values):>10.3f} {unit:<10} {remark}".rstrip(), flush=True)

    old_flight = [lambda: benchmarks(old_build / "benchmarks/flight_benchmark", "^Flight(/|$)")] if old_build else []
    flights, steps, *old = in_turn(lambda: benchmarks(programs / "flight_benchmark", "^(Flight|Flights)(/|$)"),
                                   lambda: benchmarks(programs / "step_benchmark", "."), *old_flight)
    one = flights.pop("Flight")
    row("flight alone", one, "ms")
    if old:
        row("flight alone, other build", old[0]["Flight"], "ms", f"x {ratio(old[0]['Flight'], one)} of this one")
    for name, ms in flights.items():
        remark = f"flight alone x {ratio(one, ms)}"
        if old:
            remark += f", other build's x {ratio(old[0]['Flight'], ms)}"
        row(label_of(name), ms, "ms", remark)
    for name, ms in steps.items():
        if name.startswith("BareFlight"):
            row(label_of(name), ms, "ms", f"{ratio(ms, flights[name.replace('BareFlight', 'Flights')])} of the flight")
    for name, ms in steps.items():
        if name.startswith("RightHandSide"):
            row(label_of(name), ms, "ns", scale=1e6)

    (ascents,) = in_turn(lambda: benchmarks(programs / "ascent_benchmark", "."))
    optimisation = ascents.pop("Optimisation")
    for name, ms in ascents.items():
        row(f"ascent, lanes {name.split('/')[1]}", ms, "ms", f"one lane x {ratio(ascents['Ascents/1'], ms)}")
    row("optimisation of slv4_500km, one thread", optimisation, "ms")
    tuners = [lambda: tuner(dispersa), *([lambda: tuner(old_build / "bin/dispersa")] if old_build else [])]
    tuned, *old = in_turn(*tuners, turns=1 if old_build else TURNS)  # the other build's may take minutes
    row(f"tuner, {EVALUATIONS} designs, one thread", tuned["s"], "s")
    if old:
        row("tuner, other build", old[0]["s"], "s", f"x {ratio(old[0]['s'], tuned['s'])} of this one")

    inside, over = in_turn(lambda: campaign(dispersa, "--workers", "0", "--threads", "2"),
                           lambda: campaign(dispersa, "--workers", "2"))
    row(f"table3, {CASES} cases, in process, 2 threads", inside["flights/s"], "flights/s")
    row(f"table3, {CASES} cases, over DDS, 2 workers", over["flights/s"], "flights/s",
        f"{ratio(over['flights/s'], inside['flights/s'])} of in process")
    row("memory of a process that flies itself", inside["MB"], "MB")
    row("memory of a worker", over["MB"], "MB")
    if shutil.which("valgrind"):
        counted = instructions(dispersa)
        row("instructions a flight, in process", [counted], "M")
        if old_build:
            other = instructions(old_build / "bin/dispersa")
            row("instructions a flight, other build", [other], "M", f"x {other / counted:.2f} of this one")


if __name__ == "__main__":
    if sys.argv[1] == "--capabilities":
        capabilities(pathlib.Path(sys.argv[2]).resolve() / "bin/dispersa")
    elif sys.argv[1] == "--instructions":
        print(f"instructions a flight: {instructions(pathlib.Path(sys.argv[2]) / 'bin/dispersa'):.1f} M")
    else:
        main(*(pathlib.Path(argument).resolve() for argument in sys.argv[1:]))
