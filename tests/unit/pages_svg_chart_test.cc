#include "core/pages/svg_chart.h"

#include "core/pages/chart_scale.h"
#include "tests/test.h"
#include "tests/unit/made_up_results.h"

namespace dispersa::pages_svg_chart_test {
namespace {

using report_test::kNaN;

std::vector<std::string> Labels(const ChartScale& scale) {
  std::vector<std::string> labels;
  for (const Tick& tick : scale.ticks()) labels.push_back(tick.label);
  return labels;
}

std::size_t Count(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// Of the first line: its first point, and the sums of its steps.
std::vector<std::pair<double, double>> PointsOf(const std::string& svg) {
  const std::size_t line = svg.find("class=\"line-0\"");
  const std::size_t begin = svg.find("d=\"", line) + 3;
  const std::string path = svg.substr(begin, svg.find('"', begin) - begin);
  static const std::regex number("-?[0-9.]+");
  std::vector<std::pair<double, double>> points;
  double x = 0.0, y = 0.0;
  for (std::sregex_iterator at(path.begin(), path.end(), number), end; at != end; ++at) {
    x += std::stod(at->str());
    y += std::stod((++at)->str());
    points.emplace_back(x, y);
  }
  return points;
}

TEST(ChartScale, WidensToRoundNumbers) {
  const ChartScale scale({.label = "x"}, 0.03, 0.97, 0.0, 100.0, 5);
  EXPECT_THAT(Labels(scale), ElementsAre("0.0", "0.2", "0.4", "0.6", "0.8", "1.0"));
  EXPECT_DOUBLE_EQ(scale.At(0.5), 50.0);
  EXPECT_DOUBLE_EQ(scale.At(-7.0), 0.0);  // drawn at the edge
}

TEST(ChartScale, KeepsTheEndsThatItIsGiven) {
  const ChartScale scale({.label = "x", .low = 0.0, .high = 33.0}, -5.0, 500.0, 0.0, 330.0, 3);
  EXPECT_THAT(Labels(scale), ElementsAre("0", "10", "20", "30"));
  EXPECT_DOUBLE_EQ(scale.At(33.0), 330.0);
}

TEST(ChartScale, CountsDecades) {
  const ChartScale scale({.label = "p", .low = 0.0005, .high = 1.0, .logarithmic = true, .percent = true},
                         0.0, 0.0, 0.0, 1.0, 5);
  EXPECT_THAT(Labels(scale), ElementsAre("0.1 %", "1 %", "10 %", "100 %"));
  EXPECT_NEAR(scale.At(std::sqrt(0.0005)), 0.5, 1e-12);  // half-way in decades
}

TEST(ChartScale, DividesTheDecadesIfTheyAreFew) {
  const ChartScale scale({.label = "n", .logarithmic = true}, 230.0, 5500.0, 0.0, 1.0, 4);
  EXPECT_THAT(Labels(scale), ElementsAre("500", "1000", "2000", "5000"));
}

TEST(ChartScale, SkipsDecadesWhoseLabelsWouldRunTogether) {
  const ChartScale scale({.label = "p", .low = 1e-9, .high = 1e6, .logarithmic = true}, 0.0, 0.0, 0.0, 1.0,
                         4);
  EXPECT_THAT(Labels(scale), ElementsAre("1e-08", "0.0001", "1", "10000"));
}

TEST(ChartScale, LivesWithConstantAndMissingData) {
  EXPECT_NEAR(ChartScale({.label = "x"}, 5.0, 5.0, 0.0, 100.0, 4).At(5.0), 50.0,
              1e-9);  // rounding of the ends
  EXPECT_EQ(ChartScale({.label = "x"}, INFINITY, -INFINITY, 0.0, 100.0, 4).low(), 0.0);
}

// "S2, S3" where two ignitions are a pixel apart, "S4–S6" of more; a coast without room has no label.
TEST(SvgChart, JoinsTheLabelsThatWouldLieOverEachOther) {
  SvgChart chart({.label = "t", .low = 0.0, .high = 1000.0}, {.label = "y"});
  chart.Line({0.0, 1000.0}, {0.0, 1.0}, "line-0", "");
  chart.Shade(105.0, 110.0, "narrow");
  chart.Shade(400.0, 800.0, "coast");
  for (const auto& [time_s, name] :
       {std::pair{0.0, "S1"}, {100.0, "S2"}, {104.0, "S3"}, {996.0, "S4"}, {997.0, "S5"}, {999.0, "S6"}})
    chart.Mark(time_s, name);
  const std::string svg = chart.Svg("marks");
  EXPECT_EQ(Count(svg, "class=\"mark-label\""), 4u);
  for (const char* label : {">S1<", ">S2, S3<", ">S4–S6<", ">coast<"}) EXPECT_THAT(svg, HasSubstr(label));
  EXPECT_EQ(Count(svg, "class=\"mark\""), 6u);
  const std::size_t last = svg.find(">S4–S6<");
  const double x = std::stod(svg.substr(svg.rfind("x=\"", last) + 3));
  EXPECT_LT(x, 495.0) << "it is cut by the frame";
}

TEST(SvgChart, InterruptsALineWhereItIsUndefined) {
  SvgChart chart({.label = "x"}, {.label = "y"});
  chart.Line({0.0, 1.0, 2.0, 3.0, 4.0}, {0.0, 1.0, kNaN, 1.0, 0.0}, "line-0", "");
  const std::string svg = chart.Svg("a gap");
  EXPECT_EQ(Count(svg, "class=\"line-0\""), 2u);
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(SvgChart, ThinsWithoutLosingPeaks) {
  std::vector<double> x;
  std::vector<double> y;
  for (int i = 0; i <= 100000; ++i) {
    x.push_back(i);
    y.push_back(i == 50001 ? 1.0 : 0.0);
  }
  SvgChart with({.label = "x"}, {.label = "y", .low = 0.0, .high = 1.0}, 520, 260);
  with.Line(x, y, "line-0", "");
  const std::vector<std::pair<double, double>> points = PointsOf(with.Svg("a spike"));
  EXPECT_LE(points.size(), 8u);  // two straight lines and the spike, not one hundred thousand points
  // Without a legend or marks the plot begins 24 units from the top: there the spike's tip lies.
  EXPECT_EQ(std::count_if(points.begin(), points.end(),
                          [](const auto& point) { return std::fabs(point.second - 24.0) < 1e-9; }),
            1);
}

TEST(SvgChart, DrawsACurveWithinATenthOfAPixel) {
  std::vector<double> x, y;
  for (int i = 0; i <= 1000; ++i) {
    x.push_back(i * 0.001);
    y.push_back(std::sin(0.01 * i));
  }
  SvgChart chart({.label = "x", .low = 0.0, .high = 1.0}, {.label = "y", .low = -1.0, .high = 1.0}, 520, 260);
  chart.Line(x, y, "line-0", "");
  const std::vector<std::pair<double, double>> points = PointsOf(chart.Svg("a sine"));
  EXPECT_LT(points.size(), 160u);
  // The plot is 444 wide from 58 on and 194 high from 24 on. The drawn line is at most 0.2 pixels off the
  // curve, and its ends are rounded by 0.05; where the curve is steepest (2.2) that is 0.65 upwards.
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double at = 0.5 * (points[i].first + points[i + 1].first);
    const double drawn = 0.5 * (points[i].second + points[i + 1].second);
    EXPECT_NEAR(drawn, 24.0 + 97.0 * (1.0 - std::sin(10.0 * (at - 58.0) / 444.0)), 0.65) << at;
  }
}

TEST(SvgChart, SaysWhatItShows) {
  SvgChart chart({.label = "time, s"}, {.label = "error, °"});
  chart.Line({0.0, 1.0}, {0.0, 1.0}, "line-0", "flown");
  chart.HorizontalLimit(0.5, "limit");
  chart.Mark(0.5, "S2");
  const std::string svg = chart.Svg("error < limit");
  for (const char* text :
       {">time, s<", ">error, °<", ">flown<", ">limit<", ">S2<", "aria-label=\"error &lt; limit\""}) {
    EXPECT_THAT(svg, HasSubstr(text));
  }
}

TEST(SvgChart, NamesALimitThatLiesTooFarToBeDrawnBesideTheData) {
  SvgChart chart({.label = "x"}, {.label = "y"});
  chart.Line({1.0, 1.5, 2.0}, {0.0, 1.0, 0.5}, "line-0", "");
  chart.VerticalLimit(2.9, "near");  // less than the data's width away
  chart.VerticalLimit(10.0, "high");
  chart.VerticalLimit(-9.0, "low");
  chart.HorizontalLimit(5.0, "tall");
  const std::string svg = chart.Svg("limits");
  EXPECT_THAT(svg, HasSubstr(">near<"));
  EXPECT_THAT(svg, HasSubstr(">high (far to the right)<"));
  EXPECT_THAT(svg, HasSubstr(">low (far to the left)<"));
  EXPECT_THAT(svg, HasSubstr(">tall (far above)<"));
  EXPECT_THAT(svg, Not(HasSubstr(">10<")));      // the axis ends before it
  EXPECT_EQ(Count(svg, "class=\"limit\""), 5u);  // four in the legend, one drawn
}

// Several requirements of one metric have a limit each.
TEST(SvgChart, NamesLinesOfOneKindOnceAndCutsNoLabelOfTheAxis) {
  SvgChart chart({.label = "x"}, {.label = "y"});
  chart.Line({0.0001, 0.0008}, {0.0, 1.0}, "line-0", "");
  for (const double limit : {0.2, 0.4, 0.6}) chart.HorizontalLimit(limit, "limit");
  chart.HorizontalLimit(0.8, "limit", "allowed");
  const std::string svg = chart.Svg("limits");
  EXPECT_EQ(Count(svg, ">limit</text>"), 2u);
  EXPECT_EQ(Count(svg, "data-s=\"limit\""), 4u);
  const std::size_t last = svg.find(">0.0008</text>");
  ASSERT_NE(last, std::string::npos);
  EXPECT_LE(std::stod(svg.substr(svg.rfind("x=\"", last) + 3)) + 3.1 * 6.0, 520.0);
}

TEST(SvgChart, DrawsWithoutData) {
  SvgChart chart({.label = "x"}, {.label = "y"});
  chart.Line({}, {}, "line-0", "nothing");
  EXPECT_THAT(chart.Svg("empty"), HasSubstr("</svg>"));
}

}  // namespace
}  // namespace dispersa::pages_svg_chart_test
