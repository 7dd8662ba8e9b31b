// Stability margins of the autopilot that flew the figures.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/pages/html_parts.h"
#include "core/paper/paper_sections.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

std::string Number(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : std::string("∞");
}

std::string Badge(bool passed) { return VerdictBadge(passed ? "pass" : "fail"); }

void LoopRow(HtmlTable& table, const ComputedMargins& at, const char* gains, const LoopMargins& margins) {
  table.Row({HtmlText(at.place), fmt::format("{:.1f}", at.time_s), gains,
             margins.stable ? Number(margins.gain_up_db, 1) : "unstable", Number(margins.gain_down_db, 1),
             Number(margins.phase_deg, 1), Number(1e3 * margins.delay_s, 0),
             Number(margins.crossover_rad_s, 1), Badge(PassesGates(margins))});
}

}  // namespace

std::string PaperMarginSection(const PaperStudy& study) {
  std::string html =
      "<h2 id=\"margins\">Stability margins</h2>\n" + PaperSource(study, {"nominal"}) +
      fmt::format(
          "<p><b>Rigid body only.</b> Gates in every powered phase: gain {:g} dB up and down, phase "
          "{:g}°, delay {:g} ms.</p>\n",
          kGainMarginGate_db, kPhaseMarginGate_deg, 1e3 * kDelayMarginGate_s);
  HtmlTable computed({{"Pitch, linearised"},
                      {"time, s", true},
                      {"gains"},
                      {"gain up, dB", true},
                      {"gain down, dB", true},
                      {"phase, °", true},
                      {"delay, ms", true},
                      {"crossover, rad/s", true},
                      {"gates"}});
  std::size_t points = 0, passed = 0;
  for (const ComputedMargins& at : study.computed_margins) {
    points += at.learnt ? 3 : 2;
    passed += PassesGates(at.frozen) + PassesGates(at.adapting) + (at.learnt && LearntPasses(at));
    if (at.place.empty() || at.axis != kPitch) continue;
    LoopRow(computed, at, "frozen", at.frozen);
    LoopRow(computed, at, "adapting", at.adapting);
    if (at.learnt) LoopRow(computed, at, "learnt", *at.learnt);
  }
  HtmlTable measured({{"All axes, measured in flight"},
                      {"gain up, dB", true},
                      {"gain down, dB", true},
                      {"delay, ms", true},
                      {"gates"}});
  bool all_measured = true;
  double least_gain_db = HUGE_VAL, least_delay_s = HUGE_VAL;
  for (const MeasuredMargins& margins : study.measured_margins) {
    measured.Row({fmt::format("stage {}", margins.stage + 1), Number(margins.gain_up_db, 1),
                  Number(margins.gain_down_db, 1), Number(1e3 * margins.delay_s, 0),
                  Badge(PassesGates(margins))});
    all_measured = all_measured && PassesGates(margins);
    least_gain_db = std::min({least_gain_db, margins.gain_up_db, margins.gain_down_db});
    least_delay_s = std::min(least_delay_s, margins.delay_s);
  }
  html += measured.Html("narrow") + computed.Html();
  html += PaperFindings(
      "Stability follows from the Lyapunov function; margins are not given.",
      fmt::format("Measured by spoiling the loop in flight: at least {} dB of gain either way and {} ms of "
                  "delay; {}. "
                  "Linearised, {} of {} sets (all axes, with gains frozen, adapting, and with what was "
                  "learnt by then, every few seconds of "
                  "powered flight) "
                  "pass the gates.",
                  Number(least_gain_db, 1), Number(1e3 * least_delay_s, 0),
                  all_measured ? "every phase passes the gates" : "not every phase passes the gates", passed,
                  points),
      "Classical margins do not describe a loop that adapts, hence the measured ones: gain or delay of one "
      "stage’s loop is "
      "changed until the flight is lost or a limit cycle begins, with a steady misalignment that keeps the "
      "adaptation at "
      "work.");
  return html;
}

}  // namespace dispersa
