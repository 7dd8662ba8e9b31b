// The pages of the web application as texts: what they show, how they are paged and found, and that no name
// is taken for HTML.
#include "services/web/pages.h"

#include "tests/test.h"

namespace dispersa::web_pages_test {

CampaignRow Row(std::uint64_t order, const std::string& name = "table3") {
  CampaignRow row;
  const std::string digits = std::to_string(order);
  row.id = digits + std::string(64 - digits.size(), 'a');
  row.name = name;
  row.owner = "ann";
  row.state = "done";
  row.has_ended = true;
  row.verdict = "pass";
  row.cases = row.done = 1000;
  row.order = order;
  row.launched_unix_s = 1764000000;
  row.ended_unix_s = 1764000600;
  row.requirements = {{"q_max_pa", "q_max_pa below 5 for 99 % of flights at 10 % risk", 0.99, 1000, 3, 0.9925,
                       0.999, "pass"}};
  return row;
}

CampaignIndex IndexOf(std::vector<CampaignRow> rows) {
  std::vector<CampaignIndex::Row> shared;
  for (CampaignRow& row : rows) shared.push_back(std::make_shared<CampaignRow>(std::move(row)));
  return CampaignIndex(std::move(shared));
}

std::size_t Count(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(WebList, HasTheLastLaunchedFirstFiftyAPage) {
  std::vector<CampaignRow> rows;
  for (std::uint64_t i = 1; i <= 120; ++i) rows.push_back(Row(i, "campaign-" + std::to_string(i) + "."));
  const CampaignIndex index = IndexOf(std::move(rows));
  const std::string first = ListPage(index, "", 1), last = ListPage(index, "", 3);
  EXPECT_EQ(Count(first, "name=\"id\""), 50u);
  EXPECT_EQ(Count(last, "name=\"id\""), 20u);
  EXPECT_LT(first.find("campaign-120."), first.find("campaign-119."));
  EXPECT_THAT(first, Not(HasSubstr("campaign-70.")));
  EXPECT_THAT(last, HasSubstr("campaign-1."));
  EXPECT_THAT(first, HasSubstr("page 1 of 3"));
  EXPECT_THAT(first, Not(HasSubstr("newer")));
  EXPECT_THAT(last, HasSubstr("/?q=&amp;page=2"));
  EXPECT_THAT(ListPage(index, "", 99), HasSubstr("page 3 of 3"));
  EXPECT_THAT(ListPage(index, "", 0), HasSubstr("page 1 of 3"));
}

TEST(WebList, EveryWordHasToBeSomewhere) {
  CampaignRow one = Row(1, "Vega"), other = Row(2, "table3");
  one.labels = {"commit=1A2B", "branch=main"};
  one.verdict = "fail";
  other.owner = "bob";
  const CampaignIndex index = IndexOf({one, other});
  const auto names = [&](const std::string& text) {
    std::string found;
    for (const CampaignRow* row : index.Search(text)) found += row->name + " ";
    return found;
  };
  EXPECT_EQ(names(""), "table3 Vega ");
  EXPECT_EQ(names("vega"), "Vega ");
  EXPECT_EQ(names("commit=1a2b FAIL"), "Vega ");
  EXPECT_EQ(names("ann bob"), "");
  EXPECT_EQ(names("bob"), "table3 ");
  EXPECT_EQ(names("2aaa"), "table3 ");
  EXPECT_THAT(ListPage(index, "bob", 1), HasSubstr("1 of 2 campaigns have “bob”"));
}

TEST(WebList, TenThousandCampaignsTakeMuchLessThanASecond) {
  std::vector<CampaignRow> rows;
  for (std::uint64_t i = 1; i <= 10000; ++i) rows.push_back(Row(i));
  const CampaignIndex index = IndexOf(std::move(rows));
  const auto begin = std::chrono::steady_clock::now();
  ListPage(index, "ann pass", 200);
  TrendPage(index, "q_max_pa", "ann");
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(1));
}

TEST(WebIndex, AnIdIsFoundByItsFirstDigitsIfItIsTheOnlyOne) {
  const CampaignIndex index = IndexOf({Row(12), Row(13), Row(2)});
  EXPECT_EQ(index.Find("1"), nullptr);
  EXPECT_EQ(index.Find("13")->order, 13u);
  EXPECT_EQ(index.Find(Row(2).id)->order, 2u);
  EXPECT_EQ(index.Find(""), nullptr);
  EXPECT_EQ(index.Find("9"), nullptr);
}

// Names, owners, labels, problems and search words come from clients.
TEST(WebPages, ATextIsNoHtml) {
  const std::string bad = "<script>alert(1)</script>\"'&";
  CampaignRow row = Row(1, bad), other = Row(2, bad);
  row.owner = row.problem = row.engine = row.state = bad;
  row.labels = {"a=" + bad};
  row.requirements[0].words = row.requirements[0].metric = row.requirements[0].verdict = bad;
  other.has_ended = false;
  const CampaignIndex index = IndexOf({row, other});
  const CampaignFile file = [&](const std::string&, const std::string& name) {
    return std::optional<std::string>(name == "campaign.yaml" ? "name: '<script>x'\n"
                                                              : R"({"drivers": {"<script>": [
      {"input": "<script>", "index": 0.5, "low": 0.4, "high": 0.6}]}})");
  };
  for (const std::string& page :
       {ListPage(index, bad, 1), CampaignPage(index, row, true), CampaignPage(index, other, false),
        DifferencePage(row, other, file), TrendPage(index, bad, ""), TrendPage(index, "", bad),
        LoginPage(bad, true), ErrorPage(bad, bad)}) {
    EXPECT_THAT(page, Not(HasSubstr("<script>")));
    EXPECT_THAT(page, Not(HasSubstr("\"'&")));
  }
}

