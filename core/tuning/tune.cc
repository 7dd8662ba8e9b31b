#include "core/tuning/tune.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <optional>
#include <random>

#include "core/cases/campaign_flights.h"
#include "core/flight/flight.h"
#include "core/flight/flight_model.h"
#include "core/flight/metrics.h"
#include "core/margins/flight_margins.h"
#include "core/math/constants.h"
#include "core/tuning/held_plants.h"
#include "core/tuning/nominal_margins.h"
#include "core/tuning/stage_points.h"
#include "core/tuning/tuned_plant.h"
#include "core/tuning/tuning_budget.h"

namespace dispersa {

namespace {

// Mutations are about a tenth of a variable's range at first.
constexpr double kMutationEta = 10.0;
// Mutations are about a percent at the end. The optimum is flat, and a design is rounded to a thousandth.
constexpr double kFinalMutationEta = 100.0;

double Metric(const FlightResult& result, const std::string& name) {
  return result.metrics[MetricColumn(name)];
}

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

bool AllZero(const std::vector<double>& violations) {
  return std::all_of(violations.begin(), violations.end(), [](double v) { return v == 0.0; });
}

// Adds the fraction by which the gates are missed.
void AddViolations(const MeasuredMargins& m, std::vector<double>& violations) {
  const double gain_db = std::min(m.gain_up_db, m.gain_down_db);
  violations.push_back(PassesGates(m) ? 0.0
                                      : std::max({1e-3, 1.0 - gain_db / kGainMarginGate_db,
                                                  1.0 - m.delay_s / kDelayMarginGate_s}));
}

// Steps of the search for the largest bandwidth.
constexpr double kBandwidthStep = 0.98;
constexpr double kHeldBandwidthStep = 0.97;
constexpr double kWorstSurplus = -1.0;
// Refinement of the design of one time: from this surplus on, this number of steps, of 5 % at first.
constexpr double kWorthRefining = -0.12;
constexpr int kRefinements = 500;
constexpr double kRefinementStep = 0.05, kRefinementGrowth = 1.5, kRefinementDecay = 0.97;
constexpr double kStiffBandwidthOfActuator = 0.165;

// The campaign as the tuning flies it, with the designs found so far.
class Tuner {
 public:
  Tuner(const Campaign& campaign, const AutopilotConfig& autopilot, const TuningOptions& options)
      : options_(options), campaign_(campaign) {
    campaign_.autopilot = autopilot;
    campaign_.sampling = {SamplingMethod::kMonteCarlo, static_cast<std::uint64_t>(options.cases),
                          options.seed};
    campaign_.guidance = {};  // its turns are commands, which no gains take away
    // A first model, only for properties of the plant that the loop below needs.
    start_ = std::make_unique<CampaignFlights>(campaign_);
    for (int stage = 0; stage < Plant().StageCount(); ++stage) {
      StageDesign cautious;
      cautious.bandwidth_rad_s = kStartBandwidthOfActuator * Plant().ActuatorOf(stage);
      cautious.damping = kStartDamping;
      cautious.learning = kStartLearning;
      std::vector<StageDesign> at_times;
      for (const double at_s : Plant().TimesOf(stage)) {
        if (Plant().FirstMode(stage) > 0.0)
          cautious.filters =
              Points().FiltersAt({kStartLowPassPower, kStartLowPassDamping, kStartNotchPower,
                                  kStartNotchZerosDamping, kStartNotchPolesDamping, kStartGyroWeight},
                                 stage, at_s);
        at_times.push_back(cautious);
      }
      ApplyDesign(at_times, stage, campaign_.autopilot);
    }
    ApplyDesign(kStartAugmentation, campaign_.autopilot);
    start_ = std::make_unique<CampaignFlights>(campaign_);
    // The instants are those of the rigid vehicle. The flexible one may be lost while it is not tuned.
    Campaign rigid = campaign_;
    if (rigid.vehicle.structure_beam) rigid.vehicle.structure_beam->flown_modes = 0;
    const CampaignFlights held(rigid);
    std::vector<MarginInstant> instants = MarginInstants(held.model());
    skipped_ = SkippedInstants(held.model());
    start_loss_ = NominalLoss(held.FlyNominal());
    if (options.dispersed > 0)
      held_.emplace(Plant(), instants, CampaignFlights(Stiff(rigid)), options.dispersed);
    margins_.emplace(Plant(), std::move(instants));
  }

