// Beside the first table: what flies, how it flies, and what is nearest to its limit.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/environment/ground_track.h"
#include "core/math/constants.h"
#include "core/pages/distribution_charts.h"
#include "core/pages/html_parts.h"
#include "core/pages/report_sections.h"
#include "core/pages/svg_chart.h"
#include "core/pages/vehicle_drawing.h"
#include "core/results/metric_catalogue.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

/// The row of the nominal flight that shows it right after a time.
std::size_t RowAt(const std::vector<double>& time_s, double at_s) {
  const auto after = std::upper_bound(time_s.begin(), time_s.end(), at_s + 1e-6);
  return after == time_s.begin() ? 0 : static_cast<std::size_t>(after - time_s.begin()) - 1;
}

std::string AscentFigure(const Campaign& campaign, const FlightHistories& histories) {
  const History& nominal = histories.nominal_history;
  if (nominal.rows() == 0) return "";
  const int latitude = FindHistoryColumn("latitude_deg"), longitude = FindHistoryColumn("longitude_deg"),
            altitude = FindHistoryColumn("altitude_m");
  const LaunchSite& site = campaign.vehicle.site;
  const Geodetic from = {site.latitude_rad, site.longitude_rad, site.altitude_m};
  std::vector<double> time_s, along_km, altitude_km;
  for (std::size_t row = 0; row < nominal.rows(); ++row) {
    const Geodetic place = {nominal.at(row, latitude) / kDegPerRad, nominal.at(row, longitude) / kDegPerRad,
                            0.0};
    time_s.push_back(nominal.at(row, 0));
    along_km.push_back(1e-3 * TrackOf(from, campaign.reference.program.launch_azimuth_rad, place).along_m);
    altitude_km.push_back(1e-3 * nominal.at(row, altitude));
  }
  const auto [least_km, most_km] = std::minmax_element(along_km.begin(), along_km.end());
  // A step back from the pad, as by wind, would take a part of the axis.
  if (*least_km > -0.02 * *most_km)
    for (double& along : along_km) along = std::max(along, 0.0);
  SvgChart chart({.label = "downrange, km", .low = std::min(0.0, *least_km)}, {.label = "altitude, km"}, 640,
                 250);
  std::vector<double> x, y;
  std::string listed;
  for (const SeenEvent& event : histories.nominal.events) {
    if (event.time_s > time_s.back() + nominal.step_s) continue;  // it falls as a point
    const std::size_t row = RowAt(time_s, event.time_s);
    x.push_back(along_km[row]);
    y.push_back(altitude_km[row]);
    chart.Mark(x.back(), std::to_string(x.size()));
    listed += fmt::format("{}<b>{}</b>&nbsp;{}&nbsp;{}&nbsp;s", listed.empty() ? "" : " · ", x.size(),
                          EventWords(event.name, campaign.vehicle), FixedText(event.time_s, 1));
  }
  chart.Line(along_km, altitude_km, "line-0", "");
  chart.Points(x, y, "dots", "");
  const std::string caption = "The nominal ascent along the launch azimuth.";
  return Figure(chart.Svg(caption), caption + (listed.empty() ? "" : " " + listed));
}

struct Nearest {
  const RequirementSummary* of = nullptr;
  std::string verdict;    ///< that stands
  double distance = 0.0;  ///< from the bound to the limit; without a bound from the worst flight
  double scale = 0.0;     ///< the limit, or half of a range
  double share = 0.0;     ///< of the scale
};

