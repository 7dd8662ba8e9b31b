// A map of one quantity over a grid, as inline SVG like svg_chart.h.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace dispersa {

struct HeatMapCell {
  enum class Region { kSound, kLimitCycle, kLost };
  double value = 0.0;  ///< decides the shade; not drawn where the flight was lost
  Region region = Region::kSound;
};

struct HeatMap {
  std::string x_label;
  std::string y_label;
  std::string value_label;                ///< with the unit
  std::vector<double> x;                  ///< of the columns, ascending
  std::vector<double> y;                  ///< of the rows, ascending: the first is the lowest
  std::vector<HeatMapCell> cells;         ///< shape (y, x), row by row
  double framed_x = 0.0, framed_y = 0.0;  ///< the cell with a frame, if the grid has it
};

/// The SVG element, with `description` for readers who cannot see it. Shades follow the logarithm of the
/// value. A cell also shows its value, "~" for a limit cycle, or "lost" for a lost flight, so that no
/// information depends on colour alone.
std::string HeatMapSvg(const HeatMap& map, const std::string& description);

/// For the page's <style>.
std::string_view HeatMapStyle();

}  // namespace dispersa
