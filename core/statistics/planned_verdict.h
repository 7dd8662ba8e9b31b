// The verdict on a requirement by its plan. It uses the cases in the order of their indices.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/statistics/group_sequential.h"
#include "core/statistics/verdict_plan.h"

namespace dispersa {

enum class Verdict { kPass, kFail, kInconclusive };

/// A requirement with its verdict plan.
struct PlannedRequirement {
  double probability = 0.9973;  ///< in (0, 1)
  double risk =
      0.10;  ///< in (0, 0.5): of a pass of a design that just misses, and of a fail of one that just meets
  VerdictPlan plan;
  std::int64_t planned = 0;  ///< cases that were planned before the first was flown
};

/// Indices of the cases that failed and of those without a result, each in ascending order.
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
  /// One look passed and another failed. The cases contradict each other, and nothing is decided.
  bool contradicted = false;
  /// The number of cases is no longer the planned one.
  bool beyond_plan = false;
  std::vector<Look> looks;  ///< ascending in n, the last at all cases
  LookBoundary boundary;    ///< that holds at the last look
  /// Beyond the plan: the risk that a design which just misses passes if each look were judged as the only
  /// one.
  std::optional<double> naive_risk;
  /// One-sided bounds of the success probability, each with confidence 1 - risk. One look: Clopper-Pearson.
  /// Several looks: a confidence sequence. A missing case counts as failed for the lower and as met for the
  /// upper.
  double success_lower = 0.0;
  double success_upper = 1.0;
  /// When inconclusive: the least number of cases that could pass with the present number of failures. It is
  /// for a new campaign with one look. With an anytime plan it is for this campaign.
  std::optional<std::int64_t> cases_needed;
};

/// Decides. `n`: cases of the campaign, 1 or more; `past_looks`: numbers of cases at which its verdicts were
/// read before.
///
/// Planned looks decide by Boundaries(), on the first cases by index. A look that was not planned decides
/// only by evidence that holds at any time (anytime.h), with the risk that the plan has left. So a design
/// that just misses passes with at most the stated risk, even if the campaign is extended many times. For a
/// pass a missing case counts as failed, for a fail as met.
PlannedVerdict Decide(const PlannedRequirement& requirement, std::int64_t n, const CaseTally& tally,
                      const std::vector<std::int64_t>& past_looks = {});

/// Decides all requirements, with one tally each. With `holm` the verdicts hold together: any of them is
/// wrong with at most the largest of the risks (S. Holm, Scand. J. Statist. 6 (1979) 65-70). Each is decided
/// at its risk divided by the number of undecided requirements, until none is decided any more. Without
/// `holm` each keeps its own risk.
std::vector<PlannedVerdict> DecideAll(const std::vector<PlannedRequirement>& requirements, bool holm,
                                      std::int64_t n, const std::vector<CaseTally>& tallies,
                                      const std::vector<std::int64_t>& past_looks = {});

/// Probability that a new campaign of n cases with one look passes, after `failures` of `seen` cases failed.
/// It is the mean over the posterior of the failure probability (Jeffreys' prior: Beta(failures + 1/2, seen -
/// failures + 1/2)). The observed rate would be too optimistic after few cases.
double PassProbability(double probability, double risk, std::int64_t n, std::int64_t seen,
                       std::int64_t failures);

}  // namespace dispersa
