// Two campaigns compared: the output of `dispersa compare`, compare.json and compare.html.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/results/case_columns.h"
#include "core/results/metric_catalogue.h"
#include "core/statistics/intervals.h"
#include "core/statistics/limits.h"
#include "core/statistics/summary.h"

namespace dispersa {

/// One of the two campaigns, as it was flown.
struct ComparedCampaign {
  std::string folder;  ///< as the user named it: where the replay commands find it
  std::string engine;
  const Campaign& campaign;
  const CaseColumns& cases;                  ///< with all inputs
  std::optional<std::uint64_t> to_fly = {};  ///< CasesToFly(); none: all of the campaign's cases
};

/// A value of campaign.yaml that differs between the two.
struct CampaignChange {
  std::string path;  ///< "dispersions.wind.max_speed_m_s"
  std::string a, b;  ///< "–" if the file has no such value
};

/// Whether case i of one campaign got the same draws as case i of the other.
struct Pairing {
  bool paired = false;
  std::size_t shared = 0;  ///< case indices with a result in both; if paired, the number of pairs
  std::size_t only_a = 0;
  std::size_t only_b = 0;
  std::vector<std::string>
      same;  ///< inputs that vary from case to case and are equal, bit for bit, in every shared case
  struct ChangedInput {
    std::string input;
    std::string key;        ///< its name in campaign files
    std::size_t cases = 0;  ///< shared cases in which the input differs
  };
  std::vector<ChangedInput> changed;
  std::string sentence;
};

/// b against a in one percentile.
struct PercentileComparison {
  std::string name;  ///< "p99"
  double probability = 0.0;
  double a = kUndefined, b = kUndefined;
  double difference = kUndefined;
  Interval interval{kUndefined, kUndefined};
  double p = kUndefined;
  double p_holm = kUndefined;  ///< over the metrics, for this percentile
};

/// A metric's values by row of each campaign; NaN: lost, or not defined. Magnitudes if the metric is worse
/// farther from zero. On a circle both near to their centres, and those within half a turn of each other, so
/// that differences do not run around the circle.
struct ComparedValues {
  std::vector<double> a, b;
};
ComparedValues ValuesToCompare(const CaseColumns& a, const CaseColumns& b, const std::string& metric);

/// One metric. A flight that was not completed counts as worse than any value. If a metric is neither good
/// nor bad, such flights are left out. If a metric is worse farther from zero, its magnitude is compared.
struct MetricComparison {
  std::string metric;
  MetricInfo info;
  std::size_t n_a = 0, n_b = 0;  ///< flights compared: with a value, or lost
  std::size_t lost_a = 0, lost_b = 0;
  std::size_t undefined = 0;  ///< completed flights, or pairs, in which the metric is not defined
  /// Paired: the median of b - a with limits by order statistics of the differences, and the sign test.
  /// Unpaired: the difference of the medians with limits by DifferenceLimits(), and the rank sum.
  double median_a = kUndefined, median_b = kUndefined;
  double difference = kUndefined;
  Interval interval{kUndefined, kUndefined};
  double ratio = kUndefined;  ///< paired, all values positive: median of b / a
  Interval ratio_interval{kUndefined, kUndefined};
  std::size_t b_better = 0, a_better = 0,
              equal =
                  0;  ///< numbers of pairs; if the metric is neither good nor bad: b smaller, b larger, equal
  double tendency = kUndefined;  ///< unpaired: TendencyOf(), the direction of the rank sum
  double p = kUndefined;
  double p_holm = kUndefined;  ///< over the metrics
  std::vector<PercentileComparison> tails;
  /// What a difference is measured by, in the metric's unit: the smallest limit of a requirement (of a range:
  /// its width; of a metric that is neither good nor bad a range alone), or without one the spread from 5 to
  /// 95 % of A; if A does not spread, from the least to the greatest value of both. A difference matters from
  /// practical_share of it on.
  double scale = 0.0;
  std::string scale_of = {};  ///< "limit", "spread" (of A), "range" (of both)
  /// The largest difference that is certain and matters, of the median or of a tail, as a share of the scale.
  /// Infinite: the median is that of a lost flight. 0: none.
  double effect = 0.0;
  std::string effect_in = {};       ///< "median", "p99"; empty: none
  std::string finding;              ///< "better", "worse" (of b), "differs", kTooSmall, "not shown"
  std::string found_in = "median";  ///< what the finding is about: the largest difference that is certain
  double found_p = kUndefined;      ///< its p_holm
  /// Counted in the sentence: neither a part of another metric (a stage's), nor a value whose error is
  /// compared.
  bool is_counted = true;
  struct Pair {
    std::uint64_t case_index = 0;
    double a = kUndefined, b = kUndefined;  ///< NaN: lost flight
  };
  std::vector<Pair> gains, losses;  ///< the pairs in which b gains most, and loses most
};

/// Differences of the median or of tails are certain, and all smaller than MetricComparison::least.
inline constexpr char kTooSmall[] = "too small to matter";
/// The share that decides MetricComparison::least if nobody states another.
inline constexpr double kPracticalShare = 0.01;

/// One limit, applied to the flights of both campaigns, even if only one states it. `n` is 0 if the
/// campaign's flights do not have the metric.
struct RequirementComparison {
  std::string metric;
  std::string words;  ///< "pitch_error_peak_deg below 0.5"
  bool in_a = false, in_b = false;
  std::size_t n_a = 0, n_b = 0;
  std::size_t failures_a = 0, failures_b = 0;
  /// Pairs: McNemar's table.
  std::size_t both_meet = 0, only_a_fails = 0, only_b_fails = 0, both_fail = 0;
  double difference = kUndefined;  ///< of the failure rates, b - a
  Interval interval{kUndefined, kUndefined};
  double p = kUndefined;       ///< paired: exact McNemar test; unpaired: Fisher's exact test
  double p_holm = kUndefined;  ///< over the requirements
  std::string finding;         ///< "better", "worse" (of b), "not shown"
};

/// A pair in which one campaign meets a requirement, or completes the flight, and the other does not.
struct ChangedCase {
  std::uint64_t case_index = 0;
  Outcome outcome_a = Outcome::kCompleted, outcome_b = Outcome::kCompleted;
  struct Reason {
    std::string requirement;  ///< RequirementComparison::words, or "flight completed"
    double a = kUndefined, b = kUndefined;
    Limits limits = {};
  };
  std::vector<Reason> reasons;
};

struct Comparison {
  struct Side {
    std::string folder, name, id, flight_id, engine, vehicle, reference, autopilot, sampling;
    std::uint64_t seed = 0;
    std::uint64_t cases = 0;  ///< CasesToFly()
    std::size_t flown = 0, completed = 0;
    bool has_its_law = true;  ///< false: flown with a control law in Python, which the folder does not hold
    std::string nominal_loss = {};  ///< NominalLoss(); empty: it was completed, or is not known
  };
  Side a, b;
  std::vector<CampaignChange> changes;
  std::string differs;  ///< "vehicle (3 values) and dispersions (1 value)": what `changes` are of
  double practical_share = kPracticalShare;
  Pairing pairing;
  bool independent = true;  ///< both are random samples; otherwise differences have no limits and no p-values
  std::vector<MetricComparison> metrics;
  std::vector<RequirementComparison> requirements;
  /// Limits that a vehicle brings and that neither campaign requires: flights beyond each, lost or not.
  struct LoadCheck {
    std::string metric;
    std::size_t failures_a = 0, failures_b = 0;
  };
  std::vector<LoadCheck> load_checks;
  std::vector<ChangedCase> harmed;  ///< met in a and not in b, ascending; empty if unpaired
  std::vector<ChangedCase> rescued;
  /// By the requirements that differ ("better", "worse" (of b), "mixed"). If none differs, by the counted
  /// metric with the largest effect ("better", "worse", or "differs" if no metric is either), or "no relevant
  /// difference". "not judged" of chosen points.
  std::string finding;
  std::string sentence;  ///< the result in words
};

inline constexpr double kComparisonConfidence = 0.95;

/// `metrics` are names without prefix. If empty, every metric that a flight of both campaigns defines is
/// compared. Inputs: only the changed ones and the best matched ones are listed, and never more than the
/// flights show.
Comparison Compare(const ComparedCampaign& a, const ComparedCampaign& b,
                   const std::vector<std::string>& metrics, std::vector<CampaignChange> changes,
                   double practical_share = kPracticalShare);

/// "A (smoke) is incomplete: 160 of 3000 cases have a result", for each side that lacks cases.
std::vector<std::string> IncompleteSides(const Comparison& comparison);

/// The metrics with an effect, the largest first, and then the others in their order.
std::vector<const MetricComparison*> ByEffect(const Comparison& comparison);

/// "8.8 % of the limit", "9.6 times the spread of A": MetricComparison::effect, if it is finite.
std::string ShareOfScale(const MetricComparison& metric);

/// "median 0.011 in A, 0.055 in B: a change by 8.8 % of the limit"; empty if the metric has no effect.
std::string EffectWords(const MetricComparison& metric);

/// The last part of the folder's path; the whole path where the last parts are equal.
std::string SideTitle(const Comparison& comparison, const Comparison::Side& side);

/// "dispersa replay FOLDER --case N", for the shell and the folder in which the comparison was started.
std::string ReplayCommand(const std::string& folder, std::uint64_t case_index);
/// Empty if the folder does not hold the control law.
std::string ReplayCommand(const Comparison::Side& side, std::uint64_t case_index);

/// The contents of compare.json: schema "dispersa/compare/1".
std::string ComparisonJson(const Comparison& comparison);

/// The contents of compare.html: one file, readable offline and on paper.
std::string ComparisonPage(const Comparison& comparison, const CaseColumns& a, const CaseColumns& b);

}  // namespace dispersa
