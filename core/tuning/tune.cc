#include "core/tuning/tune.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include "core/cases/campaign_flights.h"
#include "core/input/input_error.h"
#include "core/margins/loop_table.h"
#include "core/flight/flight.h"
#include "core/flight/flight_model.h"
#include "core/margins/linear_axis.h"
#include "core/margins/flight_margins.h"
#include "core/flight/metrics.h"
#include "core/math/constants.h"
#include "core/tuning/regulator.h"

namespace dispersa {

namespace {

constexpr int kElites = 2;
// Changes of a tenth of a range at first.
constexpr double kMutationEta = 10.0;
// Changes of a percent at the end: the optimum is flat, and a design is rounded to a thousandth anyhow.
constexpr double kFinalMutationEta = 100.0;

double Metric(const FlightResult& result, const std::string& name) {
  return result.metrics[MetricColumn(name)];
}

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

// Stages, and the augmentation.
int SearchesOf(const Campaign& campaign, const AutopilotConfig& autopilot) {
  return static_cast<int>(campaign.vehicle.stages.size()) + (IsAugmented(autopilot) ? 1 : 0);
}

void Validate(const Campaign& campaign, const AutopilotConfig& autopilot, const TuningOptions& options) {
  const int stages = static_cast<int>(campaign.vehicle.stages.size());
  std::vector<InputProblem> problems;
  const auto add = [&](const std::string& path, const std::string& message, const std::string& allowed) {
    problems.push_back({"", 0, 0, path, message, allowed});
  };
  if (options.seed == campaign.sampling.seed)
    add("seed", "the tuning would see the cases of campaign '" + campaign.name + "'",
        "any but the campaign's own, " + std::to_string(campaign.sampling.seed));
  if (options.cases < 1 || options.cases > 10000)
    add("cases", std::to_string(options.cases) + " is out of range", "1 to 10000");
  const int population = options.dispersed > 0 ? kHeldPopulation : kTuningPopulation;
  const int least = 2 * population * SearchesOf(campaign, autopilot);
  if (options.evaluations < least || options.evaluations > 1000000)
    add("evaluations", std::to_string(options.evaluations) + " is out of range",
        std::to_string(least) + " (two generations of " + std::to_string(population) + " for each " +
            (IsAugmented(autopilot) ? "stage and the augmentation" : "stage") + ") to 1000000");
  if (options.dispersed < 0 || options.dispersed > 1000)
    add("dispersed", std::to_string(options.dispersed) + " is out of range", "0 to 1000");
  for (const AutopilotProblem& problem : Problems(autopilot, stages))
    add(problem.path, problem.message, problem.allowed);
  for (const AxisConfig* axis : {&autopilot.pitch, &autopilot.yaw, &autopilot.roll})
    if (InfoOf(axis->law).adaptation && axis->adaptation.p_n)
      add("adaptation.p_n", "is fixed, but P_n follows from the gains that are to be found", "no p_n");
  if (options.regulator)
    for (const auto& [axis, name] : {std::pair{&autopilot.pitch, "pitch"}, {&autopilot.yaw, "yaw"}})
      if (!InfoOf(axis->law).integral)
        add(std::string(name) + ".law",
            std::string(InfoOf(axis->law).name) + " has no integral, which is a state of the regulator",
            "pid, pid_aac");
  if (!problems.empty()) throw InputError(std::move(problems));
}

bool Suffices(const LeastMargins& m) {
  return m.gain_db >= kGainMarginGate_db + kGainReserve_db &&
         m.phase_deg >= kPhaseMarginGate_deg + kPhaseReserve_deg &&
         m.delay_s >= kDelayMarginGate_s + kDelayReserve_s;
}

bool AllZero(const std::vector<double>& violations) {
  return std::all_of(violations.begin(), violations.end(), [](double v) { return v == 0.0; });
}

// Fractions by which the gates are missed.
void AddViolations(const MeasuredMargins& m, std::vector<double>& violations) {
  const double gain_db = std::min(m.gain_up_db, m.gain_down_db);
  violations.push_back(PassesGates(m) ? 0.0
                                      : std::max({1e-3, 1.0 - gain_db / kGainMarginGate_db,
                                                  1.0 - m.delay_s / kDelayMarginGate_s}));
}

// Fractions by which gates plus reserves are missed.
void AddViolations(const LeastMargins& m, std::vector<double>& violations) {
  const auto below = [&](double value, double limit) {
    violations.push_back(std::max(0.0, (limit - value) / limit));
  };
  below(m.gain_db, kGainMarginGate_db + kGainReserve_db);
  below(m.phase_deg, kPhaseMarginGate_deg + kPhaseReserve_deg);
  below(m.delay_s, kDelayMarginGate_s + kDelayReserve_s);
}

int PopulationOf(const TuningOptions& options) {
  return options.dispersed > 0 ? kHeldPopulation : kTuningPopulation;
}

// Generations of a search after the initial one.
int GenerationsOf(const TuningOptions& options, int searches) {
  const int population = PopulationOf(options);
  return (options.evaluations / searches - population) / (population - kElites);
}

// Steps of the search for the largest bandwidth.
constexpr double kBandwidthStep = 0.98;
constexpr double kHeldBandwidthStep = 0.97;
constexpr double kHopeless = -1.0;
// Of a design of one time: from this surplus on, so many steps, of 5 % at first.
constexpr double kWorthRefining = -0.12;
constexpr int kRefinements = 500;
constexpr double kRefinementStep = 0.05, kRefinementGrowth = 1.5, kRefinementDecay = 0.97;
constexpr double kStiffBandwidthOfActuator = 0.165;

constexpr const char* kGateNames[] = {"gain", "phase", "delay"};
// LoopTable's of a loop that is unstable, or more.
constexpr double kUnstableSurplus = -2.0;

// The campaign as the tuning flies it, and what it has found so far.
class Tuner {
 public:
  Tuner(const Campaign& campaign, const AutopilotConfig& autopilot, const TuningOptions& options)
      : options_(options), campaign_(campaign), learns_(Learns(autopilot)) {
    campaign_.autopilot = autopilot;
    campaign_.sampling = {SamplingMethod::kMonteCarlo, static_cast<std::uint64_t>(options.cases),
                          options.seed};
    // Of the plant alone what stages are like is asked below.
    start_ = std::make_unique<CampaignFlights>(campaign_);
    for (int stage = 0; stage < StageCount(); ++stage) {
      StageDesign cautious;
      cautious.bandwidth_rad_s = kStartBandwidthOfActuator * ActuatorOf(stage);
      cautious.damping = kStartDamping;
      cautious.learning = kStartLearning;
      std::vector<StageDesign> at_times;
      for (const double at_s : TimesOf(stage)) {
        if (FirstMode(stage) > 0.0)
          cautious.filters = FiltersAt({kStartLowPassPower, kStartLowPassDamping, kStartNotchPower,
                                        kStartNotchZerosDamping, kStartNotchPolesDamping, kStartGyroWeight},
                                       stage, at_s);
        at_times.push_back(cautious);
      }
      ApplyDesign(at_times, stage, campaign_.autopilot);
    }
    ApplyDesign(kStartAugmentation, campaign_.autopilot);
    start_ = std::make_unique<CampaignFlights>(campaign_);
    // Of a vehicle that bends the instants are those of its rigid self: untuned, the other may be lost.
    Campaign rigid = campaign_;
    if (rigid.vehicle.structure_beam) rigid.vehicle.structure_beam->flown_modes = 0;
    const CampaignFlights held(rigid);
    instants_ = MarginInstants(held.model());
    skipped_ = SkippedInstants(held.model());
    if (options.dispersed > 0) TabulateHeld(CampaignFlights(Stiff(rigid)));
  }

