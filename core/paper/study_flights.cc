#include "core/paper/study_flights.h"

#include <algorithm>

#include "core/cases/campaign_flights.h"
#include "core/flight/flight_inputs.h"

namespace dispersa {

StudyFlights FlyStudy(const Campaign& campaign, const StudyOptions& options) {
  const std::uint64_t count = options.cases > 0 ? options.cases : campaign.sampling.cases;
  const CampaignFlights flights(campaign);
  std::vector<CaseResult> results(count);
  StudyFlights study;
  study.histories.resize(std::min(count, options.histories));
  std::vector<CaseOrder> orders;
  for (std::uint64_t i = 0; i < count; ++i)
    orders.push_back({i, i < study.histories.size() ? options.step_s : 0.0});
  std::uint64_t flown = 0;
  flights.FlyCases(orders, options.threads, [&](std::size_t i, CaseResult result, const History& history) {
    results[i] = std::move(result);
    if (i < study.histories.size())
      study.histories[i] = SampleFlight(history, options.columns, options.step_s);
    ++flown;
    if (options.progress) options.progress(flown);
  });

  CaseColumns& cases = study.cases;
  const std::vector<std::size_t>& inputs = flights.rows().positions();
  cases.inputs.resize(InputCount(flights.rows().column_class()));
  if (!results.empty()) cases.metrics.resize(results.front().metrics.size());
  for (const std::size_t input : flights.rows().constants())
    cases.inputs[input] = std::vector<double>(results.size(), flights.rows().constant(input));
  for (const CaseResult& result : results) {
    cases.index.push_back(result.case_index);
    cases.outcome.push_back(result.outcome);
    for (std::size_t i = 0; i < inputs.size(); ++i) cases.inputs[inputs[i]].push_back(result.inputs[i]);
    for (std::size_t i = 0; i < result.metrics.size(); ++i) cases.metrics[i].push_back(result.metrics[i]);
    if (result.outcome == Outcome::kCompleted) continue;
    cases.lost_flights.push_back(
        {result.case_index, result.outcome, result.end_time_s, result.end_stage, result.reason});
  }
  return study;
}

}  // namespace dispersa
