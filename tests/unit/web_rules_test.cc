// Rules of the web application: where a login goes on, which label names a version, what is found, in which
// order.
#include "services/web/pages.h"
#include "services/web/web_parts.h"
#include "services/web/web_server.h"
#include "tests/distributed/http_client.h"
#include "tests/test.h"

namespace dispersa::web_rules_test {
namespace {

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

TEST(Trend, HasTheLastSixtyOfThoseThatJudgedTheMetricAndAreSearchedFor) {
  std::vector<CampaignRow> rows;
  for (std::uint64_t order = 1; order <= 63; ++order) {
    rows.push_back(Row(order));
    rows.back().owner = order == 63 ? "bob" : "ann";
    rows.back().requirements.insert(rows.back().requirements.begin(),
                                    {"alpha", "alpha words", 0.5, 10, 9, {}, {}, "fail"});
    rows.back().requirements.back().failures = static_cast<std::int64_t>(order);
  }
  rows[60].has_ended = false;
  const std::string page = TrendPage(IndexOf(rows), "q_max_pa", "ann");
  EXPECT_THAT(page, HasSubstr("The last 60 of 61 campaigns."));
  EXPECT_THAT(page, HasSubstr("62 of 100"));
  EXPECT_THAT(page, HasSubstr(">2 of 100"));
  EXPECT_THAT(page, Not(HasSubstr(">1 of 100"))) << "the sixty-first";
  EXPECT_THAT(page, Not(HasSubstr("63 of 100"))) << "of bob";
  EXPECT_THAT(page, Not(HasSubstr("61 of 100"))) << "it has not ended";
  EXPECT_THAT(page, Not(HasSubstr("9 of 10<"))) << "of another metric";
}

// The chart's scale is from the least of all, rounded down, to 1, on a height of 216.
TEST(Trend, EachPointHasItsOwnShareAndItsOwnLimit) {
  CampaignRow first = Row(1), second = Row(2);
  first.requirements = {{"m", "words", 0.5, 10, 1, 0.8, 0.95, "pass"}};
  second.requirements = {{"m", "words", 0.95, 10, 4, 0.55, 0.65, "fail"}};
  const std::string page = TrendPage(IndexOf({first, second}), "m", "");
  const auto y = [](double share) {
    char text[16];
    std::snprintf(text, sizeof text, "%.1f", 230.0 - (share - 0.5) / 0.5 * 216.0);
    return std::string(text);
  };
  EXPECT_THAT(page, HasSubstr("<circle class=\"pass\" cx=\"316.5\" cy=\"" + y(0.9) + "\""));
  EXPECT_THAT(page, HasSubstr("<circle class=\"fail\" cx=\"765.5\" cy=\"" + y(0.6) + "\""));
  EXPECT_THAT(page, AllOf(HasSubstr(">P</text></a>"), HasSubstr(">F</text></a>")));
  EXPECT_THAT(page, HasSubstr("<path class=\"limit\" d=\"M302.5 " + y(0.5)));
  EXPECT_THAT(page, HasSubstr("<path class=\"limit\" d=\"M751.5 " + y(0.95)));
  EXPECT_THAT(page, HasSubstr("d=\"M316.5 " + y(0.8) + "V" + y(0.95)));
  for (const double share : {0.5, 0.6, 0.7, 0.8, 0.9, 1.0})
    EXPECT_THAT(page, HasSubstr("<path class=\"grid\" d=\"M92 " + y(share) + "H990\"/>")) << share;
  EXPECT_THAT(page, HasSubstr("id=" + first.id + "&amp;id=" + second.id + "\">to the one before"));
}

// Its scale reaches from the least to the greatest bound or limit, on round numbers.
TEST(Trend, ABoundStandsAgainstItsOwnLimits) {
  CampaignRow rows[] = {Row(1), Row(2), Row(3)};
  rows[0].requirements = {{"q_max_pa", "words", 0.5, 10, 1, {}, {}, "pass", 110.0, {120.0}}};
  rows[1].requirements = {{"q_max_pa", "words", 0.5, 10, 4, {}, {}, "fail", 105.0, {90.0, 104.0}}};
  rows[2].requirements = {{"q_max_pa", "words", 0.5, 10, 4, {}, {}, "inconclusive", {}, {100.0}}};
  const std::string page = TrendPage(IndexOf({rows[0], rows[1], rows[2]}), "q_max_pa", "");
  const std::string chart = page.substr(0, page.find("Share of flights that meet"));
  const auto y = [](double value) {
    char text[16];
    std::snprintf(text, sizeof text, "%.1f", 230.0 - (value - 90.0) / 30.0 * 216.0);
    return std::string(text);
  };
  EXPECT_THAT(chart, HasSubstr("<circle class=\"pass\" cx=\"241.7\" cy=\"" + y(110.0) + "\""));
  EXPECT_THAT(chart, HasSubstr("<circle class=\"fail\" cx=\"541.0\" cy=\"" + y(105.0) + "\""));
  EXPECT_THAT(chart, HasSubstr("<circle class=\"inconclusive\" cx=\"840.3\" cy=\"230.0\""));
  for (const std::string& limit :
       {"M227.7 " + y(120.0), "M527.0 " + y(90.0), "M527.0 " + y(104.0), "M826.3 " + y(100.0)})
    EXPECT_THAT(chart, HasSubstr("<path class=\"limit\" d=\"" + limit)) << limit;
  EXPECT_THAT(chart, HasSubstr(">120 Pa</text>"));
  rows[0].requirements[0].bound = rows[1].requirements[0].bound = {};
  const std::string without = TrendPage(IndexOf({rows[0], rows[1], rows[2]}), "q_max_pa", "");
  EXPECT_THAT(without, Not(HasSubstr("Bound against limit"))) << "where none is known";
}

TEST(Trend, MetricsAreCountedOfCampaignsThatHaveEnded) {
  CampaignRow flying = Row(3), other = Row(4, "alpha");
  flying.has_ended = false;
  const std::string page = TrendPage(IndexOf({Row(1), Row(2), flying, other}), "", "");
  EXPECT_THAT(page, HasSubstr(">q_max_pa</a></h2>\n<p class=\"soft\">2 campaigns</p>\n<figure "
                              "class=\"wide\"><svg class=\"chart trend\""));
  EXPECT_THAT(page, HasSubstr(">alpha</a></h2>\n<p class=\"soft\">1 campaign</p>\n<figure "
                              "class=\"wide\"><svg class=\"chart trend\""));
}

TEST(Search, LooksAtEachLabelAtTheOwnerAndAtTheState) {
  CampaignRow one = Row(1), other = Row(2);
  one.labels = {"commit=1A", "branch=main"};
  one.owner = "Ann";
  other.labels = {"commit=2b"};
  other.state = "flying";
  other.owner = "bob";
  const CampaignIndex index = IndexOf({one, other});
  const auto found = [&](const std::string& text) {
    std::string orders;
    for (const CampaignRow* row : index.Search(text)) orders += std::to_string(row->order);
    return orders;
  };
  EXPECT_EQ(found("commit=1a"), "1");
  EXPECT_EQ(found("branch=main"), "1");
  EXPECT_EQ(found("commit=2b"), "2");
  EXPECT_EQ(found("ann"), "1");
  EXPECT_EQ(found("flying"), "2");
  EXPECT_EQ(found("commit"), "21") << "the last launched first";
}

TEST(List, HasAPageForEachFiftyThatAreFound) {
  std::vector<CampaignRow> rows;
  for (std::uint64_t order = 1; order <= 150; ++order) {
    rows.push_back(Row(order));
    rows.back().owner = order <= 51 ? "ann" : "bob";
  }
  rows[0].attempts = 7;
  const CampaignIndex index = IndexOf(rows);
  const std::string page = ListPage(index, "ann", 2);
  EXPECT_THAT(page, HasSubstr("page 2 of 2"));
  EXPECT_THAT(page, HasSubstr("name1<"));
  EXPECT_THAT(page, Not(HasSubstr("name2<")));
  EXPECT_THAT(page, HasSubstr("<td class=\"n\">7</td>"));
  EXPECT_THAT(page, HasSubstr("/?q=ann&amp;page=1")) << "the other page of what was searched for";
  EXPECT_THAT(ListPage(index, "bob", 1), HasSubstr("page 1 of 2"));
  EXPECT_THAT(ListPage(index, "name14", 1), Not(HasSubstr("class=\"pages\"")));
}

TEST(Campaign, IsNoneOfTheOthersOfItsDesign) {
  CampaignRow one = Row(1), other = Row(2), unlike = Row(3);
  one.design_id = other.design_id = "d";
  unlike.design_id = "e";
  const CampaignIndex index = IndexOf({one, other, unlike});
  const std::string part = CampaignPart(index, one, false);
  EXPECT_THAT(part, HasSubstr(">1 here; the report counts"));
  EXPECT_THAT(part, HasSubstr("name2"));
  EXPECT_THAT(part, HasSubstr("dispersa fetch 1aaaaaaaaaaa --out DIR"));
  EXPECT_THAT(CampaignPart(index, unlike, false), Not(HasSubstr("Other campaigns")));
}

TEST(Campaign, ATimeIsInSecondsMinutesOrHours) {
  CampaignRow row = Row(1);
  row.has_ended = false;
  row.state = "flying";
  const auto left = [&](double eta_s) {
    row.eta_s = eta_s;
    const std::string part = CampaignPart({}, row, false);
    const std::size_t end = part.find("</b><span>left"), begin = part.rfind("<b>", end) + 3;
    return part.substr(begin, end - begin);
  };
  EXPECT_EQ(left(89.0), "89 s");
  EXPECT_EQ(left(90.0), "2 min");
  EXPECT_EQ(left(5399.0), "90 min");
  EXPECT_EQ(left(5400.0), "1.5 h");
}

TEST(Campaign, OneAttemptAndOneQuarantinedCaseAreShown) {
  CampaignRow row = Row(1);
  EXPECT_THAT(CampaignPart({}, row, false), Not(HasSubstr("attempts at this design")));
  EXPECT_THAT(CampaignPart({}, row, false), Not(HasSubstr("cases quarantined")));
  row.attempts = 1;
  row.quarantined = 1;
  EXPECT_THAT(CampaignPart({}, row, false), HasSubstr("<b>1</b><span>attempts at this design"));
  EXPECT_THAT(CampaignPart({}, row, false), HasSubstr("<b>1</b><span>cases quarantined"));
}

TEST(Parts, AVerdictStandsWhenACampaignIsDone) {
  CampaignRow row = Row(1);
  EXPECT_THAT(StandingOfRow(row), HasSubstr("pass"));
  for (const char* state : {"waiting", "flying", "reporting", "cancelled", "failed", "refused"}) {
    row.state = state;
    EXPECT_THAT(StandingOfRow(row), HasSubstr(state));
    EXPECT_THAT(StandingOfRow(row), Not(HasSubstr("pass"))) << state;
  }
}

TEST(Parts, BytesAreInTheLargestUnitThatHasThem) {
  EXPECT_EQ(BytesText(999'400), "999 kB");
  EXPECT_EQ(BytesText(1'000'000), "1.0 MB");
  EXPECT_EQ(BytesText(999'900'000), "999.9 MB");
  EXPECT_EQ(BytesText(1'000'000'000), "1.0 GB");
}

TEST(Difference, HasTheRequirementsOfBothEachOnce) {
  CampaignRow a = Row(1), b = Row(2);
  a.requirements = {{"m", "only A", 0.9, 10, 1, {}, {}, "pass"}, {"m", "both", 0.9, 10, 2, {}, {}, "pass"}};
  b.requirements = {{"m", "both", 0.9, 10, 3, {}, {}, "fail"}, {"m", "only B", 0.9, 10, 4, {}, {}, "fail"}};
  const CampaignFile none = [](const std::string&, const std::string&) {
    return std::optional<std::string>();
  };
  const std::string page = DifferencePage(a, b, none);
  const std::size_t first = page.find("only A"), second = page.find("both"), third = page.find("only B");
  EXPECT_LT(first, second);
  EXPECT_LT(second, third);
  EXPECT_EQ(page.find("both", second + 1), std::string::npos);
  EXPECT_LT(page.find("2 of 10 fail"), page.find("3 of 10 fail"));
  EXPECT_THAT(page, HasSubstr("4 of 10 fail"));
}

// Over a socket on loopback.
class ServerRules : public testing::Test {
 protected:
  void Start(const std::vector<CampaignRow>& rows, const std::string& token = "") {
    port_ = FreePort();
    server_ = std::make_unique<WebServer>(
        WebOptions{{"127.0.0.1", port_}, token, false}, [](const std::string& id, const std::string& name) {
          return name == "report.html" ? std::optional("<p>report of " + id.substr(0, 1) + "</p>")
                                       : std::nullopt;
        });
    server_->Set(std::make_shared<CampaignIndex>(IndexOf(rows)));
  }
  std::string Get(const std::string& path, const std::string& header = "") {
    return AskHttp(port_,
                   "GET " + path + " HTTP/1.1\r\nHost: localhost\r\n" + header + "Connection: close\r\n\r\n");
  }

  std::uint16_t port_ = 0;
  std::unique_ptr<WebServer> server_;
};

TEST_F(ServerRules, APageHasAsManyDigitsAsItNeeds) {
  std::vector<CampaignRow> rows;
  for (std::uint64_t order = 1; order <= 600; ++order) rows.push_back(Row(order));
  Start(rows);
  EXPECT_THAT(Get("/?page=12"), HasSubstr("page 12 of 12"));
  EXPECT_THAT(Get("/?page=3"), HasSubstr("page 3 of 12"));
  EXPECT_THAT(Get("/?page=1x"), HasSubstr("page 1 of 12"));
}

TEST_F(ServerRules, ADifferenceIsFromTheOlderToTheYounger) {
  Start({Row(1), Row(2)});
  for (const char* path : {"/difference?id=1&id=2", "/difference?id=2&id=1"}) {
    const std::string page = Get(path);
    EXPECT_LT(page.find("name1"), page.find("name2")) << path;
    EXPECT_NE(page.find("name2"), std::string::npos) << path;
  }
}

TEST_F(ServerRules, OnlyACampaignThatIsDoneHasAReport) {
  CampaignRow done = Row(1), cancelled = Row(2), flying = Row(3);
  cancelled.state = "cancelled";
  flying.state = "flying";
  flying.has_ended = false;
  Start({done, cancelled, flying});
  EXPECT_THAT(Get("/campaign/" + done.id), HasSubstr("Open the report"));
  EXPECT_THAT(Get("/campaign/" + done.id + "/report"), HasSubstr("<p>report of 1</p>"));
  for (const CampaignRow& row : {cancelled, flying}) {
    EXPECT_THAT(Get("/campaign/" + row.id), Not(HasSubstr("Open the report"))) << row.state;
    EXPECT_THAT(Get("/campaign/" + row.id + "/report"), HasSubstr("This campaign has no report"))
        << row.state;
  }
}

TEST_F(ServerRules, ASessionIsFoundAmongOtherCookies) {
  const std::string token = "0123456789abcdef";
  Start({Row(1)}, token);
  const std::string body = "next=%2F%09%2Fevil.example&token=" + token;
  const std::string answer =
      AskHttp(port_,
              "POST /login HTTP/1.1\r\nHost: localhost\r\nContent-Type: "
              "application/x-www-form-urlencoded\r\nConnection: close\r\nContent-Length: " +
                  std::to_string(body.size()) + "\r\n\r\n" + body);
  EXPECT_THAT(answer, HasSubstr("Location: /\r\n"));
  const std::size_t at = answer.find("dispersa=");
  ASSERT_NE(at, std::string::npos);
  const std::string cookie = answer.substr(at, answer.find(';', at) - at);
  EXPECT_THAT(Get("/", "Cookie: a=1;b=2;  " + cookie + "; c=3\r\n"), HasSubstr("name1"));
  EXPECT_THAT(Get("/", "Cookie: x" + cookie + "\r\n"), Not(HasSubstr("name1")));
}

}  // namespace
}  // namespace dispersa::web_rules_test
