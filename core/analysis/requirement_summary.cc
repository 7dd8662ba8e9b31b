#include "core/analysis/requirement_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/results/metric_catalogue.h"
#include "core/results/sampling_text.h"
#include "core/results/text.h"
#include "core/statistics/anytime.h"
#include "core/statistics/group_sequential.h"
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
  const auto nth = values.begin() + rank;
  std::nth_element(values.begin(), nth, values.end(),
                   [&](double a, double b) { return limits.IsWorse(a, b); });
  if (!std::isfinite(*nth)) return;
  summary.bound = *nth;
  summary.margin = limits.Margin(*nth);
}

void SetWorst(const Limits& limits, const std::vector<double>& values, const CaseColumns& cases,
              RequirementSummary& summary) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (cases.outcome[i] != Outcome::kCompleted || !std::isfinite(values[i])) continue;
    if (!summary.worst_completed || limits.IsWorse(values[i], summary.worst_completed->value))
      summary.worst_completed = {cases.index[i], values[i]};
  }
}

void SetPassChances(RequirementSummary& summary) {
  if (summary.n == 0) return;
  // From the least number that can pass up, in steps that show the rise, to where it has saturated.
  const auto least = static_cast<double>(CasesNeeded(summary.probability, summary.consumer_risk, 0));
  for (const double factor : {1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 32.0}) {
    const auto cases = static_cast<std::int64_t>(std::ceil(least * factor));
    const double probability =
        PassProbability(summary.probability, summary.consumer_risk, cases, summary.n, summary.failures);
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
      return fmt::format("judged once, after {}", Plural(summary.planned, "flight"));
    case PlanKind::kGroupSequential:
      return fmt::format("judged {} times up to {} flights", summary.plan.looks, summary.planned);
    case PlanKind::kAnytime:
      return "judged at any time";
  }
  return "";
}

/// How many flights more could decide: of a new campaign, and of this one when it is extended.
void SetAdvice(RequirementSummary& summary) {
  if (summary.verdict != "inconclusive" || summary.contradicted || summary.pass_chances.empty()) return;
  // The number from which more flights hardly help.
  const double worth = 0.9 * std::min(1.0, summary.pass_chances.back().probability);
  const auto& likely = *std::find_if(summary.pass_chances.begin(), summary.pass_chances.end(),
                                     [&](const auto& chance) { return chance.probability >= worth; });
  summary.advice = {summary.pass_chances.front().cases, likely, std::nullopt};
  double left = summary.consumer_risk;
  if (summary.plan.kind != PlanKind::kAnytime)
    left -= PassRisk(summary.probability,
                     Boundaries(summary.plan, summary.probability, summary.consumer_risk, summary.planned));
  if (left >= 1e-12)
    summary.advice->extended = AnytimeCasesNeeded(summary.probability, left, summary.failures);
}

/// Completed flights that do not define the metric are failures, and no limit was broken.
std::string NotMeasuredSentence(const RequirementSummary& summary) {
  if (summary.not_measured == 0) return "";
  return fmt::format(" Of these, the metric was not measured in {}.", Plural(summary.not_measured, "flight"));
}

std::string IndependentSentence(const RequirementSummary& summary, std::int64_t missing) {
  const std::string required = PercentText(summary.probability) + " required.";
  const std::string confidence = PercentText(1.0 - summary.consumer_risk);
  std::string sentence = fmt::format(
      "{} of {} broke the limit{}.{}", summary.failures, Plural(summary.n, "flight"),
      missing > 0 ? fmt::format(", and {} have no result", missing) : "", NotMeasuredSentence(summary));
  // The bounds of a plan of several looks hold at every look, and are wider than what this one decides by.
  if (summary.verdict == "pass" && *summary.success_lower >= summary.probability) {
    sentence +=
        fmt::format(" With {} confidence at least {} of flights meet it; {}", confidence,
                    ShareText(*summary.success_lower, Rounding::kDown, summary.probability), required);
  } else if (summary.verdict == "pass") {
    sentence += fmt::format(" That is few enough by its plan ({}) at a risk of {}; {}", PlanSentence(summary),
                            PercentText(summary.consumer_risk), required);
  } else if (summary.verdict == "fail" && *summary.success_upper <= summary.probability) {
    sentence += fmt::format(" With {} confidence at most {} of flights meet it; {}", confidence,
                            ShareText(*summary.success_upper, Rounding::kUp, summary.probability), required);
  } else if (summary.verdict == "fail") {
    sentence += fmt::format(" That is too many by its plan ({}) at a risk of {}; {}", PlanSentence(summary),
                            PercentText(summary.consumer_risk), required);
  } else if (summary.contradicted) {
    sentence += fmt::format(" One look met the requirement and another one did not; {}", required);
  } else {
    sentence += fmt::format(" Between {} and {} of flights meet it, each bound with {} confidence; {}",
                            ShareText(*summary.success_lower, Rounding::kDown, summary.probability),
                            ShareText(*summary.success_upper, Rounding::kUp, summary.probability), confidence,
                            required);
  }
  if (summary.verdict != "inconclusive" && summary.looks.back().verdict != Verdict::kInconclusive) {
    const auto first = std::find_if(summary.looks.begin(), summary.looks.end(),
                                    [](const Look& look) { return look.verdict != Verdict::kInconclusive; });
    if (first->n < summary.looks.back().n)
      sentence += fmt::format(" The look after {} decided, with {}.", Plural(first->n, "flight"),
                              Plural(first->failures, "failure"));
  }
  return sentence;
}

