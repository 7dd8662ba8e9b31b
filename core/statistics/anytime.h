// Evidence about a probability that may be looked at after every case, and bounds from it.
//
// The evidence is a mixture of likelihood ratios. If the design misses (meets) the requirement, it is a
// nonnegative supermartingale that begins at 1. The probability that it ever reaches 1 / risk is then at most
// `risk` (J. Ville, 1939; H. Robbins, Ann. Math. Statist. 41 (1970) 1397-1409). This holds for any reason to
// look or to stop.
#pragma once

#include <cstdint>

#include "core/statistics/group_sequential.h"
#include "core/statistics/intervals.h"

namespace dispersa {

/// Natural logarithm of the evidence that a design succeeds with more than `probability`, after n cases with
/// `failures` failures. The mixture is over failure probabilities p below 1 - `probability`, with density ~
/// p^(-1/2).
double PassEvidence(double probability, std::int64_t n, std::int64_t failures);
/// The evidence that it succeeds with less than `probability`: a mixture over failure probabilities above 1 -
/// `probability`, with density ~ 1/p.
double FailEvidence(double probability, std::int64_t n, std::int64_t failures);

/// The decisions after n cases. The evidence for a pass may be wrong with `pass_risk`, for a fail with
/// `fail_risk`; both in (0, 1).
LookBoundary AnytimeBoundary(double probability, double pass_risk, double fail_risk, std::int64_t n);

/// The least number of cases that pass with this number of failures.
std::int64_t AnytimeCasesNeeded(double probability, double risk, std::int64_t failures);

/// Bounds of the success probability (a confidence sequence): each bound is ever wrong with at most `risk`.
/// The lower bound uses `most_failures`, the upper bound `failures`. n > 0.
Interval AnytimeSuccess(std::int64_t n, std::int64_t failures, std::int64_t most_failures, double risk);

}  // namespace dispersa
