// The ends of flights, and conditions that must not change them. The sample vehicle flies above the air.
#include "core/dynamics/fall.h"
#include "core/flight/flight.h"
#include "core/math/constants.h"
#include "tests/test.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::flight_outcome_test {
namespace {

FlightResult FlyWith(const FlightInputs& inputs, const FlightDefinition& definition = HighDefinition(),
                     History* history = nullptr) {
  const FlightModel model(definition);
  FlightOptions options;
  options.history = history;
  return Fly(model, inputs, options);
}

TEST(Outcome, CompletedAtTheEndOfTheLastBurn) {
  const FlightResult result = FlyWith({});
  EXPECT_EQ(result.outcome, Outcome::kCompleted);
  EXPECT_EQ(result.reason, "");
  EXPECT_DOUBLE_EQ(result.end_time_s, 80.0);
  EXPECT_EQ(result.end_stage, 2);
}

TEST(Outcome, LostControlByRateAtTheTickAfterTheTipOff) {
  FlightInputs inputs;
  inputs.stages[0].tip_off_yaw_rad_s = 61.0 * kRadPerDeg;
  const FlightResult result = FlyWith(inputs);
  EXPECT_EQ(result.outcome, Outcome::kLostControl);
  EXPECT_EQ(result.reason, "angular rate above 60 deg/s");
  EXPECT_NEAR(result.end_time_s, 40.5, 0.011);
  EXPECT_EQ(result.end_stage, 2);
}

TEST(Outcome, LostControlByAttitudeAfterHalfASecondInTheCoastToo) {
  for (const int cycle : {1, 5}) {
    FlightDefinition definition = HighDefinition();
    definition.autopilot.reaction_control.cycle_ticks = cycle;
    FlightInputs inputs;
    inputs.stages[0].tip_off_pitch_rad_s = 50.0 * kRadPerDeg;
    const FlightResult result = FlyWith(inputs, definition);
    EXPECT_EQ(result.outcome, Outcome::kLostControl);
    EXPECT_EQ(result.reason, "attitude error above 15 deg for 0.5 s");
    // 15° at 50°/s takes 0.3 s (the thrusters slow that by a tenth of a per cent); half a second on top.
    EXPECT_NEAR(result.end_time_s, 40.5 + 0.3 + 0.5, 0.011 + 0.01 * cycle) << cycle;
  }
}

TEST(Outcome, ImpactWhenThrustDoesNotCarryTheWeight) {
  FlightInputs inputs;
  inputs.stages[0].thrust_factor = 0.3;
  const FlightResult result = FlyWith(inputs);
  EXPECT_EQ(result.outcome, Outcome::kImpact);
  EXPECT_EQ(result.reason, "fell below the launch site");
  EXPECT_LT(result.end_time_s, 5.0);
}

TEST(Outcome, ImpactInTheCoast) {
  FlightDefinition definition = HighDefinition();
  definition.last_ignition_s = 400.0;
  FlightInputs inputs;
  inputs.stages[0].thrust_factor = 0.72;
  const FlightResult result = FlyWith(inputs, definition);
  EXPECT_EQ(result.outcome, Outcome::kImpact);
  EXPECT_GT(result.end_time_s, 41.0);
  EXPECT_LT(result.end_time_s, 399.0);
}

TEST(Outcome, StructuralLimitOnlyWhenTheVehicleSaysTerminate) {
  FlightDefinition definition = HighDefinition();
  // 200 kN on 13 t is 1.57 g, on 10 t 2.04 g: after 30 s.
  definition.vehicle.limits.axial_load_g = 200e3 / (10000.0 * kStandardGravity);
  EXPECT_EQ(FlyWith({}, definition).outcome, Outcome::kCompleted);
  definition.vehicle.limits.terminate = true;
  const FlightResult result = FlyWith({}, definition);
  EXPECT_EQ(result.outcome, Outcome::kStructuralLimit);
  EXPECT_EQ(result.reason, "a structural limit of the vehicle was exceeded");
  EXPECT_NEAR(result.end_time_s, 30.0, 0.011);
}

TEST(Outcome, NumericalFailureIsData) {
  FlightInputs inputs;
  inputs.stages[0].thrust_factor = 1e300;  // the square of an acceleration overflows
  const FlightResult result = FlyWith(inputs);
  EXPECT_EQ(result.outcome, Outcome::kNumericalFailure);
  EXPECT_EQ(result.reason, "the integrator failed or the state is not finite");

  inputs.stages[0].thrust_factor = std::numeric_limits<double>::quiet_NaN();
  const FlightResult refused = FlyWith(inputs);
  EXPECT_EQ(refused.outcome, Outcome::kNumericalFailure);
  EXPECT_EQ(refused.reason, "the input thrust_factor_stage1 has no value");
}

TEST(Outcome, LossOfControlIsAsTheVehicleSays) {
  FlightInputs inputs;
  inputs.stages[0].tip_off_yaw_rad_s = 31.0 * kRadPerDeg;
  FlightDefinition definition = HighDefinition();
  definition.vehicle.loss_of_control.rate_rad_s = 30.0 * kRadPerDeg;
  const FlightResult fast = FlyWith(inputs, definition);
  EXPECT_EQ(fast.outcome, Outcome::kLostControl);
  EXPECT_EQ(fast.reason, "angular rate above the vehicle's limit");
  definition.vehicle.loss_of_control = {5.0 * kRadPerDeg, 0.2, 90.0 * kRadPerDeg};
  const FlightResult aside = FlyWith(inputs, definition);
  EXPECT_EQ(aside.outcome, Outcome::kLostControl);
  EXPECT_EQ(aside.reason, "attitude error above the vehicle's limit, for longer than it allows");
  // 5 deg at 31 deg/s, and 0.2 s.
  EXPECT_NEAR(aside.end_time_s, 40.5 + 5.0 / 31.0 + 0.2, 0.05);
}

// Above the air the way from the last burnout is a point mass'.
TEST(Outcome, CompletedAtTheApogeeIfTheCampaignSaysSo) {
  FlightDefinition definition = HighDefinition();
  const FlightResult injected = FlyWith({}, definition);
  definition.course.ends = FlightEnd::kApogee;
  const FlightResult high = FlyWith({}, definition);
  EXPECT_EQ(high.outcome, Outcome::kCompleted);
  const FallPath path = FollowFall(
      {}, {2000.0, TumblingCylinderDragArea(11.0, 1.0)},
      {injected.end_time_s, injected.end_state.p_EoC_I, injected.end_state.v_IC_I}, {.at_apogee = true});
  ASSERT_TRUE(path.apogee);
  EXPECT_EQ(high.end_time_s, path.apogee->time_s);
  EXPECT_EQ(high.metrics[MetricColumn("apogee_altitude_km")], path.apogee->altitude_m * 1e-3);
  EXPECT_EQ(high.metrics[MetricColumn("pitch_error_rms_deg")],
            injected.metrics[MetricColumn("pitch_error_rms_deg")]);
  EXPECT_TRUE(std::isnan(injected.metrics[MetricColumn("apogee_altitude_km")]));
}

TEST(Outcome, CompletedAtTheImpactOnTheSitesGround) {
  FlightDefinition definition = HighDefinition();
  definition.course.ends = FlightEnd::kImpact;
  const FlightResult fallen = FlyWith({}, definition);
  EXPECT_EQ(fallen.outcome, Outcome::kCompleted) << fallen.reason;
  // Straight up from above the equator it stays in the equator's plane, and comes down near its site.
  EXPECT_NEAR(fallen.metrics[MetricColumn("impact_downrange_km")], 0.0, 50.0);
  EXPECT_NEAR(fallen.metrics[MetricColumn("impact_crossrange_km")], 0.0, 1e-6);
  EXPECT_NEAR(fallen.metrics[MetricColumn("impact_latitude_deg")], 0.0, 1e-9);
  EXPECT_GT(fallen.metrics[MetricColumn("impact_time_s")], fallen.metrics[MetricColumn("apogee_time_s")]);
}

TEST(Outcome, TimeoutOfSimulatedTime) {
  FlightDefinition definition = HighDefinition();
  // So high that a day does not bring it back.
  definition.vehicle.site.altitude_m = 1e10;
  definition.last_ignition_s = 90000.0;
  definition.autopilot.reaction_control.cycle_ticks = 50;
  const FlightResult result = FlyWith({}, definition);
  EXPECT_EQ(result.outcome, Outcome::kTimeout);
  EXPECT_EQ(result.reason, "86400 s of simulated time passed");
  EXPECT_NEAR(result.end_time_s, 86400.0, 0.51);
}

TEST(Fly, HistoryHasARowAnOutputStepAndAnEvent) {
  History history;
  history.step_s = 1.0;
  FlyWith({}, HighDefinition(), &history);
  // 0 to 79 s, the two ends of the two burns, the separation; the end of the flight has its event's row.
  EXPECT_EQ(history.rows(), 80u + 5u);
  EXPECT_EQ(history.at(0, FindHistoryColumn("time_s")), 0.0);
  EXPECT_EQ(history.at(history.rows() - 1, FindHistoryColumn("time_s")), 80.0);
  for (std::size_t row = 1; row < history.rows(); ++row)
    EXPECT_GE(history.at(row, 0), history.at(row - 1, 0));
}

TEST(Fly, NozzleRatesStayWithinTheActuatorsLimit) {
  FlightInputs inputs;
  inputs.stages[0].thrust.misalignment_rad.magnitude = 2.0 * kRadPerDeg;
  inputs.stages[0].tip_off_pitch_rad_s = 5.0 * kRadPerDeg;
  const FlightResult result = FlyWith(inputs);
  for (std::size_t i = 0; i < MetricCount(kUsualStages); ++i)
    if (MetricNames()[i] == "deflection_rate_peak_deg_s") {
      EXPECT_LE(result.metrics[i], 30.0 * (1.0 + 1e-12));
      EXPECT_GT(result.metrics[i], 29.0) << "the limit was not met, so nothing was tested";
    }
}

TEST(LiftOffState, RestsOnTheRotatingEarthWithTheProgramsAttitude) {
  const FlightModel model(HighDefinition());
  const RigidBodyState s = LiftOffState(model);
  const Earth earth = Wgs84();
  // Equator, longitude 0, 300 km up, carried east.
  EXPECT_NEAR((s.p_EoC_I - Vector3(earth.equatorial_radius_m + 300e3, 0.0, 0.0)).norm(), 0.0, 1e-8);
  EXPECT_NEAR(s.v_IC_I.y(), earth.rotation_rate_rad_s * s.p_EoC_I.x(), 1e-9);
  const Vector3 up = Rotate(s.q_IB, Vector3(1.0, 0.0, 0.0));
  EXPECT_NEAR((up - Vector3(1.0, 0.0, 0.0)).norm(), 0.0, 1e-14);
  EXPECT_NEAR((Rotate(s.q_IB, s.w_IB_B) - Vector3(0.0, 0.0, earth.rotation_rate_rad_s)).norm(), 0.0, 1e-18);
}

}  // namespace
}  // namespace dispersa::flight_outcome_test
