#include "core/pages/svg_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <utility>

#include "core/pages/chart_scale.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

constexpr double kLeft = 58.0;
constexpr double kRight = 18.0;
constexpr double kBottom = 42.0;
constexpr double kTitleRow = 20.0;  ///< the y axis's label
constexpr double kLegendRow = 17.0;
constexpr double kMarkRow = 13.0;  ///< labels of events
constexpr std::size_t kManyPoints = 5000;
constexpr double kCharacter = 6.9;  ///< mean width of a letter of the legend

std::string Coordinate(double value) {
  std::string text = fmt::format("{:.1f}", value);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text == "-0" ? "0" : text;
}

struct AxisRange {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void Add(double value, bool positive_only) {
    if (!std::isfinite(value) || (positive_only && value <= 0.0)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void Add(const std::vector<double>& values, bool positive_only) {
    for (const double value : values) Add(value, positive_only);
  }
};

/// Whether a limit is shown: one that lies farther from the data than these are wide would press them
/// together.
bool Near(double limit, const ChartAxis& axis, const AxisRange& data) {
  if (axis.low && axis.high) return limit >= *axis.low && limit <= *axis.high;
  const double span = data.high - data.low;
  if (!(span > 0.0)) return true;
  return limit >= data.low - span && limit <= data.high + span;
}

struct Point {
  double x;
  double y;
};

/// Of the points that share a pixel column only the first, the lowest, the highest and the last are drawn,
/// which keeps every peak.
void ThinColumn(const std::vector<Point>& column, std::vector<Point>* out) {
  if (column.size() <= 4) {
    out->insert(out->end(), column.begin(), column.end());
    return;
  }
  const auto by_y = [](const Point& a, const Point& b) { return a.y < b.y; };
  const auto lowest = std::min_element(column.begin() + 1, column.end() - 1, by_y);
  const auto highest = std::max_element(column.begin() + 1, column.end() - 1, by_y);
  out->push_back(column.front());
  out->push_back(*std::min(lowest, highest));
  if (lowest != highest) out->push_back(*std::max(lowest, highest));
  out->push_back(column.back());
}

double DistanceToSegment(const Point& point, const Point& a, const Point& b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const double squared = dx * dx + dy * dy;
  const double along =
      squared > 0.0 ? std::clamp(((point.x - a.x) * dx + (point.y - a.y) * dy) / squared, 0.0, 1.0) : 0.0;
  return std::hypot(point.x - a.x - along * dx, point.y - a.y - along * dy);
}

/// Without the points from which the line through the others is nowhere farther than the eye sees (D. H.
/// Douglas and T. K. Peucker, Cartographica 10 (1973) 112-122).
std::vector<Point> Straightened(const std::vector<Point>& run) {
  constexpr double kUnseen = 0.2;  // of a pixel
  if (run.size() < 3) return run;
  std::vector<bool> kept(run.size());
  kept.front() = kept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open = {{0, run.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    double most = kUnseen;
    std::size_t farthest = 0;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double distance = DistanceToSegment(run[i], run[first], run[last]);
      if (!(distance > most)) continue;
      most = distance;
      farthest = i;
    }
    if (farthest == 0) continue;
    kept[farthest] = true;
    open.push_back({first, farthest});
    open.push_back({farthest, last});
  }
  std::vector<Point> straightened;
  for (std::size_t i = 0; i < run.size(); ++i)
    if (kept[i]) straightened.push_back(run[i]);
  return straightened;
}

/// Tenths of a pixel as pixels, in as few letters as SVG reads: "-.3", "12", "0".
std::string Step(std::int64_t tenths) {
  std::string text = Coordinate(static_cast<double>(tenths) / 10.0);
  const std::size_t zero = text.find("0.");
  if (zero == 0 || (zero == 1 && text[0] == '-')) text.erase(zero, 1);
  return text;
}

/// The first point, then steps: these have fewer digits. Steps are between rounded points, so that their
/// sum is exact.
std::string Path(const std::vector<Point>& points) {
  std::string path;
  std::int64_t x = 0, y = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto next_x = static_cast<std::int64_t>(std::llround(10.0 * points[i].x));
    const auto next_y = static_cast<std::int64_t>(std::llround(10.0 * points[i].y));
    const std::string dx = Step(next_x - x), dy = Step(next_y - y);
    path += i == 0 ? "M" : i == 1 ? "l" : dx[0] == '-' ? "" : " ";
    path += dx + (dy[0] == '-' ? "" : " ") + dy;
    x = next_x;
    y = next_y;
  }
  return path;
}

/// Runs of finite points inside the x range, thinned.
std::vector<std::vector<Point>> Runs(const std::vector<double>& x, const std::vector<double>& y,
                                     const ChartScale& xs, const ChartScale& ys, bool positive_only) {
  std::vector<std::vector<Point>> runs(1);
  std::vector<Point> column;
  const auto flush = [&] {
    ThinColumn(column, &runs.back());
    column.clear();
  };
  for (std::size_t i = 0; i < x.size(); ++i) {
    const bool drawn = std::isfinite(x[i]) && std::isfinite(y[i]) && x[i] >= xs.low() && x[i] <= xs.high() &&
                       !(positive_only && y[i] <= 0.0);
    if (!drawn) {
      flush();
      if (!runs.back().empty()) runs.emplace_back();
      continue;
    }
    const Point point{xs.At(x[i]), ys.At(y[i])};
    if (!column.empty() && std::floor(column.back().x) != std::floor(point.x)) flush();
    column.push_back(point);
  }
  flush();
  if (runs.back().empty()) runs.pop_back();
  for (std::vector<Point>& run : runs) run = Straightened(run);
  return runs;
}

std::string Text(double x, double y, const char* style, const char* anchor, const std::string& text) {
  return fmt::format("<text x=\"{}\" y=\"{}\" class=\"{}\" text-anchor=\"{}\">{}</text>", Coordinate(x),
                     Coordinate(y), style, anchor, HtmlText(text));
}

std::string Segment(double x1, double y1, double x2, double y2, const char* style,
                    const std::string& attributes = "") {
  return fmt::format("<path class=\"{}\"{} d=\"M{} {}L{} {}\"/>", style, attributes, Coordinate(x1),
                     Coordinate(y1), Coordinate(x2), Coordinate(y2));
}

}  // namespace

