"""Control laws written in Python: flown through the same interface as those of shared objects."""
import fractions
import math
import signal
import subprocess
import sys
import unittest

import numpy

import dispersa
from program import CAMPAIGNS, SMOKE

PITCH = 1


def fused(a, b, c):
    """a * b + c, rounded once."""
    return float(fractions.Fraction(a) * fractions.Fraction(b) + fractions.Fraction(c))


def pd(tick):
    """The bits of `law: pd`."""
    return fused(tick.kp_1_s2[PITCH], tick.angle_error_rad[PITCH], tick.kd_1_s[PITCH] * tick.rate_error_rad_s[PITCH])


class Laws(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.campaign = dispersa.load(SMOKE, autopilot=CAMPAIGNS / "autopilots/pd.yaml")

    def test_a_pd_in_python_has_the_bits_of_the_built_in_one(self):
        built_in = self.campaign.fly(3)
        flown = self.campaign.fly(3, law=pd)
        self.assertEqual(flown.digest, built_in.digest)
        self.assertEqual(flown.metrics["apogee_km"], built_in.metrics["apogee_km"])

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
            self.assertGreater(ticks[-1], 10000)

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
            return pd(tick)

        with self.assertRaisesRegex(LookupError, "no gain at 20.01 s"):
            self.campaign.fly(law=late)
        with self.assertRaisesRegex(LookupError, "no gain at 20.01 s"):
            self.campaign.fly_many(3, law=late)

    def test_what_a_law_may_not_return(self):
        for returned in (None, "much", [1.0, 2.0]):
            with self.assertRaisesRegex(TypeError, "a control law returns angular accelerations"):
                self.campaign.fly(law=lambda tick: returned)
        flight = self.campaign.fly(law=lambda tick: math.nan)
        self.assertEqual(flight.outcome, "numerical_failure")
        self.assertIn("no finite number", flight.reason)

    def test_axes(self):
        with self.assertRaisesRegex(dispersa.BadInput, r"axes: \('climb',\) are not axes, allowed: some of roll, pitch and yaw"):
            self.campaign.fly(law=pd, axes=("climb",))
        both = self.campaign.fly(law=lambda t: [0.0, pd(t), fused(t.kp_1_s2[2], t.angle_error_rad[2], t.kd_1_s[2] * t.rate_error_rad_s[2])],
                                 axes=("pitch", "yaw"), history=False)
        self.assertEqual(both.outcome, "completed")

    def test_never_in_a_result_folder(self):
        """Who opens the folder could not fly it again."""
        with self.assertRaisesRegex(TypeError, "law"):
            dispersa.run(self.campaign, "nowhere", workers=0, law=pd)

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


if __name__ == "__main__":
    unittest.main()
