#include "core/trajectory/constraints.h"

#include <algorithm>

#include "core/math/constants.h"

namespace dispersa {

std::vector<ConstraintMargin> ConstraintsOf(const TrajectoryProblem& problem, const FlightProgram& program,
                                            const AscentResult& ascent) {
  std::vector<ConstraintMargin> constraints;
  const auto add = [&](const char* name, double value, double limit, double unit = 1.0) {
    const bool enforced = limit > 0.0;
    // Stored in SI. Dividing by the unit gives back the limit that the user wrote.
    constraints.push_back(
        {name, value / unit, limit / unit, enforced ? (limit - value) / unit : 0.0, enforced});
  };
  add("axial_load_max_g", ascent.axial_load_max_g, problem.axial_load_limit_g);
  add("lateral_load_max_g", ascent.lateral_load_max_g, problem.lateral_load_limit_g);
  add("programmed_alpha_max_deg", program.alpha_max_rad, problem.alpha_limit_rad, kRadPerDeg);
  add("turn_rate_max_deg_s", ascent.turn_rate_max_rad_s, problem.turn_rate_limit_rad_s, kRadPerDeg);
  add("mach_at_t2", ascent.mach_at_t2, problem.transonic_mach_low);
  const double transonic_alpha_deg = ascent.transonic_alpha_max_rad / kRadPerDeg;
  constraints.push_back(
      {"transonic_alpha_max_deg", transonic_alpha_deg, 0.0, 0.0 - transonic_alpha_deg, true});
  add("q_max_pa", ascent.q_max_pa, problem.q_max_limit_pa);
  add("q_alpha_max_pa_rad", ascent.q_alpha_max_pa_rad, problem.q_alpha_limit_pa_rad);
  return constraints;
}

bool AreSatisfied(const std::vector<ConstraintMargin>& constraints) {
  return std::all_of(constraints.begin(), constraints.end(),
                     [](const ConstraintMargin& c) { return !c.enforced || c.margin >= 0.0; });
}

std::vector<double> Violations(const std::vector<ConstraintMargin>& constraints, double reserve) {
  std::vector<double> violations;
  for (const ConstraintMargin& c : constraints) {
    if (!c.enforced) continue;
    const double missed = reserve * c.limit - c.margin;
    violations.push_back(missed <= 0.0 ? 0.0 : missed / (c.limit > 0.0 ? c.limit : 1.0));
  }
  return violations;
}

}  // namespace dispersa
