// The limits of the engine's step: whole closed-loop flights with faster and faster actuators against CVODE,
// which chooses its own steps; and the behaviour beyond the limits.
#include "core/flight/step_limits.h"
#include "core/campaign_yaml/load.h"
#include "core/flight/tick_sample.h"
#include "tests/long.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa::step_limits_test {
namespace {

FlightDefinition WithActuators(double frequency_hz, double rate_limit_deg_s = 30.0) {
  FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS);
  for (Stage& stage : definition.vehicle.stages) {
    stage.gimbal.bandwidth_rad_s = kTwoPi * frequency_hz;
    stage.gimbal.rate_limit_rad_s = rate_limit_deg_s * kRadPerDeg;
  }
  return definition;
}

// How far two integrators are apart in powered flight, and in what.
struct Compared {
  double rms_deg, peak_deg, rms_apart_deg, peak_apart_deg, yaw_peak_apart_deg;
};

// Three at most: the coast after the third has no actuators, takes three times as long, and a thruster's
// cycle more or less counts in it. CVODE takes seconds for each, so only the long test has all of them.
constexpr int kComparedStages = 3;
int StagesToCompare(int stages) { return IsLong() ? kComparedStages : stages; }

struct PoweredFlight {
  struct Stage {
    double rms_deg = 0.0, peak_deg = 0.0;
  };
  int flown_stages = kComparedStages;
  Stage stages[kComparedStages] = {};
  double yaw_peak_deg = 0.0, rate_peak_deg_s = 0.0;
};

struct LastBurnout {};

// Up to the burnout of so many stages, or to a time in the last of them.
PoweredFlight FlyPowered(const FlightModel& model, const FlightInputs& inputs, Scheme scheme, int stages,
                         double until_s = HUGE_VAL) {
  PoweredFlight flight;
  flight.flown_stages = stages;
  double squares_deg2[kComparedStages] = {};
  int ticks[kComparedStages] = {};
  FlightOptions options;
  options.scheme = scheme;
  options.observe = [&](const TickSample& tick) {
    if (tick.stack >= stages || tick.time_s > until_s) throw LastBurnout();
    if (!tick.burning) return;
    const Vector3 error_deg = tick.error.angle_rad.cwiseAbs() * kDegPerRad;
    PoweredFlight::Stage& stage = flight.stages[tick.stack];
    squares_deg2[tick.stack] += error_deg.y() * error_deg.y();
    ++ticks[tick.stack];
    stage.peak_deg = std::max(stage.peak_deg, error_deg.y());
    flight.yaw_peak_deg = std::max(flight.yaw_peak_deg, error_deg.z());
    for (const double rate_rad_s : tick.nozzle_rate_rad_s)
      flight.rate_peak_deg_s = std::max(flight.rate_peak_deg_s, std::fabs(rate_rad_s) * kDegPerRad);
  };
  try {
    const FlightResult ended = Fly(model, inputs, options);
    ADD_FAILURE() << "ended before its last burnout: " << ended.reason;
  } catch (const LastBurnout&) {
  }
  for (int stage = 0; stage < kComparedStages; ++stage)
    flight.stages[stage].rms_deg = std::sqrt(squares_deg2[stage] / std::max(ticks[stage], 1));
  return flight;
}

Compared Compare(const PoweredFlight& judged, const PoweredFlight& flown) {
  Compared c = {};
  for (int stage = 0; stage < judged.flown_stages; ++stage) {
    const PoweredFlight::Stage &a = judged.stages[stage], &b = flown.stages[stage];
    EXPECT_GT(a.rms_deg, 0.0);
    c.rms_deg = std::max(c.rms_deg, a.rms_deg);
    c.peak_deg = std::max(c.peak_deg, a.peak_deg);
    c.rms_apart_deg = std::max(c.rms_apart_deg, std::fabs(a.rms_deg - b.rms_deg));
    c.peak_apart_deg = std::max(c.peak_apart_deg, std::fabs(a.peak_deg - b.peak_deg));
  }
  c.yaw_peak_apart_deg = std::fabs(judged.yaw_peak_deg - flown.yaw_peak_deg);
  return c;
}

