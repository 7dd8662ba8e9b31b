// Ascents side by side have the same bits as one alone, with any neighbours and in any order.
#include "core/campaign_yaml/load.h"
#include "core/trajectory/ascent.h"
#include "tests/test.h"

namespace dispersa::trajectory_ascent_test {
namespace {

const AscentModel& Model() {
  static const AscentModel model =
      BuildAscentModel(LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml"), 0.01);
  return model;
}

// Different in every variable, so that no two lanes have their events together; some fall back to the ground.
std::vector<FlightProgram> Programs() {
  const FlightProgram shipped = LoadReference(DISPERSA_CAMPAIGNS "/references/slv4_500km.yaml").program;
  std::vector<FlightProgram> programs;
  for (int i = 0; i < 21; ++i) {
    FlightProgram program = shipped;
    program.alpha_max_rad *= i % 5 == 3 ? 3.0 : 1.0 + 0.01 * i;
    program.t1_s += 0.13 * (i % 4);
    program.t3_s += 0.31 * (i % 3);
    program.t2_s -= 0.47 * (i % 7);
    program.coast_s -= 5.3 * i;
    program.launch_azimuth_rad -= 0.02 * (i % 6);
    programs.push_back(program);
  }
  return programs;
}

AscentOptions SearchOptions() {
  AscentOptions options;
  options.steps = {0.5, 2.0, 20.0};
  return options;
}

void ExpectSame(const AscentResult& a, const AscentResult& b) {
  EXPECT_EQ(a.completed, b.completed);
  EXPECT_EQ(a.end_time_s, b.end_time_s);
  EXPECT_EQ(a.p_EoC_I, b.p_EoC_I);
  EXPECT_EQ(a.v_IC_I, b.v_IC_I);
  EXPECT_EQ(a.orbit.altitude_m, b.orbit.altitude_m);
  EXPECT_EQ(a.last_ignition_s, b.last_ignition_s);
  EXPECT_EQ(a.q_max_pa, b.q_max_pa);
  EXPECT_EQ(a.q_alpha_max_pa_rad, b.q_alpha_max_pa_rad);
  EXPECT_EQ(a.axial_load_max_g, b.axial_load_max_g);
  EXPECT_EQ(a.lateral_load_max_g, b.lateral_load_max_g);
  EXPECT_EQ(a.turn_rate_max_rad_s, b.turn_rate_max_rad_s);
  EXPECT_EQ(a.mach_at_t2, b.mach_at_t2);
  EXPECT_EQ(a.transonic_alpha_max_rad, b.transonic_alpha_max_rad);
}

TEST(FlyAscents, AreTheSameInAnyNumberOfLanesAndAnyOrder) {
  std::vector<FlightProgram> programs = Programs();
  std::vector<AscentResult> alone;
  for (const FlightProgram& program : programs) alone.push_back(FlyAscent(Model(), program, SearchOptions()));
  const auto completed = [](const AscentResult& result) { return result.completed; };
  EXPECT_TRUE(std::any_of(alone.begin(), alone.end(), completed));
  EXPECT_FALSE(std::all_of(alone.begin(), alone.end(), completed));
  for (const bool reversed : {false, true}) {
    if (reversed) {
      std::reverse(programs.begin(), programs.end());
      std::reverse(alone.begin(), alone.end());
    }
    for (const int width : {1, 4, 8}) {
      SCOPED_TRACE(std::to_string(width) + (reversed ? " lanes, reversed" : " lanes"));
      const std::vector<AscentResult> together = FlyAscents(Model(), programs, SearchOptions(), width);
      ASSERT_EQ(together.size(), programs.size());
      for (std::size_t i = 0; i < programs.size(); ++i) ExpectSame(alone[i], together[i]);
    }
  }
}

TEST(FlyAscents, FewerThanThereAreLanes) {
  std::vector<FlightProgram> programs = Programs();
  programs.resize(3);
  const std::vector<AscentResult> together = FlyAscents(Model(), programs, SearchOptions(), 8);
  ASSERT_EQ(together.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i)
    ExpectSame(FlyAscent(Model(), programs[i], SearchOptions()), together[i]);
  EXPECT_TRUE(FlyAscents(Model(), {}, SearchOptions()).empty());
}

TEST(FlyAscents, RecordingChangesNothingElse) {
  const std::vector<FlightProgram> programs = {Programs()[0], Programs()[3]};
  AscentOptions recording = SearchOptions();
  recording.record = true;
  const std::vector<AscentResult> recorded = FlyAscents(Model(), programs, recording);
  for (std::size_t i = 0; i < programs.size(); ++i) {
    ExpectSame(FlyAscent(Model(), programs[i], SearchOptions()), recorded[i]);
    ASSERT_FALSE(recorded[i].samples.empty());
    EXPECT_EQ(recorded[i].samples.front().time_s, 0.0);
    EXPECT_LE(recorded[i].samples.back().time_s, recorded[i].end_time_s);
  }
  // The attitude program goes on for flights that burn longer.
  EXPECT_EQ(recorded[0].samples.back().time_s, recorded[0].end_time_s);
  EXPECT_DOUBLE_EQ(recorded[0].attitude.knots.back().time_s, recorded[0].end_time_s + 30.0);
}

TEST(FlyAscents, RefusesOtherWidths) {
  try {
    FlyAscents(Model(), Programs(), SearchOptions(), 2);
    ADD_FAILURE() << "no error";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "FlyAscents: width is 2; allowed are 1, 4 and 8");
  }
}

}  // namespace
}  // namespace dispersa::trajectory_ascent_test
