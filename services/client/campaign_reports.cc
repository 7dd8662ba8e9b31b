#include "services/client/campaign_reports.h"

#include <algorithm>
#include <string>

namespace dispersa {

CampaignSummary MakeReports(const ResultFolder& folder, const Campaign& campaign, int threads,
                            const ReflownFlights& reflown, Observer& observer) {
  ReportOptions options;
  options.threads = std::max(threads, 1);
  options.histories = !reflown.none;
  options.history_cases = reflown.envelope;
  options.progress = [&](const std::string& what, std::uint64_t done, std::uint64_t total) {
    if (observer.ShouldStop()) throw Interrupted();
    observer.Show(what, done, total);
  };
  CampaignSummary summary = WriteReports(folder, campaign, options);
  observer.EndPhase();
  return summary;
}

}  // namespace dispersa
