// A map of one quantity over two factors, as a table with shaded cells.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace dispersa {

struct HeatPoint {
  enum class Region { kSound, kLimitCycle, kLost };
  double x = 0.0, y = 0.0;  ///< its column and row
  double value = 0.0;       ///< decides the shade; not shown where the flight was lost
  Region region = Region::kSound;
  bool framed = false;
};

/// The table as HTML, with x to the right and y upwards. Shades follow the logarithm of the value. A cell
/// also shows its value, "~" for a limit cycle, or "×" for a lost flight, so that no information depends on
/// colour alone. `corner`: what the axes are.
std::string HeatMapTable(const std::string& corner, const std::vector<HeatPoint>& points);

/// For the page's <style>.
std::string_view HeatMapStyle();

}  // namespace dispersa
