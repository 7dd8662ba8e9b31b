// Sums with a rounding error that does not grow with the number of terms.
#pragma once

#include <cmath>
#include <vector>

namespace dispersa {

/// Neumaier's compensated sum of term(value) in the given order.
template <typename Term>
double CompensatedSum(const std::vector<double>& values, Term term) {
  double sum = 0.0;
  double compensation = 0.0;
  for (const double value : values) {
    const double addend = term(value);
    const double next = sum + addend;
    compensation += std::fabs(sum) >= std::fabs(addend) ? (sum - next) + addend : (addend - next) + sum;
    sum = next;
  }
  return sum + compensation;
}

}  // namespace dispersa