std::string StudySentence(const RequirementSummary& summary, const JudgingContext& context) {
  const std::int64_t met = summary.n - summary.failures;
  std::string sentence = fmt::format("Design study: {} of {} points meet the limit", met, summary.n);
  if (summary.not_measured > 0)
    sentence += fmt::format(" (not measured in {})", Plural(summary.not_measured, "flight"));
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
               context.replicates, ShareText(*summary.success_lower, Rounding::kDown),
               ShareText(*summary.success_upper, Rounding::kUp), PercentText(1.0 - summary.consumer_risk));
  }
  return sentence + ": this says nothing about the probability in flight.";
}

/// Of several looks the stage-wise one: that a design that just misses passes at an earlier look, or shows so
/// few failures at the one that decides.
double AttainedRisk(const PlannedRequirement& requirement, const std::vector<Look>& looks,
                    std::int64_t missing) {
  const Look& last = looks.back();
  if (requirement.plan.kind == PlanKind::kAnytime)
    return std::min(1.0, std::exp(-PassEvidence(requirement.probability, last.n, last.failures + missing)));
  std::vector<LookBoundary> boundaries =
      Boundaries(requirement.plan, requirement.probability, requirement.risk, requirement.planned);
  const auto passed = std::find_if(looks.begin(), looks.end(), [](const Look& look) {
    return look.planned && look.verdict == Verdict::kPass;
  });
  const Look& at = passed == looks.end() ? last : *passed;
  std::erase_if(boundaries, [&](const LookBoundary& look) { return look.n >= at.n; });
  boundaries.push_back({at.n, std::min(at.n, at.failures + missing), at.n + 1});
  return PassRisk(requirement.probability, boundaries);
}

/// Bounds of the failure probability from the failures in each replicate.
Interval BoundsOfReplicates(const CaseTally& tally, const JudgingContext& context, double risk) {
  const auto points = static_cast<std::int64_t>(context.cases / context.replicates);
  std::vector<std::int64_t> counts(context.replicates, 0);
  for (const std::int64_t index : tally.failed) ++counts[static_cast<std::size_t>(index / points)];
  return ReplicateBounds(counts, points, risk);
}

}  // namespace

std::vector<double> ValuesToJudge(const Requirement& requirement, const CaseColumns& cases) {
  std::vector<double> values = MeasuredValues(cases, requirement.metric);
  const Limits limits = LimitsOf(requirement);
  for (double& value : values) value = limits.Represented(value);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (cases.outcome[i] != Outcome::kCompleted) values[i] = kUndefined;
  }
  return values;
}

std::string LimitWords(const RequirementSummary& requirement, const std::string& unit) {
  const std::string suffix = unit.empty() ? "" : " " + unit;
  if (requirement.low_limit) {
    return fmt::format("between {} and {}{}", StatedText(*requirement.low_limit),
                       StatedText(requirement.limit), suffix);
  }
  return fmt::format("{} {}{}", requirement.below ? "below" : "above", StatedText(requirement.limit), suffix);
}

double LimitBeside(const RequirementSummary& requirement, double value) {
  if (!requirement.low_limit) return requirement.limit;
  return Limits{*requirement.low_limit, requirement.limit}.Beside(value);
}

namespace {

/// Whether the bound is held against an upper limit.
bool IsBoundedAbove(const RequirementSummary& requirement) {
  return requirement.below && LimitBeside(requirement, *requirement.bound) == requirement.limit;
}

}  // namespace

