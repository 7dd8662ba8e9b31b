// Actuators with a dead zone, friction and a resolution: against closed forms, an independent integration and
// describing functions.
#include "core/dynamics/launcher_lanes.h"
#include "core/flight/limit_cycle.h"
#include "core/math/constants.h"
#include "tests/test.h"

namespace dispersa::rough_actuators_test {
namespace {

constexpr double kHalfTick_s = 0.005;

Gimbal Smooth(double bandwidth_rad_s, double damping_ratio) {
  Gimbal gimbal;
  gimbal.limit_rad = 0.2;
  gimbal.rate_limit_rad_s = 50.0;
  gimbal.bandwidth_rad_s = bandwidth_rad_s;
  gimbal.damping_ratio = damping_ratio;
  return gimbal;
}

// One nozzle, moved as the engine moves it.
class Drive {
 public:
  explicit Drive(const Gimbal& gimbal) { lanes::SetActuators(drives_, 0, gimbal, -1); }

  void Move(double command_rad, double time_s) {
    const double commands[kNozzles] = {command_rad, 0.0, 0.0, 0.0};
    const auto over = lanes::TransitionOver(drives_.bandwidth2_1_s2, drives_.twice_damping_1_s, time_s);
    state_ = lanes::Propagate(drives_, commands, over, time_s, state_);
  }
  double angle_rad() const { return state_.angle_rad[0]; }
  double rate_rad_s() const { return state_.rate_rad_s[0]; }

 private:
  lanes::Actuators<double> drives_{};
  lanes::DriveState<double> state_{};
};

TEST(RoughActuators, FrictionStopsAnOscillationWhereItsClosedFormSays) {
  // Half a swing about the command, shifted by the friction against the motion, shrinks by exp(-pi zeta /
  // root): it ends at the first turn within the friction of the command.
  const double command = 0.05, friction = 0.002, zeta = 0.1;
  const double shrinks = std::exp(-kPi * zeta / std::sqrt(1.0 - zeta * zeta));
  double turn = 0.0;
  int turns = 0;
  for (double sense = 1.0; std::fabs(command - turn) > friction; sense = -sense, ++turns) {
    const double centre = command - sense * friction;
    turn = centre + (centre - turn) * shrinks;
  }
  ASSERT_GE(turns, 5);
  Gimbal gimbal = Smooth(40.0, zeta);
  gimbal.friction_rad = friction;
  Drive drive(gimbal);
  for (int i = 0; i < 400; ++i) drive.Move(command, kHalfTick_s);
  EXPECT_EQ(drive.rate_rad_s(), 0.0);
  // Steps of 0.6 ms: a turn is met to the fourth power of 40/s times that.
  EXPECT_NEAR(drive.angle_rad(), turn, 1e-6);
}

TEST(RoughActuators, StayWithinTheirDeadZoneAndFriction) {
  Gimbal gimbal = Smooth(25.0, 0.7);
  gimbal.dead_zone_rad = 0.003;
  gimbal.friction_rad = 0.002;
  Drive drive(gimbal);
  for (int i = 0; i < 200; ++i) drive.Move(0.00499, kHalfTick_s);
  EXPECT_EQ(drive.angle_rad(), 0.0);
  for (int i = 0; i < 400; ++i) drive.Move(0.02, kHalfTick_s);
  // It creeps in without a swing and stops as far away as it takes to break loose.
  EXPECT_EQ(drive.rate_rad_s(), 0.0);
  EXPECT_GT(drive.angle_rad(), 0.0149);
  EXPECT_LT(drive.angle_rad(), 0.0200);
}

TEST(RoughActuators, FollowWholeStepsOfTheirResolution) {
  Gimbal gimbal = Smooth(25.0, 0.7);
  gimbal.resolution_rad = 0.004;
  for (const auto& [command, step] :
       {std::pair(0.0019, 0.0), {0.0021, 0.004}, {-0.0061, -0.008}, {0.3, 0.2}}) {
    Drive drive(gimbal);
    for (int i = 0; i < 400; ++i) drive.Move(command, kHalfTick_s);
    EXPECT_NEAR(drive.angle_rad(), step, 1e-12) << command;
  }
}

TEST(RoughActuators, AgreeWithAnIntegrationOfTheirOwn) {
  // Moreau's time stepping: an impulse of friction at most as large as it takes to stop. First order, at 0.5
  // us: the error of a half second is some 1e-6 of what moves.
  Gimbal gimbal = Smooth(30.0, 0.5);
  gimbal.dead_zone_rad = 0.001;
  gimbal.friction_rad = 0.0015;
  Drive drive(gimbal);
  const double w2 = 900.0, zone = gimbal.dead_zone_rad, h = 5e-7;
  double angle = 0.0, rate = 0.0, largest = 0.0;
  for (int tick = 0; tick < 100; ++tick) {
    const double command = 0.02 * std::sin(0.15 * tick) + 0.004 * std::sin(0.9 * tick);
    for (int half = 0; half < 2; ++half) drive.Move(command, kHalfTick_s);
    for (int i = 0; i < 20000; ++i) {
      const double e = command - angle;
      const double pull = w2 * (e > zone ? e - zone : e < -zone ? e + zone : 0.0);
      const double free = rate + h * (pull - 2.0 * 0.5 * 30.0 * rate);
      const double impulse = h * w2 * gimbal.friction_rad;
      rate = free > impulse ? free - impulse : free < -impulse ? free + impulse : 0.0;
      angle += h * rate;
    }
    largest = std::max(largest, std::fabs(drive.angle_rad()));
    ASSERT_NEAR(drive.angle_rad(), angle, 3e-6) << tick;
  }
  EXPECT_GT(largest, 0.01);
}

TEST(RoughActuators, OneLaneMovesAsManyDo) {
  Gimbal rough = Smooth(30.0, 0.5), coarse = Smooth(40.0, 0.7);
  rough.dead_zone_rad = 0.001;
  rough.friction_rad = 0.0015;
  coarse.resolution_rad = 0.002;
  const Gimbal gimbals[4] = {rough, Smooth(25.0, 0.7), coarse, rough};
  using Four = lanes::Pack<4>;
  lanes::Actuators<Four> drives{};
  lanes::DriveState<Four> state{};
  lanes::Transition<Four> over{};
  for (int i = 0; i < kNozzles; ++i) state.angle_rad[i] = state.rate_rad_s[i] = Four(0.0);
  std::vector<Drive> alone;
  for (int lane = 0; lane < 4; ++lane) {
    lanes::SetActuators(drives, lane, gimbals[lane], -1);
    alone.emplace_back(gimbals[lane]);
    const double w = gimbals[lane].bandwidth_rad_s;
    const auto one = lanes::TransitionOver(w * w, 2.0 * gimbals[lane].damping_ratio * w, kHalfTick_s);
    lanes::Lane(over.aa, lane) = one.aa;
    lanes::Lane(over.ar, lane) = one.ar;
    lanes::Lane(over.ra, lane) = one.ra;
    lanes::Lane(over.rr, lane) = one.rr;
  }
  for (int i = 0; i < 400; ++i) {
    Four commands[kNozzles] = {Four(0.0), Four(0.0), Four(0.0), Four(0.0)};
    for (int lane = 0; lane < 4; ++lane) {
      const double command = 0.02 * std::sin(0.07 * i + lane);
      lanes::Lane(commands[0], lane) = command;
      alone[static_cast<std::size_t>(lane)].Move(command, kHalfTick_s);
    }
    state = lanes::Propagate(drives, commands, over, Four(kHalfTick_s), state);
    for (int lane = 0; lane < 4; ++lane) {
      ASSERT_EQ(lanes::Lane(state.angle_rad[0], lane), alone[static_cast<std::size_t>(lane)].angle_rad());
      ASSERT_EQ(lanes::Lane(state.rate_rad_s[0], lane), alone[static_cast<std::size_t>(lane)].rate_rad_s());
    }
  }
}

// A double integrator under PD through a drive whose resolution is a relay with three places for commands
// below one and a half steps. A cycle is where describing function and loop make 1 together, at the frequency
// at which the loop's phase is -180°: N(a) = 4 / (pi a) sqrt(1 - 1 / (4 a²)), a the amplitude of the command
// in steps. Of the two amplitudes the larger one is stable.
TEST(RoughActuators, ACoarseCommandCyclesAsItsDescribingFunctionSays) {
  const double w = 25.0, zeta = 0.7, resolution = 0.004, kStep_s = 0.001;
  const double kd_over_kp = 0.35;
  const auto loop = [&](double omega) {
    const std::complex<double> s(0.0, omega);
    // A command that is held for a step is half a step late; angle and rate are taken as the step begins.
    return (1.0 + kd_over_kp * s) / (s * s) * w * w / (s * s + 2.0 * zeta * w * s + w * w) *
           std::exp(-0.5 * kStep_s * s);
  };
  double low = 5.0, high = 25.0;  // above it the phase has passed -180°, where arg turns positive
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (std::arg(loop(middle)) < 0.0 ? low : high) = middle;
  }
  const double omega = low, gain = 0.9 / std::abs(loop(omega));
  const auto describing = [](double a) { return 4.0 / (kPi * a) * std::sqrt(1.0 - 0.25 / (a * a)); };
  double a_low = std::sqrt(0.5), a_high = 1.5;  // it falls between them
  ASSERT_LT(describing(a_high), 1.0 / 0.9);
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (a_low + a_high);
    (describing(middle) * 0.9 > 1.0 ? a_low : a_high) = middle;
  }
  const double amplitude = a_low * resolution;