  TuningResult Run(const TuningObserver& observer) {
    TuningResult result;
    result.feasible = true;
    result.skipped = skipped_;
    for (int stage = 0; stage < StageCount(); ++stage) {
      result.stages.push_back(TuneStage(stage, observer, result.evaluations));
      result.feasible = result.feasible && result.stages.back().feasible;
    }
    if (result.feasible && IsAugmented(campaign_.autopilot)) {
      result.augmentation = TuneAugmentation(observer, result.evaluations);
      result.feasible = result.augmentation->feasible;
    }
    result.flights = flights_;
    result.autopilot = campaign_.autopilot;
    if (!result.feasible) return result;
    std::vector<double> rms_deg;
    for (const FlightResult& flown : FlyCases(ModelWith(campaign_.autopilot))) {
      rms_deg.push_back(Metric(flown, "pitch_error_rms_deg"));
      result.largest_peak_deg = std::max(result.largest_peak_deg, Metric(flown, "pitch_error_peak_deg"));
    }
    result.median_rms_deg = Median(std::move(rms_deg));
    return result;
  }

 private:
  int StageCount() const { return static_cast<int>(campaign_.vehicle.stages.size()); }
  double ActuatorOf(int stage) const {
    return campaign_.vehicle.stages[static_cast<std::size_t>(stage)].gimbal.bandwidth_rad_s;
  }

  FlightModel ModelWith(const AutopilotConfig& autopilot) const { return start_->model().WithAutopilot(autopilot); }

  std::vector<FlightResult> FlyCases(const FlightModel& model) {
    std::vector<FlightOrder> orders(campaign_.sampling.cases);
    for (std::uint64_t i = 0; i < orders.size(); ++i) {
      orders[i].inputs = start_->Draw(i);
      orders[i].options.case_index = i;
    }
    flights_ += orders.size();
    return FlyAll(model, orders);
  }

