// What a flight can apply of an input: one declaration, and the same answer by every way in which a value
// reaches a flight.
#include "core/flight/input_rules.h"

#include "core/campaign/plausible_dispersions.h"
#include "core/campaign_yaml/load.h"
#include "core/cases/campaign_flights.h"
#include "core/environment/wind.h"
#include "core/flight/flight_inputs.h"
#include "core/input/number_text.h"
#include "core/math/constants.h"
#include "tests/test.h"
#include "tests/unit/input_files.h"

namespace dispersa::flight_input_rules_test {
namespace {

constexpr char kBase[] =
    "schema: dispersa/campaign/1\nname: rules\n"
    "vehicle: " DISPERSA_CAMPAIGNS
    "/vehicles/slv4.yaml\n"
    "reference: " DISPERSA_CAMPAIGNS
    "/references/slv4_500km.yaml\n"
    "autopilot: " DISPERSA_CAMPAIGNS "/autopilots/adaptive_fuzzy.yaml\n";

// The errors of a campaign with these lines behind its files.
std::string Problems(const std::string& rest, const std::string& table = "") {
  const InputFiles files;
  files.Write("rules.yaml", kBase + rest);
  files.Write("rows.csv", table);
  return files.Texts(CheckFile(files.Path("rules.yaml")).errors);
}

Campaign Load(const std::string& rest, const std::string& table = "") {
  const InputFiles files;
  files.Write("rules.yaml", kBase + rest);
  files.Write("rows.csv", table);
  return LoadCampaign(files.Path("rules.yaml"));
}

constexpr char kList[] = "sampling: {method: list, cases: 1, seed: 1, table: rows.csv}\n";

struct Rule {
  const char* column;
  double inside, outside;  ///< in the unit of the column
  const char* allowed;
};

constexpr Rule kRules[] = {
    {"density_factor", 1e-9, 0.0, "a number above 0"},
    {"density_factor", 1.0, -1.0, "a number above 0"},
    {"thrust_factor_stage2", 0.01, -0.01, "a number above 0"},
    {"mass_flow_factor_stage1", 0.01, 0.0, "a number above 0"},
    {"specific_impulse_factor_stage4", 0.5, 0.0, "a number above 0"},
    {"dry_mass_factor_stage1", 0.5, 0.0, "a number above 0"},
    {"propellant_factor_stage2", 1.0, 2.0, "a number above 0 and not above 1.108225"},
    {"drag_factor", 0.1, 0.0, "a number above 0"},
    {"lift_factor_stage3", 0.1, -2.0, "a number above 0"},
    {"inertia_factor", 0.1, -1.0, "a number above 0"},
    {"inertia_factor_stage1", 0.1, 0.0, "a number above 0"},
    {"actuator_bandwidth_factor", 0.1, -1.0, "a number above 0"},
    {"bending_frequency_factor_mode3", 0.1, 0.0, "a number above 0"},
    {"bending_slope_factor", 0.0, -0.1, "a number not below 0"},
    {"nozzle_thrust_factor_stage1_left", 0.0, -0.1, "a number not below 0"},
    {"gyro_noise_deg_s", 0.0, -0.001, "a number not below 0"},
    {"loop_delay_s", 0.0, -0.001, "a number not below 0"},
    {"loop_gain_factor", 0.1, 0.0, "a number above 0"},
    {"separation_delay_stage1_s", 0.0, -100.0, "a number not below -"},
    {"wind_max_speed_m_s", 200.0, 200.5, "a number from 0 to 200"},
    {"wind_altitude_m", 0.0, -1.0, "a number from 0 to 100000"},
    {"wind_width_m", 100.0, 99.0, "a number from 100 to 100000"},
    {"wind_profile_east_1_m_s", -300.0, -9999.0, "a number from -300 to 300"},
    {"gust_speed_m_s", -100.0, -101.0, "a number from -100 to 100"},
    {"gust_length_m", 1.0, 10001.0, "a number from 1 to 10000"},
    {"turbulence_exceedance", 0.2, 0.3, "a number from 0 to 0.2"},
    {"stuck_nozzle", 4.0, 99.0, "a whole number from 0 to 4"},
    {"stuck_nozzle", 1.0, 1.5, "a whole number from 0 to 4"},
    {"stuck_nozzle", 0.0, -1.0, "a whole number from 0 to 4"},
    {"stuck_nozzle_stage", 4.0, 5.0, "a whole number from 0 to 4"},
    {"stuck_nozzle_deg", -89.0, -90.0, "a number above -90 and below 90"},
    {"stuck_nozzle_deg", 89.0, 90.0, "a number above -90 and below 90"},
    {"loop_stage", 4.0, 2.5, "a whole number from 0 to 4"},
    {"payload_element", 1.0, 99.0, "a whole number from 0 to "},
    {"product_of_inertia_xy_stage2_kg_m2", 0.1, -1e6, "a number from -"},
    {"product_of_inertia_xz_stage4_kg_m2", -0.1, 1e6, "a number from -"},
};

// Every rule's value in a table: as many tables as a column has rules.
std::vector<std::vector<const Rule*>> Tables() {
  std::vector<std::vector<const Rule*>> tables;
  for (const Rule& rule : kRules) {
    const auto fits = [&](const std::vector<const Rule*>& table) {
      return std::none_of(table.begin(), table.end(),
                          [&](const Rule* one) { return std::string(one->column) == rule.column; });
    };
    auto table = std::find_if(tables.begin(), tables.end(), fits);
    if (table == tables.end()) table = tables.insert(tables.end(), std::vector<const Rule*>{});
    table->push_back(&rule);
  }
  return tables;
}

TEST(InputRules, HoldForAListAndForAFlight) {
  const Campaign campaign = Load("sampling: {method: monte_carlo, cases: 1, seed: 1}\n");
  for (const auto& table : Tables()) {
    std::string header, inside, outside;
    for (const Rule* rule : table) {
      const char* comma = header.empty() ? "" : ",";
      header += comma + std::string(rule->column);
      inside += comma + FormatNumber(rule->inside);
      outside += comma + FormatNumber(rule->outside);
    }
    EXPECT_EQ(Problems(kList, header + "\n" + inside + "\n"), "");
    const std::string refused = Problems(kList, header + "\n" + outside + "\n");
    for (const Rule* rule : table)
      EXPECT_THAT(refused, HasSubstr(": " + std::string(rule->column) +
                                     "[0]: " + FormatNumber(rule->outside) + " is "));
  }
  for (const Rule& rule : kRules) {
    const int column = FindInput(rule.column);
    ASSERT_GE(column, 0) << rule.column;
    const double unit = InputColumns()[static_cast<std::size_t>(column)].unit;
    EXPECT_TRUE(IsAllowed(campaign.vehicle, column, rule.inside * unit)) << rule.column;
    EXPECT_FALSE(IsAllowed(campaign.vehicle, column, rule.outside * unit)) << rule.column;
    EXPECT_THAT(RangeText(campaign.vehicle, column), HasSubstr(rule.allowed)) << rule.column;
    FlightInputs in;
    InputValue(in, column) = rule.outside * unit;
    const std::string why =
        WhyNotAllowed({campaign.vehicle, campaign.autopilot, campaign.guidance, campaign.course, in});
    EXPECT_EQ(why, "the input " + std::string(rule.column) + " is " + FormatRounded(rule.outside) +
                       "; allowed: " + RangeText(campaign.vehicle, column));
  }
}

// The nominal flight is flown by all of its values.
TEST(InputRules, AllowTheNominalFlight) {
  const Campaign campaign = Load("sampling: {method: monte_carlo, cases: 1, seed: 1}\n");
  const FlightInputs nominal;
  EXPECT_EQ(
      WhyNotAllowed({campaign.vehicle, campaign.autopilot, campaign.guidance, campaign.course, nominal}), "");
  FlightInputs gust;
  gust.air.gust_speed_m_s = 9.0;  // whose length is 0
  EXPECT_EQ(WhyNotAllowed({campaign.vehicle, campaign.autopilot, campaign.guidance, campaign.course, gust}),
            "the input gust_length_m is 0; allowed: a number from 1 to 10000");
}

// Only a flight's own draws show what an expression, or the product of two draws, comes to.
TEST(InputRules, HoldForWhatIsKnownInFlightOnly) {
  const Campaign campaign = Load(
      "sampling: {method: monte_carlo, cases: 2, seed: 1}\n"
      "dispersions:\n  drag_coefficient: {distribution: constant, value_factor: 3}\n"
      "derived:\n  - {input: density_factor, expression: 2 - drag_factor}\n");
  const CaseResult flown = CampaignFlights(campaign).FlyCase(1);
  EXPECT_EQ(flown.outcome, Outcome::kNumericalFailure);
  EXPECT_THAT(flown.reason, HasSubstr("the input density_factor is -1; allowed: a number above 0"));
}

// Without statistics in the campaign: a row says all that its wind needs.
TEST(InputRules, AListedProfileIsFlown) {
  const std::string header =
      "wind_profile_altitude_1_m,wind_profile_altitude_2_m,wind_profile_north_1_m_s,wind_profile_north_2_m_s,"
      "wind_profile_east_1_m_s,wind_profile_east_2_m_s\n";
  const CampaignFlights flights(Load(kList, header + "0,10000,2,4,-30,-10\n"));
  const Wind wind = flights.model().PlantFor(flights.Draw(0)).environment.wind;
  const WindNorthEast at = Evaluate(wind, 5000.0);
  EXPECT_EQ(at.north_m_s, 3.0);
  EXPECT_EQ(at.east_m_s, -20.0);
  const CampaignFlights falling(Load(kList, header + "500,400,2,4,-30,-10\n"));
  EXPECT_THAT(falling.FlyCase(0).reason, HasSubstr("the altitudes of the wind profile do not grow"));
}

// A list says the same of its columns, also of one that has a meaning only beside another.
TEST(InputReaders, AreNamedForTheColumnsOfAList) {
  const auto messages = [](const std::string& table) {
    std::vector<std::string> found;
    for (const UnusualDispersion& one : UnusualDispersions(Load(kList, table)))
      found.push_back(one.key + ": " + one.message);
    return found;
  };
  EXPECT_THAT(messages("density_factor,fin_cant_stage1_deg\n1.1,0.1\n"),
              testing::ElementsAre("sampling.table.fin_cant_stage1_deg: nothing uses it: no stage that it "
                                   "draws for has fins"));
  EXPECT_THAT(messages("wind_azimuth_deg\n90\n"),
              testing::ElementsAre("sampling.table.wind_azimuth_deg: nothing uses it: the jet stream's speed "
                                   "is 0"));
  EXPECT_THAT(messages("wind_azimuth_deg,wind_max_speed_m_s\n90,20\n"), testing::IsEmpty());
  EXPECT_THAT(messages("thrust_misalignment_clock_stage1_deg,thrust_misalignment_stage2_deg\n90,0.1\n"),
              testing::ElementsAre("sampling.table.thrust_misalignment_clock_stage1_deg: nothing uses it: it "
                                   "is a direction, and nothing draws its magnitude"));
}

// Falcon 9: three burns, nine nozzles and one. Soyuz: two stages with a cross, four boosters.
TEST(InputsOfAVehicle, AreThoseOfItsParts) {
  const struct {
    const char* launcher;
    const char* column;
    bool is_had;
  } rows[] = {
      {"falcon9", "thrust_factor_stage3", true},
      {"falcon9", "thrust_factor_stage4", false},
      {"falcon9", "nozzle_thrust_factor_stage1_top", true},
      {"falcon9", "nozzle_thrust_factor_stage2_right", true},
      {"falcon9", "nozzle_thrust_factor_stage2_left", false},
      {"falcon9", "nozzle_thrust_factor_stage4_right", false},
      {"falcon9", "nozzle_offset_y_nozzle9_m", true},
      {"falcon9", "nozzle_offset_y_nozzle10_m", false},
      {"falcon9", "booster_dry_mass_factor_nozzle9", false},
      {"falcon9", "bending_frequency_factor_mode5", true},
      {"falcon9", "wind_profile_north_30_m_s", true},
      {"falcon9", "payload_mass_kg", true},
      {"soyuz", "thrust_factor_stage2", true},
      {"soyuz", "thrust_factor_stage3", false},
      {"soyuz", "nozzle_thrust_factor_stage2_top", true},
      {"soyuz", "nozzle_thrust_factor_nozzle5", true},
      {"soyuz", "booster_propellant_factor_nozzle5", true},
      {"soyuz", "booster_propellant_factor_nozzle8", true},
      {"soyuz", "booster_propellant_factor_nozzle9", false},
      {"soyuz", "nozzle_thrust_factor_nozzle9", false},
  };
  for (const auto& row : rows) {
    const Vehicle vehicle =
        LoadVehicle(std::string(DISPERSA_CAMPAIGNS "/gallery/") + row.launcher + "/vehicle.yaml");
    const std::vector<std::string> names = InputNamesOf(vehicle);
    ASSERT_GE(FindInput(row.column), 0) << row.column;
    EXPECT_EQ(HasInput(vehicle, FindInput(row.column)), row.is_had) << row.launcher << " " << row.column;
    EXPECT_EQ(std::count(names.begin(), names.end(), row.column), row.is_had) << row.column;
  }
}

// Neither an expression nor a list sets what no part of the vehicle carries.
TEST(InputsOfAVehicle, AreAllThatACampaignMaySet) {
  EXPECT_THAT(
      Problems("sampling: {method: monte_carlo, cases: 1, seed: 1}\n"
               "derived:\n  - {input: thrust_factor_stage5, expression: '1.1'}\n"),
      HasSubstr("derived[0].input: 'thrust_factor_stage5' is not an input of this vehicle's flights"));
  EXPECT_THAT(Problems(kList, "density_factor,thrust_factor_stage5\n1,1.1\n"),
              HasSubstr("thrust_factor_stage5: 'thrust_factor_stage5' is not an input of this vehicle"));
}

}  // namespace
}  // namespace dispersa::flight_input_rules_test
