// Every field of an autopilot counts. Changing one field changes the autopilot's text and the campaign's
// flight id, and the text reads back to the field.
#include "core/campaign_yaml/load.h"
#include "core/math/constants.h"
#include "tests/test.h"
#include "tests/unit/input_files.h"

namespace dispersa::law_fields_test {
namespace {

constexpr double kDeg = kRadPerDeg;

// With every block that any law reads, each value away from its default.
AxisConfig FullAxis(ControlLaw law) {
  AxisConfig axis;
  axis.law = law;
  axis.gains = {{9.0, 4.0}, {16.0, 6.0}};
  axis.rules = {5.0 * kDeg, 1.5 * kDeg};
  Adaptation& a = axis.adaptation;
  a.gamma = {10.0, 20.0};
  a.q << 10.0, 0.5, 0.5, 8.0;
  a.p_n = Vector2(0.5, 1.5);
  a.allow_unproven = true;
  a.projection_bound_rad_s2 = 40.0 * kDeg;
  a.leakage_1_s = 0.125;
  a.spread_1_s = 12.0;
  a.dead_zone_rad = 0.01 * kDeg;
  a.composite = 3.0;
  a.predictor_1_s = 15.0;
  a.supervisory_bound = 0.25;
  axis.integral = {{2.0, 3.0}, 7.0 * kDeg, false};
  axis.augmentation = {100.0, 0.1, 1.5, 15.0, 2.0, 0.5, 1.5};
  axis.filters = {{60.0, 0.1, 80.0, 0.6, 1}, {0.0, 0.0, 120.0, 0.7, 0}};
  axis.schedule = {{1, 10.0, {10.0, 4.5}, 2.5, {{61.0, 0.2, 81.0, 0.65, 0}, {0.0, 0.0, 121.0, 0.75, 0}}}};
  axis.feed_forward = FeedForward{0.05};
  return axis;
}
AutopilotConfig FullAutopilot(ControlLaw law) {
  AutopilotConfig autopilot;
  autopilot.name = "full";
  autopilot.pitch = autopilot.yaw = autopilot.roll = FullAxis(law);
  autopilot.reaction_control = {0.1 * kDeg, 0.5, 0.2, 2};
  return autopilot;
}

struct Change {
  std::string name;
  std::function<void(AxisConfig&)> apply;
};

// Of the fields that a law reads. A structure that grows must be looked at here.
std::vector<Change> ChangesOf(const LawInfo& law) {
  static_assert(sizeof(AxisGains) == 2 * sizeof(double) && sizeof(FuzzyRules) == 2 * sizeof(double));
  static_assert(sizeof(AdaptiveAugmentation) == 7 * sizeof(double) && sizeof(FeedForward) == sizeof(double));
  static_assert(sizeof(FilterSection) == 5 * sizeof(double), "four numbers and a stage");
  std::vector<Change> all;
  const auto add = [&](const std::string& name, std::function<void(AxisConfig&)> apply) {
    all.push_back({name, std::move(apply)});
  };
  const auto number = [&](const std::string& name, std::function<double&(AxisConfig&)> field) {
    add(name, [field](AxisConfig& axis) { field(axis) *= 1.0 + 0x1p-20; });
  };
  const auto flag = [&](const std::string& name, std::function<bool&(AxisConfig&)> field) {
    add(name, [field](AxisConfig& axis) { field(axis) = !field(axis); });
  };
  for (std::size_t i = 0; i < 2; ++i) {
    number("kp" + std::to_string(i), [i](AxisConfig& a) -> double& { return a.gains[i].kp_1_s2; });
    number("kd" + std::to_string(i), [i](AxisConfig& a) -> double& { return a.gains[i].kd_1_s; });
    const auto section = [&](const std::string& of, std::function<FilterSection&(AxisConfig&)> f) {
      if (i == 0) {
        number(of + "zeros", [f](AxisConfig& a) -> double& { return f(a).zeros_rad_s; });
        number(of + "zeros damping", [f](AxisConfig& a) -> double& { return f(a).zeros_damping; });
      }
      number(of + "poles", [f](AxisConfig& a) -> double& { return f(a).poles_rad_s; });
      number(of + "poles damping", [f](AxisConfig& a) -> double& { return f(a).poles_damping; });
    };
    section("filter " + std::to_string(i) + " ",
            [i](AxisConfig& a) -> FilterSection& { return a.filters[i]; });
    section("scheduled filter " + std::to_string(i) + " ",
            [i](AxisConfig& a) -> FilterSection& { return a.schedule[0].filters[i]; });
  }
  add("filter stages", [](AxisConfig& a) { std::swap(a.filters[0].stage, a.filters[1].stage); });
  add("filter left out", [](AxisConfig& a) {
    a.filters.pop_back();
    a.schedule[0].filters.pop_back();
  });
  number("schedule at", [](AxisConfig& a) -> double& { return a.schedule[0].at_s; });
  number("schedule kp", [](AxisConfig& a) -> double& { return a.schedule[0].gains.kp_1_s2; });
  number("schedule kd", [](AxisConfig& a) -> double& { return a.schedule[0].gains.kd_1_s; });
  add("schedule left out", [](AxisConfig& a) { a.schedule.clear(); });
  number("lead", [](AxisConfig& a) -> double& { return a.feed_forward->lead_s; });
  add("feed forward left out", [](AxisConfig& a) { a.feed_forward.reset(); });
  if (law.rules) {
    number("error range", [](AxisConfig& a) -> double& { return a.rules.error_range_rad; });
    number("rate range", [](AxisConfig& a) -> double& { return a.rules.rate_range_rad_s; });
  }
  if (law.adaptation) {
    for (std::size_t i = 0; i < 2; ++i) {
      number("gamma" + std::to_string(i), [i](AxisConfig& a) -> double& { return a.adaptation.gamma[i]; });
      const Eigen::Index k = static_cast<Eigen::Index>(i);
      number("q" + std::to_string(i), [k](AxisConfig& a) -> double& { return a.adaptation.q(k, k); });
      number("p_n" + std::to_string(i), [k](AxisConfig& a) -> double& { return (*a.adaptation.p_n)(k); });
    }
    add("q beside", [](AxisConfig& a) { a.adaptation.q(0, 1) = a.adaptation.q(1, 0) = 0.25; });
    add("p_n left out", [](AxisConfig& a) { a.adaptation.p_n.reset(); });
    add("unproven not allowed", [](AxisConfig& a) {
      a.adaptation.p_n.reset();
      a.adaptation.allow_unproven = false;
    });
    number("projection", [](AxisConfig& a) -> double& { return a.adaptation.projection_bound_rad_s2; });
    number("leakage", [](AxisConfig& a) -> double& { return a.adaptation.leakage_1_s; });
    number("spread", [](AxisConfig& a) -> double& { return a.adaptation.spread_1_s; });
    number("dead zone", [](AxisConfig& a) -> double& { return a.adaptation.dead_zone_rad; });
    number("composite", [](AxisConfig& a) -> double& { return a.adaptation.composite; });
    number("predictor", [](AxisConfig& a) -> double& { return a.adaptation.predictor_1_s; });
    number("supervisory", [](AxisConfig& a) -> double& { return a.adaptation.supervisory_bound; });
    flag("normalized", [](AxisConfig& a) -> bool& { return a.adaptation.normalized; });
    flag("frozen when saturated", [](AxisConfig& a) -> bool& { return a.adaptation.freeze_when_saturated; });
    flag("adaptation reset", [](AxisConfig& a) -> bool& { return a.adaptation.reset_at_ignition; });
  }
  if (law.integral) {
    for (std::size_t i = 0; i < 2; ++i)
      number("ki" + std::to_string(i), [i](AxisConfig& a) -> double& { return a.integral.ki_1_s3[i]; });
    number("integral bound", [](AxisConfig& a) -> double& { return a.integral.bound_rad_s2; });
    flag("integral reset", [](AxisConfig& a) -> bool& { return a.integral.reset_at_ignition; });
    number("schedule ki", [](AxisConfig& a) -> double& { return a.schedule[0].ki_1_s3; });
  }
  if (law.augmentation) {
    using Field = double AdaptiveAugmentation::*;
    const std::pair<const char*, Field> fields[] = {
        {"adaptive gain", &AdaptiveAugmentation::adaptive_gain_1_s},
        {"augmentation leakage", &AdaptiveAugmentation::leakage_1_s},
        {"spectral gain", &AdaptiveAugmentation::spectral_gain_1_s},
        {"high pass", &AdaptiveAugmentation::high_pass_rad_s},
        {"low pass", &AdaptiveAugmentation::low_pass_rad_s},
        {"least gain", &AdaptiveAugmentation::minimum_total_gain},
        {"largest gain", &AdaptiveAugmentation::maximum_total_gain}};
    for (const auto& [name, field] : fields)
      number(name, [field = field](AxisConfig& a) -> double& { return a.augmentation.*field; });
  }
  return all;
}

// Prints as its name; the bytes of the structure would be addresses.
struct Law : LawInfo {};
void PrintTo(const Law& law, std::ostream* out) { *out << law.name; }

class LawFields : public testing::TestWithParam<Law> {
 protected:
  /// The flight id of tests/data/yaml's campaign under an autopilot.
  std::string FlightId(const AutopilotConfig& autopilot) const {
    files_.Write("autopilot.yaml", WriteAutopilot(autopilot));
    return LoadCampaign(files_.Path("campaign.yaml")).flight_id;
  }
  /// Checks that an autopilot is none of those before it, in text and id, and survives its text.
  void Add(const std::string& name, const AutopilotConfig& autopilot) {
    const std::string text = WriteAutopilot(autopilot);
    const auto [text_of, is_new_text] = texts_.emplace(text, name);
    EXPECT_TRUE(is_new_text) << name << " has the text of " << text_of->second;
    const auto [id_of, is_new_id] = ids_.emplace(FlightId(autopilot), name);
    EXPECT_TRUE(is_new_id) << name << " has the flight id of " << id_of->second;
    EXPECT_EQ(WriteAutopilot(LoadAutopilot({"text", text})), text) << name;
  }

