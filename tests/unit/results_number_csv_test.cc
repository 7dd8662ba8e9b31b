// Files of numbers as text: what is read, and what is none.
#include "core/results/number_csv.h"
#include "tests/test.h"

namespace dispersa::results_number_csv_test {

TEST(NumberCsv, HasAValueForEachColumn) {
  const auto table = ReadNumberCsv("time_s,mach\n0,-1.5\n1e-3,2\n");
  ASSERT_TRUE(table);
  EXPECT_THAT(table->columns, ElementsAre("time_s", "mach"));
  EXPECT_THAT(table->rows, ElementsAre(ElementsAre(0.0, -1.5), ElementsAre(0.001, 2.0)));
}

TEST(NumberCsv, AnEmptyCellIsUndefined) {
  const auto table = ReadNumberCsv("a,b,c\n,1,\n");
  ASSERT_TRUE(table);
  ASSERT_EQ(table->rows.size(), 1u);
  EXPECT_TRUE(std::isnan(table->rows[0][0]));
  EXPECT_EQ(table->rows[0][1], 1.0);
  EXPECT_TRUE(std::isnan(table->rows[0][2]));
}

TEST(NumberCsv, MayHaveNoRows) {
  const auto table = ReadNumberCsv("a\n");
  ASSERT_TRUE(table);
  EXPECT_TRUE(table->rows.empty());
}

TEST(NumberCsv, AnythingElseIsNone) {
  for (const char* text :
       {"", "a", "a,b\n1,2", "a,b\n1\n", "a,b\n1,2,3\n", "a\nx\n", "a\n1x\n", "a,\n1,2\n", "\n"})
    EXPECT_FALSE(ReadNumberCsv(text)) << text;
}

}  // namespace dispersa::results_number_csv_test
