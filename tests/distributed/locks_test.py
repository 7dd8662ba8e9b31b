"""No data guarded by a lock are used without it: clang's thread safety analysis of services/.

Arguments: the build folder, whose compile_commands.json tells how each source is compiled, and clang++.
"""
import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import unittest

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
BUILD, CLANG = pathlib.Path(sys.argv[1]), sys.argv[2]
MUTEX = "services/program/mutex.h"
INCLUDE = re.compile(r'^#include "([^"]+)"', re.M)


def includes(path):
    return set(INCLUDE.findall(path.read_text()))


def sources():
    """Where each guarded member is used: the source of its class; of a class template, all that may instantiate it."""
    folder = REPOSITORY / "services"
    all_sources = list(folder.rglob("*.cc"))
    found = {source for source in all_sources if MUTEX in includes(source)}
    for header in folder.rglob("*.h"):
        if MUTEX not in includes(header):
            continue
        if re.search(r"^template .*\nclass", header.read_text(), re.M):
            name = str(header.relative_to(REPOSITORY))
            found |= {source for source in all_sources if name in includes(source)}
        else:
            found.add(header.with_suffix(".cc"))
    return sorted(found)


def options(source):
    """Include paths and definitions of the build."""
    for command in json.loads((BUILD / "compile_commands.json").read_text()):
        file = pathlib.Path(command["file"])
        # Or CMake compiles the whole module as one source, which names its own.
        if file == source or (file.parent.name == "Unity" and file.exists() and f'"{source}"' in file.read_text()):
            words = shlex.split(command["command"])
            taken = [w for w in words if w.startswith(("-I", "-D", "-std=", "-march="))]
            return taken + [w for i, w in enumerate(words) for w in words[i:i + 2] if words[i] == "-isystem"]
    raise AssertionError(f"{source} is not built")


def problems(source, words):
    # Other warnings are the business of other builds.
    command = [CLANG, "-fsyntax-only", "-Wno-everything", "-Wthread-safety", *words, source]
    return subprocess.run(command, cwd=BUILD, capture_output=True, text=True).stderr


class LocksTest(unittest.TestCase):
    def test_what_is_guarded_is_touched_under_its_lock(self):
        checked = sources()
        self.assertGreaterEqual(len(checked), 6)
        # The sources of a module at once, as it is compiled: most of the time goes into the headers that they share.
        modules = {}
        for source in checked:
            modules.setdefault(tuple(options(source)), []).append(source)
        with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            pending = []
            for number, (words, together) in enumerate(modules.items()):
                file = pathlib.Path(folder) / f"{number}.cc"
                file.write_text("".join(f'#include "{source}"\n' for source in together))
                pending.append(pool.submit(problems, file, words))
            for found in pending:
                self.assertEqual(found.result(), "")

    def test_it_would_be_noticed(self):
        guarded = f"""#include "{MUTEX}"
            struct Counter {{
              int Take() {{ @ return value_++; }}
              dispersa::Mutex mutex_;
              int value_ DISPERSA_GUARDED_BY(mutex_) = 0;
            }};"""
        with tempfile.TemporaryDirectory() as folder:
            source = pathlib.Path(folder) / "counter.cc"
            source.write_text(guarded.replace("@", "const dispersa::Lock lock(mutex_);"))
            self.assertEqual(problems(source, ["-std=c++20", f"-I{REPOSITORY}"]), "")
            source.write_text(guarded.replace("@", ""))
            self.assertIn("requires holding mutex 'mutex_'", problems(source, ["-std=c++20", f"-I{REPOSITORY}"]))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
