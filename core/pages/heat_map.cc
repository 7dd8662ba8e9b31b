#include "core/pages/heat_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "core/pages/html_parts.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

constexpr int kShades = 6;

std::string CellHtml(const HeatPoint& point, double low, double high) {
  const char* frame = point.framed ? " framed" : "";
  if (point.region == HeatPoint::Region::kLost) return fmt::format("<b class=\"lost{}\">×</b>", frame);
  int shade = 0;
  if (point.value > 0.0 && high > low)
    shade =
        std::min(static_cast<int>(kShades * std::log(point.value / low) / std::log(high / low)), kShades - 1);
  const bool cycles = point.region == HeatPoint::Region::kLimitCycle;
  return fmt::format("<b class=\"heat-{}{}{}\">{}{}</b>", shade, cycles ? " cycle" : "", frame,
                     RoundedText(point.value), cycles ? "~" : "");
}

}  // namespace

std::string HeatMapTable(const std::string& corner, const std::vector<HeatPoint>& points) {
  std::map<double, std::map<double, const HeatPoint*>, std::greater<>> rows;  // the highest first
  std::set<double> columns;
  double low = HUGE_VAL, high = 0.0;
  for (const HeatPoint& point : points) {
    rows[point.y][point.x] = &point;
    columns.insert(point.x);
    if (point.region == HeatPoint::Region::kLost || !(point.value > 0.0)) continue;
    low = std::min(low, point.value);
    high = std::max(high, point.value);
  }
  std::vector<HtmlTable::Column> titles = {{corner, true, true}};
  for (const double x : columns) titles.push_back({fmt::format("{:g}", x), true});
  HtmlTable table(titles);
  for (const auto& [y, row] : rows) {
    std::vector<std::string> cells = {fmt::format("{:g}", y)};
    for (const double x : columns) cells.push_back(row.contains(x) ? CellHtml(*row.at(x), low, high) : "");
    table.Row(cells);
  }
  return table.Html("heat");
}

std::string_view HeatMapStyle() {
  return R"css(
table.heat { table-layout: fixed; min-width: 600px; font-size: 12px; } table.heat td, table.heat th { padding: 1px; border: 0;
  text-align: center; white-space: nowrap; } table.heat th:first-child { width: 15%; padding-right: 6px; text-align: right; }
table.heat b { display: block; padding: 3px 0; font-weight: 400; color: #ffffff; print-color-adjust: exact;
  -webkit-print-color-adjust: exact; } .heat-0 { background: #e3eef9; } .heat-1 { background: #c3dbf1; }
.heat-2 { background: #97c1e6; } .heat-3 { background: #2f76b8; } .heat-4 { background: #2a62a0; } .heat-5 { background: #123f73; }
table.heat .heat-0, table.heat .heat-1, table.heat .heat-2 { color: #1a2230; } table.heat .lost { background: #b3242a; }
.cycle { outline: 3px solid #e07b1a; outline-offset: -3px; } .framed { outline: 3px solid var(--ink); outline-offset: 0; }
@media print { table.heat { min-width: 0; font-size: 5.4pt; } .cycle { outline-width: 1px; outline-offset: -1px; } }
)css";
}

}  // namespace dispersa
