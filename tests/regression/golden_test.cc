#include "tests/regression/golden.h"
#include "tests/test.h"

namespace dispersa::golden_test {
namespace {

class Golden : public testing::Test {
 protected:
  void SetUp() override {
    if (const char* rewrite = std::getenv("DISPERSA_REWRITE_GOLDENS")) rewrite_ = rewrite;
    unsetenv("DISPERSA_REWRITE_GOLDENS");
  }
  void TearDown() override {
    std::filesystem::remove(path_);
    if (rewrite_) setenv("DISPERSA_REWRITE_GOLDENS", rewrite_->c_str(), 1);
  }

  void Write(const std::string& text) { std::ofstream(path_) << text; }
  std::string Difference(const std::string& actual) const { return MatchesGolden(actual, path_).message(); }

  std::optional<std::string> rewrite_;  ///< what the environment says to the other tests of this program
  std::filesystem::path path_ = std::filesystem::path(testing::TempDir()) /
                                testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(Golden, EqualTextMatches) {
  Write("a 1\nb 2\n");
  EXPECT_TRUE(MatchesGolden("a 1\nb 2\n", path_));
}

TEST_F(Golden, MissingFails) { EXPECT_EQ(Difference("a 1\n"), "no golden \"" + path_.string() + "\""); }

TEST_F(Golden, DifferenceNamesItsEntry) {
  Write("# text\n[case 0]\na 1\nb 2\n[case 1]\na 3\nb a whole sentence\n");
  EXPECT_EQ(Difference("# text\n[case 0]\na 1\nb 2\n[case 1]\na 3\nb another sentence\n"),
            "golden DifferenceNamesItsEntry case 1 b: expected a whole sentence, found another sentence; 0 "
            "more differ");
  EXPECT_EQ(Difference("# text\n[case 0]\na 7\nb 2\n[case 1]\na 4\nb 5\n"),
            "golden DifferenceNamesItsEntry case 0 a: expected 1, found 7; 2 more differ");
}

TEST_F(Golden, DifferenceNamesWhatIsMissingOrNew) {
  Write("[case 0]\na 1\nb 2\n");
  EXPECT_EQ(Difference("[case 0]\nb 2\n"),
            "golden DifferenceNamesWhatIsMissingOrNew case 0 a: expected 1, found nothing; 0 more differ");
  EXPECT_EQ(Difference("[case 0]\na 1\nb 2\nc 3\n[case 1]\na 4\n"),
            "golden DifferenceNamesWhatIsMissingOrNew case 0 c: expected nothing, found 3; 1 more differ");
}

TEST_F(Golden, AnotherOrderOrCommentFailsToo) {
  Write("a 1\nb 2\n");
  const char kText[] =
      "golden AnotherOrderOrCommentFailsToo: equal entries, but other lines or another order";
  EXPECT_EQ(Difference("b 2\na 1\n"), kText);
  EXPECT_EQ(Difference("# new\na 1\nb 2\n"), kText);
  EXPECT_EQ(Difference("a 1\nb 2\nb 2\n"), kText);
}

TEST_F(Golden, RewriteWritesAndFails) {
  setenv("DISPERSA_REWRITE_GOLDENS", "1", 1);
  EXPECT_FALSE(MatchesGolden("new 1\n", path_));
  unsetenv("DISPERSA_REWRITE_GOLDENS");
  EXPECT_TRUE(MatchesGolden("new 1\n", path_));
}

}  // namespace
}  // namespace dispersa::golden_test
