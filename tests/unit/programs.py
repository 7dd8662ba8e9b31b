"""What tests of the programs share: the programs, as a user starts them, and the shipped campaigns.

DISPERSA_BINARIES and DISPERSA_CAMPAIGNS name the folders of the programs and of the campaigns.
"""
import os
import pathlib
import shutil
import subprocess
import tempfile

BINARIES = pathlib.Path(os.environ["DISPERSA_BINARIES"])
CAMPAIGNS = pathlib.Path(os.environ["DISPERSA_CAMPAIGNS"])
SMOKE = CAMPAIGNS / "smoke.yaml"
TIMEOUT_S = 300


def run(program, *arguments, env=None, **options):
    """One of the programs, or another by its path. `env` comes on top of this program's."""
    usual = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True, "timeout": TIMEOUT_S}
    if "input" not in options:
        usual["stdin"] = subprocess.DEVNULL
    return subprocess.run([BINARIES / program, *map(str, arguments)], env={**os.environ, **(env or {})}, **(usual | options))


def dispersa(*arguments, **options):
    return run("dispersa", *arguments, **options)


def folder_of(test):
    """A temporary folder that ends with the test, or with the class."""
    folder = pathlib.Path(tempfile.mkdtemp(prefix="dispersa-test-"))
    (test.addClassCleanup if isinstance(test, type) else test.addCleanup)(shutil.rmtree, folder)
    return folder


def smoke_text():
    """The smoke campaign for another folder: it names its files by their whole paths."""
    text = SMOKE.read_text()
    for folder in ("vehicles", "references", "autopilots"):
        text = text.replace(f": {folder}/", f": {CAMPAIGNS}/{folder}/")
    return text