TEST(WebCampaign, ShowsItsVerdictItsRequirementsAndItsReport) {
  CampaignRow row = Row(1);
  row.attempts = 3;
  row.design_id = "d";
  CampaignRow same = Row(2, "again"), unlike = Row(3, "unlike");
  same.design_id = "d";
  const CampaignIndex index = IndexOf({row, same, unlike});
  const std::string page = CampaignPage(index, row, true);
  EXPECT_THAT(page, HasSubstr("href=\"/campaign/" + row.id + "/report\""));
  EXPECT_THAT(page, HasSubstr("3 of 1000"));
  EXPECT_THAT(page, HasSubstr("99.25 % to 99.9 %"));
  EXPECT_THAT(page, HasSubstr("<b>3</b><span>attempts at this design"));
  EXPECT_THAT(page, HasSubstr("again"));
  EXPECT_THAT(page, Not(HasSubstr("unlike")));
  EXPECT_THAT(page, Not(HasSubstr("data-live")));
  EXPECT_THAT(CampaignPage(index, row, false), Not(HasSubstr("/report")));
}

TEST(WebCampaign, WhileItFliesItIsAskedForAgain) {
  CampaignRow row = Row(1);
  row.has_ended = false;
  row.state = "flying";
  row.verdict = "";
  row.done = 250;
  row.rate_per_s = 12.5;
  row.eta_s = 3600.0;
  const CampaignIndex index = IndexOf({row});
  const std::string page = CampaignPage(index, row, false), part = CampaignPart(index, row, false);
  EXPECT_THAT(page, HasSubstr("data-live"));
  EXPECT_THAT(page, HasSubstr(part));
  EXPECT_THAT(part, HasSubstr("max=\"1000\" value=\"250\""));
  EXPECT_THAT(part, HasSubstr("<b>12.5</b>"));
  EXPECT_THAT(part, HasSubstr("<b>60 min</b>"));
  EXPECT_THAT(part, Not(HasSubstr("<html")));
}

// While it flies: a histogram of each key metric with its limits, and who flies.
TEST(WebCampaign, WhileItFliesShowsHistogramsAndWorkers) {
  CampaignRow row = Row(1);
  row.has_ended = false;
  row.state = "flying";
  row.done = 30;
  row.histograms = {{"pitch_error_peak_deg", 28, 0.0, 0.5, {10, 18}, {0.9}},
                    {"apogee_km", 30, 180.0, 20.0, {10, 20}, {185.0, 215.0}},
                    {"q_max_pa", 0, 0.0, 0.0, {}, {}},
                    {"deflection_limit_cycle_deg", 28, 0.0, 1e-300, {28}, {0.2}}};
  std::vector<WorkerRow> workers = {{"0123456789ab", "<b>host", "flying", 3, 17}};
  const auto part = [&] {
    return CampaignPart(CampaignIndex({std::make_shared<CampaignRow>(row)}, workers), row, false);
  };
  std::string shown = part();
  EXPECT_EQ(Count(shown, "<svg class=\"chart\""), 2u);
  for (const char* limit : {"limit 0.9<", "limit 185<", "limit 215<"}) EXPECT_THAT(shown, HasSubstr(limit));
  EXPECT_THAT(shown, HasSubstr("Limit cycle of the deflection: 0 ° in all 28 completed flights."));
  EXPECT_THAT(shown,
              HasSubstr("Pitch error, peak: histogram of 28 completed flights. 2 of 30 cases are lost"));
  EXPECT_THAT(shown, HasSubstr("histogram of 30 completed flights.</figcaption>"));
  EXPECT_THAT(shown, HasSubstr("&lt;b&gt;host"));
  EXPECT_THAT(shown, HasSubstr("<code>01234567</code>"));
  EXPECT_THAT(shown, HasSubstr(">17</td>"));
  workers.clear();
  EXPECT_THAT(part(), HasSubstr("There is no worker: the campaign waits."));
  workers.resize(53);
  EXPECT_THAT(part(), HasSubstr("and 3 more"));
  row.has_ended = true;
  EXPECT_THAT(part(), Not(HasSubstr("Workers")));
  EXPECT_THAT(part(), Not(HasSubstr("histogram of")));
}

