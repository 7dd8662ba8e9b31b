"""Control laws written in Python: flown through the same interface as those of shared objects."""
import array
import collections
import decimal
import fractions
import functools
import gc
import itertools
import json
import math
import operator
import random
import signal
import subprocess
import sys
import threading
import types
import unittest
import weakref

import jsonschema
import numpy

import dispersa
from program import CAMPAIGNS, SMOKE, folder_of, printed, program, resident_bytes

PITCH = 1
DATA = CAMPAIGNS.parent / "tests/data/brief"
BRIEF = DATA / "smoke.yaml"  # under a PD with long ticks


def lost_campaign(cases):
    """The same, of flights that are lost after seconds."""
    return dispersa.load(DATA / "lost.yaml", autopilot=DATA / "pd.yaml", cases=cases)


def fused(a, b, c):
    """a * b + c, rounded once."""
    return float(fractions.Fraction(a) * fractions.Fraction(b) + fractions.Fraction(c))


def pd(tick):
    """The bits of `law: pd`."""
    return fused(tick.kp_1_s2[PITCH], tick.angle_error_rad[PITCH], tick.kd_1_s[PITCH] * tick.rate_error_rad_s[PITCH])


def rounded(tick):
    """The same to rounding, in a tenth of the time."""
    return float(tick.kp_1_s2[PITCH] * tick.angle_error_rad[PITCH] + tick.kd_1_s[PITCH] * tick.rate_error_rad_s[PITCH])


