// The gates for margins, and the least margins over several plants, laws and instants, each from its loops.
#include "core/flight/flight.h"
#include "core/margins/flight_margins.h"
#include "core/margins/linear_axis.h"
#include "core/math/constants.h"
#include "tests/test.h"
#include "tests/unit/flexible_sample.h"

namespace dispersa::margins_rules_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// ---- Gates ----

LoopMargins Good() {
  LoopMargins m;
  m.stable = true;
  m.gain_up_db = 6.0;
  m.gain_down_db = 7.0;
  m.phase_deg = 40.0;
  m.delay_s = 0.025;
  m.bending_phase_6db_deg = 45.0;
  m.bending_phase_3db_deg = 50.0;
  return m;
}
LoopMargins With(double LoopMargins::*margin, double value) {
  LoopMargins m = Good();
  m.*margin = value;
  return m;
}
LoopMargins Unstable() {
  LoopMargins m = Good();
  m.stable = false;
  return m;
}

TEST(LeastMargins, TakeEachMarginAndTheBendingsPhase) {
  LeastMargins least;
  least.Take(Good());
  EXPECT_EQ(least.gain_db, 6.0);
  EXPECT_EQ(least.phase_deg, 40.0);
  EXPECT_EQ(least.delay_s, 0.025);
  least.Take(With(&LoopMargins::gain_down_db, 4.0));
  EXPECT_EQ(least.gain_db, 4.0);
  least.Take(With(&LoopMargins::gain_up_db, 3.0));
  EXPECT_EQ(least.gain_db, 3.0);
  least.Take(With(&LoopMargins::bending_phase_6db_deg, 35.0));
  EXPECT_EQ(least.phase_deg, 35.0);
  least.Take(With(&LoopMargins::phase_deg, 31.0));
  EXPECT_EQ(least.phase_deg, 31.0);
  least.Take(With(&LoopMargins::bending_phase_3db_deg, 1.0));
  EXPECT_EQ(least.phase_deg, 31.0) << "what a dispersed flight must have";
  least.Take(With(&LoopMargins::delay_s, 0.021));
  least.Take(With(&LoopMargins::delay_s, 0.022));
  EXPECT_EQ(least.delay_s, 0.021);
}

TEST(PassesGates, OfANominalFlightAskForEachMarginOfItsOwn) {
  using M = LoopMargins;
  EXPECT_TRUE(PassesGates(Good()));
  EXPECT_FALSE(PassesGates(Unstable()));
  EXPECT_TRUE(PassesGates(With(&M::bending_phase_6db_deg, 30.0)));
  EXPECT_FALSE(PassesGates(With(&M::bending_phase_6db_deg, 29.9)));
  EXPECT_TRUE(PassesGates(With(&M::bending_phase_3db_deg, 1.0)));
}

TEST(PassesGates, OfADispersedFlightAskForHalfTheGainAndTheBendingWithin3Decibels) {
  using M = LoopMargins;
  EXPECT_TRUE(PassesDispersedGates(Good()));
  EXPECT_FALSE(PassesDispersedGates(Unstable()));
  EXPECT_TRUE(PassesDispersedGates(With(&M::delay_s, 0.0)));
  EXPECT_TRUE(PassesDispersedGates(With(&M::bending_phase_6db_deg, 1.0)));
  const std::pair<double M::*, double> gates[] = {{&M::gain_up_db, 3.0},
                                                  {&M::gain_down_db, 3.0},
                                                  {&M::phase_deg, 20.0},
                                                  {&M::bending_phase_3db_deg, 20.0}};
  for (const auto& [margin, gate] : gates) {
    EXPECT_TRUE(PassesDispersedGates(With(margin, gate))) << gate;
    EXPECT_FALSE(PassesDispersedGates(With(margin, gate - 0.1))) << gate;
  }
}

ComputedMargins Instant(const LoopMargins& frozen, const LoopMargins& adapting) {
  ComputedMargins m;
  m.frozen = frozen;
  m.adapting = adapting;
  return m;
}

