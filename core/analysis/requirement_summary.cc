#include "core/analysis/requirement_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/results/metric_catalogue.h"
#include "core/results/sampling_text.h"
#include "core/results/text.h"
#include "core/statistics/intervals.h"
#include "core/statistics/order_statistics.h"
#include "core/statistics/replicates.h"
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

/// A case of a requirement: what it measured, undefined when the flight was lost.
std::vector<double> ValuesOf(const Requirement& requirement, const CaseColumns& cases) {
  std::vector<double> values = MeasuredValues(cases, requirement.metric);
  if (!LossFails(requirement)) return values;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (cases.outcome[i] != Outcome::kCompleted) values[i] = kUndefined;
  }
  return values;
}

CaseTally TallyOf(const Limits& limits, const std::vector<double>& values, const CaseColumns& cases,
                  std::uint64_t all) {
  CaseTally tally;
  std::uint64_t next = 0;
  const auto skip_to = [&](std::uint64_t index) {
    for (; next < index; ++next) tally.missing.push_back(static_cast<std::int64_t>(next));
  };
  for (std::size_t i = 0; i < values.size(); ++i) {
    skip_to(cases.index[i]);
    next = cases.index[i] + 1;
    if (!limits.Meets(values[i])) tally.failed.push_back(static_cast<std::int64_t>(cases.index[i]));
  }
  skip_to(all);
  return tally;
}

/// The order statistic behind a verdict: with at most `accept` failures it passes, so that the (accept +
/// 1)-th worst of all cases is a bound of the share required. Missing cases are worse than any.
void SetBound(const Limits& limits, std::vector<double> values, std::int64_t accept, std::int64_t missing,
              RequirementSummary& summary) {
  const std::int64_t rank = accept - missing;
  if (rank < 0 || rank >= std::ssize(values)) return;
  // A lost flight is worse than any value.
  const auto badness = [&](double value) { return std::isfinite(value) ? -limits.Margin(value) : HUGE_VAL; };
  const auto nth = values.begin() + rank;
  std::nth_element(values.begin(), nth, values.end(),
                   [&](double a, double b) { return badness(a) > badness(b); });
  if (!std::isfinite(*nth)) return;
  summary.bound = *nth;
  summary.margin = limits.Margin(*nth);
}

void SetPassChances(RequirementSummary& summary) {
  if (summary.n == 0) return;
  const double rate = static_cast<double>(summary.failures) / static_cast<double>(summary.n);
  // From the least number that can pass up, in steps that show the rise, to where it has saturated.
  const auto least = static_cast<double>(CasesNeeded(summary.probability, summary.consumer_risk, 0));
  for (const double factor : {1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 32.0}) {
    const auto cases = static_cast<std::int64_t>(std::ceil(least * factor));
    const double probability = PassProbability(summary.probability, summary.consumer_risk, cases, rate);
    summary.pass_chances.push_back({cases, probability});
    if (probability > 0.995) break;
  }
}

void SetConvergence(const CaseTally& tally, const CaseColumns& cases, RequirementSummary& summary) {
  constexpr double kRatio = 1.15;
  const auto all = std::ssize(cases.index);
  const double confidence = 1.0 - summary.consumer_risk;
  for (std::int64_t n = std::min<std::int64_t>(10, all); n > 0;) {
    const auto last = static_cast<std::int64_t>(cases.index[static_cast<std::size_t>(n - 1)]);
    const auto failures =
        std::upper_bound(tally.failed.begin(), tally.failed.end(), last) - tally.failed.begin();
    summary.convergence.push_back({n, failures, ClopperPearsonLower(n - failures, n, confidence),
                                   ClopperPearsonUpper(n - failures, n, confidence)});
    if (n == all) break;
    n = std::min(all, static_cast<std::int64_t>(std::ceil(kRatio * static_cast<double>(n))));
  }
}

std::string PlanSentence(const RequirementSummary& summary) {
  switch (summary.plan.kind) {
    case PlanKind::kFixed:
      return fmt::format("one look at {} cases", summary.planned);
    case PlanKind::kGroupSequential:
      return fmt::format("{} looks up to {} cases", summary.plan.looks, summary.planned);
    case PlanKind::kAnytime:
      return "looks at any time";
  }
  return "";
}

/// The first new campaign of the list that would pass with 90 %, in words.
std::string ChanceWords(const RequirementSummary& summary) {
  if (summary.pass_chances.empty()) return "";
  const auto enough = std::find_if(summary.pass_chances.begin(), summary.pass_chances.end(),
                                   [](const auto& chance) { return chance.probability >= 0.9; });
  if (enough == summary.pass_chances.end()) {
    return " At the failure rate seen here a larger campaign is not likely to pass either.";
  }
  return fmt::format(
      " At the failure rate seen here a new campaign of {} cases passes with a probability of {}.",
      enough->cases, PercentText(enough->probability));
}