  AutopilotModel ModelOf(const AutopilotConfig& autopilot) const {
    return BuildAutopilot(autopilot, start_->model().autopilot().stages,
                          campaign_.vehicle.reaction_control.minimum_on_time_s);
  }

  LeastMargins LeastOf(const AutopilotConfig& autopilot, int stage, bool adapting) const {
    const AutopilotModel model = ModelOf(autopilot);
    const SensorModel sensors = BuildSensors(campaign_.vehicle, autopilot);
    LeastMargins least;
    for (const MarginInstant& instant : instants_) {
      if (instant.sample.stack != stage) continue;
      for (const Axis axis : {kPitch, kYaw, kRoll})
        least.Take(MarginsAt(start_->model().nominal_plant(), sensors, model, instant.sample, axis, adapting));
    }
    return least;
  }

  // Of the design that campaign_ has: the constraint that is missed by most, in the order of Evaluate.
  std::string MissedBy(const std::vector<double>& violations, int stage) const {
    const auto most = std::max_element(violations.begin(), violations.end());
    const std::size_t kind = static_cast<std::size_t>(most - violations.begin());
    const std::size_t margins = options_.dispersed > 0 ? 1 : 6;
    if (kind >= margins) return MissedInFlight(kind - margins, *most);
    return options_.dispersed > 0 ? MissedByHeld(stage) : MissedByNominal(kind % 3, kind >= 3, stage);
  }

  // The constraints of FlyCandidate.
  std::string MissedInFlight(std::size_t kind, double violation) const {
    if (kind == 0) return fmt::format("{:.0f} of {} flights are lost", violation * options_.cases, options_.cases);
    return fmt::format("a deflection swings by {:.2f} deg, {:.2f} are allowed",
                       (1.0 + violation) * kLimitCycleLimit_deg, kLimitCycleLimit_deg);
  }

  // `kind`: 0 gain, 1 phase, 2 delay.
  std::string MissedByNominal(std::size_t kind, bool adapting, int stage) const {
    constexpr const char* kUnits[] = {"dB", "deg", "ms"};
    constexpr double kNeeded[] = {kGainMarginGate_db + kGainReserve_db, kPhaseMarginGate_deg + kPhaseReserve_deg,
                                  1e3 * (kDelayMarginGate_s + kDelayReserve_s)};
    const AutopilotModel model = ModelOf(campaign_.autopilot);
    const SensorModel sensors = BuildSensors(campaign_.vehicle, campaign_.autopilot);
    const LauncherPlant& plant = start_->model().nominal_plant();
    const MotorBurn& burn = plant.stacks[static_cast<std::size_t>(stage)].burn;
    std::string where;
    double least = std::numeric_limits<double>::infinity();
    for (const MarginInstant& instant : instants_) {
      if (instant.sample.stack != stage) continue;
      for (const Axis axis : {kPitch, kYaw, kRoll}) {
        LeastMargins m;
        m.Take(MarginsAt(plant, sensors, model, instant.sample, axis, adapting));
        const double value = kind == 0 ? m.gain_db : kind == 1 ? m.phase_deg : 1e3 * m.delay_s;
        if (!(value < least)) continue;
        least = value;
        const double thrust = burn.Fraction(std::min(instant.sample.since_ignition_s, burn.duration_s));
        where = fmt::format("{} at {:.2f} s{}, {:.0f} % of full thrust", kAxisNames[axis], instant.sample.time_s,
                            instant.place.empty() ? "" : " (" + instant.place + ")", 100.0 * thrust);
      }
    }
    return fmt::format("{} margin {:.1f} {}, {:.1f} are needed: {}, {}", kGateNames[kind], least, kUnits[kind],
                       kNeeded[kind], adapting ? "adapting" : "gains held", where);
  }

  std::string MissedByHeld(int stage) const {
    const AutopilotModel model = ModelOf(campaign_.autopilot);
    const std::vector<double> shares = SharesOf(campaign_.autopilot, stage);
    const Held* worst = nullptr;
    bool worst_adapts = false;
    double least = HUGE_VAL;
    for (const Held& each : held_[static_cast<std::size_t>(stage)]) {
      for (const bool adapting : {true, false}) {
        const double surplus = each.table.Surplus(
            LineariseLaw(model, stage, each.since_ignition_s, each.axis, adapting), shares, each.gates);
        if (!(surplus < least)) continue;
        worst = &each;
        worst_adapts = adapting;
        least = surplus;
      }
    }
    const LinearLaw law = LineariseLaw(model, stage, worst->since_ignition_s, worst->axis, worst_adapts);
    // With the other gates next to nothing; where the body bends either gain or phase does.
    constexpr double kHardly = 1e-9;
    const LoopGates alone[] = {{worst->gates.gain_db, kHardly, 0.0},
                               {kHardly, worst->gates.phase_deg, 0.0},
                               {kHardly, kHardly, worst->gates.delay_s}};
    std::string gate = "gain and phase margin of bending";
    for (std::size_t kind = 0; kind < 3; ++kind)
      if (worst->table.Surplus(law, shares, alone[kind]) == least) gate = fmt::format("{} margin", kGateNames[kind]);
    return fmt::format("{}: {}, {}, {} {:.1f} s after ignition",
                       least <= kUnstableSurplus
                           ? std::string("the loop is unstable")
                           : fmt::format("{} {:.0f} % below its gate with reserve", gate, -100.0 * least),
                       worst->plant, worst_adapts ? "adapting" : "gains held", kAxisNames[worst->axis],
                       worst->since_ignition_s);
  }

