// Several charts as one picture, either self-contained or as a section of a page.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/pages/svg_chart.h"

namespace dispersa {

struct FigurePanel {
  SvgChart chart;
  std::string caption;
};

struct FigureSheet {
  std::string title;
  std::vector<FigurePanel> panels;
};

inline constexpr int kPanelWidth = 440;
inline constexpr int kPanelHeight = 340;

/// A chart of the size of a panel.
SvgChart PanelChart(ChartAxis x, ChartAxis y);

/// A whole SVG file, panels in two columns so that they can be read beside text: light background, own style.
std::string StandaloneSvg(const FigureSheet& sheet);
/// The panels with their captions; the page's style sheet needs FigureStyle() besides the report's.
std::string PageSection(const FigureSheet& sheet);
/// Classes of points: "dots-0" to "dots-3" in the lines' colours, "public" for others' values, "shipped".
std::string_view FigureStyle();

}  // namespace dispersa
