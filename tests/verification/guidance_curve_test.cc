// Guidance of a last motor with a thrust curve, whose burn rate nobody knows before its ignition.
#include "core/campaign/flight_definition.h"
#include "core/guidance/motor_estimate.h"
#include "core/vehicle/propulsion.h"
#include "tests/gallery_launcher.h"
#include "tests/long.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa::guidance_curve_test {
namespace {

Stage LastStage() {
  Stage last = LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml").stages.back();
  ThrustCurve curve{{0.0, 0.7, 13.3, 41.1, 54.0, 55.0}, {0.3, 1.0, 1.05, 0.95, 0.9, 0.0}};
  for (double& time_s : curve.time_s) time_s *= last.motor.burning_time_s / 55.0;
  // The impulse stays: the reference was found with it.
  double impulse_s = 0.0;
  for (std::size_t i = 0; i + 1 < curve.time_s.size(); ++i)
    impulse_s += 0.5 * (curve.thrust_n[i] + curve.thrust_n[i + 1]) * (curve.time_s[i + 1] - curve.time_s[i]);
  for (double& thrust_n : curve.thrust_n)
    thrust_n *= last.motor.thrust_n * last.motor.burning_time_s / impulse_s;
  SetThrustCurve(curve, last.motor);
  return last;
}

// From readings of a motor that burns 2 % faster with 0.4 % more exhaust velocity.
TEST(GuidedCurve, FindsBurnRateAndExhaustVelocity) {
  const Stage last = LastStage();
  GuidedStage nominal;
  nominal.burn = BuildBurn(last, 1.0, 1.0);
  nominal.ignition_mass_kg = last.liftoff_mass_kg;
  const MotorBurn burn = BuildBurn(last, 1.02 * 1.004, 1.02);
  MotorEstimate estimate(nominal);
  const auto add = [&](double time_s) {
    estimate.Add(time_s, burn.vacuum_thrust_n * burn.Fraction(time_s) /
                             (nominal.ignition_mass_kg - burn.propellant_mass_kg + burn.Propellant(time_s)));
  };
  const auto off = [&] {
    const MotorBurn found = estimate.Stage(0.0).burn;
    return std::array{found.vacuum_thrust_n / burn.vacuum_thrust_n - 1.0,
                      found.duration_s / burn.duration_s - 1.0};
  };
  add(3.0);
  // At once most of it counts as burn rate, whose scatter is wider.
  EXPECT_NEAR(off()[0], 0.0, 1e-3);
  EXPECT_NEAR(off()[1], 0.0, 5e-3);
  for (double time_s = 4.0; time_s < 0.8 * burn.duration_s; time_s += 1.0) add(time_s);
  std::printf("thrust found within %.1e, duration within %.1e\n", off()[0], off()[1]);
  EXPECT_NEAR(off()[0], 0.0, 2e-4);
  EXPECT_NEAR(off()[1], 0.0, 5e-4);
  EXPECT_EQ(estimate.Stage(7.0).ignition_mass_kg, nominal.ignition_mass_kg - 7.0);
}

// A burn rate is no change of impulse. Taken for one, guidance turned energy away that was not there: 120
// km of axis. Of an impulse that is off, the reserve makes up for what it can.
TEST(GuidedCurve, DoesNotTakeABurnRateForAnImpulse) {
  FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS, "adaptive_fuzzy", "slv4_500km_reserve");
  definition.vehicle.stages.back() = LastStage();
  definition.guidance.closed_loop = true;
  const FlightModel model(definition);
  for (const double rate : IsLong() ? std::vector{0.97, 0.99, 1.0, 1.01, 1.03} : std::vector{0.97, 1.03})
    for (const double impulse : {0.995, 1.0, 1.005}) {
      SCOPED_TRACE(testing::Message() << "burn rate " << rate << ", impulse " << impulse);
      FlightInputs inputs;
      inputs.stages[3].thrust_factor = inputs.stages[3].mass_flow_factor = rate;
      inputs.stages[3].specific_impulse_factor = impulse;
      const FlightResult flown = Fly(model, inputs);
      ASSERT_EQ(flown.outcome, Outcome::kCompleted) << flown.reason;
      const double axis_km = MetricOf(flown, "semi_major_axis_error_km");
      std::printf("burn rate %.2f, impulse %.3f: axis %.3f km, perigee %.2f km, inclination %.4f deg\n", rate,
                  impulse, axis_km, MetricOf(flown, "perigee_km"), MetricOf(flown, "inclination_error_deg"));
      EXPECT_NEAR(axis_km, 0.0, 2.0);
      EXPECT_LT(std::fabs(MetricOf(flown, "inclination_error_deg")), 0.05);
    }
}

// One firing of Scout's thrusters changes its roll rate by 1.4 deg/s, and thrust does not turn with it.
// Counted as unrest, it let the last ignition wait for a minute: 10 km of axis and 1.2 deg of inclination.
TEST(GuidedCurve, WaitsForNoRoll) {
  Campaign campaign = GalleryLauncher(DISPERSA_CAMPAIGNS, "scout");
  campaign.guidance.closed_loop = true;
  const FlightModel model(DefinitionOf(campaign));
  for (const double thrust : IsLong() ? std::vector{0.988, 0.99, 0.995} : std::vector{0.988}) {
    SCOPED_TRACE(thrust);
    FlightInputs inputs;
    inputs.stages[2].thrust_factor = inputs.stages[2].mass_flow_factor = thrust;
    const FlightResult flown = Fly(model, inputs);
    ASSERT_EQ(flown.outcome, Outcome::kCompleted) << flown.reason;
    std::printf("stage 3 at %.3f: waited %g s, axis %.3f km, inclination %.4f deg\n", thrust,
                MetricOf(flown, "guidance_postponement_s"), MetricOf(flown, "semi_major_axis_error_km"),
                MetricOf(flown, "inclination_error_deg"));
    EXPECT_LT(MetricOf(flown, "guidance_postponement_s"), 10.0);
    EXPECT_NEAR(MetricOf(flown, "semi_major_axis_error_km"), 0.0, 1.0);
    EXPECT_NEAR(MetricOf(flown, "inclination_error_deg"), 0.0, 0.1);
  }
}

}  // namespace
}  // namespace dispersa::guidance_curve_test
