"""The effect of each guard of the adaptive law: the shipped autopilot with one guard changed at a time.

guards_study.py BINARIES CAMPAIGNS prints the table. The cases are those of seed 2, which no campaign, tuning or verdict uses. About 5 minutes.
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

TABLE3_CASES = 40
AERO20_CASES = 32

# Title, and what stands instead of a line of the adaptation block (added to the block if it is not there).
VARIANTS = [
    ("as shipped", None, None),
    ("no spread: departures of single rules stay", "spread_1_s", "0"),
    ("spread 10 1/s", "spread_1_s", "10"),
    ("spread 100 1/s, the fastest", "spread_1_s", "100"),
    ("leakage 0.1 1/s", "leakage_1_s", "0.1"),
    ("leakage 1 1/s", "leakage_1_s", "1"),
    ("dead zone 0.02°", "dead_zone_deg", "0.02"),
    ("no projection", "projection_bound_deg_s2", "0"),
    ("projection at 5 °/s²", "projection_bound_deg_s2", "5"),
    ("adaptation into saturation", "freeze_when_saturated", "false"),
    ("rules kept at ignition", "reset_at_ignition", "false"),
    ("supervisory term above V = 1e-7", "supervisory_bound", "1e-7"),
]


def change(autopilot, key, value):
    text = autopilot.read_text()
    if re.search(rf"^    {key}: ", text, re.MULTILINE):
        text = re.sub(rf"^    {key}: .*$", f"    {key}: {value}", text, flags=re.MULTILINE)
    else:
        text = re.sub(r"^    (gamma: .*)$", rf"    \1\n    {key}: {value}", text, flags=re.MULTILINE)
    autopilot.write_text(text)


def fly(dispersa, campaign, cases, out):
    subprocess.run([dispersa, "--quiet", "run", campaign, "--seed", "2", "--cases", str(cases), "--workers", "0",
                    "--out", out], stdout=subprocess.DEVNULL, check=False)
    with open(out / "cases.csv", newline="") as stream:
        return list(csv.DictReader(stream))


def metric(rows, name):
    return [float(row[f"metric_{name}"]) for row in rows if row["outcome"] == "completed"]


def lost(rows):
    return sum(row["outcome"] != "completed" for row in rows)


def row_of(dispersa, campaigns, title, key, value):
    with tempfile.TemporaryDirectory(prefix="dispersa-guards-") as folder:
        folder = pathlib.Path(folder)
        shutil.copytree(campaigns, folder / "campaigns")
        if key:
            change(folder / "campaigns/autopilots/adaptive_fuzzy.yaml", key, value)
        table3 = fly(dispersa, folder / "campaigns/table3.yaml", TABLE3_CASES, folder / "table3")
        aero20 = fly(dispersa, folder / "campaigns/aero20.yaml", AERO20_CASES, folder / "aero20")
        margins = json.loads(subprocess.run([dispersa, "--json", "margins", folder / "campaigns/table3.yaml"],
                                            capture_output=True, text=True, check=False).stdout)
        adapting = [m["adapting"] for m in margins["computed"]]
        gain = min(min(g for g in (m["gain_up_db"], m["gain_down_db"]) if g is not None) for m in adapting)
        phase = min(m["phase_deg"] for m in adapting)
        measured = min(min(m["gain_up_db"], m["gain_down_db"]) for m in margins["measured"])

        def worst(rows, name):
            return f"{max(metric(rows, name)):.3f}°" if metric(rows, name) else "–"
        rms = f"{statistics.median(metric(table3, 'pitch_error_rms_deg')):.4f}°" if lost(table3) < len(table3) else "–"
        return (f"| {title} | {rms} | {worst(table3, 'pitch_error_peak_deg')} | "
                f"{worst(table3, 'deflection_ripple_deg')} | {worst(aero20, 'pitch_error_peak_deg')} | "
                f"{worst(aero20, 'yaw_error_peak_deg')} | {lost(table3)} + {lost(aero20)} | "
                f"{gain:.1f} dB, {phase:.1f}° | {measured:.1f} dB |")


def main():
    binaries, campaigns = map(pathlib.Path, sys.argv[1:])
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        rows = list(pool.map(lambda v: row_of(binaries / "dispersa", campaigns, *v), VARIANTS))
    print("\n".join([
        "| guard | median RMS | largest peak | worst ripple | `aero20`: pitch peak | yaw peak | lost | least computed "
        "margins, adapting | least measured |",
        "|---|---|---|---|---|---|---|---|---|", *rows]))


if __name__ == "__main__":
    main()