std::string ValueText(const RequirementSummary& requirement, double value) {
  return RoundedText(value, Rounding::kNearest, LimitBeside(requirement, value));
}

std::string BoundText(const RequirementSummary& requirement) {
  return RoundedText(*requirement.bound, IsBoundedAbove(requirement) ? Rounding::kUp : Rounding::kDown,
                     LimitBeside(requirement, *requirement.bound));
}

std::string BoundWords(const RequirementSummary& requirement, const std::string& unit) {
  if (!requirement.bound) return "";
  return fmt::format("{} {}{}", IsBoundedAbove(requirement) ? "below" : "above", BoundText(requirement),
                     unit.empty() ? "" : " " + unit);
}

std::string BoundSentence(const RequirementSummary& requirement, const std::string& unit) {
  if (!requirement.bound) return "";
  const std::string limit = requirement.low_limit
                                ? "limits " + LimitWords(requirement, unit).substr(8)
                                : "limit " + StatedText(requirement.limit) + (unit.empty() ? "" : " " + unit);
  return fmt::format("With {} confidence {} of flights stay {} ({}).",
                     PercentText(1.0 - requirement.consumer_risk), PercentText(requirement.probability),
                     BoundWords(requirement, unit), limit);
}

std::string AdviceSentence(const RequirementSummary& requirement) {
  if (!requirement.advice) return "";
  const RequirementSummary::Advice& advice = *requirement.advice;
  std::string text = fmt::format(
      " A new campaign can pass with {} flights or more. By what was seen here, a campaign of {} flights "
      "passes with a probability of {}.",
      advice.least, advice.likely.cases, ShareText(advice.likely.probability));
  if (advice.extended)
    text +=
        fmt::format(" This one, extended, needs {} flights in all with no further failure (any-time rule).",
                    *advice.extended);
  return text;
}

std::string RequirementWords(const RequirementSummary& requirement) {
  if (requirement.every_case)
    return fmt::format("{} {} in every case", requirement.metric, LimitWords(requirement, ""));
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
    summary.id = requirement.id;
    summary.rationale = requirement.rationale;
    summary.source = requirement.source;
    summary.every_case = requirement.every_case;
    summary.metric = requirement.metric;
    summary.below = !requirement.above.has_value();
    summary.limit = summary.below ? limits.high : limits.low;
    if (requirement.within) summary.low_limit = limits.low;
    summary.probability = requirement.probability;
    summary.consumer_risk = requirement.consumer_risk;
    summary.plan = requirement.plan;
    summary.planned = context.planned;
    const std::vector<double> values = ValuesToJudge(requirement, cases);
    tallies.push_back(TallyOf(limits, values, cases, context.cases));
    SetWorst(limits, values, cases, summary);
    summary.n = std::ssize(cases.index);
    summary.failures = std::ssize(tallies.back().failed);
    summary.lost_flights = static_cast<std::int64_t>(LostCount(cases));
    for (std::size_t row = 0; row < values.size(); ++row)
      summary.not_measured += cases.outcome[row] == Outcome::kCompleted && !std::isfinite(values[row]);
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
      if (context.replicates > 1 && missing == 0 && !summary.every_case) {
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
    if (!context.no_evidence.empty() &&
        verdict.verdict != Verdict::kFail) {  // a failure is one, alone or alike
      summary.verdict = "not_evidence";
      summary.sentence =
          fmt::format("{} of {} broke the limit.{} {}", summary.failures, Plural(summary.n, "flight"),
                      NotMeasuredSentence(summary), context.no_evidence);
      continue;
    }
    summary.success_lower = verdict.success_lower;
    summary.success_upper = verdict.success_upper;
    summary.cases_needed = verdict.cases_needed;
    summary.looks = verdict.looks;
    if (verdict.boundary.accept >= 0) summary.accepts = verdict.boundary.accept;
    if (verdict.boundary.reject <= verdict.boundary.n) summary.rejects = verdict.boundary.reject;
    summary.contradicted = verdict.contradicted;
    summary.beyond_plan = verdict.beyond_plan;
    summary.naive_risk = verdict.naive_risk;
    SetBound(LimitsOf(requirements[i]), ValuesToJudge(requirements[i], cases), verdict.boundary.accept,
             missing, summary);
    summary.attained_risk = AttainedRisk(planned[i], summary.looks, missing);
    SetPassChances(summary);
    SetConvergence(tallies[i], cases, summary);
    SetAdvice(summary);
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
