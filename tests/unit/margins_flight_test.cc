// Linearised and measured margins of a flight, and the inputs that disturb its loop.
#include "core/margins/flight_margins.h"

#include "core/flight/flight.h"
#include "core/margins/linear_axis.h"
#include "core/math/constants.h"
#include "tests/test.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::margins_flight_test {
namespace {

// The second stage takes over at once: nothing holds this vehicle's attitude in a coast through the air.
FlightDefinition HotStaged() {
  FlightDefinition definition = SampleDefinition();
  definition.vehicle.stages[0].separation_delay_s = 0.0;
  definition.last_ignition_s = 0.0;
  // Learnt in one rule, a trim bends the rule surface, which no linearisation about zero error knows.
  definition.autopilot.pitch.adaptation.spread_1_s = 60.0;
  return definition;
}

double Metric(const FlightResult& result, const std::string& name) {
  const auto& names = MetricNames();
  const auto at = std::find(names.begin(), names.end(), name);
  EXPECT_NE(at, names.end()) << name;
  return result.metrics[static_cast<std::size_t>(at - names.begin())];
}

// The first tick at least `time_s` after lift-off.
TickSample SampleAt(const FlightModel& model, double time_s) {
  TickSample found;
  bool done = false;
  FlightOptions options;
  options.observe = [&](const TickSample& s) {
    if (done || s.time_s < time_s) return;
    done = true;
    found = s;
  };
  Fly(model, FlightInputs{}, options);
  EXPECT_TRUE(done);
  return found;
}

TEST(LineariseAxis, IsTheStiffnessDampingAndEffectivenessByHand) {
  const FlightModel model(HotStaged());
  const LauncherPlant& plant = model.nominal_plant();
  const TickSample s = SampleAt(model, 20.0);
  const MassProperties mass = plant.stacks[0].mass.At(plant.stacks[0].burn.Propellant(s.since_ignition_s));
  const double inertia = mass.transverse_inertia_kg_m2;
  const AxisPlant pitch = LineariseAxis(plant, s, kPitch, model.sensors());
  // CN = 3 a on 1 m² at station 4 m; the slope over 0.06° differs from that at 0 by rounding alone.
  const double stiffness = 3.0 * s.instant.air.qbar_pa * (mass.cg_station_m - 4.0) / inertia;
  EXPECT_GT(stiffness, 0.1);
  EXPECT_NEAR(pitch.a(1, 0), stiffness, 1e-6 * stiffness);
  // Without jet damping and aerodynamic damping only the burning propellant's inertia is left.
  const double damping = plant.stacks[0].burn.full_flow_kg_s * mass.transverse_inertia_per_kg / inertia;
  EXPECT_NEAR(pitch.a(1, 1), damping, 1e-6 * damping);
  // sin(x) / x over the step of 1e-3 rad.
  const double effectiveness = 0.5 * 200e3 * (19.5 - mass.cg_station_m) / inertia;
  EXPECT_NEAR(pitch.a(1, 2), effectiveness, 1e-6 * effectiveness);
  EXPECT_EQ(pitch.a(3, 2), -625.0);
  EXPECT_EQ(pitch.b[3], 625.0);

  // An axisymmetric vehicle: yaw as pitch; roll with all four nozzles on the radius, and no stiffness.
  const AxisPlant yaw = LineariseAxis(plant, s, kYaw, model.sensors());
  EXPECT_NEAR(yaw.a(1, 0), pitch.a(1, 0), 1e-5 * stiffness);
  EXPECT_NEAR(yaw.a(1, 2), pitch.a(1, 2), 1e-6 * effectiveness);
  const AxisPlant roll = LineariseAxis(plant, s, kRoll, model.sensors());
  EXPECT_NEAR(roll.a(1, 0), 0.0, 1e-9);
  const double roll_effectiveness = 200e3 * 0.4 / mass.axial_inertia_kg_m2;
  EXPECT_NEAR(roll.a(1, 2), roll_effectiveness, 1e-6 * roll_effectiveness);
}

// m z'' = -(X + N) angle - N z' / V + P / 2 deflection, I angle'' += N arm z' / V, with N a radian's normal
// force.
TEST(LineariseAxis, OfAPathThatDriftsIsTheShortPeriodByHand) {
  FlightDefinition definition = HotStaged();
  definition.vehicle.flow_coriolis = false;  // the flow pushes a turning vehicle sideways: variable_mass_test
  const FlightModel model(definition);
  const LauncherPlant& plant = model.nominal_plant();
  const TickSample s = SampleAt(model, 20.0);
  const MassProperties mass = plant.stacks[0].mass.At(plant.stacks[0].burn.Propellant(s.since_ignition_s));
  const AxisPlant held = LineariseAxis(plant, s, kPitch, model.sensors());
  const AxisPlant pitch = LineariseAxis(plant, s, kPitch, model.sensors(), LateralPath::kDrifts);
  ASSERT_EQ(pitch.a.rows(), 5);
  EXPECT_TRUE(pitch.drifts);
  EXPECT_FALSE(held.drifts);
  EXPECT_EQ(pitch.a.topLeftCorner(4, 4), held.a);
  EXPECT_EQ(pitch.b.head(4), held.b);
  EXPECT_EQ(pitch.attitude[4], 0.0);
  const double speed = s.instant.v_AB_B.norm(), normal_n = 3.0 * s.instant.air.qbar_pa;
  const double axial_n = 200e3 - 0.3 * s.instant.air.qbar_pa;
  const auto near = [](double value, double by_hand, const char* name) {
    EXPECT_NEAR(value, by_hand, 2e-5 * std::fabs(by_hand)) << name;
  };
  near(pitch.a(1, 4), pitch.a(1, 0) / speed, "moment by drift");
  near(pitch.a(4, 4), -normal_n / (mass.mass_kg * speed), "damping of the drift");
  near(pitch.a(4, 0), -(axial_n + normal_n) / mass.mass_kg, "force by attitude");
  near(pitch.a(4, 2), 0.5 * 200e3 / mass.mass_kg, "force by deflection");
  EXPECT_NEAR(pitch.a(4, 1), 0.0, 1e-9);
  EXPECT_EQ(pitch.b[4], 0.0);

  const AxisPlant yaw = LineariseAxis(plant, s, kYaw, model.sensors(), LateralPath::kDrifts);
  for (const int column : {0, 2, 4}) near(yaw.a(4, column), pitch.a(4, column), "yaw as pitch");
  near(yaw.a(1, 4), pitch.a(1, 4), "yaw as pitch");
  const AxisPlant roll = LineariseAxis(plant, s, kRoll, model.sensors(), LateralPath::kDrifts);
  EXPECT_EQ(roll.a, LineariseAxis(plant, s, kRoll, model.sensors()).a);
  EXPECT_FALSE(roll.drifts);
}

// This vehicle is aerodynamically unstable: if the path may drift, the margin to a lower gain is smaller.
// Without air the drift has no effect.
TEST(ComputeMargins, OfAPathThatDrifts) {
  const FlightModel model(HotStaged()), in_space(HighDefinition());
  const auto at = [](const FlightModel& of, LateralPath path, const std::string& place) {
    const std::vector<ComputedMargins> all = ComputeMargins(of, 10.0, {}, {kFrequencyBand, path});
    return std::find_if(all.begin(), all.end(),
                        [&](const ComputedMargins& m) { return m.place == place && m.axis == kYaw; })
        ->frozen;
  };
  const LoopMargins held = at(model, LateralPath::kHeld, "max q"),
                    drifting = at(model, LateralPath::kDrifts, "max q");
  EXPECT_TRUE(drifting.stable);
  EXPECT_LT(drifting.gain_down_db, held.gain_down_db);
  EXPECT_NEAR(drifting.gain_up_db, held.gain_up_db, 0.05);
  const LoopMargins still = at(in_space, LateralPath::kHeld, "lift-off"),
                    free = at(in_space, LateralPath::kDrifts, "lift-off");
  EXPECT_TRUE(free.stable);
  EXPECT_NEAR(free.gain_up_db, still.gain_up_db, 1e-6);
  EXPECT_NEAR(free.phase_deg, still.phase_deg, 1e-6);
}

TEST(ComputeMargins, NamesEveryPhaseOnAllAxes) {
  const FlightModel model(HotStaged());
  const std::vector<ComputedMargins> all = ComputeMargins(model, 10.0);
  for (const char* place : {"lift-off", "stage 1 ignition + 1 s", "max q", "stage 1 burnout",
                            "stage 2 ignition + 1 s", "stage 2 burnout"}) {
    EXPECT_EQ(
        std::count_if(all.begin(), all.end(), [&](const ComputedMargins& m) { return m.place == place; }), 3)
        << place;
  }
  // Between: at 10, 20, 30 s of a burn of 40 s (the fourth is its burnout or the tick before) and 10 s of 20.
  EXPECT_GE(std::count_if(all.begin(), all.end(), [](const ComputedMargins& m) { return m.place.empty(); }),
            12);
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end(), [](const ComputedMargins& a, const ComputedMargins& b) {
    return a.time_s < b.time_s;
  }));
  for (const ComputedMargins& m : all) {
    EXPECT_TRUE(m.frozen.stable);
    // Only pitch adapts here.
    if (m.axis != kPitch) {
      EXPECT_EQ(m.frozen.gain_up_db, m.adapting.gain_up_db);
    } else {
      EXPECT_GT(m.frozen.gain_up_db, m.adapting.gain_up_db);
    }
  }
}