Compared CompareWithCvode(const FlightModel& model, const FlightInputs& inputs, int stages) {
  return Compare(FlyPowered(model, inputs, Scheme::kCvode, stages),
                 FlyPowered(model, inputs, Scheme::kSimpson, stages));
}

// A thousandth of a degree is a hundredth of what Table 3 asks for as a peak.
constexpr double kApart_deg = 1e-3;
void ExpectAgreement(const Compared& c) {
  EXPECT_LT(c.rms_apart_deg, 0.1 * kApart_deg);
  EXPECT_LT(c.peak_apart_deg, kApart_deg);
  EXPECT_LT(c.yaw_peak_apart_deg, kApart_deg);
}

// Through the first burnout, where the air is densest.
TEST(StepLimits, FastActuatorsAreCvodes) {
  {
    SCOPED_TRACE("50 Hz");
    const FlightModel model(WithActuators(50.0));
    const int stages = StagesToCompare(1);
    const PoweredFlight judged = FlyPowered(model, Table3Inputs(), Scheme::kCvode, stages);
    ExpectAgreement(Compare(judged, FlyPowered(model, Table3Inputs(), Scheme::kSimpson, stages)));
    // The classical method in one step a tick is unstable from 45 Hz on: it steps as finely as it has to.
    ExpectAgreement(Compare(judged, FlyPowered(model, Table3Inputs(), Scheme::kRungeKutta4, stages)));
  }
  SCOPED_TRACE("159 Hz");
  const FlightModel model(WithActuators(159.0));
  const double until_s = IsLong() ? HUGE_VAL : 30.0;  // the kick is over
  ExpectAgreement(Compare(FlyPowered(model, Table3Inputs(), Scheme::kCvode, 1, until_s),
                          FlyPowered(model, Table3Inputs(), Scheme::kSimpson, 1, until_s)));
}

// At 10 deg/s every transient of a misaligned stage takes the drives to their limit.
TEST(StepLimits, FastActuatorsAtTheirRateLimitAreCvodes) {
  for (const auto& [frequency_hz, stages] : {std::pair{40.0, StagesToCompare(2)}, {80.0, 2}}) {
    SCOPED_TRACE(frequency_hz);
    const double until_s = IsLong() ? HUGE_VAL : 85.0;  // the transient of stage 2 is over
    const FlightModel model(WithActuators(frequency_hz, 10.0));
    const PoweredFlight flown = FlyPowered(model, Table3Inputs(), Scheme::kSimpson, stages, until_s);
    EXPECT_NEAR(flown.rate_peak_deg_s, 10.0, 1e-9) << "the limit was not reached";
    ExpectAgreement(Compare(FlyPowered(model, Table3Inputs(), Scheme::kCvode, stages, until_s), flown));
  }
}

TEST(StepLimits, ADispersedActuatorBeyondIsRefusedAndSaysSo) {
  const FlightModel model(WithActuators(100.0));
  FlightInputs inputs;
  inputs.actuator_bandwidth_factor = 1.5;
  EXPECT_EQ(Fly(model, inputs).outcome, Outcome::kCompleted);
  EXPECT_NEAR(MetricOf(Fly(model, inputs), "step_limit_fraction"), 150.0 * kTwoPi * 0.01 / kActuatorLimit_rad,
              1e-12);
  inputs.actuator_bandwidth_factor = 1.0;
  inputs.stages[2].actuator_bandwidth_factor = 2.0;
  const FlightResult refused = Fly(model, inputs);
  EXPECT_EQ(refused.outcome, Outcome::kNumericalFailure);
  EXPECT_EQ(refused.end_time_s, 0.0);
  EXPECT_EQ(refused.reason,
            "the actuators of stage 3 (200 Hz): too fast for ticks of 10 ms, at most 159.2 Hz");
  EXPECT_GT(MetricOf(refused, "step_limit_fraction"), 1.0);
}

FlightDefinition Flexible(const char* autopilot = "flexible") {
  FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS, autopilot);
  definition.vehicle = LoadVehicle(std::string(DISPERSA_CAMPAIGNS) + "/vehicles/slv4_flexible.yaml");
  return definition;
}

