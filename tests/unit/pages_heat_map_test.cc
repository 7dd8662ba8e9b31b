// The cells of a heat map.
#include "core/pages/heat_map.h"

#include "tests/test.h"

namespace dispersa::pages_heat_map_test {
namespace {

using Region = HeatPoint::Region;

TEST(HeatMap, CellsSayTheirRegionWithoutColour) {
  const std::string table = HeatMapTable(
      "up ↑ across →", {{0.1, 2, 0.01}, {1, 2, 1.0, Region::kLimitCycle, true}, {10, 2, 0.5, Region::kLost}});
  EXPECT_THAT(table,
              HasSubstr("<th scope=\"row\" class=\"n\">2</th><td class=\"n\"><b class=\"heat-0\">0.01</b>"
                        "</td><td class=\"n\"><b class=\"heat-5 cycle framed\">1~</b></td><td "
                        "class=\"n\"><b class=\"lost\">×</b></td></tr>"));
  EXPECT_THAT(table, HasSubstr("up ↑ across →</th><th scope=\"col\" class=\"n\">0.1</th><th scope=\"col\" "
                               "class=\"n\">1</th><th scope=\"col\" class=\"n\">10</th>"));
}

TEST(HeatMap, ShadesFollowTheLogarithmOfTheCompletedFlights) {
  // Equal ratios from 0.01 to 1: six shades end at 0.0215, 0.0464, 0.1, 0.215, 0.464.
  const std::string table = HeatMapTable("", {{1, 1, 0.01},
                                              {2, 1, 0.03},
                                              {3, 1, 0.05},
                                              {4, 1, 0.15},
                                              {5, 1, 0.3},
                                              {6, 1, 0.7},
                                              {7, 1, 1.0},
                                              {8, 1, 1000.0, Region::kLost}});
  for (const char* cell :
       {"0\">0.01<", "1\">0.03<", "2\">0.05<", "3\">0.15<", "4\">0.3<", "5\">0.7<", "5\">1<"})
    EXPECT_THAT(table, HasSubstr(std::string("heat-") + cell));
}

TEST(HeatMap, GrowsUpwardsAndLeavesWhatWasNotFlownEmpty) {
  const std::string table = HeatMapTable("", {{1, 2, 11}, {10, 4, 22}, {1, 8, 31}, {10, 8, 32}});
  EXPECT_THAT(table,
              ContainsRegex("row\" class=\"n\">8<.*>31<.*>32<.*\n.*row\" class=\"n\">4<.*n\"></td>.*>22<.*"
                            "\n.*row\" class=\"n\">2<.*>11<.*n\"></td>"));
}

TEST(HeatMap, EqualOrMissingValuesDraw) {
  EXPECT_THAT(HeatMapTable("", {{1, 1, 0.5}, {2, 1, 0.5}}),
              HasSubstr("heat-0\">0.5</b></td><td class=\"n\"><b "
                        "class=\"heat-0\">0.5<"));
  EXPECT_THAT(HeatMapTable("", {{1, 1, 0.0}}), HasSubstr("heat-0\">0<"));
}

}  // namespace
}  // namespace dispersa::pages_heat_map_test
