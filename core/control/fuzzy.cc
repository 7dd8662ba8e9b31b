#include "core/control/fuzzy.h"

#include "core/math/functions.h"

namespace dispersa {

std::array<double, kFuzzySets> Memberships(double x, double range) {
  std::array<double, kFuzzySets> grade{};
  // Position in units of the centres' spacing, 0 at the first centre.
  const double position = Clamp(2.0 * x / range + 2.0, 0.0, kFuzzySets - 1.0);
  int left = static_cast<int>(position);
  if (left > kFuzzySets - 2) left = kFuzzySets - 2;
  const double right_grade = position - left;
  grade[static_cast<std::size_t>(left)] = 1.0 - right_grade;
  grade[static_cast<std::size_t>(left) + 1] = right_grade;
  return grade;
}

std::array<double, kFuzzyRules> Regressor(const FuzzyRules& rules, double error_rad, double rate_rad_s) {
  const auto error = Memberships(error_rad, rules.error_range_rad);
  const auto rate = Memberships(rate_rad_s, rules.rate_range_rad_s);
  std::array<double, kFuzzyRules> zeta{};
  double sum = 0.0;
  for (std::size_t i = 0; i < kFuzzySets; ++i)
    for (std::size_t j = 0; j < kFuzzySets; ++j) sum += zeta[i * kFuzzySets + j] = error[i] * rate[j];
  for (double& z : zeta) z /= sum;
  return zeta;
}

std::array<double, kFuzzyRules> PlaneConsequents(const FuzzyRules& rules, const AxisGains& gains) {
  std::array<double, kFuzzyRules> consequents{};
  for (int i = 0; i < kFuzzySets; ++i)
    for (int j = 0; j < kFuzzySets; ++j)
      consequents[static_cast<std::size_t>(i * kFuzzySets + j)] =
          gains.kp_1_s2 * rules.error_range_rad * 0.5 * (i - 2) +
          gains.kd_1_s * rules.rate_range_rad_s * 0.5 * (j - 2);
  return consequents;
}

}  // namespace dispersa
