// A reference, and every number, that is written and read back is the same.
#include "core/campaign_yaml/load.h"
#include "core/input/number_text.h"
#include "core/math/constants.h"
#include "tests/test.h"
#include "tests/unit/input_files.h"

namespace dispersa::campaign_yaml_reference_test {
namespace {

std::uint64_t Bits(double value) { return std::bit_cast<std::uint64_t>(value); }

TEST(CampaignYamlNumbers, AreReadWholeOrNotAtAll) {
  EXPECT_EQ(ParseNumber("1.5"), 1.5);
  EXPECT_EQ(ParseNumber("+.5e1"), 5.0);
  EXPECT_EQ(ParseNumber("-7"), -7.0);
  EXPECT_FALSE(std::signbit(ParseNumber("-0.0").value()));
  EXPECT_TRUE(std::isinf(ParseNumber("1e999").value()));
  EXPECT_TRUE(std::isnan(ParseNumber(".nan").value()));
  for (const char* text : {"", "+", "1,5", "1.5 ", " 1.5", "0x10", "1_000", "1.5.2", "++1", "+-1", "ten"}) {
    EXPECT_FALSE(ParseNumber(text).has_value()) << text;
  }
}

TEST(CampaignYamlNumbers, AreWrittenShort) {
  EXPECT_EQ(FormatNumber(0.1), "0.1");
  EXPECT_EQ(FormatNumber(-0.0), "0");
  EXPECT_EQ(FormatNumber(1e6), "1000000");
  EXPECT_EQ(FormatNumber(1e22), "1e+22");
  EXPECT_EQ(FormatNumber(1.0 / 3.0), "0.3333333333333333");
  EXPECT_EQ(FormatScaled(6.0 * kRadPerDeg, kRadPerDeg), "6");
  EXPECT_EQ(FormatScaled(500e3, 1e3), "500");
}

// Any double, in any unit: what is written and read is written and read as the same for ever after, and is
// off by at most one unit in the last place at first.
TEST(CampaignYamlNumbers, ScaledTextIsAFixedPoint) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> exponent(-12.0, 12.0);
  int exact = 0;
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    const double value = (i % 2 == 0 ? 1.0 : -1.0) * std::pow(10.0, exponent(random));
    EXPECT_EQ(Bits(ParseNumber(FormatNumber(value)).value()), Bits(value));
    for (const double scale : {kRadPerDeg, 1e3, 1e-3, kDegPerRad}) {
      const std::string text = FormatScaled(value, scale);
      const double read = ParseNumber(text).value() * scale;
      EXPECT_LE(std::fabs(read - value), std::nextafter(std::fabs(value), INFINITY) - std::fabs(value));
      EXPECT_EQ(FormatScaled(read, scale), text);
      EXPECT_EQ(Bits(ParseNumber(FormatScaled(read, scale)).value() * scale), Bits(read));
      exact += read == value;
    }
  }
  // Half of the mantissas at least have a multiple that is finer than they are.
  EXPECT_GT(exact, 2 * kSamples);
}

Reference RandomReference() {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> angle(-1.0, 1.0);
  Reference reference = LoadReference(DISPERSA_TEST_DATA "/yaml/reference.yaml");
  reference.name = "it's 'quoted': #1";
  reference.problem.q_max_limit_pa = 80000.0;
  reference.problem.reaction_control_propellant_kg = 0.225;
  reference.problem.launch_azimuth_rad = {1.5 + 0.1 * angle(random), 2.9 + 0.1 * angle(random)};
  reference.program.alpha_max_rad = 0.05 + 0.01 * angle(random);
  reference.program.launch_azimuth_rad = 2.5 + 0.1 * angle(random);
  reference.attitude.launch_azimuth_rad = reference.program.launch_azimuth_rad;
  reference.orbit.altitude_m = 500e3 + angle(random);
  reference.constraints.push_back({"q_alpha_max_pa_rad", 1234.5, 0.0, 0.0, false});
  reference.attitude.knots.clear();
  for (int i = 0; i < 500; ++i) {
    reference.attitude.knots.push_back({0.1 * i, angle(random), angle(random), angle(random),
                                        0.01 * angle(random), 0.01 * angle(random), 0.01 * angle(random)});
  }
  return reference;
}

