"""Differences that the comparison must find: another digest, a missing run, another engine than requested."""
import json
import unittest

from emulated_flights import RUNS, cases_of, judge

VERSION = {"schema": "dispersa/version/1", "version": "1", "engine": "1+abc", "isa": "v3", "lanes": 4}
EXPECTED = {}
for name, _, width in RUNS:
    EXPECTED.setdefault(name, {})[cases_of(width)] = f"{name}_{cases_of(width)}"


def lines(**changed):
    """What a guest says whose flights are right, one run's fields changed."""
    said = []
    for number, (campaign, isa, lanes) in enumerate(RUNS):
        run = {"isa": isa, "lanes": lanes, "digest": EXPECTED[campaign][cases_of(lanes)], **(changed if number == 3 else {})}
        said += [f"begin {number} " + json.dumps({**VERSION, "isa": run["isa"], "lanes": run["lanes"]}),
                 f"exit {number} 4", f"digest {number} {run['digest']}  /tmp/{number}/cases.csv"]
    return [*said, "end"]


class JudgeTest(unittest.TestCase):
    def test_right_flights_are_right(self):
        self.assertEqual(judge(lines(), EXPECTED, VERSION), [])

    def test_another_digest_is_found(self):
        self.assertEqual(judge(lines(digest="other"), EXPECTED, VERSION),
                         ["table3 with v4 in 4 lanes: exit code 4, cases.csv has other, here table3_6"])

    def test_another_engine_is_found(self):
        problems = judge(lines(isa="v3"), EXPECTED, VERSION)
        self.assertEqual(len(problems), 1)
        self.assertRegex(problems[0], "^table3 with v4 in 4 lanes: flown by .*v3")

    def test_a_guest_that_stops_is_found(self):
        problems = judge(lines()[:11], EXPECTED, VERSION)
        self.assertIn("the emulated machine came to no end: see serial.txt and bochs.txt in the work folder", problems)
        self.assertIn("table3 with v4 in 4 lanes: exit code 4, cases.csv has not come, here table3_6", problems)

    def test_campaigns_with_the_same_results_compare_nothing(self):
        same = dict.fromkeys(EXPECTED, EXPECTED["table3"])
        self.assertIn("two campaigns have the same results: the comparison could not fail",
                      judge(lines(), same, VERSION))


if __name__ == "__main__":
    unittest.main()
