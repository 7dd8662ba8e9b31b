"""Arguments and verdicts of the Python package, on flights of seconds."""
import json
import pathlib
import unittest
import warnings

import dispersa
from dispersa import _results
from program import CAMPAIGNS, SMOKE, folder_of, printed

GREENSITE = CAMPAIGNS.parent / "tests/data/greensite/campaign.yaml"
MADE_UP = CAMPAIGNS.parent / "tests/data/yaml"


class Validations(unittest.TestCase):
    def test_strict_takes_warnings_for_errors(self):
        for strict in (False, True):
            found = dispersa.validate(MADE_UP / "vehicle.yaml", strict=strict)
            self.assertEqual(([], 2), (found.errors, len(found.warnings)))
            self.assertEqual((not strict, not strict, 2 if strict else 0), (bool(found), found.valid, found.exit_code))

    def test_a_wrong_file_has_the_code_of_bad_input(self):
        found = dispersa.validate({"schema": "dispersa/vehicle/1"})
        self.assertEqual((False, dispersa.ExitCode.BAD_INPUT), (found.valid, found.exit_code))


class Campaigns(unittest.TestCase):
    def test_are_the_same_by_what_they_say_and_not_by_name(self):
        one, again, other = dispersa.load(SMOKE), dispersa.load(SMOKE), dispersa.load(SMOKE, seed=2)
        self.assertEqual(one.name, other.name)
        self.assertEqual((one, hash(one)), (again, hash(again)))
        self.assertNotEqual(one, other)
        self.assertEqual(2, len({one, again, other}))


class Runs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = folder_of(cls)
        cls.results = dispersa.run(SMOKE, cls.folder / "two", cases=2, workers=0, histories=False)

    def test_what_stands_in_the_verdicts_way_is_raised_with_the_results(self):
        folder = self.results.directory
        for code, error, text in (
                (dispersa.ExitCode.INCOMPLETE, dispersa.Incomplete, f"{folder}: cases are missing: no worker"),
                (dispersa.ExitCode.INTERNAL_ERROR, dispersa.InternalError,
                 f"{folder}: a case was returned twice with different bits")):
            with self.assertRaises(error) as raised:
                _results._judge(folder, code, "no worker")
            self.assertEqual(text, str(raised.exception))
            self.assertEqual(folder, raised.exception.results.directory)
        for code in (dispersa.ExitCode.DONE, dispersa.ExitCode.REQUIREMENT_FAILED, dispersa.ExitCode.INCONCLUSIVE):
            self.assertEqual(2, len(_results._judge(folder, code, None)))

    def test_a_folder_without_a_name_is_named_by_the_first_eight_digits(self):
        campaign = self.results.campaign
        self.assertEqual(str(pathlib.Path("results", f"smoke-{campaign.id[:8]}")), _results._folder_of(campaign, ""))
        self.assertEqual("here", _results._folder_of(campaign, pathlib.Path("here")))

    def test_what_is_said_of_a_coordinator_goes_with_one(self):
        for name, value in (("domain", 1), ("address", "127.0.0.1"), ("keys", "keys"), ("insecure", True), ("priority", 1)):
            with self.assertRaises(dispersa.BadInput) as raised:
                dispersa.run(SMOKE, self.folder / name, workers=0, **{name: value})
            self.assertEqual(f"{name}: may be given only with `peer`, allowed: its default", str(raised.exception))

    def test_one_metric_is_compared_by_its_name(self):
        compared = dispersa.compare(self.results, self.results, metrics="pitch_error_peak_deg")
        self.assertEqual(dispersa.compare(self.results, self.results, metrics=["pitch_error_peak_deg"]), compared)


class Studies(unittest.TestCase):
    def setUp(self):
        self.enterContext(warnings.catch_warnings())
        warnings.simplefilter("ignore", dispersa.InputWarning)  # a published vehicle that is a table of numbers

    def test_margins_of_a_path_that_drifts(self):
        ours = dispersa.margins(GREENSITE, frequency_band_percent=0, drift=True)
        self.assertEqual(printed("margins", GREENSITE, "--frequency-band", "0", "--drift"), ours)
        self.assertNotEqual(dispersa.margins(GREENSITE, frequency_band_percent=0)["computed"], ours["computed"])

    def test_a_band_of_frequencies_has_a_limit(self):
        for band in (-1, 51):
            with self.assertRaisesRegex(dispersa.BadInput, "frequency_band_percent: .* allowed: .*0 to 50"):
                dispersa.margins(GREENSITE, frequency_band_percent=band)

    def test_a_target_that_is_missed_is_a_requirement_that_failed(self):
        self.assertEqual(3, _results.Optimization(reached=False).exit_code)
        self.assertEqual(0, _results.Optimization(reached=True).exit_code)
        self.assertEqual({"reached": True}, json.loads(json.dumps(_results.Optimization(reached=True))))


if __name__ == "__main__":
    unittest.main()
