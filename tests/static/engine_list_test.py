"""core/flight/engine_list.cmake: the lists of engines that CMake accepts, and its messages about the others."""
import os
import pathlib
import subprocess
import unittest

CMAKE = os.environ.get("CMAKE", "cmake")
SCRIPT = pathlib.Path(__file__).parents[2] / "core/flight/engine_list.cmake"


class EngineListTest(unittest.TestCase):
    def problem(self, engines):
        """What CMake says, on one line; empty if it takes the list."""
        done = subprocess.run([CMAKE, "-D", f"DISPERSA_ENGINES={engines}", "-P", SCRIPT], text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False, timeout=60)
        self.assertEqual(done.returncode != 0, done.stdout != "")
        return " ".join(line.strip() for line in done.stdout.splitlines()
                        if line.strip() and not line.startswith(("CMake Error", "Call Stack"))).strip()

    def test_takes_what_has_one_lane_for_every_processor(self):
        for engines in ("v3 1;v3 4;v3 8;v4 1;v4 4;v4 8", "v3 1;v3 4;v4 8", "v3 1", "v3 4;v3 1"):
            self.assertEqual(self.problem(engines), "", engines)

    def test_refuses_what_lacks_it(self):
        for engines in ("v3 4", "v3 4;v3 8", "v4 1;v4 8", ""):
            self.assertEqual(self.problem(engines), f"DISPERSA_ENGINES: 'v3 1' is missing in '{engines}'")

    def test_refuses_what_is_no_engine(self):
        for engine in ("v2 1", "v3 2", "v3", "v3 18"):
            self.assertEqual(self.problem(f"v3 1;{engine}"),
                             f"DISPERSA_ENGINES: '{engine}' is no engine; allowed: v3 or v4 and 1, 4 or 8")


if __name__ == "__main__":
    unittest.main()
