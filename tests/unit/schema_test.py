"""JSON Schemas of the input files against the reader.

Every file that ships is valid, and of thousands of small changes of valid files (a key left out, misspelled, of another
type, out of range, another word) a schema refuses none that the reader takes, and all that the reader refuses for a
reason that a schema can know.
"""
import copy
import itertools
import json
import os
import pathlib
import re
import shutil
import tempfile
import unittest

import jsonschema
import yaml

from programs import CAMPAIGNS, dispersa, folder_of

DATA = CAMPAIGNS.parent / "tests" / "data" / "yaml"
KINDS = ["campaign", "vehicle", "reference", "autopilot", "scenario"]
EVERY = int(os.environ.get("DISPERSA_SCHEMA_EVERY", "5"))  # 1: all changes, a minute of work

WHOLE = 20  # every so many changes are judged by the file that stands alone too

# What a schema can know, in the reader's words.
KNOWABLE = re.compile(r"unknown key|missing key|missing unit|the unit of|is not a number|is not a whole number|"
                      r"is not a choice|is not a map|is not a list|is not text|is not a truth value|is out of range|"
                      r"is not a metric|there is neither|the limit is missing|is not the schema|the list is empty|"
                      r"the list has")
# Where the rest of the file, or another one, decides, and why; each is a change that a schema lets pass.
ELSEWHERE = [
    ("missing key 'grain'|missing key 'tanks'", "the motor, a map below, says whether a stage has the one or the other"),
    ("missing key 'ki_1_s3'", "the axis' law, a map above, says whether a schedule's gains have an integral"),
    ("missing key '(inclination|argument_of_perigee)_per_", "the target, a map beside, says which misses are weighed"),
    ("missing key 'reaction_control'", "a vehicle of one stage has no coast"),
    ("missing key 'sensors'", "a beam that flies wants them"),
    ("missing key '(name|element|mass_kg|shear_stiffness)", "the beam's theory, or the sections' masses, decide"),
    ("missing key '(low|high)_", "of two ends one is given, and which distribution it is"),
    ("missing key 'radius_m'", "a list of nozzles that is empty is none"),
    ("missing key '(span|chord)_", "a coefficient wants its length, if its table is one"),
    ("mass_properties.*is not a (number|list)", "where propellant is given, all others are lists"),
    (r"the list has \d+", "as many as the vehicle has stages"),
    ("is not a choice", "a nozzle's name, which the vehicle gives"),
]


class Loader(yaml.SafeLoader):
    """The reader's YAML: decimal numbers, true and false; everything else is text."""


Loader.yaml_implicit_resolvers = {}
NUMBER = re.compile(r"^[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?$")
Loader.add_implicit_resolver("tag:yaml.org,2002:bool", re.compile("^(true|false)$"), list("tf"))
Loader.add_implicit_resolver("tag:yaml.org,2002:float", NUMBER, list("-+.0123456789"))
Loader.add_constructor("tag:yaml.org,2002:float",
                       lambda loader, node: float(node.value) if re.search("[.eE]", node.value) else int(node.value))


def load(path):
    return yaml.load(path.read_text(), Loader)


def kind_of(document):
    return document["schema"].split("/")[1]


def shipped():
    """Every input file in the repository."""
    for path in sorted([*CAMPAIGNS.rglob("*.yaml"), *DATA.glob("*.yaml")]):
        document = load(path)
        if isinstance(document, dict) and str(document.get("schema", "")).startswith("dispersa/"):
            yield path, document


def places(value, path=()):
    """Every value of a document, by the keys that lead to it."""
    yield path, value
    children = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else []
    for key, child in children:
        yield from places(child, path + (key,))


def changed(document, path, change):
    """A copy in which `change`(parent, last key) was done."""
    copied = copy.deepcopy(document)
    parent = copied
    for key in path[:-1]:
        parent = parent[key]
    change(parent, path[-1])
    return copied


def rename(parent, key):
    items = [(name + "_x" if name == key else name, value) for name, value in parent.items()]
    parent.clear()
    parent.update(items)


def mutants(document):
    """(what is done, and the place and the change for `changed`, which copies the whole document)"""
    def put(replacement):
        def change(parent, key):
            parent[key] = replacement
        return change

    def remove(parent, key):
        del parent[key]

    for path, value in places(document):
        if not path or path == ("schema",):
            continue
        where = ".".join(str(key) for key in path)
        if isinstance(path[-1], str):
            yield f"{where} left out", path, remove
            yield f"{where} misspelled", path, rename
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            replacements = {"text": "some text", "-1e9": -10**9, "1e12": 10**12}
        else:
            replacements = {"text": "some text", "a list": [], "a number": 4711}
        for name, replacement in replacements.items():
            if type(replacement) is not type(value) or replacement != value:
                yield f"{where} is {name}", path, put(replacement)


