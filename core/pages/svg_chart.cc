#include "core/pages/svg_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
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
constexpr double kCharacter = 6.9;                      ///< mean width of a letter of the legend
constexpr double kMarkCharacter = 6.2, kMarkGap = 4.0;  ///< the same of a mark's label, and beside it

std::string Coordinate(double value) {
  std::string text = fmt::format("{:.1f}", value);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text == "-0" ? "0" : text;
}

/// Whether a limit is shown: one that lies farther from the data than these are wide would press them
/// together.
bool Near(double limit, const ChartAxis& axis, const ChartRange& data) {
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

/// A chart as it is drawn: which series it shows, how far its axes reach, and where each part lies.
class SvgChart::Picture {
 public:
  explicit Picture(const SvgChart& chart);

  std::string Svg(const std::string& description) const;

 private:
  struct LegendEntry {
    const Series* series;
    const std::string* text;
    double x;
    int row;
  };
  struct SpanParts {
    std::string labels;  ///< above the plot
    std::string shapes;  ///< inside it
  };
  struct MarkLabel {
    double from, to;
    std::string text;
    std::string first;  ///< event of several
  };

  // Stages of the layout, in their order.
  std::vector<std::string> Legends() const;
  ChartScale HorizontalScale();
  ChartRange VerticalRange();
  std::vector<LegendEntry> PlacedLegend() const;
  double Top() const;

  std::string Opening(const std::string& description) const;
  SpanParts Spans() const;
  std::vector<MarkLabel> MarkLabels() const;
  std::string Ticks() const;
  std::string PlotOpening() const;
  std::string Drawn(const Series& series) const;
  std::string Lines(const Series& series, const std::string& named) const;
  std::string Dots(const Series& series, const std::string& named) const;
  std::string Areas(const Series& series, const std::string& named) const;
  std::string Boxes(const Series& series) const;
  std::string AxisLabels() const;
  std::string Legend() const;

  const SvgChart& chart_;
  const double bottom_;
  const double right_;
  std::vector<std::string> legends_;  ///< of each series
  std::vector<bool> drawn_;           ///< of each series: not a limit far from the data
  const ChartScale xs_;
  const ChartRange y_range_;
  const std::vector<LegendEntry> entries_;
  const double top_;
  const ChartScale ys_;
};

SvgChart::Picture::Picture(const SvgChart& chart)
    : chart_(chart),
      bottom_(chart.height_ - kBottom),
      right_(chart.width_ - kRight),
      legends_(Legends()),
      drawn_(chart.series_.size(), true),
      xs_(HorizontalScale()),
      y_range_(VerticalRange()),
      entries_(PlacedLegend()),
      top_(Top()),
      ys_(chart.y_, y_range_.low, y_range_.high, bottom_, top_, 5) {}

std::vector<std::string> SvgChart::Picture::Legends() const {
  std::vector<std::string> legends;
  for (const Series& series : chart_.series_) legends.push_back(series.legend);
  return legends;
}

ChartScale SvgChart::Picture::HorizontalScale() {
  const ChartAxis& axis = chart_.x_;
  ChartRange range;
  for (const Series& series : chart_.series_) {
    if (series.kind != Series::Kind::kVerticalLimit) range.Add(series.x, axis.logarithmic);
  }
  const ChartRange data = range;
  for (std::size_t i = 0; i < chart_.series_.size(); ++i) {
    if (chart_.series_[i].kind != Series::Kind::kVerticalLimit) continue;
    const double limit = chart_.series_[i].x[0];
    drawn_[i] = Near(limit, axis, data);
    if (!drawn_[i]) legends_[i] += limit > data.high ? " (far to the right)" : " (far to the left)";
    const double room = 0.03 * (data.high - data.low);  // a limit shall not lie on the frame
    if (drawn_[i]) range.Add(std::vector{limit - room, limit + room}, axis.logarithmic);
  }
  return {axis, range.low, range.high, kLeft, right_, std::max(3, chart_.width_ / 90)};
}

ChartRange SvgChart::Picture::VerticalRange() {
  const ChartAxis& axis = chart_.y_;
  ChartRange range;
  for (const Series& series : chart_.series_) {
    if (series.kind == Series::Kind::kVerticalLimit || series.kind == Series::Kind::kHorizontalLimit)
      continue;
    if (series.kind == Series::Kind::kBars) {
      range.Add(0.0, axis.logarithmic);
      range.Add(series.low, axis.logarithmic);
      continue;
    }
    for (std::size_t i = 0; i < series.x.size(); ++i) {  // only what the x axis shows
      if (!(series.x[i] >= xs_.low() && series.x[i] <= xs_.high())) continue;
      range.Add(series.low[i], axis.logarithmic);
      if (!series.high.empty()) range.Add(series.high[i], axis.logarithmic);
    }
  }
  const ChartRange data = range;
  for (std::size_t i = 0; i < chart_.series_.size(); ++i) {
    if (chart_.series_[i].kind != Series::Kind::kHorizontalLimit) continue;
    const double limit = chart_.series_[i].low[0];
    drawn_[i] = Near(limit, axis, data);
    if (drawn_[i]) range.Add(limit, axis.logarithmic);
    if (!drawn_[i] && !legends_[i].empty())
      legends_[i] += limit > data.high ? " (far above)" : " (far below)";
  }
  return range;
}

std::vector<SvgChart::Picture::LegendEntry> SvgChart::Picture::PlacedLegend() const {
  std::vector<LegendEntry> entries;
  double x = kLeft;
  int rows = 0;
  for (std::size_t i = 0; i < chart_.series_.size(); ++i) {
    const Series& series = chart_.series_[i];
    const bool is_known = std::any_of(entries.begin(), entries.end(), [&](const LegendEntry& entry) {
      return *entry.text == legends_[i] && entry.series->style == series.style;
    });
    if (legends_[i].empty() || is_known) continue;
    const double width = 32.0 + kCharacter * static_cast<double>(legends_[i].size());
    if (rows == 0 || x + width > chart_.width_ - kRight) {
      ++rows;
      x = kLeft;
    }
    entries.push_back({&series, &legends_[i], x, rows - 1});
    x += width;
  }
  return entries;
}

/// The legend decides where the plot begins.
double SvgChart::Picture::Top() const {
  const int rows = entries_.empty() ? 0 : entries_.back().row + 1;
  return kTitleRow + kLegendRow * rows + (chart_.spans_.empty() ? 4.0 : kMarkRow);
}

std::string SvgChart::Picture::Svg(const std::string& description) const {
  const SpanParts spans = Spans();
  std::string svg = Opening(description) + spans.labels + Ticks() + PlotOpening() + spans.shapes;
  for (std::size_t i = 0; i < chart_.series_.size(); ++i)
    if (drawn_[i]) svg += Drawn(chart_.series_[i]);
  return svg + "</svg>" + Segment(kLeft, bottom_, right_, bottom_, "axis") + AxisLabels() + Legend() +
         "</svg>";
}

/// The element with what the page's script needs to tell values from positions.
std::string SvgChart::Picture::Opening(const std::string& description) const {
  const auto axis = [](const ChartAxis& described, const ChartScale& scale, double from, double to) {
    return fmt::format("{} {} {} {} {}{}", ShortestText(scale.low()), ShortestText(scale.high()),
                       Coordinate(from), Coordinate(to), described.logarithmic ? "log" : "linear",
                       described.percent ? " percent" : "");
  };
  std::string svg = fmt::format(
      "<svg class=\"chart\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\" data-x=\"{}\" data-y=\"{}\"",
      chart_.width_, chart_.height_, HtmlText(description), axis(chart_.x_, xs_, kLeft, right_),
      axis(chart_.y_, ys_, bottom_, top_));
  if (!chart_.x_metric_.empty()) svg += fmt::format(" data-mx=\"{}\"", chart_.x_metric_);
  if (!chart_.y_metric_.empty()) svg += fmt::format(" data-my=\"{}\"", chart_.y_metric_);
  return svg + ">";
}

SvgChart::Picture::SpanParts SvgChart::Picture::Spans() const {
  SpanParts parts;
  for (const MarkLabel& label : MarkLabels())
    parts.labels += Text(label.from, top_ - 3.0, "mark-label", "start", label.text);
  for (const Span& span : chart_.spans_) {
    if (span.to < xs_.low() || span.from > xs_.high()) continue;
    const double from = xs_.At(std::max(span.from, xs_.low()));
    const double to = xs_.At(std::min(span.to, xs_.high()));
    if (span.to > span.from) {
      parts.shapes +=
          fmt::format("<rect class=\"shade\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>",
                      Coordinate(from), Coordinate(top_), Coordinate(to - from), Coordinate(bottom_ - top_));
    } else {
      parts.shapes += Segment(from, top_, from, bottom_, "mark");
    }
  }
  return parts;
}

std::vector<SvgChart::Picture::MarkLabel> SvgChart::Picture::MarkLabels() const {
  const auto width = [](const std::string& text) {
    return kMarkCharacter * static_cast<double>(text.size());
  };
  std::vector<Span> events, wide;
  for (const Span& span : chart_.spans_)
    if (!(span.to < xs_.low() || span.from > xs_.high()))
      (span.to > span.from ? wide : events).push_back(span);
  std::stable_sort(events.begin(), events.end(),
                   [](const Span& a, const Span& b) { return a.from < b.from; });
  std::vector<MarkLabel> labels;
  for (const Span& event : events) {
    const double x = xs_.At(event.from) + 1.0;
    if (!labels.empty() && x < labels.back().to + kMarkGap) {
      const bool is_second = labels.back().text == labels.back().first;
      labels.back().text = labels.back().first + (is_second ? ", " : "–") + event.label;
      labels.back().to = labels.back().from + width(labels.back().text);
    } else {
      labels.push_back({x, x + width(event.label), event.label, event.label});
    }
  }
  // Those at the right edge move to the left as far as they must, and join what they meet there.
  for (std::size_t i = labels.size(); i-- > 0;) {
    const double end = i + 1 < labels.size() ? labels[i + 1].from - kMarkGap : chart_.width_ - 2.0;
    const double over = labels[i].to - end;
    if (over <= 0.0) break;
    labels[i].from -= over;
    labels[i].to -= over;
  }
  const auto is_free = [&](double from, double to) {
    return std::none_of(labels.begin(), labels.end(), [&](const MarkLabel& label) {
      return from < label.to + kMarkGap && to > label.from - kMarkGap;
    });
  };
  for (const Span& span : wide) {
    const double from = xs_.At(std::max(span.from, xs_.low())), to = xs_.At(std::min(span.to, xs_.high()));
    const double left = 0.5 * (from + to - width(span.label)), right = left + width(span.label);
    if (left >= from && is_free(left, right)) labels.push_back({left, right, span.label, span.label});
  }
  return labels;
}

std::string SvgChart::Picture::Ticks() const {
  std::string svg = "<g class=\"ticks\">";
  for (const Tick& tick : ys_.ticks()) {
    const double y = ys_.At(tick.value);
    svg += Segment(kLeft, y, right_, y, "grid");
    svg += Text(kLeft - 6.0, y + 4.0, "tick", "end", tick.label);
  }
  for (const Tick& tick : xs_.ticks()) {
    const double x = xs_.At(tick.value);
    svg += Segment(x, bottom_, x, bottom_ + 4.0, "axis");
    const double half = 0.5 * kMarkCharacter * static_cast<double>(tick.label.size());
    svg += Text(std::min(x, chart_.width_ - half), bottom_ + 17.0, "tick", "middle", tick.label);
  }
  return svg + "</g>";
}

/// A view of its own, so that a zoom changes nothing but what it shows; a little larger than the axes, so
/// that nothing on them is cut.
std::string SvgChart::Picture::PlotOpening() const {
  constexpr double kRim = 3.0;
  const std::string x = Coordinate(kLeft - kRim), y = Coordinate(top_ - kRim);
  const std::string width = Coordinate(right_ - kLeft + 2.0 * kRim);
  const std::string height = Coordinate(bottom_ - top_ + 2.0 * kRim);
  return fmt::format(
      "<svg class=\"plot\" x=\"{0}\" y=\"{1}\" width=\"{2}\" height=\"{3}\" viewBox=\"{0} {1} {2} {3}\" "
      "preserveAspectRatio=\"none\">",
      x, y, width, height);
}

std::string SvgChart::Picture::Drawn(const Series& series) const {
  const std::string named = fmt::format(" data-s=\"{}\"", HtmlText(series.legend));
  switch (series.kind) {
    case Series::Kind::kLine:
      return Lines(series, named);
    case Series::Kind::kPoints:
      return Dots(series, named);
    case Series::Kind::kBand:
      return Areas(series, named);
    case Series::Kind::kBars:
      return Boxes(series);
    case Series::Kind::kVerticalLimit: {
      const double x = xs_.At(series.x[0]);
      return Segment(x, top_, x, bottom_, series.style.c_str(), named);
    }
    case Series::Kind::kHorizontalLimit: {
      const double y = ys_.At(series.low[0]);
      return Segment(kLeft, y, right_, y, series.style.c_str(), named);
    }
  }
  return "";
}

std::string SvgChart::Picture::Lines(const Series& series, const std::string& named) const {
  std::string svg;
  for (const auto& run : Runs(series.x, series.low, xs_, ys_, chart_.y_.logarithmic)) {
    svg +=
        fmt::format("<path class=\"{}\"{}{} d=\"{}\"/>", series.style, named,
                    series.case_index ? fmt::format(" data-case=\"{}\"", *series.case_index) : "", Path(run));
  }
  return svg;
}

/// One path of strokes without length, whose round ends are the dots: an element a case would be heavy. From
/// left to right the steps are short.
std::string SvgChart::Picture::Dots(const Series& series, const std::string& named) const {
  const bool is_many = series.x.size() > kManyPoints;  // of many dots one a pixel is seen
  std::vector<std::pair<std::int64_t, std::int64_t>> tenths;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (!std::isfinite(series.x[i]) || !std::isfinite(series.low[i])) continue;
    const double x = xs_.At(series.x[i]), y = ys_.At(series.low[i]);
    if (is_many)
      tenths.emplace_back(10 * std::llround(x), 10 * std::llround(y));
    else
      tenths.emplace_back(std::llround(10.0 * x), std::llround(10.0 * y));
  }
  std::sort(tenths.begin(), tenths.end());
  tenths.erase(std::unique(tenths.begin(), tenths.end()), tenths.end());
  std::string dots;
  std::pair<std::int64_t, std::int64_t> at = {0, 0};
  for (const auto& next : tenths) {
    const std::string dy = Step(next.second - at.second);
    dots += (dots.empty() ? "M" : "m") + Step(next.first - at.first) + (dy[0] == '-' ? "" : " ") + dy + "h0";
    at = next;
  }
  return fmt::format("<path class=\"{}\"{} d=\"{}\"/>", series.style, named, dots);
}

