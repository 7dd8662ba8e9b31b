// Whole flights in turbulence and with real actuators, against CVODE with the same air and the same
// equations.
#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa::rough_flight_test {
namespace {

// Its coast is of half a minute: turbulence is long past, and CVODE takes as long for a tick of it as for any
// other.
FlightDefinition Rough() {
  FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS);
  definition.last_ignition_s = 210.0;
  definition.noise_seed = 3;
  definition.turbulence_path =
      std::make_shared<const TurbulencePath>(ClimbPath{{0.0, 2000.0, 40e3}, {1.0, 0.9, 0.5}, 3.2});
  return definition;
}

FlightInputs InTurbulence() {
  FlightInputs inputs;
  inputs.air.turbulence_exceedance = 1e-3;
  inputs.air.turbulence_wind_20ft_m_s = 15.0;
  return inputs;
}

struct Difference {
  double altitude_m, velocity_m_s, error_peak_deg;
};
Difference Between(const FlightModel& model, const FlightInputs& inputs, const char* what) {
  SCOPED_TRACE(what);
  FlightOptions exact;
  exact.scheme = Scheme::kCvode;
  const FlightResult judged = Fly(model, inputs, exact), flown = Fly(model, inputs);
  EXPECT_EQ(judged.outcome, Outcome::kCompleted) << judged.reason;
  EXPECT_EQ(flown.outcome, Outcome::kCompleted) << flown.reason;
  const auto apart = [&](const char* metric) {
    return std::fabs(MetricOf(judged, metric) - MetricOf(flown, metric));
  };
  const Difference d{1e3 * apart("injection_altitude_km"), apart("injection_velocity_m_s"),
                     apart("pitch_error_peak_deg")};
  return d;
}

// One more firing of the coast's thrusters changes the flight by 0.04 m and 6e-4 m/s
// (flight_convergence_test.cc). The flights may differ by a few firings. The other bounds are far below the
// effect of any dispersion.
constexpr double kAltitude_m = 0.5, kVelocity_m_s = 5e-3, kPeak_deg = 1e-3;

TEST(RoughFlight, InTurbulenceIsCvodes) {
  const Difference d = Between(FlightModel(Rough()), InTurbulence(), "turbulence");
  EXPECT_LT(d.altitude_m, kAltitude_m);
  EXPECT_LT(d.velocity_m_s, kVelocity_m_s);
  EXPECT_LT(d.error_peak_deg, kPeak_deg);
}

TEST(RoughFlight, WithRealActuatorsIsCvodes) {
  FlightDefinition definition = Rough();
  for (Stage& stage : definition.vehicle.stages) {
    stage.gimbal.dead_zone_rad = 0.02 * kRadPerDeg;
    stage.gimbal.friction_rad = 0.02 * kRadPerDeg;
    stage.gimbal.resolution_rad = 0.005 * kRadPerDeg;
  }
  const FlightModel model(definition);
  // Sticking and slipping drives in turbulence make a flight depend on its last digits: a drag of 1e-12 more
  // moves the injection by metres. So CVODE's flight must lie among such neighbours of the engine's, no
  // farther beyond them than they lie apart. One drive by itself is held to an exact solution in
  // rough_actuators_test.
  std::vector<FlightOrder> neighbours(8);
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    neighbours[i].inputs = InTurbulence();
    neighbours[i].inputs.drag_factor += 1e-12 * static_cast<double>(i);
  }
  const std::vector<FlightResult> flown = FlyAll(model, neighbours);
  FlightOptions exact;
  exact.scheme = Scheme::kCvode;
  const FlightResult judged = Fly(model, InTurbulence(), exact);
  ASSERT_EQ(judged.outcome, Outcome::kCompleted) << judged.reason;
  for (const char* metric : {"injection_altitude_km", "injection_velocity_m_s", "pitch_error_rms_stage1_deg",
                             "pitch_error_rms_stage2_deg"}) {
    double low = 1e300, high = -1e300;
    for (const FlightResult& one : flown) {
      low = std::min(low, MetricOf(one, metric));
      high = std::max(high, MetricOf(one, metric));
    }
    EXPECT_GT(MetricOf(judged, metric), low - (high - low)) << metric;
    EXPECT_LT(MetricOf(judged, metric), high + (high - low)) << metric;
  }
  // The kick's, before neighbours part: the engine's steps through sticking and slipping err by a thousandth.
  const double ripple_deg = MetricOf(judged, "deflection_ripple_deg");
  EXPECT_NEAR(MetricOf(flown[0], "deflection_ripple_deg"), ripple_deg, 2e-3 * ripple_deg);
}

TEST(RoughFlight, TurbulenceIsTheCasesAndNothingElses) {
  const FlightModel model(Rough());
  const auto field = [&](const FlightInputs& inputs, std::uint64_t index) {
    return model.PlantFor(inputs, index).environment.turbulence;
  };
  FlightInputs inputs = InTurbulence();
  const auto one = field(inputs, 5);
  ASSERT_TRUE(one);
  EXPECT_EQ(one->north_m_s, field(inputs, 5)->north_m_s);
  EXPECT_NE(one->north_m_s, field(inputs, 6)->north_m_s);
  inputs.drag_factor = 1.1;
  inputs.sensors.gyro_noise_rad_s = 1e-3;
  EXPECT_EQ(one->up_m_s, field(inputs, 5)->up_m_s);
  inputs.air.turbulence_scale = 2.0;
  for (std::size_t i = 0; i < one->east_m_s.size(); i += 100)
    EXPECT_NEAR(field(inputs, 5)->east_m_s[i], 2.0 * one->east_m_s[i], 1e-12);
  FlightDefinition other = Rough();
  other.noise_seed = 4;
  EXPECT_NE(one->north_m_s, FlightModel(other).PlantFor(inputs, 5).environment.turbulence->north_m_s);
  EXPECT_FALSE(field(FlightInputs{}, 5)) << "no turbulence was asked for";
}

}  // namespace
}  // namespace dispersa::rough_flight_test