TEST(WebDifference, NamesInputsRequirementsEngineAndDriversThatDiffer) {
  CampaignRow a = Row(1), b = Row(2);
  a.engine = "one";
  b.engine = "two";
  b.verdict = b.requirements[0].verdict = "fail";
  b.requirements[0].failures = 40;
  b.requirements.push_back({"alpha", "alpha below 2", 0.5, 10, 1, std::nullopt, std::nullopt, "pass"});
  const CampaignFile file = [&](const std::string& id,
                                const std::string& name) -> std::optional<std::string> {
    const bool is_a = id == a.id;
    if (name == "campaign.yaml") return is_a ? "gain: 1\nsame: 7\n" : "gain: 2\nsame: 7\n";
    return std::string(R"({"drivers": {"q_max_pa": [{"input": ")") + (is_a ? "wind" : "thrust") +
           R"(", "index": 0.5, "low": 0.4, "high": 0.6}]}})";
  };
  const std::string page = DifferencePage(a, b, file);
  EXPECT_THAT(page, HasSubstr("<td><code>gain</code></td><td><code>1</code></td><td><code>2</code></td>"));
  EXPECT_THAT(page, Not(HasSubstr("same")));
  EXPECT_THAT(page, HasSubstr("<tr class=\"differs\"><td>Engine</td>"));
  EXPECT_THAT(page, HasSubstr("<tr class=\"differs\"><td>Verdict</td>"));
  EXPECT_THAT(page, HasSubstr("<tr><td>Owner</td>"));
  EXPECT_THAT(page, HasSubstr("40 of 1000 fail"));
  EXPECT_THAT(page, HasSubstr("alpha below 2</td><td><span class=\"soft\">not required"));
  EXPECT_THAT(page, HasSubstr("wind 50 % <span class=\"soft\">(40 to 60)"));
  EXPECT_THAT(page, HasSubstr("thrust 50 %"));
  const CampaignFile none = [](const std::string&, const std::string&) {
    return std::optional<std::string>();
  };
  EXPECT_THAT(DifferencePage(a, b, none), HasSubstr("text cannot be read"));
}

TEST(WebTrend, FollowsOneRequirementOverVersionsOldestFirst) {
  CampaignRow first = Row(1), second = Row(2), other = Row(3), flying = Row(4);
  first.labels = {"commit=v001", "branch=main"};
  second.labels = {"commit=v002", "branch=main"};
  other.labels = {"commit=v003", "branch=try"};
  flying.has_ended = false;
  flying.labels = {"commit=v004"};
  const CampaignIndex index = IndexOf({first, second, other, flying});
  const std::string page = TrendPage(index, "q_max_pa", "branch=main");
  const std::size_t chart = page.find("<svg"), end = page.find("</svg>");
  const std::string svg = page.substr(chart, end - chart);
  EXPECT_LT(svg.find("v001"), svg.find("v002"));
  EXPECT_EQ(Count(svg, "<circle"), 2u);
  EXPECT_EQ(Count(svg, "class=\"range\""), 2u);
  EXPECT_THAT(page, Not(HasSubstr("v003")));
  EXPECT_THAT(TrendPage(index, "q_max_pa", ""), Not(HasSubstr("v004"))) << "it has judged nothing";
  EXPECT_THAT(page, HasSubstr("/difference?id=" + first.id + "&amp;id=" + second.id));
  EXPECT_THAT(TrendPage(index, "", ""), HasSubstr("/trend?metric=q_max_pa"));
  EXPECT_THAT(TrendPage(index, "alpha", ""), HasSubstr("No campaign that has ended requires it"));
}

}  // namespace dispersa::web_pages_test
