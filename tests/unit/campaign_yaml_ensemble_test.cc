// A folder of soundings in a campaign: what it becomes, and what a case draws of it.
#include "core/analysis/drivers.h"
#include "core/campaign/case_design.h"
#include "core/campaign/flight_definition.h"
#include "core/campaign_yaml/load.h"
#include "core/campaign_yaml/parse_sounding.h"
#include "core/flight/flight.h"
#include "tests/test.h"
#include "tests/unit/input_files.h"

namespace dispersa::campaign_yaml_ensemble_test {

constexpr char kData[] = DISPERSA_TEST_DATA "/soundings/";

// Two soundings of January, in one file of an archive, and two of July: by its text, and by a file's name.
class Ensemble : public InputFiles {
 public:
  explicit Ensemble(const std::string& draw) {
    Edit("campaign.yaml", "  wind: {max_speed_m_s: 60.96, azimuth: uniform, altitude_km: 12}",
         "  weather: {ensemble: soundings, draw: " + draw + "}");
    std::string igra = TextOfFile(std::string(kData) + "igra.txt"), next = igra;
    next.replace(next.find("01 15 12"), 8, "01 16 00");
    Write("soundings/b_igra.txt", igra + next);
    Write("soundings/a_wyoming.txt",
          Edited(std::string(kData) + "wyoming.txt", {{"12Z 15 Jan 2020", "00Z 3 Jul 2019"}}));
    Write("soundings/c_20210704_12.csv", "altitude_m,direction_deg,speed_kt\n0,350,10\n30000,90,20\n");
  }
  Campaign Load() const { return LoadCampaign(Path("campaign.yaml")); }
};

TEST(Ensemble, IsTheSoundingsInTheOrderOfTheirFiles) {
  const Ensemble files("uniform");
  const Campaign campaign = files.Load();
  std::string names;
  for (const DatedWeather& one : campaign.soundings) names += one.file + " " + one.time + "\n";
  EXPECT_EQ(names,
            "a_wyoming.txt 2019-07-03T00\nb_igra.txt 2020-01-15T12\nb_igra.txt 2020-01-16T00\n"
            "c_20210704_12.csv 2021-07-04T12\n");
  EXPECT_TRUE(campaign.soundings[1].table.has_air());
  EXPECT_FALSE(campaign.soundings[3].table.has_air());
  // The campaign's text holds them all.
  const Campaign again = ParseCampaign(campaign.canonical_yaml, "again");
  EXPECT_EQ(again.id, campaign.id);
  EXPECT_EQ(again.flight_id, campaign.flight_id);
  EXPECT_EQ(again.soundings[2].table.east_m_s, campaign.soundings[2].table.east_m_s);
  files.Write("soundings/c_20210704_12.csv", "altitude_m,direction_deg,speed_kt\n0,350,10\n30000,90,21\n");
  EXPECT_NE(files.Load().flight_id, campaign.flight_id);
}

// How often each sounding is drawn, of `cases`.
std::vector<int> Counts(const Campaign& campaign) {
  std::vector<int> counts(campaign.soundings.size() + 1);
  const CaseDesign design(campaign);
  for (std::uint64_t i = 0; i < campaign.sampling.cases; ++i)
    ++counts.at(static_cast<std::size_t>(design.Draw(i).air.weather_sounding));
  return counts;
}

TEST(Ensemble, IsDrawnByEveryMethod) {
  for (const auto& [draw, expected] : {std::pair("uniform", std::vector<int>{0, 300, 300, 300, 300}),
                                       {"by_month", {0, 300, 300, 300, 300}}}) {
    for (const char* method : {"monte_carlo", "latin_hypercube", "sobol"}) {
      const Ensemble files(draw);
      files.Edit("campaign.yaml", "method: monte_carlo, cases: 100",
                 std::string("method: ") + method + ", cases: 1200");
      const std::vector<int> counts = Counts(files.Load());
      for (std::size_t i = 0; i < counts.size(); ++i)
        EXPECT_NEAR(counts[i], expected[i], method == std::string("monte_carlo") ? 60 : 3)
            << draw << method << i;
    }
  }
  // Three of one month and one of another.
  const Ensemble files("by_month");
  files.Edit("soundings/a_wyoming.txt", "00Z 3 Jul 2019", "00Z 3 Jan 2019");
  files.Edit("campaign.yaml", "method: monte_carlo, cases: 100", "method: sobol, cases: 1200");
  const std::vector<int> counts = Counts(files.Load());
  for (const std::size_t january : {1u, 2u, 3u}) EXPECT_NEAR(counts[january], 200, 3);
  EXPECT_NEAR(counts[4], 600, 3);
  // A list names them, and the mean.
  files.Edit("campaign.yaml", "method: sobol, cases: 1200", "method: list, cases: 4");
  files.Edit("campaign.yaml", "seed: 20260101", "seed: 20260101, table: {weather_sounding: [4, 0, 4, 2]}");
  EXPECT_EQ(Counts(files.Load()), (std::vector<int>{1, 0, 1, 0, 2}));
}

TEST(Ensemble, AFlightMeetsTheWindAndTheAirOfItsNumber) {
  const Ensemble files("uniform");
  const Campaign campaign = files.Load();
  const FlightDefinition definition = DefinitionOf(campaign);
  const FlightModel model(definition);
  FlightInputs in;
  const LauncherPlant mean = model.PlantFor(in);
  ASSERT_EQ(mean.environment.wind.tables.size(), 1u);
  EXPECT_EQ(mean.environment.wind.tables[0].east_m_s, MeanWeather(campaign.soundings).east_m_s);
  for (std::size_t k = 0; k < campaign.soundings.size(); ++k) {
    in.air.weather_sounding = static_cast<double>(k + 1);
    const LauncherPlant plant = model.PlantFor(in);
    ASSERT_EQ(plant.environment.wind.tables.size(), 1u);
    EXPECT_EQ(plant.environment.wind.tables[0].north_m_s, campaign.soundings[k].table.north_m_s) << k;
    EXPECT_EQ(plant.environment.air != nullptr, campaign.soundings[k].table.has_air()) << k;
  }
  in.air.weather_sounding = 5.0;
  EXPECT_EQ(Fly(model, in).reason, "the campaign has no sounding 5");
}

TEST(TimeInName, OfManyForms) {
  EXPECT_EQ(TimeInName("20110522_OUN_12Z.txt"), "2011-05-22");
  EXPECT_EQ(TimeInName("oun_2011-05-22T12.csv"), "2011-05-22T12");
  EXPECT_EQ(TimeInName("2011052212.csv"), "2011-05-22T12");
  EXPECT_EQ(TimeInName("2010-12-09 11:06:00"), "2010-12-09T11");
  EXPECT_EQ(TimeInName("2011052299.csv"), "2011-05-22");
  EXPECT_EQ(TimeInName("x12345678_2011_05_22.csv"), "2011-05-22");
  EXPECT_EQ(TimeInName("20111322.csv"), "");
  EXPECT_EQ(TimeInName("may4.txt"), "");
}

}  // namespace dispersa::campaign_yaml_ensemble_test
