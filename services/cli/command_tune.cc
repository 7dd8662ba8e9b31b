// dispersa tune: an autopilot's gains, found by the one procedure that tunes every law.
#include <fmt/format.h>

#include <memory>
#include <string>

#include "core/campaign_yaml/load.h"
#include "core/results/output_file.h"
#include "services/cli/command.h"
#include "services/cli/stream_beside.h"
#include "services/cli/terminal_observer.h"
#include "services/cli/warn.h"
#include "services/client/autopilot_tuning.h"
#include "services/client/writable.h"
#include "services/log/log.h"
#include "services/program/option_values.h"
#include "services/program/threads.h"

namespace dispersa {
namespace {

struct TuneOptions {
  TuningRequest request;
  int threads = 0;  ///< 0: the processor's
};

// The part that a line of the log is about: a stage's number, or the augmentation.
std::string PartText(const TuningRecord& record, const TuningResult& result) {
  return record.stage < std::ssize(result.stages) ? fmt::format("{}", record.stage + 1) : "augm.";
}

void PrintText(std::FILE* stream, const TuningRequest& request, const TunedAutopilot& tuned_autopilot) {
  const auto& [result, log] = tuned_autopilot;
  if (!result.nominal_loss.empty()) fmt::print(stream, "warning: {}\n", result.nominal_loss);
  if (!result.start_loss.empty())
    fmt::print(stream,
               "warning: With the design that the search starts from: {} Margins are computed up to there.\n",
               result.start_loss);
  fmt::print(stream, "{:<6}{:>11}{:>10}{:>14}{:>14}\n", "stage", "generation", "feasible", "best rms deg",
             "mean rms deg");
  const auto number = [](const std::optional<double>& value) {
    return value ? fmt::format("{:.5f}", *value) : std::string("-");
  };
  for (const TuningRecord& record : log) {
    const GenerationRecord& g = record.generation;
    fmt::print(stream, "{:<6}{:>11}{:>9.0f}%{:>14}{:>14}\n", PartText(record, result), g.generation,
               100.0 * g.feasible_fraction, number(g.best_objective), number(g.mean_objective));
  }
  fmt::print(stream, "\n{:<6}{:>9}{:>9}{:>10}{:>13}{:>10}  {}\n", "stage", "kp 1/s2", "kd 1/s", "gamma, ki",
             "mean rms deg", "peak deg", "least margins, frozen | adapting");
  for (std::size_t i = 0; i < result.stages.size(); ++i) {
    const StageTuning& stage = result.stages[i];
    const AxisConfig& axis = result.autopilot.pitch;
    const LawInfo& law = InfoOf(axis.law);
    const std::string learning = law.adaptation ? fmt::format("{}", axis.adaptation.gamma[i])
                                 : law.integral ? fmt::format("{}", axis.integral.ki_1_s3[i])
                                                : std::string("-");
    fmt::print(stream, "{:<6}{:>9}{:>9}{:>10}{:>13.5f}{:>10.4f}  {} | {}{}\n", i + 1, axis.gains[i].kp_1_s2,
               axis.gains[i].kd_1_s, learning, stage.mean_rms_deg, stage.peak_deg, MarginsText(stage.frozen),
               MarginsText(stage.adapting), stage.feasible ? "" : "  INFEASIBLE");
    if (!stage.missed.empty()) fmt::print(stream, "      misses by most: {}\n", stage.missed);
  }
  if (!result.skipped.empty())
    fmt::print(stream, "No margins are required below {:g} % of full thrust:\n",
               100.0 * kLeastThrustFraction);
  for (const SkippedInstant& at : result.skipped)
    fmt::print(stream, "      {:.2f} s, stage {}{}\n", at.time_s, at.stage + 1,
               at.place.empty() ? "" : ", " + at.place);
  if (result.augmentation) {
    const AugmentationTuning& tuned = *result.augmentation;
    fmt::print(
        stream,
        "augmentation: adaptive gain {:.3g} 1/s, spectral gain {:.3g} 1/s, total gain to {:.3g}; mean rms "
        "{:.5f} deg, peak {:.4f} deg{}\n",
        tuned.design.adaptive_gain_1_s, tuned.design.spectral_gain_1_s, tuned.design.maximum_total_gain,
        tuned.mean_rms_deg, tuned.peak_deg, tuned.feasible ? "" : "  INFEASIBLE");
    if (!tuned.missed.empty()) fmt::print(stream, "      misses by most: {}\n", tuned.missed);
  }
  fmt::print(stream, "\n{} designs, {} flights\n", result.evaluations, result.flights);
  if (!result.feasible) return;
  fmt::print(stream,
             "median powered RMS pitch error {:.5f} deg, largest peak {:.4f} deg over {} cases of seed {}\n",
             result.median_rms_deg, result.largest_peak_deg, request.tuning.cases, request.tuning.seed);
  fmt::print(stream, "autopilot: {}\n", request.out);
}

ExitCode RunTuning(const TuneOptions& options, const GlobalOptions& global) {
  TuningRequest request = options.request;
  request.tuning.threads = ThreadsOrAll(options.threads);
  std::FILE* const stream = StreamBeside("--out", request.out, global);
  RequireWritableFile("--out", request.out);
  const Campaign campaign = LoadAndWarn(request.campaign);
  const AutopilotConfig autopilot =
      request.autopilot.empty() ? campaign.autopilot : LoadAutopilot(request.autopilot);

  TerminalObserver observer(global.quiet);
  const TunedAutopilot tuned = TuneAutopilot(campaign, autopilot, request.tuning, observer);
  WriteFile(request.out, TunedFile(request, tuned));
  if (global.json) {
    fmt::print("{}\n", TuningJson(request, tuned).dump(2));
  } else {
    PrintText(stream, request, tuned);
  }
  if (tuned.result.feasible) return kExitDone;
  Tell("no design was found that meets every constraint; {} has the best one that was found\n", request.out);
  return kExitRequirementFailed;
}

}  // namespace

void AddTuneCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<TuneOptions>();
  CLI::App* command = app.add_subcommand("tune", "find the gains of an autopilot with any control law");
  command
      ->add_option("campaign", options->request.campaign, "campaign file: vehicle, reference and dispersions")
      ->required()
      ->type_name(kYamlType);
  command
      ->add_option("-o,--out", options->request.out,
                   "autopilot file to write; if a constraint is missed, the autopilot's name says so; -: "
                   "standard output")
      ->required()
      ->type_name(kFileType);
  command
      ->add_option("--autopilot", options->request.autopilot,
                   "autopilot file with the law and the fixed parameters, instead of the campaign's")
      ->type_name(kYamlType);
  command
      ->add_option("--seed", options->request.tuning.seed,
                   "seed of the search and of its cases; must not be the campaign's")
      ->capture_default_str();
  command->add_option("--cases", options->request.tuning.cases, "cases flown for each design")
      ->transform(WholeNumber(1, 10000))
      ->capture_default_str();
  command
      ->add_option("--evaluations", options->request.tuning.evaluations,
                   "number of designs to try, shared by the stages and the augmentation of PD")
      ->transform(WholeNumber(1, 1000000))
      ->capture_default_str();
  command
      ->add_option("--dispersed", options->request.tuning.dispersed,
                   "number of dispersed cases in which every design must meet the gates of dispersed flights")
      ->transform(WholeNumber(0, 1000))
      ->capture_default_str();
  command->add_flag(
      "--lqr", options->request.tuning.regulator,
      "search the weights of a linear-quadratic regulator and use its gains; for the laws pid and pid_aac");
  command->add_option("--threads", options->threads, "threads; the result does not depend on them")
      ->transform(WholeNumber(1, 1024));
  command->footer(
      "Minimises the mean RMS pitch error of each stage. The computed margins must be above the gates of\n"
      "`dispersa margins` with a reserve. Then it designs the augmentation of PD by the measured margins. It "
      "ignores\n"
      "the gains of the file and keeps the times of its schedule. Exit code 3: no design meets the "
      "constraints.\n"
      "Example: dispersa tune campaigns/table3.yaml --autopilot campaigns/autopilots/pd.yaml --out pd.yaml");
  Bind(command, invocation, options, RunTuning);
}

}  // namespace dispersa
