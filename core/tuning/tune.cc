#include "core/tuning/tune.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>

#include "core/campaign/campaign_flights.h"
#include "core/campaign/input_error.h"
#include "core/flight/flight.h"
#include "core/flight/flight_model.h"
#include "core/flight/margins.h"
#include "core/flight/metrics.h"
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
  const int least = 2 * kTuningPopulation * SearchesOf(campaign, autopilot);
  if (options.evaluations < least || options.evaluations > 1000000)
    add("evaluations", std::to_string(options.evaluations) + " is out of range",
        std::to_string(least) + " (two generations of " + std::to_string(kTuningPopulation) +
            " for each " + (IsAugmented(autopilot) ? "stage and the augmentation" : "stage") + ") to 1000000");
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

// Generations of a search after the initial one.
int GenerationsOf(int evaluations, int searches) {
  return (evaluations / searches - kTuningPopulation) / (kTuningPopulation - kElites);
}

// Steps of the search for the largest bandwidth.
constexpr double kBandwidthStep = 0.98;

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
      if (FirstMode(stage) > 0.0)
        cautious.filters = FiltersAt({kStartLowPassPower, kStartLowPassDamping, kStartNotchPower,
                                      kStartNotchZerosDamping, kStartNotchPolesDamping, kStartGyroWeight},
                                     stage);
      ApplyDesign(cautious, stage, campaign_.autopilot);
    }
    ApplyDesign(kStartAugmentation, campaign_.autopilot);
    start_ = std::make_unique<CampaignFlights>(campaign_);
    // Of a vehicle that bends the instants are those of its rigid self: untuned, the other may be lost.
    Campaign rigid = campaign_;
    if (rigid.vehicle.structure_beam) rigid.vehicle.structure_beam->flown_modes = 0;
    instants_ = MarginInstants(CampaignFlights(rigid).model());
  }

  TuningResult Run(const TuningObserver& observer) {
    TuningResult result;
    result.feasible = true;
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

  // The first mode of a stage in the middle of its burn; 0 where it does not bend.
  double FirstMode(int stage) const {
    const LauncherStack& stack = start_->model().nominal_plant().stacks[static_cast<std::size_t>(stage)];
    if (!stack.bending || stack.bending->modes == 0) return 0.0;
    return stack.bending->At(0, 0, BendingTable::kFrequency, 0.5 * stack.burn.propellant_mass_kg);
  }

  // All but the bandwidth at a point of the search.
  StageDesign ShapeOf(const std::vector<double>& point, int stage) const {
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
      design.filters = FiltersAt({point.begin() + static_cast<std::ptrdiff_t>(next), point.end()}, stage);
    return design;
  }

  // Of the last variables of a point.
  StageFilters FiltersAt(const std::vector<double>& point, int stage) const {
    const double first_mode_rad_s = FirstMode(stage);
    StageFilters filters;
    filters.low_pass_rad_s = std::pow(10.0, point[0]) * first_mode_rad_s;
    filters.low_pass_damping = point[1];
    filters.notch_rad_s = std::pow(10.0, point[2]) * first_mode_rad_s;
    filters.notch_zeros_damping = point[3];
    filters.notch_poles_damping = point[4];
    if (!BlendedGyros(campaign_.autopilot, stage).empty()) filters.first_gyro_weight = point[5];
    return filters;
  }

  // Of a point of the search: bandwidth as a fraction of the largest admissible one, and its shape. Where
  // none is admissible the least one stands, and its margins say by how much they are missed.
  StageDesign DesignOf(const std::vector<double>& point, int stage) const {
    StageDesign design = ShapeOf(point, stage);
    AutopilotConfig autopilot = campaign_.autopilot;
    const double lowest_rad_s = kBandwidthOfActuator.low * ActuatorOf(stage);
    double w = kBandwidthOfActuator.high * ActuatorOf(stage);
    std::size_t failed_last = 0;
    for (; w > lowest_rad_s; w *= kBandwidthStep) {
      design.bandwidth_rad_s = w;
      ApplyDesign(design, stage, autopilot);
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
    AddViolations(LeastOf(candidate, stage, false), violations);
    AddViolations(LeastOf(candidate, stage, true), violations);
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
    search.population = kTuningPopulation;
    search.elites = kElites;
    search.generations = GenerationsOf(options_.evaluations, SearchesOf(campaign_, campaign_.autopilot));
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
    evaluations += found.evaluations;
    return tuned;
  }

  StageTuning TuneStage(int stage, const TuningObserver& observer, std::uint64_t& evaluations) {
    BoundedProblem problem;
    struct Variable {
      Bounds bounds;
      double start;
    };
    std::vector<Variable> variables = {{kBandwidthOfLargest, kBandwidthOfLargest.high}};
    if (options_.regulator) {
      variables.push_back({kIntegralWeightPower, kStartIntegralWeightPower});
      variables.push_back({kRateWeightPower, kStartRateWeightPower});
    } else {
      variables.push_back({kDamping, kStartDamping});
      if (learns_) variables.push_back({kLearning, kStartLearning});
    }
    if (FirstMode(stage) > 0.0) {
      variables.push_back({kLowPassPower, kStartLowPassPower});
      variables.push_back({kLowPassDamping, kStartLowPassDamping});
      variables.push_back({kNotchPower, kStartNotchPower});
      variables.push_back({kNotchZerosDamping, kStartNotchZerosDamping});
      variables.push_back({kNotchPolesDamping, kStartNotchPolesDamping});
      if (!BlendedGyros(campaign_.autopilot, stage).empty())
        variables.push_back({kGyroWeight, kStartGyroWeight});
    }
    problem.known_points = {{}};
    for (const Variable& variable : variables) {
      problem.lower.push_back(variable.bounds.low);
      problem.upper.push_back(variable.bounds.high);
      problem.known_points[0].push_back(variable.start);
    }
    problem.evaluate = [&](const std::vector<double>& point) { return Evaluate(point, stage); };
    const GeneticAlgorithmResult found = Minimize(problem, stage, observer);

    StageTuning tuned;
    tuned.design = DesignOf(found.variables, stage);
    ApplyDesign(tuned.design, stage, campaign_.autopilot);
    tuned.feasible = AllZero(found.evaluation.constraint_violations);
    tuned.mean_rms_deg = found.evaluation.objective;
    tuned.peak_deg = found.evaluation.tie_breaker;
    tuned.frozen = LeastOf(campaign_.autopilot, stage, false);
    tuned.adapting = LeastOf(campaign_.autopilot, stage, true);
    evaluations += found.evaluations;
    return tuned;
  }

  const TuningOptions& options_;
  Campaign campaign_;  ///< its autopilot: tuned as far as the search has come
  bool learns_;
  std::unique_ptr<CampaignFlights>
      start_;  ///< all stages untuned: margins are taken about its nominal flight
  std::vector<MarginInstant> instants_;
  std::atomic<std::uint64_t> flights_ = 0;
};

}  // namespace

std::uint64_t TuningGenerations(const Campaign& campaign, const AutopilotConfig& autopilot,
                                const TuningOptions& options) {
  const int searches = SearchesOf(campaign, autopilot);
  return static_cast<std::uint64_t>(searches) *
         static_cast<std::uint64_t>(GenerationsOf(options.evaluations, searches) + 1);
}

TuningResult Tune(const Campaign& campaign, const AutopilotConfig& autopilot, const TuningOptions& options,
                  const TuningObserver& observer) {
  Validate(campaign, autopilot, options);
  return Tuner(campaign, autopilot, options).Run(observer);
}

}  // namespace dispersa
