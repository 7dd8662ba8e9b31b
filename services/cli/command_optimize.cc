// dispersa optimize: the trajectory that reaches the target orbit, as a reference file.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

#include "core/campaign_yaml/load.h"
#include "core/math/constants.h"
#include "core/report/output_file.h"
#include "core/report/text.h"
#include "core/trajectory/optimize.h"
#include "services/cli/command.h"
#include "services/cli/flight_json.h"
#include "services/cli/progress.h"

namespace dispersa {
namespace {

struct OptimizeOptions {
  std::string campaign;
  std::string out;
  std::optional<std::uint64_t> seed;
  int threads = 0;  ///< 0: the processor's
};

std::string HistoryCsv(const std::vector<AscentSample>& history) {
  std::string csv =
      "time_s,stage,altitude_m,velocity_m_s,relative_velocity_m_s,flight_path_angle_deg,relative_path_angle_"
      "deg,"
      "alpha_deg,pitch_deg,yaw_deg,roll_deg,mach,qbar_pa,axial_load_g,mass_kg\n";
  for (const AscentSample& s : history) {
    csv += ShortestText(s.time_s) + "," + std::to_string(s.stage);
    for (const double value :
         {s.altitude_m, s.velocity_m_s, s.relative_velocity_m_s, s.flight_path_angle_rad * kDegPerRad,
          s.relative_path_angle_rad * kDegPerRad, s.alpha_rad * kDegPerRad, s.pitch_rad * kDegPerRad,
          s.yaw_rad * kDegPerRad, s.roll_rad * kDegPerRad, s.mach, s.qbar_pa, s.axial_load_g, s.mass_kg}) {
      csv += "," + ShortestText(value);
    }
    csv += "\n";
  }
  return csv;
}

nlohmann::ordered_json ResultJson(const OptimizationResult& result, const std::string& file) {
  const Reference& reference = result.reference;
  const FlightProgram& program = reference.program;
  auto constraints = nlohmann::ordered_json::array();
  for (const ConstraintMargin& constraint : reference.constraints) {
    constraints.push_back({{"name", constraint.name},
                           {"value", JsonNumber(constraint.value)},
                           {"limit", constraint.enforced ? JsonNumber(constraint.limit) : nullptr},
                           {"margin", constraint.enforced ? JsonNumber(constraint.margin) : nullptr}});
  }
  return {{"schema", "dispersa/optimize/1"},
          {"reference", result.reached ? nlohmann::ordered_json(file) : nullptr},
          {"orbit",
           {{"altitude_km", JsonNumber(reference.orbit.altitude_m * 1e-3)},
            {"velocity_m_s", JsonNumber(reference.orbit.velocity_m_s)},
            {"flight_path_angle_deg", JsonNumber(reference.orbit.flight_path_angle_rad * kDegPerRad)},
            {"inclination_deg", JsonNumber(reference.orbit.inclination_rad * kDegPerRad)}}},
          {"errors",
           {{"altitude_km", JsonNumber(result.errors.altitude_m * 1e-3)},
            {"velocity_m_s", JsonNumber(result.errors.velocity_m_s)},
            {"flight_path_angle_deg", JsonNumber(result.errors.flight_path_angle_rad * kDegPerRad)}}},
          {"variables",
           {{"alpha_max_deg", program.alpha_max_rad * kDegPerRad},
            {"t1_s", program.t1_s},
            {"t3_s", program.t3_s},
            {"t2_s", program.t2_s},
            {"coast_s", program.coast_s},
            {"launch_azimuth_deg", program.launch_azimuth_rad * kDegPerRad}}},
          {"constraints", std::move(constraints)},
          {"seed", reference.problem.seed},
          {"evaluations", reference.evaluations}};
}

// The paper's Table 2 stands beside ours.
void PrintText(const OptimizationResult& result) {
  const Reference& reference = result.reference;
  const TrajectoryProblem& problem = reference.problem;
  const FlightProgram& program = reference.program;
  fmt::print("{:<28}{:>12}{:>16}{:>14}\n", "injection", "desired", "reached", "error");
  fmt::print("{:<28}{:>12.6g}{:>16.6f}{:>14.3g}\n", "altitude, km", problem.target_altitude_m * 1e-3,
             reference.orbit.altitude_m * 1e-3, result.errors.altitude_m * 1e-3);
  fmt::print("{:<28}{:>12.6g}{:>16.6f}{:>14.3g}\n", "velocity, m/s", problem.target_velocity_m_s,
             reference.orbit.velocity_m_s, result.errors.velocity_m_s);
  fmt::print("{:<28}{:>12.6g}{:>16.6f}{:>14.3g}\n", "flight path angle, deg",
             problem.target_flight_path_angle_rad * kDegPerRad,
             reference.orbit.flight_path_angle_rad * kDegPerRad,
             result.errors.flight_path_angle_rad * kDegPerRad);
  fmt::print("{:<28}{:>28.6f}\n", "inclination, deg", reference.orbit.inclination_rad * kDegPerRad);
  fmt::print(
      "\nflight program: alpha_max {:.6f} deg, t1 {:.4f} s, t3 {:.4f} s, t2 {:.4f} s, coast {:.4f} s, "
      "launch azimuth {:.6f} deg\n\n",
      program.alpha_max_rad * kDegPerRad, program.t1_s, program.t3_s, program.t2_s, program.coast_s,
      program.launch_azimuth_rad * kDegPerRad);
  fmt::print("{:<36}{:>14}{:>14}{:>14}\n", "constraint", "value", "limit", "margin");
  for (const ConstraintMargin& constraint : reference.constraints) {
    if (constraint.enforced) {
      fmt::print("{:<36}{:>14.6g}{:>14.6g}{:>14.6g}\n", constraint.name, constraint.value, constraint.limit,
                 constraint.margin);
    } else {
      fmt::print("{:<36}{:>14.6g}{:>14}\n", constraint.name, constraint.value, "none");
    }
  }
  fmt::print("\nseed {}, {} evaluations\n", problem.seed, reference.evaluations);
}

OptimizationResult Search(const OptimizationInput& input, int threads, bool quiet) {
  Progress progress("optimize", quiet);
  const auto generations = static_cast<std::uint64_t>(input.problem.generations);
  const auto observe = [&](const GenerationRecord& record) {
    progress.Show(static_cast<std::uint64_t>(record.generation), generations,
                  record.best_objective ? fmt::format("best {:.4g}", *record.best_objective)
                                        : std::string("no feasible trajectory yet"));
  };
  try {
    TrajectoryOptions options;
    options.tick_s = input.tick_s;
    options.threads = threads;
    return OptimizeTrajectory(input.vehicle, input.problem, options, observe);
  } catch (const std::invalid_argument& error) {
    throw InputError(std::string("the optimisation problem cannot be solved as given: ") + error.what());
  }
}

ExitCode Optimize(const OptimizeOptions& options, const GlobalOptions& global) {
  const OptimizationInput input = LoadOptimization(options.campaign, options.seed);
  const int threads = options.threads > 0
                          ? options.threads
                          : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  OptimizationResult result = Search(input, threads, global.quiet);
  result.reference.name = input.name;
  result.reference.vehicle_sha256 = input.vehicle_sha256;

  const std::filesystem::path file = options.out.empty() ? input.name + "_reference.yaml" : options.out;
  if (result.reached) {
    std::filesystem::path history_file = file;
    history_file.replace_extension(".csv");
    WriteFile(file, WriteReference(result.reference));
    WriteFile(history_file, HistoryCsv(result.history));
  }
  if (global.json) {
    fmt::print("{}\n", ResultJson(result, file.string()).dump(2));
  } else {
    PrintText(result);
    if (result.reached) fmt::print("reference: {}\n", file.string());
  }
  if (result.reached) return kExitDone;
  fmt::print(stderr, "{}\n", result.statement);
  return kExitRequirementFailed;
}

}  // namespace

void AddOptimizeCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<OptimizeOptions>();
  CLI::App* command =
      app.add_subcommand("optimize", "find the trajectory that reaches a campaign's target orbit");
  command->add_option("campaign", options->campaign, "campaign file, with an optimize block or a reference")
      ->required();
  command->add_option("-o,--out", options->out,
                      "reference file to write; the time history goes beside it as .csv; default "
                      "<name>_reference.yaml. Nothing is written when the target is not reached");
  command->add_option("--seed", options->seed, "seed, instead of the file's");
  command->add_option("--threads", options->threads, "threads; the result does not depend on them")
      ->check(CLI::Range(1, 1024));
  command->footer("Example: dispersa optimize campaigns/nominal.yaml -o slv4_500km.yaml --seed 2");
  command->callback([options, &invocation] {
    invocation.command = [options](const GlobalOptions& global) { return Optimize(*options, global); };
  });
}

}  // namespace dispersa