  // Ends at the first set of margins that fails, and begins with the one that failed last: designs that are
  // tried one after another are alike, so that one far from admissible costs next to nothing.
  bool HasMargins(const AutopilotConfig& autopilot, int stage, std::size_t* failed_last) const {
    const AutopilotModel model = ModelOf(autopilot);
    const SensorModel sensors = BuildSensors(campaign_.vehicle, autopilot);
    const std::size_t sets = instants_.size() * kAxes * 2;
    for (std::size_t k = 0; k < sets; ++k) {
      const std::size_t set = (*failed_last + k) % sets;
      const MarginInstant& instant = instants_[set / (kAxes * 2)];
      if (instant.sample.stack != stage) continue;
      const Axis axis = static_cast<Axis>(set / 2 % kAxes);
      LeastMargins least;
      least.Take(MarginsAt(start_->model().nominal_plant(), sensors, model, instant.sample, axis, set % 2 == 0));
      if (Suffices(least)) continue;
      *failed_last = set;
      return false;
    }
    return true;
  }

  // A rigid vehicle whose autopilot keeps the reference even where the air's instability is doubled.
  Campaign Stiff(Campaign rigid) const {
    for (AxisConfig* axis : {&rigid.autopilot.pitch, &rigid.autopilot.yaw, &rigid.autopilot.roll}) {
      axis->filters.clear();
      axis->schedule.clear();
    }
    for (int stage = 0; stage < StageCount(); ++stage)
      ApplyDesign(
          StageDesign{kStiffBandwidthOfActuator * ActuatorOf(stage), kStartDamping, kStartLearning, {}},
          stage, rigid.autopilot);
    return rigid;
  }

  std::vector<double> TimesOf(int stage) const { return ScheduledTimes(campaign_.autopilot, stage); }

  // The first mode of a stage at a time of its schedule, without one in the middle of its burn; 0 where it
  // does not bend.
  double FirstMode(int stage, double at_s = 0.0) const {
    const LauncherStack& stack = start_->model().nominal_plant().stacks[static_cast<std::size_t>(stage)];
    if (!stack.bending || stack.bending->modes == 0) return 0.0;
    const double propellant_kg =
        TimesOf(stage).size() > 1 ? stack.burn.Propellant(at_s) : 0.5 * stack.burn.propellant_mass_kg;
    return stack.bending->At(0, 0, BendingTable::kFrequency, propellant_kg);
  }

  // A plant at an instant, about one axis, that designs must hold.
  struct Held {
    std::string plant;  ///< which it is, in words
    double since_ignition_s = 0.0;
    Axis axis = kPitch;
    LoopGates gates;
    LoopTable table;
  };

  void TabulateHeld(const CampaignFlights& rigid) {
    held_.resize(static_cast<std::size_t>(StageCount()));
    for (const MarginInstant& instant : instants_)
      Hold(start_->model().nominal_plant(), "nominal plant", instant.sample, {1.0, 1.0 - kFrequencyBand, 1.0 + kFrequencyBand},
           {kGainMarginGate_db + kHeldGainReserve_db, kPhaseMarginGate_deg + kHeldPhaseReserve_deg,
            kDelayMarginGate_s + kHeldDelayReserve_s});
    for (int i = 0; i < options_.dispersed; ++i) {
      // Beyond the cases that are flown, which need not be as many.
      const std::uint64_t draw = static_cast<std::uint64_t>(i);
      const FlightInputs inputs = start_->Draw(draw);
      const LauncherPlant plant = start_->model().PlantFor(inputs, draw);
      for (const MarginInstant& instant : MarginInstants(rigid.model(), 5.0, inputs))
        Hold(plant, fmt::format("plant of draw {}", i), instant.sample, {1.0},
             {kDispersedGainGate_db + kHeldGainReserve_db, kDispersedPhaseGate_deg + kHeldPhaseReserve_deg,
              0.0});
    }
  }

