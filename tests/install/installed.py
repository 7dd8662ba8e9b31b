"""The tree that `cmake --install` makes of the build, for the tests of this folder.

DISPERSA_BUILD, DISPERSA_SOURCE, CMAKE and CPACK name the build folder, the repository and the programs of CMake.
"""
import os
import pathlib
import shutil
import subprocess

BUILD = pathlib.Path(os.environ["DISPERSA_BUILD"])
SOURCE = pathlib.Path(os.environ["DISPERSA_SOURCE"])
CMAKE = os.environ["CMAKE"]
CPACK = os.environ["CPACK"]
TIMEOUT_S = 240


def run(*command, **options):
    """The finished process; its output as text."""
    options.setdefault("timeout", TIMEOUT_S)
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, **options)


def copy_sources(folder):
    """The repository's files as git lists them, without git's own."""
    listed = run("git", "-c", "safe.directory=*", "-C", SOURCE, "ls-files", "-z").stdout
    for file in listed.split("\0")[:-1]:
        (folder / file).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(SOURCE / file, folder / file)


def install(prefix):
    """Installs there, and moves the tree elsewhere: whatever still names the first place fails."""
    done = run(CMAKE, "--install", BUILD, "--prefix", prefix.parent / "first")
    if done.returncode != 0:
        raise AssertionError(done.stdout + done.stderr)
    (prefix.parent / "first").rename(prefix)


def environment(prefix, **more):
    """A user's who has nothing of the build or the repository."""
    return {"PATH": f"{prefix}/bin:/usr/bin:/bin", "HOME": str(prefix.parent), "LANG": "C.UTF-8", **more}
