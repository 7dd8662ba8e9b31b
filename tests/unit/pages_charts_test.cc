// The charts of a report: what they draw, and over which range.
#include <fmt/format.h>

#include "core/environment/earth.h"
#include "core/pages/distribution_charts.h"
#include "core/pages/flight_charts.h"
#include "core/pages/vehicle_drawing.h"
#include "tests/test.h"
#include "tests/unit/made_up_results.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::pages_charts_test {
namespace {

using report_test::kPeak;

std::size_t CountOf(const std::string& text, const std::string& what) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
  return count;
}

CaseColumns Values(const std::string& metric, const std::vector<double>& values) {
  CaseColumns cases;
  cases.metrics.resize(MetricCount(kUsualStages));
  for (std::size_t i = 0; i < values.size(); ++i) {
    cases.index.push_back(i);
    cases.outcome.push_back(Outcome::kCompleted);
  }
  cases.metrics[MetricColumn(metric)] = values;
  return cases;
}

RequirementSummary Limited(const std::string& metric, bool below, double limit, std::optional<double> low) {
  RequirementSummary requirement;
  requirement.metric = metric;
  requirement.below = below;
  requirement.limit = limit;
  requirement.low_limit = low;
  requirement.probability = 0.9;
  requirement.consumer_risk = 0.1;
  return requirement;
}

// A range is left on either side, so either side has its chart.
TEST(DistributionFigures, HaveAChartForEachSideThatHasALimit) {
  struct Case {
    std::vector<RequirementSummary> requirements;
    std::size_t beyond, at_most;
  };
  const Case cases[] = {{{}, 1, 0},
                        {{Limited(kPeak, true, 5.0, {})}, 1, 0},
                        {{Limited(kPeak, false, 5.0, {})}, 0, 1},
                        {{Limited(kPeak, true, 9.0, 5.0)}, 1, 1},
                        {{Limited(kPeak, true, 9.0, {}), Limited(kPeak, false, 5.0, {})}, 1, 1}};
  for (const Case& one : cases) {
    CampaignSummary summary;
    summary.requirements = one.requirements;
    const std::string html = DistributionFigures(kPeak, summary, Values(kPeak, {1, 2, 3, 4}));
    EXPECT_EQ(CountOf(html, ">share of cases beyond this<"), one.beyond);
    EXPECT_EQ(CountOf(html, ">share of cases at most this<"), one.at_most);
    EXPECT_EQ(CountOf(html, "A range allows its share on both sides together."),
              one.beyond + one.at_most == 2 ? 2u : 0u);
  }
}

/// The range of the axis of the first chart that says `what`: "low high from to ...".
std::pair<double, double> AxisOf(const std::string& html, const std::string& what, const char* axis) {
  const std::size_t chart = html.rfind("<svg class=\"chart\"", html.find(what));
  const std::string name = std::string(" data-") + axis + "=\"";
  std::istringstream text(html.substr(html.find(name, chart) + name.size(), 60));
  std::pair<double, double> range;
  EXPECT_TRUE(text >> range.first >> range.second) << what;
  return range;
}

TEST(DistributionFigures, DrawALimitOnTheValuesSideOfTheCut) {
  for (const double sign : {1.0, -1.0}) {
    CampaignSummary summary;
    summary.requirements = {Limited("impact_longitude_deg", true, sign * 179.9, {})};
    const std::string html =
        DistributionFigures("impact_longitude_deg", summary,
                            Values("impact_longitude_deg", {sign * 179.98, -sign * 179.98, sign * 179.97}));
    const auto [low, high] = AxisOf(html, "Histogram of", "x");
    EXPECT_LT(high - low, 1.0);
    EXPECT_GE(sign > 0.0 ? low : -high, 179.8);
  }
}

CaseColumns Pairs(const std::map<std::string, std::vector<double>>& metrics) {
  CaseColumns cases;
  for (const auto& [metric, values] : metrics) {
    const CaseColumns one = Values(metric, values);
    if (cases.rows() == 0) cases = one;
    cases.metrics[MetricColumn(metric)] = values;
  }
  return cases;
}