TEST(PassesGates, OfAnInstantAskFrozenAdaptingAndLearnt) {
  // Between the two sets of gates, and below both.
  const LoopMargins between = With(&LoopMargins::gain_up_db, 4.0),
                    below = With(&LoopMargins::gain_up_db, 2.0);
  EXPECT_TRUE(PassesGates(Instant(Good(), Good())));
  for (const ComputedMargins& m : {Instant(between, Good()), Instant(Good(), between)}) {
    EXPECT_FALSE(PassesGates(m));
    EXPECT_TRUE(PassesDispersedGates(m));
  }
  for (const ComputedMargins& m : {Instant(below, Good()), Instant(Good(), below)})
    EXPECT_FALSE(PassesDispersedGates(m));
  ComputedMargins learnt = Instant(Good(), Good());
  learnt.learnt = between;
  // Rules must keep the nominal margins; an augmentation must leave those of a dispersed flight.
  EXPECT_FALSE(LearntPasses(learnt));
  EXPECT_FALSE(PassesGates(learnt));
  EXPECT_TRUE(PassesDispersedGates(learnt));
  learnt.is_augmented = true;
  EXPECT_TRUE(LearntPasses(learnt));
  EXPECT_TRUE(PassesGates(learnt));
  learnt.learnt = below;
  EXPECT_FALSE(LearntPasses(learnt));
  EXPECT_FALSE(PassesGates(learnt));
  EXPECT_FALSE(PassesDispersedGates(learnt));
}

// ---- The least of several loops ----

void ExpectSame(const LoopMargins& found, const LoopMargins& expected) {
  EXPECT_EQ(found.stable, expected.stable);
  EXPECT_EQ(found.gain_up_db, expected.gain_up_db);
  EXPECT_EQ(found.gain_down_db, expected.gain_down_db);
  EXPECT_EQ(found.phase_deg, expected.phase_deg);
  EXPECT_EQ(found.delay_s, expected.delay_s);
  EXPECT_EQ(found.crossover_rad_s, expected.crossover_rad_s);
  EXPECT_EQ(found.bending_peak_db, expected.bending_peak_db);
  EXPECT_EQ(found.bending_phase_6db_deg, expected.bending_phase_6db_deg);
  EXPECT_EQ(found.bending_phase_3db_deg, expected.bending_phase_3db_deg);
}

LoopMargins LeastOf(const std::vector<LoopMargins>& all) {
  const auto of = [&](double LoopMargins::*margin, bool largest) {
    double found = all.front().*margin;
    for (const LoopMargins& m : all)
      found = largest ? std::fmax(found, m.*margin) : std::fmin(found, m.*margin);
    return found;
  };
  using M = LoopMargins;
  LoopMargins least;
  least.stable = std::all_of(all.begin(), all.end(), [](const M& m) { return m.stable; });
  for (double M::*margin : {&M::gain_up_db, &M::gain_down_db, &M::phase_deg, &M::delay_s,
                            &M::bending_phase_6db_deg, &M::bending_phase_3db_deg})
    least.*margin = of(margin, false);
  for (double M::*margin : {&M::crossover_rad_s, &M::bending_peak_db}) least.*margin = of(margin, true);
  return least;
}

FlightDefinition HotStaged(Vehicle vehicle) {
  FlightDefinition definition = SampleDefinition();
  definition.vehicle = std::move(vehicle);
  definition.vehicle.stages[0].separation_delay_s = 0.0;
  definition.vehicle.stages[1].gimbal.delay_ticks = 3;
  definition.last_ignition_s = 0.0;
  definition.autopilot.pitch.adaptation.composite = 3.0;
  definition.autopilot.pitch.adaptation.predictor_1_s = 15.0;
  return definition;
}

FlightModel Flexible() {
  FlightDefinition definition = HotStaged(FlexibleSample());
  definition.vehicle.profile = {{ProfileShape::kTangentOgive, 2.0, 1.0},
                                {ProfileShape::kCylinder, 18.0, 1.0}};
  StructureBeam& beam = *definition.vehicle.structure_beam;
  beam.modes = beam.flown_modes = 2;
  beam.propellant_levels = 3;
  beam.elements = 20;
  return FlightModel(definition);
}