std::string IndependentSentence(const RequirementSummary& summary, std::int64_t missing) {
  const std::string required = PercentText(summary.probability);
  const std::string confidence = PercentText(1.0 - summary.consumer_risk);
  const std::string seen =
      fmt::format("{} in {}{}", Plural(summary.failures, "failure"), Plural(summary.n, "case"),
                  missing > 0 ? fmt::format(" ({} without a result)", missing) : "");
  std::string sentence;
  // The bounds of a plan of several looks hold at every look, and are wider than what this one decides by.
  if (summary.verdict == "pass" && *summary.success_lower >= summary.probability) {
    sentence = fmt::format("Met: {} show a probability of at least {} with {} confidence; {} is required.",
                           seen, PercentText(*summary.success_lower), confidence, required);
  } else if (summary.verdict == "pass") {
    sentence = fmt::format("Met by its plan ({}): {} at a risk of {}; {} is required.", PlanSentence(summary),
                           seen, PercentText(summary.consumer_risk), required);
  } else if (summary.verdict == "fail" && *summary.success_upper <= summary.probability) {
    sentence = fmt::format("Not met: {} show a probability of at most {} with {} confidence; {} is required.",
                           seen, PercentText(*summary.success_upper), confidence, required);
  } else if (summary.verdict == "fail") {
    sentence = fmt::format("Not met by its plan ({}): {} at a risk of {}; {} is required.",
                           PlanSentence(summary), seen, PercentText(summary.consumer_risk), required);
  } else if (summary.contradicted) {
    sentence = fmt::format(
        "Not decided: one look met the requirement and another one did not, with {} in all; {} is required.",
        seen, required);
  } else {
    sentence = fmt::format(
        "Not decided: {} show a probability of {} to {}, either bound with {} confidence; {} is required.",
        seen, PercentText(*summary.success_lower), PercentText(*summary.success_upper), confidence, required);
    sentence += ChanceWords(summary);
  }
  if (summary.verdict != "inconclusive" && summary.looks.back().verdict != Verdict::kInconclusive) {
    const auto first = std::find_if(summary.looks.begin(), summary.looks.end(),
                                    [](const Look& look) { return look.verdict != Verdict::kInconclusive; });
    if (first->n < summary.looks.back().n)
      sentence += fmt::format(" Decided by the look at {} cases, with {}.", first->n,
                              Plural(first->failures, "failure"));
  }
  if (summary.beyond_plan) {
    sentence += fmt::format(
        " Beyond the plan ({}): read as if each look were the only one, these looks pass a design that just "
        "misses with a probability of {}, not {}; the verdict spends only what the plan left of its risk.",
        PlanSentence(summary), PercentText(*summary.naive_risk), PercentText(summary.consumer_risk));
  }
  return sentence;
}

std::string StudySentence(const RequirementSummary& summary, const JudgingContext& context) {
  const std::int64_t met = summary.n - summary.failures;
  std::string sentence = fmt::format("Design study: {} of {} points meet the limit", met, summary.n);
  if (context.cases > static_cast<std::uint64_t>(summary.n))
    sentence += fmt::format(", {} have no result", context.cases - static_cast<std::uint64_t>(summary.n));
  if (context.design_points > context.cases)
    sentence += fmt::format("; the design has {} points and is incomplete", context.design_points);
  sentence += ". The points are chosen, not drawn independently";
  if (summary.success_lower) {
    return sentence +
           fmt::format(
               " within a design; its {} independent replicates show a probability of {} to {}, either bound "
               "with {} confidence.",
               context.replicates, PercentText(*summary.success_lower), PercentText(*summary.success_upper),
               PercentText(1.0 - summary.consumer_risk));
  }
  return sentence + ": this says nothing about the probability in flight.";
}

/// Bounds of the failure probability from the failures in each replicate.
Interval BoundsOfReplicates(const CaseTally& tally, const JudgingContext& context, double risk) {
  const auto points = static_cast<std::int64_t>(context.cases / context.replicates);
  std::vector<std::int64_t> counts(context.replicates, 0);
  for (const std::int64_t index : tally.failed) ++counts[static_cast<std::size_t>(index / points)];
  return ReplicateBounds(counts, points, risk);
}

}  // namespace

