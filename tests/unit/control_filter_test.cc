// Second-order sections after a control law.
#include "core/control/filter.h"

#include "core/control/axis_controller.h"
#include "core/math/constants.h"
#include "tests/test.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::control_filter_test {
namespace {

constexpr double kTick_s = 0.01;

std::complex<double> ResponseOf(const DigitalSection& f, double w) {
  const std::complex<double> z = std::polar(1.0, w * kTick_s);
  return (f.b0 * z * z + f.b1 * z + f.b2) / (z * z + f.a1 * z + f.a2);
}

TEST(Discretise, KeepsRestAndThePolesFrequency) {
  for (const double w : {2.0, 20.0, 200.0}) {
    const DigitalSection low_pass = Discretise({.poles_rad_s = w, .poles_damping = 0.7}, kTick_s);
    EXPECT_NEAR(std::abs(ResponseOf(low_pass, 0.0) - 1.0), 0.0, 1e-12);
    // H(i wp) = 1 / (2 d i), prewarped exactly there.
    EXPECT_NEAR(std::abs(ResponseOf(low_pass, w) - std::complex<double>(0.0, -1.0 / 1.4)), 0.0, 1e-11);
    const DigitalSection notch = Discretise(
        {.zeros_rad_s = w, .zeros_damping = 0.05, .poles_rad_s = w, .poles_damping = 0.5}, kTick_s);
    EXPECT_NEAR(std::abs(ResponseOf(notch, w)), 0.1, 1e-11);
    EXPECT_NEAR(std::abs(ResponseOf(notch, 0.0)), 1.0, 1e-12);
  }
}

TEST(Discretise, FollowsTheContinuousSectionFarBelowTheSampling) {
  const FilterSection section{
      .zeros_rad_s = 3.0, .zeros_damping = 0.4, .poles_rad_s = 5.0, .poles_damping = 0.6};
  const DigitalSection digital = Discretise(section, kTick_s);
  for (const double w : {0.5, 3.0, 10.0}) {
    const std::complex<double> s(0.0, w);
    const std::complex<double> h = (s * s / 9.0 + 0.8 * s / 3.0 + 1.0) / (s * s / 25.0 + 1.2 * s / 5.0 + 1.0);
    EXPECT_LT(std::abs(ResponseOf(digital, w) - h), 2e-3 * std::abs(h)) << w;
  }
}

TEST(StepAxis, FiltersItsCommandInSeriesInTheStageOfEachSection) {
  AxisConfig config = SampleAxis(ControlLaw::kPd);
  config.filters = {
      {.poles_rad_s = 60.0, .poles_damping = 0.7},
      {.zeros_rad_s = 20.0, .zeros_damping = 0.1, .poles_rad_s = 20.0, .poles_damping = 0.6, .stage = 2}};
  const AxisLaw law = BuildAxisLaw(config, kTick_s);
  for (const int stage : {0, 1}) {
    AxisState state;
    AxisTelemetry telemetry;
    const double kp = config.gains[static_cast<std::size_t>(stage)].kp_1_s2;
    // The sections' difference equations, directly.
    double x[2][3] = {}, y[2][3] = {};
    for (int k = 0; k < 200; ++k) {
      const double error = std::sin(0.3 * k);
      double through = kp * error;
      for (int i = 0; i <= stage; ++i) {
        const DigitalSection f = Discretise(config.filters[static_cast<std::size_t>(i)], kTick_s);
        std::copy_backward(x[i], x[i] + 2, x[i] + 3);
        std::copy_backward(y[i], y[i] + 2, y[i] + 3);
        x[i][0] = through;
        y[i][0] = f.b0 * x[i][0] + f.b1 * x[i][1] + f.b2 * x[i][2] - f.a1 * y[i][1] - f.a2 * y[i][2];
        through = y[i][0];
      }
      EXPECT_NEAR(StepAxis(law, stage, error, 0.0, 1.0, 1.0, kTick_s, state, telemetry), through, 1e-11) << k;
    }
  }
}

}  // namespace
}  // namespace dispersa::control_filter_test
