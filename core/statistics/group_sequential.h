// Boundaries for counts of failures that are looked at several times, from the exact binomial distribution.
#pragma once

#include <cstdint>
#include <vector>

#include "core/statistics/verdict_plan.h"

namespace dispersa {

/// What a look at n cases decides: a pass with at most `accept` failures (-1: none is few enough), a fail
/// with at least `reject` (n + 1: none is many enough).
struct LookBoundary {
  std::int64_t n = 0;
  std::int64_t accept = -1;
  std::int64_t reject = 1;
};

/// Cases at each of the plan's looks: the i-th of K at ceil(i `planned` / K), the last at `planned`. One for
/// a fixed plan, none for an anytime one.
std::vector<std::int64_t> LookCounts(const VerdictPlan& plan, std::int64_t planned);

/// The plan's boundaries. Whatever a design's true probability, it is passed at any of the looks with at most
/// `risk` if it misses the required `probability`, and failed with at most the same risk if it meets it.
/// Either statement holds whether or not one stops at the first decision.
std::vector<LookBoundary> Boundaries(const VerdictPlan& plan, double probability, double risk,
                                     std::int64_t planned);

/// Probability that a design that succeeds with `probability` shows at most `accept` failures at any of the
/// looks (in ascending order of n); the same for at least `reject`.
double PassRisk(double probability, const std::vector<LookBoundary>& looks);
double FailRisk(double probability, const std::vector<LookBoundary>& looks);

}  // namespace dispersa
