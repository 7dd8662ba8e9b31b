// The pitch program: exact on cubics, consistent between angles and angular velocity, held outside.
#include "core/flight/attitude_program.h"

#include "core/math/constants.h"
#include "tests/test.h"

namespace dispersa::flight_attitude_program_test {

// Three cubics of time.
double Pitch(double t) { return 1.5 - 0.02 * t + 3e-4 * t * t - 4e-6 * t * t * t; }
double PitchRate(double t) { return -0.02 + 6e-4 * t - 12e-6 * t * t; }
double Yaw(double t) { return 0.1 + 0.004 * t - 1e-4 * t * t + 2e-6 * t * t * t; }
double YawRate(double t) { return 0.004 - 2e-4 * t + 6e-6 * t * t; }
double Roll(double t) { return -0.2 + 0.01 * t - 1e-6 * t * t * t; }
double RollRate(double t) { return 0.01 - 3e-6 * t * t; }

AttitudeProgram Cubics() {
  AttitudeProgram program;
  for (const double t : {0.0, 3.0, 10.0, 11.0, 40.0})
    program.knots.push_back({t, Pitch(t), Yaw(t), Roll(t), PitchRate(t), YawRate(t), RollRate(t)});
  return program;
}

TEST(AttitudeProgram, ReproducesCubicsAndTheirRates) {
  const AttitudeProgram program = Cubics();
  for (double t = 0.0; t <= 40.0; t += 0.37) {
    const ReferenceAttitude r = program.At(t);
    // Values of order 1 through a handful of operations.
    EXPECT_NEAR(r.angles.pitch, Pitch(t), 1e-14) << t;
    EXPECT_NEAR(r.angles.yaw, Yaw(t), 1e-14) << t;
    EXPECT_NEAR(r.angles.roll, Roll(t), 1e-14) << t;
  }
}

TEST(AttitudeProgram, AngularVelocityIsTheMotionOfItsAttitude) {
  const AttitudeProgram program = Cubics();
  const double step = 1e-4;
  for (double t = 0.2; t < 40.0; t += 1.7) {
    const ReferenceAttitude r = program.At(t);
    const Quaternion turn = Inverse(program.At(t - step).q_LR) * program.At(t + step).q_LR;
    // The turn over 2 steps, half-way: truncation of step², rounding of 1e-16 / step.
    const Vector3 w_R = RotationVector(turn) / (2.0 * step);
    EXPECT_LT((w_R - r.w_LR_R).norm(), 1e-10) << t;
    EXPECT_GT(r.w_LR_R.norm(), 1e-3);
  }
}

TEST(AttitudeProgram, IsContinuousWithItsRateAcrossKnots) {
  const AttitudeProgram program = Cubics();
  for (const double knot : {3.0, 10.0, 11.0}) {
    const ReferenceAttitude before = program.At(std::nextafter(knot, 0.0)), at = program.At(knot);
    EXPECT_NEAR(before.angles.pitch, at.angles.pitch, 1e-14);
    EXPECT_LT((before.w_LR_R - at.w_LR_R).norm(), 1e-13);
  }
}

TEST(AttitudeProgram, HoldsItsEndsWithoutRate) {
  const AttitudeProgram program = Cubics();
  EXPECT_NEAR(program.At(-5.0).angles.pitch, Pitch(0.0), 1e-15);
  EXPECT_EQ(program.At(-5.0).w_LR_R.norm(), 0.0);
  EXPECT_NEAR(program.At(100.0).angles.yaw, Yaw(40.0), 1e-15);
  EXPECT_EQ(program.At(100.0).w_LR_R.norm(), 0.0);
  EXPECT_GT(program.At(40.0).w_LR_R.norm(), 0.0) << "the last knot belongs to the program";
}

TEST(AttitudeProgram, PitchAloneTurnsAboutBodyY) {
  AttitudeProgram program;
  program.knots = {{.time_s = 0.0, .pitch = 0.5 * kPi, .pitch_rate = -0.01},
                   {.time_s = 10.0, .pitch = 0.5 * kPi - 0.1, .pitch_rate = -0.01}};
  const Vector3 w = program.At(4.0).w_LR_R;
  EXPECT_NEAR(w.y(), -0.01, 1e-15);
  EXPECT_EQ(w.x(), 0.0);
  EXPECT_EQ(w.z(), 0.0);
  // At lift-off body x points up: -z of L.
  const Vector3 up = Rotate(program.At(0.0).q_LR, Vector3(1.0, 0.0, 0.0));
  EXPECT_LT((up - Vector3(0.0, 0.0, -1.0)).norm(), 1e-15);
}

}  // namespace dispersa::flight_attitude_program_test
