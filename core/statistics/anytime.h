// Evidence about a probability that may be looked at after every case, and bounds from it.
//
// A mixture of likelihood ratios is, when the design misses (meets) the requirement, a nonnegative
// supermartingale that begins at 1; that it ever reaches 1 / risk has at most the probability `risk`
// (J. Ville, 1939; H. Robbins, Ann. Math. Statist. 41 (1970) 1397-1409). Whatever made one look or stop is
// allowed.
#pragma once

#include <cstdint>

#include "core/statistics/group_sequential.h"
#include "core/statistics/intervals.h"

namespace dispersa {

/// Natural logarithm of the evidence after n cases with so many failures that a design succeeds with more
/// than `probability`: failure probabilities p below 1 - `probability`, mixed with density ~ p^(-1/2).
double PassEvidence(double probability, std::int64_t n, std::int64_t failures);
/// That it succeeds with less: failure probabilities above, mixed with density ~ 1/p.
double FailEvidence(double probability, std::int64_t n, std::int64_t failures);

/// What is decided after n cases when each kind of evidence may be wrong with its risk, in (0, 1).
LookBoundary AnytimeBoundary(double probability, double pass_risk, double fail_risk, std::int64_t n);

/// The least number of cases that pass with so many failures.
std::int64_t AnytimeCasesNeeded(double probability, double risk, std::int64_t failures);

/// Bounds of the success probability, each wrong at any time with at most `risk`: a confidence sequence.
/// `most_failures` count for the lower bound, `failures` for the upper. n > 0.
Interval AnytimeSuccess(std::int64_t n, std::int64_t failures, std::int64_t most_failures, double risk);

}  // namespace dispersa
