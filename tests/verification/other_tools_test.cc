// Rockets of other tools' published examples, flown here, against the results that those tools print
// (tests/data/other_tools/SOURCE.md).
#include <filesystem>

#include "core/campaign/flight_definition.h"
#include "core/campaign_yaml/load.h"
#include "core/flight/flight.h"
#include "core/flight/history_columns.h"
#include "core/flight/metrics.h"
#include "tests/temporary_folder.h"
#include "tests/test.h"

namespace dispersa::other_tools_test {
namespace {

constexpr char kData[] = DISPERSA_TEST_DATA "/other_tools/";

struct Flown {
  FlightResult result;
  History history;

  double Metric(const std::string& name) const { return result.metrics.at(MetricColumn(name)); }
  double Value(std::size_t row, const char* column) const {
    return history.at(row, FindHistoryColumn(column));
  }
  double Speed(std::size_t row) const {
    return std::hypot(Value(row, "ned_v_n_m_s"), Value(row, "ned_v_e_m_s"), Value(row, "ned_v_d_m_s"));
  }
  std::size_t Fastest() const {
    std::size_t fastest = 0;
    for (std::size_t row = 0; row < history.rows(); ++row)
      if (Speed(row) > Speed(fastest)) fastest = row;
    return fastest;
  }
  std::size_t At(double time_s) const {
    std::size_t row = 0;
    while (Value(row, "time_s") < time_s - 1e-6) ++row;
    return row;
  }
};

Flown Fly(const std::string& campaign) {
  Flown flown;
  flown.history.step_s = 0.002;
  FlightOptions options;
  options.history = &flown.history;
  flown.result = Fly(FlightModel(DefinitionOf(LoadCampaign(campaign))), {}, options);
  EXPECT_EQ(flown.result.outcome, Outcome::kCompleted) << flown.result.reason;
  return flown;
}

void ExpectWithin(double here, double there, double low_percent, double high_percent, const char* what) {
  const double percent = 100.0 * (here / there - 1.0);
  EXPECT_GE(percent, low_percent) << what << " " << here;
  EXPECT_LE(percent, high_percent) << what << " " << here;
}

// Tolerances: twice what is found, or 0.1 %. The thrust's points carry 0.02 % of impulse.
TEST(OtherTools, RocketPysSoundingRocket) {
  constexpr double kSite_m = 668.0;
  const Flown flown = Fly(std::string(kData) + "valetudo_campaign.yaml");
  ExpectWithin(flown.Metric("rail_exit_time_s"), 1.084, -0.15, 0.15, "rail exit, time");
  ExpectWithin(flown.Metric("rail_exit_speed_m_s"), 22.603, -0.1, 0.1, "rail exit, speed");
  const std::size_t fastest = flown.Fastest(), burnout = flown.At(5.274);
  ExpectWithin(flown.Value(fastest, "time_s"), 2.59, -0.4, 0.4, "greatest speed, time");
  ExpectWithin(flown.Speed(fastest), 124.036, -0.15, 0.15, "greatest speed");
  ExpectWithin(flown.Value(fastest, "mach"), 0.368, -0.15, 0.15, "greatest Mach number");
  ExpectWithin(flown.Value(burnout, "altitude_m") - kSite_m, 427.599, -0.2, 0.2, "burnout, altitude");
  ExpectWithin(flown.Speed(burnout), 94.412, -0.45, 0.45, "burnout, speed");
  ExpectWithin(flown.Metric("apogee_time_s"), 13.978, -0.2, 0.2, "apogee, time");
  ExpectWithin(1e3 * flown.Metric("apogee_altitude_km") - kSite_m, 815.260, -0.25, 0.25, "apogee");
}

void ExpectTwoStages(const Flown& flown, double booster_percent, double percent) {
  ExpectWithin(flown.Speed(flown.At(1.535)), 67.433, booster_percent - 0.2, booster_percent + 0.2,
               "first burnout, speed");
  const std::size_t fastest = flown.Fastest();
  ExpectWithin(flown.Speed(fastest), 158.799, percent - 0.15, percent + 0.15, "greatest speed");
  ExpectWithin(flown.Value(fastest, "mach"), 0.468, percent - 0.2, percent + 0.2, "greatest Mach number");
  ExpectWithin(flown.Value(fastest, "time_s"), 2.892, -0.6, 0.6, "greatest speed, time");
}

TEST(OtherTools, OpenRocketsTwoStages) {
  // Its recorded masses.
  const TemporaryFolder folder;
  std::filesystem::copy(kData, folder.path(), std::filesystem::copy_options::recursive);
  std::string vehicle = TextOfFile(folder / "two_stage.yaml");
  for (const auto& [from, to] : {std::pair("propellant_mass_kg: 0.148", "propellant_mass_kg: 0.295"),
                                 {"propellant_left_kg: [0.148, 0]", "propellant_left_kg: [0.295, 0]"},
                                 {"mass_kg: [1.138, 0.990]", "mass_kg: [1.138, 0.843]"},
                                 {"cg_station_m: [1.773, 1.742]", "cg_station_m: [1.773, 1.814]"},
                                 {"[0.0608, 0.054]", "[0.0608, 0.0244]"}}) {
    const std::size_t at = vehicle.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    vehicle.replace(at, std::string(from).size(), to);
  }
  std::ofstream(folder / "two_stage.yaml") << vehicle;
  const Flown recorded = Fly((folder / "two_stage_campaign.yaml").string());
  ExpectTwoStages(recorded, 0.0, 0.0);
  ExpectWithin(1e3 * recorded.Metric("apogee_altitude_km"), 674.979, -0.5, 0.5, "apogee");
  ExpectWithin(recorded.Metric("apogee_time_s"), 11.091, -0.8, 0.8, "apogee, time");
  // It notes the rod's end at the end of a step.
  ExpectWithin(recorded.Speed(recorded.At(0.36)), 20.087, -0.6, 0.6, "rod, speed");

  // The true ones: a booster that is heavier by 0.148 kg when it leaves.
  const Flown right = Fly(std::string(kData) + "two_stage_campaign.yaml");
  ExpectTwoStages(right, -3.09, -0.59);
  ExpectWithin(1e3 * right.Metric("apogee_altitude_km"), 674.979, -0.9, -0.4, "apogee");
}

}  // namespace
}  // namespace dispersa::other_tools_test
