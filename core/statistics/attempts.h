// Decides whether a requirement is met after several campaigns have tried to show it for one design.
//
// The first attempt that could have passed keeps its plan. Later attempts add their cases to one pool.
// Evidence that holds at any time (anytime.h) decides the pool, with the risk that the plan has left. So all
// attempts together pass a design that just misses with at most the stated risk. This holds even if seeds,
// numbers of cases and the moment to stop were chosen after results were seen.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/statistics/planned_verdict.h"

namespace dispersa {

/// The cases of one campaign for one requirement. Cases of a seed are counted from 0. So if two attempts have
/// the same seed, the larger one contains the cases of the smaller.
struct Attempt {
  std::uint64_t seed = 0;
  std::int64_t planned = 0;   ///< planned number of cases
  std::int64_t cases = 0;     ///< counted: up to the last that was assigned
  std::int64_t failures = 0;  ///< among `cases`; a case without a result counts as a failure
  VerdictPlan plan;
  bool passed = false;  ///< by its own plan, for the present requirement
  /// False for cases of another engine. They were seen and may have spent risk, but they show nothing about
  /// the flights of this one.
  bool is_evidence = true;
};

struct AttemptsVerdict {
  bool passed = false;          ///< by the plan that was kept, or by the pool
  bool passed_before = false;   ///< an earlier attempt passed
  bool by_plan = false;         ///< the last attempt is judged by its own plan
  bool is_spent = false;        ///< an earlier attempt has spent the plan's risk
  std::int64_t pool_cases = 0;  ///< all cases that count
  std::int64_t pool_failures = 0;
  double risk_left = 0.0;  ///< for the pool
  /// Number of cases with which the pool would pass at its present failures; none: no number passes.
  std::optional<std::int64_t> pool_needed;
};

/// Judges the last attempt; `attempts` also holds the earlier ones. `reserved`: number of attempts that share
/// the risk evenly and keep their own plans.
///
/// - An attempt that could not have passed with any number of failures spends no risk.
/// - An attempt that flies cases of an earlier attempt again was planned after their results were seen. It
///   has no plan to keep.
/// - Cases that are no evidence are in no pool, and their passes are none.
/// - If an attempt passed, later attempts that repeat or extend it also pass.
AttemptsVerdict JudgeAttempts(double probability, double risk, std::uint64_t reserved,
                              const std::vector<Attempt>& attempts);

}  // namespace dispersa
