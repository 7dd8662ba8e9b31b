// dispersa modes: how a vehicle bends.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/campaign_yaml/load.h"
#include "core/input/input_error.h"
#include "core/math/constants.h"
#include "core/pages/modes_page.h"
#include "core/results/json_number.h"
#include "core/results/output_file.h"
#include "core/structure/bending_modes.h"
#include "core/structure/free_body.h"
#include "core/vehicle/mass.h"
#include "services/cli/command.h"
#include "services/cli/warn.h"
#include "services/client/writable.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;

struct ModesOptions {
  std::string vehicle;
  std::string out;
  bool shapes = false;
};

const char* PlaneName(BeamPlane plane) { return plane == BeamPlane::kY ? "y" : "z"; }

nlohmann::ordered_json ModeJson(const Vehicle& vehicle, const StackModes& stack, BeamPlane plane,
                                std::size_t index, const BendingMode& mode, bool shapes) {
  auto places = nlohmann::ordered_json::array();
  for (const BeamSensor& place : ShownStations(vehicle, stack.stage)) {
    const StationShape at = ShapeOf(stack, plane, mode, place.station_m);
    places.push_back({{"name", place.name},
                      {"station_m", place.station_m},
                      {"deflection", Number(at.deflection)},
                      {"slope_1_m", Number(at.slope_1_m)}});
  }
  nlohmann::ordered_json json = {{"plane", PlaneName(plane)},
                                 {"mode", index + 1},
                                 {"frequency_hz", mode.frequency_rad_s / kTwoPi},
                                 {"generalized_mass_kg", mode.generalized_mass_kg},
                                 {"mac", mode.mac},
                                 {"stations", std::move(places)}};
  if (shapes)
    json["shape"] = {{"station_m", stack.station_m[plane == BeamPlane::kY ? 0 : 1]},
                     {"deflection", mode.deflection},
                     {"slope_1_m", mode.slope_1_m}};
  return json;
}

// Planes may have levels of their own, in a table of a finite-element model: an entry for each level of
// either.
nlohmann::ordered_json StacksJson(const Vehicle& vehicle, const std::vector<StackModes>& stacks,
                                  bool shapes) {
  const std::vector<StackMass> masses = BuildStackMasses(vehicle);
  const std::vector<JettisonedMass> jettisons = BuildJettisonedMasses(vehicle);
  auto json = nlohmann::ordered_json::array();
  for (const StackModes& stack : stacks) {
    std::vector<double> levels;
    for (const std::vector<BendingLevel>& plane : stack.levels) {
      for (const BendingLevel& level : plane) levels.push_back(level.propellant_kg);
    }
    std::sort(levels.begin(), levels.end(), std::greater<>());
    levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
    for (const double propellant_kg : levels) {
      auto modes = nlohmann::ordered_json::array(), elements = modes;
      for (const std::vector<double>& nodes_m : stack.station_m) elements.push_back(nodes_m.size() - 1);
      for (const BeamPlane plane : kBeamPlanes) {
        for (const BendingLevel& level : stack.levels[plane == BeamPlane::kY ? 0 : 1]) {
          if (level.propellant_kg != propellant_kg) continue;
          for (std::size_t i = 0; i < level.modes.size(); ++i)
            modes.push_back(ModeJson(vehicle, stack, plane, i, level.modes[i], shapes));
        }
      }
      MassProperties rigid =
          Without(masses[static_cast<std::size_t>(stack.stage)], stack.stage, jettisons, stack.gone)
              .At(propellant_kg);
      if (stack.stage == 0 && vehicle.boosters.count > 0) {  // with the propellant that they have then
        const FreeBody body(BuildBeamMasses(vehicle, 0, propellant_kg, stack.gone), {});
        rigid.mass_kg = body.mass_kg;
        rigid.cg_station_m = body.cg_station_m;
      }
      json.push_back({{"stage", stack.stage + 1},
                      {"jettisoned", stack.gone != 0},
                      {"propellant_kg", propellant_kg},
                      {"mass_kg", rigid.mass_kg},
                      {"cg_station_m", rigid.cg_station_m},
                      {"elements", elements},
                      {"mesh_difference", stack.mesh_difference},
                      {"modes", std::move(modes)}});
    }
  }
  return json;
}

