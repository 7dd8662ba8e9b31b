// The effect of bending on places of the body, the effect of forces there on the modes, and the modes'
// oscillation.
#include "tests/test.h"
#include "tests/unit/made_up_bending.h"

namespace dispersa::dynamics_bending_motion_test {
namespace {

using lanes::BendingState;
using lanes::ModalForce;
using lanes::StackBending;

using Number = double (MadeUpMode::*)(double) const;

BendingState<double> SomeState() {
  BendingState<double> s{};
  s.q_m[0][0] = 0.03, s.q_m[0][1] = -0.02, s.q_m[1][0] = 0.05, s.q_m[1][1] = 0.01;
  s.rate_m_s[0][0] = -0.4, s.rate_m_s[0][1] = 0.7, s.rate_m_s[1][0] = 0.2, s.rate_m_s[1][1] = 0.9;
  return s;
}

// A plane's modes together at a station.
double Sum(int plane, const double (&by_mode)[kModes], Number of, double station_m) {
  double sum = 0.0;
  for (std::size_t mode = 0; mode < 2; ++mode)
    sum += by_mode[mode] * (TwoPlanes()[static_cast<std::size_t>(plane)][mode].*of)(station_m);
  return sum;
}

// The axis runs through (-s, y(s), z(s)). A small turn w takes its direction (1, 0, 0) to (1, -dy/ds,
// -dz/ds), which is (1, w_z, -w_y).
struct Turned {
  double about_y, about_z;
};
Turned TurnedAt(double station_m, const double (&y)[kModes], const double (&z)[kModes]) {
  return {Sum(1, z, &MadeUpMode::Slope, station_m), -Sum(0, y, &MadeUpMode::Slope, station_m)};
}

class BendingMotion : public testing::Test {
 protected:
  const ModeTable table_ = MadeUpTable(TwoPlanes());
  const StackBending<double> bending_ = BendingOf(table_, 0.0);
  const BendingState<double> state_ = SomeState();
};

constexpr double kRounding = 1e-14;  // of numbers below 10

TEST_F(BendingMotion, DisplacesAndTurnsThePivot) {
  const lanes::Bent<double> at = BentAtPivot(bending_, state_, lanes::Zero<double>(), lanes::Zero<double>());
  const Turned turned = TurnedAt(kBodyPivot_m, state_.q_m[0], state_.q_m[1]);
  EXPECT_NEAR(at.y_m, Sum(0, state_.q_m[0], &MadeUpMode::Deflection, kBodyPivot_m), kRounding);
  EXPECT_NEAR(at.z_m, Sum(1, state_.q_m[1], &MadeUpMode::Deflection, kBodyPivot_m), kRounding);
  EXPECT_NEAR(at.about_y_rad, turned.about_y, kRounding);
  EXPECT_NEAR(at.about_z_rad, turned.about_z, kRounding);
}

// Each load at the pivot moves and turns it by its plane's residual flexibility: work is positive, and a
// couple moves it by as much as a force turns it.
TEST_F(BendingMotion, LoadsAtThePivotBendWhatDoesNotFly) {
  ModeTable table = MadeUpTable(TwoPlanes());
  const double residual[kPlanes][3] = {{2e-8, 3e-9, 5e-9}, {7e-8, 1.1e-8, 1.3e-8}};
  for (int plane = 0; plane < kPlanes; ++plane)
    for (int i = 0; i < 3; ++i)
      table.rows[static_cast<std::size_t>(table.Row(plane, 0, 0) - table.rows.data() + ModeTable::kResidual +
                                          i)] = residual[plane][i];
  const StackBending<double> bending = BendingOf(table, 0.0);
  const auto at = [&](lanes::Vector<double> force, lanes::Vector<double> couple) {
    return BentAtPivot(bending, BendingState<double>{}, force, couple);
  };
  const lanes::Vector<double> none = lanes::Zero<double>(), y{0.0, 1.0, 0.0}, z{0.0, 0.0, 1.0};
  EXPECT_DOUBLE_EQ(at(y, none).y_m, residual[0][0]);
  EXPECT_DOUBLE_EQ(at(z, none).z_m, residual[1][0]);
  EXPECT_DOUBLE_EQ(at(z, none).about_y_rad, residual[1][1]);
  EXPECT_DOUBLE_EQ(at(y, none).about_z_rad, -residual[0][1]);
  EXPECT_DOUBLE_EQ(at(none, y).z_m, residual[1][1]);
  EXPECT_DOUBLE_EQ(at(none, z).y_m, -residual[0][1]);
  EXPECT_DOUBLE_EQ(at(none, y).about_y_rad, residual[1][2]);
  EXPECT_DOUBLE_EQ(at(none, z).about_z_rad, residual[0][2]);
  EXPECT_EQ(at(z, none).y_m, 0.0);
  EXPECT_EQ(at(none, y).about_z_rad, 0.0);
}

TEST_F(BendingMotion, TurnsTheInertialUnitAndEachGyro) {
  const lanes::Vector<double> turn = lanes::UnitTurn(bending_, state_);
  const Turned turned = TurnedAt(kBodyUnit_m, state_.q_m[0], state_.q_m[1]);
  EXPECT_EQ(turn.x, 0.0);
  EXPECT_NEAR(turn.y, turned.about_y, kRounding);
  EXPECT_NEAR(turn.z, turned.about_z, kRounding);
  for (int gyro = -1; gyro < kRateGyros; ++gyro) {
    const double station_m = gyro < 0 ? kBodyUnit_m : kBodyGyros_m[static_cast<std::size_t>(gyro)];
    const lanes::Vector<double> rate = lanes::TurnRate(bending_, state_, gyro);
    const Turned turning = TurnedAt(station_m, state_.rate_m_s[0], state_.rate_m_s[1]);
    EXPECT_EQ(rate.x, 0.0);
    EXPECT_NEAR(rate.y, turning.about_y, kRounding) << gyro;
    EXPECT_NEAR(rate.z, turning.about_z, kRounding) << gyro;
  }
}

// The angle of the unit is the integral of its rate.
TEST_F(BendingMotion, TheUnitsTurnGrowsByItsRate) {
  constexpr double kTime_s = 0.25;
  BendingState<double> later = state_;
  for (int plane = 0; plane < kPlanes; ++plane)
    for (int mode = 0; mode < 2; ++mode) later.q_m[plane][mode] += kTime_s * state_.rate_m_s[plane][mode];
  const lanes::Vector<double> from = lanes::UnitTurn(bending_, state_), to = lanes::UnitTurn(bending_, later),
                              rate = lanes::TurnRate(bending_, state_, -1);
  EXPECT_NEAR(to.y - from.y, kTime_s * rate.y, kRounding);
  EXPECT_NEAR(to.z - from.z, kTime_s * rate.z, kRounding);
}

// Virtual work: a mode's generalised force is the work of force and couple for a unit of its coordinate.
TEST_F(BendingMotion, AForceAtThePivotDrivesAModeByItsWork) {
  const lanes::Vector<double> force{7e4, 300.0, -500.0}, couple{90.0, 400.0, -200.0};
  ModalForce<double> driven{};
  for (int plane = 0; plane < kPlanes; ++plane)
    for (int mode = 0; mode < 2; ++mode) driven.drive_m_s2[plane][mode] = 10.0 * plane + mode;  // is added to
  const ModalForce<double> before = driven;
  DriveAtPivot(bending_, state_, force, couple, driven);
  for (int plane = 0; plane < kPlanes; ++plane)
    for (int mode = 0; mode < 2; ++mode) {
      BendingState<double> unit{};
      unit.q_m[plane][mode] = 1.0;
      const lanes::Bent<double> at =
          BentAtPivot(bending_, unit, lanes::Zero<double>(), lanes::Zero<double>());
      const double work =
          force.y * at.y_m + force.z * at.z_m + couple.y * at.about_y_rad + couple.z * at.about_z_rad;
      EXPECT_NEAR(driven.drive_m_s2[plane][mode] - before.drive_m_s2[plane][mode], work, 1e-9)
          << plane << mode;
    }
}

// The force along the axis does work F/2 q' S q: the beam becomes shorter by it.
TEST_F(BendingMotion, CompressionDrivesTheModesByTheGradientOfItsWork) {
  constexpr double kAxial_n = 3e5;
  const auto work = [&](const BendingState<double>& s) {
    double sum = 0.0;
    for (std::size_t plane = 0; plane < kPlanes; ++plane)
      for (std::size_t i = 0; i < 2; ++i)
        for (std::size_t k = 0; k < 2; ++k)
          sum += 0.5 * kAxial_n * s.q_m[plane][i] * TwoPlanes()[plane][i].shortening[k] * s.q_m[plane][k];
    return sum;
  };
  ModalForce<double> driven{};
  driven.drive_m_s2[0][1] = 250.0;
  driven.drive_m_s2[1][0] = -700.0;
  const ModalForce<double> before = driven;
  lanes::FinishDrive(bending_, state_, kAxial_n, driven);
  for (std::size_t plane = 0; plane < kPlanes; ++plane)
    for (std::size_t mode = 0; mode < 2; ++mode) {
      constexpr double kStep_m = 1e-3;
      BendingState<double> up = state_, down = state_;
      up.q_m[plane][mode] += kStep_m;
      down.q_m[plane][mode] -= kStep_m;
      const double force = before.drive_m_s2[plane][mode] + (work(up) - work(down)) / (2.0 * kStep_m);
      // Of a quadratic function the central difference is exact but for rounding of 100 J over the step.
      EXPECT_NEAR(driven.drive_m_s2[plane][mode], force / TwoPlanes()[plane][mode].mass_kg, 1e-12);
    }
}

// q'' + 2 zeta w q' + w² q = drive, from the shapes' own numbers.
struct Oscillator {
  double frequency_rad_s, damping_ratio;

