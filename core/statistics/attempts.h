// Whether a requirement is shown when several campaigns have tried to show it of one design.
//
// The first attempt that could have passed keeps its plan. Later ones add their cases to one pool, which is
// decided by evidence that holds at any time (anytime.h) with the risk that the plan left. So a design that
// just misses is passed by any of the attempts with at most the stated risk, whoever chose seeds, numbers of
// cases and the moment to stop by what he saw.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/statistics/planned_verdict.h"

namespace dispersa {

/// One campaign's cases as far as one requirement is concerned. Cases of one seed are counted from 0, so that
/// of two attempts with one seed the larger holds the cases of the smaller.
struct Attempt {
  std::uint64_t seed = 0;
  std::int64_t planned = 0;   ///< cases that it was to fly
  std::int64_t cases = 0;     ///< counted: up to the last that was assigned
  std::int64_t failures = 0;  ///< of them; a case without a result is one
  VerdictPlan plan;
  bool passed = false;  ///< by its own plan, for what is required now
};

struct AttemptsVerdict {
  bool passed = false;          ///< by the plan that was kept, or by the pool
  bool passed_before = false;   ///< an earlier attempt was
  bool by_plan = false;         ///< the last attempt is judged by its own plan
  bool is_spent = false;        ///< an attempt before it has spent the plan's risk
  std::int64_t pool_cases = 0;  ///< all that count together
  std::int64_t pool_failures = 0;
  double risk_left = 0.0;  ///< for the pool
  /// Cases of the pool that would pass with as many failures; none: no number does.
  std::optional<std::int64_t> pool_needed;
};

/// The last attempt in the light of those before it. `reserved`: so many attempts share the risk evenly, and
/// each keeps its plan.
///
/// - An attempt that could not have passed, however few failures it had, spends nothing.
/// - One that flies cases again that an earlier one has shown was planned after they were seen: it has no
///   plan to keep.
/// - When an attempt passed, the later ones that repeat or extend it stay passed.
AttemptsVerdict JudgeAttempts(double probability, double risk, std::uint64_t reserved,
                              const std::vector<Attempt>& attempts);

}  // namespace dispersa
