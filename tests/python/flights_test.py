"""Flights from Python have the bits of the program's, and their histories are not copied."""
import csv
import math
import threading
import time
import unittest

import numpy

import dispersa
from program import CAMPAIGNS, SMOKE, folder_of, printed, program, resident_bytes


def owner(array):
    """What a view's memory belongs to in the end."""
    while isinstance(array.base, numpy.ndarray):
        array = array.base
    return array.base

TICK_S = 0.01  # of the campaign's autopilot: the program's histories have every tick


class One(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = folder_of(cls)
        cls.campaign = dispersa.load(SMOKE)

    def check(self, arguments, flight):
        said = printed("fly", SMOKE, *arguments, "--history", self.folder / "history.csv")
        undefined = {name: (math.nan if value is None else value) for name, value in said["metrics"].items()}
        self.assertEqual((flight.outcome, flight.end_time_s, flight.end_stage, flight.reason, flight.digest),
                         tuple(said[key] for key in ("outcome", "end_time_s", "end_stage", "reason", "digest")))
        self.assertEqual(flight.completed, said["outcome"] == "completed")
        self.assertEqual(flight.inputs, said["inputs"])
        # The program says too what no target of this campaign names.
        numpy.testing.assert_array_equal([flight.metrics.get(name, math.nan) for name in undefined], list(undefined.values()))
        # It leaves out what flights of this kind do not define.
        others = set(flight.metrics) - set(undefined)
        self.assertTrue(all(math.isnan(flight.metrics[name]) for name in others), others)
        with open(self.folder / "history.csv", newline="") as stream:
            rows = list(csv.reader(stream))
        self.assertEqual(flight.history.columns, rows[0])
        numpy.testing.assert_array_equal(flight.history.rows, [[float(c or "nan") for c in row] for row in rows[1:]])

    def test_a_case_is_the_programs_to_the_bit(self):
        self.check(["--case", 7], self.campaign.fly(7, step_s=TICK_S))

    def test_the_nominal_flight_is_the_programs_to_the_bit(self):
        self.check([], dispersa.fly(SMOKE, step_s=TICK_S))

    def test_each_integrator_is_the_programs_to_the_bit(self):
        for name in ("erk4", "cvode"):
            self.check(["--case", 2, "--integrator", name], self.campaign.fly(2, integrator=name, step_s=TICK_S))

    def test_replaced_inputs(self):
        drawn = self.campaign.fly(3, history=False)
        self.assertIsNone(drawn.history)
        # A value in the unit of its column is the draw.
        self.assertEqual(self.campaign.fly(inputs=drawn.inputs, history=False).digest, drawn.digest)
        heavier = self.campaign.fly(3, inputs={"drag_factor": 2.0}, history=False)
        self.assertEqual(heavier.inputs, {**drawn.inputs, "drag_factor": 2.0})
        self.assertNotEqual(heavier.digest, drawn.digest)
        with self.assertRaisesRegex(dispersa.BadInput, "'drag' is not an input of this vehicle"):
            self.campaign.fly(inputs={"drag": 2.0})
        with self.assertRaisesRegex(dispersa.BadInput, "inputs: drag_factor is -1, allowed: a number above 0"):
            self.campaign.fly(inputs={"drag_factor": -1.0})

    def test_history_is_the_flights_memory(self):
        history = self.campaign.fly(1).history
        column = history["altitude_m"]
        self.assertFalse(history.rows.flags.owndata or column.flags.owndata)
        self.assertTrue(numpy.shares_memory(column, history.rows))
        self.assertEqual(type(owner(column)).__name__, "PyCapsule")
        self.assertIs(owner(column), owner(history.rows))
        kept = column[-1]
        del history  # the column keeps the memory
        self.assertEqual(column[-1], kept)

    def test_bad_arguments(self):
        for arguments, said in (((12,), "the campaign has no case 12, allowed: 0 to 11"), ((-1,), "no case -1")):
            with self.assertRaisesRegex(dispersa.BadInput, said):
                self.campaign.fly(*arguments)
        with self.assertRaisesRegex(dispersa.BadInput, "'euler' is not an integrator, allowed: simpson, erk4 or cvode"):
            self.campaign.fly(integrator="euler")
        for step_s in (0.0, 0.005, 1e5):
            with self.assertRaisesRegex(dispersa.BadInput, f"step_s: {step_s} is out of range, allowed: 0.01 to 10000"):
                self.campaign.fly(step_s=step_s)
        for step_s in (math.nan, "0.1", None):
            with self.assertRaisesRegex(dispersa.BadInput, "step_s: .* is no finite number"):
                self.campaign.fly_many(1, step_s=step_s)
        for case in (1.7, "3", b"3", True, numpy.array([3])):
            with self.assertRaisesRegex(dispersa.BadInput, "the campaign has no case "):
                self.campaign.fly(case)
        for cases in ("123", b"\1\2", True, 2.5, [2.5], ["1"], [True], 13):
            with self.assertRaises(dispersa.BadInput):
                self.campaign.fly_many(cases)
        for value in (math.nan, math.inf, "5", None, True, 10**400):
            with self.assertRaisesRegex(dispersa.BadInput, "inputs: drag_factor: .* is no finite number"):
                self.campaign.fly(inputs={"drag_factor": value})
        with self.assertRaisesRegex(dispersa.BadInput, "inputs: 5 is not an input of this vehicle"):
            self.campaign.fly(inputs={5: 1.0})
        for call in (lambda: self.campaign.fly(integrator=None), lambda: self.campaign.fly_many(1, threads=None),
                     lambda: dispersa.load(SMOKE, autopilot=""), lambda: self.campaign.fly(law=5),
                     lambda: self.campaign.fly_many(1, law=5)):
            self.assertRaises(dispersa.BadInput, call)
        for cases in (numpy.int8(2), numpy.array(2), [0, 1], range(2), (numpy.uint64(i) for i in range(2))):
            self.assertEqual(self.campaign.fly_many(cases, histories=False).cases.tolist(), [0, 1])
        self.assertEqual(self.campaign.fly(numpy.uint8(3), inputs={"drag_factor": numpy.float32(1.0)}, history=False).case, 3)
        with self.assertRaisesRegex(KeyError, "has no column 'pitch_error'; there is pitch_error_deg"):
            self.campaign.fly().history["pitch_error"]


class Many(unittest.TestCase):
    COLUMNS = ["time_s", "altitude_m", "pitch_error_deg"]

    def test_each_is_the_case_alone(self):
        campaign = dispersa.load(SMOKE)
        flights = campaign.fly_many([5, 0, 11], step_s=0.1)
        self.assertEqual(flights.cases.tolist(), [5, 0, 11])
        for i, index in enumerate((5, 0, 11)):
            alone = campaign.fly(index)
            self.assertEqual(flights[i].digest, alone.digest)
            self.assertEqual(flights[i].history.columns, alone.history.columns)
            numpy.testing.assert_array_equal(flights[i].history.rows, alone.history.rows)
            self.assertEqual(flights.inputs["drag_factor"][i], alone.inputs["drag_factor"])
            self.assertEqual(flights.metrics["pitch_error_peak_deg"][i], alone.metrics["pitch_error_peak_deg"])
        self.assertEqual([flight.case for flight in flights], [5, 0, 11])
        self.assertEqual([flight.case for flight in flights[1:]], [0, 11])
        numpy.testing.assert_array_equal(flights.history(-1).rows, flights[-1].history.rows)
        self.assertEqual(len(flights.history(-1)), len(flights.history(2)))
        for position in (3, -4):
            for get in (flights.__getitem__, flights.history):
                with self.assertRaisesRegex(IndexError, f"there is no flight {position} of 3"):
                    get(position)

    def test_rows_come_at_the_output_step_and_in_coasts_where_a_stride_ends_on_it(self):
        for step_s, in_coasts_s in ((0.03, 0.15), (0.1, 0.1)):
            history = dispersa.fly(SMOKE, step_s=step_s).history
            gaps_s = numpy.diff(history["time_s"])
            flying = (history["thrust_n"] > 0.0)[1:]
            self.assertAlmostEqual(numpy.median(gaps_s[flying]), step_s)
            self.assertAlmostEqual(gaps_s.max(), in_coasts_s)

    def test_a_thousand_histories_without_copies(self):
        campaign = dispersa.load(CAMPAIGNS / "table3.yaml", cases=1000)
        # What flights side by side need while they fly, whole histories among it, is there before.
        campaign.fly_many(64, columns=self.COLUMNS, step_s=0.2)
        before = resident_bytes()
        flights = campaign.fly_many(columns=self.COLUMNS, step_s=0.2)
        size = flights.histories.nbytes
        grown = resident_bytes() - before
        self.assertEqual(len(flights), 1000)
        self.assertEqual(flights.histories.shape, (flights.offsets[-1], len(self.COLUMNS)))
        self.assertGreater(size, 50e6)  # enough for a copy to be seen
        self.assertFalse(flights.histories.flags.owndata)
        self.assertEqual(type(owner(flights.histories)).__name__, "PyCapsule")
        before_reading = resident_bytes()
        histories = [flights.history(i) for i in range(1000)]
        end = sum(history["altitude_m"][-1] for history in histories)
        self.assertGreater(end / 1000, 400e3)
        for history in histories:
            self.assertIs(owner(history["altitude_m"]), owner(flights.histories))
        # Views alone; reading the array's pages makes none.
        self.assertLess(resident_bytes() - before_reading, 0.25 * size)
        # The array, what the flights returned besides, and the engine's tables; not the array twice. Besides it were 16 MB on an
        # idle machine and 33 MB on a busy one, where more flights wait for an earlier one.
        self.assertLess(grown, size + 40e6, f"{grown / 1e6:.0f} MB for {size / 1e6:.0f} MB of histories")

    def test_other_threads_run_meanwhile(self):
        campaign = dispersa.load(CAMPAIGNS / "table3.yaml", cases=60)
        campaign.fly(0, history=False)  # what flights share is built
        ticks, stop = [], threading.Event()

        def tick():
            while not stop.is_set():
                ticks.append(time.monotonic())
                time.sleep(0.005)

        ticker = threading.Thread(target=tick)
        ticker.start()
        begin = time.monotonic()
        campaign.fly_many(threads=1, histories=False)
        end = time.monotonic()
        stop.set()
        ticker.join()
        during = sum(begin < each < end for each in ticks)
        self.assertGreater(during, 5, f"{during} ticks in {end - begin:.2f} s")

    def test_the_callers_function_sees_progress_and_can_stop(self):
        campaign = dispersa.load(SMOKE)
        seen = []
        campaign.fly_many(histories=False, progress=lambda *what: seen.append(what))
        self.assertEqual(seen[-1], ("smoke", 12, 12, ""))

        def refuse(*_):
            raise LookupError("enough")

        with self.assertRaisesRegex(LookupError, "enough"):
            campaign.fly_many(histories=False, progress=refuse)

    def test_samples_end_with_the_flight(self):
        flights = dispersa.load(SMOKE).fly_many(2, columns=["time_s", "altitude_m"], step_s=1.0)
        sampled = flights.sample("altitude_m", [0.0, 10.0, 1e6])
        self.assertEqual(sampled[:, 0].tolist(), [flights.history(i)["altitude_m"][0] for i in (0, 1)])
        self.assertTrue(numpy.isnan(sampled[:, 2]).all() and (sampled[:, 1] > sampled[:, 0]).all())
        with self.assertRaisesRegex(dispersa.BadInput, "'altitude' is not a column of histories"):
            dispersa.load(SMOKE).fly_many(2, columns=["altitude"])


if __name__ == "__main__":
    unittest.main()