void PrintStack(const Vehicle& vehicle, const StackModes& stack, BeamPlane plane) {
  const std::vector<BendingLevel>& levels = stack.levels[plane == BeamPlane::kY ? 0 : 1];
  const std::size_t count = levels.front().modes.size();
  fmt::print("\nstage {} and above{}, plane {}\n{:>14}", stack.stage + 1, WithoutText(vehicle, stack),
             stack.axisymmetric ? "y, z" : PlaneName(plane), "propellant kg");
  for (std::size_t i = 0; i < count; ++i) fmt::print("{:>11} {} Hz{:>9} kg", "mode", i + 1, "gen.");
  fmt::print("\n");
  for (const BendingLevel& level : levels) {
    fmt::print("{:>14.1f}", level.propellant_kg);
    for (const BendingMode& mode : level.modes)
      fmt::print("{:>16.3f}{:>12.1f}", mode.frequency_rad_s / kTwoPi, mode.generalized_mass_kg);
    fmt::print("\n");
  }
  fmt::print("{:<24}{:>10}   deflection and slope 1/m of each mode, full, then empty\n", "", "station m");
  for (const BeamSensor& place : ShownStations(vehicle, stack.stage)) {
    for (std::size_t i = 0; i < levels.size(); i += std::max<std::size_t>(levels.size() - 1, 1)) {
      const BendingLevel& level = levels[i];
      fmt::print("{:<24}{:>10.2f}", i == 0 ? place.name : "", place.station_m);
      for (const BendingMode& mode : level.modes) {
        const StationShape at = ShapeOf(stack, plane, mode, place.station_m);
        fmt::print("  {:>+8.3f} {:>+8.4f}", at.deflection, at.slope_1_m);
      }
      fmt::print("\n");
    }
  }
  if (const std::string mesh = MeshText(stack, plane == BeamPlane::kY ? 0 : 1); !mesh.empty())
    fmt::print("{}\n", mesh);
}

// A name that ends in .html is the page's, any other a folder's. Folders are made.
fs::path PageFile(const std::string& out) {
  const fs::path path = out;
  const fs::path page = path.extension() == ".html" ? path : path / "modes.html";
  std::error_code error;
  if (page.has_parent_path()) fs::create_directories(page.parent_path(), error);
  if (error)
    throw InputError("--out: " + out + ": " + error.message(),
                     "a folder that can be written, or a .html file");
  return page;
}

ExitCode Modes(const ModesOptions& options, const GlobalOptions& global) {
  std::vector<InputProblem> warnings;
  const Vehicle vehicle = LoadVehicle(options.vehicle, &warnings);
  if (!vehicle.structure_beam)
    throw InputError(
        {{options.vehicle, 1, 1, "", "the vehicle is rigid", "a vehicle with a structure_beam"}});
  Warn(warnings);
  const fs::path page = options.out.empty() ? fs::path() : PageFile(options.out);
  RequireWritableFile("--out", page);
  const std::vector<StackModes> stacks = ShownStacks(vehicle);
  if (!page.empty()) WriteFile(page, ModesPage(vehicle, stacks));
  if (global.json) {
    nlohmann::ordered_json json = {{"schema", "dispersa/modes/1"},
                                   {"vehicle", vehicle.name},
                                   {"beam", BeamText(*vehicle.structure_beam)},
                                   {"stacks", StacksJson(vehicle, stacks, options.shapes)}};
    if (!page.empty()) json["page"] = page.string();
    fmt::print("{}\n", json.dump(2));
    return kExitDone;
  }
  fmt::print("{}. {}. Deflections are scaled to a largest of 1.\n", vehicle.name,
             BeamText(*vehicle.structure_beam));
  for (const StackModes& stack : stacks) {
    PrintStack(vehicle, stack, BeamPlane::kY);
    if (!stack.axisymmetric) PrintStack(vehicle, stack, BeamPlane::kZ);
  }
  if (!page.empty()) fmt::print("\npage: {}\n", page.string());
  return kExitDone;
}

}  // namespace

void AddModesCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<ModesOptions>();
  CLI::App* command =
      app.add_subcommand("modes", "print the bending modes of a vehicle, by stack and propellant");
  command->add_option("vehicle", options->vehicle, "vehicle file with a structure_beam")
      ->required()
      ->type_name(kYamlType);
  command
      ->add_option("--out", options->out,
                   "write the plots too: a folder for modes.html, or a name that ends in .html")
      ->type_name(kFolderType);
  command->add_flag("--shapes", options->shapes, "with --json: the whole shapes, node by node");
  command->footer(
      "Frequencies, generalised masses, and deflection and slope at the beam's sensors and the nozzle "
      "pivot.\n"
      "Example: dispersa modes campaigns/vehicles/slv4_flexible.yaml --out modes");
  Bind(command, invocation, options, Modes);
}

}  // namespace dispersa
