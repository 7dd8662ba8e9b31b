// dispersa tune: an autopilot's gains, found by the one procedure that tunes every law.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "core/campaign/free_flight.h"
#include "core/campaign_yaml/load.h"
#include "core/results/json_number.h"
#include "core/results/output_file.h"
#include "core/tuning/regulator.h"
#include "core/tuning/tune.h"
#include "services/cli/command.h"
#include "services/cli/progress.h"
#include "services/cli/stream_beside.h"
#include "services/cli/warn.h"
#include "services/client/margins_of.h"
#include "services/client/writable.h"
#include "services/log/log.h"
#include "services/program/option_values.h"
#include "services/program/threads.h"

namespace dispersa {
namespace {

struct TuneOptions {
  std::string campaign;
  std::string out;
  std::string autopilot;  ///< empty: the campaign's
  TuningOptions tuning;
  int threads = 0;  ///< 0: the processor's
};

// The command that gives the same file again; the number of threads does not matter.
std::string CommandText(const TuneOptions& options) {
  std::string text = "dispersa tune " + options.campaign;
  if (!options.autopilot.empty()) text += " --autopilot " + options.autopilot;
  if (options.tuning.regulator) text += " --lqr";
  if (options.tuning.dispersed > 0) text += fmt::format(" --dispersed {}", options.tuning.dispersed);
  return text + fmt::format(" --out {} --seed {} --cases {} --evaluations {}", options.out,
                            options.tuning.seed, options.tuning.cases, options.tuning.evaluations);
}

// The law and the meaning of its numbers, as comment lines.
std::string LawText(ControlLaw law) {
  constexpr std::size_t kColumns = 108;
  std::istringstream words(InfoOf(law).meaning);
  std::string text, line = "#";
  for (std::string word; words >> word;) {
    if (line.size() + 1 + word.size() > kColumns) {
      text += line + "\n";
      line = "#";
    }
    line += " " + word;
  }
  return text + line +
         "\n"
         "# Gains are those of the error dynamics s² + kd s + kp, one entry per stage; roll has those of "
         "pitch.\n";
}

// The weights behind a regulator's gains.
std::string RegulatorText(const AxisConfig& axis) {
  std::string text =
      "# They are those of a linear-quadratic regulator, optimal for e'' = -u and these weights of (∫e)², "
      "e², e'² beside u²:\n";
  for (std::size_t i = 0; i < axis.gains.size(); ++i) {
    const RegulatorWeights q =
        WeightsOf({axis.integral.ki_1_s3[i], axis.gains[i].kp_1_s2, axis.gains[i].kd_1_s});
    text += fmt::format("#   stage {}: {:.3g} 1/s^6, {:.3g} 1/s^4, {:.3g} 1/s^2\n", i + 1, q.integral_1_s6,
                        q.angle_1_s4, q.rate_1_s2);
  }
  return text;
}

// The part that a line of the log is about: a stage's number, or the augmentation.
std::string PartText(const TuningRecord& record, const TuningResult& result) {
  return record.stage < std::ssize(result.stages) ? fmt::format("{}", record.stage + 1) : "augm.";
}

std::string MarginsText(const LeastMargins& m) {
  return fmt::format("{:.1f} dB, {:.1f} deg, {:.0f} ms", m.gain_db, m.phase_deg, 1e3 * m.delay_s);
}

// The comment at the head of the file.
/// Behind the name of an autopilot that no gate has let pass.
constexpr char kMissed[] = " (misses a constraint)";

std::string Header(const TuneOptions& options, const TuningResult& result) {
  std::string text = LawText(result.autopilot.pitch.law);
  if (!result.feasible)
    text += "# DO NOT FLY: no design was found that meets every constraint; this is the best one.\n";
  if (options.tuning.regulator) text += RegulatorText(result.autopilot.pitch);
  text += fmt::format("#\n# Tuned by\n#   {}\n", CommandText(options));
  text += fmt::format("# which tried {} designs in {} flights.", result.evaluations, result.flights);
  if (result.feasible)
    text += fmt::format(
        " Over the {} cases of its seed:\n#   median powered RMS pitch error {:.5f} deg, largest peak "
        "{:.4f} deg\n",
        options.tuning.cases, result.median_rms_deg, result.largest_peak_deg);
  else
    text += "\n";
  for (std::size_t i = 0; i < result.stages.size(); ++i)
    if (!result.stages[i].missed.empty())
      text += fmt::format("# Stage {} misses by most: {}\n", i + 1, result.stages[i].missed);
  if (result.augmentation && !result.augmentation->missed.empty())
    text += fmt::format("# The augmentation misses by most: {}\n", result.augmentation->missed);
  text += "# Least computed margins (gain either way, phase, delay), gains frozen | adapting:\n";
  for (std::size_t i = 0; i < result.stages.size(); ++i) {
    text += fmt::format("#   stage {}: {} | {}\n", i + 1, MarginsText(result.stages[i].frozen),
                        MarginsText(result.stages[i].adapting));
  }
  if (!result.skipped.empty())
    text += fmt::format("# No margins at {} instants with less than {:g} % of full thrust.\n",
                        result.skipped.size(), 100.0 * kLeastThrustFraction);
  if (result.feasible && options.tuning.dispersed > 0)
    text += fmt::format(
        "# The plants of {} draws meet the gates of dispersed flights, {:.0f} dB and {:.0f} deg, too.\n",
        options.tuning.dispersed, kDispersedGainGate_db, kDispersedPhaseGate_deg);
  return text;
}

nlohmann::ordered_json MarginsJson(const LeastMargins& m) {
  return {{"gain_db", Number(m.gain_db)},
          {"phase_deg", Number(m.phase_deg)},
          {"delay_ms", Number(1e3 * m.delay_s)}};
}

nlohmann::ordered_json ResultJson(const TuneOptions& options, const TuningResult& result,
                                  const std::vector<TuningRecord>& log) {
  auto stages = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < result.stages.size(); ++i) {
    const StageTuning& stage = result.stages[i];
    const AxisGains& gains = result.autopilot.pitch.gains[i];
    stages.push_back({{"stage", i + 1},
                      {"feasible", stage.feasible},
                      {"kp_1_s2", gains.kp_1_s2},
                      {"kd_1_s", gains.kd_1_s},
                      {"bandwidth_rad_s", stage.design.bandwidth_rad_s},
                      {"damping", stage.design.damping},
                      {"learning", stage.design.learning},
                      {"pitch_error_rms_mean_deg", Number(stage.mean_rms_deg)},
                      {"pitch_error_peak_deg", Number(stage.peak_deg)},
                      {"frozen", MarginsJson(stage.frozen)},
                      {"adapting", MarginsJson(stage.adapting)},
                      {"missed", TextOrNull(stage.missed)}});
    if (stage.surplus) stages.back()["surplus"] = Number(*stage.surplus);
  }
  auto generations = nlohmann::ordered_json::array();
  for (const TuningRecord& record : log) {
    const GenerationRecord& g = record.generation;
    const bool of_stage = record.stage < std::ssize(result.stages);
    generations.push_back({{"stage", of_stage ? nlohmann::ordered_json(record.stage + 1) : nullptr},
                           {"generation", g.generation},
                           {"feasible_fraction", g.feasible_fraction},
                           {"best_deg", g.best_objective ? Number(*g.best_objective) : nullptr},
                           {"mean_deg", g.mean_objective ? Number(*g.mean_objective) : nullptr}});
  }
  nlohmann::ordered_json augmentation;
  if (result.augmentation) {
    const AugmentationTuning& tuned = *result.augmentation;
    augmentation = {{"feasible", tuned.feasible},
                    {"adaptive_gain_1_s", tuned.design.adaptive_gain_1_s},
                    {"spectral_gain_1_s", tuned.design.spectral_gain_1_s},
                    {"maximum_total_gain", tuned.design.maximum_total_gain},
                    {"pitch_error_rms_mean_deg", Number(tuned.mean_rms_deg)},
                    {"pitch_error_peak_deg", Number(tuned.peak_deg)},
                    {"missed", TextOrNull(tuned.missed)}};
  }
  return {{"schema", "dispersa/tune/1"},
          {"autopilot", options.out},
          {"feasible", result.feasible},
          {"nominal_loss", TextOrNull(result.nominal_loss)},
          {"start_loss", TextOrNull(result.start_loss)},
          {"seed", options.tuning.seed},
          {"cases", options.tuning.cases},
          {"evaluations", result.evaluations},
          {"flights", result.flights},
          {"pitch_error_rms_median_deg", result.feasible ? Number(result.median_rms_deg) : nullptr},
          {"pitch_error_peak_deg", result.feasible ? Number(result.largest_peak_deg) : nullptr},
          {"stages", std::move(stages)},
          {"skipped", SkippedJson(result.skipped)},
          {"augmentation", std::move(augmentation)},
          {"log", std::move(generations)}};
}

void PrintText(std::FILE* stream, const TuneOptions& options, const TuningResult& result,
               const std::vector<TuningRecord>& log) {
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
             result.median_rms_deg, result.largest_peak_deg, options.tuning.cases, options.tuning.seed);
  fmt::print(stream, "autopilot: {}\n", options.out);
}