  void Hold(LauncherPlant plant, const std::string& name, const TickSample& sample,
            const std::vector<double>& frequency_factors, const LoopGates& gates) {
    const std::size_t stage = static_cast<std::size_t>(sample.stack);
    SensorModel all = start_->model().sensors();
    all.stages[stage].unit = 1.0;
    for (std::size_t g = 0; g < all.gyros.size(); ++g) all.stages[stage].gyro[g] = 1.0;
    const std::array<double, kModes> nominal = plant.bending.frequency;
    for (const double factor : frequency_factors) {
      for (std::size_t k = 0; k < kModes; ++k) plant.bending.frequency[k] = factor * nominal[k];
      // Roll neither bends nor diverges: the nominal plant stands for all.
      const std::vector<Axis> axes =
          frequency_factors.size() > 1 ? std::vector{kPitch, kYaw, kRoll} : std::vector{kPitch, kYaw};
      for (const Axis axis : axes) {
        if (axis == kRoll && !plant.stacks[stage].layout.rolls) continue;  // thrusters hold it
        held_[stage].push_back({factor == 1.0 ? name : fmt::format("{}, modes at {:.0f} %", name, 100.0 * factor),
                                sample.since_ignition_s, axis, gates,
                                LoopTable(LineariseAxis(plant, sample, axis, all), campaign_.autopilot.tick_s,
                                          plant.stacks[stage].gimbal.delay_ticks)});
      }
    }
  }

  // What an autopilot makes of the rates of each sensor in a stage.
  std::vector<double> SharesOf(const AutopilotConfig& autopilot, int stage) const {
    const SensorModel sensors = BuildSensors(campaign_.vehicle, autopilot);
    const SensorModel::Weights& weights = sensors.stages[static_cast<std::size_t>(stage)];
    std::vector<double> shares = {weights.unit};
    for (std::size_t g = 0; g < sensors.gyros.size(); ++g) shares.push_back(weights.gyro[g]);
    return shares;
  }

  // The least surplus of all held plants of a stage, or of those nearer to one of its times than to others.
  // Once it is below `enough` the rest does not matter; `last`, which was least before, is looked at first.
  double SurplusOf(const AutopilotConfig& autopilot, int stage, std::size_t* last, double enough,
                   std::optional<std::size_t> about = {}) const {
    const AutopilotModel model = ModelOf(autopilot);
    const std::vector<double> shares = SharesOf(autopilot, stage);
    const std::vector<double> times = TimesOf(stage);
    const auto nearest = [&](double at_s) {
      std::size_t found = 0;
      for (std::size_t k = 1; k < times.size(); ++k)
        if (std::fabs(at_s - times[k]) < std::fabs(at_s - times[found])) found = k;
      return found;
    };
    const std::vector<Held>& held = held_[static_cast<std::size_t>(stage)];
    double least = HUGE_VAL;
    for (std::size_t k = 0; k < held.size() && least > enough; ++k) {
      // The one that failed last, then all.
      const std::size_t i = (*last + k) % held.size();
      const Held& each = held[i];
      if (about && nearest(each.since_ignition_s) != *about) continue;
      for (const bool adapting : {true, false}) {
        const LinearLaw law = LineariseLaw(model, stage, each.since_ignition_s, each.axis, adapting);
        const double surplus = each.table.Surplus(law, shares, each.gates);
        if (surplus < least) {
          least = surplus;
          if (least <= enough) *last = i;
        }
        if (!InfoOf(model.laws[static_cast<std::size_t>(each.axis)].config.law).adaptation) break;
      }
    }
    return least;
  }

  // All but the bandwidth at a point of the search.
  StageDesign ShapeOf(const std::vector<double>& point, int stage, double at_s) const {
    StageDesign design;
    std::size_t next = 1;
    if (options_.regulator) {
      const RegulatorGains k = SolveRegulator({std::pow(10.0, point[1]), 1.0, std::pow(10.0, point[2])});
      const double w = std::sqrt(k.kp_1_s2);
      design.damping = k.kd_1_s / (2.0 * w);
      design.learning = k.ki_1_s3 / (w * w * w);
      next = 3;
    } else {
      design.damping = point[next++];
      design.learning = learns_ ? point[next++] : 0.0;
    }
    if (FirstMode(stage) > 0.0)
      design.filters =
          FiltersAt({point.begin() + static_cast<std::ptrdiff_t>(next), point.end()}, stage, at_s);
    return design;
  }

  // Of the last variables of a point.
  StageFilters FiltersAt(const std::vector<double>& point, int stage, double at_s) const {
    const double first_mode_rad_s = FirstMode(stage, at_s);
    const double fastest_rad_s = kFastestPoles * kPi / campaign_.autopilot.tick_s;
    StageFilters filters;
    filters.low_pass_rad_s = std::min(std::pow(10.0, point[0]) * first_mode_rad_s, fastest_rad_s);
    filters.low_pass_damping = point[1];
    filters.notch_rad_s = std::min(std::pow(10.0, point[2]) * first_mode_rad_s, fastest_rad_s);
    filters.notch_zeros_damping = point[3];
    filters.notch_poles_damping = point[4];
    if (!BlendedGyros(campaign_.autopilot, stage).empty()) filters.first_gyro_weight = point[5];
    return filters;
  }

