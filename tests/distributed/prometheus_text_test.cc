// A service in figures for a monitor: each figure is what its help says.
#include "services/coordinator/prometheus_text.h"

#include <fmt/format.h>

#include "made_up_service.h"
#include "services/transport/complaints.h"
#include "tests/test.h"

namespace dispersa::prometheus_text_test {

class PrometheusTextTest : public ServiceTest {
 protected:
  ServingTimes times_ = {3, 0.75, 0.5};

  /// The value behind a name, which must be there once.
  std::string Value(const std::string& name) {
    const std::string text = "\n" + PrometheusText(*service_, workforce_, times_), wanted = "\n" + name + " ";
    const std::size_t at = text.find(wanted);
    if (at == std::string::npos || text.find(wanted, at + 1) != std::string::npos) return "not there once";
    const std::size_t begin = at + wanted.size();
    return text.substr(begin, text.find('\n', begin) - begin);
  }
};

TEST_F(PrometheusTextTest, AnEmptyServiceIsAllZeros) {
  StartService();
  const auto metric = [](const char* name, const char* type, const char* help, std::uint64_t value) {
    return fmt::format("# HELP {0} {1}\n# TYPE {0} {2}\n{0} {3}\n", name, help, type, value);
  };
  const std::string text = PrometheusText(*service_, workforce_, times_);
  for (const std::string& part :
       {std::string("# HELP dispersa_campaigns Campaigns by state.\n# TYPE dispersa_campaigns gauge\n"),
        metric("dispersa_cases_done", "gauge", "Cases with a result, of all campaigns.", 0),
        metric("dispersa_cases_waiting", "gauge", "Cases that no worker has: the depth of the queue.", 0),
        metric("dispersa_cases_assigned", "gauge", "Cases that workers have.", 0),
        metric("dispersa_cases_quarantined", "gauge", "Cases that are quarantined.", 0),
        metric("dispersa_results_per_second", "gauge", "New results of all campaigns, over the last 10 s.",
               0),
        metric("dispersa_conflicts", "gauge", "Results that contradicted others.", 0),
        metric("dispersa_workers", "gauge", "Workers that are joined.", 0),
        metric("dispersa_slots", "gauge", "Threads of theirs that fly.", 0),
        metric("dispersa_reports_writing", "gauge", "Campaigns whose report is being written.", 0),
        metric("dispersa_reports_waiting", "gauge", "Campaigns that wait for their report.", 0),
        metric("dispersa_report_wait_seconds", "gauge", "Time for which the first of them has waited.", 0),
        metric("dispersa_disk_bytes", "gauge", "Bytes of all campaigns' folders.", 0),
        metric("dispersa_audits_total", "counter", "Results that were flown again.", 0),
        metric("dispersa_expelled", "gauge", "Processes, hosts and keys that may not fly here any more.", 0),
        metric("dispersa_refused_total", "counter", "Datagrams and messages that were refused.",
               Complaints())})
    EXPECT_THAT(text, HasSubstr(part));
  EXPECT_EQ(Value("dispersa_request_seconds_sum"), "0.75");
  EXPECT_EQ(Value("dispersa_request_seconds_count"), "3");
  EXPECT_EQ(Value("dispersa_round_seconds_max"), "0.5");
  EXPECT_GT(std::stod(Value("dispersa_disk_free_bytes")), 1e6);
}

TEST_F(PrometheusTextTest, ANameEndsNoLabel) {
  StartService();
  CatalogueEntry entry;
  entry.id = std::string(64, 'a');
  entry.name = "a\"b\\c\nd";
  entry.owner = "ann";
  service_->Launch(entry, "no campaign");
  EXPECT_THAT(PrometheusText(*service_, workforce_, times_),
              HasSubstr(R"(name="a\"b\\c\\x0ad",owner="ann",state="waiting"} 0)"));
}

TEST_F(PrometheusTextTest, ACaseIsCountedOnce) {
  StartService(1);
  const Campaign campaign = Smoke(100);
  const std::string flies = Launch(campaign, 1);
  Launch(Smoke(30, 2));  // waits for the first one's end
  ASSERT_TRUE(Reaches(flies, CampaignState::kFlying));
  workforce_.Join("one", 3);
  workforce_.Join("other", 2);
  const std::uint64_t assigned = MadeUpWorkforce::CasesIn(workforce_.Tick());
  ASSERT_GT(assigned, 0u);
  ASSERT_LT(assigned, 90u);
  // The last cases, which nobody has.
  for (const std::uint64_t i : {97, 98, 99})
    workforce_.Return("one", campaign.flight_id, MadeUpWorkforce::ResultOf(i));
  EXPECT_EQ(Value("dispersa_cases_done"), "3");
  EXPECT_EQ(Value("dispersa_cases_assigned"), std::to_string(assigned));
  EXPECT_EQ(Value("dispersa_cases_waiting"), std::to_string(100 - 3 - assigned + 30));
  EXPECT_EQ(Value("dispersa_workers"), "2");
  EXPECT_EQ(Value("dispersa_slots"), "5");
  EXPECT_EQ(Value("dispersa_campaigns{state=\"flying\"}"), "1");
  EXPECT_EQ(Value("dispersa_campaigns{state=\"waiting\"}"), "1");
}

TEST_F(PrometheusTextTest, AConflictStaysOverARestart) {
  StartService();
  const Campaign campaign = Smoke(5);
  const std::string id = Launch(campaign);
  ASSERT_TRUE(Reaches(id, CampaignState::kFlying));
  workforce_.Join("w");
  CaseResult result = MadeUpWorkforce::ResultOf(0);
  workforce_.Return("w", campaign.flight_id, result);
  result.end_time_s = 1.0;
  workforce_.Return("w", campaign.flight_id, result);
  workforce_.time_s += 2.0;  // it is noted once a second
  service_->Step();
  EXPECT_EQ(Value("dispersa_conflicts"), "1");
  StartService();
  EXPECT_EQ(Value("dispersa_conflicts"), "1");
}

}  // namespace dispersa::prometheus_text_test