std::string SvgChart::Picture::Areas(const Series& series, const std::string& named) const {
  const auto lows = Runs(series.x, series.low, xs_, ys_, chart_.y_.logarithmic);
  const auto highs = Runs(series.x, series.high, xs_, ys_, chart_.y_.logarithmic);
  std::string svg;
  for (std::size_t i = 0; i < std::min(lows.size(), highs.size()); ++i) {
    std::vector<Point> outline = highs[i];
    outline.insert(outline.end(), lows[i].rbegin(), lows[i].rend());
    svg += fmt::format("<path class=\"{}\"{} d=\"{}Z\"/>", series.style, named, Path(outline));
  }
  return svg;
}

std::string SvgChart::Picture::Boxes(const Series& series) const {
  std::string svg;
  for (std::size_t i = 0; i + 1 < series.x.size(); ++i) {
    if (series.low[i] <= 0.0) continue;
    const double from = xs_.At(series.x[i]);
    const double y = ys_.At(series.low[i]);
    svg += fmt::format(
        "<rect class=\"bar\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"><title>{} to {}: {}"
        "</title></rect>",
        Coordinate(from), Coordinate(y), Coordinate(std::max(xs_.At(series.x[i + 1]) - from - 0.6, 0.6)),
        Coordinate(bottom_ - y), ReadableText(series.x[i]), ReadableText(series.x[i + 1]),
        ReadableText(series.low[i]));
  }
  return svg;
}