/// The failed first, then those that are not shown to be met, then by the share of the limit that is left.
Nearest LeastMargin(const CampaignSummary& summary) {
  const auto rank = [](const std::string& verdict) {
    return verdict == "fail" ? 0 : verdict == "pass" ? 2 : 1;
  };
  Nearest least;
  for (std::size_t i = 0; i < summary.requirements.size(); ++i) {
    const RequirementSummary& one = summary.requirements[i];
    const std::string& verdict = summary.standing.requirements[i].verdict;
    double distance = 0.0;
    if (one.margin) {
      distance = *one.margin;
    } else if (one.worst_completed) {
      const double value = one.worst_completed->value;
      const double above = one.low_limit.value_or(one.below ? -HUGE_VAL : one.limit);
      const double below = one.low_limit || one.below ? one.limit : HUGE_VAL;
      distance = std::min(below - value, value - above);
    } else {
      continue;
    }
    const double scale = one.low_limit ? 0.5 * (one.limit - *one.low_limit) : std::fabs(one.limit);
    const double share = scale > 0.0 ? distance / scale : distance;
    if (least.of != nullptr && std::pair(rank(least.verdict), least.share) <= std::pair(rank(verdict), share))
      continue;
    least = {&one, verdict, distance, scale, share};
  }
  return least;
}

std::string WholePercent(double share) {
  return share < 0.01 ? "less than 1 %" : fmt::format("{:.0f} %", 100.0 * share);
}

std::string DriverWords(const CampaignSummary& summary, const std::string& metric) {
  constexpr std::size_t kMost = 3;
  constexpr double kLeast = 0.05;
  for (const MetricDrivers& of : summary.drivers) {
    if (of.metric != metric || of.drivers.empty()) continue;
    std::string words;
    for (std::size_t i = 0; i < std::min(kMost, of.drivers.size()); ++i) {
      if (i > 0 && of.drivers[i].index < kLeast) break;
      words += fmt::format("{}{} ({})", i == 0 ? "" : ", ", Code(of.drivers[i].input),
                           WholePercent(of.drivers[i].index));
    }
    return "Its scatter comes from " + words + ". A share is of the variance.";
  }
  return "No input is shown to drive its scatter.";
}

std::string LeastMarginText(const CampaignSummary& summary) {
  const Nearest least = LeastMargin(summary);
  if (least.of == nullptr)
    return summary.requirements.empty() ? ""
                                        : "<p><b class=\"title\">Least margin</b></p>\n<p>No completed "
                                          "flight has a value of a requirement’s metric.</p>\n";
  const RequirementSummary& one = *least.of;
  const MetricInfo info = DescribeMetric(one.metric);
  const std::string from = one.margin ? "The bound" : "The worst completed flight";
  // As the table rounds a margin.
  std::string distance = RoundedText(least.distance, Rounding::kDown, 0.0);
  const bool is_beyond = distance.starts_with('-');
  distance.erase(0, is_beyond ? 1 : 0);
  const std::string share = least.scale > 0.0
                                ? fmt::format(": {} of {}", WholePercent(std::fabs(least.share)),
                                              one.low_limit ? "half the range" : "the limit")
                                : "";
  return fmt::format(
      "<p><b class=\"title\">Least margin</b></p>\n<p>{} <a href=\"#{}\">{}</a> {}. {} is {}{}{} {}{}. {} <a "
      "href=\"#causes\">Causes</a></p>\n",
      VerdictBadge(least.verdict), DistributionId(one.metric), HtmlText(info.title),
      HtmlText(LimitWords(one, info.unit)), from, distance, info.unit.empty() ? "" : " ", HtmlText(info.unit),
      is_beyond ? "beyond it" : "away from it", share, DriverWords(summary, one.metric));
}

}  // namespace

std::string GlanceSection(const Campaign& campaign, const CampaignSummary& summary,
                          const FlightHistories& histories) {
  const std::string vehicle = fmt::format("{}, {} m long. Red: centre of gravity, full; white: burnt out.",
                                          HtmlText(campaign.vehicle.name),
                                          ReadableText(campaign.vehicle.stages.front().bottom_station_m));
  return "<section class=\"glance\">\n" + AscentFigure(campaign, histories) + "<div>" +
         Figure(VehicleSketch(campaign.vehicle), vehicle) + LeastMarginText(summary) + "</div>\n</section>\n";
}

}  // namespace dispersa