SvgChart::SvgChart(ChartAxis x, ChartAxis y, int width, int height)
    : x_(std::move(x)), y_(std::move(y)), width_(width), height_(height) {}

void SvgChart::Line(std::vector<double> x, std::vector<double> y, const std::string& style,
                    const std::string& legend) {
  series_.push_back({Series::Kind::kLine, std::move(x), std::move(y), {}, style, legend});
}

void SvgChart::CaseLine(std::vector<double> x, std::vector<double> y, const std::string& style,
                        std::uint64_t case_index) {
  Line(std::move(x), std::move(y), style, fmt::format("case {}", case_index));
  series_.back().case_index = case_index;
}

void SvgChart::ShowsCases(const std::string& x_metric, const std::string& y_metric) {
  x_metric_ = x_metric;
  y_metric_ = y_metric;
}

void SvgChart::Points(std::vector<double> x, std::vector<double> y, const std::string& style,
                      const std::string& legend) {
  series_.push_back({Series::Kind::kPoints, std::move(x), std::move(y), {}, style, legend});
}

void SvgChart::Band(std::vector<double> x, std::vector<double> low, std::vector<double> high,
                    const std::string& style, const std::string& legend) {
  series_.push_back({Series::Kind::kBand, std::move(x), std::move(low), std::move(high), style, legend});
}

void SvgChart::Bars(std::vector<double> edges, std::vector<double> counts, const std::string& legend) {
  series_.push_back({Series::Kind::kBars, std::move(edges), std::move(counts), {}, "bar", legend});
}

void SvgChart::VerticalLimit(double x, const std::string& legend, const std::string& style) {
  series_.push_back({Series::Kind::kVerticalLimit, {x}, {}, {}, style, legend});
}

void SvgChart::HorizontalLimit(double y, const std::string& legend, const std::string& style) {
  series_.push_back({Series::Kind::kHorizontalLimit, {}, {y}, {}, style, legend});
}

void SvgChart::Mark(double x, const std::string& label) { spans_.push_back({x, x, label}); }

void SvgChart::Shade(double from, double to, const std::string& label) {
  spans_.push_back({from, to, label});
}

