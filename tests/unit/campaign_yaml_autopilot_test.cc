// An autopilot that is written to a file and read back is the same.
#include "core/campaign_yaml/load.h"
#include "core/control/law_here.h"
#include "tests/test.h"

namespace dispersa::campaign_yaml_autopilot_test {

constexpr char kEverything[] = R"(schema: dispersa/autopilot/1
name: all_laws
tick_s: 0.02
pitch:
  law: adaptive_fuzzy
  gains:
    - {kp_1_s2: 16.3, kd_1_s: 7}
    - {kp_1_s2: 25, kd_1_s: 9.01}
  rules: {error_range_deg: 5, rate_range_deg_s: 1.5}
  adaptation:
    gamma: [8000, 0]
    q: [[1, 0.1], [0.1, 0.02]]
    p_n: [0.02, -0.01]
    allow_unproven: true
    projection_bound_deg_s2: 60
    leakage_1_s: 0.1
    spread_1_s: 40
    dead_zone_deg: 0.01
    normalized: true
    composite: 2
    predictor_1_s: 20
    freeze_when_saturated: true
    reset_at_ignition: true
    supervisory_bound: 0.5
yaw:
  law: pd_aac
  gains:
    - {kp_1_s2: 1, kd_1_s: 2}
    - {kp_1_s2: 3, kd_1_s: 4}
  augmentation:
    adaptive_gain_1_s: 2000
    leakage_1_s: 0.1
    spectral_gain_1_s: 20
    high_pass_rad_s: 15
    low_pass_rad_s: 2
    minimum_total_gain: 0.5
    maximum_total_gain: 1.6
roll:
  law: frozen_fuzzy
  gains:
    - {kp_1_s2: 5, kd_1_s: 6}
    - {kp_1_s2: 7, kd_1_s: 8}
  rules: {error_range_deg: 4, rate_range_deg_s: 1}
reaction_control: {deadband_deg: 0.05, rate_gain_s: 0.5, hysteresis: 0.25, cycle_ticks: 5}
)";

TEST(WriteAutopilot, WritesWhatWasReadToTheCharacter) {
  EXPECT_EQ(WriteAutopilot(LoadAutopilot({"text", kEverything})), kEverything);
}

TEST(WriteAutopilot, QuotesANameThatYamlWouldReadAsSomethingElse) {
  AutopilotConfig autopilot = LoadAutopilot({"text", kEverything});
  autopilot.name = "1: a #'\"\n";
  EXPECT_EQ(LoadAutopilot({"text", WriteAutopilot(autopilot)}).name, autopilot.name);
}

TEST(WriteAutopilot, LeavesOutGuardsThatAreOff) {
  AutopilotConfig autopilot = LoadAutopilot({"text", kEverything});
  Adaptation bare;
  bare.gamma = {1.0, 2.0};
  bare.q = autopilot.pitch.adaptation.q;
  autopilot.pitch.adaptation = bare;
  const std::string text = WriteAutopilot(autopilot);
  EXPECT_THAT(text, HasSubstr("    gamma: [1, 2]\n    q: [[1, 0.1], [0.1, 0.02]]\nyaw:")) << text;
}

TEST(WriteAutopilot, ShippedAutopilotsKeepEveryKey) {
  for (const auto& entry : std::filesystem::directory_iterator(DISPERSA_CAMPAIGNS "/autopilots")) {
    const AutopilotConfig autopilot = LoadAutopilot(entry.path().string());
    const std::string text = WriteAutopilot(autopilot);
    EXPECT_EQ(WriteAutopilot(LoadAutopilot({"text", text})), text) << entry.path();
  }
}

const std::string kPidRoll = R"(
roll:
  law: pid
  gains:
    - {kp_1_s2: 5, kd_1_s: 6}
    - {kp_1_s2: 7, kd_1_s: 8}
)";

std::string WithRoll(const std::string& roll) {
  const std::string all = kEverything;
  return all.substr(0, all.find("\nroll:")) + roll + all.substr(all.find("reaction_control:"));
}

TEST(WriteAutopilot, WritesAScheduleInFull) {
  const auto with_schedule = [](const std::string& schedule) {
    return WithRoll(kPidRoll + R"(  filters:
    - {poles_rad_s: 20, poles_damping: 0.7, stage: 1}
  schedule:
)" + schedule + R"(  integral:
    ki_1_s3: [9.5, 0]
)");
  };
  // An entry without filters has those before it; stages without any have none.
  const std::string short_text = with_schedule(
      "    - {stage: 1, at_s: 5, kp_1_s2: 6, kd_1_s: 6, ki_1_s3: 1}\n"
      "    - {stage: 1, at_s: 9, kp_1_s2: 6, kd_1_s: 7, ki_1_s3: 1, filters: [{poles_rad_s: 30, "
      "poles_damping: 1}]}\n"
      "    - {stage: 1, at_s: 12.5, kp_1_s2: 8, kd_1_s: 7, ki_1_s3: 0}\n"
      "    - {stage: 2, at_s: 3, kp_1_s2: 8, kd_1_s: 7, ki_1_s3: 2}\n");
  const std::string full_text = with_schedule(
      "    - {stage: 1, at_s: 5, kp_1_s2: 6, kd_1_s: 6, ki_1_s3: 1, filters: [{poles_rad_s: 20, "
      "poles_damping: 0.7}]}\n"
      "    - {stage: 1, at_s: 9, kp_1_s2: 6, kd_1_s: 7, ki_1_s3: 1, filters: [{poles_rad_s: 30, "
      "poles_damping: 1}]}\n"
      "    - {stage: 1, at_s: 12.5, kp_1_s2: 8, kd_1_s: 7, ki_1_s3: 0, filters: [{poles_rad_s: 30, "
      "poles_damping: 1}]}\n"
      "    - {stage: 2, at_s: 3, kp_1_s2: 8, kd_1_s: 7, ki_1_s3: 2}\n");
  EXPECT_EQ(WriteAutopilot(LoadAutopilot({"text", short_text})), full_text);
  EXPECT_EQ(WriteAutopilot(LoadAutopilot({"text", full_text})), full_text);
}

TEST(ReadAutopilot, NamesALawInPythonButDoesNotHoldIt) {
  const std::string sha256(64, 'a');
  std::string roll = kPidRoll;
  roll.replace(roll.find("pid"), 3, "plugin");
  const std::string text = WithRoll(roll) + "plugin: {python: {name: mine, sha256: " + sha256 + "}}\n";
  const auto problem = [&text] { return ErrorOf<InputError>([&] { LoadAutopilot({"flown.yaml", text}); }); };
  const std::string absent =
      "flown.yaml:44:18: plugin.python: flown with a Python law, 'mine', which is not in the file: without "
      "it the campaign cannot be flown, allowed: dispersa.run(..., workers=0, law=...) in Python, with that "
      "law";
  EXPECT_EQ(problem(), absent);
  {
    LawHere law({});
    PluginConfig offer = law.Config({{"law", 3.0}});
    offer.sha256 = sha256;
    law.Offer(offer);
    const AutopilotConfig autopilot = LoadAutopilot({"flown.yaml", text});
    ASSERT_TRUE(autopilot.plugin.has_value());
    EXPECT_TRUE(autopilot.plugin->in_python);
    EXPECT_EQ(autopilot.plugin->name, "mine");
    EXPECT_NE(FunctionsHere(*autopilot.plugin), nullptr);
    std::thread([&] { EXPECT_EQ(problem(), absent) << "an offer is the thread's that makes it"; }).join();
  }
  EXPECT_EQ(problem(), absent);
}

}  // namespace dispersa::campaign_yaml_autopilot_test
