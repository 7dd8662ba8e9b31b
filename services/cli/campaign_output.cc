#include "services/cli/campaign_output.h"

#include <fmt/format.h>

#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "core/results/text.h"
#include "services/program/option_values.h"

namespace dispersa {

void AddReflownOptions(CLI::App& command, ReflownFlights& flights) {
  const std::map<std::string, std::uint64_t> words = {{"all", std::numeric_limits<std::uint64_t>::max()}};
  command.add_flag("--no-histories", flights.none,
                   "make the report without flying cases again; for gates that read only verdicts");
  command
      .add_option("--envelope", flights.envelope,
                  "number of first cases, or all, to fly again for the percentiles over time; the extreme "
                  "cases of every metric are flown too")
      ->transform(WholeNumber(1, UINT64_MAX))
      ->transform(CLI::Transformer(words).description("{all}"))
      ->default_str(std::to_string(flights.envelope));
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
    fmt::print(
        "{}: {}{}: {}\n", requirement.verdict, RequirementWords(requirement),
        requirement.bound ? fmt::format(", bound {}", ReadableText(*requirement.bound)) : std::string(),
        requirement.sentence);
  }
  fmt::print("report: {}\nresult: {}\n", (directory / "report.html").string(), directory.string());
}

}  // namespace dispersa
