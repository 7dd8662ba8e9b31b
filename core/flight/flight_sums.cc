#include "core/flight/flight_sums.h"

namespace dispersa {

ErrorSums Total(const ErrorSums (&stages)[kMaxStages]) {
  ErrorSums total;
  for (const ErrorSums& stage : stages) {
    total.squares += stage.squares;
    total.count += stage.count;
    if (stage.peak <= total.peak) continue;
    total.peak = stage.peak;
    total.peak_time_s = stage.peak_time_s;
  }
  return total;
}

bool ExceedsStructure(const StructuralLimits& limits, const FlightSums& sums) {
  const auto exceeded = [](double value, double limit) { return limit > 0.0 && value > limit; };
  return exceeded(sums.q_alpha_max_pa_rad, limits.q_alpha_pa_rad) ||
         exceeded(sums.axial_load_max_g, limits.axial_load_g) ||
         exceeded(sums.lateral_load_max_g, limits.lateral_load_g) ||
         exceeded(sums.bending_moment_max_n_m, limits.bending_moment_n_m);
}

}  // namespace dispersa
