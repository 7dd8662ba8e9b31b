"""What tests/run --changed selects, in a made-up repository."""
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "tools"))
import changed  # noqa: E402

TABLE = {"math": set(), "flight": {"math"}, "results": {"math"}, "pages": {"results"}, "cli": {"pages", "flight"}}
SOURCES = {"tests/unit/math_lanes_test.cc": '#include "core/math/lanes.h"\n',
           "tests/unit/flight_metrics_test.cc": '#include "core/flight/metrics.h"\n#include "tests/made_up.h"\n',
           "tests/unit/pages_report_test.cc": '#include "core/pages/report.h"\n',
           "tests/unit/export_test.py": "import json\n",
           "tests/static/libm.py": "import re\n"}


class Changed(unittest.TestCase):
    def setUp(self):
        self.root = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        for name, text in {**SOURCES, "tests/made_up.h": '#include "core/results/folder.h"\n'}.items():
            (self.root / name).parent.mkdir(parents=True, exist_ok=True)
            (self.root / name).write_text(text)

    def reached(self, *files):
        found = changed.reached(self.root, TABLE, list(files), sorted(SOURCES))
        self.assertIn(("tests/static/libm.py", 0), found)  # checks of the sources run always
        return {pathlib.PurePath(group.file).stem: group.distance for group in found if "static" not in group.file}

    def test_by_the_links_of_rooms(self):
        self.assertEqual(self.reached("core/pages/report.cc"), {"pages_report_test": 0, "export_test": 1})
        self.assertEqual(self.reached("core/math/lanes.cc"),
                         {"math_lanes_test": 0, "flight_metrics_test": 1, "pages_report_test": 2, "export_test": 2})

    def test_through_headers_of_tests(self):
        self.assertEqual(self.reached("core/results/folder.cc"), {"flight_metrics_test": 0, "pages_report_test": 1, "export_test": 2})
        self.assertEqual(self.reached("tests/made_up.h"), {"flight_metrics_test": 0})

    def test_sources_of_tests_themselves(self):
        self.assertEqual(self.reached("tests/unit/export_test.py"), {"export_test": 0})

    def test_who_reads_a_build_file_or_data_is_not_known(self):
        for file in ("CMakeLists.txt", "campaigns/smoke.yaml", "tests/data/us76/table.csv"):
            self.assertEqual(len(self.reached(file)), len(SOURCES) - 1, file)
        self.assertEqual(self.reached("core/README.md"), {})

    def test_the_nearest_within_a_time(self):
        groups = changed.reached(self.root, TABLE, ["core/math/lanes.cc"], sorted(SOURCES))
        seconds = {"tests/unit/math_lanes_test.cc": 5.0, "tests/static/libm.py": 1.0}
        kept = {group.file for group in changed.within(groups, lambda file: seconds.get(file, 10.0), 20.0)}
        self.assertEqual(kept, {"tests/static/libm.py", "tests/unit/math_lanes_test.cc", "tests/unit/flight_metrics_test.cc"})
        self.assertEqual(len(changed.within(groups, lambda file: 99.0, 20.0)), 1)


if __name__ == "__main__":
    unittest.main()