  double Drive(double q, double rate, double acceleration) const {
    return acceleration + 2.0 * damping_ratio * frequency_rad_s * rate +
           frequency_rad_s * frequency_rad_s * q;
  }
};
Oscillator OscillatorOf(std::size_t plane, std::size_t mode, double damping_ratio) {
  const MadeUpMode of = TwoPlanes()[plane][mode];
  return {of.frequency_rad_s, of.damping * damping_ratio};
}

TEST_F(BendingMotion, FreeModesSwingAsDampedOscillators) {
  for (const double damping_ratio : {0.0, 0.02, 0.6}) {
    const StackBending<double> bending = BendingOf(table_, 0.0, damping_ratio);
    for (const double time_s : {0.005, 0.37}) {
      const BendingState<double> to =
          lanes::Swung(bending, lanes::SwingOver(bending, time_s), state_, {}, {}, {});
      for (std::size_t plane = 0; plane < kPlanes; ++plane)
        for (std::size_t mode = 0; mode < 2; ++mode) {
          // q = e^(-s t) (A cos d t + B sin d t).
          const Oscillator of = OscillatorOf(plane, mode, damping_ratio);
          const double w = of.frequency_rad_s, s = of.damping_ratio * w;
          const double d = w * std::sqrt(1.0 - of.damping_ratio * of.damping_ratio);
          const double a = state_.q_m[plane][mode], b = (state_.rate_m_s[plane][mode] + s * a) / d;
          const double e = std::exp(-s * time_s), cosine = std::cos(d * time_s), sine = std::sin(d * time_s);
          EXPECT_NEAR(to.q_m[plane][mode], e * (a * cosine + b * sine), 1e-15);
          EXPECT_NEAR(to.rate_m_s[plane][mode], e * ((b * d - s * a) * cosine - (a * d + s * b) * sine),
                      1e-13);
        }
    }
  }
}

// A mode that starts on a parabola of time and is driven so that the parabola solves its equation stays on
// it.
TEST_F(BendingMotion, DrivenModesFollowAParabolaExactly) {
  constexpr double kDamping = 0.05;
  const StackBending<double> bending = BendingOf(table_, 0.0, kDamping);
  BendingState<double> from{};
  ModalForce<double> d0{}, d1{}, d2{};
  const auto parabola = [](std::size_t plane, std::size_t mode, int power) {
    const double size = 0.01 * (1.0 + static_cast<double>(mode)) * (plane == 0 ? 1.0 : -2.0);
    return power == 0 ? size : power == 1 ? -3.0 * size : 20.0 * size;
  };
  for (std::size_t plane = 0; plane < kPlanes; ++plane)
    for (std::size_t mode = 0; mode < 2; ++mode) {
      const double a = parabola(plane, mode, 0), v = parabola(plane, mode, 1), c = parabola(plane, mode, 2);
      from.q_m[plane][mode] = a;
      from.rate_m_s[plane][mode] = v;
      const Oscillator of = OscillatorOf(plane, mode, kDamping);
      d0.drive_m_s2[plane][mode] = of.Drive(a, v, 2.0 * c);
      d1.drive_m_s2[plane][mode] = of.Drive(v, 2.0 * c, 0.0);
      d2.drive_m_s2[plane][mode] = of.Drive(c, 0.0, 0.0);
    }
  constexpr double kTime_s = 0.13;
  const BendingState<double> to = lanes::Swung(bending, lanes::SwingOver(bending, kTime_s), from, d0, d1, d2);
  for (std::size_t plane = 0; plane < kPlanes; ++plane)
    for (std::size_t mode = 0; mode < 2; ++mode) {
      const double a = parabola(plane, mode, 0), v = parabola(plane, mode, 1), c = parabola(plane, mode, 2);
      EXPECT_NEAR(to.q_m[plane][mode], a + kTime_s * (v + kTime_s * c), 1e-15);
      EXPECT_NEAR(to.rate_m_s[plane][mode], v + 2.0 * kTime_s * c, 1e-14);
    }
}

TEST_F(BendingMotion, TwiceATimeIsOneSwingAndThenAnother) {
  const StackBending<double> bending = BendingOf(table_, 0.0, 0.03);
  const lanes::Swing<double> once = lanes::SwingOver(bending, 0.04), twice = lanes::Twice(bending, once);
  EXPECT_EQ(twice.time_s, 0.08);
  // Drives that change: those of the second half are d(t + 0.04).
  ModalForce<double> d0{}, d1{}, d2{}, later0{}, later1{};
  for (int plane = 0; plane < kPlanes; ++plane)
    for (int mode = 0; mode < 2; ++mode) {
      const double b = d1.drive_m_s2[plane][mode] = 30.0 + mode,
                   c = d2.drive_m_s2[plane][mode] = 100.0 * plane;
      const double a = d0.drive_m_s2[plane][mode] = 1.0 - plane;
      later0.drive_m_s2[plane][mode] = a + 0.04 * (b + 0.04 * c);
      later1.drive_m_s2[plane][mode] = b + 0.08 * c;
    }
  const BendingState<double> at_once = lanes::Swung(bending, twice, state_, d0, d1, d2);
  const BendingState<double> halfway = lanes::Swung(bending, once, state_, d0, d1, d2);
  const BendingState<double> in_two = lanes::Swung(bending, once, halfway, later0, later1, d2);
  for (int plane = 0; plane < kPlanes; ++plane)
    for (int mode = 0; mode < 2; ++mode) {
      EXPECT_NEAR(at_once.q_m[plane][mode], in_two.q_m[plane][mode], 1e-15);
      EXPECT_NEAR(at_once.rate_m_s[plane][mode], in_two.rate_m_s[plane][mode], 1e-13);
    }
}

}  // namespace
}  // namespace dispersa::dynamics_bending_motion_test
