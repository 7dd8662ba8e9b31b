// dispersa margins: how much gain, phase and delay a campaign's autopilot can lose along the nominal flight.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/campaign/campaign_flights.h"
#include "core/flight/margins.h"
#include "services/cli/command.h"
#include "services/cli/flight_json.h"
#include "services/cli/warn.h"

namespace dispersa {
namespace {

struct MarginsOptions {
  std::string campaign;
  CampaignOverrides overrides;
};

struct MarginsResult {
  std::string autopilot;
  std::vector<ComputedMargins> computed;
  std::vector<MeasuredMargins> measured;
  bool passed = false;
};

constexpr const char* kAxisNames[kAxes] = {"roll", "pitch", "yaw"};

nlohmann::ordered_json LoopJson(const LoopMargins& m) {
  return {{"stable", m.stable},
          {"gain_up_db", JsonNumber(m.gain_up_db)},
          {"gain_down_db", JsonNumber(m.gain_down_db)},
          {"phase_deg", JsonNumber(m.phase_deg)},
          {"delay_ms", JsonNumber(1e3 * m.delay_s)},
          {"crossover_rad_s", JsonNumber(m.crossover_rad_s)},
          {"passed", PassesGates(m)}};
}

void PrintJson(const MarginsResult& result) {
  auto computed = nlohmann::ordered_json::array();
  for (const ComputedMargins& m : result.computed) {
    computed.push_back({{"place", m.place},
                        {"stage", m.stage + 1},
                        {"time_s", m.time_s},
                        {"axis", kAxisNames[m.axis]},
                        {"frozen", LoopJson(m.frozen)},
                        {"adapting", LoopJson(m.adapting)}});
  }
  auto measured = nlohmann::ordered_json::array();
  for (const MeasuredMargins& m : result.measured) {
    measured.push_back({{"stage", m.stage + 1},
                        {"gain_up_db", m.gain_up_db},
                        {"gain_down_db", m.gain_down_db},
                        {"delay_ms", 1e3 * m.delay_s},
                        {"passed", PassesGates(m)}});
  }
  const nlohmann::ordered_json json = {
      {"schema", "dispersa/margins/1"},
      {"model", "rigid body: no bending, no slosh"},
      {"autopilot", result.autopilot},
      {"gates",
       {{"gain_db", kGainMarginGate_db},
        {"phase_deg", kPhaseMarginGate_deg},
        {"delay_ms", 1e3 * kDelayMarginGate_s}}},
      {"measured_resolution",
       {{"gain_db", kMeasuredGainStep_db},
        {"gain_ceiling_db", kMeasuredGainCeiling_db},
        {"delay_ms", 1e3 * kMeasuredDelayStep_s},
        {"delay_ceiling_ms", 1e3 * kMeasuredDelayCeiling_s}}},
      {"computed", std::move(computed)},
      {"measured", std::move(measured)},
      {"passed", result.passed}};
  fmt::print("{}\n", json.dump(2));
}

std::string Number(double value, const char* format) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "none";
}

void PrintLoop(const std::string& place, const char* kind, const ComputedMargins& at, const LoopMargins& m) {
  fmt::print("{:<24} {:>8.2f} {:<5}  {:<8} {:>8} {:>8} {:>8.1f} {:>8}  {}\n", place, at.time_s,
             kAxisNames[at.axis], kind, Number(m.gain_up_db, "{:.1f}"),
             m.gain_down_db == 0.0 ? "0.0" : "-" + Number(m.gain_down_db, "{:.1f}"), m.phase_deg,
             Number(1e3 * m.delay_s, "{:.0f}"),
             !m.stable ? "FAIL: unstable" : PassesGates(m) ? "" : "FAIL");
}

// How near a margin set is to its nearest gate, as a fraction of it.
double Nearness(const LoopMargins& m) {
  return std::min({m.gain_up_db / kGainMarginGate_db, m.gain_down_db / kGainMarginGate_db,
                   m.phase_deg / kPhaseMarginGate_deg, m.delay_s / kDelayMarginGate_s});
}

void PrintText(const MarginsResult& result) {
  fmt::print(
      "Margins of autopilot {} along the nominal flight.\n"
      "RIGID-BODY MARGINS: no bending modes, no slosh. Gates: gain {:.0f} dB both ways, phase {:.0f} deg, "
      "delay {:.0f} ms.\n\n"
      "Computed: linearised; frozen = gains held, adapting = with the adaptation about zero error.\n",
      result.autopilot, kGainMarginGate_db, kPhaseMarginGate_deg, 1e3 * kDelayMarginGate_s);
  fmt::print("{:<24} {:>8} {:<5}  {:<8} {:>8} {:>8} {:>8} {:>8}\n", "", "time s", "axis", "", "gain dB",
             "gain dB", "phase", "delay ms");
  for (const ComputedMargins& m : result.computed) {
    // Between the named instants only what fails.
    const bool named = !m.place.empty();
    if (named || !PassesGates(m.frozen)) PrintLoop(named ? m.place : "(between)", "frozen", m, m.frozen);
    if (named || !PassesGates(m.adapting)) PrintLoop(named ? m.place : "(between)", "adapting", m, m.adapting);
  }
  fmt::print("\nNearest to a gate in each stage, named instants or between:\n");
  for (const MeasuredMargins& stage : result.measured) {
    for (const bool adapting : {false, true}) {
      const ComputedMargins* nearest = nullptr;
      const auto margins = [adapting](const ComputedMargins& m) -> const LoopMargins& {
        return adapting ? m.adapting : m.frozen;
      };
      for (const ComputedMargins& m : result.computed) {
        if (m.stage == stage.stage && (!nearest || Nearness(margins(m)) < Nearness(margins(*nearest))))
          nearest = &m;
      }
      if (nearest)
        PrintLoop(fmt::format("stage {}", stage.stage + 1), adapting ? "adapting" : "frozen", *nearest,
                  margins(*nearest));
    }
  }
  fmt::print(
      "\nMeasured: all axes of one stage's loop spoilt in flight until it is lost (to {} dB, {:.0f} ms).\n"
      "{:<10} {:>8} {:>8} {:>9}\n",
      kMeasuredGainStep_db, 1e3 * kMeasuredDelayStep_s, "", "gain dB", "gain dB", "delay ms");
  for (const MeasuredMargins& m : result.measured) {
    const auto capped = [](double value, double ceiling) { return value >= ceiling ? ">" : ""; };
    fmt::print("{:<10} {:>8} {:>8} {:>9}  {}\n", fmt::format("stage {}", m.stage + 1),
               fmt::format("{}{:.1f}", capped(m.gain_up_db, kMeasuredGainCeiling_db), m.gain_up_db),
               fmt::format("{}-{:.1f}", capped(m.gain_down_db, kMeasuredGainCeiling_db), m.gain_down_db),
               fmt::format("{}{:.0f}", capped(m.delay_s, kMeasuredDelayCeiling_s), 1e3 * m.delay_s),
               PassesGates(m) ? "" : "FAIL");
  }
  fmt::print("\n{}\n", result.passed ? "PASS: every gate is met" : "FAIL: a gate is not met");
}

ExitCode Margins(const MarginsOptions& options, const GlobalOptions& global) {
  const Campaign campaign = LoadAndWarn(options.campaign, options.overrides);
  const CampaignFlights flights(campaign);
  MarginsResult result;
  result.autopilot = campaign.autopilot.name;
  result.computed = ComputeMargins(flights.model());
  result.measured = MeasureMargins(flights.model());
  result.passed =
      std::all_of(result.computed.begin(), result.computed.end(),
                  [](const ComputedMargins& m) { return PassesGates(m.frozen) && PassesGates(m.adapting); }) &&
      std::all_of(result.measured.begin(), result.measured.end(),
                  [](const MeasuredMargins& m) { return PassesGates(m); });
  if (global.json) {
    PrintJson(result);
  } else {
    PrintText(result);
  }
  return result.passed ? kExitDone : kExitRequirementFailed;
}

}  // namespace

void AddMarginsCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<MarginsOptions>();
  CLI::App* command =
      app.add_subcommand("margins", "gain, phase and delay margins of the autopilot (rigid body)");
  command->add_option("campaign", options->campaign, "campaign file")->required();
  command->add_option("--autopilot", options->overrides.autopilot,
                      "autopilot file, instead of the campaign's");
  command->footer(
      "Computed from a linearisation at lift-off, max q, ignitions and burnouts, and measured by spoiling\n"
      "the loop in flight. Ends with 3 when a gate is not met.\n"
      "Example: dispersa margins campaigns/nominal.yaml");
  command->callback([options, &invocation] {
    invocation.command = [options](const GlobalOptions& global) { return Margins(*options, global); };
  });
}

}  // namespace dispersa