  InputFiles files_;
  std::map<std::string, std::string> texts_, ids_;
};

TEST_P(LawFields, ChangeTextAndFlightIdEachByItself) {
  const AutopilotConfig base = FullAutopilot(GetParam().law);
  Add("the autopilot as it is", base);
  using Axis = AxisConfig AutopilotConfig::*;
  const std::pair<const char*, Axis> axes[] = {{"pitch ", &AutopilotConfig::pitch},
                                               {"yaw ", &AutopilotConfig::yaw},
                                               {"roll ", &AutopilotConfig::roll}};
  for (const Change& change : ChangesOf(GetParam())) {
    for (const auto& [name, axis] : axes) {
      AutopilotConfig changed = base;
      change.apply(changed.*axis);
      Add(name + change.name, changed);
    }
  }
  for (const auto& [name, axis] : axes) {
    AutopilotConfig changed = base;
    (changed.*axis).law = GetParam().law == ControlLaw::kPd ? ControlLaw::kPid : ControlLaw::kPd;
    Add(std::string(name) + "law", changed);
  }
}

TEST_P(LawFields, OfTheWholeAutopilotCountToo) {
  const AutopilotConfig base = FullAutopilot(GetParam().law);
  Add("the autopilot as it is", base);
  const std::pair<const char*, std::function<void(AutopilotConfig&)>> changes[] = {
      {"tick", [](AutopilotConfig& a) { a.tick_s = 0.005; }},
      {"deadband", [](AutopilotConfig& a) { a.reaction_control.deadband_rad = 0.11 * kDeg; }},
      {"rate gain", [](AutopilotConfig& a) { a.reaction_control.rate_gain_s = 0.51; }},
      {"hysteresis", [](AutopilotConfig& a) { a.reaction_control.hysteresis = 0.21; }},
      {"cycle", [](AutopilotConfig& a) { a.reaction_control.cycle_ticks = 4; }},
  };
  for (const auto& [name, change] : changes) {
    AutopilotConfig changed = base;
    change(changed);
    Add(name, changed);
  }
}

std::vector<Law> OwnLaws() {
  std::vector<Law> laws;
  for (const LawInfo& law : kLaws)
    if (!law.foreign) laws.push_back({law});
  return laws;
}
INSTANTIATE_TEST_SUITE_P(Laws, LawFields, testing::ValuesIn(OwnLaws()),
                         [](const auto& law) { return std::string(law.param.name); });

TEST(RateGyroFields, ChangeTextAndFlightId) {
  const InputFiles files;
  files.Edit("flexible.yaml", "sensors: {inertial_unit: {station_m: 2}}",
             "sensors: {inertial_unit: {station_m: 2}, rate_gyros: [{name: a, station_m: 1}, {name: b, "
             "station_m: 1.5}]}");
  files.Edit("campaign.yaml", "vehicle: vehicle.yaml", "vehicle: flexible.yaml");
  AutopilotConfig base = LoadAutopilot(files.Path("autopilot.yaml"));
  base.rate_gyros = {{"a", 0.25, 0}, {"b", 0.75, 0}};
  std::vector<AutopilotConfig> all(6, base);
  all[1].rate_gyros = {{"a", 0.26, 0}, {"b", 0.74, 0}};
  all[2].rate_gyros = {{"b", 0.25, 0}, {"a", 0.75, 0}};
  all[3].rate_gyros = {{"a", 0.25, 1}, {"b", 0.75, 1}};
  all[4].rate_gyros = {{"a", 0.25, 2}, {"b", 0.75, 2}};
  all[5].rate_gyros = {};
  std::map<std::string, std::size_t> ids;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string text = WriteAutopilot(all[i]);
    EXPECT_EQ(WriteAutopilot(LoadAutopilot({"text", text})), text);
    files.Write("autopilot.yaml", text);
    const auto [other, is_new] = ids.emplace(LoadCampaign(files.Path("campaign.yaml")).flight_id, i);
    EXPECT_TRUE(is_new) << i << " has the flight id of " << other->second;
  }
}

}  // namespace
}  // namespace dispersa::law_fields_test