TEST(CampaignYamlReference, KeepsEveryField) {
  const Reference original = RandomReference();
  const Reference read = LoadReference({"reference.yaml", WriteReference(original)});
  EXPECT_EQ(read.name, original.name);
  EXPECT_EQ(read.problem.target_altitude_m, 500e3);
  EXPECT_EQ(read.problem.t3_s.low, 6.0);
  EXPECT_EQ(read.problem.t3_s.high, 9.0);
  EXPECT_EQ(read.problem.weight_altitude_1_m, original.problem.weight_altitude_1_m);
  EXPECT_EQ(read.problem.weight_angle_1_rad, original.problem.weight_angle_1_rad);
  EXPECT_EQ(read.problem.alpha_limit_rad, 6.0 * kRadPerDeg);
  EXPECT_EQ(read.problem.q_max_limit_pa, 80000.0);
  EXPECT_EQ(read.problem.q_alpha_limit_pa_rad, 0.0);
  EXPECT_EQ(read.problem.reaction_control_propellant_kg, 0.225);
  EXPECT_EQ(read.problem.seed, 1u);
  EXPECT_EQ(read.program.t3_s, 7.5);
  EXPECT_EQ(read.last_ignition_s, 420.5);
  EXPECT_EQ(read.orbit.velocity_m_s, 7612.5996);
  ASSERT_EQ(read.constraints.size(), 2u);
  EXPECT_EQ(read.constraints[1].name, "q_alpha_max_pa_rad");
  EXPECT_FALSE(read.constraints[1].enforced);
  EXPECT_EQ(read.engine, "0.1.0+000000000000");
  EXPECT_EQ(read.vehicle_sha256, "none");
  EXPECT_EQ(read.evaluations, 6000);
  EXPECT_EQ(read.attitude.launch_azimuth_rad, read.program.launch_azimuth_rad);
}

TEST(CampaignYamlReference, OfASingleStageIgnitesAtLiftOff) {
  Reference original = RandomReference();
  original.last_ignition_s = 0.0;
  EXPECT_EQ(LoadReference({"reference.yaml", WriteReference(original)}).last_ignition_s, 0.0);
}

TEST(CampaignYamlReference, KeepsWhatATargetAndCoastsHaveBesides) {
  Reference original = RandomReference();
  TrajectoryProblem& problem = original.problem;
  problem.target_inclination_rad = 51.6 * kRadPerDeg;
  problem.target_node_rad = 200.0 * kRadPerDeg;
  problem.velocity_is_free = true;
  problem.weight_inclination_1_rad = 10.0 * kDegPerRad;
  problem.earlier_coast_s[2] = {5.0, 90.0};
  problem.launch_azimuth_rad = {350.0 * kRadPerDeg, 370.0 * kRadPerDeg};
  original.program.earlier_coast_s[2] = 33.25;
  original.earlier_ignition_s[2] = 222.5;
  original.orbit.inclination_rad = 51.5 * kRadPerDeg;
  original.orbit.node_longitude_rad = 123.0 * kRadPerDeg;
  const std::string text = WriteReference(original);
  const Reference read = LoadReference({"reference.yaml", text});
  EXPECT_EQ(WriteReference(read), text);
  EXPECT_EQ(read.problem.target_inclination_rad, 51.6 * kRadPerDeg);
  EXPECT_EQ(read.problem.target_node_rad, 200.0 * kRadPerDeg);
  EXPECT_TRUE(read.problem.velocity_is_free);
  EXPECT_EQ(read.problem.weight_inclination_1_rad, problem.weight_inclination_1_rad);
  EXPECT_EQ(read.problem.earlier_coast_s[2].low, 5.0);
  EXPECT_EQ(read.problem.earlier_coast_s[2].high, 90.0);
  EXPECT_EQ(read.problem.earlier_coast_s[1].high, 0.0);
  EXPECT_EQ(read.problem.launch_azimuth_rad.high, 370.0 * kRadPerDeg);
  EXPECT_EQ(read.program.earlier_coast_s[2], 33.25);
  EXPECT_EQ(read.earlier_ignition_s[2], 222.5);
  EXPECT_EQ(read.orbit.node_longitude_rad, 123.0 * kRadPerDeg);
  // Without any of it there is nothing of it in the file.
  const std::string plain = WriteReference(RandomReference());
  for (const char* key : {"node", "perigee", "inclination_per", "stage"})
    EXPECT_EQ(plain.find(key), std::string::npos) << key;
}

