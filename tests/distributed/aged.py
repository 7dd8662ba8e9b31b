"""A data folder as an older engine would have left it.

No older release is at hand in a test. So a folder of today gets the engine and the flight ids of another one, in every
file that holds them, with their checksums. The rows stay, so they have the columns of today.
"""
import hashlib
import json
import sqlite3

ENGINE = "0.9.0+0123456789ab"
FLIGHT = "f" * 64  # of every campaign


def sealed(state):
    """The text of a state file (services/coordinator/sealed_json.h)."""
    state = {name: value for name, value in state.items() if name != "checksum"}
    compact = json.dumps(state, separators=(",", ":"), ensure_ascii=False)
    return json.dumps({**state, "checksum": hashlib.sha256(compact.encode()).hexdigest()}, ensure_ascii=False)


def age_results(results, engine=ENGINE, flight=FLIGHT):
    database = results / "results.sqlite"
    if not database.exists():
        return
    with sqlite3.connect(database) as rows:
        for key, value in (("engine", engine), ("flight_id", flight)):
            rows.execute("UPDATE provenance SET value = ? WHERE key = ?", (value, key))
    rows.close()


def age(data):
    for state in data.glob("*/state.json"):
        age_results(state.parent / "results")
        entry = json.loads(state.read_text())
        entry["flight_id"] = FLIGHT
        if entry["engine"]:
            entry["engine"] = ENGINE
        state.write_text(sealed(entry))