// Charts beside each other in a section; a pair that no flight defines has none.
TEST(ScatterFigures, AreOfOneSizeAndOnlyOfWhatIsDefined) {
  const std::string html = InjectionFigures({}, Pairs({{"apogee_km", {400, 500}},
                                                       {"perigee_km", {300, 310}},
                                                       {"injection_velocity_error_m_s", {1, 2}},
                                                       {"injection_altitude_error_km", {-1, 2}}}));
  EXPECT_EQ(CountOf(html, "<svg class=\"chart\" viewBox=\"0 0 520 300\""), 2u);
  EXPECT_EQ(InjectionFigures({}, {}), "");
}

TEST(ScatterFigures, ShowTargetAndLimits) {
  CampaignSummary summary;
  summary.requirements = {Limited("perigee_km", false, 295.0, {}), Limited("apogee_km", true, 520.0, 380.0)};
  std::vector<double> apogee, perigee;
  for (int k = 0; k < 20; ++k) {
    apogee.push_back(400.0 + 5.0 * k);
    perigee.push_back(300.0 + k % 3);
  }
  const std::string html = InjectionFigures(summary, Pairs({{"apogee_km", apogee}, {"perigee_km", perigee}}));
  EXPECT_EQ(CountOf(html, "<svg class=\"chart\""), 1u);
  EXPECT_EQ(CountOf(html, "class=\"ellipse\" data-s"), 3u);
  EXPECT_EQ(CountOf(html, "class=\"limit\" data-s"), 3u) << "a range has two";
  EXPECT_THAT(html, Not(HasSubstr("dot-target"))) << "no error of it is measured";
  // The nominal flight is on an orbit of 20 km less than the reference's, a circle of 330 km, where it shall
  // be.
  summary.nominal.emplace().outcome = Outcome::kCompleted;
  summary.nominal->metrics.assign(summary.metric_list.size(), 0.0);
  for (const auto& [metric, value] :
       {std::pair{"apogee_km", 320.0}, {"perigee_km", 300.0}, {"semi_major_axis_error_km", -20.0}})
    summary.nominal->metrics[summary.metric_list.PositionOf(metric)] = value;
  summary.reference_orbit.velocity_m_s = std::sqrt(Wgs84().mu_m3_s2 / (Wgs84().equatorial_radius_m + 330e3));
  const std::string aimed =
      InjectionFigures(summary, Pairs({{"apogee_km", {330, 340}}, {"perigee_km", {330, 340}}}));
  EXPECT_THAT(aimed, HasSubstr(">reference</text>"));
  static const std::regex first_dot(
      "class=\"(?:dots|dot-target)\" data-s=\"(?:cases|reference)\" d=\"M([^mh]+)h0");
  std::vector<std::string> places;
  for (std::sregex_iterator at(aimed.begin(), aimed.end(), first_dot), end; at != end; ++at)
    places.push_back((*at)[1]);
  ASSERT_EQ(places.size(), 2u);
  EXPECT_EQ(places[0], places[1]) << "the first case is where it shall be";
  EXPECT_THAT(InjectionFigures({}, Pairs({{"injection_velocity_error_m_s", {1, 2}},
                                          {"injection_altitude_error_km", {-1, 2}}})),
              HasSubstr(">target</text>"));
}

// 1, 2 or 5 times a power of ten, and at most a fifth of the vehicle, which is 1080 px long.
TEST(VehicleDrawing, HasABarOfAFifthOfTheVehicle) {
  for (const auto& [length_m, bar_m] : {std::pair{3.0, 0.5}, {27.0, 5.0}, {60.0, 10.0}, {120.0, 20.0}}) {
    Vehicle vehicle = SampleVehicle();
    vehicle.stages[0].bottom_station_m = length_m;
    const double end_px = 60.0 + 1080.0 * bar_m / length_m;
    EXPECT_THAT(VehicleDrawing(vehicle),
                HasSubstr(fmt::format("<text class=\"soft\" x=\"{:.2f}\"", end_px + 10.0)))
        << length_m;
  }
}

constexpr int kSteps = 100;

