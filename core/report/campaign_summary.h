// Every number that a report shows.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/campaign/case_result.h"
#include "core/report/result_folder.h"
#include "core/statistics/summary.h"

namespace dispersa {

/// What a campaign comes to, worst last.
enum class CampaignVerdict { kPass, kInconclusive, kFail, kIncomplete };
/// "pass", "inconclusive", "fail", "incomplete".
const char* CampaignVerdictName(CampaignVerdict verdict);
/// The contract's exit code: 0, 4, 3, 5.
int ExitCode(CampaignVerdict verdict);

struct MetricSummary {
  std::string name;  ///< without the prefix
  Summary statistics;
};

/// A lost flight (any outcome but completed) is a failure of every requirement.
struct RequirementSummary {
  std::string metric;
  bool below = true;  ///< else above
  double limit = 0.0;
  double probability = 0.0;
  double consumer_risk = 0.0;
  std::int64_t n = 0;
  std::int64_t failures = 0;
  std::int64_t lost_flights = 0;        ///< of the failures
  std::string verdict;                  ///< "pass", "fail" or "inconclusive"
  double success_lower = 0.0;           ///< one-sided confidence bounds of the success probability
  double success_upper = 1.0;
  std::optional<std::int64_t> cases_needed;  ///< at least so many cases in all, if no further one fails
  std::string sentence;                 ///< the verdict in words
};

struct WorstCase {
  std::uint64_t case_index = 0;
  std::optional<double> value;  ///< none: undefined
  Outcome outcome = Outcome::kCompleted;
};

struct WorstCases {
  std::string metric;
  std::vector<WorstCase> cases;  ///< worst first; lost flights before all others
};

/// A dispersion as declared against the inputs as the flights applied them, in the unit of the column.
struct DispersionSummary {
  std::string dispersion;      ///< its name
  std::string input;           ///< column, without the prefix
  std::string declared;        ///< "normal, 3 sigma 0.25", ...
  std::optional<double> expected_mean;  ///< of the declared distribution
  std::optional<double> expected_std;
  Summary drawn;
};

struct CampaignSummary {
  std::string name;
  std::string id;
  std::string flight_id;
  std::uint64_t seed = 0;
  std::uint64_t cases = 0;     ///< asked for
  std::uint64_t flown = 0;
  std::string sampling;        ///< "monte_carlo", ...
  bool independent = true;     ///< cases independent and identically distributed: verdicts are confidence
                               ///< statements; false: a design study
  std::string engine;
  std::string vehicle;
  std::string reference;
  std::string autopilot;
  CampaignVerdict verdict = CampaignVerdict::kIncomplete;
  std::array<std::uint64_t, kOutcomeCount> outcomes{};
  std::vector<MetricSummary> metrics;  ///< in the order of MetricNames()
  std::vector<RequirementSummary> requirements;
  std::vector<QuarantinedCase> quarantined;
  std::vector<WorstCases> worst_cases;
  std::vector<DispersionSummary> dispersions;
  std::optional<CaseResult> nominal;   ///< flown without dispersions, when it was flown
};

/// From what is stored, without flying anything (so without `nominal`).
CampaignSummary BuildSummary(const ResultFolder& folder, const Campaign& campaign);

/// The contents of summary.json: schema "dispersa/summary/1", two spaces of indent, a final newline.
std::string SummaryJson(const CampaignSummary& summary);

}  // namespace dispersa