  TuningResult Run(const TuningObserver& observer) {
    TuningResult result;
    result.feasible = true;
    result.skipped = skipped_;
    result.start_loss = start_loss_;
    for (int stage = 0; stage < Plant().StageCount(); ++stage) {
      result.stages.push_back(TuneStage(stage, observer, result.evaluations));
      result.feasible = result.feasible && result.stages.back().feasible;
    }
    if (result.feasible && IsAugmented(campaign_.autopilot)) {
      result.augmentation = TuneAugmentation(observer, result.evaluations);
      result.feasible = result.augmentation->feasible;
    }
    result.flights = flights_;
    result.autopilot = campaign_.autopilot;
    result.nominal_loss = NominalLoss(CampaignFlights(campaign_).FlyNominal());
    result.feasible = result.feasible && result.nominal_loss.empty();
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
  TunedPlant Plant() const { return {campaign_, start_->model()}; }
  StagePoints Points() const { return {Plant(), options_}; }
  FlightModel ModelWith(const AutopilotConfig& autopilot) const {
    return start_->model().WithAutopilot(autopilot);
  }

  std::vector<FlightResult> FlyCases(const FlightModel& model) {
    std::vector<FlightOrder> orders(campaign_.sampling.cases);
    for (std::uint64_t i = 0; i < orders.size(); ++i) {
      orders[i].inputs = start_->Draw(i);
      orders[i].options.case_index = i;
    }
    flights_ += orders.size();
    return FlyAll(model, orders);
  }

  // For the design in campaign_: the constraint that is missed by most. `violations` are in the order of
  // Evaluate().
  std::string MissedBy(const std::vector<double>& violations, int stage) const {
    const auto most = std::max_element(violations.begin(), violations.end());
    const std::size_t kind = static_cast<std::size_t>(most - violations.begin());
    const std::size_t margins = options_.dispersed > 0 ? 1 : 6;
    if (kind >= margins) return MissedInFlight(kind - margins, *most);
    return options_.dispersed > 0 ? held_->Missed(stage) : margins_->Missed(kind % 3, kind >= 3, stage);
  }

  // The constraints of FlyCandidate.
  std::string MissedInFlight(std::size_t kind, double violation) const {
    if (kind == 0)
      return fmt::format("{:.0f} of {} flights are lost", violation * options_.cases, options_.cases);
    return fmt::format("a deflection oscillates by {:.2f} deg, {:.2f} deg is allowed",
                       (1.0 + violation) * kLimitCycleLimit_deg, kLimitCycleLimit_deg);
  }

  // A rigid vehicle with an autopilot that follows the reference even if the aerodynamic instability is
  // doubled.
  Campaign Stiff(Campaign rigid) const {
    for (AxisConfig* axis : {&rigid.autopilot.pitch, &rigid.autopilot.yaw, &rigid.autopilot.roll}) {
      axis->filters.clear();
      axis->schedule.clear();
    }
    for (int stage = 0; stage < Plant().StageCount(); ++stage)
      ApplyDesign(
          StageDesign{
              kStiffBandwidthOfActuator * Plant().ActuatorOf(stage), kStartDamping, kStartLearning, {}},
          stage, rigid.autopilot);
    return rigid;
  }

  // The designs at a point of the search. The point's first variable is the bandwidth as a fraction of the
  // largest admissible one. If no bandwidth is admissible, the lowest is used, and its margins tell by how
  // much they miss.
  std::vector<StageDesign> DesignOf(const std::vector<double>& point, int stage) const {
    const std::vector<double> times = Plant().TimesOf(stage);
    std::vector<StageDesign> designs;
    for (std::size_t k = 0; k < times.size(); ++k)
      designs.push_back(options_.dispersed > 0 ? HeldDesign(point, stage, k)
                                               : NominalDesign(point, stage, times[k]));
    return designs;
  }

  // The design for a time of a stage's schedule, judged as if it held for the whole stage. It has the largest
  // bandwidth, and a damping, with which the held plants about that time meet their gates. If there is none,
  // it has those with the largest surplus.
  StageDesign HeldDesign(const std::vector<double>& point, int stage, std::size_t time) const {
    const std::vector<double> times = Plant().TimesOf(stage);
    StageDesign design = Points().ShapeOf(point, stage, times[time]), best = design;
    const double damping = design.damping;
    AutopilotConfig autopilot = campaign_.autopilot;
    double most = -HUGE_VAL;
    std::size_t last = 0;
    for (double w = kHeldBandwidthOfActuator.high * Plant().ActuatorOf(stage);
         w > kHeldBandwidthOfActuator.low * Plant().ActuatorOf(stage) && most < 0.0;
         w *= kHeldBandwidthStep) {
      for (const double factor : kDampingFactors) {
        if (times.size() == 1 && factor != 1.0) break;
        design.bandwidth_rad_s = w;
        design.damping = factor * damping;
        ApplyDesign(std::vector<StageDesign>(times.size(), design), stage, autopilot);
        // A surplus below kWorstSurplus is not worth computing exactly.
        const double surplus =
            held_->SurplusOf(autopilot, stage, &last, std::clamp(most, kWorstSurplus, 0.0), time);
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

  // Improves the design of one time if the common shape misses the gates there. A random walk changes
  // bandwidth, damping, integral and filters, and keeps each improvement. Steps grow after success and shrink
  // after failure. The walk does not depend on earlier points of the search.
  void Refine(int stage, std::size_t time, double most, StageDesign& best) const {
    const std::size_t times = Plant().TimesOf(stage).size();
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
      const double surplus = held_->SurplusOf(autopilot, stage, &last, most, time);
      const bool better = surplus > most;
      size *= better ? kRefinementGrowth : kRefinementDecay;
      if (!better) continue;
      most = surplus;
      best = next;
    }
  }

  StageDesign NominalDesign(const std::vector<double>& point, int stage, double at_s) const {
    StageDesign design = Points().ShapeOf(point, stage, at_s);
    const std::size_t times = Plant().TimesOf(stage).size();
    AutopilotConfig autopilot = campaign_.autopilot;
    const double lowest_rad_s = kBandwidthOfActuator.low * Plant().ActuatorOf(stage);
    double w = kBandwidthOfActuator.high * Plant().ActuatorOf(stage);
    std::size_t failed_last = 0;
    for (; w > lowest_rad_s; w *= kBandwidthStep) {
      design.bandwidth_rad_s = w;
      ApplyDesign(std::vector<StageDesign>(times, design), stage, autopilot);
      if (margins_->Suffice(autopilot, stage, &failed_last)) break;
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
      violations.push_back(std::max(0.0, -held_->SurplusOf(candidate, stage, &last, -HUGE_VAL)));
    } else {
      AddViolations(margins_->LeastOf(candidate, stage, false), violations);
      AddViolations(margins_->LeastOf(candidate, stage, true), violations);
    }
    if (!AllZero(violations)) return evaluation;

    FlyCandidate(ModelWith(candidate), "_stage" + std::to_string(stage + 1) + "_deg", evaluation);
    return evaluation;
  }

  // Adds objective, tie-breaker and constraints from flights of the cases. `suffix` is that of the pitch
  // error metrics.
  void FlyCandidate(const FlightModel& candidate, const std::string& suffix, Evaluation& evaluation) {
    double sum_deg = 0.0, lost = 0.0, cycle_deg = 0.0;
    for (const FlightResult& flown : FlyCases(candidate)) {
      // Some metrics of a lost flight are undefined.
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

  // `part` is the stage of TuningRecord.
  GeneticAlgorithmResult Minimize(const BoundedProblem& problem, int part,
                                  const TuningObserver& observer) const {
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
      for (const MeasuredMargins& m : MeasureMargins(candidate))
        AddViolations(m, evaluation.constraint_violations);
      if (AllZero(evaluation.constraint_violations)) FlyCandidate(candidate, "_deg", evaluation);
      return evaluation;
    };
    const GeneticAlgorithmResult found = Minimize(problem, Plant().StageCount(), observer);

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

  // For the augmentation in campaign_: one constraint for each stage, then those of flight.
  std::string MissedByAugmentation(const std::vector<double>& violations) const {
    const auto most = std::max_element(violations.begin(), violations.end());
    const std::size_t kind = static_cast<std::size_t>(most - violations.begin());
    const std::vector<MeasuredMargins> measured = MeasureMargins(ModelWith(campaign_.autopilot));
    if (kind >= measured.size()) return MissedInFlight(kind - measured.size(), *most);
    const MeasuredMargins& m = measured[kind];
    return fmt::format(
        "measured margins of stage {}: gain {:.1f} dB up, {:.1f} dB down, delay {:.0f} ms; {:.1f} dB and "
        "{:.0f} ms are needed",
        m.stage + 1, m.gain_up_db, m.gain_down_db, 1e3 * m.delay_s, kGainMarginGate_db,
        1e3 * kDelayMarginGate_s);
  }

  StageTuning TuneStage(int stage, const TuningObserver& observer, std::uint64_t& evaluations) {
    BoundedProblem problem = Points().ProblemOf(stage);
    problem.evaluate = [&](const std::vector<double>& point) { return Evaluate(point, stage); };
    const GeneticAlgorithmResult found = Minimize(problem, stage, observer);

    StageTuning tuned;
    const std::vector<StageDesign> designs = DesignOf(found.variables, stage);
    tuned.design = designs.front();
    ApplyDesign(designs, stage, campaign_.autopilot);
    tuned.feasible = AllZero(found.evaluation.constraint_violations);
    tuned.mean_rms_deg = found.evaluation.objective;
    tuned.peak_deg = found.evaluation.tie_breaker;
    tuned.frozen = margins_->LeastOf(campaign_.autopilot, stage, false);
    tuned.adapting = margins_->LeastOf(campaign_.autopilot, stage, true);
    if (options_.dispersed > 0) {
      std::size_t last = 0;
      tuned.surplus = held_->SurplusOf(campaign_.autopilot, stage, &last, -HUGE_VAL);
    }
    if (!tuned.feasible) tuned.missed = MissedBy(found.evaluation.constraint_violations, stage);
    evaluations += found.evaluations;
    return tuned;
  }

  const TuningOptions& options_;
  Campaign campaign_;  ///< its autopilot is tuned as far as the search has come
  std::unique_ptr<CampaignFlights>
      start_;  ///< all stages untuned; margins are computed about its nominal flight
  std::vector<SkippedInstant> skipped_;
  std::string start_loss_;
  std::optional<NominalMargins> margins_;
  std::optional<HeldPlants> held_;  ///< set if dispersed plants are held
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
  CheckTuning(campaign, autopilot, options);
  return Tuner(campaign, autopilot, options).Run(observer);
}

}  // namespace dispersa