class Laws(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.campaign = dispersa.load(BRIEF)

    def test_a_pd_in_python_has_the_bits_of_the_built_in_one(self):
        built_in = self.campaign.fly(3)
        flown = self.campaign.fly(3, law=pd)
        self.assertEqual(flown.digest, built_in.digest)
        self.assertEqual(flown.metrics["apogee_km"], built_in.metrics["apogee_km"])

    def test_a_law_stands_in_the_place_of_an_axis_with_a_schedule(self):
        campaign = dispersa.load(CAMPAIGNS / "table3_flexible.yaml")
        flight = campaign.fly(law=lambda tick: 0.0, history=False)
        self.assertEqual(flight.outcome, "lost_control")

    def test_cases_side_by_side_each_with_a_memory_of_its_own(self):
        def counting(tick):
            tick.memory["ticks"] = tick.memory.get("ticks", 0) + 1
            tick.telemetry[0] = tick.memory["ticks"]
            return pd(tick)

        flights = self.campaign.fly_many([0, 4, 7], law=counting, columns=["time_s", "law_telemetry_1"])
        for i, case in enumerate((0, 4, 7)):
            self.assertEqual(flights[i].digest, self.campaign.fly(case, history=False).digest)
            ticks = flights.history(i)["law_telemetry_1"]
            ticks = ticks[numpy.isfinite(ticks)]
            self.assertTrue((numpy.diff(ticks) >= 0).all())
            self.assertGreater(ticks[-1], 5000)

    def test_what_a_law_is_told(self):
        told = []

        def listening(tick):
            if tick.memory.get("stage") != tick.stage:
                tick.memory["stage"] = tick.stage
                told.append((tick.stage, tick.limit_rad, tick.kp_1_s2.shape, tick.saturation.tolist()))
            return [9.0, pd(tick), -9.0]  # those of other axes are ignored

        flight = self.campaign.fly(law=listening, history=False)
        self.assertEqual(flight.digest, self.campaign.fly(history=False).digest)
        self.assertEqual([stage for stage, *_ in told], [1, 2, 3, 4])
        self.assertTrue(all(0.0 < limit < 0.2 and shape == (3,) for _, limit, shape, _ in told))

    def test_arrays_of_a_tick_cannot_be_written(self):
        def writing(tick):
            tick.angle_error_rad[PITCH] = 0.0

        with self.assertRaisesRegex(ValueError, "read-only"):
            self.campaign.fly(law=writing)

    def test_what_a_law_raises_is_raised(self):
        def late(tick):
            if tick.time_s > 20.0:
                raise LookupError(f"no gain at {tick.time_s:.2f} s")
            return rounded(tick)

        with self.assertRaisesRegex(LookupError, "no gain at 20.03 s"):
            self.campaign.fly(law=late)
        with self.assertRaisesRegex(LookupError, "no gain at 20.03 s"):
            self.campaign.fly_many(3, law=late)

    def test_flights_that_raise_leave_nothing_behind(self):
        def fly(count):
            for _ in range(count):
                with self.assertRaises(TypeError):
                    self.campaign.fly(law=lambda tick: None)
            gc.collect()

        def growth():
            before = resident_bytes()
            fly(30)
            return resident_bytes() - before

        fly(10)
        # The heap grows in steps; what is left behind would make it grow each time.
        self.assertLess(min(growth() for _ in range(3)), 30 * 8192)

    def test_what_a_law_may_not_return(self):
        for returned, said in ((None, r"None \(NoneType\)"), ("much", r"'much' \(str\)"), ([1.0, 2.0], r"\[1.0, 2.0\] \(list\)"),
                               (True, r"True \(bool\)"), (1j, r"1j \(complex\)"), ([0.0, None, 0.0], r"None, 0.0\] \(list\)"),
                               (numpy.zeros(1), r"array\(\[0.\]\) \(numpy.ndarray\)"), (numpy.bool_(True), r"True_? \(numpy.bool_?\)"),
                               (numpy.zeros((1, 3)), r"array\(\[\[0., 0., 0.\]\]\)"), (fractions.Fraction(1, 2), r"\(Fraction\)"),
                               ("x" * 999, r"'x{59} … \(str\)$"), ("日" * 99, r"'日{59} … \(str\)$"),
                               (type("Odd", (), {"__repr__": lambda self: "\ud800"})(), r"\\ud800 \(Odd\)$")):
            with self.assertRaisesRegex(TypeError, "a control law returns angular accelerations, rad/s.2: a number, or three, of "
                                        "roll, pitch and yaw; this one returned .*" + said) as caught:
                self.campaign.fly(law=lambda tick: returned)
            self.assertEqual(caught.exception.__notes__,
                             ["raised by the control law in the nominal flight, 0.00 s after lift-off"])
        with self.assertRaisesRegex(TypeError, "of several axes returns three .* returned one number, 0.0 .float."):
            self.campaign.fly(law=lambda tick: 0.0, axes=("pitch", "yaw"))
        flight = self.campaign.fly(law=lambda tick: math.nan)
        self.assertEqual(flight.outcome, "numerical_failure")
        self.assertIn("no finite number", flight.reason)

    def test_numbers_of_numpy_are_numbers(self):
        digest = self.campaign.fly(law=lambda tick: 0.0, history=False).digest
        for zero in (0, numpy.float64(0.0), numpy.float32(0.0), numpy.int64(0), numpy.uint8(0), [0, numpy.float32(0), 0.0],
                     numpy.zeros(3), numpy.zeros(3, dtype=numpy.int32), (0.0, 0.0, 0.0)):
            self.assertEqual(self.campaign.fly(law=lambda tick: zero, history=False).digest, digest, repr(zero))

    def test_a_note_names_case_and_time(self):
        def late(tick):
            if tick.time_s > 20.0:
                raise LookupError("no gain")
            return rounded(tick)

        with self.assertRaisesRegex(LookupError, "^'no gain'$|^no gain$") as caught:
            self.campaign.fly(7, law=late)
        self.assertEqual(caught.exception.__notes__, ["raised by the control law in case 7, 20.03 s after lift-off"])

    def test_axes(self):
        with self.assertRaisesRegex(dispersa.BadInput, r"axes: \('climb',\) are not axes, allowed: some of roll, pitch and yaw"):
            self.campaign.fly(law=pd, axes=("climb",))
        both = self.campaign.fly(law=lambda t: [0.0, rounded(t), float(t.kp_1_s2[2] * t.angle_error_rad[2] + t.kd_1_s[2] * t.rate_error_rad_s[2])],
                                 axes=("pitch", "yaw"), history=False)
        self.assertEqual(both.outcome, "completed")

    def test_interrupted(self):
        script = ("import sys, time, dispersa\n"
                  "def slow(tick):\n"
                  "    if tick.time_s == 0.0: print('flying', flush=True)\n"
                  "    time.sleep(0.01)\n"
                  "    return 0.0\n"
                  "try:\n    dispersa.fly(sys.argv[1], law=slow)\n"
                  "except KeyboardInterrupt:\n    print('interrupted')\n")
        process = subprocess.Popen([sys.executable, "-B", "-c", script, str(SMOKE)], stdout=subprocess.PIPE, text=True)
        try:
            self.assertEqual(process.stdout.readline(), "flying\n")
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.communicate(timeout=30)[0], "interrupted\n")
        finally:
            process.kill()
            process.wait()


