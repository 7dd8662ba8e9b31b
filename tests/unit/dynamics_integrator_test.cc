// The integrators against exact solutions and against a Runge-Kutta step written out here.
#include "core/dynamics/integrator.h"
#include "tests/test.h"

namespace dispersa::dynamics_integrator_test {
namespace {

// An actuator: second order, 30 rad/s, damping 0.7, at rest with a command of 0.01 from time 0.
constexpr double kFrequency = 30.0, kDamping = 0.7, kCommand = 0.01;
using State = std::array<double, 2>;

void Actuator(double, const double* y, double* dydt, void*) {
  dydt[0] = y[1];
  dydt[1] = kFrequency * (kFrequency * (kCommand - y[0]) - 2.0 * kDamping * y[1]);
}

double ExactAngle(double t) {
  const double damped = kFrequency * std::sqrt(1.0 - kDamping * kDamping);
  return kCommand * (1.0 - std::exp(-kDamping * kFrequency * t) *
                               (std::cos(damped * t) +
                                kDamping / std::sqrt(1.0 - kDamping * kDamping) * std::sin(damped * t)));
}

constexpr double kAbsolute[] = {1e-16, 1e-15};
constexpr double kTick_s = 0.01;
constexpr int kTicks = 20;

double AngleAfterTicks(Scheme scheme, int steps) {
  Integrator integrator(scheme, 2, &Actuator, nullptr, kAbsolute);
  State y{};
  for (int k = 0; k < kTicks; ++k)
    EXPECT_TRUE(integrator.Advance(k * kTick_s, (k + 1) * kTick_s, steps, y.data()));
  return y[0];
}

TEST(RungeKutta4, IsTheClassicalMethodStepByStep) {
  for (const int steps : {1, 3}) {
    State y{};
    const double h = kTick_s / steps;
    for (int k = 0; k < kTicks * steps; ++k) {
      State k1, k2, k3, k4;
      const auto at = [&](const State& slope, double by) {
        return State{y[0] + by * slope[0], y[1] + by * slope[1]};
      };
      Actuator(0.0, y.data(), k1.data(), nullptr);
      Actuator(0.0, at(k1, 0.5 * h).data(), k2.data(), nullptr);
      Actuator(0.0, at(k2, 0.5 * h).data(), k3.data(), nullptr);
      Actuator(0.0, at(k3, h).data(), k4.data(), nullptr);
      for (std::size_t i = 0; i < 2; ++i) y[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
    }
    // Sums in another order: rounding of 0.01.
    EXPECT_NEAR(AngleAfterTicks(Scheme::kRungeKutta4, steps), y[0], 1e-16) << steps;
  }
}

TEST(RungeKutta4, HalvingTheStepDividesTheErrorBySixteen) {
  double previous = AngleAfterTicks(Scheme::kRungeKutta4, 1) - ExactAngle(kTicks * kTick_s);
  for (const int steps : {2, 4, 8}) {
    const double error = AngleAfterTicks(Scheme::kRungeKutta4, steps) - ExactAngle(kTicks * kTick_s);
    // 16 and what terms of higher order add to it at 0.3 rad a step.
    EXPECT_NEAR(previous / error, 16.0, 1.0) << steps;
    previous = error;
  }
}

TEST(Cvode, IsAccurateToItsTolerance) {
  // 20 restarts, each allowed 1e-12 of a change of 0.001 or 1e-16.
  EXPECT_NEAR(AngleAfterTicks(Scheme::kCvode, 1), ExactAngle(kTicks * kTick_s), 1e-14);
}

// A clock far from zero: position 6.4e6, velocity 7e3, no force.
void Drift(double, const double* y, double* dydt, void*) {
  dydt[0] = y[1];
  dydt[1] = 0.0;
}

TEST(Cvode, ItsRelativeToleranceIsOfTheMotionNotOfTheDistance) {
  constexpr double tolerance[] = {1e-10, 1e-12};
  Integrator integrator(Scheme::kCvode, 2, &Drift, nullptr, tolerance);
  State y = {6.4e6, 7e3};
  for (int k = 0; k < 1000; ++k) ASSERT_TRUE(integrator.Advance(k * kTick_s, (k + 1) * kTick_s, 1, y.data()));
  // The rounding of 6.4e6 m a thousand times, in a random walk; 1e-12 of 6.4e6 m a tick would be 6e-3 m.
  EXPECT_NEAR(y[0], 6.4e6 + 7e3 * 10.0, 1e-7);
}

TEST(Integrator, EveryAdvanceStartsAfresh) {
  for (const Scheme scheme : {Scheme::kRungeKutta4, Scheme::kCvode}) {
    Integrator used(scheme, 2, &Actuator, nullptr, kAbsolute),
        fresh(scheme, 2, &Actuator, nullptr, kAbsolute);
    State elsewhere = {5.0, -3.0};
    used.Advance(7.0, 7.5, 10, elsewhere.data());
    State a = {0.002, 0.1}, b = a;
    ASSERT_TRUE(used.Advance(1.0, 1.01, 2, a.data()));
    ASSERT_TRUE(fresh.Advance(1.0, 1.01, 2, b.data()));
    EXPECT_EQ(a, b);
  }
}

TEST(Integrator, AStateThatIsNotFiniteFailsAndIsLeftAlone) {
  const auto undefined = [](double, const double*, double* dydt, void*) {
    dydt[0] = dydt[1] = std::numeric_limits<double>::quiet_NaN();
  };
  for (const Scheme scheme : {Scheme::kRungeKutta4, Scheme::kCvode}) {
    Integrator integrator(scheme, 2, undefined, nullptr, kAbsolute);
    State y = {1.0, 2.0};
    EXPECT_FALSE(integrator.Advance(0.0, 1.0, 1, y.data()));
    EXPECT_EQ(y, (State{1.0, 2.0}));
  }
}

TEST(ParseScheme, KnowsItsNamesAndNoOther) {
  Scheme scheme = Scheme::kRungeKutta4;
  EXPECT_TRUE(ParseScheme("cvode", &scheme));
  EXPECT_EQ(scheme, Scheme::kCvode);
  EXPECT_TRUE(ParseScheme("erk4", &scheme));
  EXPECT_EQ(scheme, Scheme::kRungeKutta4);
  EXPECT_FALSE(ParseScheme("euler", &scheme));
}

}  // namespace
}  // namespace dispersa::dynamics_integrator_test
