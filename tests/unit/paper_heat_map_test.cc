// The text of a cell of a heat map.
#include "core/paper/heat_map.h"
#include "tests/test.h"

namespace dispersa::paper_heat_map_test {
namespace {

using Region = HeatMapCell::Region;

HeatMap Sample() {
  HeatMap map;
  map.x_label = "across";
  map.y_label = "up";
  map.value_label = "error, °";
  map.x = {0.1, 1, 10};
  map.y = {2};
  map.cells = {{0.01, Region::kSound}, {1.0, Region::kLimitCycle}, {0.5, Region::kLost}};
  map.framed_x = 1;
  map.framed_y = 2;
  return map;
}

std::size_t Count(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(PaperHeatMap, CellsSayTheirRegionWithoutColour) {
  const std::string svg = HeatMapSvg(Sample(), "a map");
  EXPECT_THAT(svg, HasSubstr(">0.0100</text>"));
  EXPECT_THAT(svg, HasSubstr(">1.00 ~</text>"));
  EXPECT_THAT(svg, HasSubstr(">×</text>"));
  EXPECT_THAT(svg, Not(HasSubstr("0.500")));  // a lost flight has no value
  EXPECT_THAT(svg, HasSubstr("aria-label=\"a map\""));
}

TEST(PaperHeatMap, ShadesFollowTheLogarithmOfTheCompletedFlights) {
  HeatMap map = Sample();
  // Equal ratios from 0.01 to 1: six shades end at 0.0215, 0.0464, 0.1, 0.215, 0.464.
  map.x = {1, 2, 3, 4, 5, 6, 7};
  map.cells = {{0.01}, {0.03}, {0.05}, {0.15}, {0.3}, {0.7}, {1.0}};
  const std::string svg = HeatMapSvg(map, "");
  for (const char* shade : {"\"heat-0\"", "\"heat-1\"", "\"heat-2\"", "\"heat-3\"", "\"heat-4\""})
    EXPECT_EQ(Count(svg, shade), 1) << shade;
  EXPECT_EQ(Count(svg, "\"heat-5\""), 2);  // 0.7 and the largest itself
}

/// The height of a text, from the top.
double HeightOf(const std::string& svg, const std::string& text) {
  const std::size_t end = svg.find(">" + text + "</text>");
  EXPECT_NE(end, std::string::npos) << text;
  return std::stod(svg.substr(svg.rfind(" y=\"", end) + 4));
}

TEST(PaperHeatMap, GrowsUpwardsAndNamesTheRowOfEachCell) {
  HeatMap map = Sample();
  map.x = {1, 10};
  map.y = {2, 4, 8};
  map.cells = {{11.0}, {12.0}, {21.0}, {22.0}, {31.0}, {32.0}};
  map.framed_x = 10;
  map.framed_y = 4;
  const std::string svg = HeatMapSvg(map, "");
  for (const auto& [row, left, right] :
       {std::tuple{"2", "11.0", "12.0"}, {"4", "21.0", "22.0"}, {"8", "31.0", "32.0"}}) {
    EXPECT_EQ(HeightOf(svg, left), HeightOf(svg, row));
    EXPECT_EQ(HeightOf(svg, right), HeightOf(svg, row));
  }
  EXPECT_GT(HeightOf(svg, "2"), HeightOf(svg, "4"));
  EXPECT_GT(HeightOf(svg, "4"), HeightOf(svg, "8"));
  EXPECT_EQ(Count(svg, "heat-frame"), 1);  // of one cell, and not of its row and column
}

TEST(PaperHeatMap, OneCellIsFramedIfTheGridHasIt) {
  EXPECT_EQ(Count(HeatMapSvg(Sample(), ""), "heat-frame"), 1);
  HeatMap map = Sample();
  map.framed_x = 3;
  EXPECT_EQ(Count(HeatMapSvg(map, ""), "heat-frame"), 0);
}

TEST(PaperHeatMap, EqualOrMissingValuesDraw) {
  HeatMap map = Sample();
  map.cells = {{0.5}, {0.5}, {0.5}};
  EXPECT_EQ(Count(HeatMapSvg(map, ""), "\"heat-0\""), 3);
  map.cells = {{0.0, Region::kLost}, {0.0, Region::kLost}, {0.0, Region::kLost}};
  EXPECT_EQ(Count(HeatMapSvg(map, ""), ">×</text>"), 3);
}

}  // namespace
}  // namespace dispersa::paper_heat_map_test
