// Thrust curves in vehicle files: tables, .eng files, curves of test stands.
#include "core/campaign_yaml/load.h"
#include "core/input/number_text.h"
#include "core/math/functions.h"
#include "core/math/table.h"
#include "tests/test.h"
#include "tests/unit/input_files.h"

namespace dispersa::campaign_yaml_thrust_curve_test {
namespace {

constexpr char kMotor[] =
    "{thrust_kn: 60, burning_time_s: 60, ignition_rise_s: 0.2, tail_off_s: 0.4, published_mass_flow_kg_s: "
    "25}";

// Made up.
constexpr char kEng[] =
    "; a made-up motor\n"
    "TRIAL-1 98 640 5-10 1500 1600 NOBODY\n"
    "   0.05 90000.0\n"
    "   0.50 100000\n"
    "   2.00 80000\n"
    "   2.60 0.0\n"
    ";\n";

Motor MotorOf(const InputFiles& files, const std::string& motor) {
  files.Edit("vehicle.yaml", kMotor, motor);
  return LoadVehicle(files.Path("vehicle.yaml")).stages[0].motor;
}

void ExpectCurve(const Motor& motor, const std::vector<double>& time_s, const std::vector<double>& thrust_n) {
  EXPECT_EQ(motor.thrust_curve.time_s, time_s);
  EXPECT_EQ(motor.thrust_curve.thrust_n, thrust_n);
  EXPECT_EQ(motor.thrust_n, motor.thrust_curve.Greatest());
  EXPECT_DOUBLE_EQ(motor.burning_time_s * motor.thrust_n, motor.thrust_curve.Impulse());
  EXPECT_EQ(motor.ignition_rise_s, 0.0);
}

TEST(ThrustCurveFile, OfACsv) {
  const InputFiles files;
  files.Write("curve.csv", "# as fired\nthrust_n,time_s\n0,0\n70000,1.5\n50000,50\n0,60\n");
  ExpectCurve(MotorOf(files, "{thrust_curve: {reference: vacuum, table: curve.csv}}"), {0.0, 1.5, 50.0, 60.0},
              {0.0, 70e3, 50e3, 0.0});
}

TEST(ThrustCurveFile, Inline) {
  const InputFiles files;
  ExpectCurve(
      MotorOf(files, "{thrust_curve: {reference: vacuum, table: {time_s: [0, 20], thrust_kn: [80, 60]}}}"),
      {0.0, 20.0}, {80e3, 60e3});
}

TEST(ThrustCurveFile, AtSeaLevelIsWithoutThePressureOfTheAir) {
  const InputFiles files;
  ExpectCurve(MotorOf(files,
                      "{nozzle_exit_area_m2: 0.2, thrust_curve: {reference: sea_level, table: {time_s: [0, "
                      "1, 20], thrust_n: [0, 60000, 0]}}}"),
              {0.0, 1.0, 20.0}, {0.0, 60000.0 + 0.2 * 101325.0, 0.0});
}

TEST(ThrustCurveFile, OfAnEngFileBeginsAtIgnition) {
  for (const std::string line_end : {"\n", "\r\n"}) {
    const InputFiles files;
    std::string text;
    for (const char c : std::string(kEng)) text += c == '\n' ? line_end : std::string(1, c);
    files.Write("curve.ENG", text);
    ExpectCurve(MotorOf(files, "{thrust_curve: {reference: vacuum, table: curve.ENG}}"),
                {0.0, 0.05, 0.5, 2.0, 2.6}, {0.0, 90e3, 100e3, 80e3, 0.0});
  }
}

// Of the first stage's 1500 kg the flow is 20 to 30 kg/s: 1505 kg in all.
TEST(ThrustCurveFile, MayGiveTheMassFlow) {
  const InputFiles files;
  files.Write("curve.csv", "time_s,mass_flow_kg_s,thrust_n\n0,20,50000\n30.1,30,70000\n60.2,20,50000\n");
  const Motor motor = MotorOf(files, "{thrust_curve: {reference: vacuum, table: curve.csv}}");
  EXPECT_EQ(motor.thrust_curve.flow_kg_s, (std::vector<double>{20.0, 30.0, 20.0}));
  EXPECT_EQ(motor.thrust_curve.thrust_n, (std::vector<double>{50e3, 70e3, 50e3}));
  EXPECT_DOUBLE_EQ(motor.burning_time_s, 25.0 * 60.2 / 30.0);
}

// A test stand's 100,000 rows: a smooth burn with a fast rise, and noise of 1 % of the greatest thrust.
std::string TestStand(std::size_t rows, double noise, double* impulse_n_s = nullptr) {
  std::string text = "time_s,thrust_n,chamber_pressure_bar\n";
  const double end_s = 25.0;
  double sum = 0.0, before_n = 0.0, before_s = 0.0;
  std::uint64_t state = 1;
  for (std::size_t i = 0; i < rows; ++i) {
    const double time_s = end_s * static_cast<double>(i) / static_cast<double>(rows - 1);
    const double x = time_s / end_s;
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    const double random = static_cast<double>(state >> 11) / 9007199254740992.0 - 0.5;
    const double full_n = 60e3 * (1.0 + 0.4 * std::sin(3.0 * x)) * (1.0 + 2.0 * noise * random);
    const double thrust_n =
        i + 1 == rows ? 0.0 : full_n * std::min({1.0, time_s / 0.1, (end_s - time_s) / 0.5});
    if (i > 0) sum += 0.5 * (thrust_n + before_n) * (time_s - before_s);
    before_n = thrust_n, before_s = time_s;
    text += FormatNumber(time_s) + "," + FormatNumber(thrust_n) + "," + FormatNumber(1e-3 * thrust_n) + "\n";
  }
  if (impulse_n_s != nullptr) *impulse_n_s = sum;
  return text;
}

TEST(ThrustCurveFile, OfATestStandIsThinned) {
  const InputFiles files;
  double impulse_n_s = 0.0;
  files.Write("curve.csv", TestStand(100'000, 0.0, &impulse_n_s));
  const auto start = std::chrono::steady_clock::now();
  const Motor motor = MotorOf(files, "{thrust_curve: {reference: vacuum, table: curve.csv}}");
  // A tenth of it on a free machine, with optimisation.
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
  const ThrustCurve& curve = motor.thrust_curve;
  EXPECT_EQ(curve.thinned.rows, 100'000u);
  EXPECT_LT(curve.time_s.size(), 200u);  // the error falls with the square of their number
  EXPECT_NEAR(curve.Impulse(), impulse_n_s, 1e-12 * impulse_n_s);
  EXPECT_LE(curve.thinned.thrust_error, kThinnedCurveTolerance);
  EXPECT_GT(curve.thinned.thrust_error, 0.0);
  // The exact function, everywhere, not only at rows.
  for (int i = 0; i <= 1000; ++i) {
    const double time_s = 25.0 * i / 1000.0;
    const double exact_n = 60e3 * (1.0 + 0.4 * std::sin(3.0 * time_s / 25.0)) *
                           std::min({1.0, time_s / 0.1, (25.0 - time_s) / 0.5});
    const Table1D table{curve.time_s, curve.thrust_n};
    EXPECT_NEAR(table(time_s), exact_n, 1.2e-4 * curve.Greatest()) << time_s;
  }
}

// 1 % of noise cannot be followed. The fit averages it: it is nearer to the motor than the noise is.
TEST(ThrustCurveFile, OfATestStandWithNoiseIsItsFit) {
  const InputFiles files;
  double impulse_n_s = 0.0;
  files.Write("curve.csv", TestStand(20'000, 0.01, &impulse_n_s));
  const ThrustCurve curve =
      MotorOf(files, "{thrust_curve: {reference: vacuum, table: curve.csv}}").thrust_curve;
  EXPECT_EQ(curve.time_s.size(), kThrustCurveCorners);
  EXPECT_NEAR(curve.Impulse(), impulse_n_s, 1e-12 * impulse_n_s);
  EXPECT_GE(curve.thinned.thrust_error, 0.009);
  EXPECT_LE(curve.thinned.thrust_error, 0.016);
  double sum = 0.0;
  const Table1D table{curve.time_s, curve.thrust_n};
  for (int i = 0; i <= 1000; ++i) {
    const double time_s = 25.0 * i / 1000.0;
    const double exact_n = 60e3 * (1.0 + 0.4 * std::sin(3.0 * time_s / 25.0)) *
                           std::min({1.0, time_s / 0.1, (25.0 - time_s) / 0.5});
    sum += Square((table(time_s) - exact_n) / curve.Greatest());
  }
  EXPECT_LT(std::sqrt(sum / 1001.0), 0.004);  // the noise has 0.0058
}

TEST(ThrustCurveFile, IsThinnedOnceForAll) {
  const InputFiles files;
  files.Edit("vehicle.yaml", kMotor, "{thrust_curve: {reference: vacuum, table: curve.csv}}");
  files.Write("curve.csv", TestStand(5000, 0.01));
  const Campaign campaign = LoadCampaign(files.Path("campaign.yaml"));
  const Campaign again = ParseCampaign(campaign.canonical_yaml, "again");
  EXPECT_EQ(again.canonical_yaml, campaign.canonical_yaml);
  EXPECT_EQ(again.flight_id, campaign.flight_id);
  const ThrustCurve &here = campaign.vehicle.stages[0].motor.thrust_curve,
                    &there = again.vehicle.stages[0].motor.thrust_curve;
  EXPECT_EQ(here.time_s.size(), kThrustCurveCorners);
  EXPECT_EQ(there.time_s, here.time_s);
  EXPECT_EQ(there.thrust_n, here.thrust_n);
  EXPECT_EQ(there.pressure_pa, here.pressure_pa);
}

TEST(ThrustCurveFile, OfAThousandRowsIsNotThinned) {
  const InputFiles files;
  files.Write("curve.csv", TestStand(1000, 0.01));
  const ThrustCurve curve =
      MotorOf(files, "{thrust_curve: {reference: vacuum, table: curve.csv}}").thrust_curve;
  EXPECT_EQ(curve.thinned.rows, 0u);
  EXPECT_EQ(curve.time_s.size(), 1000u);
}

// One row more, of an .eng file, and rows of noise alone: no value below 0.
TEST(ThrustCurveFile, OfAnEngFileIsThinnedToo) {
  const InputFiles files;
  std::string text = "A 98 640 0 1500 1600 NOBODY\n";
  for (int i = 1; i <= 1001; ++i)
    text += FormatNumber(0.02 * i) + " " + FormatNumber(i == 1001 ? 0.0 : i % 2 == 0 ? 50e3 : 1.0) + "\n";
  files.Write("curve.eng", text);
  const ThrustCurve curve =
      MotorOf(files, "{thrust_curve: {reference: vacuum, table: curve.eng}}").thrust_curve;
  EXPECT_EQ(curve.thinned.rows, 1002u);
  EXPECT_EQ(curve.time_s.size(), kThrustCurveCorners);
  for (double thrust_n : curve.thrust_n) EXPECT_GE(thrust_n, 0.0);
}

// The format leaves out the point at ignition.
TEST(ThrustCurveFile, ATenthIsEarly) {
  const InputFiles files;
  files.Write("curve.eng",
              "TRIAL-1 98 640 5-10 1486 1600 NOBODY ; less by 0.93 %\n0.26 90000\n0.5 100000 ; peak\n"
              "2 80000\n2.6 0\n");
  EXPECT_EQ(MotorOf(files, "{thrust_curve: {reference: vacuum, table: curve.eng}}").thrust_curve.time_s,
            (std::vector<double>{0.0, 0.26, 0.5, 2.0, 2.6}));
}

TEST(ThrustCurveFile, ChamberPressureOfAnotherTestIsUnusual) {
  const InputFiles files;
  files.Edit(
      "vehicle.yaml", kMotor,
      "{thrust_curve: {reference: vacuum, table: {time_s: [0, 30, 60], thrust_n: [60000, 60000, 40000], "
      "chamber_pressure_bar: [60, 30, 60]}}}");
  const std::string said = files.Texts(CheckFile(files.Path("vehicle.yaml")).warnings);
  EXPECT_NE(said.find("stages[0].motor.thrust_curve.table.chamber_pressure_bar: makes thrust over pressure "
                      "change, in the burn's strong part, by a factor of 3"),
            std::string::npos)
      << said;
}

TEST(ThrustCurveFile, StandsInTheIdOfWhatFlies) {
  const InputFiles files;
  files.Edit("vehicle.yaml", kMotor, "{thrust_curve: {reference: vacuum, table: curve.eng}}");
  files.Write("curve.eng", kEng);
  const std::string id = LoadCampaign(files.Path("campaign.yaml")).flight_id;
  std::string other = kEng;
  const std::size_t at = other.find(" 800");
  ASSERT_NE(at, std::string::npos);
  files.Write("curve.eng", other.replace(at, 4, " 801"));
  EXPECT_NE(LoadCampaign(files.Path("campaign.yaml")).flight_id, id);
}

}  // namespace
}  // namespace dispersa::campaign_yaml_thrust_curve_test
