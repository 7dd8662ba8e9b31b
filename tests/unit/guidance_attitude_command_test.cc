// The commanded attitude: it keeps its limits and reaches the desired attitude.
#include "core/guidance/attitude_command.h"
#include "core/math/constants.h"
#include "tests/test.h"

namespace dispersa::guidance_attitude_command_test {
namespace {

constexpr double kDeg = kRadPerDeg;
constexpr double kTick_s = 0.01;

TEST(AttitudeCommand, TurnsWithinItsRateAndAccelerationAndDoesNotOvershoot) {
  for (const double way_deg : {0.1, 2.0, 30.0, -30.0}) {
    AttitudeCommand command;
    command.Start(0.0, {}, {});
    Direction last = command.direction();
    double last_rate = 0.0, farthest = 0.0;
    for (int tick = 1; tick <= 30000; ++tick) {
      command.Follow(tick * kTick_s, {way_deg * kDeg, 0.0}, {}, 0.5 * kDeg, 0.05 * kDeg);
      const double rate = (command.direction().pitch_rad - last.pitch_rad) / kTick_s;
      EXPECT_LE(std::fabs(rate), 0.5 * kDeg * (1.0 + 1e-9));
      EXPECT_LE(std::fabs(rate - last_rate), 0.05 * kDeg * kTick_s * (1.0 + 1e-6));
      last_rate = rate;
      last = command.direction();
      farthest = std::fmax(farthest, last.pitch_rad / (way_deg * kDeg));
    }
    EXPECT_NEAR(last.pitch_rad, way_deg * kDeg, 1e-4 * kDeg) << way_deg;
    EXPECT_LT(farthest, 1.01) << way_deg;
    EXPECT_EQ(last.yaw_rad, 0.0);
  }
}

TEST(AttitudeCommand, FollowsWhatMovesSteadily) {
  AttitudeCommand command;
  command.Start(0.0, {}, {});
  Direction wanted;
  for (int tick = 1; tick <= 3000; ++tick) {
    wanted = {0.1 * kDeg * tick * kTick_s, 5.0 * kDeg - 1.0 * kDeg * tick * kTick_s};
    command.Follow(tick * kTick_s, wanted, {0.1 * kDeg, -1.0 * kDeg}, 3.0 * kDeg, 2.0 * kDeg);
  }
  EXPECT_NEAR(command.direction().pitch_rad, wanted.pitch_rad, 0.02 * kDeg);
  EXPECT_NEAR(command.direction().yaw_rad, wanted.yaw_rad, 0.02 * kDeg);
}

TEST(AttitudeCommand, ItsAngularVelocityIsThatOfItsAttitude) {
  AttitudeCommand command;
  command.Start(0.0, {0.3, -0.4}, {0.02, 0.03});
  const double h = 1e-4;
  const Quaternion before = FromPitchYawRoll(command.AnglesAt(-h)),
                   after = FromPitchYawRoll(command.AnglesAt(h));
  const Vector3 w = RotationVector(Inverse(before) * after) / (2.0 * h);
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(command.RateAt(0.0)[axis], w[axis], 1e-9);
}

}  // namespace
}  // namespace dispersa::guidance_attitude_command_test
