#include "services/cli/campaign_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "services/cli/progress.h"

namespace dispersa {

CampaignSummary MakeReports(const ResultFolder& folder, const Campaign& campaign, int threads, bool quiet,
                            bool histories, const std::function<void()>& check) {
  std::string phase;
  std::unique_ptr<Progress> progress;
  ReportOptions options;
  options.threads = std::max(threads, 1);
  options.histories = histories;
  options.progress = [&](const std::string& what, std::uint64_t done, std::uint64_t total) {
    if (check) check();
    if (!progress || what != phase) {
      progress.reset();
      progress = std::make_unique<Progress>(what, quiet);
      phase = what;
    }
    progress->Show(done, total);
  };
  return WriteReports(folder, campaign, options);
}

void PrintSummary(const CampaignSummary& summary, const std::filesystem::path& directory, bool json) {
  if (json) {
    auto object = nlohmann::ordered_json::parse(SummaryJson(summary));
    object["directory"] = directory.string();
    fmt::print("{}\n", object.dump(2));
    return;
  }
  fmt::print("{}: {} of {} cases flown", summary.name, summary.flown, summary.cases);
  for (int i = 0; i < kOutcomeCount; ++i) {
    const auto count = summary.outcomes[static_cast<std::size_t>(i)];
    if (count > 0) fmt::print(", {} {}", count, OutcomeName(static_cast<Outcome>(i)));
  }
  if (!summary.quarantined.empty()) fmt::print(", {} quarantined", summary.quarantined.size());
  fmt::print("\n");
  for (const std::string& warning : Warnings(summary)) fmt::print("warning: {}\n", warning);
  for (const RequirementSummary& requirement : summary.requirements) {
    fmt::print("{}: {}: {}\n", requirement.verdict, RequirementWords(requirement), requirement.sentence);
  }
  fmt::print("report: {}\nresult: {}\n", (directory / "report.html").string(), directory.string());
}

}  // namespace dispersa