// Stage 1 falls to a tenth of its thrust at 31.5 s, and below a fifth just after 31 s.
TEST(SkippedInstants, HaveLittleThrustAndAreNotAmongTheOthers) {
  FlightDefinition definition = HotStaged();
  Motor& motor = definition.vehicle.stages[0].motor;
  SetThrustCurve({{0.0, 28.0, 31.5, 45.0}, {200e3, 200e3, 20e3, 0.0}}, motor);
  const FlightModel model(definition);
  const std::vector<SkippedInstant> skipped = SkippedInstants(model, 5.0);
  ASSERT_GE(skipped.size(), 3u);
  EXPECT_EQ(skipped.back().place, "stage 1 burnout");
  for (const SkippedInstant& at : skipped) {
    EXPECT_EQ(at.stage, 0);
    EXPECT_GT(at.time_s, 31.0);
    EXPECT_LT(at.thrust_fraction, kLeastThrustFraction);
  }
  const std::vector<MarginInstant> instants = MarginInstants(model, 5.0);
  const auto tail_off = std::find_if(instants.begin(), instants.end(),
                                     [](const MarginInstant& at) { return at.place == "stage 1 tail-off"; });
  ASSERT_NE(tail_off, instants.end());
  const MotorBurn& burn = model.nominal_plant().stacks[0].burn;
  const double level = burn.Fraction(tail_off->sample.since_ignition_s);
  EXPECT_GE(level, kLeastThrustFraction);
  EXPECT_NEAR(level, kLeastThrustFraction, 0.01);  // a tick of 10 ms before it
  for (const MarginInstant& at : instants) {
    EXPECT_NE(at.place, "stage 1 burnout");
    if (at.sample.stack == 0) {
      EXPECT_LE(at.sample.time_s, tail_off->sample.time_s);
    }
  }
  // Constant thrust has none to skip.
  EXPECT_TRUE(SkippedInstants(FlightModel(HotStaged()), 5.0).empty());
}

