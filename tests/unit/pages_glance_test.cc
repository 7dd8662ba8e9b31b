// Beside the first table: the ascent, the vehicle, and the requirement with the least margin.
#include <fmt/format.h>

#include "core/pages/report_sections.h"
#include "core/pages/vehicle_drawing.h"
#include "tests/test.h"
#include "tests/unit/made_up_results.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::pages_glance_test {
namespace {

RequirementSummary Judged(const std::string& metric, const std::string& verdict, double limit,
                          std::optional<double> margin) {
  RequirementSummary one;
  one.metric = metric;
  one.verdict = verdict;
  one.limit = limit;
  one.probability = 0.9;
  one.margin = margin;
  if (margin) one.bound = limit - *margin;
  return one;
}

std::string Glance(const std::vector<RequirementSummary>& requirements,
                   const std::vector<MetricDrivers>& drivers = {}) {
  Campaign campaign;
  campaign.vehicle = SampleVehicle();
  CampaignSummary summary;
  summary.requirements = requirements;
  for (const RequirementSummary& one : requirements) {
    summary.standing.requirements.emplace_back();
    summary.standing.requirements.back().verdict = one.verdict;
  }
  summary.drivers = drivers;
  return GlanceSection(campaign, summary, {});
}

TEST(GlanceSection, NamesTheLeastMarginOfTheWorstVerdict) {
  const RequirementSummary near = Judged("pitch_error_peak_deg", "pass", 0.5, 0.1);  // 20 % of the limit
  const RequirementSummary far = Judged("deflection_peak_deg", "pass", 5.0, 2.0);    // 40 %
  const RequirementSummary open = Judged("yaw_error_peak_deg", "inconclusive", 1.0, 0.9);
  const RequirementSummary failed = Judged("roll_error_peak_deg", "fail", 1.0, -0.25);
  EXPECT_THAT(Glance({far, near}), HasSubstr("20 % of the limit"));
  EXPECT_THAT(Glance({near, far}), HasSubstr("#of-pitch_error_peak_deg"));
  EXPECT_THAT(Glance({near, open}), HasSubstr("#of-yaw_error_peak_deg"));
  const std::string html = Glance({open, failed, near});
  EXPECT_THAT(html, HasSubstr("#of-roll_error_peak_deg"));
  EXPECT_THAT(html, HasSubstr("beyond it: 25 % of the limit"));
  EXPECT_THAT(Glance({}), Not(HasSubstr("Least margin")));
}

TEST(GlanceSection, TakesTheWorstFlightWhereThereIsNoBound) {
  RequirementSummary range = Judged("injection_altitude_error_km", "inconclusive", 10.0, {});
  range.low_limit = -10.0;
  range.worst_completed = RequirementSummary::Worst{.case_index = 3, .value = -8.0};
  EXPECT_THAT(Glance({range}),
              HasSubstr("The worst completed flight is 2 km away from it: 20 % of half the range"));
}

TEST(GlanceSection, SaysWhatDrivesIt) {
  MetricDrivers drivers{.metric = "pitch_error_peak_deg", .drivers = {}};
  for (const double share : {0.41, 0.2, 0.1, 0.05}) {
    Driver& driver = drivers.drivers.emplace_back();
    driver.input = fmt::format("input_{}", share);
    driver.index = share;
  }
  const std::string html = Glance({Judged("pitch_error_peak_deg", "pass", 0.5, 0.1)}, {drivers});
  EXPECT_THAT(html, HasSubstr("<code>input_0.41</code> (41 %)"));
  EXPECT_THAT(html, Not(HasSubstr("input_0.05"))) << "three are enough";
}

TEST(GlanceSection, DrawsTheAscentWithItsEvents) {
  Campaign campaign;
  campaign.vehicle = SampleVehicle();
  FlightHistories histories;
  for (int k = 0; k <= 100; ++k) {
    std::vector<double> row(HistoryColumns().size(), 0.0);
    row[0] = k;
    row[static_cast<std::size_t>(FindHistoryColumn("altitude_m"))] = 1000.0 * k;
    row[static_cast<std::size_t>(FindHistoryColumn("latitude_deg"))] =
        campaign.vehicle.site.latitude_rad * 57.29577951308232 + 0.01 * k;
    row[static_cast<std::size_t>(FindHistoryColumn("longitude_deg"))] =
        campaign.vehicle.site.longitude_rad * 57.29577951308232;
    histories.nominal_history.values.insert(histories.nominal_history.values.end(), row.begin(), row.end());
  }
  histories.nominal.events = {
      {.name = "lift_off"}, {.name = "max_q", .time_s = 40.0}, {.name = "impact", .time_s = 300.0}};
  const std::string html = GlanceSection(campaign, {}, histories);
  EXPECT_THAT(html, HasSubstr("downrange, km"));
  EXPECT_THAT(html, HasSubstr("<b>2</b>&nbsp;max q&nbsp;40.0&nbsp;s"));
  EXPECT_THAT(html, Not(HasSubstr("impact"))) << "the history ends before";
}

TEST(VehicleSketch, HasTheBodyWithoutWords) {
  const std::string sketch = VehicleSketch(SampleVehicle());
  EXPECT_THAT(sketch, Not(HasSubstr("<text")));
  EXPECT_THAT(sketch, Not(HasSubstr("<style")));
  EXPECT_THAT(sketch, HasSubstr("class=\"grain\""));
  EXPECT_THAT(sketch, HasSubstr("class=\"hinge\""));
  // Boosters beside the body make the picture higher.
  Vehicle boosted = SampleVehicle();
  boosted.boosters.count = 2;
  boosted.boosters.radius_m = 3.0;
  boosted.boosters.diameter_m = 1.0;
  const auto height = [](const std::string& svg) {
    std::istringstream view(svg.substr(svg.find("viewBox=\"") + 9));
    double left, top, width, high;
    view >> left >> top >> width >> high;
    return high;
  };
  EXPECT_GT(height(VehicleSketch(boosted)), height(sketch) + 100.0);
}

}  // namespace
}  // namespace dispersa::pages_glance_test
