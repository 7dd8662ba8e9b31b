#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>

#include "core/pages/chart_scale.h"
#include "core/pages/html_parts.h"
#include "core/results/metric_catalogue.h"
#include "core/results/text.h"
#include "services/web/pages.h"
#include "services/web/web_parts.h"

namespace dispersa {
namespace {

constexpr std::size_t kMostPoints = 60;
/// On the page of all requirements.
constexpr std::size_t kMostInAll = 20, kMostCharts = 30;
constexpr char kLetters[] =
    "<p class=\"soft\">The letter is the verdict’s first: P pass, F fail, I inconclusive, N not evidence, S "
    "study. The version is the label <code>commit</code>.</p>\n";

struct Point {
  const CampaignRow* row;
  const RequirementOutcome* outcome;
};

/// The label by which a reader knows the version, or the first digits of the id.
std::string VersionOf(const CampaignRow& row) {
  for (auto label = row.labels.rbegin(); label != row.labels.rend(); ++label) {
    if (label->starts_with("commit=")) return label->substr(7, 10);
  }
  return row.id.substr(0, 8);
}

/// So that a verdict is read without colours.
std::string LetterOf(const std::string& verdict) {
  std::string letter = verdict.substr(0, 1);
  for (char& each : letter) each = static_cast<char>(std::toupper(static_cast<unsigned char>(each)));
  return letter;
}

/// Of the rows that have judged the metric, the newest first; `all` counts those left out too.
std::vector<Point> PointsOf(const std::vector<const CampaignRow*>& rows, const std::string& metric,
                            std::size_t most, std::size_t& all) {
  std::vector<Point> points;
  for (const CampaignRow* row : rows) {
    if (!row->has_ended) continue;
    const auto one = std::find_if(row->requirements.begin(), row->requirements.end(),
                                  [&](const RequirementOutcome& each) { return each.metric == metric; });
    if (one != row->requirements.end() && ++all <= most) points.push_back({row, &*one});
  }
  return points;
}

/// Of a campaign in a chart: NaN without a value.
struct Mark {
  double value = std::nan("");
  std::optional<double> low, high;  ///< what is sure of it
  std::vector<double> limits;
};

struct Trend {
  const char* title;
  const char* words;
  ChartAxis axis;
  std::string unit;
  ChartRange range = {};
  std::vector<Mark> marks = {};