class Campaigns(unittest.TestCase):
    """A law in Python in a campaign: in this process alone, and under ids that are nobody else's."""

    @classmethod
    def setUpClass(cls):
        cls.folder = folder_of(cls)
        cls.campaign = lost_campaign(3)
        cls.results = dispersa.run(cls.campaign, cls.folder / "flown", workers=0, law=pd)

    def text(self, name):
        return (self.results.directory / name).read_text()

    def run_of(self, law, name, **options):
        return dispersa.run(self.campaign, self.folder / name, workers=0, law=law, histories=False, **options)

    def test_only_in_this_process(self):
        for where in ({}, {"workers": 1}, {"peer": "127.0.0.1"}, {"workers": 0, "peer": "127.0.0.1"}):
            with self.assertRaisesRegex(dispersa.BadInput, "law: a control law in Python flies in this process only, "
                                        "allowed: workers=0 and no peer"):
                dispersa.run(self.campaign, self.folder / "never", law=pd, **where)
        with self.assertRaisesRegex(dispersa.BadInput, "law: 7 cannot be called"):
            dispersa.run(self.campaign, self.folder / "never", workers=0, law=7)
        self.assertFalse((self.folder / "never").exists())

    def test_the_flights_are_the_built_in_laws_but_not_the_ids(self):
        built_in = dispersa.run(self.campaign, self.folder / "built_in", workers=0, histories=False)
        self.assertEqual(self.results.digest, built_in.digest)
        self.assertNotEqual(self.results.campaign.flight_id, built_in.campaign.flight_id)
        self.assertNotEqual(self.results.campaign.id, built_in.campaign.id)
        self.assertIsNone(built_in.campaign.python_law)
        self.assertEqual(self.results.campaign.python_law[0], "pd")

    def test_the_id_is_the_laws(self):
        def made(gain):
            return lambda tick: gain * pd(tick)

        ids = [dispersa.run(self.campaign, self.folder / f"id{i}", workers=0, law=law, cases=1, histories=False).campaign.flight_id
               for i, law in enumerate((made(1.0), made(1.0), made(1.5), functools.partial(lambda gain, tick: gain * pd(tick), 1.0)))]
        self.assertEqual(ids[0], ids[1])
        self.assertEqual(len(set(ids)), 3)

    def test_resumed_with_a_law_that_was_another_then(self):
        file = self.folder / "gain.txt"

        def reading(tick):
            if "gain" not in tick.memory:
                tick.memory["gain"] = float(file.read_text())
            return tick.memory["gain"] * pd(tick)

        file.write_text("1.0")
        self.run_of(reading, "reading")
        file.write_text("0.9")
        with self.assertRaisesRegex(dispersa.BadInput, "law: the folder's first case was flown with another law: case 0 is not"):
            self.run_of(reading, "reading", resume=True)
        file.write_text("1.0")
        self.assertEqual(self.run_of(reading, "reading", resume=True).digest, self.results.digest)

    def test_axes_of_a_run(self):
        for axes in ("roll", "climb"):
            with self.assertRaisesRegex(dispersa.BadInput, f"axes: '{axes}' are not "):
                dispersa.run(self.results.campaign, self.folder / "never", workers=0, law=pd, axes=axes)
        with self.assertRaisesRegex(dispersa.BadInput, "axes: need a law in Python"):
            dispersa.run(self.campaign, self.folder / "never", workers=0, axes="climb")
        self.assertFalse((self.folder / "never").exists())
        for name, axes in (("again", "pitch"), ("once more", None)):
            again = dispersa.run(self.results.campaign, self.folder / name, workers=0, law=pd, axes=axes, histories=False)
            self.assertEqual(again.campaign, self.results.campaign)

    def test_the_folder_says_so(self):
        name, sha256 = self.results.campaign.python_law
        self.assertRegex(self.text("campaign.yaml"), f"  plugin:\n    python:\n      name: pd\n      sha256: \"?{sha256}\"?\n")
        summary = json.loads(self.text("summary.json"))
        jsonschema.validate(summary, json.loads((CAMPAIGNS.parent / "core/analysis/summary.schema.json").read_text()))
        self.assertEqual(summary["campaign"]["python_law"], {"name": name, "sha256": sha256})
        self.assertEqual({case["replay"] for case in summary["worst_cases"]}, {None})
        report = self.text("report.html")
        self.assertIn("Flown with a Python law, pd: nobody without it can fly these cases again.", report)
        self.assertIn("pitch by pd in Python", report)
        for promise in ("dispersa replay", "dispersa run campaign.yaml", "dispersa report ."):
            self.assertNotIn(promise, report)
        text = program("export", self.results.directory, "--format", "markdown", "--out", "-")
        self.assertIn("| – |", text)
        self.assertNotIn("dispersa replay", text)
        compared = dispersa.compare(self.results, self.results)
        self.assertNotIn("dispersa replay", json.dumps(compared))

    def test_the_file_alone_cannot_be_flown(self):
        file = self.results.directory / "campaign.yaml"
        said, = printed("validate", file, code=2)["errors"]
        self.assertEqual((said["path"], said["message"], said["allowed"]),
                         ("autopilot.plugin.python", "flown with a Python law, 'pd', which is not in the file: without it the "
                          "campaign cannot be flown", "dispersa.run(..., workers=0, law=...) in Python, with that law"))
        self.assertGreater(said["line"], 1)
        self.assertFalse(dispersa.validate(file))
        for command in ("run", "fly", "plan", "margins"):
            program(command, file, code=2)
        for call in (self.results.campaign.fly, lambda: dispersa.load(file), lambda: dispersa.margins(self.results.campaign),
                     lambda: dispersa.run(self.results.campaign, self.folder / "never", workers=0)):
            with self.assertRaisesRegex(dispersa.BadInput, "flown with a Python law, 'pd', which is not "):
                call()
        self.assertEqual(self.results.campaign.fly(2, law=pd).digest, self.results.digest[2])

    def test_replay_wants_the_law(self):
        program("replay", self.results.directory, "--case", 1, code=2)
        with self.assertRaisesRegex(dispersa.BadInput, "flown with a Python law, 'pd', which is not here"):
            self.results.replay(1)
        with self.assertRaisesRegex(dispersa.BadInput, "other' .* is not the Python law that the campaign was flown with, "
                                    "allowed: 'pd'"):
            def other(tick):
                return 0.0
            self.results.replay(1, law=other)
        self.assertTrue(self.results.replay(1, law=pd)["match"])
        with self.assertRaisesRegex(dispersa.BadInput, "was flown with its own autopilot"):
            dispersa.run(self.campaign, self.folder / "plain", workers=0, histories=False).replay(1, law=pd)

    def test_reports_again(self):
        before = self.text("report.html")
        program("report", self.results.directory, "--quiet", code=2)
        self.assertEqual(self.text("report.html"), before)
        with self.assertRaisesRegex(dispersa.BadInput, "flown with a Python law"):
            dispersa.report(self.results)
        dispersa.report(self.results, histories=False)
        self.assertNotIn("dispersa report .", self.text("report.html"))
        dispersa.report(self.results, law=pd)
        self.assertEqual(self.text("report.html"), before)

    def test_resumed_with_the_same_law_alone(self):
        def other(tick):
            return 0.9 * pd(tick)

        flown = self.run_of(pd, "resumed")
        with self.assertRaises(dispersa.BadInput):
            self.run_of(other, "resumed", resume=True)
        with self.assertRaises(dispersa.BadInput):
            dispersa.run(self.campaign, flown.directory, workers=0, resume=True)
        more = dispersa.run(lost_campaign(4), flown.directory, workers=0, law=pd, resume=True, histories=False)
        self.assertEqual((more.digest[:3], len(more)), (flown.digest, 4))

    def test_what_a_law_raises_ends_the_run(self):
        flown = []

        def breaking(tick):
            if tick.time_s == 0.0:
                flown.append(1)
            if len(flown) > 8 and tick.time_s > 30.0:
                raise LookupError("no gain")
            return rounded(tick)

        with self.assertRaisesRegex(LookupError, "no gain") as caught:
            dispersa.run(dispersa.load(BRIEF), self.folder / "broken", workers=0, law=breaking)
        self.assertRegex(caught.exception.__notes__[0], r"raised by the control law in case \d+.*, 30.03 s after lift-off")
        left = dispersa.results(self.folder / "broken")
        self.assertEqual([outcome for outcome in left.outcome if outcome != "completed"], [], "no flight of a broken law counts")

    def test_a_law_that_is_not_the_same_twice(self):
        count = [0]

        def drifting(tick):
            count[0] += 1
            return pd(tick) * (1.0 + 1e-9 * count[0])

        with self.assertRaisesRegex(dispersa.BadInput, "the control law .*drifting is not deterministic: of the nominal flight, "
                                    "flown twice, at 0.* s "):
            self.run_of(drifting, "drifting")
        self.assertFalse((self.folder / "drifting").exists())

    def test_every_kind_of_autopilot_gives_its_axis(self):
        for file in sorted((CAMPAIGNS / "autopilots").glob("*.yaml")):
            if "flexible" not in file.name:  # those are for a vehicle that bends
                campaign = dispersa.load(SMOKE, autopilot=file, cases=1)
                self.assertEqual(campaign.fly(law=rounded, history=False).outcome, "completed", file.name)
        campaign = dispersa.load(SMOKE, autopilot=CAMPAIGNS / "autopilots/composite_fuzzy.yaml", cases=1)  # has every key
        self.assertEqual(dispersa.run(campaign, self.folder / "fuzzy", workers=0, law=rounded, histories=False).outcome, ["completed"])

    def test_what_a_flight_remembers_ends_with_it(self):
        class Kept:
            pass

        kept = []

        def remembering(tick):
            if "kept" not in tick.memory:
                tick.memory["kept"] = Kept()
                tick.memory["itself"] = tick
                kept.append(weakref.ref(tick.memory["kept"]))
            return rounded(tick)

        alive = []
        self.campaign.fly_many(3, histories=False, law=remembering,
                               progress=lambda *_: (gc.collect(), alive.append(sum(each() is not None for each in kept))))
        self.assertEqual(len(kept), 3)
        gc.collect()
        self.assertEqual([each() for each in kept], [None] * 3)

    def test_interrupted(self):
        script = ("import sys, dispersa\n"
                  "def slow(tick):\n"
                  "    if tick.time_s == 0.0: print('flying', flush=True)\n"
                  "    return tick.kp_1_s2[1] * tick.angle_error_rad[1] + tick.kd_1_s[1] * tick.rate_error_rad_s[1]\n"
                  "try:\n    dispersa.run(sys.argv[1], sys.argv[2], cases=500, workers=0, law=slow)\n"
                  "except KeyboardInterrupt:\n    print('interrupted')\n")
        process = subprocess.Popen([sys.executable, "-B", "-c", script, str(SMOKE), str(self.folder / "interrupted")],
                                   stdout=subprocess.PIPE, text=True)
        try:
            for _ in range(20):
                self.assertEqual(process.stdout.readline(), "flying\n")
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.communicate(timeout=60)[0].split()[-1], "interrupted")
        finally:
            process.kill()
            process.wait()
        left = dispersa.results(self.folder / "interrupted")
        self.assertEqual(set(left.reason), {""} if len(left) else set())


