#include "tests/tools/figure_sheet.h"

#include <fmt/format.h>

#include <utility>

#include "core/pages/html_parts.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

constexpr int kColumns = 2;
constexpr int kGap = 14;
constexpr int kTitle = 34;

constexpr std::string_view kLightStyle = R"css(
svg { --paper: #ffffff; --ink: #1a2230; --soft: #5b6675; --rule: #d8dee6; --panel: #f0f3f7; --blue: #1f5fa8;
  --orange: #c8621b; --green: #2d7d46; --violet: #7350a8; --limit: #c0272d; }
text { font-family: "Liberation Sans", Arial, Helvetica, sans-serif; fill: var(--ink); }
.title { font-size: 17px; font-weight: 600; } .label { font-size: 12px; font-weight: 600; }
.tick { font-size: 11px; fill: var(--soft); } .legend { font-size: 11.5px; }
.mark-label { font-size: 10px; fill: var(--soft); }
path { fill: none; stroke-linejoin: round; } .grid { stroke: var(--rule); stroke-width: 0.7; }
.axis { stroke: var(--soft); stroke-width: 1; } .shade { fill: var(--panel); }
.mark { stroke: var(--soft); stroke-width: 0.8; stroke-dasharray: 2 3; }
.limit { stroke: var(--limit); stroke-width: 1.3; stroke-dasharray: 7 4; }
.line-0 { stroke: var(--blue); stroke-width: 1.6; } .line-1 { stroke: var(--orange); stroke-width: 1.4; }
.line-2 { stroke: var(--green); stroke-width: 1.4; } .line-3 { stroke: var(--violet); stroke-width: 1.4; }
)css";

}  // namespace

SvgChart PanelChart(ChartAxis x, ChartAxis y) {
  return SvgChart(std::move(x), std::move(y), kPanelWidth, kPanelHeight);
}

std::string StandaloneSvg(const FigureSheet& sheet) {
  const int count = static_cast<int>(sheet.panels.size());
  const int rows = (count + kColumns - 1) / kColumns;
  const int width = kColumns * (kPanelWidth + kGap) + kGap;
  const int height = kTitle + rows * (kPanelHeight + kGap) + kGap;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\">\n"
      "<style>{2}{3}</style>\n<rect width=\"{0}\" height=\"{1}\" style=\"fill: var(--paper)\"/>\n"
      "<text class=\"title\" x=\"{4}\" y=\"24\">{5}</text>\n",
      width, height, kLightStyle, FigureStyle(), kGap, HtmlText(sheet.title));
  for (int i = 0; i < count; ++i) {
    const FigurePanel& panel = sheet.panels[static_cast<std::size_t>(i)];
    // A nested element without a size would take the whole picture's.
    svg += fmt::format("<svg x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\">{}</svg>\n",
                       kGap + (i % kColumns) * (kPanelWidth + kGap),
                       kTitle + kGap + (i / kColumns) * (kPanelHeight + kGap), kPanelWidth, kPanelHeight,
                       panel.chart.Svg(panel.caption));
  }
  return svg + "</svg>\n";
}

std::string PageSection(const FigureSheet& sheet) {
  std::string html = fmt::format("<h2>{}</h2>\n<div class=\"figures\">\n", HtmlText(sheet.title));
  for (const FigurePanel& panel : sheet.panels)
    html += Figure(panel.chart.Svg(panel.caption), HtmlText(panel.caption));
  return html + "</div>\n";
}

std::string_view FigureStyle() {
  return R"css(
svg .dots-0, svg .dots-1, svg .dots-2, svg .dots-3, svg .public, svg .shipped { stroke-linecap: round; }
svg .dots-0 { stroke: var(--blue); stroke-width: 6; } svg .dots-1 { stroke: var(--orange); stroke-width: 6; }
svg .dots-2 { stroke: var(--green); stroke-width: 6; } svg .dots-3 { stroke: var(--violet); stroke-width: 6; }
svg .public { stroke: var(--ink); stroke-width: 5; }
svg .shipped { stroke: var(--limit); stroke-width: 13; opacity: 0.45; }
)css";
}

}  // namespace dispersa
