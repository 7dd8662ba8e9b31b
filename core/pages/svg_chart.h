// A chart as inline SVG: no script, no font and no file outside the page. Colours come from the page's style
// sheet by class, so that one chart serves screen, dark screen and paper.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace dispersa {

struct ChartAxis {
  std::string label;               ///< with the unit
  std::optional<double> low = {};  ///< none: the least value of the data
  std::optional<double> high = {};
  bool logarithmic = false;  ///< base 10; values that are not positive are left out
  bool percent = false;      ///< tick labels of 0.01 read "1 %"
};

class SvgChart {
 public:
  SvgChart(ChartAxis x, ChartAxis y, int width = 520, int height = 260);

  /// Points joined by lines; NaN interrupts. `style` is a class of the style sheet ("line-0" ... "line-3").
  void Line(std::vector<double> x, std::vector<double> y, const std::string& style,
            const std::string& legend);
  /// The line of one case. The page's script can mark it.
  void CaseLine(std::vector<double> x, std::vector<double> y, const std::string& style,
                std::uint64_t case_index);
  /// Positions along x are this metric of the cases, and positions along y too if `y_metric` is not empty.
  void ShowsCases(const std::string& x_metric, const std::string& y_metric = "");
  /// Dots.
  void Points(std::vector<double> x, std::vector<double> y, const std::string& style,
              const std::string& legend);
  /// The area between two curves over the same x.
  void Band(std::vector<double> x, std::vector<double> low, std::vector<double> high,
            const std::string& style, const std::string& legend);
  /// counts[i] between edges[i] and edges[i + 1], from zero up.
  void Bars(std::vector<double> edges, std::vector<double> counts, const std::string& legend);
  /// Dashed lines that belong to a requirement. The axes grow to show them. A limit that is too far from the
  /// data is not drawn; the legend then gives its value.
  void VerticalLimit(double x, const std::string& legend, const std::string& style = "limit");
  void HorizontalLimit(double y, const std::string& legend, const std::string& style = "limit");
  /// A labelled event, and a labelled span of time. Events that are too near share one label; a span without
  /// room has none.
  void Mark(double x, const std::string& label);
  void Shade(double from, double to, const std::string& label);

  /// The SVG element. Screen readers read `description`.
  std::string Svg(const std::string& description) const;

 private:
  class Picture;
  struct Series {
    enum class Kind { kLine, kPoints, kBand, kBars, kVerticalLimit, kHorizontalLimit };
    Kind kind;
    std::vector<double> x;
    std::vector<double> low;  ///< y of lines and bars
    std::vector<double> high;
    std::string style;
    std::string legend;
    std::optional<std::uint64_t> case_index = {};
  };
  struct Span {
    double from;
    double to;  ///< == from: an event
    std::string label;
  };

  ChartAxis x_;
  ChartAxis y_;
  int width_;
  int height_;
  std::string x_metric_;
  std::string y_metric_;
  std::vector<Series> series_;
  std::vector<Span> spans_;
};

}  // namespace dispersa