TEST(ComputeMargins, OfAVehicleThatIsNotTheNominal) {
  const FlightModel model(HotStaged());
  FlightInputs light;
  light.inertia_factor = 0.8;
  const std::vector<ComputedMargins> nominal = ComputeMargins(model, 10.0),
                                     other = ComputeMargins(model, 10.0, light);
  ASSERT_EQ(other.size(), nominal.size());
  // The loop's gain is over the inertia: 1.94 dB less room. The autopilot does not know, and the air's
  // stiffness, which grows too, counts little at the frequencies of the margin.
  for (std::size_t i = 0; i < other.size(); ++i)
    EXPECT_NEAR(nominal[i].frozen.gain_up_db - other[i].frozen.gain_up_db, 20.0 * std::log10(1.0 / 0.8), 0.3)
        << nominal[i].time_s << " s, axis " << nominal[i].axis;
}

TEST(LineariseLearntLaw, HasTheSlopesOfBothSidesOfTheRuleThatLearnt) {
  const FlightModel model(HotStaged());
  TickSample s = SampleAt(model, 20.0);
  AxisState& memory = s.memories[kPitch];
  memory = {};
  const LinearLaw fresh = LineariseLaw(model.autopilot(), 0, s.since_ignition_s, kPitch, true);
  constexpr double kLearnt_rad_s2 = 0.01;
  memory.departure_rad_s2[12] = kLearnt_rad_s2;  // of the central rule alone
  const FuzzyRules& rules = model.definition().autopilot.pitch.rules;
  for (const int error : {-1, 1}) {
    for (const int rate : {-1, 1}) {
      const LinearLaw learnt = LineariseLearntLaw(model.autopilot(), s, kPitch, {error, rate});
      // Up to the middle, down beyond it; sets are half a range apart.
      EXPECT_NEAR(learnt.kp_1_s2, fresh.kp_1_s2 - error * kLearnt_rad_s2 / (0.5 * rules.error_range_rad),
                  1e-12);
      EXPECT_NEAR(learnt.kd_1_s, fresh.kd_1_s - rate * kLearnt_rad_s2 / (0.5 * rules.rate_range_rad_s),
                  1e-12);
    }
  }
  // A value that all rules have learnt is no slope.
  for (double& departure : memory.departure_rad_s2) departure = kLearnt_rad_s2;
  EXPECT_EQ(LineariseLearntLaw(model.autopilot(), s, kPitch, {}).kp_1_s2, fresh.kp_1_s2);
}