TEST(CampaignYamlReference, AzimuthBoundsThatFallGoThroughNorth) {
  std::string text = TextOfFile(DISPERSA_TEST_DATA "/yaml/reference.yaml");
  const std::string from = "launch_azimuth_deg: [90, 170]";
  text.replace(text.find(from), from.size(), "launch_azimuth_deg: [350, 10]");
  const Reference read = LoadReference({"reference.yaml", text});
  EXPECT_EQ(read.problem.launch_azimuth_rad.low, 350.0 * kRadPerDeg);
  EXPECT_NEAR(read.problem.launch_azimuth_rad.high, 370.0 * kRadPerDeg, 1e-15);
}

// v² = mu (2/r - 1/a).
TEST(CampaignYamlReference, AnEllipseIsEnteredAtItsPerigee) {
  Reference original = RandomReference();
  original.problem.target_altitude_m = 200e3;
  original.problem.target_apogee_m = 800e3;
  original.problem.target_flight_path_angle_rad = 0.0;
  const Reference read = LoadReference({"reference.yaml", WriteReference(original)});
  const double mu = 3.986004418e14, radius = 6378137.0;
  EXPECT_EQ(read.problem.target_altitude_m, 200e3);
  EXPECT_EQ(read.problem.target_apogee_m, 800e3);
  EXPECT_EQ(read.problem.target_flight_path_angle_rad, 0.0);
  EXPECT_NEAR(read.problem.target_velocity_m_s,
              std::sqrt(mu * (2.0 / (radius + 200e3) - 1.0 / (radius + 500e3))), 1e-6);
}

Reference WithTarget(const std::string& target) {
  std::string text = TextOfFile(DISPERSA_TEST_DATA "/yaml/reference.yaml");
  const std::string from = "target: {altitude_km: 500, velocity_m_s: 7612.6, flight_path_angle_deg: 0}";
  text.replace(text.find(from), from.size(), "target: {" + target + "}");
  const std::string weights = "flight_path_angle_per_deg: 10}";
  if (target.find("argument") != std::string::npos)
    text.replace(text.find(weights), weights.size(),
                 "flight_path_angle_per_deg: 10, argument_of_perigee_per_deg: 1}");
  return LoadReference({"reference.yaml", text});
}

// By the conic section: r = p / (1 + e cos v), v² = mu (2/r - 1/a), tan(angle) = e sin v / (1 + e cos v).
TEST(CampaignYamlReference, AnEllipseIsGivenByItsAxisAndEnteredAtATrueAnomaly) {
  const Reference read = WithTarget(
      "semi_major_axis_km: 24400, eccentricity: 0.73, true_anomaly_deg: 20, "
      "argument_of_perigee_deg: 178");
  const double mu = 3.986004418e14, nu = 20.0 * kRadPerDeg, along = 1.0 + 0.73 * std::cos(nu);
  const double radius_m = 24.4e6 * (1.0 - 0.73 * 0.73) / along;
  EXPECT_NEAR(read.problem.target_altitude_m, 24.4e6 * 0.27 - 6378137.0, 1e-6);
  EXPECT_NEAR(*read.problem.target_apogee_m, 24.4e6 * 1.73 - 6378137.0, 1e-6);
  EXPECT_NEAR(read.problem.target_velocity_m_s, std::sqrt(mu * (2.0 / radius_m - 1.0 / 24.4e6)), 1e-8);
  EXPECT_NEAR(read.problem.target_flight_path_angle_rad, std::atan2(0.73 * std::sin(nu), along), 1e-14);
  EXPECT_EQ(read.problem.target_true_anomaly_rad, nu);
  EXPECT_FALSE(read.problem.is_entered_anywhere);
  const std::string text = WriteReference(read);
  EXPECT_NE(text.find("semi_major_axis_km: 24400, eccentricity: 0.73, true_anomaly_deg: 20"),
            std::string::npos)
      << text;
  EXPECT_EQ(text.find("apogee_altitude"), std::string::npos);
  EXPECT_EQ(text.find("entered_at"), std::string::npos);
  EXPECT_EQ(WriteReference(LoadReference({"reference.yaml", text})), text);
}

// 90 degrees at lift-off is exactly the constant that the loader makes of it.
TEST(CampaignYamlReference, AnglesBecomeRadiansOnce) {
  const Reference reference = LoadReference(DISPERSA_TEST_DATA "/yaml/reference.yaml");
  EXPECT_EQ(reference.attitude.knots[0].pitch, 90.0 * kRadPerDeg);
  EXPECT_EQ(reference.attitude.knots[1].pitch_rate, -0.7 * kRadPerDeg);
  EXPECT_EQ(reference.program.launch_azimuth_rad, 146.7 * kRadPerDeg);
}

}  // namespace
}  // namespace dispersa::campaign_yaml_reference_test