std::string LimitWords(const RequirementSummary& requirement, const std::string& unit) {
  const std::string suffix = unit.empty() ? "" : " " + unit;
  if (requirement.low_limit) {
    return fmt::format("between {} and {}{}", ReadableText(*requirement.low_limit),
                       ReadableText(requirement.limit), suffix);
  }
  return fmt::format("{} {}{}", requirement.below ? "below" : "above", ReadableText(requirement.limit),
                     suffix);
}

std::string RequirementWords(const RequirementSummary& requirement) {
  return fmt::format("{} {} for {} of flights at {} risk", requirement.metric, LimitWords(requirement, ""),
                     PercentText(requirement.probability), PercentText(requirement.consumer_risk));
}

std::vector<RequirementSummary> JudgeAll(const std::vector<Requirement>& requirements,
                                         const JudgingContext& context, const CaseColumns& cases) {
  std::vector<RequirementSummary> summaries;
  std::vector<PlannedRequirement> planned;
  std::vector<CaseTally> tallies;
  const std::int64_t missing = static_cast<std::int64_t>(context.cases) - std::ssize(cases.index);
  for (const Requirement& requirement : requirements) {
    const Limits limits = LimitsOf(requirement);
    RequirementSummary summary;
    summary.metric = requirement.metric;
    summary.by_default = requirement.by_default;
    summary.below = !requirement.above.has_value();
    summary.limit = summary.below ? limits.high : limits.low;
    if (requirement.within) summary.low_limit = limits.low;
    summary.probability = requirement.probability;
    summary.consumer_risk = requirement.consumer_risk;
    summary.plan = requirement.plan;
    summary.planned = context.planned;
    tallies.push_back(TallyOf(limits, ValuesOf(requirement, cases), cases, context.cases));
    summary.n = std::ssize(cases.index);
    summary.failures = std::ssize(tallies.back().failed);
    if (LossFails(requirement)) summary.lost_flights = static_cast<std::int64_t>(LostCount(cases));
    summary.post_hoc =
        !context.registered.empty() && std::find(context.registered.begin(), context.registered.end(),
                                                 RequirementLine(requirement)) == context.registered.end();
    planned.push_back(
        {requirement.probability, requirement.consumer_risk, requirement.plan, context.planned});
    summaries.push_back(std::move(summary));
  }

  if (!IsIndependent(context.method)) {
    for (std::size_t i = 0; i < summaries.size(); ++i) {
      RequirementSummary& summary = summaries[i];
      summary.verdict = "study";
      if (context.replicates > 1 && missing == 0) {
        const Interval failure = BoundsOfReplicates(tallies[i], context, summary.consumer_risk);
        summary.success_lower = 1.0 - failure.upper;
        summary.success_upper = 1.0 - failure.lower;
      }
      summary.sentence = StudySentence(summary, context);
    }
    return summaries;
  }
  if (context.cases == 0) return summaries;
  const std::vector<PlannedVerdict> verdicts =
      DecideAll(planned, context.holm, static_cast<std::int64_t>(context.cases), tallies, context.past_looks);
  for (std::size_t i = 0; i < summaries.size(); ++i) {
    RequirementSummary& summary = summaries[i];
    const PlannedVerdict& verdict = verdicts[i];
    summary.verdict = VerdictName(verdict.verdict);
    summary.success_lower = verdict.success_lower;
    summary.success_upper = verdict.success_upper;
    summary.cases_needed = verdict.cases_needed;
    summary.looks = verdict.looks;
    if (verdict.boundary.accept >= 0) summary.accepts = verdict.boundary.accept;
    if (verdict.boundary.reject <= verdict.boundary.n) summary.rejects = verdict.boundary.reject;
    summary.contradicted = verdict.contradicted;
    summary.beyond_plan = verdict.beyond_plan;
    summary.naive_risk = verdict.naive_risk;
    SetBound(LimitsOf(requirements[i]), ValuesOf(requirements[i], cases), verdict.boundary.accept, missing,
             summary);
    SetPassChances(summary);
    SetConvergence(tallies[i], cases, summary);
    summary.sentence = IndependentSentence(summary, missing);
  }
  return summaries;
}

RequirementSummary Judge(const Requirement& requirement, SamplingMethod method, const CaseColumns& cases,
                         std::int64_t missing) {
  JudgingContext context;
  context.method = method;
  context.cases = cases.rows() + static_cast<std::uint64_t>(missing);
  context.planned = static_cast<std::int64_t>(context.cases);
  // Rows may be some of a campaign's cases: here they are the first ones, whatever their numbers were.
  CaseColumns numbered = cases;
  std::iota(numbered.index.begin(), numbered.index.end(), std::uint64_t{0});
  return JudgeAll({requirement}, context, numbered).front();
}

}  // namespace dispersa
