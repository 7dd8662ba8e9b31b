#include "core/paper/heat_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/math/assertion.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

constexpr double kLeft = 64.0;
constexpr double kTop = 44.0;
constexpr double kBottom = 44.0;
constexpr double kCellWidth = 58.0;
constexpr double kCellHeight = 30.0;
constexpr int kShades = 6;

std::string Label(double x, double y, const char* style, const char* anchor, const std::string& text) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"{}\" text-anchor=\"{}\">{}</text>", x, y, style,
                     anchor, HtmlText(text));
}

/// Three significant digits: a cell is narrow.
std::string Short(double value) {
  if (!std::isfinite(value)) return "–";
  if (value == 0.0) return "0";
  const int digits = 2 - static_cast<int>(std::floor(std::log10(std::fabs(value))));
  return fmt::format("{:.{}f}", value, std::clamp(digits, 0, 4));
}

std::string Rectangle(double x, double y, double width, double height, const std::string& style) {
  return fmt::format("<rect class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>",
                     style, x, y, width, height);
}

}  // namespace

std::string HeatMapSvg(const HeatMap& map, const std::string& description) {
  DISPERSA_ASSERT(map.cells.size() == map.x.size() * map.y.size(), map.cells.size(), map.x.size(),
                  map.y.size());
  double low = HUGE_VAL;
  double high = 0.0;
  for (const HeatMapCell& cell : map.cells) {
    if (cell.region == HeatMapCell::Region::kLost || !(cell.value > 0.0)) continue;
    low = std::min(low, cell.value);
    high = std::max(high, cell.value);
  }
  const auto shade = [&](double value) {
    if (!(value > 0.0) || !(high > low)) return 0;
    const double part = std::log(value / low) / std::log(high / low);
    return std::clamp(static_cast<int>(part * kShades), 0, kShades - 1);
  };

  const double plot_width = kCellWidth * static_cast<double>(map.x.size());
  const double plot_height = kCellHeight * static_cast<double>(map.y.size());
  const double bottom = kTop + plot_height;
  const double width = kLeft + plot_width + 12.0;
  const double height = bottom + kBottom;
  std::string svg =
      fmt::format("<svg class=\"chart\" viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"{}\">", width,
                  height, HtmlText(description));
  svg += Label(4.0, 13.0, "label", "start", map.y_label);
  svg += Label(4.0, 32.0, "legend", "start", map.value_label + "; ~ limit cycle; × flight lost");
  for (std::size_t row = 0; row < map.y.size(); ++row) {
    const double y = bottom - kCellHeight * static_cast<double>(row + 1);
    svg += Label(kLeft - 6.0, y + 0.5 * kCellHeight + 4.0, "tick", "end", fmt::format("{:g}", map.y[row]));
    for (std::size_t column = 0; column < map.x.size(); ++column) {
      const double x = kLeft + kCellWidth * static_cast<double>(column);
      const HeatMapCell& cell = map.cells[row * map.x.size() + column];
      const bool lost = cell.region == HeatMapCell::Region::kLost;
      const bool cycles = cell.region == HeatMapCell::Region::kLimitCycle;
      const int s = shade(cell.value);
      svg += Rectangle(x + 1.0, y + 1.0, kCellWidth - 2.0, kCellHeight - 2.0,
                       lost ? "heat-lost" : fmt::format("heat-{}{}", s, cycles ? " heat-cycle" : ""));
      const char* ink = lost || s >= kShades / 2 ? "heat-light" : "heat-dark";
      svg += Label(x + 0.5 * kCellWidth, y + 0.5 * kCellHeight + 4.0, ink, "middle",
                   lost ? "×" : Short(cell.value) + (cycles ? " ~" : ""));
      if (map.x[column] == map.framed_x && map.y[row] == map.framed_y) {
        svg += Rectangle(x, y, kCellWidth, kCellHeight, "heat-frame");
      }
    }
  }
  for (std::size_t column = 0; column < map.x.size(); ++column) {
    svg += Label(kLeft + kCellWidth * (static_cast<double>(column) + 0.5), bottom + 16.0, "tick", "middle",
                 fmt::format("{:g}", map.x[column]));
  }
  svg += Label(kLeft + 0.5 * plot_width, height - 8.0, "label", "middle", map.x_label);
  return svg + "</svg>";
}

std::string_view HeatMapStyle() {
  return R"css(
svg .heat-0 { fill: #e3eef9; } svg .heat-1 { fill: #c3dbf1; } svg .heat-2 { fill: #97c1e6; }
svg .heat-3 { fill: #5b94cc; } svg .heat-4 { fill: #2f6cab; } svg .heat-5 { fill: #123f73; }
svg .heat-lost { fill: #b3242a; } svg .heat-cycle { stroke: #e07b1a; stroke-width: 3; }
svg .heat-frame { fill: none; stroke: var(--ink); stroke-width: 2.5; }
svg text.heat-dark { fill: #1a2230; font-size: 11px; } svg text.heat-light { fill: #ffffff; font-size: 11px; }
)css";
}

}  // namespace dispersa
