// dispersa optimize: the trajectory that reaches the target orbit, as a reference file.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/campaign_yaml/load.h"
#include "core/math/constants.h"
#include "core/pages/trajectory_figures.h"
#include "core/pages/trajectory_page.h"
#include "services/cli/command.h"
#include "services/cli/terminal_observer.h"
#include "services/cli/warn.h"
#include "services/client/reference_search.h"
#include "services/log/log.h"
#include "services/program/option_values.h"
#include "services/program/threads.h"

namespace dispersa {
namespace {

struct OptimizeOptions {
  std::string campaign;
  std::string out;
  std::optional<std::uint64_t> seed;
  int threads = 0;  ///< 0: the processor's
};

void PrintInjection(const OptimizationResult& result, const std::optional<CheckFlight>& check) {
  const bool flown = check && check->completed();
  fmt::print("{:<26}{:>12}{:>16}{:>12}{:>14}", AscentEndWords(result.history), "desired", "reached", "error",
             "half the step");
  fmt::print("{}\n", flown ? fmt::format("{:>14}", "closed loop") : "");
  for (const InjectionRow& row : InjectionRows(result, check)) {
    // Rounded to what is shown, and never a negative zero.
    fmt::print("{:<26}{:>12.6g}{:>16.7f}{:>+12.2g}{:>+14.2g}", row.name, row.desired,
               std::round(row.reached * 1e7) / 1e7 + 0.0, row.error, row.halved);
    fmt::print("{}\n", row.flown ? fmt::format("{:>+14.2g}", *row.flown) : "");
  }
  fmt::print("{}\n", OrbitSentence(result.reference));
  if (flown) fmt::print("closed loop: errors of the nominal flight under the campaign's autopilot\n");
  if (check) fmt::print("{}\n", CheckFlightText(*check));
}

void PrintText(const OptimizationResult& result, const std::optional<CheckFlight>& check) {
  const Reference& reference = result.reference;
  const FlightProgram& program = reference.program;
  PrintInjection(result, check);
  fmt::print(
      "\nflight program: alpha_max {:.6f} deg, t1 {:.4f} s, t3 {:.4f} s, t2 {:.4f} s, coast {:.4f} s, "
      "launch azimuth {:.6f} deg\n",
      program.alpha_max_rad * kDegPerRad, program.t1_s, program.t3_s, program.t2_s, program.coast_s,
      program.launch_azimuth_rad * kDegPerRad);
  for (std::size_t i = 1; i < program.earlier_coast_s.size(); ++i)
    if (reference.earlier_ignition_s[i] > 0.0)
      fmt::print("coast before stage {}: {:.4f} s, its ignition at {:.4f} s\n", i + 1,
                 program.earlier_coast_s[i], reference.earlier_ignition_s[i]);
  for (std::size_t i = 0; i < program.steering.size(); ++i)
    if (!program.steering[i].empty())
      fmt::print("incidence of stage {}: {:+.4f} deg at ignition, {:+.4f} deg at depletion\n", i + 1,
                 program.steering[i].begin_rad * kDegPerRad, program.steering[i].end_rad * kDegPerRad);
  fmt::print("\n{:<28}{:>14}{:>14}{:>14}\n", "constraint", "value", "limit", "margin");
  for (const ConstraintMargin& constraint : reference.constraints) {
    if (constraint.enforced) {
      fmt::print("{:<28}{:>14.6g}{:>14.6g}{:>14.6g}\n", constraint.name, constraint.value, constraint.limit,
                 constraint.margin);
    } else {
      fmt::print("{:<28}{:>14.6g}{:>14}\n", constraint.name, constraint.value, "none");
    }
  }
  if (const std::string text = LimitsThatDoNotBind(reference); !text.empty()) fmt::print("{}\n", text);
  fmt::print("\nseed {}, {} ascents\n", reference.problem.seed, reference.evaluations);
}

ExitCode Optimize(const OptimizeOptions& options, const GlobalOptions& global) {
  std::vector<InputProblem> warnings;
  const OptimizationInput input = LoadOptimization(options.campaign, options.seed, &warnings);
  Warn(warnings);
  const int threads = ThreadsOrAll(options.threads);
  const std::filesystem::path file = options.out.empty() ? input.name + "_reference.yaml" : options.out;
  if (file == "-")
    throw InputError("--out: '-' is one stream, but optimize writes three files", "a file name");
  RequireWritableReference("--out", file);
  TerminalObserver observer(global.quiet);
  const FoundReference found = FindReference(input, threads, observer);
  observer.EndPhase();
  WriteFoundReference(found, file);
  const OptimizationResult& result = found.result;
  if (global.json) {
    fmt::print("{}\n", FoundReferenceJson(input.vehicle, found, file.string()).dump(2));
  } else {
    PrintText(result, found.check);
    fmt::print("reference{}: {}\n", result.reached ? "" : ", which misses its target", file.string());
  }
  if (found.reached()) return kExitDone;
  Tell("{}\n", found.Statement());
  return kExitRequirementFailed;
}

}  // namespace

void AddOptimizeCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<OptimizeOptions>();
  CLI::App* command =
      app.add_subcommand("optimize", "find the trajectory that reaches a campaign's target orbit");
  command->add_option("campaign", options->campaign, "campaign file, with an optimize block or a reference")
      ->required()
      ->type_name(kYamlType);
  command
      ->add_option(
          "-o,--out", options->out,
          "reference file to write; the time history goes beside it as .csv, figures and tables as .html; "
          "default <name>_reference.yaml. A reference that misses its target is written too, with a mark")
      ->type_name(kFileType);
  command->add_option("--seed", options->seed, "seed, instead of the file's");
  command->add_option("--threads", options->threads, "threads; the result does not depend on them")
      ->transform(WholeNumber(1, 1024));
  command->footer(
      "Example: dispersa optimize campaigns/nominal.yaml -o slv4_500km.yaml --seed 2\n"
      "The shipped reference: dispersa optimize campaigns/slv4_500km.yaml -o "
      "campaigns/references/slv4_500km.yaml");
  Bind(command, invocation, options, Optimize);
}

}  // namespace dispersa