  Gimbal gimbal = Smooth(w, zeta);
  gimbal.resolution_rad = resolution;
  Drive drive(gimbal);
  LimitCycleMeter meter(0.01);
  double angle = 0.002, rate = 0.0, time = 0.0, last = 0.0, largest = 0.0, swing_low = 0.0, swing_high = 0.0;
  std::vector<double> upward;
  for (int i = 0; i < 60000; ++i, time += kStep_s) {
    const double command = -gain * (angle + kd_over_kp * rate);
    const double before = drive.angle_rad();
    drive.Move(command, kStep_s);
    // The drive's angle turns the vehicle: by trapezoids.
    const double next = rate + 0.5 * kStep_s * (before + drive.angle_rad());
    angle += 0.5 * kStep_s * (rate + next);
    rate = next;
    if (i % 10 == 0) meter.Add(0.0, drive.angle_rad(), 0.0);
    if (time > 30.0) {
      largest = std::max(largest, std::fabs(command));
      swing_low = std::min(swing_low, drive.angle_rad());
      swing_high = std::max(swing_high, drive.angle_rad());
      if (last < 0.0 && command >= 0.0) upward.push_back(time - kStep_s * command / (command - last));
    }
    last = command;
  }
  ASSERT_GE(upward.size(), 10u);
  const double found = kTwoPi * static_cast<double>(upward.size() - 1) / (upward.back() - upward.front());
  EXPECT_NEAR(found / omega, 1.0, 0.03);
  EXPECT_NEAR(largest / amplitude, 1.0, 0.04);
  // And the metric of flights finds it.
  EXPECT_NEAR(meter.worst_rad() / (swing_high - swing_low), 1.0, 0.05);
}

}  // namespace
}  // namespace dispersa::rough_actuators_test
