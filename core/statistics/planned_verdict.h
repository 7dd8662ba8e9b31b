// The verdict on a requirement by its plan, from the cases in the order of their indices, whoever looked
// when.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/statistics/group_sequential.h"
#include "core/statistics/verdict_plan.h"

namespace dispersa {

enum class Verdict { kPass, kFail, kInconclusive };

/// What is to be shown, and how it may be looked at.
struct PlannedRequirement {
  double probability = 0.9973;  ///< in (0, 1)
  double risk = 0.10;           ///< in (0, 0.5): of passing what just misses, and of failing what just meets
  VerdictPlan plan;
  std::int64_t planned = 0;  ///< cases that were planned before the first was flown
};

/// Cases by index: those that failed, and those without a result; each ascending.
struct CaseTally {
  std::vector<std::int64_t> failed;
  std::vector<std::int64_t> missing;

  /// Among the first n cases.
  std::int64_t Failed(std::int64_t n) const;
  std::int64_t Missing(std::int64_t n) const;
};

struct Look {
  std::int64_t n = 0;
  std::int64_t failures = 0;
  bool planned = false;
  Verdict verdict = Verdict::kInconclusive;  ///< from this look and those before it

  bool operator==(const Look&) const = default;
};

struct PlannedVerdict {
  Verdict verdict = Verdict::kInconclusive;
  /// A look passed and another one failed: the cases contradict themselves, and nothing is decided.
  bool contradicted = false;
  /// The number of cases is not the planned one any more.
  bool beyond_plan = false;
  std::vector<Look> looks;  ///< ascending in n, the last at all cases
  LookBoundary boundary;    ///< that holds at the last look
  /// Beyond the plan: the risk of passing what just misses if each of these looks were read as the only one.
  std::optional<double> naive_risk;
  /// Of the success probability, one-sided, each with confidence 1 - risk: Clopper-Pearson where there is one
  /// look, else a confidence sequence. A missing case counts as failed for the lower and as met for the
  /// upper.
  double success_lower = 0.0;
  double success_upper = 1.0;
  /// When inconclusive: the least number of cases that could pass with as many failures: of a new campaign
  /// with one look, or of this one when its plan is an anytime plan.
  std::optional<std::int64_t> cases_needed;
};

/// Decides. `n`: cases of the campaign, 1 or more; `past_looks`: numbers of cases at which its verdicts were
/// read before.
///
/// Planned looks decide by Boundaries(), on the first cases by index. A look that was not planned decides
/// only by evidence that holds at any time (anytime.h), with what the plan leaves of the risk; so a pass of a
/// design that just misses has at most the stated risk however often the campaign is extended. For a pass a
/// missing case counts as failed, for a fail as met.
PlannedVerdict Decide(const PlannedRequirement& requirement, std::int64_t n, const CaseTally& tally,
                      const std::vector<std::int64_t>& past_looks = {});

/// All of them, one tally each. With `holm` the verdicts hold together: that any of them is wrong has at most
/// the largest of the risks (S. Holm, Scand. J. Statist. 6 (1979) 65-70); each is decided at its risk divided
/// by the number of those that are not yet decided, until no further one is. Without, each keeps its own
/// risk.
std::vector<PlannedVerdict> DecideAll(const std::vector<PlannedRequirement>& requirements, bool holm,
                                      std::int64_t n, const std::vector<CaseTally>& tallies,
                                      const std::vector<std::int64_t>& past_looks = {});

/// Probability that a new campaign of n cases with one look passes, after `failures` of `seen` cases failed:
/// over the failure probabilities that these leave possible (Jeffreys' prior: Beta(failures + 1/2, seen -
/// failures + 1/2)), not at the rate seen, which after few cases is nearly always too good.
double PassProbability(double probability, double risk, std::int64_t n, std::int64_t seen,
                       std::int64_t failures);

}  // namespace dispersa
