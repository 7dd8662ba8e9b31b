"""The wheel's metadata, and how CMake makes what is in it."""
import os
import pathlib
import re
import sys

from skbuild import setup

SOURCE = pathlib.Path(__file__).resolve().parents[2]
PROJECT = re.search(r'^project\(dispersa VERSION (\S+).*?DESCRIPTION "(.*?)"', (SOURCE / "CMakeLists.txt").read_text(),
                    re.DOTALL | re.MULTILINE)

setup(name="dispersa", version=PROJECT[1], description=PROJECT[2], packages=["dispersa"], python_requires=">=3.11",
      install_requires=["numpy"], extras_require={"tables": ["pandas"], "plots": ["matplotlib"]},
      cmake_source_dir=os.path.relpath(SOURCE),
      cmake_args=["-DDISPERSA_SERVICE=OFF", f"-DDISPERSA_PYTHON={sys.executable}", "-DDISPERSA_PYTHON_FOLDER=."])