std::string SvgChart::Picture::AxisLabels() const {
  return Text(0.5 * (kLeft + right_), chart_.height_ - 8.0, "label", "middle", chart_.x_.label) +
         Text(4.0, 13.0, "label", "start", chart_.y_.label);
}

std::string SvgChart::Picture::Legend() const {
  std::string svg;
  for (const LegendEntry& entry : entries_) {
    const double y = kTitleRow + kLegendRow * entry.row + 9.0;
    const Series::Kind kind = entry.series->kind;
    const std::string& style = entry.series->style;
    const bool dot = kind == Series::Kind::kPoints;
    svg += kind == Series::Kind::kBand || kind == Series::Kind::kBars
               ? fmt::format("<rect class=\"{}\" x=\"{}\" y=\"{}\" width=\"18\" height=\"10\"/>", style,
                             Coordinate(entry.x), Coordinate(y - 9.0))
               : Segment(entry.x + (dot ? 12.0 : 0.0), y - 4.0, entry.x + (dot ? 12.0 : 18.0), y - 4.0,
                         style.c_str());
    svg += Text(entry.x + 22.0, y, "legend", "start", *entry.text);
  }
  return svg;
}

std::string SvgChart::Svg(const std::string& description) const { return Picture(*this).Svg(description); }

}  // namespace dispersa
