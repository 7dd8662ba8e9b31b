#include "services/client/autopilot_tuning.h"

#include <fmt/format.h>

#include <sstream>
#include <utility>

#include "core/campaign/free_flight.h"
#include "core/campaign_yaml/load.h"
#include "core/containment/interrupted.h"
#include "core/results/json_number.h"
#include "core/tuning/regulator.h"
#include "services/client/margins_of.h"

namespace dispersa {
namespace {

// The command that gives the same file again; the number of threads does not matter.
std::string CommandText(const TuningRequest& request) {
  std::string text = "dispersa tune " + request.campaign;
  if (!request.autopilot.empty()) text += " --autopilot " + request.autopilot;
  if (request.tuning.regulator) text += " --lqr";
  if (request.tuning.dispersed > 0) text += fmt::format(" --dispersed {}", request.tuning.dispersed);
  return text + fmt::format(" --out {} --seed {} --cases {} --evaluations {}", request.out,
                            request.tuning.seed, request.tuning.cases, request.tuning.evaluations);
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

/// Behind the name of an autopilot that no gate has let pass.
constexpr char kMissed[] = " (misses a constraint)";

// The comment at the head of the file.
std::string Header(const TuningRequest& request, const TuningResult& result) {
  std::string text = LawText(result.autopilot.pitch.law);
  if (!result.feasible)
    text += "# DO NOT FLY: no design was found that meets every constraint; this is the best one.\n";
  if (request.tuning.regulator) text += RegulatorText(result.autopilot.pitch);
  text += fmt::format("#\n# Tuned by\n#   {}\n", CommandText(request));
  text += fmt::format("# which tried {} designs in {} flights.", result.evaluations, result.flights);
  if (result.feasible)
    text += fmt::format(
        " Over the {} cases of its seed:\n#   median powered RMS pitch error {:.5f} deg, largest peak "
        "{:.4f} deg\n",
        request.tuning.cases, result.median_rms_deg, result.largest_peak_deg);
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
  if (result.feasible && request.tuning.dispersed > 0)
    text += fmt::format(
        "# The plants of {} draws meet the gates of dispersed flights, {:.0f} dB and {:.0f} deg, too.\n",
        request.tuning.dispersed, kDispersedGainGate_db, kDispersedPhaseGate_deg);
  return text;
}

nlohmann::ordered_json MarginsJson(const LeastMargins& m) {
  return {{"gain_db", Number(m.gain_db)},
          {"phase_deg", Number(m.phase_deg)},
          {"delay_ms", Number(1e3 * m.delay_s)}};
}

}  // namespace

std::string MarginsText(const LeastMargins& m) {
  return fmt::format("{:.1f} dB, {:.1f} deg, {:.0f} ms", m.gain_db, m.phase_deg, 1e3 * m.delay_s);
}

TunedAutopilot TuneAutopilot(const Campaign& campaign, const AutopilotConfig& autopilot,
                             const TuningOptions& options, Observer& observer) {
  RequireControl(campaign, "gains");
  TunedAutopilot tuned;
  const auto observe = [&](const TuningRecord& record) {
    tuned.log.push_back(record);
    const GenerationRecord& g = record.generation;
    observer.Show("tune", tuned.log.size(), TuningGenerations(campaign, autopilot, options),
                  fmt::format("search {}, {}", record.stage + 1,
                              g.best_objective ? fmt::format("best {:.4g} deg", *g.best_objective)
                                               : std::string("no feasible design yet")));
    if (observer.ShouldStop()) throw Interrupted();
  };
  tuned.result = Tune(campaign, autopilot, options, observe);
  observer.EndPhase();
  if (!tuned.result.feasible) tuned.result.autopilot.name += kMissed;
  return tuned;
}

std::string TunedFile(const TuningRequest& request, const TunedAutopilot& tuned) {
  return Header(request, tuned.result) + WriteAutopilot(tuned.result.autopilot);
}

nlohmann::ordered_json TuningJson(const TuningRequest& request, const TunedAutopilot& tuned_autopilot) {
  const auto& [result, log] = tuned_autopilot;
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
          {"autopilot", request.out},
          {"feasible", result.feasible},
          {"nominal_loss", TextOrNull(result.nominal_loss)},
          {"start_loss", TextOrNull(result.start_loss)},
          {"seed", request.tuning.seed},
          {"cases", request.tuning.cases},
          {"evaluations", result.evaluations},
          {"flights", result.flights},
          {"pitch_error_rms_median_deg", result.feasible ? Number(result.median_rms_deg) : nullptr},
          {"pitch_error_peak_deg", result.feasible ? Number(result.largest_peak_deg) : nullptr},
          {"stages", std::move(stages)},
          {"skipped", SkippedJson(result.skipped)},
          {"augmentation", std::move(augmentation)},
          {"log", std::move(generations)}};
}

}  // namespace dispersa
