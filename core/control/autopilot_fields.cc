#include "core/control/autopilot_fields.h"

#include "core/math/stages.h"

namespace dispersa {
namespace {

// Delays and actuators need less than a second. A longer lead would be another program.
constexpr Range kLead = Between(0.0, 1.0);

void DescribeGains(Fields& fields, AxisGains& gains) {
  fields.Quantity("kp", kPerTimeSquared, kPositive, gains.kp_1_s2, "of the error dynamics s^2 + kd s + kp");
  fields.Quantity("kd", kPerTime, kPositive, gains.kd_1_s, "gain on the rate of the error");
}

void DescribeSection(Fields& fields, FilterSection& section) {
  fields.Quantity("zeros", kFrequency, kPositive, section.zeros_rad_s, "of a notch; default: a low pass",
                  0.0);
  fields.Number("zeros_damping", kNonNegative, section.zeros_damping, "of the zeros", 0.0);
  fields.Quantity("poles", kFrequency, kPositive, section.poles_rad_s, "of the section");
  fields.Number("poles_damping", kPositive, section.poles_damping, "of the poles");
}

void DescribeFilter(Fields& fields, FilterSection& section) {
  DescribeSection(fields, section);
  fields.Integer("stage", 1, kMaxStages, section.stage, "in whose burn it acts; default: all", 0);
}

// ---- schedule ----

// What a schedule's next entry has if it names no filters: those of the entry before, else the stage's own.
std::vector<FilterSection> FiltersBefore(const AxisConfig& axis, std::size_t entry) {
  const int stage = axis.schedule[entry].stage;
  if (entry > 0 && axis.schedule[entry - 1].stage == stage) return axis.schedule[entry - 1].filters;
  std::vector<FilterSection> own;
  for (const std::size_t i : FiltersOfStage(axis, stage)) own.push_back(axis.filters[i]);
  return own;
}

void DescribeEntry(Fields& fields, AxisConfig& axis, ScheduleEntry& entry) {
  bool has_filters = false;
  fields.When(HasList("filters"), [&] { has_filters = true; });
  fields.Integer("stage", 1, kMaxStages, entry.stage, "in whose burn it applies", 0);
  fields.Quantity("at", kTime, kPositive, entry.at_s, "since its ignition");
  DescribeGains(fields, entry.gains);
  constexpr const char* kOfIntegral = "gain of the integral, for a law with one";
  std::optional<double> of_other_laws;
  if (InfoOf(axis.law).integral)
    fields.Number("ki_1_s3", kNonNegative, entry.ki_1_s3, kOfIntegral);
  else
    fields.OptionalNumber("ki_1_s3", kNonNegative, of_other_laws, kOfIntegral);
  fields.List("filters", 0, kFilterSections, entry.filters, "replace those before: same number, same order",
              DescribeSection);
  if (!has_filters)
    entry.filters = FiltersBefore(axis, static_cast<std::size_t>(&entry - axis.schedule.data()));
}

// ---- blocks of a law ----

void Describe(Fields& fields, FuzzyRules& rules) {
  fields.Quantity("error_range", kAngle, kPositive, rules.error_range_rad,
                  "outer set centres of the error, +-");
  fields.Quantity("rate_range", kAngularRate, kPositive, rules.rate_range_rad_s,
                  "outer set centres of its rate, +-");
}

void Describe(Fields& fields, Adaptation& adaptation) {
  fields.Numbers("gamma", kNonNegative, 1, kMaxStages, adaptation.gamma, "adaptation gain, one per stage");
  Matrix2& q = adaptation.q;
  std::vector<std::vector<double>> rows = {{q(0, 0), q(0, 1)}, {q(1, 0), q(1, 1)}};
  fields.Rows("q", 2, 2, 2, rows, "[[q11, q12], [q12, q22]]",
              "Q of the Lyapunov equation, symmetric positive definite");
  if (rows.size() == 2 && rows[0].size() == 2 && rows[1].size() == 2)
    q << rows[0][0], rows[0][1], rows[1][0], rows[1][1];
  std::vector<double> p_n;
  if (adaptation.p_n) p_n = {adaptation.p_n->x(), adaptation.p_n->y()};
  fields.OptionalNumbers("p_n", kAnyNumber, 2, 2, p_n,
                         "last column of P; it follows from gains and Q and must agree with them");
  if (p_n.size() == 2) adaptation.p_n = Vector2(p_n[0], p_n[1]);
  fields.Flag("allow_unproven", adaptation.allow_unproven, false,
              "fly a P_n that does not follow from gains and Q");
  fields.Quantity("projection_bound", kAngularAcceleration, kNonNegative, adaptation.projection_bound_rad_s2,
                  "largest change of a consequent from its start; 0: unlimited", 0.0);
  fields.Quantity("leakage", kPerTime, kNonNegative, adaptation.leakage_1_s,
                  "sigma modification: pulls the consequents to their start", 0.0);
  fields.Quantity("spread", kPerTime, kNonNegative, adaptation.spread_1_s,
                  "pulls the consequents' changes to their mean over the rules", 0.0);
  fields.Quantity("dead_zone", kAngle, kNonNegative, adaptation.dead_zone_rad,
                  "no adaptation while |e' P_n| / p12 is smaller", 0.0);
  fields.Flag("normalized", adaptation.normalized, false,
              "divides the regressor of (32) by its squared norm");
  fields.Number("composite", kNonNegative, adaptation.composite,
                "adds this times p22 times the prediction error to (32)", 0.0);
  fields.Quantity("predictor", kPerTime, kNonNegative, adaptation.predictor_1_s,
                  "how fast the prediction follows the measurement", 0.0);
  fields.Flag("freeze_when_saturated", adaptation.freeze_when_saturated, false,
              "no adaptation into a deflection limit");
  fields.Flag("reset_at_ignition", adaptation.reset_at_ignition, false,
              "consequents restart with each stage");
  fields.Number("supervisory_bound", kNonNegative, adaptation.supervisory_bound,
                "the supervisory term acts while V exceeds it; 0: never", 0.0);
}

void Describe(Fields& fields, IntegralAction& integral) {
  fields.Numbers("ki_1_s3", kNonNegative, 1, kMaxStages, integral.ki_1_s3,
                 "gain of the integral, one per stage");
  fields.Quantity("bound", kAngularAcceleration, kNonNegative, integral.bound_rad_s2,
                  "of the integral's share; 0: none", 0.0);
  fields.Flag("reset_at_ignition", integral.reset_at_ignition, false,
              "the integral restarts with each stage");
}

void Describe(Fields& fields, AdaptiveAugmentation& augmentation) {
  fields.Quantity("adaptive_gain", kPerTime, kNonNegative, augmentation.adaptive_gain_1_s,
                  "on the squared error from the reference model, in rad");
  fields.Quantity("leakage", kPerTime, kNonNegative, augmentation.leakage_1_s, "pulls the total gain to 1");
  fields.Quantity("spectral_gain", kPerTime, kNonNegative, augmentation.spectral_gain_1_s,
                  "on the squared high-passed command, in rad/s^2");
  fields.Quantity("high_pass", kFrequency, kPositive, augmentation.high_pass_rad_s,
                  "of the spectral damper, above the loop's bandwidth");
  fields.Quantity("low_pass", kFrequency, kPositive, augmentation.low_pass_rad_s, "of the spectral damper");
  fields.Number("minimum_total_gain", kPositive, augmentation.minimum_total_gain, "lower limit");
  fields.Number("maximum_total_gain", kPositive, augmentation.maximum_total_gain, "upper limit");
}

// The blocks that a law reads must be there; others may be (the same file with another law is a comparison).
template <class Block>
void DescribeBlock(Fields& fields, const char* key, ControlLaw law, bool LawInfo::*needs, Block& block,
                   const char* meaning) {
  std::vector<std::string> laws;
  for (const LawInfo& info : kLaws)
    if (info.*needs) laws.emplace_back(info.name);
  const auto describe = [&] {
    bool is_there = InfoOf(law).*needs;
    fields.OptionalMap(key, is_there, meaning, [&](Fields& map) { Describe(map, block); });
  };
  fields.Either({{Has(key), describe, InfoOf(law).*needs},
                 {Is("law", laws), [&] { fields.Missing({key}, "a map, which this law needs"); }}});
}

// ---- the file ----

void Describe(Fields& fields, AxisConfig& axis) {
  std::vector<std::pair<std::string, ControlLaw>> laws;
  for (const LawInfo& law : kLaws) laws.emplace_back(law.name, law.law);
  fields.Choice<ControlLaw>("law", laws, axis.law, "of the axis");
  fields.List("gains", 1, kMaxStages, axis.gains, "one per stage", DescribeGains);
  fields.List("filters", 0, kFilterSections, axis.filters, "in series, after the law", DescribeFilter);
  fields.List("schedule", 0, SIZE_MAX, axis.schedule, "values of the law at times in a stage's burn",
              [&axis](Fields& map, ScheduleEntry& entry) { DescribeEntry(map, axis, entry); });
  bool feeds_forward = axis.feed_forward.has_value();
  fields.OptionalMap("feed_forward", feeds_forward, "adds the program's angular acceleration, after the law",
                     [&](Fields& map) {
                       if (!axis.feed_forward) axis.feed_forward.emplace();
                       map.Quantity("lead", kTime, kLead, axis.feed_forward->lead_s,
                                    "how far the program is read ahead: delay and actuators");
                     });
  DescribeBlock(fields, "rules", axis.law, &LawInfo::rules, axis.rules, "fuzzy sets");
  DescribeBlock(fields, "adaptation", axis.law, &LawInfo::adaptation, axis.adaptation, "equation (32)");
  DescribeBlock(fields, "integral", axis.law, &LawInfo::integral, axis.integral, "of a PID law");
  DescribeBlock(fields, "augmentation", axis.law, &LawInfo::augmentation, axis.augmentation,
                "adaptive augmenting control");
}

void Describe(Fields& fields, ReactionControlLogic& logic) {
  fields.Quantity("deadband", kAngle, kPositive, logic.deadband_rad, "no firing inside it");
  fields.Quantity("rate_gain", kTime, kNonNegative, logic.rate_gain_s,
                  "of the switching line e + rate_gain de/dt");
  fields.Number("hysteresis", {0.0, 1.0, false, true}, logic.hysteresis,
                "a firing ends inside the deadband by this fraction of it");
  fields.Integer("cycle_ticks", 1, 100, logic.cycle_ticks,
                 "between decisions: thrusters open for whole cycles");
}

void DescribeShare(Fields& fields, GyroShare& share) {
  fields.Text("gyro", share.gyro, "of the vehicle's sensors");
  fields.Number("weight", Between(-10.0, 10.0), share.weight, "of its measurement", 1.0);
  fields.Integer("stage", 0, kMaxStages, share.stage, "in whose burn it counts; 0: all", 0);
}

void Describe(Fields& fields, PluginConfig& plugin, const OpenPlugin& open) {
  const auto python = [&] {
    plugin.in_python = true;
    fields.Map("python", "a law in Python, in a campaign flown under it", [&](Fields& law) {
      law.Text("name", plugin.name, "of the law");
      law.Text("sha256", plugin.sha256, "of its source");
      law.Check([&] { open(law, "", plugin); });
    });
  };
  const auto library = [&] {
    std::string base64;
    std::optional<std::vector<std::string>> names;
    fields.Group("", "", [&](Fields&) {
      fields.Bytes("library", "the file name of a shared object", "a shared object, or its bytes",
                   [&](Fields& object) {
                     object.Text("sha256", plugin.sha256, "of the bytes");
                     object.Text("base64", base64, "the bytes");
                   });
      fields.Check([&] { names = open(fields, base64, plugin); });
    });
    std::vector<double> values;
    const auto parameters = [&](Fields& map) {
      if (!names) return map.AnyNumbers();
      for (const std::string& name : *names) map.Number(name.c_str(), kAnyNumber, values.emplace_back(), "");
    };
    constexpr const char* kMeaning = "a number for each parameter that the law names";
    bool has_parameters = false;
    if (names && !names->empty())
      fields.Map("parameters", kMeaning, parameters);
    else
      fields.OptionalMap("parameters", has_parameters, kMeaning, parameters);
    for (std::size_t i = 0; i < values.size(); ++i) plugin.parameters.emplace_back((*names)[i], values[i]);
  };
  fields.Either({{Has("python"), python}, {Else(), library}});
}

}  // namespace

void Describe(Fields& fields, AutopilotConfig& autopilot, const OpenPlugin& open) {
  fields.Text("name", autopilot.name, "of the autopilot");
  fields.Quantity("tick", kTime, Between(1e-4, 0.1), autopilot.tick_s, "between two commands");
  for (const auto& [key, config] :
       {std::pair("pitch", &autopilot.pitch), {"yaw", &autopilot.yaw}, {"roll", &autopilot.roll}})
    fields.Map(key, "control law of this axis", [config = config](Fields& map) {
      map.Group("axis", "law", [config](Fields& axis) { Describe(axis, *config); });
    });
  fields.List("rate_gyros", 0, SIZE_MAX, autopilot.rate_gyros,
              "measure the rates; default: the inertial unit", DescribeShare);
  bool has_plugin = false;
  fields.OptionalMap("plugin", has_plugin, "a control law of your own",
                     [&](Fields& plugin) { Describe(plugin, autopilot.plugin.emplace(), open); });
  fields.Map("reaction_control", "in unpowered flight",
             [&](Fields& logic) { Describe(logic, autopilot.reaction_control); });
}

}  // namespace dispersa
