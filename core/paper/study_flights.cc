#include "core/paper/study_flights.h"

#include <algorithm>
#include <mutex>

#include "core/campaign/campaign_flights.h"
#include "core/optimization/parallel_for.h"

namespace dispersa {

StudyFlights FlyStudy(const Campaign& campaign, const StudyOptions& options) {
  const std::uint64_t count = options.cases > 0 ? options.cases : campaign.sampling.cases;
  const CampaignFlights flights(campaign);
  std::vector<CaseResult> results(count);
  StudyFlights study;
  study.histories.resize(std::min(count, options.histories));
  std::mutex mutex;
  std::uint64_t flown = 0;
  ParallelFor(count, static_cast<std::size_t>(std::max(options.threads, 1)), [&](std::size_t i) {
    if (i < study.histories.size()) {
      History history;
      history.step_s = options.step_s;
      results[i] = flights.FlyCase(i, &history);
      study.histories[i] = SampleFlight(history, options.columns, options.step_s);
    } else {
      results[i] = flights.FlyCase(i);
    }
    const std::lock_guard lock(mutex);
    ++flown;
    if (options.progress) options.progress(flown);
  });

  CaseColumns& cases = study.cases;
  cases.inputs.resize(InputColumns().size());
  cases.metrics.resize(MetricNames().size());
  for (const CaseResult& result : results) {
    cases.index.push_back(result.case_index);
    cases.outcome.push_back(result.outcome);
    for (std::size_t i = 0; i < result.inputs.size(); ++i) cases.inputs[i].push_back(result.inputs[i]);
    for (std::size_t i = 0; i < result.metrics.size(); ++i) cases.metrics[i].push_back(result.metrics[i]);
    if (result.outcome == Outcome::kCompleted) continue;
    cases.lost_flights.push_back(
        {result.case_index, result.outcome, result.end_time_s, result.end_stage, result.reason});
  }
  return study;
}

}  // namespace dispersa
