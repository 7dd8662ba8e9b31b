#include "core/flight/structural_limits.h"

#include <algorithm>

#include "core/flight/flight_sums.h"

namespace dispersa {
namespace {

constexpr StructuralLimit kLimits[] = {
    {"q_max_pa", &StructuralLimits::q_max_pa, &FlightSums::q_max_pa},
    {"q_alpha_max_pa_rad", &StructuralLimits::q_alpha_pa_rad, &FlightSums::q_alpha_max_pa_rad},
    {"axial_load_max_g", &StructuralLimits::axial_load_g, &FlightSums::axial_load_max_g},
    {"lateral_load_max_g", &StructuralLimits::lateral_load_g, &FlightSums::lateral_load_max_g},
    {"bending_moment_max_n_m", &StructuralLimits::bending_moment_n_m, &FlightSums::bending_moment_max_n_m},
};

}  // namespace

std::span<const StructuralLimit> AllStructuralLimits() { return kLimits; }

bool HasLimits(const StructuralLimits& limits) {
  return std::any_of(std::begin(kLimits), std::end(kLimits),
                     [&](const StructuralLimit& one) { return limits.*one.limit > 0.0; });
}

bool ExceedsStructure(const StructuralLimits& limits, const FlightSums& sums) {
  return std::any_of(std::begin(kLimits), std::end(kLimits), [&](const StructuralLimit& one) {
    return limits.*one.limit > 0.0 && sums.*one.load > limits.*one.limit;
  });
}

}  // namespace dispersa
