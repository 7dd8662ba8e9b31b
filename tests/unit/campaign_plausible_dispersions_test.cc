// Dispersions that no vehicle and no day has, with the full text.
#include "core/campaign/plausible_dispersions.h"

#include "core/environment/atmosphere.h"
#include "core/flight/flight_inputs.h"
#include "core/math/constants.h"
#include "tests/test.h"
#include "tests/unit/distributions.h"

namespace dispersa::campaign_plausible_dispersions_test {

Dispersion Normal(const char* column, double nominal, double sigma) {
  return made_up::Of(column, made_up::Normal(nominal, sigma), column);
}

std::vector<std::string> Texts(const Campaign& campaign) {
  std::vector<std::string> texts;
  for (const UnusualDispersion& f : UnusualDispersions(campaign))
    texts.push_back(f.key + " " + f.message + " | " + f.allowed);
  return texts;
}

TEST(UnusualDispersions, AreThoseBeyondWhatIsKnown) {
  Campaign campaign;
  campaign.dispersions = {Normal("drag_factor", 1.0, 0.02), Normal("thrust_factor_stage1", 1.0, 0.5),
                          Normal("thrust_factor_stage2", 1.0, 0.5),
                          Normal("gyro_bias_yaw_deg_s", 0.0, 0.02 * kRadPerDeg)};
  EXPECT_THAT(Texts(campaign), ElementsAre("dispersions.thrust draws from -0.5 to 2.5 (thrust_factor_stage1) "
                                           "but for 0.27 % of the cases | 0.8 to 1.2 (1 to 5 % of motors)"));
  campaign.dispersions[3].distribution.sigma = 1.0 * kRadPerDeg;
  campaign.dispersions.erase(campaign.dispersions.begin(), campaign.dispersions.begin() + 3);
  EXPECT_THAT(Texts(campaign),
              ElementsAre("dispersions.gyro_bias.yaw draws from -3 to 3 (gyro_bias_yaw_deg_s) but for 0.27 % "
                          "of the cases | -0.1 to 0.1 (0.0001 to 0.01 deg/s of inertial units)"));
}

TEST(UnusualDispersions, AreThoseOfTheWholeVehicleToo) {
  Campaign campaign;
  campaign.dispersions = {Normal("density_factor", 1.0, 0.15), Normal("inertia_factor", 1.0, 0.15),
                          Normal("loop_delay_s", 0.2, 0.1), Normal("loop_gain_factor", 1.0, 0.3)};
  const auto begins = [](const char* text) { return StartsWith(text); };
  EXPECT_THAT(Texts(campaign), ElementsAre(begins("dispersions.density draws from 0.55 to 1.45"),
                                           begins("dispersions.inertia draws from 0.55"),
                                           begins("dispersions.loop_delay draws from -0.1 to 0.5"),
                                           begins("dispersions.loop_gain draws from 0.1 to 1.9")));
  for (Dispersion& dispersion : campaign.dispersions) dispersion.distribution.sigma /= 10.0;
  EXPECT_THAT(Texts(campaign), IsEmpty());
}

TEST(UnusualDispersions, AreThoseOfOneNozzleAsOfAStage) {
  Campaign campaign;
  campaign.vehicle.stages.resize(1);
  campaign.dispersions = {Normal("nozzle_misalignment_stage1_left_deg", 0.0, 1.0 * kRadPerDeg)};
  EXPECT_THAT(Texts(campaign),
              ElementsAre(HasSubstr("draws from -3 to 3 (nozzle_misalignment_stage1_left_deg) but for 0.27 % "
                                    "of the cases | -1.5 to 1.5 (0.1 to 0.5 deg of solid motors)")));
}

TEST(UnusualDispersions, AreErrorsOfNavigationThatNothingUses) {
  Campaign campaign;
  campaign.dispersions = {Normal("navigation_velocity_error_downrange_m_s", 0.0, 0.1)};
  EXPECT_THAT(Texts(campaign),
              ElementsAre("dispersions.navigation_velocity_error nothing uses it: the flight has no "
                          "closed-loop guidance, and the autopilot has sensors of its own | guidance: {mode: "
                          "closed_loop}, or none of navigation's errors"));
  campaign.guidance.closed_loop = true;
  EXPECT_THAT(Texts(campaign), IsEmpty());
}

TEST(UnusualDispersions, AreTailOffsThatNoStageHas) {
  Campaign campaign;
  campaign.vehicle.stages.resize(2);
  campaign.dispersions = {Normal("tail_off_factor_stage1", 1.0, 0.1),
                          Normal("tail_off_factor_stage2", 1.0, 0.1)};
  EXPECT_THAT(Texts(campaign),
              ElementsAre("dispersions.tail_off nothing uses it: no stage that it draws for has a tail_off_* "
                          "| tail_off_* of the stages' motors, or no tail_off"));
  campaign.vehicle.stages[1].motor.tail_off_s = 0.3;
  EXPECT_THAT(Texts(campaign), IsEmpty());
}

TEST(UnusualDispersions, AreWindsOfAnotherUnit) {
  Campaign campaign;
  campaign.wind_table = WeatherTable{WindTable{{0.0, 20.0}, {0.0, 3000.0}, {0.0, 4000.0}}};
  EXPECT_THAT(Texts(campaign), ElementsAre("dispersions.wind_profile has a wind of 5000 m/s | up to 150 m/s "
                                           "(the strongest jet streams have 100 to 120 m/s)"));
  campaign.wind_table = WeatherTable{WindTable{{0.0, 20.0}, {0.0, 30.0}, {0.0, 40.0}}};
  EXPECT_THAT(Texts(campaign),
              ElementsAre("dispersions.wind_profile ends at 20 m, above which the wind fades within 10000 m "
                          "| 5000 m or more (altitudes may be in kilometres)"));
  campaign.wind_table = WeatherTable{WindTable{{0.0, 20e3}, {0.0, 30.0}, {0.0, 40.0}}};
  EXPECT_THAT(Texts(campaign), IsEmpty());
}

// Each check of winds and of measured air, just inside and just outside.
struct WeatherEdge {
  const char* name;
  void (*set)(Campaign&, double);
  double inside, outside;
  const char* text;
};
void PrintTo(const WeatherEdge& edge, std::ostream* out) { *out << edge.name; }

class WeatherEdges : public testing::TestWithParam<WeatherEdge> {};

TEST_P(WeatherEdges, AreWhereTheChecksSay) {
  Campaign campaign;
  GetParam().set(campaign, GetParam().inside);
  EXPECT_THAT(Texts(campaign), IsEmpty());
  GetParam().set(campaign, GetParam().outside);
  EXPECT_THAT(Texts(campaign), ElementsAre(GetParam().text));
}

constexpr const char* kFast =
    "dispersions.wind_profile has a wind of 150.1 m/s | up to 150 m/s (the strongest jet streams have 100 to "
    "120 m/s)";
constexpr const char* kLow =
    "dispersions.wind_profile ends at 4999 m, above which the wind fades within 10000 m | 5000 m or more "
    "(altitudes may be in kilometres)";

// 3, 4, 5: across and along the meridian together.
void SetSpeed(Campaign& c, double x) {
  c.wind_table = WeatherTable{WindTable{{0.0, 10e3, 20e3}, {0.0, -0.6 * x, 1.0}, {0.0, 0.8 * x, 1.0}}};
}
void SetTop(Campaign& c, double x) {
  c.wind_table = WeatherTable{WindTable{{0.0, x}, {0.0, 1.0}, {0.0, 1.0}}};
}
WindStatistics Levels(double top_m) {
  WindStatistics statistics;
  statistics.altitude_m = {0.0, top_m};
  statistics.mean_north_m_s = statistics.mean_east_m_s = {1.0, 2.0};
  statistics.sigma_north_m_s = statistics.sigma_east_m_s = {1.0, 1.0};
  return statistics;
}
void SetNorthLevel(Campaign& c, double x) {
  c.wind_statistics = Levels(20e3);
  c.wind_statistics->mean_north_m_s[1] = -(x - 30.0);
  c.wind_statistics->sigma_north_m_s[1] = 10.0;
}
void SetEastLevel(Campaign& c, double x) {
  c.wind_statistics = Levels(20e3);
  c.wind_statistics->mean_east_m_s[1] = x - 30.0;
  c.wind_statistics->sigma_east_m_s[1] = 10.0;
}
void SetTopLevel(Campaign& c, double x) { c.wind_statistics = Levels(x); }
// The standard's air at 0, 10 and 70 km, with factors of pressure and density at one of them.
void SetAir(Campaign& c, std::size_t level, double pressure, double density) {
  WeatherTable table{WindTable{{0.0, 10e3, 70e3}, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}};
  for (const double altitude_m : table.altitude_m) {
    const AirState air = StandardAtmosphere1976(altitude_m);
    table.pressure_pa.push_back(air.pressure_pa);
    table.density_kg_m3.push_back(air.density_kg_m3);
    table.temperature_k.push_back(air.temperature_k);
  }
  table.pressure_pa[level] *= pressure;
  table.density_kg_m3[level] *= density;
  c.wind_table = table;
}
void SetPressure(Campaign& c, double x) { SetAir(c, 1, x, 1.0); }
void SetDensity(Campaign& c, double x) { SetAir(c, 1, x, x); }

INSTANTIATE_TEST_SUITE_P(
    Each, WeatherEdges,
    testing::Values(
        WeatherEdge{"Speed", SetSpeed, 149.9, 150.1, kFast}, WeatherEdge{"Top", SetTop, 5000.0, 4999.0, kLow},
        WeatherEdge{"NorthOfALevel", SetNorthLevel, 149.9, 150.1, kFast},
        WeatherEdge{"EastOfALevel", SetEastLevel, 149.9, 150.1, kFast},
        WeatherEdge{"TopLevel", SetTopLevel, 5000.0, 4999.0, kLow},
        WeatherEdge{"GreaterPressure", SetPressure, 1.019, 1.021,
                    "dispersions.wind_profile has at 10000 m a pressure 1.02 times that of its density and "
                    "temperature | within 2 % (the gas law of dry air; vapour makes up to 1.5 %)"},
        WeatherEdge{"LesserPressure", SetPressure, 0.981, 0.979,
                    "dispersions.wind_profile has at 10000 m a pressure 0.979 times that of its density and "
                    "temperature | within 2 % (the gas law of dry air; vapour makes up to 1.5 %)"},
        WeatherEdge{
            "DenserAir", SetDensity, 1.41, 1.43,
            "dispersions.wind_profile has at 10000 m a density of 0.5913 kg/m3 | within a factor of 1.4 of "
            "the standard's, 0.4135 kg/m3 (to 60 km seasons and latitudes change it by up to 40 %)"},
        WeatherEdge{
            "ThinnerAir", SetDensity, 0.71, 0.70,
            "dispersions.wind_profile has at 10000 m a density of 0.2895 kg/m3 | within a factor of 1.4 of "
            "the standard's, 0.4135 kg/m3 (to 60 km seasons and latitudes change it by up to 40 %)"}),
    [](const auto& edge) { return std::string(edge.param.name); });

// Above 60 km the air changes by more than that.
TEST(UnusualDispersions, AreNoneOfThinAir) {
  Campaign campaign;
  SetAir(campaign, 2, 2.0, 2.0);
  EXPECT_THAT(Texts(campaign), IsEmpty());
  SetAir(campaign, 0, 2.0, 2.0);
  EXPECT_EQ(Texts(campaign).size(), 1u);
}

}  // namespace dispersa::campaign_plausible_dispersions_test