TEST(FrequencySets, AreAllModesTogetherAndEachAlone) {
  std::vector<std::string> names;
  std::vector<std::array<double, 2>> factors;
  for (const FrequencySet& set : FrequencySets(2, 0.15)) {
    names.push_back(set.name);
    factors.push_back({set.factor[0], set.factor[1]});
    EXPECT_EQ(set.factor[2], names.back().rfind("all", 0) == 0 ? set.factor[0] : 1.0) << set.name;
  }
  EXPECT_THAT(names,
              testing::ElementsAre("as they are", "all 15 % lower", "all 15 % higher", "mode 1 15 % lower",
                                   "mode 1 15 % higher", "mode 2 15 % lower", "mode 2 15 % higher"));
  using Two = std::array<double, 2>;
  EXPECT_THAT(factors, testing::ElementsAre(Two{1.0, 1.0}, Two{0.85, 0.85}, Two{1.15, 1.15}, Two{0.85, 1.0},
                                            Two{1.15, 1.0}, Two{1.0, 0.85}, Two{1.0, 1.15}));
  EXPECT_EQ(FrequencySets(1, 0.15).size(), 3u);  // alone is together
  EXPECT_EQ(FrequencySets(2, 0.0).size(), 1u);
  EXPECT_EQ(FrequencySets(0, 0.15).size(), 1u);
}

TEST(MarginsAt, OfABodyThatBendsAreTheLeastOfAllSetsOfFrequencies) {
  const FlightModel model = Flexible();
  int different = 0;
  for (const MarginInstant& instant : MarginInstants(model, 10.0)) {
    const auto at = [&](const LauncherPlant& plant, double band) {
      return MarginsAt(plant, model.sensors(), model.autopilot(), instant.sample, kYaw, true,
                       {band, LateralPath::kHeld});
    };
    const auto& bending =
        model.nominal_plant().stacks[static_cast<std::size_t>(instant.sample.stack)].bending;
    std::vector<std::array<double, 2>> factors = {{1.0, 1.0}, {0.8, 0.8}, {1.2, 1.2}};
    if (bending->modes == 2) factors.insert(factors.end(), {{0.8, 1.0}, {1.2, 1.0}, {1.0, 0.8}, {1.0, 1.2}});
    std::vector<LoopMargins> each;
    for (const std::array<double, 2>& factor : factors) {
      LauncherPlant plant = model.nominal_plant();
      for (std::size_t mode = 0; mode < 2; ++mode) plant.bending.frequency_factor[mode] *= factor[mode];
      each.push_back(at(plant, 0.0));
    }
    ExpectSame(at(model.nominal_plant(), 0.2), LeastOf(each));
    for (const LoopMargins& m : each) different += m.bending_peak_db != each[0].bending_peak_db;
  }
  EXPECT_GT(different, 4);
}

// The inputs of Fig. 5 of the paper, and the learnt values, belong to the law that flies. Stage 2 has a
// longer delay.
TEST(ComputeDispersedMargins, AreOfTheDispersedLawOnEverySideOfZeroError) {
  const FlightModel model(HotStaged(SampleVehicle()));
  FlightOrder order;
  FlightInputs& inputs = order.inputs;
  inputs.pn_error_factor = 1.5;
  inputs.pn_rate_factor = 0.7;
  for (StageInputs& stage : inputs.stages) stage.thrust.misalignment_rad.magnitude = 0.25 * kRadPerDeg;
  const LauncherPlant plant = model.PlantFor(inputs);
  const std::vector<MarginInstant> instants = MarginInstants(model, 10.0, inputs);
  const DispersedMargins found = ComputeDispersedMargins(model, order, 10.0);
  int sides = 0;
  for (const MarginInstant& instant : instants) {
    const TickSample& s = instant.sample;
    const auto at = std::find_if(found.margins.begin(), found.margins.end(), [&](const ComputedMargins& m) {
      return m.time_s == s.time_s && m.place == instant.place && m.axis == kPitch;
    });
    ASSERT_NE(at, found.margins.end()) << s.time_s;
    const auto of = [&](LinearLaw law) {
      law.drive_error *= 1.5;
      law.drive_rate *= 0.7;
      law.drive_prediction *= 0.7;
      return SampledLoop(LineariseAxis(plant, s, kPitch, model.sensors()), law, 0.01, s.stack == 0 ? 1 : 3)
          .Margins();
    };
    ExpectSame(at->frozen, of(LineariseLaw(model.autopilot(), s.stack, s.since_ignition_s, kPitch, false)));
    std::vector<LoopMargins> adapting = {
        of(LineariseLaw(model.autopilot(), s.stack, s.since_ignition_s, kPitch, true))};
    ExpectSame(at->adapting, adapting[0]);
    for (const ErrorSide side : {ErrorSide{-1, -1}, ErrorSide{-1, 1}, ErrorSide{1, -1}, ErrorSide{1, 1}})
      adapting.push_back(of(LineariseLearntLaw(model.autopilot(), s, kPitch, side)));
    ASSERT_TRUE(at->learnt);
    ExpectSame(*at->learnt, LeastOf(adapting));
    sides +=
        adapting[1].gain_up_db != adapting[2].gain_up_db && adapting[2].gain_up_db != adapting[4].gain_up_db;
  }
  EXPECT_GT(sides, 3) << "each side has margins of its own";
}

