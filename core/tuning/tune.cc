#include "core/tuning/tune.h"

#include <algorithm>
#include <atomic>
#include <limits>

#include "core/campaign/campaign_flights.h"
#include "core/campaign/input_error.h"
#include "core/flight/flight_model.h"
#include "core/flight/margins.h"
#include "core/flight/metrics.h"
#include "core/tuning/stage_design.h"

namespace dispersa {

namespace {

constexpr int kElites = 2;
// Changes of a percent at the end: the optimum is flat, and a design is rounded to a thousandth anyhow.
constexpr double kFinalMutationEta = 100.0;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double Metric(const CaseResult& result, const std::string& name) {
  const std::vector<std::string>& names = MetricNames();
  return result
      .metrics[static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin())];
}

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
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
  const int least = 2 * kTuningPopulation * stages;
  if (options.evaluations < least || options.evaluations > 1000000)
    add("evaluations", std::to_string(options.evaluations) + " is out of range",
        std::to_string(least) + " (two generations of " + std::to_string(kTuningPopulation) +
            " for each stage) to 1000000");
  for (const AutopilotProblem& problem : Problems(autopilot, stages))
    add(problem.path, problem.message, problem.allowed);
  for (const AxisConfig* axis : {&autopilot.pitch, &autopilot.yaw, &autopilot.roll})
    if (axis->law == ControlLaw::kAdaptiveFuzzy && axis->adaptation.p_n)
      add("adaptation.p_n", "is fixed, but P_n follows from the gains that are to be found", "no p_n");
  if (!problems.empty()) throw InputError(std::move(problems));
}

void Take(const LoopMargins& m, LeastMargins& least) {
  least.gain_db = std::min({least.gain_db, m.gain_up_db, m.gain_down_db});
  least.phase_deg = std::min(least.phase_deg, m.phase_deg);
  least.delay_s = std::min(least.delay_s, m.delay_s);
}

