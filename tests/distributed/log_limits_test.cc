// Lines of a daemon that come by thousands.
#include "services/log/log_limits.h"

#include "services/transport/complaints.h"
#include "tests/test.h"

namespace dispersa::log_limits_test {

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

// A worker of another user beside a coordinator for a day: some lines, and no thousands.
TEST(RepeatedComplaintsTest, TheSameIsSaidEverLessOften) {
  RepeatedComplaints complaints;
  int said = 0;
  for (int second = 0; second < 86400; ++second) said += complaints.IsDue("a", second);
  EXPECT_LE(said, 1450) << "once a minute";
  EXPECT_GE(said, 1430);
  EXPECT_TRUE(complaints.IsDue("b", 86400.0)) << "another one is said at once";
  EXPECT_FALSE(complaints.IsDue("b", 86400.5));
  EXPECT_TRUE(complaints.IsDue("b", 86401.0));
  EXPECT_FALSE(complaints.IsDue("b", 86402.5));
  EXPECT_TRUE(complaints.IsDue("b", 86403.0));
  EXPECT_TRUE(complaints.IsDue("b", 90000.0)) << "it had ended";
  EXPECT_TRUE(complaints.IsDue("b", 90001.0)) << "and begins again";
  for (int i = 0; i < 100'000; ++i) complaints.IsDue(std::to_string(i), 1e6);
  EXPECT_LE(complaints.remembered(), 1000u) << "of many senders";
}

TEST(LogLimits, ALineWithoutAKindIsAlwaysWritten) {
  LogLimits limits;
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(limits.Take("", "text", 1.0));
  EXPECT_THAT(limits.TakeCounts(100.0), IsEmpty());
}

}  // namespace dispersa::log_limits_test