  // Of a point of the search: bandwidth as a fraction of the largest admissible one, and its shape. Where
  // none is admissible the least one stands, and its margins say by how much they are missed.
  std::vector<StageDesign> DesignOf(const std::vector<double>& point, int stage) const {
    const std::vector<double> times = TimesOf(stage);
    std::vector<StageDesign> designs;
    for (std::size_t k = 0; k < times.size(); ++k)
      designs.push_back(options_.dispersed > 0 ? HeldDesign(point, stage, k)
                                               : NominalDesign(point, stage, times[k]));
    return designs;
  }

  // At a time of a stage's schedule, as if the whole stage had it: the largest bandwidth and the damping with
  // which the held plants about that time are held, else those which come nearest.
  StageDesign HeldDesign(const std::vector<double>& point, int stage, std::size_t time) const {
    const std::vector<double> times = TimesOf(stage);
    StageDesign design = ShapeOf(point, stage, times[time]), best = design;
    const double damping = design.damping;
    AutopilotConfig autopilot = campaign_.autopilot;
    double most = -HUGE_VAL;
    std::size_t last = 0;
    for (double w = kHeldBandwidthOfActuator.high * ActuatorOf(stage);
         w > kHeldBandwidthOfActuator.low * ActuatorOf(stage) && most < 0.0; w *= kHeldBandwidthStep) {
      for (const double factor : kDampingFactors) {
        if (times.size() == 1 && factor != 1.0) break;
        design.bandwidth_rad_s = w;
        design.damping = factor * damping;
        ApplyDesign(std::vector<StageDesign>(times.size(), design), stage, autopilot);
        // Of what is hopeless the degree does not matter.
        const double surplus = SurplusOf(autopilot, stage, &last, std::clamp(most, kHopeless, 0.0), time);
        if (surplus <= most) continue;
        most = surplus;
        best = design;
        if (most >= 0.0) break;
      }
    }
    if (times.size() > 1 && most < 0.0 && most > kWorthRefining) Refine(stage, time, most, best);
    best.bandwidth_rad_s *= point[0];
    return best;
  }

  // Where what a stage has in common does not hold the plants about a time, the design of that time departs
  // from it: a random walk of its bandwidth, damping, integral and filters that keeps what is better, with
  // steps that grow by success and shrink by failure. The same whatever was tried before.
  void Refine(int stage, std::size_t time, double most, StageDesign& best) const {
    const std::size_t times = TimesOf(stage).size();
    const double fastest_rad_s = kFastestPoles * kPi / campaign_.autopilot.tick_s;
    AutopilotConfig autopilot = campaign_.autopilot;
    std::mt19937_64 random(options_.seed);
    const auto change = [&](double size) {
      return std::exp(size * (static_cast<double>(random() >> 11) * 0x1p-52 - 1.0));
    };
    double size = kRefinementStep;
    std::size_t last = 0;
    for (int i = 0; i < kRefinements && most < 0.0; ++i) {
      StageDesign next = best;
      for (double* value :
           {&next.bandwidth_rad_s, &next.damping, &next.learning, &next.filters.low_pass_rad_s,
            &next.filters.low_pass_damping, &next.filters.notch_rad_s, &next.filters.notch_zeros_damping,
            &next.filters.notch_poles_damping})
        *value *= change(size);
      next.filters.low_pass_rad_s = std::min(next.filters.low_pass_rad_s, fastest_rad_s);
      next.filters.notch_rad_s = std::min(next.filters.notch_rad_s, fastest_rad_s);
      ApplyDesign(std::vector<StageDesign>(times, next), stage, autopilot);
      const double surplus = SurplusOf(autopilot, stage, &last, most, time);
      const bool better = surplus > most;
      size *= better ? kRefinementGrowth : kRefinementDecay;
      if (!better) continue;
      most = surplus;
      best = next;
    }
  }

  StageDesign NominalDesign(const std::vector<double>& point, int stage, double at_s) const {
    StageDesign design = ShapeOf(point, stage, at_s);
    const std::size_t times = TimesOf(stage).size();
    AutopilotConfig autopilot = campaign_.autopilot;
    const double lowest_rad_s = kBandwidthOfActuator.low * ActuatorOf(stage);
    double w = kBandwidthOfActuator.high * ActuatorOf(stage);
    std::size_t failed_last = 0;
    for (; w > lowest_rad_s; w *= kBandwidthStep) {
      design.bandwidth_rad_s = w;
      ApplyDesign(std::vector<StageDesign>(times, design), stage, autopilot);
      if (HasMargins(autopilot, stage, &failed_last)) break;
    }
    design.bandwidth_rad_s = point[0] * std::max(w, lowest_rad_s);
    return design;
  }

