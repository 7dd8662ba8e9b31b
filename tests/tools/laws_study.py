"""The control laws side by side: every shipped autopilot on the same campaigns.

laws_study.py BINARIES CAMPAIGNS prints three tables: each law on each campaign, each with the program fed forward, and
whose roll axis loses the vehicle when a nozzle is stuck. No tuning has seen the cases. About 10 minutes of one core.
"""
import csv
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

LAWS = ["adaptive_fuzzy", "frozen_fuzzy", "pd", "pid", "lqr", "pd_aac", "pid_aac"]
# The gains of PID times this: what brings its measured margins down to those of the augmented PID, whose tuning holds
# the measured gates and not the computed ones with their reserve.
RAISED, FACTOR = "pid, all gains times 1.12", 1.12
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


def with_raised_gains(text):
    def raise_all(match):
        return match[1] + ", ".join(f"{float(gain) * FACTOR:.4g}" for gain in match[2].split(", "))
    return re.sub(r"(ki_1_s3: \[|kp_1_s2: |kd_1_s: )([0-9., ]*[0-9])", raise_all, text)


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
        title = law if law == RAISED else f"`{law}`"
        lines.append(f"| {title} | {median_and_peak(rows)} | {'' if law == 'adaptive_fuzzy' else f'{better} of {len(rows)}'} | "
                     f"{median_and_peak(by_campaign['table3'])} | {median_and_peak(by_campaign['aero20'])} | {losses} | "
                     f"{lost(by_campaign['stuck_nozzle'])} of {len(by_campaign['stuck_nozzle'])} |")
    return lines


def with_feed_forward(text):
    """Every axis with the program fed forward."""
    return re.sub(r"^(  law: .*\n)", rf"\1  feed_forward: {{lead_s: {LEAD_S}}}\n", text, flags=re.MULTILINE)


def feed_forward_table(without, fed):
    lines = ["| law | median RMS, without | with | stage 1, median peak, without | with | smaller RMS in |",
             "|---|---|---|---|---|---|"]
    for law in fed:
        a, b = without[law]["controllers"], fed[law]
        name = "metric_pitch_error_rms_deg"
        better = sum(float(y[name]) < float(x[name]) for x, y in zip(a, b)
                     if x["outcome"] == y["outcome"] == "completed")
        numbers = [statistics.median(metric(rows, what)) for what in ["pitch_error_rms_deg", "pitch_error_peak_stage1_deg"]
                   for rows in (a, b)]
        lines.append(f"| `{law}` | " + " | ".join(f"{x:.4f}°" for x in numbers) + f" | {better} of {len(b)} |")
    return lines


def axis(text, name):
    """The lines of an axis below its name."""
    return re.search(rf"^{name}:\n((?:  .*\n)+)", text, re.MULTILINE)[1]


def stuck_nozzle_table(dispersa, campaigns, folder):
    lines = ["| pitch and yaw as | roll as | lost | median, over the cases that all complete, of the RMS error in pitch | "
             "in roll |", "|---|---|---|---|---|"]
    texts = {law: (campaigns / f"autopilots/{law}.yaml").read_text() for law in ["adaptive_fuzzy", "pid", "pd"]}
    rolls = {f"`{law}` (kp {re.findall('kp_1_s2: ([0-9.]+)', text)[2]} in stage 3)": axis(text, "roll")
             for law, text in texts.items()}
    rolls["`pid`'s yaw: with an integral"] = axis(texts["pid"], "yaw")
    flown = []
    for law, text in texts.items():
        for title, roll in rolls.items():
            autopilot = folder / f"stuck{len(flown)}.yaml"
            autopilot.write_text(text.replace("roll:\n" + axis(text, "roll"), "roll:\n" + roll))
            flown.append((law, title, fly(dispersa, campaigns / "stuck_nozzle.yaml", autopilot, 60,
                                          folder / f"stuck{len(flown)}")))
    shared = [i for i in range(60) if all(rows[i]["outcome"] == "completed" for _, _, rows in flown)]
    for law, title, rows in flown:
        medians = " | ".join(f"{statistics.median(float(rows[i][f'metric_{name}_error_rms_deg']) for i in shared):.3f}°"
                             for name in ["pitch", "roll"])
        lines.append(f"| `{law}` | {title} | {lost(rows)} of {len(rows)} | {medians} |")
    return lines


def main():
    binaries, campaigns = map(pathlib.Path, sys.argv[1:])
    dispersa = binaries / "dispersa"
    with tempfile.TemporaryDirectory(prefix="dispersa-laws-") as folder:
        folder = pathlib.Path(folder)
        raised = folder / "raised.yaml"
        raised.write_text(with_raised_gains((campaigns / "autopilots/pid.yaml").read_text()))
        files = {law: campaigns / f"autopilots/{law}.yaml" for law in LAWS} | {RAISED: raised}
        flown = {law: {campaign: fly(dispersa, campaigns / f"{campaign}.yaml", autopilot, cases,
                                     folder / f"{autopilot.stem}-{campaign}")
                       for campaign, cases in CAMPAIGNS} for law, autopilot in files.items()}
        fed = {}
        for law in LAWS:
            autopilot = folder / f"{law}.yaml"
            autopilot.write_text(with_feed_forward((campaigns / f"autopilots/{law}.yaml").read_text()))
            fed[law] = fly(dispersa, campaigns / "controllers.yaml", autopilot, dict(CAMPAIGNS)["controllers"],
                           folder / f"{law}-fed")
        stuck = stuck_nozzle_table(dispersa, campaigns, folder)
    for table in (laws_table(flown), feed_forward_table(flown, fed), stuck):
        print("\n".join(table) + "\n")


if __name__ == "__main__":
    main()
