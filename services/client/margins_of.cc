#include "services/client/margins_of.h"

#include <algorithm>
#include <utility>

#include "core/campaign/free_flight.h"
#include "core/cases/campaign_flights.h"
#include "core/results/json_number.h"
#include "services/program/threads.h"

namespace dispersa {
namespace {

nlohmann::ordered_json LoopJson(const LoopMargins& m, bool passed) {
  return {{"stable", m.stable},
          {"gain_up_db", Number(m.gain_up_db)},
          {"gain_down_db", Number(m.gain_down_db)},
          {"phase_deg", Number(m.phase_deg)},
          {"delay_ms", Number(1e3 * m.delay_s)},
          {"crossover_rad_s", Number(m.crossover_rad_s)},
          {"bending_peak_db", Number(m.bending_peak_db)},
          {"bending_phase_deg", m.bending_phase_6db_deg},
          {"passed", passed}};
}

nlohmann::ordered_json LeastJson(const LeastMargin& m, double unit = 1.0) {
  return {{"value", Number(unit * m.value)}, {"case", m.case_index}, {"time_s", m.time_s}};
}

nlohmann::ordered_json DispersedJson(const CampaignMargins& dispersed) {
  const auto loop_json = [](const LeastLoopMargins& loop) -> nlohmann::ordered_json {
    return {{"stage", loop.stage + 1},
            {"axis", kAxisNames[loop.axis]},
            {"gain_up_db", LeastJson(loop.gain_up_db)},
            {"gain_down_db", LeastJson(loop.gain_down_db)},
            {"phase_deg", LeastJson(loop.phase_deg)},
            {"delay_ms", LeastJson(loop.delay_s, 1e3)}};
  };
  return {{"cases", dispersed.cases},
          {"gates", {{"gain_db", kDispersedGainGate_db}, {"phase_deg", kDispersedPhaseGate_deg}}},
          {"ended_early", dispersed.ended_early},
          {"missed", dispersed.missed},
          {"least", ListOf(dispersed.loops, loop_json)},
          {"passed", dispersed.Passed()}};
}

nlohmann::ordered_json BySetJson(const std::vector<SetMargins>& by_set) {
  return ListOf(by_set, [](const SetMargins& set) {
    nlohmann::ordered_json json = {{"frequencies", set.frequencies}};
    json.update(LoopJson(set.margins, PassesGates(set.margins)));
    return json;
  });
}

}  // namespace

nlohmann::ordered_json SkippedJson(const std::vector<SkippedInstant>& skipped) {
  return ListOf(skipped, [](const SkippedInstant& at) -> nlohmann::ordered_json {
    return {{"place", at.place},
            {"stage", at.stage + 1},
            {"time_s", at.time_s},
            {"thrust_percent", 100.0 * at.thrust_fraction}};
  });
}

nlohmann::ordered_json MarginsJson(const MarginsResult& result) {
  auto computed = nlohmann::ordered_json::array();
  for (const ComputedMargins& m : result.computed) {
    computed.push_back({{"place", m.place},
                        {"stage", m.stage + 1},
                        {"time_s", m.time_s},
                        {"axis", kAxisNames[m.axis]},
                        {"frozen", LoopJson(m.frozen, PassesGates(m.frozen))},
                        {"adapting", LoopJson(m.adapting, PassesGates(m.adapting))},
                        {"learnt", m.learnt ? LoopJson(*m.learnt, LearntPasses(m)) : nullptr}});
    if (!m.by_set.empty()) computed.back()["by_frequencies"] = BySetJson(m.by_set);
  }
  const auto measured_json = [](const MeasuredMargins& m) -> nlohmann::ordered_json {
    return {{"stage", m.stage + 1},
            {"gain_up_db", m.gain_up_db},
            {"gain_down_db", m.gain_down_db},
            {"delay_ms", 1e3 * m.delay_s},
            {"passed", PassesGates(m)}};
  };
  nlohmann::ordered_json json = {
      {"schema", "dispersa/margins/1"},
      {"model", result.bends ? "bending, no slosh" : "rigid body: no bending, no slosh"},
      {"frequency_band_percent", 100.0 * result.of.frequency_band},
      {"drift", result.of.path == LateralPath::kDrifts},
      {"nominal_loss", TextOrNull(result.nominal_loss)},
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
      {"least_thrust_percent", 100.0 * kLeastThrustFraction},
      {"skipped", SkippedJson(result.skipped)},
      {"computed", std::move(computed)},
      {"measured", ListOf(result.measured, measured_json)},
      {"passed", result.passed}};
  if (result.dispersed) json["dispersed"] = DispersedJson(*result.dispersed);
  return json;
}

MarginsResult MarginsOf(const Campaign& campaign, const MarginsOptions& options) {
  RequireControl(campaign, "margins");
  const CampaignFlights flights(campaign);
  MarginsResult result;
  result.autopilot = campaign.autopilot.name;
  result.bends = flights.model().nominal_plant().bending_modes() > 0;
  result.of = {options.frequency_band_percent / 100.0,
               options.drift ? LateralPath::kDrifts : LateralPath::kHeld};
  result.computed = ComputeMargins(flights.model(), 5.0, {}, result.of);
  result.skipped = SkippedInstants(flights.model());
  result.measured = MeasureMargins(flights.model());
  result.nominal_loss = NominalLoss(flights.FlyNominal());
  result.passed = result.nominal_loss.empty() &&
                  std::all_of(result.computed.begin(), result.computed.end(),
                              [](const ComputedMargins& m) { return PassesGates(m); }) &&
                  std::all_of(result.measured.begin(), result.measured.end(),
                              [](const MeasuredMargins& m) { return PassesGates(m); });
  if (options.cases) {
    result.dispersed = ComputeCampaignMargins(flights, *options.cases, UsableCores(), result.of.path);
    result.passed = result.passed && result.dispersed->Passed();
  }
  return result;
}

}  // namespace dispersa