  Evaluation Evaluate(const std::vector<double>& point, int stage) {
    AutopilotConfig candidate = campaign_.autopilot;
    ApplyDesign(DesignOf(point, stage), stage, candidate);
    Evaluation evaluation;
    std::vector<double>& violations = evaluation.constraint_violations;
    if (options_.dispersed > 0) {
      std::size_t last = 0;
      violations.push_back(std::max(0.0, -SurplusOf(candidate, stage, &last, -HUGE_VAL)));
    } else {
      AddViolations(LeastOf(candidate, stage, false), violations);
      AddViolations(LeastOf(candidate, stage, true), violations);
    }
    if (!AllZero(violations)) return evaluation;

    FlyCandidate(ModelWith(candidate), "_stage" + std::to_string(stage + 1) + "_deg", evaluation);
    return evaluation;
  }

  // Objective, tie-breaker and constraints of flight; `suffix` of the metrics of the pitch error.
  void FlyCandidate(const FlightModel& candidate, const std::string& suffix, Evaluation& evaluation) {
    double sum_deg = 0.0, lost = 0.0, cycle_deg = 0.0;
    for (const FlightResult& flown : FlyCases(candidate)) {
      // Not every metric of a flight that was lost is defined.
      if (flown.outcome != Outcome::kCompleted) {
        lost += 1.0;
        continue;
      }
      sum_deg += Metric(flown, "pitch_error_rms" + suffix);
      evaluation.tie_breaker = std::max(evaluation.tie_breaker, Metric(flown, "pitch_error_peak" + suffix));
      cycle_deg = std::max(cycle_deg, Metric(flown, "deflection_ripple_deg"));
    }
    evaluation.objective = sum_deg / options_.cases;
    evaluation.constraint_violations.push_back(lost / options_.cases);
    evaluation.constraint_violations.push_back(std::max(0.0, cycle_deg / kLimitCycleLimit_deg - 1.0));
  }

  // `part`: as in TuningRecord.
  GeneticAlgorithmResult Minimize(const BoundedProblem& problem, int part, const TuningObserver& observer) const {
    GeneticAlgorithmOptions search;
    search.population = PopulationOf(options_);
    search.elites = kElites;
    search.generations = GenerationsOf(options_, SearchesOf(campaign_, campaign_.autopilot));
    search.mutation_eta = kMutationEta;
    search.final_mutation_eta = kFinalMutationEta;
    search.objective_tolerance = kObjectiveTolerance_deg;
    search.seed = options_.seed;
    search.threads = options_.threads;
    return GeneticAlgorithm(search).Minimize(problem, [&](const GenerationRecord& record) {
      if (observer) observer({part, record});
    });
  }

  static AugmentationDesign AugmentationOf(const std::vector<double>& point) {
    return {std::pow(10.0, point[0]), std::pow(10.0, point[1]), point[2]};
  }

  AugmentationTuning TuneAugmentation(const TuningObserver& observer, std::uint64_t& evaluations) {
    BoundedProblem problem;
    problem.lower = {kAdaptiveGainPower.low, kSpectralGainPower.low, kMaximumTotalGain.low};
    problem.upper = {kAdaptiveGainPower.high, kSpectralGainPower.high, kMaximumTotalGain.high};
    problem.known_points = {{std::log10(kStartAugmentation.adaptive_gain_1_s),
                             std::log10(kStartAugmentation.spectral_gain_1_s),
                             kStartAugmentation.maximum_total_gain}};
    problem.evaluate = [this](const std::vector<double>& point) {
      AutopilotConfig autopilot = campaign_.autopilot;
      ApplyDesign(AugmentationOf(point), autopilot);
      const FlightModel candidate = ModelWith(autopilot);
      Evaluation evaluation;
      for (const MeasuredMargins& m : MeasureMargins(candidate)) AddViolations(m, evaluation.constraint_violations);
      if (AllZero(evaluation.constraint_violations)) FlyCandidate(candidate, "_deg", evaluation);
      return evaluation;
    };
    const GeneticAlgorithmResult found = Minimize(problem, StageCount(), observer);

    AugmentationTuning tuned;
    tuned.design = AugmentationOf(found.variables);
    ApplyDesign(tuned.design, campaign_.autopilot);
    tuned.feasible = AllZero(found.evaluation.constraint_violations);
    tuned.mean_rms_deg = found.evaluation.objective;
    tuned.peak_deg = found.evaluation.tie_breaker;
    if (!tuned.feasible) tuned.missed = MissedByAugmentation(found.evaluation.constraint_violations);
    evaluations += found.evaluations;
    return tuned;
  }

