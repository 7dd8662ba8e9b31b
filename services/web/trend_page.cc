#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>

#include "core/pages/html_parts.h"
#include "core/results/text.h"
#include "services/web/pages.h"
#include "services/web/web_parts.h"

namespace dispersa {
namespace {

constexpr std::size_t kMostPoints = 60;
/// On the page of all requirements.
constexpr std::size_t kMostInAll = 20, kMostCharts = 30;
constexpr char kChartWords[] =
    "Share of flights that meet the requirement, with its confidence bounds, by campaign in the order of "
    "launching. The dashed line is the share that is required. The letter is the verdict’s first: P pass, "
    "F fail, I inconclusive, N not evidence, S study. The version is the label <code>commit</code>.";

struct Point {
  const CampaignRow* row;
  const RequirementOutcome* outcome;
  double met() const {
    return outcome->n == 0 ? 0.0
                           : 1.0 - static_cast<double>(outcome->failures) / static_cast<double>(outcome->n);
  }
  double low() const {
    return std::min({outcome->success_lower.value_or(met()), met(), outcome->probability});
  }
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

std::string TrendChart(const std::vector<Point>& points) {
  constexpr double kLeft = 62.0, kRight = 990.0, kTop = 14.0, kBottom = 230.0, kHeight = 320.0;
  double least = 1.0;
  for (const Point& point : points) least = std::min(least, point.low());
  least = std::max(0.0, least - 0.05 * (1.0 - least) - 1e-6);
  const auto y = [&](double share) { return kBottom - (share - least) / (1.0 - least) * (kBottom - kTop); };
  const double step = (kRight - kLeft) / static_cast<double>(points.size());
  std::string svg = fmt::format(
      "<svg class=\"chart trend\" viewBox=\"0 0 1000 {:.0f}\" role=\"group\" "
      "aria-label=\"Share of flights that meet the requirement, by campaign\">\n",
      kHeight);
  for (int i = 0; i <= 4; ++i) {
    const double share = least + (1.0 - least) * i / 4.0;
    svg += fmt::format(
        "<path class=\"grid\" d=\"M{} {:.1f}H{}\"/><text class=\"tick\" text-anchor=\"end\" x=\"{}\" "
        "y=\"{:.1f}\">{:.4g} %</text>\n",
        kLeft, y(share), kRight, kLeft - 6.0, y(share) + 4.0, 100.0 * share);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point& point = points[i];
    const RequirementOutcome& one = *point.outcome;
    const double x = kLeft + step * (static_cast<double>(i) + 0.5), half = std::min(14.0, 0.45 * step);
    svg += fmt::format("<path class=\"limit\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>", x - half, y(one.probability),
                       x + half);
    svg += fmt::format("<a href=\"{}\"><title>{}: {} of {} fail, {}</title>", LinkTo(*point.row),
                       HtmlText(VersionOf(*point.row)), one.failures, one.n, HtmlText(one.verdict));
    if (one.success_lower && one.success_upper)
      svg += fmt::format("<path class=\"range\" d=\"M{:.1f} {:.1f}V{:.1f}\"/>", x, y(*one.success_lower),
                         y(*one.success_upper));
    svg += fmt::format(
        "<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"8\"/><text class=\"letter\" "
        "text-anchor=\"middle\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text></a>",
        HtmlText(one.verdict), x, y(point.met()), x, y(point.met()) + 4.0, LetterOf(one.verdict));
    if (points.size() <= 30 || i % 2 == 0)
      svg += fmt::format(
          "<text class=\"tick\" text-anchor=\"end\" transform=\"translate({:.1f} {:.1f}) "
          "rotate(-50)\">{}</text>\n",
          x + 4.0, kBottom + 14.0, HtmlText(VersionOf(*point.row)));
  }
  return svg + "</svg>\n";
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
    const std::vector<Point> points = PointsOf(rows, metric, kMostInAll, all);
    html += TrendChart({points.rbegin(), points.rend()});
  }
  return html + "<p class=\"soft\">" + kChartWords + "</p>\n";
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
  std::vector<Point> by_age(points.rbegin(), points.rend());
  main += fmt::format(
      "<figure class=\"wide\">{}<figcaption>{}{}</figcaption></figure>\n", TrendChart(by_age), kChartWords,
      all > points.size() ? fmt::format(" The last {} of {} campaigns.", points.size(), all) : "");
  return Frame("Trend", main + table.Html());
}

}  // namespace dispersa
