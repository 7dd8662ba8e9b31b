#include "core/campaign_yaml/attitude_columns.h"
#include "core/campaign_yaml/inline_files.h"
#include "core/campaign_yaml/load.h"
#include "core/campaign_yaml/number_text.h"

namespace dispersa {
namespace {

std::string Deg(double radians) { return FormatScaled(radians, kRadPerDeg); }
std::string Km(double metres) { return FormatScaled(metres, 1e3); }

std::string DegBounds(const Bounds& bounds) { return "[" + Deg(bounds.low) + ", " + Deg(bounds.high) + "]"; }
std::string Limits(const Bounds& bounds) {
  return "[" + FormatNumber(bounds.low) + ", " + FormatNumber(bounds.high) + "]";
}

// Names come from other files and may hold anything.
std::string Quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? "''" : std::string(1, c);
  return quoted + "'";
}

std::string ProblemText(const TrajectoryProblem& problem) {
  std::string text;
  text += "problem:\n";
  text += "  target: {altitude_km: " + Km(problem.target_altitude_m) +
          ", velocity_m_s: " + FormatNumber(problem.target_velocity_m_s) +
          ", flight_path_angle_deg: " + Deg(problem.target_flight_path_angle_rad) + "}\n";
  text += "  bounds:\n";
  text += "    alpha_max_deg: " + DegBounds(problem.alpha_max_rad) + "\n";
  text += "    t1_s: " + Limits(problem.t1_s) + "\n";
  text += "    t3_s: " + Limits(problem.t3_s) + "\n";
  text += "    t2_s: " + Limits(problem.t2_s) + "\n";
  text += "    coast_s: " + Limits(problem.coast_s) + "\n";
  text += "    launch_azimuth_deg: " + DegBounds(problem.launch_azimuth_rad) + "\n";
  text += "  weights: {altitude_per_km: " + FormatScaled(problem.weight_altitude_1_m, 1e-3) +
          ", velocity_per_m_s: " + FormatNumber(problem.weight_velocity_s_m) +
          ", flight_path_angle_per_deg: " + FormatScaled(problem.weight_angle_1_rad, kDegPerRad) + "}\n";
  text += "  limits:\n";
  text += "    axial_load_g: " + FormatNumber(problem.axial_load_limit_g) + "\n";
  text += "    lateral_load_g: " + FormatNumber(problem.lateral_load_limit_g) + "\n";
  text += "    alpha_deg: " + Deg(problem.alpha_limit_rad) + "\n";
  if (problem.turn_rate_limit_rad_s > 0.0) {
    text += "    turn_rate_deg_s: " + Deg(problem.turn_rate_limit_rad_s) + "\n";
  }
  text += "    transonic_mach_low: " + FormatNumber(problem.transonic_mach_low) + "\n";
  text += "    transonic_mach_high: " + FormatNumber(problem.transonic_mach_high) + "\n";
  if (problem.q_max_limit_pa > 0.0) text += "    q_max_pa: " + FormatNumber(problem.q_max_limit_pa) + "\n";
  if (problem.q_alpha_limit_pa_rad > 0.0) {
    text += "    q_alpha_pa_rad: " + FormatNumber(problem.q_alpha_limit_pa_rad) + "\n";
  }
  if (problem.velocity_reserve_m_s > 0.0)
    text += "  velocity_reserve_m_s: " + FormatNumber(problem.velocity_reserve_m_s) + "\n";
  if (problem.reaction_control_propellant_kg > 0.0)
    text +=
        "  reaction_control_propellant_kg: " + FormatNumber(problem.reaction_control_propellant_kg) + "\n";
  text += "  population: " + std::to_string(problem.population) + "\n";
  text += "  generations: " + std::to_string(problem.generations) + "\n";
  text += "  seed: " + std::to_string(problem.seed) + "\n";
  return text;
}

}  // namespace

std::string WriteReference(const Reference& reference) {
  const FlightProgram& program = reference.program;
  const Orbit& orbit = reference.orbit;
  const TrajectoryProblem& problem = reference.problem;
  std::string text = std::string("schema: ") + kReferenceSchema + "\n";
  text += "name: " + Quoted(reference.name) + "\n";
  if (!reference.target_missed.empty()) text += "target_missed: " + Quoted(reference.target_missed) + "\n";
  text += ProblemText(problem);
  text += "flight_program:\n";
  text += "  alpha_max_deg: " + Deg(program.alpha_max_rad) + "\n";
  text += "  t1_s: " + FormatNumber(program.t1_s) + "\n";
  text += "  t3_s: " + FormatNumber(program.t3_s) + "\n";
  text += "  t2_s: " + FormatNumber(program.t2_s) + "\n";
  text += "  coast_s: " + FormatNumber(program.coast_s) + "\n";
  text += "  launch_azimuth_deg: " + Deg(program.launch_azimuth_rad) + "\n";
  text += "  last_ignition_s: " + FormatNumber(reference.last_ignition_s) + "\n";
  text += "orbit: {altitude_km: " + Km(orbit.altitude_m) +
          ", velocity_m_s: " + FormatNumber(orbit.velocity_m_s) +
          ", flight_path_angle_deg: " + Deg(orbit.flight_path_angle_rad) +
          ", inclination_deg: " + Deg(orbit.inclination_rad) + "}\n";
  text +=
      "errors: {altitude_km: " + Km(orbit.altitude_m - problem.target_altitude_m) +
      ", velocity_m_s: " + FormatNumber(orbit.velocity_m_s - AimedVelocity(problem)) +
      ", flight_path_angle_deg: " + Deg(orbit.flight_path_angle_rad - problem.target_flight_path_angle_rad) +
      "}\n";
  text += reference.constraints.empty() ? "constraints: []\n" : "constraints:\n";
  for (const ConstraintMargin& constraint : reference.constraints) {
    text += "  - {name: " + constraint.name + ", value: " + FormatNumber(constraint.value) +
            ", limit: " + FormatNumber(constraint.limit) + ", margin: " + FormatNumber(constraint.margin) +
            ", enforced: " + (constraint.enforced ? "true" : "false") + "}\n";
  }
  text += "provenance: {engine: " + Quoted(reference.engine) +
          ", vehicle_sha256: " + Quoted(reference.vehicle_sha256) +
          ", evaluations: " + std::to_string(reference.evaluations) + "}\n";
  text += "attitude:\n  columns: [";
  for (std::size_t c = 0; c < kAttitudeColumns.size(); ++c) {
    text += std::string(c > 0 ? ", " : "") + kAttitudeColumns[c].name;
  }
  text += "]\n  rows:\n";
  for (const AttitudeKnot& knot : reference.attitude.knots) {
    text += "    - [";
    for (std::size_t c = 0; c < kAttitudeColumns.size(); ++c) {
      text += (c > 0 ? ", " : "") + FormatScaled(knot.*kAttitudeColumns[c].field, kAttitudeColumns[c].scale);
    }
    text += "]\n";
  }
  return text;
}

}  // namespace dispersa
