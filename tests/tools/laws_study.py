"""The control laws side by side: every shipped autopilot on the same campaigns.

laws_study.py BINARIES CAMPAIGNS README writes two tables between the README's <!-- laws:begin --> and <!-- laws:end -->
(each law on each campaign) and <!-- feed_forward:begin --> and <!-- feed_forward:end --> (each with the program fed
forward). No tuning has seen the cases. About 10 minutes of one core.
"""
import csv
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

LAWS = ["adaptive_fuzzy", "frozen_fuzzy", "pd", "pid", "lqr", "pd_aac", "pid_aac"]
# Campaign, cases of it.
CAMPAIGNS = [("controllers", 1000), ("table3", 500), ("aero20", 320), ("stuck_nozzle", 60)]
# One tick of delay and the lag 2 * 0.7 / w of the first two stages' actuators; the upper stages' are 20 and 31 ms less.
LEAD_S = 0.066


def fly(dispersa, campaign, autopilot, cases, out):
    subprocess.run([dispersa, "--quiet", "run", campaign, "--autopilot", autopilot, "--cases", str(cases), "--workers",
                    "0", "--no-histories", "--out", out], stdout=subprocess.DEVNULL, check=False)
    with open(out / "cases.csv", newline="") as stream:
        return list(csv.DictReader(stream))


def metric(rows, name):
    return [float(row[f"metric_{name}"]) for row in rows if row["outcome"] == "completed"]


def lost(rows):
    return sum(row["outcome"] != "completed" for row in rows)


def median_and_peak(rows):
    if lost(rows) == len(rows):
        return "– | –"
    return f"{statistics.median(metric(rows, 'pitch_error_rms_deg')):.4f}° | {max(metric(rows, 'pitch_error_peak_deg')):.3f}°"


def laws_table(flown):
    lines = ["| law | `controllers`: median RMS | largest peak | smaller than `adaptive_fuzzy` in | `table3`: median RMS | "
             "largest peak | `aero20`: median RMS | largest peak | lost | `stuck_nozzle`: lost |",
             "|---|---|---|---|---|---|---|---|---|---|"]
    first = flown["adaptive_fuzzy"]["controllers"]
    for law, by_campaign in flown.items():
        rows = by_campaign["controllers"]
        name = "metric_pitch_error_rms_deg"
        better = sum(float(a[name]) < float(b[name]) for a, b in zip(rows, first)
                     if a["outcome"] == b["outcome"] == "completed")
        losses = sum(lost(by_campaign[campaign]) for campaign in ["controllers", "table3", "aero20"])
        lines.append(f"| `{law}` | {median_and_peak(rows)} | {'' if law == 'adaptive_fuzzy' else f'{better} of {len(rows)}'} | "
                     f"{median_and_peak(by_campaign['table3'])} | {median_and_peak(by_campaign['aero20'])} | {losses} | "
                     f"{lost(by_campaign['stuck_nozzle'])} of {len(by_campaign['stuck_nozzle'])} |")
    return lines


def with_feed_forward(text):
    """Every axis with the program fed forward."""
    return re.sub(r"^(  law: .*\n)", rf"\1  feed_forward: {{lead_s: {LEAD_S}}}\n", text, flags=re.MULTILINE)


def feed_forward_table(without, fed):
    lines = ["| law | median RMS, without | with | stage 1, median peak, without | with | smaller RMS in |",
             "|---|---|---|---|---|---|"]
    for law in without:
        a, b = without[law]["controllers"], fed[law]
        name = "metric_pitch_error_rms_deg"
        better = sum(float(y[name]) < float(x[name]) for x, y in zip(a, b)
                     if x["outcome"] == y["outcome"] == "completed")
        numbers = [statistics.median(metric(rows, what)) for what in ["pitch_error_rms_deg", "pitch_error_peak_stage1_deg"]
                   for rows in (a, b)]
        lines.append(f"| `{law}` | " + " | ".join(f"{x:.4f}°" for x in numbers) + f" | {better} of {len(b)} |")
    return lines


def put(readme, name, lines):
    text, count = re.subn(rf"(<!-- {name}:begin -->\n).*?(<!-- {name}:end -->)",
                          lambda m: m[1] + "\n".join(lines) + "\n" + m[2], readme.read_text(), flags=re.DOTALL)
    if count != 1:
        sys.exit(f"{readme}: no <!-- {name}:begin --> and <!-- {name}:end -->")
    readme.write_text(text)


def main():
    binaries, campaigns, readme = map(pathlib.Path, sys.argv[1:])
    dispersa = binaries / "dispersa"
    with tempfile.TemporaryDirectory(prefix="dispersa-laws-") as folder:
        folder = pathlib.Path(folder)
        flown = {law: {campaign: fly(dispersa, campaigns / f"{campaign}.yaml", campaigns / f"autopilots/{law}.yaml", cases,
                                     folder / f"{law}-{campaign}")
                       for campaign, cases in CAMPAIGNS} for law in LAWS}
        fed = {}
        for law in LAWS:
            autopilot = folder / f"{law}.yaml"
            autopilot.write_text(with_feed_forward((campaigns / f"autopilots/{law}.yaml").read_text()))
            fed[law] = fly(dispersa, campaigns / "controllers.yaml", autopilot, dict(CAMPAIGNS)["controllers"],
                           folder / f"{law}-fed")
    put(readme, "laws", laws_table(flown))
    put(readme, "feed_forward", feed_forward_table(flown, fed))


if __name__ == "__main__":
    main()
