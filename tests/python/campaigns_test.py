"""Loading, validating, editing and planning from Python: the same ids, texts, problems and draws as the program's."""
import collections
import copy
import csv
import os
import pickle
import subprocess
import sys
import types
import unittest
import warnings

import numpy

import dispersa
from program import CAMPAIGNS, SMOKE, folder_of, printed, program, shipped_campaigns


class Loading(unittest.TestCase):
    def test_every_shipped_campaign_has_the_programs_ids(self):
        files = shipped_campaigns()
        self.assertGreater(len(files), 20)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", dispersa.InputWarning)
            for file in files:
                with self.subTest(file.name):
                    campaign = dispersa.load(file)
                    for tree in (dispersa.read(file), dispersa.read(file, inlined=True)):
                        self.assertEqual(dispersa.load(tree).canonical_yaml, campaign.canonical_yaml)
        for name in ("smoke", "full", "table3_sobol", "gallery/electron/campaign"):
            file = CAMPAIGNS / f"{name}.yaml"
            if file.exists():
                plan = printed("plan", file, "--cases", 4)
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore", dispersa.InputWarning)
                    campaign = dispersa.load(file, cases=4)
                self.assertEqual((campaign.id, campaign.flight_id), (plan["id"], plan["flight_id"]), name)

    def test_a_scenarios_tables_stand_in_the_place_of_their_names(self):
        file = CAMPAIGNS.parent / "tests/data/yaml/scenario.yaml"
        self.assertEqual(dispersa.read(file)["wind"]["table"], "scenario_wind.csv")
        self.assertEqual(dispersa.read(file, inlined=True)["wind"]["table"]["altitude_m"], [0, 10000])

    def test_overrides(self):
        campaign = dispersa.load(SMOKE, cases=3, seed=2**63 + 1)
        plan = printed("plan", SMOKE, "--cases", 3, "--seed", 2**63 + 1)
        self.assertEqual((campaign.cases, campaign.seed, campaign.id), (3, 2**63 + 1, plan["id"]))
        self.assertEqual(dispersa.load(SMOKE, autopilot=CAMPAIGNS / "autopilots/pd.yaml").autopilot,
                         dispersa.read(CAMPAIGNS / "autopilots/pd.yaml")["name"])

    def test_arguments_out_of_range(self):
        for arguments, said in (({"cases": 0}, "cases: 0 is out of range, allowed: a whole number from 1 to 4294967295"),
                                ({"seed": -1}, "seed: -1 is out of range"), ({"cases": 2.5}, "cases: 2.5 is not a whole number")):
            with self.assertRaisesRegex(dispersa.BadInput, said):
                dispersa.load(SMOKE, **arguments)

    def test_an_edited_tree_is_the_edited_file(self):
        tree = dispersa.read(SMOKE)
        tree["sampling"]["cases"] = numpy.int64(5)
        tree["dispersions"]["wind"]["max_speed_m_s"] = numpy.float64(0.1) * 3
        tree["name"] = "edited.true"
        edited = dispersa.load(tree)
        folder = folder_of(type(self))
        tree["vehicle"], tree["reference"], tree["autopilot"] = (
            str(CAMPAIGNS / tree[key]) for key in ("vehicle", "reference", "autopilot"))
        dispersa.write(tree, folder / "edited.yaml")
        self.assertEqual(dispersa.load(folder / "edited.yaml").id, edited.id)
        self.assertEqual(printed("plan", folder / "edited.yaml")["id"], edited.id)
        self.assertEqual(edited.name, "edited.true")
        dispersa.write({"a": [1.5]}, folder / "small.yaml")
        self.assertEqual((folder / "small.yaml").read_text(), '{\n "a": [\n  1.5\n ]\n}\n')

    def test_names_in_a_dict_are_relative_to_base(self):
        plain = dict(dispersa.read(SMOKE))
        with self.assertRaises(dispersa.BadInput) as caught:
            dispersa.load(plain)
        self.assertIn("file 'vehicles/slv4.yaml' not found", str(caught.exception))
        for tree in (plain, collections.UserDict(plain), types.MappingProxyType(plain)):
            self.assertEqual(dispersa.load(tree, base=CAMPAIGNS), dispersa.load(SMOKE))

    def test_a_tree_keeps_its_folder(self):
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(CAMPAIGNS)
        tree = dispersa.read("smoke.yaml")
        os.chdir("/")
        for same in (tree, tree.copy(), tree | {}, copy.deepcopy(tree)):
            self.assertEqual(dispersa.load(same), dispersa.load(SMOKE))

    def test_files_are_utf_8_whatever_the_locale(self):
        folder = folder_of(type(self))
        script = ("import dispersa, sys\ntree = dispersa.read(sys.argv[1], inlined=True)\ntree['vehicle']['name'] = '\\xe9t\\xe9'\n"
                  "tree['sampling']['cases'] = 1\ndispersa.write(tree, sys.argv[2] + '/t.yaml')\n"
                  "print(ascii(dispersa.run(sys.argv[2] + '/t.yaml', sys.argv[2] + '/r', workers=0).campaign.vehicle))\n")
        done = subprocess.run([sys.executable, "-B", "-X", "utf8=0", "-c", script, str(SMOKE), str(folder)], text=True,
                              capture_output=True, env={**os.environ, "LC_ALL": "C", "PYTHONCOERCECLOCALE": "0"})
        self.assertEqual((done.stdout, done.returncode), ("'\\xe9t\\xe9'\n", 0), done.stderr)

    def test_names_that_label_results_cannot_be_changed(self):
        campaign = dispersa.load(SMOKE)
        for names in (campaign.input_names, campaign.metric_names, campaign.dispersed, campaign.warnings):
            self.assertIsInstance(names, tuple)

    def test_pickled(self):
        tree = dispersa.read(SMOKE, inlined=True)
        tree["reference"]["target_missed"] = "far off"
        with self.assertWarnsRegex(dispersa.InputWarning, "misses its own target"):
            campaign = dispersa.load(tree)
        self.assertTrue(campaign.warnings)
        for copied in (pickle.loads(pickle.dumps(campaign)), copy.copy(campaign)):
            self.assertEqual((copied, copied.warnings), (campaign, campaign.warnings))