// Actuators whose nozzles push the body as they turn, where they begin to be flagged. The law is one whose
// bending margins suffice: a loop near its limit magnifies any difference between two methods
// (core/dynamics/README.md).
TEST(StepLimits, HeavyNozzlesNearTheirLimitAreAlmostCvodes) {
  FlightDefinition definition = Flexible("flexible_unscheduled");
  for (Stage& stage : definition.vehicle.stages) stage.gimbal.bandwidth_rad_s = kTwoPi * 16.0;
  const FlightModel model(definition);
  EXPECT_GT(GreatestStepUse(model.PlantFor({}), 0.01).fraction, kNearStepLimit);
  const Compared c = CompareWithCvode(model, {}, StagesToCompare(1));
  EXPECT_LT(c.rms_apart_deg, 1e-3 * c.rms_deg);
  EXPECT_LT(c.peak_apart_deg, 1e-3 * c.peak_deg);
}

// The third mode of stage 2 ends at 43.7 Hz; so much stiffer at 61 Hz, beyond half the sampling frequency.
TEST(StepLimits, AModeBeyondHalfTheSamplingFrequencyIsFlaggedAndCvodes) {
  const FlightModel model(Flexible());
  FlightInputs inputs;
  inputs.bending_frequency_factor[2] = 1.4;
  const StepUse use = GreatestStepUse(model.PlantFor(inputs), 0.01);
  EXPECT_EQ(use.part.substr(0, 25), "bending mode 3 of stage 2");
  EXPECT_GT(use.fraction, kNearStepLimit);
  EXPECT_LT(use.fraction, 1.0);
  const Compared c = CompareWithCvode(model, inputs, StagesToCompare(2));
  EXPECT_LT(c.rms_apart_deg, 1e-3 * c.rms_deg);
  EXPECT_LT(c.peak_apart_deg, 1e-3 * c.peak_deg);
}

TEST(StepLimits, FasterBendingModesAreRefused) {
  const FlightModel model(Flexible());
  const StepUse nominal = GreatestStepUse(model.PlantFor({}), 0.01);
  EXPECT_GT(nominal.fraction, 0.0);
  EXPECT_LT(nominal.fraction, kNearStepLimit) << "below half the sampling frequency";
  FlightInputs inputs;
  for (double& factor : inputs.bending_frequency_factor) factor = 10.0;
  const StepUse fast = GreatestStepUse(model.PlantFor(inputs), 0.01);
  EXPECT_GT(fast.fraction, 1.0);
  EXPECT_EQ(fast.part.substr(0, 13), "bending mode ");
  EXPECT_DOUBLE_EQ(fast.limit_hz, 62.5);
  EXPECT_EQ(Fly(model, inputs).outcome, Outcome::kNumericalFailure);
}

// Of an expression, say, which no file shows.
TEST(StepLimits, MassesThatNoVehicleHasAreRefused) {
  const FlightModel model(Slv4Definition(DISPERSA_CAMPAIGNS));
  FlightInputs overfull, negative, light, tensor;
  overfull.stages[1].propellant_factor = 1.2;
  negative.stages[0].dry_mass_factor = -1.0;
  light.payload_mass_kg = -100.0;  // less than another element weighs
  light.payload_element = 1.0;
  tensor.stages[3].product_of_inertia_xy_kg_m2 = 1e5;
  EXPECT_EQ(Fly(model, overfull).reason,
            "the input propellant_factor_stage2 is 1.2; allowed: a number above 0 and not above 1.108225");
  EXPECT_EQ(Fly(model, negative).reason, "the input dry_mass_factor_stage1 is -1; allowed: a number above 0");
  EXPECT_EQ(Fly(model, light).reason, "the element 'nose' weighs less than nothing");
  EXPECT_EQ(Fly(model, tensor).reason.substr(0, 53), "the input product_of_inertia_xy_stage4_kg_m2 is 10000");
}

}  // namespace
}  // namespace dispersa::step_limits_test
