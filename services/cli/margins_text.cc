#include "services/cli/margins_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace dispersa {
namespace {

std::string Formatted(double value, const char* format) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "none";
}

void AddLoop(std::string& text, const std::string& place, const char* kind, const ComputedMargins& at,
             const LoopMargins& m) {
  const bool passed = &m == (at.learnt ? &*at.learnt : nullptr) ? LearntPasses(at) : PassesGates(m);
  const std::string bending =
      std::isfinite(m.bending_peak_db)
          ? fmt::format(
                "{:>8.1f} {:>8}", m.bending_peak_db,
                m.bending_phase_6db_deg < 180.0 ? fmt::format("{:.1f}", m.bending_phase_6db_deg) : "-")
          : "";
  text += fmt::format("{:<24} {:>8.2f} {:<5}  {:<8} {:>8} {:>8} {:>8.1f} {:>8} {} {}\n", place, at.time_s,
                      kAxisNames[at.axis], kind, Formatted(m.gain_up_db, "{:.1f}"),
                      m.gain_down_db == 0.0 ? "0.0" : "-" + Formatted(m.gain_down_db, "{:.1f}"), m.phase_deg,
                      Formatted(1e3 * m.delay_s, "{:.0f}"), bending,
                      !m.stable ? "FAIL: unstable"
                      : passed  ? ""
                                : "FAIL");
}

// How near a margin set is to its nearest gate, as a fraction of it.
double Nearness(const LoopMargins& m) {
  return std::min({m.gain_up_db / kGainMarginGate_db, m.gain_down_db / kGainMarginGate_db,
                   m.phase_deg / kPhaseMarginGate_deg, m.delay_s / kDelayMarginGate_s,
                   m.bending_phase_6db_deg / kPhaseMarginGate_deg});
}

void AddDispersed(std::string& text, const CampaignMargins& dispersed) {
  text += fmt::format(
      "\n"
      "Dispersed: the least margins of {} cases, each linearised about its own flight, with case and time.\n"
      "Gates: gain {:.0f} dB both ways, phase {:.0f} deg.\n"
      "{:<8}{:<6} {:>23} {:>23} {:>23} {:>23}\n",
      dispersed.cases, kDispersedGainGate_db, kDispersedPhaseGate_deg, "", "", "gain up dB", "gain down dB",
      "phase deg", "delay ms");
  const auto cell = [](const LeastMargin& m, double unit, int decimals) {
    return std::isfinite(m.value)
               ? fmt::format("{:.{}f} ({} at {:.1f} s)", unit * m.value, decimals, m.case_index, m.time_s)
               : "none";
  };
  for (const LeastLoopMargins& loop : dispersed.loops) {
    text += fmt::format("{:<8}{:<6} {:>23} {:>23} {:>23} {:>23}\n", fmt::format("stage {}", loop.stage + 1),
                        kAxisNames[loop.axis], cell(loop.gain_up_db, 1.0, 1), cell(loop.gain_down_db, 1.0, 1),
                        cell(loop.phase_deg, 1.0, 1), cell(loop.delay_s, 1e3, 0));
  }
  text += fmt::format(
      "{} of {} cases miss a gate{}; {} flights ended early.\n", dispersed.missed.size(), dispersed.cases,
      dispersed.missed.empty() ? "" : fmt::format(", the first is case {}", dispersed.missed.front()),
      dispersed.ended_early);
}

void AddSkipped(std::string& text, const std::vector<SkippedInstant>& skipped) {
  if (skipped.empty()) return;
  text += fmt::format("Skipped, with less than {:g} % of full thrust:\n", 100.0 * kLeastThrustFraction);
  for (const SkippedInstant& at : skipped)
    text += fmt::format("{:<24} {:>8.2f} stage {}, {:.1f} % of full thrust\n",
                        at.place.empty() ? "(between)" : at.place, at.time_s, at.stage + 1,
                        100.0 * at.thrust_fraction);
}

std::string FrequenciesText(const MarginModel& of) {
  if (of.frequency_band == 0.0) return "nominal frequencies of the modes";
  return fmt::format(
      "each margin the least with nominal frequencies of the modes, and {0:g} % lower and higher, all "
      "together and each mode alone",
      100.0 * of.frequency_band);
}

// The least margins of each stage for each set of mode frequencies, adapting.
void AddBySet(std::string& text, const MarginsResult& result) {
  if (!result.bends || result.of.frequency_band == 0.0) return;
  text += fmt::format(
      "\nLeast margins of each stage by frequencies of the modes (gain both ways, phase, phase of "
      "bending):\n");
  for (const MeasuredMargins& stage : result.measured) {
    std::vector<SetMargins> least;
    for (const ComputedMargins& m : result.computed) {
      if (m.stage != stage.stage || m.by_set.empty()) continue;
      if (least.empty()) least = m.by_set;
      for (std::size_t i = 0; i < least.size(); ++i)
        least[i].margins = Least(least[i].margins, m.by_set[i].margins);
    }
    for (const auto& [frequencies, m] : least) {
      text +=
          fmt::format("{:<8} {:<24} {:>8} {:>8.1f} {:>8} {}\n", fmt::format("stage {}", stage.stage + 1),
                      frequencies, Formatted(std::min(m.gain_up_db, m.gain_down_db), "{:.2f}"), m.phase_deg,
                      m.bending_phase_6db_deg < 180.0 ? fmt::format("{:.1f}", m.bending_phase_6db_deg) : "-",
                      PassesGates(m) ? "" : "FAIL");
    }
  }
}

}  // namespace

