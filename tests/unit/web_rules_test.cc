// Rules of the web application that need no server: where a login goes on, which label names a version, what
// is found, in which order.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/web/pages.h"
#include "services/web/web_parts.h"

namespace dispersa::web_rules_test {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(LocalPath, IsAPathOfThisServer) {
  for (const char* path : {"/", "/trend?metric=q_max_pa&q=branch%3Dmain", "/campaign/0a?part=1#end", "/a//b",
                           "/~ann/!$'()*+,;="})
    EXPECT_EQ(LocalPath(path), path);
}

TEST(LocalPath, NothingThatABrowserReadsAsAnotherHost) {
  for (const std::string path :
       {"", "trend", "https://evil.example/", "//evil.example", "/\\evil.example", "\\/evil.example",
        "/\t/evil.example", "/\n/evil.example", "/\r/evil.example", "\t//evil.example", " //evil.example",
        "/ /evil.example", "/\x01/evil.example", "/\x1f/evil.example", "/\x7f/evil.example",
        "/\xc2\xa0/evil.example", "/a\\b", "/a\tb"})
    EXPECT_EQ(LocalPath(path), "/") << path;
  EXPECT_EQ(LocalPath(std::string("/\0/evil.example", 15)), "/");
}

CampaignRow Row(std::uint64_t order, const std::string& metric = "q_max_pa") {
  CampaignRow row;
  row.id = std::to_string(order) + std::string(63, 'a');
  row.name = "name" + std::to_string(order);
  row.state = "done";
  row.has_ended = true;
  row.verdict = "pass";
  row.order = order;
  row.requirements = {{metric, "words", 0.9, 100, 3, 0.92, 0.99, "pass"}};
  return row;
}

CampaignIndex IndexOf(const std::vector<CampaignRow>& rows) {
  std::vector<CampaignIndex::Row> shared;
  for (const CampaignRow& row : rows) shared.push_back(std::make_shared<CampaignRow>(row));
  return CampaignIndex(std::move(shared));
}

// A campaign that was launched again from a later commit is known by that one.
TEST(Trend, AVersionIsTheLastCommitThatWasGiven) {
  CampaignRow again = Row(1), once = Row(2), none = Row(3);
  again.labels = {"commit=old0000000", "branch=main", "commit=0123456789abcdef", "by=ann"};
  once.labels = {"recommit=wrong", "commit=fedcba"};
  none.labels = {"branch=main"};
  const std::string page = TrendPage(IndexOf({again, once, none}), "q_max_pa", "");
  EXPECT_THAT(page, HasSubstr("<code>0123456789</code>")) << "its first ten digits";
  EXPECT_THAT(page, HasSubstr("<code>fedcba</code>"));
  EXPECT_THAT(page, HasSubstr("<code>3aaaaaaa</code>")) << "without a commit the first digits of the id";
  EXPECT_THAT(page, Not(HasSubstr("old0000000")));
  EXPECT_THAT(page, Not(HasSubstr("wrong")));
}

}  // namespace
}  // namespace dispersa::web_rules_test