  void Add(const Mark& mark) {
    marks.push_back(mark);
    range.Add(mark.limits, false);
    for (const double value : {mark.value, mark.low.value_or(mark.value), mark.high.value_or(mark.value)})
      range.Add(value, false);
  }
};

/// The share of flights that meet the requirement.
Trend TrendOfShares(const std::vector<Point>& points) {
  Trend trend{
      "Share of flights that meet the requirement",
      "Share of flights that meet the requirement, with its confidence bounds, by campaign in the order "
      "of launching. The dashed line is the share that is required.",
      {.label = "", .high = 1.0, .percent = true},
      ""};
  for (const auto& [row, one] : points) {
    const double met =
        one->n == 0 ? 0.0 : 1.0 - static_cast<double>(one->failures) / static_cast<double>(one->n);
    trend.Add({met, one->success_lower, one->success_upper, {one->probability}});
  }
  return trend;
}

/// The metric's bound; no marks if no campaign has one.
Trend TrendOfBounds(const std::vector<Point>& points) {
  const std::string unit = DescribeMetric(points.front().outcome->metric).unit;
  Trend trend{
      "Bound against limit",
      "The bound that the required share of flights keeps, in the metric’s unit, by campaign in the "
      "order of launching. The dashed line is the limit. A letter on the lower edge has no bound: the "
      "cases were too few, or too many flights were lost.",
      {.label = ""},
      unit.empty() ? "" : " " + unit};
  bool has_bound = false;
  for (const auto& [row, one] : points) {
    has_bound |= one->bound.has_value();
    trend.Add({one->bound.value_or(std::nan("")), {}, {}, one->limits});
  }
  if (!has_bound) trend.marks.clear();
  return trend;
}

std::string TrendChart(const std::vector<Point>& points, const Trend& trend) {
  constexpr double kLeft = 92.0, kRight = 990.0, kTop = 14.0, kBottom = 230.0, kHeight = 320.0;
  const ChartScale scale(trend.axis, trend.range.low, trend.range.high, kBottom, kTop, 4);
  const auto y = [&](double value) { return scale.At(value); };
  const double step = (kRight - kLeft) / static_cast<double>(points.size());
  std::string svg = fmt::format(
      "<svg class=\"chart trend\" viewBox=\"0 0 1000 {:.0f}\" role=\"group\" aria-label=\"{}, by "
      "campaign\">\n",
      kHeight, trend.title);
  for (const Tick& tick : scale.ticks())
    svg += fmt::format(
        "<path class=\"grid\" d=\"M{} {:.1f}H{}\"/><text class=\"tick\" text-anchor=\"end\" x=\"{}\" "
        "y=\"{:.1f}\">{}{}</text>\n",
        kLeft, y(tick.value), kRight, kLeft - 6.0, y(tick.value) + 4.0, tick.label, HtmlText(trend.unit));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point& point = points[i];
    const RequirementOutcome& one = *point.outcome;
    const Mark& mark = trend.marks[i];
    const double x = kLeft + step * (static_cast<double>(i) + 0.5), half = std::min(14.0, 0.45 * step);
    for (const double limit : mark.limits)
      svg += fmt::format("<path class=\"limit\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>", x - half, y(limit), x + half);
    svg += fmt::format("<a href=\"{}\"><title>{}: {} of {} fail, {}</title>", LinkTo(*point.row),
                       HtmlText(VersionOf(*point.row)), one.failures, one.n, HtmlText(one.verdict));
    if (mark.low && mark.high)
      svg +=
          fmt::format("<path class=\"range\" d=\"M{:.1f} {:.1f}V{:.1f}\"/>", x, y(*mark.low), y(*mark.high));
    const double at = std::isfinite(mark.value) ? y(mark.value) : kBottom;
    svg += fmt::format(
        "<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"8\"/><text class=\"letter\" "
        "text-anchor=\"middle\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text></a>",
        HtmlText(one.verdict), x, at, x, at + 4.0, LetterOf(one.verdict));
    if (points.size() <= 30 || i % 2 == 0)
      svg += fmt::format(
          "<text class=\"tick\" text-anchor=\"end\" transform=\"translate({:.1f} {:.1f}) "
          "rotate(-50)\">{}</text>\n",
          x + 4.0, kBottom + 14.0, HtmlText(VersionOf(*point.row)));
  }
  return svg + "</svg>\n";
}

/// The bound's, if there is one, and the share's.
std::vector<Trend> TrendsOf(const std::vector<Point>& points) {
  std::vector<Trend> trends = {TrendOfBounds(points), TrendOfShares(points)};
  std::erase_if(trends, [](const Trend& trend) { return trend.marks.empty(); });
  return trends;
}

std::string TrendFigure(const std::vector<Point>& points, const Trend& trend) {
  return fmt::format("<figure class=\"wide\">{}<figcaption>{}</figcaption></figure>\n",
                     TrendChart(points, trend), trend.words);
}

std::string Metrics(const CampaignIndex& index) {
  std::map<std::string, std::size_t> counts;
  for (const CampaignIndex::Row& row : index.rows())
    if (row->has_ended)
      for (const RequirementOutcome& one : row->requirements) ++counts[one.metric];
  if (counts.empty()) return "<p>No campaign has judged a requirement.</p>\n";
  std::string html;
  std::size_t drawn = 0;
  const std::vector<const CampaignRow*> rows = index.Search("");
  for (const auto& [metric, count] : counts) {
    html +=
        fmt::format("<h2><a href=\"/trend?metric={}\">{}</a></h2>\n<p class=\"soft\">{} campaign{}{}</p>\n",
                    UrlText(metric), HtmlText(metric), count, count == 1 ? "" : "s",
                    count > kMostInAll ? fmt::format(", the last {} are shown", kMostInAll) : "");
    if (++drawn > kMostCharts) continue;
    std::size_t all = 0;
    std::vector<Point> points = PointsOf(rows, metric, kMostInAll, all);
    std::reverse(points.begin(), points.end());
    html += TrendFigure(points, TrendsOf(points).front());
  }
  return html + kLetters;
}

}  // namespace

std::string TrendPage(const CampaignIndex& index, const std::string& metric, const std::string& search) {
  if (metric.empty())
    return Frame("Trends",
                 "<h1>Trends</h1>\n<p>Each requirement over the campaigns that have judged it. A metric’s "
                 "page has all of its campaigns, and their numbers.</p>\n" +
                     Metrics(index));
  std::size_t all = 0;
  const std::vector<Point> points = PointsOf(index.Search(search), metric, kMostPoints, all);
  std::string main = fmt::format(
      "<h1>Trend of {}</h1>\n<form class=\"filter\" action=\"/trend\"><input type=\"hidden\" name=\"metric\" "
      "value=\"{}\"><input type=\"search\" name=\"q\" value=\"{}\" placeholder=\"only campaigns with …, as "
      "branch=main\" aria-label=\"Only campaigns with\"><button>Show</button> <a href=\"/trend\">Other "
      "metrics</a></form>\n",
      HtmlText(metric), HtmlText(metric), HtmlText(search));
  if (points.empty()) return Frame("Trend", main + "<p>No campaign that has ended requires it.</p>\n");
  HtmlTable table("Version|Campaign|Verdict|#Failures|Flights that meet it|Requirement|");
  for (std::size_t i = 0; i < points.size(); ++i) {
    const RequirementOutcome& one = *points[i].outcome;
    table.Row({Code(VersionOf(*points[i].row)), NameOf(*points[i].row), VerdictBadge(HtmlText(one.verdict)),
               fmt::format("{} of {}", one.failures, one.n),
               one.success_lower && one.success_upper
                   ? PercentText(*one.success_lower) + " to " + PercentText(*one.success_upper)
                   : "",
               HtmlText(one.words),
               i + 1 < points.size()
                   ? fmt::format("<a href=\"/difference?id={}&amp;id={}\">to the one before</a>",
                                 points[i + 1].row->id, points[i].row->id)
                   : ""});
  }
  const std::vector<Point> by_age(points.rbegin(), points.rend());
  for (const Trend& trend : TrendsOf(by_age)) main += TrendFigure(by_age, trend);
  main += kLetters;
  if (all > points.size()) main += fmt::format("<p>The last {} of {} campaigns.</p>\n", points.size(), all);
  return Frame("Trend", main + table.Html());
}

}  // namespace dispersa