  // Of the augmentation that campaign_ has, likewise: one constraint a stage, then those of flight.
  std::string MissedByAugmentation(const std::vector<double>& violations) const {
    const auto most = std::max_element(violations.begin(), violations.end());
    const std::size_t kind = static_cast<std::size_t>(most - violations.begin());
    const std::vector<MeasuredMargins> measured = MeasureMargins(ModelWith(campaign_.autopilot));
    if (kind >= measured.size()) return MissedInFlight(kind - measured.size(), *most);
    const MeasuredMargins& m = measured[kind];
    return fmt::format("measured margins of stage {}: gain {:.1f} dB up, {:.1f} dB down, delay {:.0f} ms; {:.1f} dB and "
                       "{:.0f} ms are needed",
                       m.stage + 1, m.gain_up_db, m.gain_down_db, 1e3 * m.delay_s, kGainMarginGate_db,
                       1e3 * kDelayMarginGate_s);
  }

  StageTuning TuneStage(int stage, const TuningObserver& observer, std::uint64_t& evaluations) {
    BoundedProblem problem;
    struct Variable {
      Bounds bounds;
      double start;
      double held_start = start;  ///< of the second point that a search under held plants begins with
    };
    std::vector<Variable> variables = {{kBandwidthOfLargest, kBandwidthOfLargest.high}};
    if (options_.regulator) {
      variables.push_back({kIntegralWeightPower, kStartIntegralWeightPower});
      variables.push_back({kRateWeightPower, kStartRateWeightPower});
    } else {
      variables.push_back({kDamping, kStartDamping, kHeldDampingStart});
      if (learns_ && options_.dispersed > 0)
        variables.push_back({kHeldLearning, kHeldLearningStart});
      else if (learns_)
        variables.push_back({kLearning, kStartLearning});
    }
    if (FirstMode(stage) > 0.0) {
      variables.push_back({kLowPassPower, kStartLowPassPower, kHeldLowPassPowerStart});
      variables.push_back({kLowPassDamping, kStartLowPassDamping, kHeldLowPassDampingStart});
      variables.push_back({kNotchPower, kStartNotchPower, kHeldNotchPowerStart});
      variables.push_back({kNotchZerosDamping, kStartNotchZerosDamping, kHeldNotchZerosDampingStart});
      variables.push_back({kNotchPolesDamping, kStartNotchPolesDamping, kHeldNotchPolesDampingStart});
      if (!BlendedGyros(campaign_.autopilot, stage).empty())
        variables.push_back({kGyroWeight, kStartGyroWeight, kHeldGyroWeightStart});
    }
    problem.known_points = {{}};
    if (options_.dispersed > 0) problem.known_points.push_back({});
    for (const Variable& variable : variables) {
      problem.lower.push_back(variable.bounds.low);
      problem.upper.push_back(variable.bounds.high);
      problem.known_points[0].push_back(variable.start);
      if (options_.dispersed > 0) problem.known_points[1].push_back(variable.held_start);
    }
    problem.evaluate = [&](const std::vector<double>& point) { return Evaluate(point, stage); };
    const GeneticAlgorithmResult found = Minimize(problem, stage, observer);

    StageTuning tuned;
    const std::vector<StageDesign> designs = DesignOf(found.variables, stage);
    tuned.design = designs.front();
    ApplyDesign(designs, stage, campaign_.autopilot);
    tuned.feasible = AllZero(found.evaluation.constraint_violations);
    tuned.mean_rms_deg = found.evaluation.objective;
    tuned.peak_deg = found.evaluation.tie_breaker;
    tuned.frozen = LeastOf(campaign_.autopilot, stage, false);
    tuned.adapting = LeastOf(campaign_.autopilot, stage, true);
    if (options_.dispersed > 0) {
      std::size_t last = 0;
      tuned.surplus = SurplusOf(campaign_.autopilot, stage, &last, -HUGE_VAL);
    }
    if (!tuned.feasible) tuned.missed = MissedBy(found.evaluation.constraint_violations, stage);
    evaluations += found.evaluations;
    return tuned;
  }

  const TuningOptions& options_;
  Campaign campaign_;  ///< its autopilot: tuned as far as the search has come
  bool learns_;
  std::unique_ptr<CampaignFlights>
      start_;  ///< all stages untuned: margins are taken about its nominal flight
  std::vector<MarginInstant> instants_;
  std::vector<SkippedInstant> skipped_;
  std::vector<std::vector<Held>> held_;  ///< by stage
  std::atomic<std::uint64_t> flights_ = 0;
};

}  // namespace

std::uint64_t TuningGenerations(const Campaign& campaign, const AutopilotConfig& autopilot,
                                const TuningOptions& options) {
  const int searches = SearchesOf(campaign, autopilot);
  return static_cast<std::uint64_t>(searches) *
         static_cast<std::uint64_t>(GenerationsOf(options, searches) + 1);
}

TuningResult Tune(const Campaign& campaign, const AutopilotConfig& autopilot, const TuningOptions& options,
                  const TuningObserver& observer) {
  Validate(campaign, autopilot, options);
  return Tuner(campaign, autopilot, options).Run(observer);
}

}  // namespace dispersa