TEST(MarginInstants, MaxQIsTheLargestOfTheFlight) {
  const FlightModel model(HotStaged(SampleVehicle()));
  double largest = 0.0;
  FlightOptions options;
  options.observe = [&](const TickSample& s) {
    if (s.burning) largest = std::fmax(largest, s.instant.air.qbar_pa);
  };
  Fly(model, FlightInputs{}, options);
  int count = 0;
  for (const MarginInstant& instant : MarginInstants(model, 10.0)) {
    if (instant.place != "max q") continue;
    ++count;
    EXPECT_EQ(instant.sample.instant.air.qbar_pa, largest);
  }
  EXPECT_EQ(count, 1);
}

TEST(MarginsAt, OfARollThatThrustersHoldHaveNoLimit) {
  const FlightModel model(HotStaged(SampleVehicle()));
  LauncherPlant plant = model.nominal_plant();
  plant.stacks[0].layout.rolls = false;
  const TickSample s = MarginInstants(model, 10.0).front().sample;
  const LoopMargins m = MarginsAt(plant, model.sensors(), model.autopilot(), s, kRoll, false);
  EXPECT_TRUE(m.stable);
  EXPECT_EQ(m.gain_up_db, kInfinity);
  EXPECT_EQ(m.gain_down_db, kInfinity);
  EXPECT_EQ(m.delay_s, kInfinity);
  EXPECT_EQ(m.phase_deg, 180.0);
  EXPECT_TRUE(PassesGates(m));
}

// Without air a thrust line of stage 1 that lies 0.28 m aside holds a steady error of 5 to 10 degrees in one
// axis: a loop that leaves the rules' range before anything spoils it has no margin to measure.
TEST(MeasureMargins, AreNoneWhereAnErrorLeavesTheRulesRange) {
  FlightDefinition definition = HotStaged(SampleVehicle());
  definition.vehicle.site.altitude_m = 300e3;
  definition.autopilot.yaw.gains = {{2.0, 10.0}, {2.0, 10.0}};
  definition.autopilot.pitch = definition.autopilot.yaw;
  const FlightModel model(definition);
  for (const bool in_yaw : {false, true}) {
    FlightInputs inputs;
    inputs.stages[0].thrust.offset_m.magnitude = 0.28;
    inputs.stages[0].thrust.offset_m.clock_rad = in_yaw ? 0.0 : 0.5 * kPi;
    const FlightResult flown = Fly(model, inputs);
    const auto metric = [&](const char* name) { return flown.metrics[MetricColumn(name)]; };
    ASSERT_EQ(flown.outcome, Outcome::kCompleted);
    ASSERT_LT(metric("deflection_ripple_deg"), 0.2);
    ASSERT_EQ(metric("yaw_error_peak_deg") > 5.0, in_yaw);
    ASSERT_EQ(metric("pitch_error_peak_deg") > 5.0, !in_yaw);
    for (const MeasuredMargins& m : MeasureMargins(model, inputs)) {
      EXPECT_EQ(m.gain_up_db, 0.0);
      EXPECT_EQ(m.gain_down_db, 0.0);
      EXPECT_EQ(m.delay_s, 0.0);
    }
  }
}

}  // namespace
}  // namespace dispersa::margins_rules_test
