#include "core/report/requirement_summary.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/report/metric_catalogue.h"
#include "core/report/sampling_text.h"
#include "core/report/text.h"
#include "core/statistics/requirement.h"
#include "core/statistics/summary.h"

namespace dispersa {
namespace {

const char* VerdictName(Verdict verdict) {
  switch (verdict) {
    case Verdict::kPass:
      return "pass";
    case Verdict::kFail:
      return "fail";
    case Verdict::kInconclusive:
      return "inconclusive";
  }
  return "";
}

std::string Plural(std::int64_t count, const char* noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string IndependentSentence(const RequirementSummary& summary, std::int64_t missing) {
  const std::string required = PercentText(summary.probability);
  const std::string confidence = PercentText(1.0 - summary.consumer_risk);
  const std::string seen =
      fmt::format("{} in {}{}", Plural(summary.failures, "failure"), Plural(summary.n, "case"),
                  missing > 0 ? fmt::format(" ({} without a result)", missing) : "");
  if (summary.verdict == "pass") {
    return fmt::format("Met: {} show a probability of at least {} with {} confidence; {} is required.", seen,
                       PercentText(*summary.success_lower), confidence, required);
  }
  if (summary.verdict == "fail") {
    return fmt::format("Not met: {} show a probability of at most {} with {} confidence; {} is required.",
                       seen, PercentText(*summary.success_upper), confidence, required);
  }
  return fmt::format(
      "Not decided: {} show a probability of at least {} with {} confidence, short of the {} required; "
      "that takes {} cases in all if no further one fails.",
      seen, PercentText(*summary.success_lower), confidence, required, *summary.cases_needed);
}

/// The points that have no result count as failed for a pass and as met for a fail.
const char* EnumeratedVerdict(const RequirementResult& result, double probability) {
  const auto all = static_cast<double>(result.n + result.missing);
  const auto met = static_cast<double>(result.n - result.failures);
  if (all > 0.0 && met >= probability * all) return "pass";
  return met + static_cast<double>(result.missing) < probability * all ? "fail" : "inconclusive";
}

std::string EnumeratedSentence(const RequirementSummary& summary, std::int64_t missing) {
  return fmt::format(
      "Design study: {} of {} flown points meet the limit{}; {} of them are required. This says nothing "
      "about "
      "the probability in flight.",
      summary.n - summary.failures, summary.n,
      missing > 0 ? fmt::format(" ({} have no result)", missing) : "", PercentText(summary.probability));
}

std::string SpaceFillingSentence(const RequirementSummary& summary) {
  return fmt::format(
      "Design study: {} of {} points meet the limit. Binomial confidence limits do not hold for this "
      "design{}; fly Monte Carlo for a verdict.",
      summary.n - summary.failures, summary.n,
      summary.verdict == "fail" ? ", but so many failures leave no doubt" : "");
}

}  // namespace

RequirementSummary Judge(const Requirement& requirement, SamplingMethod method, const CaseColumns& cases,
                         std::int64_t missing) {
  RequirementSummary summary;
  summary.metric = requirement.metric;
  summary.below = requirement.below.has_value();
  summary.limit = summary.below ? *requirement.below : requirement.above.value();
  summary.probability = requirement.probability;
  summary.consumer_risk = requirement.consumer_risk;

  const std::vector<std::string>& names = MetricNames();
  const auto metric =
      static_cast<std::size_t>(std::find(names.begin(), names.end(), requirement.metric) - names.begin());
  std::vector<double> values = cases.metrics.at(metric);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (cases.outcome[i] == Outcome::kCompleted) continue;
    values[i] = kUndefined;
    ++summary.lost_flights;
  }
  const ProbabilityRequirement criterion{.side = summary.below ? Side::kBelow : Side::kAbove,
                                         .limit = summary.limit,
                                         .probability = summary.probability,
                                         .consumer_risk = summary.consumer_risk};
  const RequirementResult result = Evaluate(criterion, values, missing);
  summary.n = result.n;
  summary.failures = result.failures;

  if (IsIndependent(method)) {
    summary.verdict = VerdictName(result.verdict);
    summary.success_lower = result.success_lower;
    summary.success_upper = result.success_upper;
    summary.cases_needed = result.cases_needed;
    summary.sentence = IndependentSentence(summary, missing);
  } else if (IsEnumerated(method)) {
    summary.verdict = EnumeratedVerdict(result, summary.probability);
    summary.sentence = EnumeratedSentence(summary, missing);
  } else {
    summary.verdict = result.verdict == Verdict::kFail ? "fail" : "inconclusive";
    summary.sentence = SpaceFillingSentence(summary);
  }
  return summary;
}

}  // namespace dispersa
