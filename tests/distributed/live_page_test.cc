// The data of the page of `watch --web`, made from a coordinator's answers: texts stay texts, words are those
// of the report.
#include "services/cli/live_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace dispersa::live_page_test {
namespace {

using Json = nlohmann::ordered_json;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

Json Status() {
  return Json::parse(
      R"({"campaigns": [{"id": "0123456789abcdef", "name": "smoke", "state": "flying", "done": 5,
    "total": 20, "quarantined": 2, "rate_per_s": 2.5, "eta_s": 75.0, "priority": 0, "code": null, "problem": null,
    "requirements": []}], "workers": []})");
}

Json Worker(const std::string& host) {
  return {{"id", "fedcba9876543210"}, {"host", host}, {"slots", 3}, {"state", "flying"}, {"flown", 7}};
}

TEST(LivePage, TextsOfOthersAreNoPartOfThePage) {
  Json status = Status();
  const std::string hostile = "<img src=x onerror=\"f()\">&";
  status["workers"].push_back(Worker(hostile));
  status["campaigns"][0]["problem"] = hostile;
  status["campaigns"][0]["name"] = hostile;
  status["campaigns"][0]["state"] = hostile;
  LiveParts parts = StatusParts(status);
  parts.erase("title");  // which is shown as text
  parts.merge(NoticeParts(hostile));
  for (const auto& [id, html] : parts) {
    EXPECT_THAT(html, Not(HasSubstr("<img"))) << id;
    EXPECT_THAT(html, HasSubstr("&lt;img src=x")) << id;
  }
}

TEST(LivePage, SaysHowFarItIs) {
  Json status = Status();
  EXPECT_THAT(StatusParts(status)["progress"], HasSubstr("The campaign waits for workers."));
  for (int i = 0; i < 52; ++i) status["workers"].push_back(Worker("h"));
  LiveParts parts = StatusParts(status);
  EXPECT_EQ(parts["title"], "smoke flying 5/20 – dispersa");
  for (const char* words : {"Cases are being flown.", "<progress max=\"20\" value=\"7\">",
                            "<b>5</b><span>of 20 cases flown", "<b>2.5</b>", "<b>1m15s</b>",
                            "<b>52</b><span>workers with 156 slots", "<b>2</b><span>cases quarantined"})
    EXPECT_THAT(parts["progress"], HasSubstr(words));
  EXPECT_THAT(parts["workers"], HasSubstr("and 2 more"));
  status["campaigns"][0]["code"] = 3;
  status["campaigns"][0]["state"] = "done";
  EXPECT_THAT(StatusParts(status)["progress"],
              ContainsRegex("done</span><p>Exit code 3: a requirement failed\\.</p>"));
  EXPECT_THAT(StatusParts(status)["progress"], HasSubstr("dispersa fetch 0123456789ab --out DIR"));
}

TEST(LivePage, ShowsHowRequirementsStandAndWhereTheirLimitsAre) {
  const Json tally = Json::parse(
      R"({"n": 9, "requirements": [{"metric": "pitch_error_peak_deg", "above": -0.5, "below": 0.75,
    "probability": 0.9973, "consumer_risk": 0.1, "n": 9, "failures": 4, "so_far": "fail"}], "histograms":
    [{"metric": "pitch_error_peak_deg", "n": 7, "low": 0.25, "width": 0.125, "counts": [1, 4, 2]},
     {"metric": "q_alpha_max_pa_rad", "n": 0, "low": 0, "width": 1, "counts": []}]})");
  LiveParts parts = TallyParts(tally);
  for (const char* words :
       {"<b>Pitch error, peak</b> between -0.5 and 0.75 ° for 99.73 % of flights, consumer risk 10 %",
        "4 of 9 fail pitch_error_peak_deg (fail so far)", "badge so-far fail"})
    EXPECT_THAT(parts["requirements"], HasSubstr(words));
  for (const char* words :
       {"<title>0.25 to 0.375: 1</title>", "<title>0.375 to 0.5: 4</title>", "<title>0.5 to 0.625: 2</title>",
        "limit: between -0.5 and 0.75 °", "Pitch error, peak, °",
        "histogram of 7 completed flights. 2 of 9 cases are lost or do not define the metric."})
    EXPECT_THAT(parts["histograms"], HasSubstr(words));
  EXPECT_THAT(parts["histograms"], Not(HasSubstr("Product of dynamic pressure"))) << "of no flight";
  EXPECT_TRUE(TallyParts(Json::parse(R"({"n": 0, "requirements": [], "histograms": []})")).empty())
      << "what a coordinator does not know any more stays on the page";
}

TEST(LivePage, NamesItsOwnStyleAndScriptByTheirHashes) {
  EXPECT_EQ(ContentSecurityPolicy("<style>a{}</style>b<script>f()</script>"),
            "default-src 'none'; style-src 'sha256-X1RutGBrXCt9KkSaXMK7tHftWiRscFHOhxsS8tv8hBk='; script-src "
            "'sha256-GcEEE0IkDzIP5EQ6DXZaDPORqT5RTBELX8Fyzyg9yvo='; connect-src 'self'; "
            "base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
  const std::string page = LivePage("0123");
  EXPECT_EQ(page.find("<script>"), page.rfind("<script>"));
  EXPECT_EQ(page.find("<style>"), page.rfind("<style>"));
  EXPECT_THAT(page, Not(HasSubstr("style=")));
}

}  // namespace
}  // namespace dispersa::live_page_test
