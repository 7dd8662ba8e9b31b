#include "core/campaign_yaml/inline_files.h"
#include "core/campaign_yaml/load.h"
#include "core/input/number_text.h"
#include "core/trajectory/attitude_columns.h"
#include "core/trajectory/optimize.h"

namespace dispersa {
namespace {

std::string Km(double metres) { return FormatScaled(metres, 1e3); }

std::string DegBounds(const Bounds& bounds) {
  return "[" + FormatDegrees(bounds.low) + ", " + FormatDegrees(bounds.high) + "]";
}
std::string Limits(const Bounds& bounds) {
  return "[" + FormatNumber(bounds.low) + ", " + FormatNumber(bounds.high) + "]";
}

// Names come from other files and may hold anything.
std::string Quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? "''" : std::string(1, c);
  return quoted + "'";
}

std::string TargetText(const TrajectoryProblem& problem) {
  std::string text = "  target: {";
  if (problem.target_apogee_m) {
    text += "perigee_altitude_km: " + Km(problem.target_altitude_m) +
            ", apogee_altitude_km: " + Km(*problem.target_apogee_m);
  } else {
    text += "altitude_km: " + Km(problem.target_altitude_m);
    if (!problem.velocity_is_free) text += ", velocity_m_s: " + FormatNumber(problem.target_velocity_m_s);
    text += ", flight_path_angle_deg: " + FormatDegrees(problem.target_flight_path_angle_rad);
  }
  if (problem.target_inclination_rad)
    text += ", inclination_deg: " + FormatDegrees(*problem.target_inclination_rad);
  if (problem.target_node_rad) text += ", node_deg: " + FormatDegrees(*problem.target_node_rad);
  if (problem.target_argument_of_perigee_rad)
    text += ", argument_of_perigee_deg: " + FormatDegrees(*problem.target_argument_of_perigee_rad);
  return text + "}\n";
}

std::string StageKey(std::size_t stage, const char* what) {
  return "stage" + std::to_string(stage + 1) + "_" + what + "_s: ";
}

std::string IncidenceKey(std::size_t stage, const char* when) {
  return "stage" + std::to_string(stage + 1) + "_incidence_" + when + "_deg: ";
}

std::string ProblemText(const TrajectoryProblem& problem) {
  std::string text;
  text += "problem:\n";
  text += TargetText(problem);
  text += "  bounds:\n";
  text += "    alpha_max_deg: " + DegBounds(problem.alpha_max_rad) + "\n";
  text += "    t1_s: " + Limits(problem.t1_s) + "\n";
  text += "    t3_s: " + Limits(problem.t3_s) + "\n";
  text += "    t2_s: " + Limits(problem.t2_s) + "\n";
  text += "    coast_s: " + Limits(problem.coast_s) + "\n";
  text += "    launch_azimuth_deg: " + DegBounds(problem.launch_azimuth_rad) + "\n";
  for (std::size_t stage = 1; stage < problem.earlier_coast_s.size(); ++stage)
    if (problem.earlier_coast_s[stage].high > 0.0)
      text += "    " + StageKey(stage, "coast") + Limits(problem.earlier_coast_s[stage]) + "\n";
  for (std::size_t stage = 1; stage < problem.steering.size(); ++stage)
    if (!problem.steering[stage].empty())
      text += "    " + IncidenceKey(stage, "begin") + DegBounds(problem.steering[stage].begin_rad) +
              "\n    " + IncidenceKey(stage, "end") + DegBounds(problem.steering[stage].end_rad) + "\n";
  text += "  weights: {altitude_per_km: " + FormatScaled(problem.weight_altitude_1_m, 1e-3) +
          ", velocity_per_m_s: " + FormatNumber(problem.weight_velocity_s_m) +
          ", flight_path_angle_per_deg: " + FormatScaled(problem.weight_angle_1_rad, kDegPerRad);
  if (problem.target_inclination_rad)
    text += ", inclination_per_deg: " + FormatScaled(problem.weight_inclination_1_rad, kDegPerRad);
  if (problem.target_argument_of_perigee_rad)
    text += ", argument_of_perigee_per_deg: " + FormatScaled(problem.weight_argument_1_rad, kDegPerRad);
  text += "}\n";
  text += "  limits:\n";
  text += "    axial_load_g: " + FormatNumber(problem.axial_load_limit_g) + "\n";
  text += "    lateral_load_g: " + FormatNumber(problem.lateral_load_limit_g) + "\n";
  text += "    alpha_deg: " + FormatDegrees(problem.alpha_limit_rad) + "\n";
  if (problem.turn_rate_limit_rad_s > 0.0) {
    text += "    turn_rate_deg_s: " + FormatDegrees(problem.turn_rate_limit_rad_s) + "\n";
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
  text += "  alpha_max_deg: " + FormatDegrees(program.alpha_max_rad) + "\n";
  text += "  t1_s: " + FormatNumber(program.t1_s) + "\n";
  text += "  t3_s: " + FormatNumber(program.t3_s) + "\n";
  text += "  t2_s: " + FormatNumber(program.t2_s) + "\n";
  text += "  coast_s: " + FormatNumber(program.coast_s) + "\n";
  text += "  launch_azimuth_deg: " + FormatDegrees(program.launch_azimuth_rad) + "\n";
  text += "  last_ignition_s: " + FormatNumber(reference.last_ignition_s) + "\n";
  for (std::size_t stage = 1; stage < reference.earlier_ignition_s.size(); ++stage)
    if (reference.earlier_ignition_s[stage] > 0.0)
      text += "  " + StageKey(stage, "coast") + FormatNumber(program.earlier_coast_s[stage]) + "\n  " +
              StageKey(stage, "ignition") + FormatNumber(reference.earlier_ignition_s[stage]) + "\n";
  for (std::size_t stage = 1; stage < program.steering.size(); ++stage)
    if (!program.steering[stage].empty())
      text += "  " + IncidenceKey(stage, "begin") + FormatDegrees(program.steering[stage].begin_rad) +
              "\n  " + IncidenceKey(stage, "end") + FormatDegrees(program.steering[stage].end_rad) + "\n";
  text += "orbit: {altitude_km: " + Km(orbit.altitude_m) +
          ", velocity_m_s: " + FormatNumber(orbit.velocity_m_s) +
          ", flight_path_angle_deg: " + FormatDegrees(orbit.flight_path_angle_rad) +
          ", inclination_deg: " + FormatDegrees(orbit.inclination_rad);
  if (problem.target_node_rad) text += ", node_longitude_deg: " + FormatDegrees(orbit.node_longitude_rad);
  if (problem.target_argument_of_perigee_rad)
    text += ", argument_of_latitude_deg: " + FormatDegrees(orbit.argument_of_latitude_rad);
  text += "}\n";
  const OrbitErrors errors = ErrorsOf(problem, orbit);
  text += "errors: {altitude_km: " + Km(errors.altitude_m) +
          ", velocity_m_s: " + FormatNumber(errors.velocity_m_s) +
          ", flight_path_angle_deg: " + FormatDegrees(errors.flight_path_angle_rad);
  if (problem.target_inclination_rad) text += ", inclination_deg: " + FormatDegrees(errors.inclination_rad);
  if (problem.target_argument_of_perigee_rad)
    text += ", argument_of_perigee_deg: " + FormatDegrees(errors.argument_of_perigee_rad);
  text += "}\n";
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
