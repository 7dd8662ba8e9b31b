"""The reference for the Python package: the program, and the shipped campaigns."""
import json
import os
import pathlib
import resource
import shutil
import subprocess
import tempfile

BINARIES = pathlib.Path(os.environ["DISPERSA_BINARIES"])
CAMPAIGNS = pathlib.Path(os.environ["DISPERSA_CAMPAIGNS"])
SMOKE = CAMPAIGNS / "smoke.yaml"
TIMEOUT_S = 300


def program(*arguments, name="dispersa", code=0):
    """Standard output of a command that ends with `code`."""
    done = subprocess.run([str(BINARIES / name), *map(str, arguments)], capture_output=True, text=True, timeout=TIMEOUT_S)
    assert done.returncode == code, (arguments, done.returncode, done.stderr)
    return done.stdout


def printed(*arguments, code=0):
    """The object that a command prints with --json."""
    return json.loads(program(*arguments, "--json", "--quiet", code=code))


def folder_of(test_class):
    """A temporary folder that ends with the class."""
    folder = pathlib.Path(tempfile.mkdtemp(prefix="dispersa-python-"))
    test_class.addClassCleanup(shutil.rmtree, folder)
    return folder


def resident_bytes():
    with open("/proc/self/statm") as stream:
        return int(stream.read().split()[1]) * resource.getpagesize()


def shipped_campaigns():
    """Every campaign file that ships and can be flown."""
    files = sorted(CAMPAIGNS.glob("*.yaml")) + sorted(CAMPAIGNS.glob("gallery/*/campaign.yaml"))
    return [file for file in files if "\noptimize:" not in file.read_text()]