def holding(value):
    return lambda tick: value


class Identity(unittest.TestCase):
    """What a law's hash is taken over."""

    def hash_of(self, value):
        return dispersa._law.identity(holding(value))[1]

    def test_values_of_every_kind(self):
        class Slots:
            __slots__ = ("__k",)

            def __init__(self, k):
                self.__k = k

        class Attributes(list):
            pass

        class Partial(functools.partial):
            pass

        def attributed(kind, k):
            made = kind()
            made.k = k
            return made

        made = {
            "deque": lambda k: collections.deque([k]), "bytearray": lambda k: bytearray([int(k)]),
            "array": lambda k: array.array("d", [k]), "memoryview": lambda k: memoryview(bytes([int(k)])),
            "mappingproxy": lambda k: types.MappingProxyType({"k": k}), "range": lambda k: range(int(k)), "slice": lambda k: slice(k),
            "objects": lambda k: numpy.array([k, None]), "fields": lambda k: numpy.zeros(1, [(f"k{k}", "f8")]),
            "Decimal": lambda k: decimal.Decimal(k), "bound built-in": lambda k: {1: k}.get, "getter": lambda k: operator.itemgetter(int(k)),
            "cycle": lambda k: itertools.cycle([k]), "Random": random.Random, "rng": lambda k: numpy.random.default_rng(int(k)),
            "factory": lambda k: collections.defaultdict(holding(k)), "slots": Slots, "closure": holding,
            "list with attributes": lambda k: attributed(Attributes, k), "function with attributes": lambda k: attributed(lambda: holding(0), k),
            "partial with attributes": lambda k: attributed(lambda: Partial(pd), k), "set": lambda k: {k, "other"},
            "cached": lambda k: functools.lru_cache(holding(k)), "vectorized": lambda k: numpy.vectorize(holding(k)),
            "polynomial": lambda k: numpy.poly1d([k])}
        for name, make in made.items():
            with self.subTest(name):
                self.assertEqual(self.hash_of(make(1.0)), self.hash_of(make(1.0)))
                self.assertNotEqual(self.hash_of(make(1.0)), self.hash_of(make(2.0)))

    def test_what_cannot_be_seen_is_refused(self):
        for value, kind in (((i for i in (1, 2)), "generator"), (threading.Lock(), "_thread.lock"), (numpy.frompyfunc(holding(1), 1, 1), "numpy.ufunc")):
            with self.assertRaisesRegex(dispersa.BadInput, f"law: it holds a '({kind}).*', whose state cannot be seen"):
                self.hash_of(value)
        deep = []
        for _ in range(3000):
            deep = [deep]
        with self.assertRaisesRegex(dispersa.BadInput, "law: its references are nested too deeply for the hash"):
            self.hash_of(deep)

    def test_what_contains_itself(self):
        class Node:
            def __init__(self):
                self.peers = {self}

        self.assertEqual(self.hash_of(Node()), self.hash_of(Node()))

    def test_modules_of_the_user(self):
        folder = folder_of(type(self))
        (folder / "own_gains.py").write_text("K = 1.0\n")
        sys.path.insert(0, str(folder))
        self.addCleanup(sys.path.remove, str(folder))
        import own_gains
        self.addCleanup(sys.modules.pop, "own_gains")

        def importing(tick):
            import own_gains
            return own_gains.K

        laws = {"held": lambda tick: own_gains.K, "a default": lambda tick, gains=own_gains: gains.K, "imported": importing,
                "a field's": functools.partial(lambda own, tick: own.gains.K, types.SimpleNamespace(gains=own_gains))}
        hashes = {name: dispersa._law.identity(law) for name, law in laws.items()}
        own_gains.K = 2.0
        for name, law in laws.items():
            self.assertNotEqual(dispersa._law.identity(law), hashes[name], name)
        own_gains.K = 1.0
        self.assertEqual({name: dispersa._law.identity(law) for name, law in laws.items()}, hashes)
        (folder / "own_gains.py").write_text("K = 3.0 - 2.0\n")
        for name, law in laws.items():
            self.assertNotEqual(dispersa._law.identity(law), hashes[name], name)

    def test_libraries_go_in_by_version(self):
        folder = folder_of(type(self)) / "site-packages"
        folder.mkdir()
        (folder / "own_library.py").write_text("__version__ = '1'\ndef gain():\n    return 1.0\n")
        sys.path.insert(0, str(folder))
        self.addCleanup(sys.path.remove, str(folder))
        import own_library
        self.addCleanup(sys.modules.pop, "own_library")
        first = self.hash_of(own_library.gain)
        own_library.__version__ = "2"
        self.assertNotEqual(self.hash_of(own_library.gain), first)

    def test_the_same_in_another_process(self):
        script = ("import collections, numpy, dispersa\n"
                  "table = {'a': {1.5, 'x', (2, 'y')}, 'b': collections.deque([numpy.ones(3)])}\n"
                  "def law(tick):\n    import math\n    return math.sin(table['b'][0][1])\n"
                  "print(dispersa._law.identity(law))\n")
        said = {subprocess.run([sys.executable, "-B", "-c", script], capture_output=True, text=True, check=True).stdout
                for _ in range(3)}
        self.assertEqual(len(said), 1)


if __name__ == "__main__":
    unittest.main()