class Validating(unittest.TestCase):
    def test_problems_are_objects_with_what_the_program_says(self):
        folder = folder_of(type(self))
        text = SMOKE.read_text().replace(": vehicles/", f": {CAMPAIGNS}/vehicles/").replace("cases: 12", "cases: -12")
        (folder / "bad.yaml").write_text(text.replace("drag_coefficient", "drag_coeficient"))
        said = printed("validate", folder / "bad.yaml", code=2)
        validation = dispersa.validate(folder / "bad.yaml")
        self.assertFalse(validation)
        self.assertEqual(validation.exit_code, 2)
        self.assertEqual([vars(problem) for problem in validation.errors], said["errors"])
        self.assertGreaterEqual(len(said["errors"]), 3)  # cases, a key, the files beside
        self.assertEqual("\n".join(map(str, validation.errors)) + "\n",
                         program("validate", folder / "bad.yaml", "--quiet", code=2))
        with self.assertRaises(dispersa.BadInput) as caught:
            dispersa.load(folder / "bad.yaml")
        self.assertEqual(caught.exception.problems, validation.errors)
        self.assertEqual((caught.exception.code, pickle.loads(pickle.dumps(caught.exception)).problems),
                         (dispersa.ExitCode.BAD_INPUT, validation.errors))

    def test_dicts(self):
        tree = dispersa.read(SMOKE)
        self.assertTrue(dispersa.validate(tree))
        tree["sampling"]["method"] = "dice"
        problem, = dispersa.validate(tree).errors
        self.assertEqual(str(problem), f"{CAMPAIGNS}/<dict>: sampling.method: 'dice' is not a choice, allowed: one of "
                         "monte_carlo, latin_hypercube, sobol, corners, one_at_a_time, grid, list")
        tree["sampling"] = {"cases": float("nan")}
        deep = {}
        for _ in range(3000):
            deep = {"deeper": deep}
        for value, said in ((float("nan"), "Out of range float"), (object(), "object has no place in a file"),
                            (deep, "recursion|nested too deeply"), ("\ud800", "surrogates not allowed")):
            tree["sampling"] = {"cases": value}
            problem, = dispersa.validate(tree).errors
            self.assertRegex(problem.message, said)
            with self.assertRaisesRegex(dispersa.BadInput, said):
                dispersa.load(tree)

    def test_missing_file(self):
        with self.assertRaisesRegex(dispersa.BadInput, "nothing.yaml:1:1: file not found"):
            dispersa.load("nothing.yaml")

    def test_a_file_of_a_list(self):
        file = folder_of(type(self)) / "list.yaml"
        file.write_text("- 1\n- 2\n")
        with self.assertRaisesRegex(dispersa.BadInput, "list.yaml:1:1: is no map of keys"):
            dispersa.read(file)


class Planning(unittest.TestCase):
    def test_draws_are_the_programs_to_the_bit(self):
        rows = list(csv.reader(program("plan", CAMPAIGNS / "full.yaml", "--cases", 7, "--csv").splitlines()))
        plan = dispersa.load(CAMPAIGNS / "full.yaml", cases=7).plan()
        self.assertEqual(["input_" + name for name in plan.dtype.names], rows[0][1:])
        for i, row in enumerate(rows[1:]):
            self.assertEqual(list(plan[i]), [float(cell) for cell in row[1:]])
        self.assertEqual(len(plan), 7)
        self.assertEqual(dispersa.plan(SMOKE, 3).tobytes(), dispersa.plan(SMOKE)[:3].tobytes())
        with self.assertRaises(dispersa.BadInput):
            dispersa.plan(SMOKE, -1)

    def test_a_design_has_no_cases_beyond_its_own(self):
        tree = dispersa.read(SMOKE)
        for sampling in ({"method": "latin_hypercube"}, {"method": "sobol", "replicates": 3}, {"method": "monte_carlo"}):
            tree["sampling"] = {"cases": 12, "seed": 1, **sampling}
            campaign = dispersa.load(tree)
            with self.assertRaisesRegex(dispersa.BadInput, "cases: 13 is out of range, allowed: a whole number from 0 to 12"):
                campaign.plan(13)
            self.assertEqual(campaign.plan(5).tobytes(), campaign.plan()[:5].tobytes())
            # Another number of cases is another design, as it is for the program.
            more = dispersa.load(tree, cases=24).plan()
            for what in (tree, campaign):
                self.assertEqual(dispersa.plan(what, cases=24).tobytes(), more.tobytes())


if __name__ == "__main__":
    unittest.main()