LeastMargins LeastOf(const FlightModel& model, const std::vector<MarginInstant>& instants, int stage,
                     bool adapting) {
  LeastMargins least = {kInfinity, kInfinity, kInfinity};
  for (const MarginInstant& instant : instants) {
    if (instant.sample.stack != stage) continue;
    for (const Axis axis : {kPitch, kYaw, kRoll})
      Take(MarginsAt(model, instant.sample, axis, adapting), least);
  }
  return least;
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

// Generations of a stage after the initial one.
int GenerationsOf(int evaluations, int stages) {
  return (evaluations / stages - kTuningPopulation) / (kTuningPopulation - kElites);
}

// The campaign as the tuning flies it, and what it has found so far.
class Tuner {
 public:
  Tuner(const Campaign& campaign, const AutopilotConfig& autopilot, const TuningOptions& options)
      : options_(options), campaign_(campaign) {
    campaign_.autopilot = autopilot;
    campaign_.sampling = {SamplingMethod::kMonteCarlo, static_cast<std::uint64_t>(options.cases),
                          options.seed};
    for (int stage = 0; stage < StageCount(); ++stage)
      ApplyDesign(StartDesign(), stage, ActuatorOf(stage), campaign_.autopilot);
    instants_ = MarginInstants(CampaignFlights(campaign_).model());
  }

  TuningResult Run(const TuningObserver& observer) {
    TuningResult result;
    result.feasible = true;
    for (int stage = 0; stage < StageCount(); ++stage) {
      result.stages.push_back(TuneStage(stage, observer, result.evaluations));
      result.feasible = result.feasible && result.stages.back().feasible;
    }
    result.flights = flights_;
    result.autopilot = campaign_.autopilot;
    if (!result.feasible) return result;
    const CampaignFlights flights(campaign_);
    std::vector<double> rms_deg;
    for (const CaseResult& flown : FlyAll(flights)) {
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
  std::vector<double> StartDesign() const {
    std::vector<double> design;
    for (std::size_t i = 0; i < DesignSize(campaign_.autopilot); ++i)
      design.push_back(kDesignVariables[i].start);
    return design;
  }

  std::vector<CaseResult> FlyAll(const CampaignFlights& flights) {
    std::vector<CaseResult> all;
    for (std::uint64_t i = 0; i < campaign_.sampling.cases; ++i) all.push_back(flights.FlyCase(i));
    flights_ += all.size();
    return all;
  }

  Evaluation Evaluate(const std::vector<double>& design, int stage) {
    Campaign candidate = campaign_;
    ApplyDesign(design, stage, ActuatorOf(stage), candidate.autopilot);
    const CampaignFlights flights(candidate);
    Evaluation evaluation;
    std::vector<double>& violations = evaluation.constraint_violations;
    AddViolations(LeastOf(flights.model(), instants_, stage, false), violations);
    AddViolations(LeastOf(flights.model(), instants_, stage, true), violations);
    if (std::any_of(violations.begin(), violations.end(), [](double v) { return v > 0.0; }))
      return evaluation;

    const std::string suffix = "_stage" + std::to_string(stage + 1) + "_deg";
    double sum_deg = 0.0, lost = 0.0, cycle_deg = 0.0;
    const std::vector<CaseResult> all = FlyAll(flights);
    for (const CaseResult& flown : all) {
      // Not every metric of a flight that was lost is defined.
      if (flown.outcome != Outcome::kCompleted) {
        lost += 1.0;
        continue;
      }
      sum_deg += Metric(flown, "pitch_error_rms" + suffix);
      evaluation.tie_breaker = std::max(evaluation.tie_breaker, Metric(flown, "pitch_error_peak" + suffix));
      cycle_deg = std::max(cycle_deg, Metric(flown, "deflection_limit_cycle_deg"));
    }
    const double cases = static_cast<double>(all.size());
    evaluation.objective = sum_deg / cases;
    violations.push_back(lost / cases);
    violations.push_back(std::max(0.0, cycle_deg / kLimitCycleLimit_deg - 1.0));
    return evaluation;
  }

  StageTuning TuneStage(int stage, const TuningObserver& observer, std::uint64_t& evaluations) {
    GeneticAlgorithmOptions search;
    search.population = kTuningPopulation;
    search.elites = kElites;
    search.generations = GenerationsOf(options_.evaluations, StageCount());
    search.final_mutation_eta = kFinalMutationEta;
    search.objective_tolerance = kObjectiveTolerance_deg;
    search.seed = options_.seed;
    search.threads = options_.threads;

    BoundedProblem problem;
    problem.known_points = {StartDesign()};
    for (std::size_t i = 0; i < problem.known_points[0].size(); ++i) {
      problem.lower.push_back(kDesignVariables[i].lower);
      problem.upper.push_back(kDesignVariables[i].upper);
    }
    problem.evaluate = [&](const std::vector<double>& design) { return Evaluate(design, stage); };
    const GeneticAlgorithmResult found =
        GeneticAlgorithm(search).Minimize(problem, [&](const GenerationRecord& record) {
          if (observer) observer({stage, record});
        });

    ApplyDesign(found.variables, stage, ActuatorOf(stage), campaign_.autopilot);
    const CampaignFlights flights(campaign_);
    StageTuning tuned;
    tuned.design = found.variables;
    const std::vector<double>& violations = found.evaluation.constraint_violations;
    tuned.feasible = std::all_of(violations.begin(), violations.end(), [](double v) { return v == 0.0; });
    tuned.mean_rms_deg = found.evaluation.objective;
    tuned.peak_deg = found.evaluation.tie_breaker;
    tuned.frozen = LeastOf(flights.model(), instants_, stage, false);
    tuned.adapting = LeastOf(flights.model(), instants_, stage, true);
    evaluations += found.evaluations;
    return tuned;
  }

  const TuningOptions& options_;
  Campaign campaign_;  ///< its autopilot: tuned as far as the search has come
  std::vector<MarginInstant> instants_;
  std::atomic<std::uint64_t> flights_ = 0;
};

}  // namespace

std::uint64_t TuningGenerations(const Campaign& campaign, const TuningOptions& options) {
  const int stages = static_cast<int>(campaign.vehicle.stages.size());
  return static_cast<std::uint64_t>(stages) *
         static_cast<std::uint64_t>(GenerationsOf(options.evaluations, stages) + 1);
}

TuningResult Tune(const Campaign& campaign, const AutopilotConfig& autopilot, const TuningOptions& options,
                  const TuningObserver& observer) {
  Validate(campaign, autopilot, options);
  return Tuner(campaign, autopilot, options).Run(observer);
}

}  // namespace dispersa