// The margin of pitch at lift-off.
LoopMargins AtLiftOff(const FlightModel& model, const FlightInputs& inputs) {
  const DispersedMargins found = ComputeDispersedMargins(model, {inputs, {}}, 10.0);
  EXPECT_EQ(found.margins.at(0).axis, kPitch);
  return found.margins.at(0).frozen;
}

TEST(ComputeDispersedMargins, AreThoseOfTheFlightsOwnPlant) {
  const FlightModel model(HotStaged());
  const double nominal_db = AtLiftOff(model, {}).gain_up_db;
  const double half_db = 20.0 * std::log10(2.0);
  FlightInputs stuck;
  stuck.stuck_nozzle = 1.0;  // one of the two that turn pitch
  stuck.stuck_nozzle_stage = 1.0;
  EXPECT_NEAR(AtLiftOff(model, stuck).gain_up_db, nominal_db + half_db, 1e-3);
  FlightInputs spoilt;
  spoilt.loop_gain_factor = 0.5;
  EXPECT_NEAR(AtLiftOff(model, spoilt).gain_up_db, nominal_db + half_db, 1e-9);
  spoilt.loop_stage = 2.0;
  EXPECT_EQ(AtLiftOff(model, spoilt).gain_up_db, nominal_db);
}

TEST(ComputeDispersedMargins, EndWithTheFlight) {
  const FlightModel model(HotStaged());
  FlightInputs hopeless;
  for (StageInputs& stage : hopeless.stages) stage.thrust.misalignment_rad.magnitude = 20.0 * kRadPerDeg;
  const DispersedMargins found = ComputeDispersedMargins(model, {hopeless, {}});
  EXPECT_NE(found.outcome, Outcome::kCompleted);
  EXPECT_LT(found.margins.size(), ComputeDispersedMargins(model, {}).margins.size());
}

void ExpectMeasuredAsComputed(const FlightDefinition& definition) {
  const FlightModel model(definition);
  const std::vector<ComputedMargins> computed = ComputeMargins(model, 5.0);
  const std::vector<MeasuredMargins> measured = MeasureMargins(model);
  ASSERT_EQ(measured.size(), 2u);
  for (const MeasuredMargins& m : measured) {
    double up = 1e9, down = kMeasuredGainCeiling_db, delay = 1e9;
    for (const ComputedMargins& c : computed) {
      if (c.stage != m.stage) continue;
      up = std::min(up, c.adapting.gain_up_db);
      down = std::min(down, c.adapting.gain_down_db);
      delay = std::min(delay, c.adapting.delay_s);
    }
    // A cycle that barely grows is not seen within a short burn, and one that barely decays outlasts the
    // start-up transient: both blur the limit.
    EXPECT_NEAR(m.gain_up_db, up, 0.5) << "stage " << m.stage + 1;
    // Towards less gain the slow divergence of an unstable body takes longer than a burn to be seen.
    EXPECT_GE(m.gain_down_db, down - 0.5) << "stage " << m.stage + 1;
    EXPECT_NE(m.gain_down_db, m.gain_up_db) << "stage " << m.stage + 1;
    EXPECT_NEAR(m.delay_s, delay, 0.15 * delay) << "stage " << m.stage + 1;
  }
}

TEST(MeasureMargins, AgreeWithTheComputedOnes) { ExpectMeasuredAsComputed(HotStaged()); }

TEST(MeasureMargins, OfAVehicleThatIsNotTheNominalHaveItsGain) {
  const FlightModel model(HotStaged());
  FlightInputs light;
  light.inertia_factor = 0.8;
  const std::vector<ComputedMargins> computed = ComputeMargins(model, 5.0, light);
  for (const MeasuredMargins& m : MeasureMargins(model, light)) {
    double up = 1e9;
    for (const ComputedMargins& c : computed)
      if (c.stage == m.stage) up = std::min(up, c.adapting.gain_up_db);
    EXPECT_NEAR(m.gain_up_db, up, 0.5) << "stage " << m.stage + 1;
  }
}