/// A flight of 100 s: 40 degrees of incidence at rest, 3 in the air, and no air after 80 s.
History Flown(double pitch_deflection_deg, double yaw_deflection_deg) {
  History history;
  for (int k = 0; k <= kSteps; ++k) {
    std::vector<double> row(HistoryColumns().size(), 0.0);
    const auto set = [&](const char* name, double value) {
      row[static_cast<std::size_t>(FindHistoryColumn(name))] = value;
    };
    set("time_s", k);
    set("stage", 1);
    set("thrust_n", 1000.0);
    set("qbar_pa", k < 5 || k > 80 ? 100.0 : 30000.0);
    set("alpha_deg", k < 5 ? 40.0 : k > 80 ? 25.0 : 3.0);
    set("beta_deg", k == 50 ? -8.0 : 0.0);
    set("deflection_pitch_deg", k == 30 ? pitch_deflection_deg : 0.1);
    set("deflection_yaw_deg", k == 40 ? yaw_deflection_deg : 0.1);
    history.values.insert(history.values.end(), row.begin(), row.end());
  }
  return history;
}

FlightHistories HistoriesOf(const std::vector<History>& flights) {
  FlightHistories histories;
  std::vector<int> columns;
  for (int i = 0; i < std::ssize(BandColumnNames()); ++i) columns.push_back(i);
  histories.nominal_history = flights[0];
  for (std::size_t i = 0; i < flights.size(); ++i) {
    histories.written_cases.push_back(i);
    histories.written_flights.push_back(SampleFlight(flights[i], columns, 1.0));
  }
  histories.bands = ComputeBands(histories.written_flights, columns, 1.0);
  return histories;
}

TEST(EnvelopeFigures, ScaleIncidenceByTheAir) {
  const std::string html = EnvelopeFigures(HistoriesOf({Flown(1.0, 1.0)}), CampaignSummary{}, 10.0);
  const auto [low, high] = AxisOf(html, ">angle of attack, °<", "y");
  EXPECT_LE(high, 5.0);
  EXPECT_GE(low, -5.0);
}

TEST(EnvelopeFigures, DrawTheLimitOfThePeakThatTheyShow) {
  for (const char* metric : {"pitch_error_peak_deg", "yaw_error_peak_deg", "roll_error_peak_deg"}) {
    CampaignSummary summary;
    summary.requirements = {Limited(metric, true, 0.5, {})};
    EXPECT_EQ(CountOf(EnvelopeFigures(HistoriesOf({Flown(1.0, 1.0)}), summary, 10.0), ">limit of the peak<"),
              1u);
  }
}

/// Three burns: 100 s, a coast of 50 s, 100 s, then a coast of 1000 s, 100 s. Outside burns the error is 9.
History WithCoasts() {
  History history;
  for (int k = 0; k <= 1350; ++k) {
    std::vector<double> row(HistoryColumns().size(), 0.0);
    const auto set = [&](const char* name, double value) {
      row[static_cast<std::size_t>(FindHistoryColumn(name))] = value;
    };
    const bool burns = k <= 100 || (k >= 150 && k <= 250) || k >= 1250;
    set("time_s", k);
    set("stage", k < 150 ? 1 : k < 1250 ? 2 : 3);
    set("thrust_n", burns ? 1000.0 : 0.0);
    set("qbar_pa", 30000.0);
    set("pitch_error_deg", burns ? 0.5 : 9.0);
    history.values.insert(history.values.end(), row.begin(), row.end());
  }
  return history;
}

// The dead band of a coast would set the scale, and a long coast the axis.
TEST(EnvelopeFigures, BeginWithPoweredFlight) {
  const std::string html = EnvelopeFigures(HistoriesOf({WithCoasts()}), CampaignSummary{}, 10.0);
  const auto [from_s, to_s] = AxisOf(html, "Pitch error in powered flight", "x");
  EXPECT_EQ(from_s, 0.0);
  EXPECT_EQ(to_s, 250.0);
  EXPECT_LT(AxisOf(html, "Pitch error in powered flight", "y").second, 2.0);
  EXPECT_GE(AxisOf(html, "Pitch error over the whole flight", "y").second, 9.0);
  EXPECT_GE(AxisOf(html, "Pitch error over the whole flight", "x").second, 1350.0);
  EXPECT_EQ(AxisOf(html, "Pitch error while stage 3 burns", "x"), std::pair(1240.0, 1350.0));
  EXPECT_THAT(html, Not(HasSubstr("Pitch error while stage 2 burns")));
}