std::string SvgChart::Svg(const std::string& description) const {
  const double bottom = height_ - kBottom;
  const double right = width_ - kRight;

  std::vector<std::string> legends;
  for (const Series& series : series_) legends.push_back(series.legend);
  std::vector<bool> drawn(series_.size(), true);

  AxisRange x_range;
  for (const Series& series : series_) {
    if (series.kind != Series::Kind::kVerticalLimit) x_range.Add(series.x, x_.logarithmic);
  }
  const AxisRange x_data = x_range;
  for (std::size_t i = 0; i < series_.size(); ++i) {
    if (series_[i].kind != Series::Kind::kVerticalLimit) continue;
    const double limit = series_[i].x[0];
    drawn[i] = Near(limit, x_, x_data);
    if (!drawn[i]) legends[i] += limit > x_data.high ? " (far to the right)" : " (far to the left)";
    const double room = 0.03 * (x_data.high - x_data.low);  // a limit shall not lie on the frame
    if (drawn[i]) x_range.Add(std::vector{limit - room, limit + room}, x_.logarithmic);
  }
  const ChartScale xs(x_, x_range.low, x_range.high, kLeft, right, std::max(3, width_ / 90));

  AxisRange y_range;
  for (const Series& series : series_) {
    if (series.kind == Series::Kind::kVerticalLimit || series.kind == Series::Kind::kHorizontalLimit)
      continue;
    if (series.kind == Series::Kind::kBars) {
      y_range.Add(0.0, y_.logarithmic);
      y_range.Add(series.low, y_.logarithmic);
      continue;
    }
    for (std::size_t i = 0; i < series.x.size(); ++i) {  // only what the x axis shows
      if (!(series.x[i] >= xs.low() && series.x[i] <= xs.high())) continue;
      y_range.Add(series.low[i], y_.logarithmic);
      if (!series.high.empty()) y_range.Add(series.high[i], y_.logarithmic);
    }
  }
  const AxisRange y_data = y_range;
  for (std::size_t i = 0; i < series_.size(); ++i) {
    if (series_[i].kind != Series::Kind::kHorizontalLimit) continue;
    const double limit = series_[i].low[0];
    drawn[i] = Near(limit, y_, y_data);
    if (drawn[i]) y_range.Add(limit, y_.logarithmic);
    if (!drawn[i] && !legends[i].empty()) legends[i] += limit > y_data.high ? " (far above)" : " (far below)";
  }

  // The legend decides where the plot begins.
  struct Entry {
    const Series* series;
    const std::string* text;
    double x;
    int row;
  };
  std::vector<Entry> entries;
  double legend_x = kLeft;
  int rows = 0;
  for (std::size_t i = 0; i < series_.size(); ++i) {
    if (legends[i].empty()) continue;
    const double width = 32.0 + kCharacter * static_cast<double>(legends[i].size());
    if (rows == 0 || legend_x + width > width_ - kRight) {
      ++rows;
      legend_x = kLeft;
    }
    entries.push_back({&series_[i], &legends[i], legend_x, rows - 1});
    legend_x += width;
  }
  const double top = kTitleRow + kLegendRow * rows + (spans_.empty() ? 4.0 : kMarkRow);
  const ChartScale ys(y_, y_range.low, y_range.high, bottom, top, 5);

  // What the page's script needs to tell values from positions.
  const auto axis = [](const ChartAxis& described, const ChartScale& scale, double from, double to) {
    return fmt::format("{} {} {} {} {}{}", ShortestText(scale.low()), ShortestText(scale.high()),
                       Coordinate(from), Coordinate(to), described.logarithmic ? "log" : "linear",
                       described.percent ? " percent" : "");
  };
  std::string svg = fmt::format(
      "<svg class=\"chart\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\" data-x=\"{}\" data-y=\"{}\"",
      width_, height_, HtmlText(description), axis(x_, xs, kLeft, right), axis(y_, ys, bottom, top));
  if (!x_metric_.empty()) svg += fmt::format(" data-mx=\"{}\"", x_metric_);
  if (!y_metric_.empty()) svg += fmt::format(" data-my=\"{}\"", y_metric_);
  svg += ">";

  std::string spans, labels;
  for (const Span& span : spans_) {
    if (span.to < xs.low() || span.from > xs.high()) continue;
    const double from = xs.At(std::max(span.from, xs.low()));
    const double to = xs.At(std::min(span.to, xs.high()));
    if (span.to > span.from) {
      spans +=
          fmt::format("<rect class=\"shade\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>",
                      Coordinate(from), Coordinate(top), Coordinate(to - from), Coordinate(bottom - top));
      labels += Text(0.5 * (from + to), top - 3.0, "mark-label", "middle", span.label);
    } else {
      spans += Segment(from, top, from, bottom, "mark");
      const bool inside = from + kCharacter * static_cast<double>(span.label.size()) < width_;
      labels +=
          Text(from + (inside ? 1.0 : -1.0), top - 3.0, "mark-label", inside ? "start" : "end", span.label);
    }
  }
  svg += labels + "<g class=\"ticks\">";
  for (const Tick& tick : ys.ticks()) {
    const double y = ys.At(tick.value);
    svg += Segment(kLeft, y, right, y, "grid");
    svg += Text(kLeft - 6.0, y + 4.0, "tick", "end", tick.label);
  }
  for (const Tick& tick : xs.ticks()) {
    const double x = xs.At(tick.value);
    svg += Segment(x, bottom, x, bottom + 4.0, "axis");
    svg += Text(x, bottom + 17.0, "tick", "middle", tick.label);
  }
  // A view of its own, so that a zoom changes nothing but what it shows; a little larger than the axes, so
  // that nothing on them is cut.
  constexpr double kRim = 3.0;
  const std::string frame =
      fmt::format("{} {} {} {}", Coordinate(kLeft - kRim), Coordinate(top - kRim),
                  Coordinate(right - kLeft + 2.0 * kRim), Coordinate(bottom - top + 2.0 * kRim));
  svg += fmt::format(
      "</g><svg class=\"plot\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" viewBox=\"{}\" "
      "preserveAspectRatio=\"none\">{}",
      Coordinate(kLeft - kRim), Coordinate(top - kRim), Coordinate(right - kLeft + 2.0 * kRim),
      Coordinate(bottom - top + 2.0 * kRim), frame, spans);

  for (std::size_t n = 0; n < series_.size(); ++n) {
    const Series& series = series_[n];
    if (!drawn[n]) continue;
    const std::string named = fmt::format(" data-s=\"{}\"", HtmlText(series.legend));
    switch (series.kind) {
      case Series::Kind::kLine:
        for (const auto& run : Runs(series.x, series.low, xs, ys, y_.logarithmic)) {
          svg += fmt::format("<path class=\"{}\"{}{} d=\"{}\"/>", series.style, named,
                             series.case_index ? fmt::format(" data-case=\"{}\"", *series.case_index) : "",
                             Path(run));
        }
        break;
      case Series::Kind::kPoints: {
        // One path of strokes without length, whose round ends are the dots: an element a case would be
        // heavy.
        std::string dots;
        std::set<std::pair<long, long>> taken;
        for (std::size_t i = 0; i < series.x.size(); ++i) {
          if (!std::isfinite(series.x[i]) || !std::isfinite(series.low[i])) continue;
          const double x = xs.At(series.x[i]);
          const double y = ys.At(series.low[i]);
          // Of many dots one a pixel is seen.
          if (series.x.size() > kManyPoints && !taken.insert({std::lround(x), std::lround(y)}).second)
            continue;
          dots += "M" + Coordinate(x) + " " + Coordinate(y) + "h0";
        }
        svg += fmt::format("<path class=\"{}\"{} d=\"{}\"/>", series.style, named, dots);
        break;
      }
      case Series::Kind::kBand: {
        const auto lows = Runs(series.x, series.low, xs, ys, y_.logarithmic);
        const auto highs = Runs(series.x, series.high, xs, ys, y_.logarithmic);
        for (std::size_t i = 0; i < std::min(lows.size(), highs.size()); ++i) {
          std::vector<Point> outline = highs[i];
          outline.insert(outline.end(), lows[i].rbegin(), lows[i].rend());
          svg += fmt::format("<path class=\"{}\"{} d=\"{}Z\"/>", series.style, named, Path(outline));
        }
        break;
      }
      case Series::Kind::kBars:
        for (std::size_t i = 0; i + 1 < series.x.size(); ++i) {
          if (series.low[i] <= 0.0) continue;
          const double from = xs.At(series.x[i]);
          const double y = ys.At(series.low[i]);
          svg += fmt::format(
              "<rect class=\"bar\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"><title>{} to {}: {}"
              "</title></rect>",
              Coordinate(from), Coordinate(y), Coordinate(std::max(xs.At(series.x[i + 1]) - from - 0.6, 0.6)),
              Coordinate(bottom - y), ReadableText(series.x[i]), ReadableText(series.x[i + 1]),
              ReadableText(series.low[i]));
        }
        break;
      case Series::Kind::kVerticalLimit:
        svg += Segment(xs.At(series.x[0]), top, xs.At(series.x[0]), bottom, series.style.c_str(), named);
        break;
      case Series::Kind::kHorizontalLimit:
        svg += Segment(kLeft, ys.At(series.low[0]), right, ys.At(series.low[0]), series.style.c_str(), named);
        break;
    }
  }

  svg += "</svg>" + Segment(kLeft, bottom, right, bottom, "axis");
  svg += Text(0.5 * (kLeft + right), height_ - 8.0, "label", "middle", x_.label);
  svg += Text(4.0, 13.0, "label", "start", y_.label);
  for (const Entry& entry : entries) {
    const double y = kTitleRow + kLegendRow * entry.row + 9.0;
    const bool area = entry.series->kind == Series::Kind::kBand || entry.series->kind == Series::Kind::kBars;
    svg += area ? fmt::format("<rect class=\"{}\" x=\"{}\" y=\"{}\" width=\"18\" height=\"10\"/>",
                              entry.series->style, Coordinate(entry.x), Coordinate(y - 9.0))
                : Segment(entry.x + (entry.series->kind == Series::Kind::kPoints ? 12.0 : 0.0), y - 4.0,
                          entry.x + (entry.series->kind == Series::Kind::kPoints ? 12.0 : 18.0), y - 4.0,
                          entry.series->style.c_str());
    svg += Text(entry.x + 22.0, y, "legend", "start", *entry.text);
  }
  return svg + "</svg>";
}

}  // namespace dispersa
