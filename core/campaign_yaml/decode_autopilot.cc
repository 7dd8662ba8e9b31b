#include "core/campaign_yaml/decode.h"
#include "core/campaign_yaml/inline_files.h"
#include "core/campaign_yaml/struct_problems.h"
#include "core/campaign_yaml/yaml_reader.h"

namespace dispersa {
namespace {

using ProblemList = std::vector<InputProblem>;

AxisGains DecodeGains(const InputNode& node, const std::string& path, ProblemList& problems) {
  MapReader map(node, path, problems);
  AxisGains gains;
  gains.kp_1_s2 = map.Quantity("kp", kPerTimeSquared, kPositive);
  gains.kd_1_s = map.Quantity("kd", kPerTime, kPositive);
  return gains;
}

FuzzyRules DecodeRules(const InputNode& node, const std::string& path, ProblemList& problems) {
  MapReader map(node, path, problems);
  FuzzyRules rules;
  rules.error_range_rad = map.Quantity("error_range", kAngle, kPositive);
  rules.rate_range_rad_s = map.Quantity("rate_range", kAngularRate, kPositive);
  return rules;
}

Adaptation DecodeAdaptation(const InputNode& node, const std::string& path, ProblemList& problems) {
  MapReader map(node, path, problems);
  Adaptation adaptation;
  adaptation.gamma = map.Numbers("gamma", kNonNegative, 1, kMaxStages);
  map.Each("q", 2, 2, [&](const InputNode& row, const std::string& row_path) {
    if (row.kind != InputNode::Kind::kList || row.items.size() != 2) {
      AddProblem(problems, row, row_path, row.Describe() + " is not a row of two numbers",
                 "[[q11, q12], [q12, q22]]");
      return;
    }
    const auto index = &row - node.Find("q")->items.data();
    for (int column = 0; column < 2; ++column) {
      adaptation.q(index, column) = ReadNumber(row.items[static_cast<std::size_t>(column)],
                                               row_path + "[" + std::to_string(column) + "]", problems);
    }
  });
  if (map.Optional("p_n") != nullptr) {
    const std::vector<double> p_n = map.Numbers("p_n", kAnyNumber, 2, 2);
    if (p_n.size() == 2) adaptation.p_n = Vector2(p_n[0], p_n[1]);
  }
  adaptation.allow_unproven = map.Flag("allow_unproven", false);
  adaptation.projection_bound_rad_s2 =
      map.Quantity("projection_bound", kAngularAcceleration, kNonNegative, 0.0);
  adaptation.leakage_1_s = map.Quantity("leakage", kPerTime, kNonNegative, 0.0);
  adaptation.spread_1_s = map.Quantity("spread", kPerTime, kNonNegative, 0.0);
  adaptation.dead_zone_rad = map.Quantity("dead_zone", kAngle, kNonNegative, 0.0);
  adaptation.freeze_when_saturated = map.Flag("freeze_when_saturated", false);
  adaptation.reset_at_ignition = map.Flag("reset_at_ignition", false);
  adaptation.supervisory_bound = map.Number("supervisory_bound", kNonNegative, 0.0);
  return adaptation;
}

AdaptiveAugmentation DecodeAugmentation(const InputNode& node, const std::string& path,
                                        ProblemList& problems) {
  MapReader map(node, path, problems);
  AdaptiveAugmentation augmentation;
  augmentation.adaptive_gain_1_s = map.Quantity("adaptive_gain", kPerTime, kNonNegative);
  augmentation.leakage_1_s = map.Quantity("leakage", kPerTime, kNonNegative);
  augmentation.spectral_gain_1_s = map.Quantity("spectral_gain", kPerTime, kNonNegative);
  augmentation.high_pass_rad_s = map.Quantity("high_pass", kFrequency, kPositive);
  augmentation.low_pass_rad_s = map.Quantity("low_pass", kFrequency, kPositive);
  augmentation.minimum_total_gain = map.Number("minimum_total_gain", kPositive);
  augmentation.maximum_total_gain = map.Number("maximum_total_gain", kPositive);
  return augmentation;
}

// The blocks that a law reads must be there; others may be (the same file with another law is a comparison).
AxisConfig DecodeAxis(const InputNode& node, const std::string& path, ProblemList& problems) {
  MapReader map(node, path, problems);
  AxisConfig axis;
  axis.law = map.Choice<ControlLaw>("law", {{"adaptive_fuzzy", ControlLaw::kAdaptiveFuzzy},
                                            {"frozen_fuzzy", ControlLaw::kFrozenFuzzy},
                                            {"pd", ControlLaw::kPd},
                                            {"pd_aac", ControlLaw::kPdAac}});
  map.Each("gains", 1, kMaxStages, [&](const InputNode& item, const std::string& item_path) {
    axis.gains.push_back(DecodeGains(item, item_path, problems));
  });
  const auto block = [&](const char* key, bool needed) -> const InputNode* {
    return needed ? &map.Required(key, "a map, which this law needs") : map.Optional(key);
  };
  const bool adaptive = axis.law == ControlLaw::kAdaptiveFuzzy;
  if (const InputNode* rules = block("rules", adaptive || axis.law == ControlLaw::kFrozenFuzzy)) {
    axis.rules = DecodeRules(*rules, map.PathOf("rules"), problems);
  }
  if (const InputNode* adaptation = block("adaptation", adaptive)) {
    axis.adaptation = DecodeAdaptation(*adaptation, map.PathOf("adaptation"), problems);
  }
  if (const InputNode* augmentation = block("augmentation", axis.law == ControlLaw::kPdAac)) {
    axis.augmentation = DecodeAugmentation(*augmentation, map.PathOf("augmentation"), problems);
  }
  return axis;
}

ReactionControlLogic DecodeReactionControl(const InputNode& node, const std::string& path,
                                           ProblemList& problems) {
  MapReader map(node, path, problems);
  ReactionControlLogic logic;
  logic.deadband_rad = map.Quantity("deadband", kAngle, kPositive);
  logic.rate_gain_s = map.Quantity("rate_gain", kTime, kNonNegative);
  logic.cycle_ticks = static_cast<int>(map.Integer("cycle_ticks", 1, 100));
  logic.hysteresis = map.Number("hysteresis", {0.0, 1.0, false, true});
  return logic;
}

}  // namespace

AutopilotConfig DecodeAutopilot(const InputNode& node, const std::string& path, int stages,
                                std::vector<InputProblem>& problems) {
  const std::size_t before = problems.size();
  AutopilotConfig autopilot;
  if (node.file == nullptr) return autopilot;  // already reported
  if (!CheckSchema(node, kAutopilotSchema, !path.empty(), path, problems)) return autopilot;
  {
    MapReader map(node, path, problems);
    map.Ignore("schema");
    autopilot.name = map.Text("name");
    autopilot.tick_s = map.Quantity("tick", kTime, {1e-4, 0.1, false, false});
    autopilot.pitch = DecodeAxis(map.Required("pitch", "a map"), map.PathOf("pitch"), problems);
    autopilot.yaw = DecodeAxis(map.Required("yaw", "a map"), map.PathOf("yaw"), problems);
    autopilot.roll = DecodeAxis(map.Required("roll", "a map"), map.PathOf("roll"), problems);
    autopilot.reaction_control = DecodeReactionControl(map.Required("reaction_control", "a map"),
                                                       map.PathOf("reaction_control"), problems);
  }
  if (stages == 0) stages = static_cast<int>(autopilot.pitch.gains.size());
  if (problems.size() == before) AddStructProblems(Problems(autopilot, stages), node, path, problems);
  return autopilot;
}

}  // namespace dispersa