ExitCode RunTuning(const TuneOptions& given, const GlobalOptions& global) {
  TuneOptions options = given;
  options.tuning.threads = ThreadsOrAll(options.threads);
  std::FILE* const stream = StreamBeside("--out", options.out, global);
  RequireWritableFile("--out", options.out);
  const Campaign campaign = LoadAndWarn(options.campaign);
  RequireControl(campaign, "gains");
  const AutopilotConfig autopilot =
      options.autopilot.empty() ? campaign.autopilot : LoadAutopilot(options.autopilot);

  std::vector<TuningRecord> log;
  TuningResult result;
  {
    Progress progress("tune", global.quiet);
    const auto observe = [&](const TuningRecord& record) {
      log.push_back(record);
      const GenerationRecord& g = record.generation;
      progress.Show(log.size(), TuningGenerations(campaign, autopilot, options.tuning),
                    fmt::format("search {}, {}", record.stage + 1,
                                g.best_objective ? fmt::format("best {:.4g} deg", *g.best_objective)
                                                 : std::string("no feasible design yet")));
    };
    result = Tune(campaign, autopilot, options.tuning, observe);
  }
  // A search that misses its gates has still found something, which says so itself.
  if (!result.feasible) result.autopilot.name += kMissed;
  WriteFile(options.out, Header(options, result) + WriteAutopilot(result.autopilot));
  if (global.json) {
    fmt::print("{}\n", ResultJson(options, result, log).dump(2));
  } else {
    PrintText(stream, options, result, log);
  }
  if (result.feasible) return kExitDone;
  Tell("no design was found that meets every constraint; {} has the best one that was found\n", options.out);
  return kExitRequirementFailed;
}

}  // namespace

void AddTuneCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<TuneOptions>();
  CLI::App* command = app.add_subcommand("tune", "find the gains of an autopilot with any control law");
  command->add_option("campaign", options->campaign, "campaign file: vehicle, reference and dispersions")
      ->required()
      ->type_name(kYamlType);
  command
      ->add_option("-o,--out", options->out,
                   "autopilot file to write; if a constraint is missed, the autopilot's name says so; -: "
                   "standard output")
      ->required()
      ->type_name(kFileType);
  command
      ->add_option("--autopilot", options->autopilot,
                   "autopilot file with the law and the fixed parameters, instead of the campaign's")
      ->type_name(kYamlType);
  command
      ->add_option("--seed", options->tuning.seed,
                   "seed of the search and of its cases; must not be the campaign's")
      ->capture_default_str();
  command->add_option("--cases", options->tuning.cases, "cases flown for each design")
      ->transform(WholeNumber(1, 10000))
      ->capture_default_str();
  command
      ->add_option("--evaluations", options->tuning.evaluations,
                   "number of designs to try, shared by the stages and the augmentation of PD")
      ->transform(WholeNumber(1, 1000000))
      ->capture_default_str();
  command
      ->add_option("--dispersed", options->tuning.dispersed,
                   "number of dispersed cases in which every design must meet the gates of dispersed flights")
      ->transform(WholeNumber(0, 1000))
      ->capture_default_str();
  command->add_flag(
      "--lqr", options->tuning.regulator,
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