class SchemaTest(unittest.TestCase):
    maxDiff = None

    @classmethod
    def setUpClass(cls):
        cls.folder = folder_of(cls)
        done = dispersa("--quiet", "schema", "--all", cls.folder / "schemas")
        assert done.returncode == 0, done.stderr
        cls.validators, cls.whole = {}, {}  # of the split set, whose files refer to one another, and of each alone
        for kind in KINDS:
            path = cls.folder / "schemas" / f"{kind}.json"
            schema = json.loads(path.read_text())
            jsonschema.Draft7Validator.check_schema(schema)
            cls.validators[kind] = jsonschema.Draft7Validator(schema, resolver=jsonschema.RefResolver(path.as_uri(), schema))
            cls.whole[kind] = jsonschema.Draft7Validator(json.loads(cls.printed(kind)))

    @staticmethod
    def printed(kind):
        done = dispersa("schema", kind)
        assert done.returncode == 0, done.stderr
        return done.stdout

    def refusals(self, document):
        return [f"{list(error.absolute_path)}: {error.message[:200]}"
                for error in self.validators[kind_of(document)].iter_errors(document)]

    def test_every_file_that_ships_is_valid(self):
        count = 0
        for path, document in shipped():
            with self.subTest(path=path):
                self.assertEqual([], self.refusals(document))
                self.assertTrue(self.whole[kind_of(document)].is_valid(document))
            count += 1
        self.assertGreater(count, 50)

    def test_the_schema_of_one_kind_is_complete(self):
        for kind in KINDS:
            text = self.printed(kind)
            self.assertEqual([], [ref for ref in re.findall(r'"\$ref":\s*"([^"]*)"', text) if not ref.startswith("#/$defs/")])
        self.assertEqual((self.folder / "schemas" / "autopilot.json").read_text(), self.printed("autopilot"))

    def test_the_schema_of_a_campaign_refers_to_the_others(self):
        text = (self.folder / "schemas" / "campaign.json").read_text()
        files = {ref.split("#")[0] for ref in re.findall(r'"\$ref":\s*"([^"]*)"', text)}
        self.assertEqual({"", "vehicle.json", "autopilot.json", "reference.json"}, files)
        self.assertLess(len(text), 140_000)

    def test_an_unknown_kind_is_refused(self):
        done = dispersa("schema", "vehicel")
        self.assertEqual(2, done.returncode)
        self.assertEqual("kind: there is no 'vehicel' (did you mean 'vehicle'?), allowed: one of campaign, vehicle, "
                         "reference, autopilot, scenario", done.stderr.splitlines()[0])

    def test_a_folder_that_cannot_be_made_is_refused(self):
        done = dispersa("schema", "--all", "/dev/null/schemas")
        self.assertEqual((2, "--all: /dev/null/schemas cannot be written: /dev/null: Not a directory, allowed: an existing or "
                             "new folder that can be written\n"), (done.returncode, done.stderr))

    def test_what_is_written_as_an_object(self):
        for option, names in (("--all", ["campaign", "vehicle", "reference", "autopilot", "scenario"]), ("--out", ["vehicle"])):
            with tempfile.TemporaryDirectory() as folder:
                files = [f"{folder}/{name}.json" for name in names]
                words = ["--all", folder] if option == "--all" else ["vehicle", "--out", files[0]]
                done = dispersa("schema", "--json", *words)
                self.assertEqual({"schema": "dispersa/schema/1", "files": files}, json.loads(done.stdout))

    def test_units_and_defaults_are_hinted(self):
        site = self.validators["vehicle"].schema["properties"]["site"]["properties"]
        self.assertEqual({"type": "number", "minimum": -90, "maximum": 90,
                          "description": "°, from -90 to 90: geodetic"},
                         site["latitude_deg"])
        gravel = self.validators["vehicle"].schema["properties"]["hold_down_s"]
        self.assertEqual(0, gravel["default"])

    def test_defaults_of_flags_and_words_and_limits_that_are_open(self):
        vehicle, campaign, autopilot = (self.validators[kind].schema for kind in ("vehicle", "campaign", "autopilot"))
        self.assertIs(True, vehicle["properties"]["jet_damping"]["default"])
        self.assertIs(False, vehicle["properties"]["limits"]["properties"]["terminate"]["default"])
        verdicts = campaign["properties"]["verdicts"]["properties"]
        self.assertEqual("each", verdicts["joint"]["default"])
        self.assertNotIn("default", campaign["properties"]["sampling"]["properties"]["seed"])
        self.assertEqual({"type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 1,
                          "description": "above 0 and below 1: share of flights that must keep the limit"},
                         campaign["properties"]["requirements"]["items"]["properties"]["probability"])
        limit = vehicle["properties"]["boosters"]["properties"]["gimbal"]["properties"]["rate_limit_deg_s"]
        if "$ref" in limit:  # said once, for stages and boosters
            limit = vehicle["$defs"][limit["$ref"].rsplit("/", 1)[1]]
        self.assertEqual("°/s, above 0: of each drive", limit["description"])
        self.assertEqual(6, autopilot["$defs"]["axis_law"]["properties"]["gains"]["maxItems"])

    def test_what_keys_say_of_each_other(self):
        def refuses(name, change):
            document = load(CAMPAIGNS / name)
            self.assertEqual([], self.refusals(document))
            change(document)
            return bool(self.refusals(document))

        def second_unit(vehicle):
            vehicle["stages"][0]["liftoff_mass_kg"] = 1000 * vehicle["stages"][0]["liftoff_mass_ton"]

        def many_stages(vehicle):
            vehicle["stages"] = [vehicle["stages"][0]] * 7

        def restarts(vehicle):  # what burns again has no masses of its own
            vehicle["stages"][1]["restarts"] = True

        def bound_of_a_normal(campaign):
            campaign["dispersions"]["drag_coefficient"] = {"distribution": "normal", "three_sigma_percent": 6, "bound_percent": 5}

        def bound_of_a_uniform(campaign):
            campaign["dispersions"]["drag_coefficient"] = {"distribution": "uniform", "bound_percent": 5}

        def low_end_alone(campaign):
            campaign["dispersions"]["drag_coefficient"] = {"distribution": "triangular", "low_percent": -5, "mode_percent": 0}

        def integral_missing(autopilot):
            del autopilot["pitch"]["integral"]

        vehicle = "vehicles/slv4.yaml"
        self.assertTrue(refuses(vehicle, second_unit))
        self.assertTrue(refuses(vehicle, many_stages))
        self.assertTrue(refuses(vehicle, lambda v: v["stages"].clear()))
        self.assertTrue(refuses(vehicle, restarts))
        self.assertTrue(refuses("table3.yaml", bound_of_a_normal))
        self.assertFalse(refuses("table3.yaml", bound_of_a_uniform))
        self.assertTrue(refuses("table3.yaml", low_end_alone))
        self.assertTrue(refuses("autopilots/pid.yaml", integral_missing))

    def test_changes_are_judged_as_by_the_reader(self):
        # The changed files stand among the ones that they name.
        tree = self.folder / "campaigns"
        shutil.copytree(CAMPAIGNS, tree)
        shutil.copytree(DATA, tree / "data")
        originals = ["full.yaml", "orbit.yaml", "slv4_500km.yaml", "vehicles/slv4_flexible.yaml", "gallery/vega/vehicle.yaml",
                     "gallery/electron/vehicle.yaml", "autopilots/pid_aac.yaml", "autopilots/adaptive_fuzzy.yaml",
                     "autopilots/flexible.yaml", "data/reference.yaml", "data/scenario.yaml"]
        judged = []  # what was done, file, whether the schema refuses
        for name in originals:
            path = tree / name
            original = load(path)
            # Every so many: another one in each file.
            for i, (what, *change) in enumerate(itertools.islice(mutants(original), len(judged) % EVERY, None, EVERY)):
                document = changed(original, *change)
                file = path.parent / f"changed_{path.stem}_{i}.yaml"
                file.write_text(json.dumps(document))
                refused = bool(self.refusals(document)) if kind_of(document) else True
                if len(judged) % WHOLE == 0 and kind_of(document):
                    self.assertEqual(refused, not self.whole[kind_of(document)].is_valid(document), (name, what))
                judged.append((f"{name}: {what}", str(file), refused))
        files = [file for _, file, _ in judged]
        errors = {file: [] for file in files}
        for start in range(0, len(files), 500):
            done = dispersa("--json", "validate", *files[start:start + 500])
            self.assertIn(done.returncode, (0, 2), done.stderr)
            for error in json.loads(done.stdout)["errors"]:
                # An error in a file that is named belongs to another schema.
                errors.setdefault(error["file"], []).append(error["message"])

        too_strict = [what for what, file, refused in judged if refused and not errors[file]]
        self.assertEqual([], too_strict[:20])
        missed, excused = [], 0
        for what, file, refused in judged:
            knowable = [message for message in errors[file] if KNOWABLE.search(message)]
            if refused or not knowable:
                continue
            rest = [m for m in knowable if not any(re.search(pattern, f"{what}: {m}") for pattern, _ in ELSEWHERE)]
            excused += not rest
            if rest:
                missed.append(f"{what}: {rest[0][:150]}")
        self.assertEqual([], missed[:60])
        refused = sum(refused for _, _, refused in judged)
        self.assertGreater(refused, 3000 / EVERY)
        self.assertLess(excused, 0.02 * refused)


if __name__ == "__main__":
    unittest.main()
