"""Uncertainties under which adaptation pays: variants of the adaptive fuzzy law against a PID, under uncertainties
larger than those of Table 3.

adaptation_search.py BINARIES CAMPAIGNS prints the table. For each uncertainty every variant and the PID are tuned anew, by the same procedure with the
same budget on the same cases of that uncertainty, then flown on others. About 15 minutes of one core.
"""
import concurrent.futures
import csv
import json
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile

CASES = 120
EVALUATIONS = 160

# Beside Table 3: what is uncertain, and what the dispersions say.
UNCERTAINTIES = [
    ("Table 3 alone", []),
    ("inertia, CP ±50 %, CG ±20 %, bandwidth −30 to 0 %",
     ["inertia: {distribution: uniform, bound_percent: 50}", "center_of_gravity: {distribution: uniform, bound_percent: 20}",
      "center_of_pressure: {distribution: uniform, bound_percent: 50}",
      "actuator_bandwidth: {distribution: uniform, low_percent: -30, high_percent: 0}"]),
    ("inertia ±50 %", ["inertia: {distribution: uniform, bound_percent: 50}"]),
    ("CG ±50 %", ["center_of_gravity: {distribution: uniform, bound_percent: 50}"]),
    ("CP ±50 %", ["center_of_pressure: {distribution: uniform, bound_percent: 50}"]),
    ("actuator bandwidth −50 to 0 %", ["actuator_bandwidth: {distribution: uniform, low_percent: -50, high_percent: 0}"]),
]

# Narrow sets are what a larger rule set has where flights are: nine or more sets an input over the same 5°. Beyond them
# the supervisory term restores the linear law.
NARROW = {"error_range_deg": "0.25", "rate_range_deg_s": "0.5", "supervisory_bound": "1e-12"}
# Of the adaptive law: what stands instead of a line of its file.
VARIANTS = [
    ("as shipped", {}),
    ("spread 10 1/s", {"spread_1_s": "10"}),
    ("normalized regressor", {"normalized": "true"}),
    ("composite 5", {"composite": "5", "predictor_1_s": "20"}),
    ("composite 5, predictor 5 1/s", {"composite": "5", "predictor_1_s": "5"}),
    ("composite 20, predictor 5 1/s", {"composite": "20", "predictor_1_s": "5"}),
    ("narrow sets", NARROW),
    ("narrow sets, normalized, composite 5", {**NARROW, "normalized": "true", "composite": "5", "predictor_1_s": "20"}),
]


def change(text, key, value):
    """A guard of the adaptation block or a range of the rules, in every axis that has them."""
    if key in ("error_range_deg", "rate_range_deg_s"):
        return re.sub(rf"{key}: [0-9.]+", f"{key}: {value}", text)
    text, count = re.subn(rf"^    {key}: .*$", f"    {key}: {value}", text, flags=re.MULTILINE)
    return text if count else re.sub(r"^    (gamma: .*)$", rf"    \1\n    {key}: {value}", text, flags=re.MULTILINE)


def run(dispersa, *arguments):
    return subprocess.run([dispersa, *map(str, arguments)], capture_output=True, text=True, check=False)


class Search:
    def __init__(self, dispersa, campaigns, folder):
        self.dispersa, self.folder = dispersa, folder
        self.campaigns = folder / "campaigns"
        shutil.copytree(campaigns, self.campaigns)

    def campaign(self, number, dispersions):
        text = (self.campaigns / "controllers.yaml").read_text()
        path = self.campaigns / f"uncertain{number}.yaml"
        path.write_text(text + "dispersions:\n" + "".join(f"  {line}\n" for line in dispersions))
        return path

    def fly(self, campaign, text, name, *options):
        """Tuned, flown and its margins; None where no design passes the gates."""
        autopilot, tuned = self.folder / f"{name}.yaml", self.folder / f"{name}_tuned.yaml"
        autopilot.write_text(text)
        run(self.dispersa, "--quiet", "tune", campaign, "--autopilot", autopilot, "--out", tuned, "--seed", 1, "--cases", 4,
            "--evaluations", EVALUATIONS, "--threads", 1, *options)
        if not tuned.exists():
            return None
        out = self.folder / f"{name}_out"
        run(self.dispersa, "--quiet", "run", campaign, "--autopilot", tuned, "--cases", CASES, "--workers", 0,
            "--no-histories", "--out", out)
        margins = json.loads(run(self.dispersa, "--json", "margins", campaign, "--autopilot", tuned).stdout)["measured"]
        with open(out / "cases.csv", newline="") as stream:
            rows = list(csv.DictReader(stream))
        return rows, min(min(m["gain_up_db"], m["gain_down_db"]) for m in margins), min(m["delay_ms"] for m in margins)

    def rows_of(self, number):
        """The rows of one uncertainty."""
        title, dispersions = UNCERTAINTIES[number]
        campaign = self.campaign(number, dispersions)
        pid_text, adaptive = ((self.campaigns / f"autopilots/{law}.yaml").read_text() for law in ["pid", "adaptive_fuzzy"])
        pid = self.fly(campaign, pid_text, f"{number}_pid")
        if pid is None:
            return [f"| {title} | PID | no design passes the gates | | | | |"]
        rows = [f"| {title} | PID | {describe(pid, pid)}",
                f"| | PID searched as a regulator | {describe(self.fly(campaign, pid_text, f'{number}_lqr', '--lqr'), pid)}"]
        print("\n".join(rows), file=sys.stderr, flush=True)
        for i, (variant, changes) in enumerate(VARIANTS):
            text = adaptive
            for key, value in changes.items():
                text = change(text, key, value)
            rows.append(f"| | {variant} | {describe(self.fly(campaign, text, f'{number}_{i}'), pid)}")
            print(f"{title}: {rows[-1]}", file=sys.stderr, flush=True)
        return rows


def describe(flown, pid):
    if flown is None:
        return "no design passes the gates | | | | |"
    rows, gain, delay = flown
    done = [rms(row) for row in rows if row["outcome"] == "completed"]
    ratios = [rms(a) / rms(b) for a, b in zip(rows, pid[0]) if a["outcome"] == b["outcome"] == "completed"]
    better = sum(rms(a) < rms(b) for a, b in zip(rows, pid[0]))
    median = f"{statistics.median(done):.4f}°" if done else "–"
    ratio = f"{statistics.median(ratios):.2f}" if ratios else "–"
    gates = "" if gain >= 6.0 and delay >= 20.0 else ", missed"
    return f"{median} | {ratio} | {better} of {len(rows)} | {len(rows) - len(done)} | {gain:.1f} dB, {delay:.0f} ms{gates} |"


def rms(row):
    return float(row["metric_pitch_error_rms_deg"]) if row["outcome"] == "completed" else float("inf")


def main():
    binaries, campaigns = map(pathlib.Path, sys.argv[1:])
    lines = ["| uncertain | law | median RMS | median ratio to PID | smaller than PID in | lost | least measured margins |",
             "|---|---|---|---|---|---|---|"]
    with tempfile.TemporaryDirectory(prefix="dispersa-adaptation-") as folder:
        search = Search(binaries / "dispersa", campaigns, pathlib.Path(folder))
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            for rows in pool.map(search.rows_of, range(len(UNCERTAINTIES))):
                lines += rows
    print("\n".join(lines))


if __name__ == "__main__":
    main()