std::string MarginsText(const MarginsResult& result) {
  std::string text = result.nominal_loss.empty() ? "" : result.nominal_loss + "\n\n";
  text += fmt::format(
      "Margins of autopilot {} along the nominal flight.\n"
      "{}\n"
      "{}Gates: gain {:.0f} dB both ways, phase {:.0f} deg, delay {:.0f} ms.\n"
      "\n"
      "Computed from a linearisation. frozen: gains held. adapting: with the adaptation about zero error.\n"
      "learnt: with the trim learnt until then from a thrust misalignment of 0.25 deg (gates of an "
      "augmentation:\n"
      "{:.0f} dB and {:.0f} deg).\n",
      result.autopilot,
      result.bends ? fmt::format("Bending modes, no slosh; {}.\n"
                                 "Bending: largest response, and its least angle from -1 where it is above "
                                 "-{:.0f} dB, against the phase gate.",
                                 FrequenciesText(result.of), kGainMarginGate_db)
                   : "RIGID-BODY MARGINS: no bending modes, no slosh.",
      result.of.path == LateralPath::kDrifts
          ? "The path drifts: lateral velocity changes the incidence of pitch and yaw too.\n"
          : "",
      kGainMarginGate_db, kPhaseMarginGate_deg, 1e3 * kDelayMarginGate_s, kDispersedGainGate_db,
      kDispersedPhaseGate_deg);
  text += fmt::format("{:<24} {:>8} {:<5}  {:<8} {:>8} {:>8} {:>8} {:>8}{}\n", "", "time s", "axis", "",
                      "gain dB", "gain dB", "phase", "delay ms", result.bends ? "  bend dB    phase" : "");
  for (const ComputedMargins& m : result.computed) {
    // Between the named instants only what fails.
    const bool named = !m.place.empty();
    if (named || !PassesGates(m.frozen)) AddLoop(text, named ? m.place : "(between)", "frozen", m, m.frozen);
    if (named || !PassesGates(m.adapting))
      AddLoop(text, named ? m.place : "(between)", "adapting", m, m.adapting);
    if (m.learnt && (named || !LearntPasses(m)))
      AddLoop(text, named ? m.place : "(between)", "learnt", m, *m.learnt);
  }
  AddSkipped(text, result.skipped);
  text += fmt::format("\nNearest to a gate in each stage, at named instants or between:\n");
  for (const MeasuredMargins& stage : result.measured) {
    for (const char* kind : {"frozen", "adapting", "learnt"}) {
      const ComputedMargins* nearest = nullptr;
      const auto margins = [kind](const ComputedMargins& m) -> const LoopMargins& {
        return kind[0] == 'f' ? m.frozen : kind[0] == 'l' && m.learnt ? *m.learnt : m.adapting;
      };
      for (const ComputedMargins& m : result.computed) {
        if (m.stage == stage.stage && (!nearest || Nearness(margins(m)) < Nearness(margins(*nearest))))
          nearest = &m;
      }
      if (nearest) AddLoop(text, fmt::format("stage {}", stage.stage + 1), kind, *nearest, margins(*nearest));
    }
  }
  AddBySet(text, result);
  text += fmt::format(
      "\nMeasured: gain or delay of all axes of one stage changed in flight until control is lost (steps of "
      "{} dB, {:.0f} ms): nozzles that ripple by more than {} deg, an error of more than {} deg, or a flight "
      "that does not complete.\n"
      "{:<10} {:>8} {:>8} {:>9}\n",
      kMeasuredGainStep_db, 1e3 * kMeasuredDelayStep_s, kLostRipple_deg, kLostError_deg, "", "gain dB",
      "gain dB", "delay ms");
  for (const MeasuredMargins& m : result.measured) {
    const auto capped = [](double value, double ceiling) { return value >= ceiling ? ">" : ""; };
    text +=
        fmt::format("{:<10} {:>8} {:>8} {:>9}  {}\n", fmt::format("stage {}", m.stage + 1),
                    fmt::format("{}{:.1f}", capped(m.gain_up_db, kMeasuredGainCeiling_db), m.gain_up_db),
                    fmt::format("{}-{:.1f}", capped(m.gain_down_db, kMeasuredGainCeiling_db), m.gain_down_db),
                    fmt::format("{}{:.0f}", capped(m.delay_s, kMeasuredDelayCeiling_s), 1e3 * m.delay_s),
                    PassesGates(m) ? "" : "FAIL");
    if (m.gain_up_db == 0.0 && m.gain_down_db == 0.0 && m.delay_s == 0.0)
      text += fmt::format(
          "{:<10} counts as lost without any change: with a thrust misalignment of 0.25 deg\n", "");
  }
  if (result.dispersed) AddDispersed(text, *result.dispersed);
  text += fmt::format("\n{}\n", result.passed ? "PASS: every gate is met" : "FAIL: a gate is not met");
  return text;
}

}  // namespace dispersa
