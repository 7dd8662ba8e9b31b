// Rules of the program itself: they run in this build, and say where and by what they are broken.
#include "core/math/assertion.h"

#include "core/statistics/intervals.h"
#include "tests/test.h"

namespace dispersa::math_assertion_test {
namespace {

std::string Said(const auto& action) {
  try {
    action();
  } catch (const AssertionFailed& fault) {
    return fault.what();
  }
  return "nothing";
}

TEST(Assertion, SaysWhereAndByWhichValuesItIsBroken) {
  const int n = 3;
  const double part = 0.25;
  EXPECT_EQ(Said([&] { DISPERSA_ASSERT(n == 3 && part < 1.0, n, part); }), "nothing");
  const std::string with = Said([&] { DISPERSA_ASSERT(n < 3, n, part); });
  EXPECT_TRUE(with.starts_with("engine fault: ")) << with;
  EXPECT_TRUE(with.ends_with("math_assertion_test.cc:" + std::to_string(__LINE__ - 2) +
                             ": n < 3 does not hold, n, part: 3 0.25"))
      << with;
  EXPECT_TRUE(Said([&] { DISPERSA_ASSERT(n < 3); }).ends_with(": n < 3 does not hold"));
}

TEST(Assertion, RulesOfTheLibraryRunInTheReleaseBuild) {
  const std::string said = Said([] { ClopperPearsonLower(7, 5, 0.95); });
  EXPECT_TRUE(said.starts_with("engine fault: core/statistics/intervals.cc:")) << said;
  EXPECT_TRUE(said.ends_with("n, events, confidence: 5 7 0.94999999999999996")) << said;
}

}  // namespace
}  // namespace dispersa::math_assertion_test
