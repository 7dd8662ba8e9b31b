// Sensors in flight: the gyro's section, the requirements on gyros, and the inertial unit's drift.
#include "core/flight/sensor_model.h"
#include "core/flight/tick_sample.h"
#include "core/math/rotation.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa::flight_sensors_test {
namespace {

TEST(RampInvariant, FollowsARampAsTheContinuousGyroDoes) {
  const double w = 2.0 * kPi * 20.0, zeta = 0.6, tick_s = 0.01;
  const DigitalSection s = RampInvariant(w, zeta, tick_s);
  EXPECT_NEAR((s.b0 + s.b1 + s.b2) / (1.0 + s.a1 + s.a2), 1.0, 1e-12);
  // y'' + 2 zeta w y' + w² y = w² t from rest: t - 2 zeta / w, plus what rings.
  double first = 0.0, second = 0.0;
  const double d = w * std::sqrt(1.0 - zeta * zeta), lag = 2.0 * zeta / w;
  for (int k = 0; k < 30; ++k) {
    const double t = k * tick_s, y = s.b0 * t + first;
    first = s.b1 * t - s.a1 * y + second;
    second = s.b2 * t - s.a2 * y;
    const double e = std::exp(-zeta * w * t);
    const double exact = t - lag + e * (lag * std::cos(d * t) + (zeta * w * lag - 1.0) / d * std::sin(d * t));
    EXPECT_NEAR(y, exact, 1e-14) << k;
  }
}

AutopilotConfig With(std::vector<GyroShare> shares) {
  AutopilotConfig autopilot = LoadAutopilot(DISPERSA_CAMPAIGNS "/autopilots/pid.yaml");
  autopilot.rate_gyros = std::move(shares);
  return autopilot;
}

TEST(GyroProblems, NamesWhatIsNotThere) {
  const Vehicle vehicle = LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4_flexible.yaml");
  const auto problem = [&](std::vector<GyroShare> shares) {
    const auto found = GyroProblems(vehicle, With(std::move(shares)));
    return found.empty() ? std::string() : found[0].path + ": " + found[0].message;
  };
  EXPECT_EQ(problem({}), "");
  EXPECT_EQ(problem({{"gyro of stage 1", 0.25, 1}, {"gyro of stage 2", 0.75, 1}}), "");
  EXPECT_EQ(problem({{"gyro", 1.0, 1}}), "rate_gyros[0].gyro: 'gyro' is no rate gyro of the vehicle");
  EXPECT_EQ(problem({{"gyro of stage 1", 1.0, 0}}),
            "rate_gyros[0].gyro: 'gyro of stage 1' is not on board any more while stage 2 burns");
  EXPECT_EQ(problem({{"gyro of stage 1", 0.25, 1}}), "rate_gyros: the weights of stage 1 sum to 0.250000");
}

// The autopilot holds what it measures to the program, so the true error is the unit's: it drifts as
// e' = -w x e - b in the axes of a body that turns, which the product of bias and time is not.
TEST(InertialUnit, ErrorsTurnWithTheVehicle) {
  FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS, "pid");
  const FlightModel model(definition);
  FlightInputs biased;
  biased.sensors.gyro_bias_yaw_rad_s = 5.0e-5;
  Vector3 drift = Vector3::Zero();
  double last_s = 0.0, compared = 0.0;
  FlightOptions options;
  options.observe = [&](const TickSample& s) {
    // Midpoint rule.
    const double h = s.time_s - last_s;
    const Vector3 half =
        drift +
        0.5 * h * (Vector3(0.0, 0.0, biased.sensors.gyro_bias_yaw_rad_s) - s.state.w_IB_B.cross(drift));
    drift += h * (Vector3(0.0, 0.0, biased.sensors.gyro_bias_yaw_rad_s) - s.state.w_IB_B.cross(half));
    last_s = s.time_s;
    if (!s.burning || s.since_ignition_s < 20.0) return;
    const Vector3 naive(0.0, 0.0, biased.sensors.gyro_bias_yaw_rad_s * s.time_s);
    // The loop's own errors are hundredths of a degree.
    EXPECT_LT((s.error.angle_rad - drift).norm(), 0.05 * kRadPerDeg) << s.time_s;
    if (s.stack == 2) {
      EXPECT_GT((s.error.angle_rad - naive).norm(), 0.1 * kRadPerDeg) << s.time_s;
    }
    compared += 1.0;
  };
  EXPECT_EQ(Fly(model, biased, options).outcome, Outcome::kCompleted);
  EXPECT_GT(compared, 1000.0);
}

}  // namespace
}  // namespace dispersa::flight_sensors_test
