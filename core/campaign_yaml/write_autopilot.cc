#include "core/campaign_yaml/canonical.h"
#include "core/campaign_yaml/inline_files.h"
#include "core/campaign_yaml/load.h"
#include "core/campaign_yaml/number_text.h"
#include "core/math/constants.h"

namespace dispersa {
namespace {

std::string Deg(double radians) { return FormatScaled(radians, kRadPerDeg); }

const char* LawName(ControlLaw law) {
  switch (law) {
    case ControlLaw::kAdaptiveFuzzy:
      return "adaptive_fuzzy";
    case ControlLaw::kFrozenFuzzy:
      return "frozen_fuzzy";
    case ControlLaw::kPd:
      return "pd";
    case ControlLaw::kPdAac:
      break;
  }
  return "pd_aac";
}

std::string Row(double a, double b) { return "[" + FormatNumber(a) + ", " + FormatNumber(b) + "]"; }

std::string AdaptationText(const Adaptation& a) {
  std::string text = "  adaptation:\n    gamma: [";
  for (std::size_t i = 0; i < a.gamma.size(); ++i) text += (i > 0 ? ", " : "") + FormatNumber(a.gamma[i]);
  text += "]\n    q: [" + Row(a.q(0, 0), a.q(0, 1)) + ", " + Row(a.q(1, 0), a.q(1, 1)) + "]\n";
  if (a.p_n) text += "    p_n: " + Row(a.p_n->x(), a.p_n->y()) + "\n";
  // A guard that is off is left out.
  const auto number = [&](const char* key, double value, const std::string& shown) {
    if (value != 0.0) text += std::string("    ") + key + ": " + shown + "\n";
  };
  const auto flag = [&](const char* key, bool value) {
    if (value) text += std::string("    ") + key + ": true\n";
  };
  flag("allow_unproven", a.allow_unproven);
  number("projection_bound_deg_s2", a.projection_bound_rad_s2, Deg(a.projection_bound_rad_s2));
  number("leakage_1_s", a.leakage_1_s, FormatNumber(a.leakage_1_s));
  number("spread_1_s", a.spread_1_s, FormatNumber(a.spread_1_s));
  number("dead_zone_deg", a.dead_zone_rad, Deg(a.dead_zone_rad));
  flag("freeze_when_saturated", a.freeze_when_saturated);
  flag("reset_at_ignition", a.reset_at_ignition);
  number("supervisory_bound", a.supervisory_bound, FormatNumber(a.supervisory_bound));
  return text;
}

std::string AugmentationText(const AdaptiveAugmentation& a) {
  return "  augmentation:\n    adaptive_gain_1_s: " + FormatNumber(a.adaptive_gain_1_s) +
         "\n    leakage_1_s: " + FormatNumber(a.leakage_1_s) +
         "\n    spectral_gain_1_s: " + FormatNumber(a.spectral_gain_1_s) +
         "\n    high_pass_rad_s: " + FormatNumber(a.high_pass_rad_s) +
         "\n    low_pass_rad_s: " + FormatNumber(a.low_pass_rad_s) +
         "\n    minimum_total_gain: " + FormatNumber(a.minimum_total_gain) +
         "\n    maximum_total_gain: " + FormatNumber(a.maximum_total_gain) + "\n";
}

std::string AxisText(const char* name, const AxisConfig& axis) {
  std::string text = std::string(name) + ":\n  law: " + LawName(axis.law) + "\n  gains:\n";
  for (const AxisGains& gains : axis.gains)
    text +=
        "    - {kp_1_s2: " + FormatNumber(gains.kp_1_s2) + ", kd_1_s: " + FormatNumber(gains.kd_1_s) + "}\n";
  const bool adaptive = axis.law == ControlLaw::kAdaptiveFuzzy;
  if (adaptive || axis.law == ControlLaw::kFrozenFuzzy)
    text += "  rules: {error_range_deg: " + Deg(axis.rules.error_range_rad) +
            ", rate_range_deg_s: " + Deg(axis.rules.rate_range_rad_s) + "}\n";
  if (adaptive) text += AdaptationText(axis.adaptation);
  if (axis.law == ControlLaw::kPdAac) text += AugmentationText(axis.augmentation);
  return text;
}

}  // namespace

std::string WriteAutopilot(const AutopilotConfig& autopilot) {
  const ReactionControlLogic& rcs = autopilot.reaction_control;
  return std::string("schema: ") + kAutopilotSchema + "\nname: " + TextScalar(autopilot.name) +
         "\ntick_s: " + FormatNumber(autopilot.tick_s) + "\n" + AxisText("pitch", autopilot.pitch) +
         AxisText("yaw", autopilot.yaw) + AxisText("roll", autopilot.roll) +
         "reaction_control: {deadband_deg: " + Deg(rcs.deadband_rad) +
         ", rate_gain_s: " + FormatNumber(rcs.rate_gain_s) + ", hysteresis: " + FormatNumber(rcs.hysteresis) +
         ", cycle_ticks: " + std::to_string(rcs.cycle_ticks) + "}\n";
}

}  // namespace dispersa
