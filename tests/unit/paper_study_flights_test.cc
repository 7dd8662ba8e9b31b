// Campaigns flown in process: the same cases as a campaign's, for any number of threads.
#include "core/paper/study_flights.h"

#include "core/campaign_yaml/load.h"
#include "core/cases/campaign_flights.h"
#include "tests/test.h"

namespace dispersa::paper_study_flights_test {
namespace {

const Campaign& Smoke() {
  static const Campaign campaign = LoadCampaign(DISPERSA_CAMPAIGNS "/smoke.yaml");
  return campaign;
}

TEST(PaperStudyFlights, AreTheCampaignsCasesForAnyNumberOfThreads) {
  StudyOptions options;
  options.cases = 3;
  options.histories = 1;
  options.columns = {FindHistoryColumn("pitch_error_deg")};
  options.threads = 2;
  std::uint64_t reported = 0;
  options.progress = [&](std::uint64_t done) { reported = std::max(reported, done); };
  const StudyFlights flown = FlyStudy(Smoke(), options);
  EXPECT_EQ(reported, 3u);
  ASSERT_EQ(flown.cases.rows(), 3u);

  const CampaignFlights flights(Smoke());
  for (std::size_t row = 0; row < 3; ++row) {
    const CaseResult expected = flights.FlyCase(row);
    EXPECT_EQ(flown.cases.index[row], row);
    EXPECT_EQ(flown.cases.outcome[row], expected.outcome);
    for (std::size_t i = 0; i < expected.inputs.size(); ++i)
      EXPECT_EQ(flown.cases.inputs[flights.rows().positions()[i]][row], expected.inputs[i]) << i;
    for (std::size_t i = 0; i < expected.metrics.size(); ++i) {
      if (std::isnan(expected.metrics[i])) {
        EXPECT_TRUE(std::isnan(flown.cases.metrics[i][row])) << MetricNames()[i];
      } else {
        EXPECT_EQ(flown.cases.metrics[i][row], expected.metrics[i]) << MetricNames()[i];
      }
    }
  }

  // The history is that of case 0: its largest error at 0.1 s steps is at most the metric, taken every tick,
  // unless the coast, which the metric leaves out, has a larger one; the attitude is held there too.
  ASSERT_EQ(flown.histories.size(), 1u);
  ASSERT_EQ(flown.histories[0].size(), 1u);
  EXPECT_GT(flown.histories[0][0].size(), 5000u);  // more than 500 s
  double largest = 0.0;
  for (std::size_t step = 0; step < 1000; ++step)  // stages 1 and 2
    largest = std::max(largest, std::fabs(flown.histories[0][0][step]));
  EXPECT_GT(largest, 0.0);
  EXPECT_LE(largest, flown.cases.metrics[MetricColumn("pitch_error_peak_deg")][0]);
}

}  // namespace
}  // namespace dispersa::paper_study_flights_test
