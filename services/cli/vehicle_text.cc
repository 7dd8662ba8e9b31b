#include "services/cli/vehicle_text.h"

#include <fmt/format.h>

#include <vector>

#include "core/flight/structural_limits.h"
#include "core/results/text.h"
#include "core/vehicle/propulsion.h"
#include "core/vehicle/vehicle_figures.h"

namespace dispersa {
namespace {

double TotalDeltaV(const std::vector<StageFigures>& figures) {
  double sum_m_s = 0.0;
  for (const StageFigures& one : figures) sum_m_s += one.ideal_delta_v_m_s;
  return sum_m_s;
}

std::string BoosterText(const Vehicle& vehicle) {
  const Boosters& b = vehicle.boosters;
  const MotorBurn burn = BuildBoosterBurn(b, 1.0, 1.0);
  return fmt::format(
      "{} boosters beside {}, each of {} kg with {} kg of propellant, {} kN and {} s{}\n", b.count,
      vehicle.stages[0].name, ReadableText(b.dry_mass_kg + b.propellant_mass_kg),
      ReadableText(b.propellant_mass_kg), ReadableText(1e-3 * b.motor.thrust_n),
      ReadableText(burn.duration_s),
      vehicle.aerodynamics.empty() ? "; the aerodynamics are built up from the core's profile alone" : "");
}

std::string JettisonText(const Stage& stage, const Jettison& jettison) {
  const char* when = jettison.trigger == JettisonTrigger::kAtTime       ? "at {} s"
                     : jettison.trigger == JettisonTrigger::kAtAltitude ? "at {} m"
                                                                        : "at a heat flux of {} W/m2";
  return fmt::format("jettisoned from {}: {}, {} kg, {}; the masses above include it\n", stage.name,
                     jettison.name, ReadableText(jettison.mass_kg),
                     fmt::format(fmt::runtime(when), ReadableText(jettison.threshold)));
}

// Of a test stand's table, if it was thinned.
std::string ThinnedText(const std::string& whose, const ThrustCurve& curve) {
  if (curve.thinned.rows == 0) return {};
  return fmt::format(
      "thrust table of {}: {} rows thinned to {} corners; impulse kept, thrust within {:.2g} % of the "
      "greatest{}\n",
      whose, curve.thinned.rows, curve.time_s.size(), 100.0 * curve.thinned.thrust_error,
      curve.flow_kg_s.empty() ? ""
                              : fmt::format(", mass flow within {:.2g} %", 100.0 * curve.thinned.flow_error));
}

}  // namespace

std::string VehicleText(const Vehicle& vehicle) {
  const std::vector<StageFigures> figures = FiguresOf(vehicle);
  std::string text =
      fmt::format("\n{}: {} kg, {} m\n", vehicle.name, ReadableText(vehicle.stages[0].liftoff_mass_kg),
                  ReadableText(vehicle.stages[0].bottom_station_m));
  text +=
      fmt::format("{:<12}{:>12}{:>12}{:>10}{:>10}{:>10}{:>9}{:>9}{:>11}{:>10}{:>9}\n", "stage", "at ignition",
                  "propellant", "dry", "dry/own", "thrust", "burn", "Isp", "ideal dv", "T/W", "burnout");
  text += fmt::format("{:<12}{:>12}{:>12}{:>10}{:>10}{:>10}{:>9}{:>9}{:>11}{:>10}{:>9}\n", "", "kg", "kg",
                      "kg", "", "kN", "s", "s", "m/s", "ignition", "g");
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const Stage& stage = vehicle.stages[i];
    const StageFigures& one = figures[i];
    text += fmt::format(
        "{:<12}{:>12.0f}{:>12.0f}{:>10.0f}{:>10.3f}{:>10.1f}{:>9.1f}{:>9.1f}{:>11.0f}{:>10.2f}{:>9.2f}\n",
        stage.name.substr(0, 11), stage.liftoff_mass_kg, stage.propellant_mass_kg, one.dry_mass_kg,
        one.structural_fraction, stage.motor.thrust_n * 1e-3, one.burning_time_s, one.specific_impulse_s,
        one.ideal_delta_v_m_s, one.thrust_to_weight, one.burnout_load_g);
  }
  text += fmt::format("{:<12}{:>84.0f}\n", "together", TotalDeltaV(figures));
  text +=
      "dry/own of the last stage includes the payload; dv and Isp in vacuum, without losses; T/W of stage 1 "
      "at its release\n";
  if (vehicle.boosters.count > 0)
    text += BoosterText(vehicle) + ThinnedText("the boosters", vehicle.boosters.motor.thrust_curve);
  for (const Stage& stage : vehicle.stages) text += ThinnedText(stage.name, stage.motor.thrust_curve);
  for (std::size_t i = 0; i < vehicle.aerodynamics.size() && i < vehicle.stages.size(); ++i)
    if (!vehicle.aerodynamics[i].yaw_plane.empty())
      text += fmt::format("aerodynamics from {} on: two planes of symmetry, each with a table of its own\n",
                          vehicle.stages[i].name);
  for (const Stage& stage : vehicle.stages)
    for (const Jettison& jettison : stage.jettisoned) text += JettisonText(stage, jettison);
  std::string limits;
  for (const StructuralLimit& limit : AllStructuralLimits()) {
    const double value = vehicle.limits.*limit.limit;
    if (value > 0.0)
      limits += fmt::format("{}{} {}", limits.empty() ? "" : ", ", limit.metric, ReadableText(value));
  }
  return text + "limits: " + (limits.empty() ? "none, so no load is checked" : limits) + "\n";
}

nlohmann::ordered_json VehicleJson(const Vehicle& vehicle) {
  const std::vector<StageFigures> figures = FiguresOf(vehicle);
  auto stages = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const StageFigures& one = figures[i];
    stages.push_back({{"name", vehicle.stages[i].name},
                      {"liftoff_mass_kg", vehicle.stages[i].liftoff_mass_kg},
                      {"propellant_mass_kg", vehicle.stages[i].propellant_mass_kg},
                      {"dry_mass_kg", one.dry_mass_kg},
                      {"structural_fraction", one.structural_fraction},
                      {"specific_impulse_s", one.specific_impulse_s},
                      {"ideal_delta_v_m_s", one.ideal_delta_v_m_s},
                      {"thrust_to_weight", one.thrust_to_weight},
                      {"burnout_load_g", one.burnout_load_g}});
    const ThrustCurve& curve = vehicle.stages[i].motor.thrust_curve;
    if (curve.thinned.rows > 0)
      stages.back()["thrust_table"] = {{"rows", curve.thinned.rows},
                                       {"corners", curve.time_s.size()},
                                       {"thrust_error", curve.thinned.thrust_error}};
  }
  return {{"name", vehicle.name}, {"ideal_delta_v_m_s", TotalDeltaV(figures)}, {"stages", std::move(stages)}};
}

}  // namespace dispersa
