// Lines of a daemon that come by thousands.
#include "services/log/log_limits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace dispersa::log_limits_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(LogLimits, OfOneKindSixtyLinesAMinuteAndThenTheirCount) {
  LogLimits limits;
  int written = 0;
  for (int i = 0; i < 372; ++i)
    written += limits.Take("worker {} joined", "worker w" + std::to_string(i) + " joined", 5.0);
  EXPECT_EQ(written, 60);
  EXPECT_TRUE(limits.Take("worker {} left", "worker w1 left", 6.0)) << "of another kind";
  EXPECT_THAT(limits.TakeCounts(64.9), IsEmpty()) << "the minute is not over";
  EXPECT_THAT(limits.TakeCounts(65.0),
              ElementsAre("… and 312 more like it in the last minute: worker w371 joined"));
  EXPECT_THAT(limits.TakeCounts(200.0), IsEmpty()) << "said once";
  EXPECT_TRUE(limits.Take("worker {} joined", "worker w1 joined", 201.0));
}

TEST(LogLimits, ALineWithoutAKindIsAlwaysWritten) {
  LogLimits limits;
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(limits.Take("", "text", 1.0));
  EXPECT_THAT(limits.TakeCounts(100.0), IsEmpty());
}

}  // namespace
}  // namespace dispersa::log_limits_test
