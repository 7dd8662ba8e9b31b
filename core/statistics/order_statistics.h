// Numbers of cases and of failures that show a probability, from the exact binomial distribution (J. M.
// Hanson and B. B. Beard, "Applying Monte Carlo simulation to launch vehicle design and requirements
// verification", NASA/TP-2010-216447). The cases are independent and identically distributed.
#pragma once

#include <cstdint>
#include <optional>

namespace dispersa {

/// Probability of at most `failures` failures in n cases, when each case succeeds with `probability`. This is
/// the risk of accepting a design that just misses the requirement. n >= 0, failures >= 0, probability in (0,
/// 1).
double ConsumerRisk(double probability, std::int64_t n, std::int64_t failures);

/// Probability of at least `failures` failures in n cases, when each case succeeds with `probability`. This
/// is the risk of rejecting a design that just meets the requirement.
double ProducerRisk(double probability, std::int64_t n, std::int64_t failures);

/// The smallest n for which `failures` failures still show the probability: ConsumerRisk <= consumer_risk.
/// `probability` and `consumer_risk` in (0, 1).
std::int64_t CasesNeeded(double probability, double consumer_risk, std::int64_t failures);

/// The largest number of failures in n cases that still shows the probability. None if 0 failures do not show
/// it.
std::optional<std::int64_t> MaxFailures(double probability, double consumer_risk, std::int64_t n);

}  // namespace dispersa
