#include "services/cli/campaign_output.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "core/flight/engine_version.h"
#include "core/results/metric_catalogue.h"
#include "services/log/log.h"
#include "services/program/option_values.h"

namespace dispersa {

namespace {

/// What a reader of this verdict does next.
std::string NextStep(const CampaignSummary& summary) {
  switch (summary.standing.verdict) {
    case StandingVerdict::kPass:
      return "read the report's assumptions and warnings";
    case StandingVerdict::kNothingJudged:
      return "state what must hold under 'requirements:' of the campaign file";
    case StandingVerdict::kInconclusive:
      return "fly more cases; the line above says how many";
    case StandingVerdict::kNotEvidence:
      if (summary.verdict == CampaignVerdict::kNotEvidence)
        return "disperse what the vehicle has; the lines above say what nothing reads";
      return IsIndependent(summary.sampling)
                 ? "fly the requirements as they stand with another seed, or read the reasons above"
                 : "require 'every_case: true', or sample by monte_carlo";
    case StandingVerdict::kFail:
      return "read the causes in the report; 'dispersa search' finds the smallest dispersion that fails";
    case StandingVerdict::kIncomplete:
      return summary.engine == EngineVersion()
                 ? "the same command with --resume flies what is missing"
                 : "this engine cannot go on: fly the campaign into a new folder";
  }
  return "";
}

}  // namespace

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

void AddGateOption(CLI::App& command, bool& gate) {
  command.add_flag("--gate", gate,
                   "for continuous integration: exit code 7 instead of 0 when nothing is required");
}

void AddFreshOption(CLI::App& command, std::string& reason) {
  command
      .add_option("--fresh", reason,
                  "reason why earlier attempts at this design shall not count; the report shows it")
      ->type_name("REASON");
}

void AddOpenOption(CLI::App& command, bool& open) {
  command.add_flag("--open", open, "show report.html in the browser ($BROWSER, or xdg-open)");
}

void OpenInBrowser(std::string page) {
  const char* chosen = std::getenv("BROWSER");
  std::string program = chosen != nullptr && *chosen != '\0' ? chosen : "xdg-open";
  char* const arguments[] = {program.data(), page.data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_RDWR, 0);
  pid_t pid = 0;
  const int error = posix_spawnp(&pid, arguments[0], &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) LogWarning("{}: {}; open {} yourself", program, std::strerror(error), page);
}

void PrintSummary(const CampaignSummary& summary, const std::filesystem::path& directory, bool json,
                  const std::string& if_incomplete) {
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
  for (const std::string& note : WithWarnings(StandingNotes(summary.standing, summary), summary))
    fmt::print("warning: {}\n", note);
  for (std::size_t i = 0; i < summary.requirements.size(); ++i) {
    const RequirementSummary& requirement = summary.requirements[i];
    std::string verdict = summary.standing.requirements[i].verdict;
    std::replace(verdict.begin(), verdict.end(), '_', ' ');
    const std::string bound = BoundSentence(requirement, DescribeMetric(requirement.metric).unit);
    fmt::print("{}: {}: {}{}{}\n", verdict, RequirementWords(requirement),
               JudgedSentence(requirement, summary.standing.requirements[i]), bound.empty() ? "" : " ",
               bound);
  }
  for (const LoadCheck& check : summary.load_checks) fmt::print("{}\n", LoadCheckSentence(check));
  if (const std::string advice = AdviceTogether(summary); !advice.empty()) fmt::print("{}\n", advice);
  const bool is_told = summary.standing.verdict == StandingVerdict::kIncomplete && !if_incomplete.empty();
  fmt::print("VERDICT {}, next: {}\n", StandingBadge(summary.standing),
             is_told ? if_incomplete : NextStep(summary));
  fmt::print("report: {}\nresult: {}\n", (directory / "report.html").string(), directory.string());
}

}  // namespace dispersa
