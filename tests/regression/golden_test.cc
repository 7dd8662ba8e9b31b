#include "tests/regression/golden.h"

#include <cstdlib>

#include <gmock/gmock.h>

namespace dispersa::golden_test {
namespace {

class Golden : public testing::Test {
 protected:
  void SetUp() override { unsetenv("DISPERSA_REWRITE_GOLDENS"); }
  void TearDown() override { std::filesystem::remove(path_); }

  void Write(const std::string& text) { std::ofstream(path_) << text; }

  std::filesystem::path path_ =
      std::filesystem::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(Golden, EqualTextMatches) {
  Write("a\nb\n");
  EXPECT_TRUE(MatchesGolden("a\nb\n", path_));
}

TEST_F(Golden, MissingFails) {
  EXPECT_EQ(MatchesGolden("a\n", path_).message(), "no golden \"" + path_.string() + "\"");
}

TEST_F(Golden, DifferenceNamesItsLine) {
  Write("a\nb\n");
  EXPECT_EQ(MatchesGolden("a\nc\n", path_).message(), path_.string() + ":2: expected b, found c");
  EXPECT_EQ(MatchesGolden("a\n", path_).message(), path_.string() + ":2: expected b, found the end");
  EXPECT_EQ(MatchesGolden("a\nb\nc\n", path_).message(), path_.string() + ":3: expected the end, found c");
}

TEST_F(Golden, RewriteWritesAndFails) {
  setenv("DISPERSA_REWRITE_GOLDENS", "1", 1);
  EXPECT_FALSE(MatchesGolden("new\n", path_));
  unsetenv("DISPERSA_REWRITE_GOLDENS");
  EXPECT_TRUE(MatchesGolden("new\n", path_));
}

}  // namespace
}  // namespace dispersa::golden_test
