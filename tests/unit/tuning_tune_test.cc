// The procedure that tunes every control law: the gates it keeps, the requests it refuses, and its dependence
// on its arguments alone.
#include "core/tuning/tune.h"

#include "core/campaign_yaml/load.h"
#include "core/cases/campaign_flights.h"
#include "core/flight/flight_model.h"
#include "core/input/input_error.h"
#include "core/margins/flight_margins.h"
#include "core/tuning/regulator.h"
#include "core/tuning/stage_design.h"
#include "core/tuning/tuned_plant.h"
#include "tests/test.h"
#include "tests/unit/flexible_sample.h"

namespace dispersa::tuning_tune_test {
namespace {

// The sample vehicle with its second stage taking over at once, since nothing holds its attitude in a coast
// through the air, slender enough for slow designs too, under a misaligned thrust.
Campaign SampleCampaign() {
  const FlightDefinition definition = SampleDefinition();
  Campaign campaign;
  campaign.name = "sample";
  campaign.vehicle = definition.vehicle;
  campaign.vehicle.stages[0].separation_delay_s = 0.0;
  for (AeroTable& table : campaign.vehicle.aerodynamics) table.cn = {0.0, 0.3, 0.0, 0.3};
  campaign.autopilot = definition.autopilot;
  campaign.autopilot.pitch.adaptation.spread_1_s = 60.0;
  campaign.reference.attitude = definition.program;
  campaign.reference.last_ignition_s = 0.0;
  campaign.sampling = {SamplingMethod::kMonteCarlo, 100, 77};
  Dispersion misalignment;
  misalignment.name = "thrust_misalignment";
  misalignment.distribution.kind = Distribution::kNormal;
  misalignment.distribution.sigma = 0.1 * kRadPerDeg;
  misalignment.absolute = true;
  misalignment.inputs = {FindInput("thrust_misalignment_stage1_deg"),
                         FindInput("thrust_misalignment_stage2_deg")};
  campaign.dispersions = {misalignment};
  return campaign;
}

// Two stages, two generations of 8 after the first.
TuningOptions Small() { return {.seed = 3, .cases = 1, .evaluations = 40, .threads = 1}; }

AutopilotConfig AllPd() {
  AutopilotConfig autopilot = SampleAutopilot();
  autopilot.pitch.law = ControlLaw::kPd;
  return autopilot;
}

std::string ErrorOf(const Campaign& campaign, const AutopilotConfig& autopilot,
                    const TuningOptions& options) {
  try {
    Tune(campaign, autopilot, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ApplyDesign, TurnsRatiosIntoRoundedGains) {
  AutopilotConfig autopilot = SampleAutopilot();
  const AutopilotConfig before = autopilot;
  // kp = 5² and kd = 2 * 0.7 * 5. p12 = q11 / (2 kp) = 0.02; gamma = 0.1 * 5³ * 25 / 0.02.
  ApplyDesign({5.0, 0.7, 0.1, {}}, 1, autopilot);
  for (const AxisConfig* axis : {&autopilot.pitch, &autopilot.yaw, &autopilot.roll}) {
    EXPECT_EQ(axis->gains[1].kp_1_s2, 25.0);
    EXPECT_EQ(axis->gains[1].kd_1_s, 7.0);
    EXPECT_EQ(axis->gains[0].kp_1_s2, before.pitch.gains[0].kp_1_s2);
  }
  EXPECT_EQ(autopilot.pitch.adaptation.gamma[1], 15600.0) << "15,625 to three digits";
  EXPECT_EQ(autopilot.pitch.adaptation.gamma[0], before.pitch.adaptation.gamma[0]);
  EXPECT_EQ(autopilot.yaw.adaptation.gamma[1], before.yaw.adaptation.gamma[1]) << "yaw does not adapt";
  ApplyDesign({3.085, 0.7, 0.1, {}}, 0, autopilot);
  EXPECT_EQ(autopilot.pitch.gains[0].kp_1_s2, 9.52) << "3.085² = 9.517";
}

TEST(Learns, IsTrueWhereAnAxisAdapts) {
  EXPECT_TRUE(Learns(SampleAutopilot()));
  EXPECT_FALSE(Learns(AllPd()));
}

TEST(Tune, HoldsEveryGateWithItsReserveAtEveryInstant) {
  const Campaign campaign = SampleCampaign();
  const TuningResult result = Tune(campaign, campaign.autopilot, Small());
  ASSERT_TRUE(result.feasible);
  Campaign tuned = campaign;
  tuned.autopilot = result.autopilot;
  for (const ComputedMargins& m : ComputeMargins(CampaignFlights(tuned).model())) {
    for (const LoopMargins& margins : {m.frozen, m.adapting}) {
      // The search linearises about the flight of its start design; this one differs by a little in attitude.
      EXPECT_GE(margins.gain_up_db, kGainMarginGate_db + 0.95 * kGainReserve_db) << m.time_s;
      EXPECT_GE(margins.gain_down_db, kGainMarginGate_db + 0.95 * kGainReserve_db) << m.time_s;
      EXPECT_GE(margins.phase_deg, kPhaseMarginGate_deg + 0.95 * kPhaseReserve_deg) << m.time_s;
      EXPECT_GE(margins.delay_s, kDelayMarginGate_s + 0.95 * kDelayReserve_s) << m.time_s;
    }
  }
}

TEST(ApplyDesign, GivesAScheduledStageADesignAtEachOfPitchsTimes) {
  AutopilotConfig autopilot = SampleAutopilot();
  autopilot.pitch.schedule = {{1, 10.0, {1.0, 1.0}, 0.0, {}}, {2, 5.0, {3.0, 3.0}, 0.0, {}}};
  autopilot.yaw.schedule = {{1, 99.0, {1.0, 1.0}, 0.0, {}}};
  EXPECT_EQ(ScheduledTimes(autopilot, 0), (std::vector<double>{0.0, 10.0}));
  StageDesign first{4.0, 0.5, 0.1, {}}, then{5.0, 0.7, 0.1, {}};
  first.filters = then.filters = {60.0, 0.5, 20.0, 0.1, 0.6, 1.0};
  then.filters.low_pass_rad_s = 80.0;
  ApplyDesign(std::vector<StageDesign>{first, then}, 0, autopilot);
  for (const AxisConfig* axis : {&autopilot.pitch, &autopilot.yaw, &autopilot.roll}) {
    EXPECT_EQ(axis->gains[0].kp_1_s2, 16.0);
    ASSERT_FALSE(axis->schedule.empty());
    EXPECT_EQ(axis->schedule[0].at_s, 10.0);
    EXPECT_EQ(axis->schedule[0].gains.kp_1_s2, 25.0);
    EXPECT_EQ(axis->schedule[0].gains.kd_1_s, 7.0);
    if (axis == &autopilot.roll) continue;
    ASSERT_EQ(axis->schedule[0].filters.size(), 2u);
    EXPECT_EQ(axis->filters[0].poles_rad_s, 60.0);
    EXPECT_EQ(axis->schedule[0].filters[0].poles_rad_s, 80.0);
  }
  ASSERT_EQ(autopilot.pitch.schedule.size(), 2u);
  EXPECT_EQ(autopilot.pitch.schedule[1].gains.kp_1_s2, 3.0) << "another stage's stays";
  EXPECT_EQ(autopilot.yaw.schedule.size(), 1u);
  EXPECT_EQ(Problems(autopilot, 2).size(), 0u);
}

// SampleCampaign that bends, with boosters at the end of the first stage until 15.5 s after lift-off.
Campaign BoostedCampaign() {
  Campaign campaign = SampleCampaign();
  Vehicle& vehicle = campaign.vehicle;
  vehicle.profile = {{ProfileShape::kTangentOgive, 2.0, 1.0}, {ProfileShape::kCylinder, 18.0, 1.0}};
  vehicle.structure_beam = FlexibleSample().structure_beam;
  vehicle.structure_beam->flown_modes = vehicle.structure_beam->modes = 1;
  vehicle.structure_beam->elements = 10;
  vehicle.structure_beam->propellant_levels = 3;
  vehicle.stages[0].motor.burning_time_s = 25.0;  // so that the test is short
  vehicle.stages[1].motor.burning_time_s = 5.0;
  Boosters& b = vehicle.boosters;
  b = {4, 100.0, 300.0, 0.9, 0.5, 14.5, 18.5, 18.6, {}, {15.0, 18.0, 0.48, 0.2}, 0.5};
  b.motor.thrust_n = 40e3;
  b.motor.burning_time_s = 15.0;
  b.attachment_station_m = 18.0;
  vehicle.stages[0].liftoff_mass_kg += b.LiftOffMass();
  EXPECT_TRUE(Problems(vehicle).empty());
  campaign.autopilot = AllPd();
  campaign.autopilot.pitch.schedule = {{1, 20.0, {1.0, 1.0}, 0.0, {}}};
  return campaign;
}

// Designs suit the stack that flies: margins hold with the boosters and without them, and filters follow the
// first mode of each.
TEST(Tune, KnowsWhenBoostersHaveLeftAVehicleThatBends) {
  const Campaign campaign = BoostedCampaign();
  const CampaignFlights flights(campaign);
  const FlightModel& model = flights.model();
  const LauncherStack& stack = model.nominal_plant().stacks[0];
  const auto first_mode = [&](unsigned gone, double at_s) {
    return stack.BendingWithout(gone)->At(0, 0, ModeTable::kFrequency, stack.burn.Propellant(at_s));
  };
  const TunedPlant plant{campaign, model};
  EXPECT_EQ(plant.FirstMode(0, 0.0), first_mode(0, 0.0));
  EXPECT_EQ(plant.FirstMode(0, 20.0), first_mode(kBoostersGone, 20.0));
  EXPECT_NE(first_mode(kBoostersGone, 20.0), first_mode(0, 20.0));
  EXPECT_GT(first_mode(kBoostersGone, 20.0), 1.05 * first_mode(0, 0.0));

  TuningOptions options = Small();
  options.evaluations = 4 * kTuningPopulation;
  const TuningResult result = Tune(campaign, campaign.autopilot, options);
  ASSERT_TRUE(result.feasible);
  Campaign tuned = campaign;
  tuned.autopilot = result.autopilot;
  int with = 0, without = 0;
  for (const ComputedMargins& m : ComputeMargins(CampaignFlights(tuned).model())) {
    EXPECT_TRUE(PassesGates(m.frozen)) << m.time_s;
    ++(m.time_s < 15.0 ? with : without);
  }
  EXPECT_GT(with, 1);
  EXPECT_GT(without, 1);
  const AxisConfig& pitch = result.autopilot.pitch;
  ASSERT_EQ(pitch.schedule.size(), 1u);
  // Of numbers to three digits.
  EXPECT_NEAR(pitch.schedule[0].filters[0].poles_rad_s / pitch.filters[0].poles_rad_s,
              first_mode(kBoostersGone, 20.0) / first_mode(0, 0.0), 0.02);
}

TEST(Tune, HoldsDispersedPlantsWithAScheduledStage) {
  const Campaign campaign = SampleCampaign();
  AutopilotConfig scheduled = campaign.autopilot;
  scheduled.pitch.schedule = {{1, 20.0, {1.0, 1.0}, 0.0, {}}};
  TuningOptions options = Small();
  options.dispersed = 2;
  options.evaluations = 2 * 2 * kHeldPopulation;
  const TuningResult result = Tune(campaign, scheduled, options);
  ASSERT_TRUE(result.feasible);
  Campaign tuned = campaign;
  tuned.autopilot = result.autopilot;
  ASSERT_EQ(tuned.autopilot.yaw.schedule.size(), 1u);
  for (const StageTuning& stage : result.stages) EXPECT_GE(stage.surplus.value_or(-1.0), 0.0);
  for (const ComputedMargins& m : ComputeMargins(CampaignFlights(tuned).model()))
    EXPECT_TRUE(PassesGates(m.frozen) && PassesGates(m.adapting)) << m.time_s;
  options.threads = 3;
  const TuningResult again = Tune(campaign, result.autopilot, options);
  EXPECT_EQ(WriteAutopilot(again.autopilot), WriteAutopilot(result.autopilot))
      << "threads, and gains as found";
}

TEST(Tune, IsTheSameForAnyNumberOfThreads) {
  const Campaign campaign = SampleCampaign();
  std::vector<GenerationRecord> logs[2];
  TuningOptions options = Small();
  TuningResult results[2];
  for (const std::size_t i : {0u, 1u}) {
    options.threads = i == 0 ? 1 : 3;
    results[i] = Tune(campaign, campaign.autopilot, options,
                      [&](const TuningRecord& record) { logs[i].push_back(record.generation); });
  }
  EXPECT_EQ(WriteAutopilot(results[0].autopilot), WriteAutopilot(results[1].autopilot));
  EXPECT_EQ(logs[0], logs[1]);
  EXPECT_EQ(logs[0].size(), TuningGenerations(campaign, campaign.autopilot, options));
  EXPECT_EQ(results[0].flights, results[1].flights);
  EXPECT_EQ(results[0].median_rms_deg, results[1].median_rms_deg);
}

TEST(Tune, DoesNotDependOnTheGainsThatItReplaces) {
  const Campaign campaign = SampleCampaign();
  const TuningResult once = Tune(campaign, campaign.autopilot, Small());
  EXPECT_NE(WriteAutopilot(once.autopilot), WriteAutopilot(campaign.autopilot));
  const TuningResult again = Tune(campaign, once.autopilot, Small());
  EXPECT_EQ(WriteAutopilot(again.autopilot), WriteAutopilot(once.autopilot));
}

TEST(Tune, DependsOnItsSeed) {
  const Campaign campaign = SampleCampaign();
  TuningOptions other = Small();
  other.seed = 4;
  EXPECT_NE(WriteAutopilot(Tune(campaign, campaign.autopilot, Small()).autopilot),
            WriteAutopilot(Tune(campaign, campaign.autopilot, other).autopilot));
}

// Guidance's turns are commands: no gains take their deflections away. A rigid vehicle needs few designs.
TEST(Tune, FliesTheReferenceWithoutGuidance) {
  Campaign guided = LoadCampaign(DISPERSA_CAMPAIGNS "/gallery/electron/campaign.yaml");
  guided.vehicle.structure_beam.reset();
  for (AxisConfig* axis : {&guided.autopilot.pitch, &guided.autopilot.yaw}) axis->filters.clear();
  ASSERT_TRUE(guided.guidance.closed_loop);
  Campaign open_loop = guided;
  open_loop.guidance = {};
  TuningOptions few = Small();
  few.evaluations = 32;
  const TuningResult results[] = {Tune(guided, guided.autopilot, few),
                                  Tune(open_loop, guided.autopilot, few)};
  ASSERT_TRUE(results[0].stages[1].feasible);
  EXPECT_EQ(WriteAutopilot(results[0].autopilot), WriteAutopilot(results[1].autopilot));
  EXPECT_EQ(results[0].stages[1].mean_rms_deg, results[1].stages[1].mean_rms_deg);
}

TEST(Tune, DoesNotSeeTheVerdictsCases) {
  const Campaign campaign = SampleCampaign();
  Campaign other = campaign;
  other.sampling.seed = 78;
  EXPECT_EQ(Tune(campaign, campaign.autopilot, Small()).median_rms_deg,
            Tune(other, campaign.autopilot, Small()).median_rms_deg);
}

TEST(Tune, ImprovesOnItsStart) {
  const Campaign campaign = SampleCampaign();
  AutopilotConfig start = campaign.autopilot;
  for (int stage = 0; stage < 2; ++stage)
    ApplyDesign({kStartBandwidthOfActuator * 25.0, kStartDamping, kStartLearning, {}}, stage, start);
  TuningOptions options = Small();
  const TuningResult result = Tune(campaign, campaign.autopilot, options);
  // The mean of the same cases under the start design.
  Campaign untuned = campaign;
  untuned.autopilot = start;
  untuned.sampling.seed = options.seed;
  const CampaignFlights flights(untuned);
  double sum_deg = 0.0;
  for (int i = 0; i < options.cases; ++i)
    sum_deg += flights.FlyCase(static_cast<std::uint64_t>(i)).metrics[0];
  EXPECT_LT(result.median_rms_deg, 0.8 * sum_deg / options.cases);
}

TEST(Tune, SpendsTheSameBudgetOnEveryLaw) {
  const Campaign campaign = SampleCampaign();
  const TuningResult adaptive = Tune(campaign, campaign.autopilot, Small());
  const TuningResult pd = Tune(campaign, AllPd(), Small());
  EXPECT_EQ(adaptive.evaluations, pd.evaluations);
  EXPECT_EQ(adaptive.evaluations, 40u);
  EXPECT_EQ(pd.stages[0].design.learning, 0.0);
  EXPECT_EQ(pd.stages[0].frozen.gain_db, pd.stages[0].adapting.gain_db);
}

TEST(SolveRegulator, SolvesTheRiccatiEquation) {
  for (const RegulatorWeights q :
       {RegulatorWeights{1.0, 1.0, 1.0}, {1e-4, 1.0, 1e-2}, {1e3, 1.0, 1e2}, {1e-4, 1.0, 1e2}}) {
    const RegulatorGains k = SolveRegulator(q);
    // Spectral factor of the chain of integrators: |s³ + kd s² + kp s + ki|² on the imaginary axis is
    // w⁶ + q_rate w⁴ + q_angle w² + q_integral, and the loop is stable.
    const RegulatorWeights back = WeightsOf(k);
    EXPECT_NEAR(back.integral_1_s6, q.integral_1_s6, 1e-10 * q.integral_1_s6);
    EXPECT_NEAR(back.angle_1_s4, 1.0, 1e-8 * (1.0 + k.ki_1_s3 * k.kd_1_s));
    EXPECT_NEAR(back.rate_1_s2, q.rate_1_s2, 1e-8 * (1.0 + k.kp_1_s2));
    EXPECT_GT(k.ki_1_s3, 0.0);
    EXPECT_GT(k.kd_1_s * k.kp_1_s2, k.ki_1_s3) << "Hurwitz";
  }
}

TEST(Tune, FindsARegulatorWithinTheSameBudget) {
  const Campaign campaign = SampleCampaign();
  AutopilotConfig pid = AllPd();
  pid.pitch.law = pid.yaw.law = ControlLaw::kPid;
  TuningOptions options = Small();
  options.regulator = true;
  const TuningResult found = Tune(campaign, pid, options);
  ASSERT_TRUE(found.feasible);
  EXPECT_EQ(found.evaluations, 40u);
  for (std::size_t i = 0; i < 2; ++i) {
    const AxisConfig& axis = found.autopilot.pitch;
    const RegulatorWeights q =
        WeightsOf({axis.integral.ki_1_s3[i], axis.gains[i].kp_1_s2, axis.gains[i].kd_1_s});
    // Of the flown gains, which have three digits.
    EXPECT_GT(q.integral_1_s6, 0.0);
    EXPECT_GT(q.angle_1_s4, -0.02 * axis.gains[i].kp_1_s2 * axis.gains[i].kp_1_s2);
    EXPECT_GT(q.rate_1_s2, 0.0);
  }
  EXPECT_EQ(ErrorOf(campaign, AllPd(), options),
            "pitch.law: pd has no integral, which is a state of the regulator, allowed: pid, pid_aac\n"
            "yaw.law: pd has no integral, which is a state of the regulator, allowed: pid, pid_aac");
}

TEST(Tune, SearchesWhatAugmentsPdLastWithinTheSameBudget) {
  const Campaign campaign = SampleCampaign();
  AutopilotConfig augmented = AllPd();
  augmented.pitch.law = ControlLaw::kPdAac;
  augmented.pitch.augmentation = {1.0, 0.1, 1.0, 15.0, 2.0, 0.5, 1.0};
  TuningOptions options = Small();
  options.evaluations = 48;  // 14 for each of three searches: 8 and one generation of 6
  int last = 0;
  const TuningResult result =
      Tune(campaign, augmented, options, [&](const TuningRecord& r) { last = r.stage; });
  ASSERT_TRUE(result.feasible);
  ASSERT_TRUE(result.augmentation.has_value());
  EXPECT_EQ(last, 2);
  EXPECT_EQ(result.evaluations, 42u);
  const AdaptiveAugmentation& found = result.autopilot.pitch.augmentation;
  EXPECT_EQ(found.adaptive_gain_1_s,
            RoundToDigits(result.augmentation->design.adaptive_gain_1_s, kDesignDigits));
  EXPECT_EQ(found.maximum_total_gain,
            RoundToDigits(result.augmentation->design.maximum_total_gain, kDesignDigits));
  EXPECT_EQ(found.leakage_1_s, 0.1) << "not searched";
  Campaign tuned = campaign;
  tuned.autopilot = result.autopilot;
  for (const MeasuredMargins& m : MeasureMargins(CampaignFlights(tuned).model())) EXPECT_TRUE(PassesGates(m));
  // No worse than where it began.
  AutopilotConfig start = result.autopilot;
  ApplyDesign(kStartAugmentation, start);
  tuned.autopilot = start;
  tuned.sampling.seed = options.seed;
  EXPECT_LE(result.median_rms_deg, CampaignFlights(tuned).FlyCase(0).metrics[0] + kObjectiveTolerance_deg);
  options.evaluations = 47;
  EXPECT_EQ(ErrorOf(campaign, augmented, options),
            "evaluations: 47 is out of range, allowed: 48 (two generations of 8 for each stage and the "
            "augmentation) to 1000000");
}

// Motors that take 0.5 s to their thrust and tail off over some seconds.
Campaign CurvedCampaign() {
  Campaign campaign = SampleCampaign();
  SetThrustCurve({{0.0, 0.5, 20.0, 38.0, 41.0, 44.0}, {0.0, 190e3, 220e3, 180e3, 30e3, 0.0}},
                 campaign.vehicle.stages[0].motor);
  SetThrustCurve({{0.0, 0.5, 10.0, 18.5, 20.0, 22.0}, {0.0, 52e3, 55e3, 48e3, 8e3, 0.0}},
                 campaign.vehicle.stages[1].motor);
  return campaign;
}

TEST(Tune, AsksForNoMarginsWhereThereIsHardlyThrust) {
  const Campaign campaign = CurvedCampaign();
  const TuningResult result = Tune(campaign, campaign.autopilot, Small());
  ASSERT_TRUE(result.feasible) << result.stages[0].missed << "; " << result.stages[1].missed;
  // Lift-off and burnout, what is between these of the tail-off, and the other stage's burnout.
  std::vector<std::string> places;
  for (const SkippedInstant& at : result.skipped) {
    places.push_back(at.place);
    EXPECT_LT(at.thrust_fraction, kLeastThrustFraction) << at.place;
  }
  EXPECT_THAT(places, testing::IsSupersetOf({"lift-off", "stage 1 burnout", "stage 2 burnout"}));
  for (const StageTuning& stage : result.stages) EXPECT_EQ(stage.missed, "");
  Campaign tuned = campaign;
  tuned.autopilot = result.autopilot;
  for (const ComputedMargins& m : ComputeMargins(CampaignFlights(tuned).model()))
    EXPECT_TRUE(PassesGates(m.frozen) && PassesGates(m.adapting)) << m.place << " " << m.time_s;
}

TEST(Tune, NamesTheGateThatItMissesByMost) {
  Campaign campaign = CurvedCampaign();
  for (Stage& stage : campaign.vehicle.stages) stage.gimbal.delay_ticks = 30;  // 0.3 s
  TuningResult result = Tune(campaign, campaign.autopilot, Small());
  ASSERT_FALSE(result.feasible);
  EXPECT_THAT(result.stages[0].missed,
              testing::MatchesRegex("(gain|phase|delay) margin -?[0-9.]+ (dB|deg|ms), [0-9.]+ are needed: "
                                    "(gains held|adapting), (roll|pitch|yaw) at [0-9.]+ s( \\(.*\\))?, "
                                    "[0-9]+ % of full thrust"));
  const auto misses = [](const LeastMargins& m) {
    return m.gain_db < kGainMarginGate_db + kGainReserve_db ||
           m.phase_deg < kPhaseMarginGate_deg + kPhaseReserve_deg ||
           m.delay_s < kDelayMarginGate_s + kDelayReserve_s;
  };
  EXPECT_TRUE(misses(result.stages[0].frozen) || misses(result.stages[0].adapting));
  TuningOptions options = Small();
  options.dispersed = 2;
  options.evaluations = 2 * 2 * kHeldPopulation;
  result = Tune(campaign, campaign.autopilot, options);
  ASSERT_FALSE(result.feasible);
  EXPECT_THAT(result.stages[0].missed,
              testing::MatchesRegex(
                  "(the loop is unstable|(gain|phase|delay) margin [0-9]+ % below its gate with "
                  "reserve): (nominal plant|plant of draw [01])(, all 15 % (lower|higher))?, (gains "
                  "held|adapting), (roll|pitch|yaw) [0-9.]+ s after ignition"));
}

TEST(Tune, NamesFlightsThatAreLost) {
  Campaign campaign = SampleCampaign();
  // Far more misalignment than the nozzles can turn against: margins are what they were.
  campaign.dispersions[0].distribution.sigma = 40.0 * kRadPerDeg;
  TuningOptions options = Small();
  options.cases = 4;
  const TuningResult result = Tune(campaign, campaign.autopilot, options);
  ASSERT_FALSE(result.feasible);
  EXPECT_THAT(result.stages[0].missed, testing::MatchesRegex("[1-4] of 4 flights are lost"));
}

TEST(Tune, DoesNotFlyADesignThatMissesAMargin) {
  Campaign campaign = SampleCampaign();
  // An actuator that rings a hundredfold: the slowest, least damped design of the box still crosses -1 there.
  for (Stage& stage : campaign.vehicle.stages) stage.gimbal.damping_ratio = 0.005;
  const TuningResult hopeless = Tune(campaign, campaign.autopilot, Small());
  EXPECT_FALSE(hopeless.feasible);
  EXPECT_EQ(hopeless.flights, 0u);
}

TEST(Tune, RefusesTheCampaignsSeedAndWhatIsOutOfRange) {
  const Campaign campaign = SampleCampaign();
  TuningOptions options = Small();
  options.seed = 77;
  EXPECT_EQ(
      ErrorOf(campaign, campaign.autopilot, options),
      "seed: the tuning would fly the cases of campaign 'sample', allowed: any but the campaign's own, 77");
  options = Small();
  options.cases = 0;
  options.evaluations = 31;
  EXPECT_EQ(ErrorOf(campaign, campaign.autopilot, options),
            "cases: 0 is out of range, allowed: 1 to 10000\n"
            "evaluations: 31 is out of range, allowed: 32 (two generations of 8 for each stage) to 1000000");
}

TEST(Tune, RefusesAnAutopilotThatDoesNotSuit) {
  const Campaign campaign = SampleCampaign();
  AutopilotConfig fixed = campaign.autopilot;
  fixed.pitch.adaptation.p_n = Vector2(0.01, 0.01);
  fixed.pitch.adaptation.allow_unproven = true;
  EXPECT_EQ(ErrorOf(campaign, fixed, Small()),
            "adaptation.p_n: is fixed, but P_n follows from the gains that are to be found, allowed: no p_n");
  AutopilotConfig short_one = AllPd();
  short_one.yaw.gains.pop_back();
  EXPECT_EQ(ErrorOf(campaign, short_one, Small()),
            "yaw.gains: has 1 entries, allowed: one entry for each of the vehicle's 2 stages");
}

}  // namespace
}  // namespace dispersa::tuning_tune_test
