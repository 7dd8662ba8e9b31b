"""The cost of a control law from a shared object for a campaign: computing time of `law: pd` and of the example in
C, in turn.

usage: plugin_cost.py BUILD
"""
import pathlib
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
TURNS = 5
CASES = 400


def seconds(build, autopilot, out):
    """Of computing, of all processes, for one campaign."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([build / "bin/dispersa", "run", ROOT / "campaigns/table3.yaml", "--autopilot", autopilot, "--cases",
                    str(CASES), "--workers", "0", "--threads", "1", "--no-histories", "--out", out, "--quiet"],
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main(build):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "dispersa").mkdir()
        shutil.copy(ROOT / "core/control/control_law.h", folder / "dispersa")
        subprocess.run(["cc", "-O2", "-fPIC", "-shared", f"-I{folder}", ROOT / "campaigns/control_laws/c/pd.c", "-lm",
                        "-o", folder / "pd.so"], check=True)
        text = (ROOT / "campaigns/autopilots/pd.yaml").read_text()
        plugin = folder / "plugin.yaml"
        plugin.write_text(text.replace("law: pd", "law: plugin").replace("tick_s:", "plugin: {library: pd.so}\ntick_s:"))
        ratios = []
        for turn in range(TURNS):
            built_in = seconds(build, ROOT / "campaigns/autopilots/pd.yaml", folder / f"a{turn}")
            ours = seconds(build, plugin, folder / f"b{turn}")
            same = (folder / f"a{turn}/cases.csv").read_bytes() == (folder / f"b{turn}/cases.csv").read_bytes()
            ratios.append(ours / built_in)
            print(f"built in {built_in:.2f} s, shared object {ours:.2f} s, {'same' if same else 'OTHER'} bytes")
    print(f"ratio {statistics.median(ratios):.2f} ({min(ratios):.2f} to {max(ratios):.2f}) over {CASES} cases of table3")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]).resolve())