TEST(MeasureMargins, AgreeWithTheComputedOnesOfAFilteredPid) {
  FlightDefinition definition = HotStaged();
  // Not roll, which nothing excites.
  for (AxisConfig* axis : {&definition.autopilot.pitch, &definition.autopilot.yaw}) {
    axis->law = ControlLaw::kPid;
    axis->filters = {{.poles_rad_s = 90.0, .poles_damping = 0.7}};
  }
  ExpectMeasuredAsComputed(definition);
}

TEST(MeasureMargins, AgreeWithTheComputedOnesOfAScheduledPid) {
  FlightDefinition definition = HotStaged();
  for (AxisConfig* axis : {&definition.autopilot.pitch, &definition.autopilot.yaw}) {
    axis->law = ControlLaw::kPid;
    axis->filters = {{.poles_rad_s = 90.0, .poles_damping = 0.7}};
    // For half of stage 1 with twice the rate gain, which the stage's own do not know of.
    const FilterSection wider = {.poles_rad_s = 120.0, .poles_damping = 0.7};
    axis->schedule = {{1, 10.0, {20.0, 10.0}, 8.0, {wider}}, {1, 30.0, {20.0, 10.0}, 8.0, {wider}}};
  }
  ExpectMeasuredAsComputed(definition);
  // And the schedule decides them.
  FlightDefinition held = definition;
  held.autopilot.pitch.schedule.clear();
  held.autopilot.yaw.schedule.clear();
  EXPECT_GT(MeasureMargins(FlightModel(held))[0].gain_up_db,
            MeasureMargins(FlightModel(definition))[0].gain_up_db + 1.0);
}

TEST(LoopInputs, ChangeTheLoopOfTheirStageAlone) {
  const FlightModel model(HotStaged());
  FlightInputs inputs;
  for (StageInputs& stage : inputs.stages) stage.thrust.misalignment_rad.magnitude = 0.1 * kRadPerDeg;
  const FlightResult plain = Fly(model, inputs);
  inputs.loop_gain_factor = 0.7;
  inputs.loop_delay_s = 0.013;
  inputs.loop_stage = 2;
  const FlightResult second = Fly(model, inputs);
  EXPECT_EQ(Metric(second, "pitch_error_rms_stage1_deg"), Metric(plain, "pitch_error_rms_stage1_deg"));
  EXPECT_NE(Metric(second, "pitch_error_rms_stage2_deg"), Metric(plain, "pitch_error_rms_stage2_deg"));
  inputs.loop_stage = 1;
  EXPECT_NE(Metric(Fly(model, inputs), "pitch_error_rms_stage1_deg"),
            Metric(plain, "pitch_error_rms_stage1_deg"));
}

TEST(LoopInputs, ADelayActsWithinATick) {
  // The first transient of a misalignment towards yaw, which flies PD, grows with the delay, whole ticks or
  // not.
  const FlightModel model(HotStaged());
  FlightInputs inputs;
  for (StageInputs& stage : inputs.stages) stage.thrust.misalignment_rad.magnitude = 0.25 * kRadPerDeg;
  double last = 0.0;
  for (const double delay_s : {0.0, 0.004, 0.008, 0.010, 0.013, 0.020, 0.024}) {
    inputs.loop_delay_s = delay_s;
    const double peak = Metric(Fly(model, inputs), "yaw_error_peak_deg");
    EXPECT_GT(peak, last) << delay_s;
    last = peak;
  }
}

TEST(PassesGates, AsksForEveryMargin) {
  const LoopMargins good = {true, 6.0, 6.0, 30.0, 0.020, 5.0};
  EXPECT_TRUE(PassesGates(good));
  LoopMargins m = good;
  m.stable = false;
  EXPECT_FALSE(PassesGates(m));
  m = good;
  m.gain_up_db = 5.9;
  EXPECT_FALSE(PassesGates(m));
  m = good;
  m.gain_down_db = 5.9;
  EXPECT_FALSE(PassesGates(m));
  m = good;
  m.phase_deg = 29.9;
  EXPECT_FALSE(PassesGates(m));
  m = good;
  m.delay_s = 0.0199;
  EXPECT_FALSE(PassesGates(m));
  EXPECT_TRUE(PassesGates(MeasuredMargins{0, 6.0, 6.0, 0.020}));
  EXPECT_FALSE(PassesGates(MeasuredMargins{0, 5.9, 6.0, 0.020}));
  EXPECT_FALSE(PassesGates(MeasuredMargins{0, 6.0, 5.9, 0.020}));
  EXPECT_FALSE(PassesGates(MeasuredMargins{0, 6.0, 6.0, 0.019}));
}

}  // namespace
}  // namespace dispersa::margins_flight_test
