#!/usr/bin/env python3
"""Events of the gallery's nominal flights beside the published ones.

gallery_table.py DISPERSA GALLERY            prints the tables
gallery_table.py DISPERSA GALLERY --write    writes them into the launchers' flown.csv, which the docs site shows
gallery_table.py DISPERSA GALLERY --check    compares those files with them, and every difference with 2 %; ends with 1
                                             if a number is farther away and published.yaml does not explain it
Names of launchers behind --check: of these alone.
"""

import csv
import io
import pathlib
import re
import subprocess
import sys
import tempfile

import yaml

WITHIN = 0.02
LAUNCHERS = ("vega", "electron", "scout", "falcon9", "falcon9_leo", "ariane5", "soyuz", "nike_apache")
TITLES = {
    "lift_off": "lift-off",
    "mach_1": "Mach 1",
    "max_dynamic_pressure": "highest dynamic pressure",
    "injection": "injection",
    "apogee": "apogee",
}
COLUMNS = ("time_s", "stage", "mass_kg", "thrust_n", "mach", "qbar_pa", "altitude_m", "inertial_velocity_m_s", "ned_v_n_m_s",
           "ned_v_e_m_s", "ned_v_d_m_s")  # of a history


def fly(dispersa, campaign):
    """Rows of the nominal flight's history, as floats by column."""
    with tempfile.TemporaryDirectory() as folder:
        history = pathlib.Path(folder) / "history.csv"
        done = subprocess.run([dispersa, "fly", campaign, "--history", history], capture_output=True, text=True, timeout=300)
        if done.returncode != 0 or "completed" not in done.stdout:
            sys.exit(f"{campaign}: {done.stdout[:200]}{done.stderr}")
        with open(history, newline="") as file:
            lines = csv.reader(file)
            head = next(lines)
            places = [(name, head.index(name)) for name in COLUMNS]
            return [{name: float(line[at] or 0) for name, at in places} for line in lines]


def speed(row, frame):
    if frame == "inertial":
        return row["inertial_velocity_m_s"]
    return sum(row[f"ned_v_{axis}_m_s"] ** 2 for axis in "ned") ** 0.5


def events_of(rows, vehicle):
    """Row of each event, by name."""
    events = {"lift_off": rows[0], "injection": rows[-1], "apogee": max(rows, key=lambda row: row["altitude_m"])}
    events["ignition"] = rows[0] | {"time_s": -vehicle.get("hold_down_s", 0)}
    events["mach_1"] = next(row for row in rows if row["mach"] >= 1)
    events["max_dynamic_pressure"] = max(rows, key=lambda row: row["qbar_pa"])
    for before, row in zip(rows, rows[1:]):
        stage = int(row["stage"])
        if stage > before["stage"]:
            events[f"stage{stage - 1}_separation"] = row
        if row["thrust_n"] > 0:
            events.setdefault(f"stage{stage}_ignition", row)
            events[f"stage{stage}_cut_off"] = row
    boosters = vehicle.get("boosters")
    if boosters:
        empty = boosters["dry_mass_kg"] * len(boosters.get("angles_deg", [0] * boosters.get("count", 0)))
        for before, row in zip(rows, rows[1:]):
            if before["mass_kg"] - row["mass_kg"] > 0.9 * empty:
                events.setdefault("booster_separation", row)
    for stage in vehicle["stages"]:
        for jettison in stage.get("jettisoned", []):
            drop = jettison["mass_kg"]
            for before, row in zip(rows, rows[1:]):
                lost = before["mass_kg"] - row["mass_kg"]
                # A row's burning beside it is less than half of what leaves.
                if row["stage"] == before["stage"] and 0.9 * drop < lost < 1.5 * drop:
                    events.setdefault(f"{jettison['name'].replace(' ', '_')}_jettison", row)
    return events


def title_of(name):
    return TITLES.get(name) or re.sub(r"^stage(\d)", r"stage \1:", name).replace("_", " ")


def compare(launcher, dispersa, gallery):
    """Rows of the table, and what is farther from the published number than 2 % without an explanation."""
    folder = gallery / launcher
    vehicle = yaml.safe_load((folder / "vehicle.yaml").read_text())
    published = yaml.safe_load((folder / "published.yaml").read_text())
    rows = fly(dispersa, folder / "campaign.yaml")
    flown = events_of(rows, vehicle)
    shift = vehicle.get("hold_down_s", 0) if published["time_zero"] == "ignition" else 0
    table = [["event", "time, s: published", "flown", "altitude, km: published", "flown", "velocity, m/s: published", "flown",
              "difference"]]
    beyond = []
    for event in published["events"]:
        row = flown.get(event.get("flown_as", event["event"]))
        if row is None:
            sys.exit(f"{launcher}: {event['event']} does not happen")
        cells, differences = [], []
        for key, value, digits in (
            ("time_s", row["time_s"] + shift, 1),
            ("altitude_km", row["altitude_m"] / 1000, 1),
            ("velocity_m_s", speed(row, event.get("frame", "relative")), 0),
        ):
            wanted = event.get(key)
            cells += [f"{wanted:g}" if wanted is not None else "", f"{value:.{digits}f}"]
            if not wanted:
                continue
            off = value / wanted - 1
            differences.append(f"{100 * off:+.1f} %")
            is_near = key == "time_s" and abs(value - wanted) <= event.get("tolerance_s", 0)
            if abs(off) > WITHIN and not is_near and "explained" not in event:
                beyond.append(f"{launcher}: {event['event']}: {key} is {value:.{digits}f}, published {wanted:g}")
        frame = event.get("frame")
        if frame and event.get("velocity_m_s"):
            cells[4] += f", {frame.replace('_', ' ')}"
        note = f"; {event['explained']}" if "explained" in event else ""
        table.append([title_of(event["event"]), *cells, ", ".join(differences) + note])
    return table, beyond


def main():
    dispersa, gallery = map(pathlib.Path, sys.argv[1:3])
    mode = sys.argv[3] if len(sys.argv) > 3 else ""
    is_bad = False
    for launcher in sys.argv[4:] or LAUNCHERS:
        rows, beyond = compare(launcher, dispersa, gallery)
        text = io.StringIO()
        csv.writer(text, lineterminator="\n").writerows(rows)
        file = gallery / launcher / "flown.csv"
        if mode == "":
            print(f"{launcher}:\n{text.getvalue()}")
        elif mode == "--write":
            file.write_text(text.getvalue())
        elif file.read_text() != text.getvalue():
            beyond.append(f"{file}: not of today's flights; gallery_table.py --write")
        for line in beyond:
            print(line)
        is_bad |= bool(beyond)
    sys.exit(1 if mode == "--check" and is_bad else 0)


if __name__ == "__main__":
    main()