// As of a sounding rocket, whose first motor burns 3 s, and which then flies on to its apogee.
TEST(EnvelopeFigures, ShowTheBurnAfterAShortCoastAndNoLongCoastAfterIt) {
  History history;
  for (int k = 0; k <= 240; ++k) {
    std::vector<double> row(HistoryColumns().size(), 0.0);
    row[0] = k;
    row[static_cast<std::size_t>(FindHistoryColumn("stage"))] = k < 20 ? 1 : 2;
    row[static_cast<std::size_t>(FindHistoryColumn("thrust_n"))] =
        k <= 3 || (k >= 20 && k <= 26) ? 1000.0 : 0.0;
    history.values.insert(history.values.end(), row.begin(), row.end());
  }
  const std::string html = EnvelopeFigures(HistoriesOf({history}), CampaignSummary{}, 10.0);
  EXPECT_EQ(AxisOf(html, "Axial load", "x").second, 30.0);
}

TEST(EnvelopeFigures, DrawTheOuterPercentilesOfEnoughFlights) {
  FlightHistories histories = HistoriesOf({Flown(1.0, 1.0)});
  for (const auto& [flights, curves] : {std::pair<std::size_t, bool>{370, false}, {371, true}}) {
    histories.bands.flights = flights;
    EXPECT_EQ(CountOf(EnvelopeFigures(histories, {}, 10.0), "0.27 and 99.73 %") > 0, curves);
  }
}

CampaignSummary WorstOf(const std::string& metric, const std::vector<std::uint64_t>& cases) {
  CampaignSummary summary;
  summary.worst_cases.push_back({.metric = metric, .cases = {}});
  for (const std::uint64_t index : cases)
    summary.worst_cases[0].cases.push_back({.case_index = index, .value = 1.0});
  return summary;
}

// The peak's channel is drawn, of each case its own.
TEST(WorstFigures, DrawTheChannelThatHasThePeak) {
  const FlightHistories histories = HistoriesOf({Flown(4.0, -5.0), Flown(-4.0, 3.0), Flown(0.0, 6.0)});
  const std::string both = WorstFigures(histories, WorstOf("deflection_peak_deg", {0, 1}));
  EXPECT_THAT(both, HasSubstr("Worst cases over the envelope: yaw deflection, °."));
  EXPECT_THAT(both, HasSubstr("Worst cases over the envelope: pitch deflection, °."));
  EXPECT_EQ(CountOf(both, "data-case=\"0\""), 1u);
  EXPECT_LT(both.find("data-case=\"1\""), both.find("data-case=\"0\"")) << "pitch comes first";
  const std::string yaw = WorstFigures(histories, WorstOf("deflection_peak_deg", {0, 2}));
  EXPECT_THAT(yaw, Not(HasSubstr("pitch deflection")));
  EXPECT_EQ(CountOf(yaw, "data-case="), 2u);
  EXPECT_EQ(WorstQuantity("deflection_peak_deg", 1, histories), "pitch deflection at 30 s");
  EXPECT_EQ(WorstQuantity("deflection_peak_deg", 2, histories), "yaw deflection at 40 s");
  EXPECT_EQ(WorstQuantity("q_alpha_max_pa_rad", 2, histories), "angle of sideslip at 50 s");
  EXPECT_EQ(WorstQuantity("deflection_peak_deg", 3, histories), "") << "it has no history";
  // Of the incidence in air the sideslip is the larger one, and at rest nothing counts.
  const std::string incidence = WorstFigures(histories, WorstOf("q_alpha_max_pa_rad", {0}));
  EXPECT_THAT(incidence, HasSubstr("angle of sideslip, °"));
  EXPECT_THAT(incidence, Not(HasSubstr("angle of attack, °")));
}

}  // namespace
}  // namespace dispersa::pages_charts_test
