// Boundaries for counts of failures at several looks, from the exact binomial distribution.
#pragma once

#include <cstdint>
#include <vector>

#include "core/statistics/verdict_plan.h"

namespace dispersa {

/// The decision at a look after n cases. At most `accept` failures pass; -1: no number passes. At least
/// `reject` failures fail; n + 1: no number fails.
struct LookBoundary {
  std::int64_t n = 0;
  std::int64_t accept = -1;
  std::int64_t reject = 1;
};

/// Numbers of cases at the plan's looks: look i of K is at ceil(i `planned` / K), the last at `planned`. A
/// fixed plan has one look, an anytime plan none.
std::vector<std::int64_t> LookCounts(const VerdictPlan& plan, std::int64_t planned);

/// The plan's boundaries. A design that misses the required `probability` passes at any of the looks with at
/// most `risk`. A design that meets it fails at any of the looks with at most `risk`. Both hold whether or
/// not the campaign stops at the first decision.
std::vector<LookBoundary> Boundaries(const VerdictPlan& plan, double probability, double risk,
                                     std::int64_t planned);

/// For a design that succeeds with `probability`: the probability of at most `accept` failures at any of the
/// looks (PassRisk), or of at least `reject` (FailRisk). Looks in ascending order of n.
double PassRisk(double probability, const std::vector<LookBoundary>& looks);
double FailRisk(double probability, const std::vector<LookBoundary>& looks);

}  // namespace dispersa
