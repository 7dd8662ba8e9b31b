// Every number that a report shows.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/campaign/case_result.h"
#include "core/report/case_columns.h"
#include "core/report/dispersion_summary.h"
#include "core/report/lost_flight.h"
#include "core/report/requirement_summary.h"
#include "core/report/result_folder.h"
#include "core/statistics/summary.h"

namespace dispersa {

/// What a campaign comes to, worst last.
enum class CampaignVerdict { kPass, kInconclusive, kFail, kIncomplete };
/// "pass", "inconclusive", "fail", "incomplete".
const char* CampaignVerdictName(CampaignVerdict verdict);
/// The contract's exit code: 0, 4, 3, 5.
int VerdictExitCode(CampaignVerdict verdict);

struct MetricSummary {
  std::string name;  ///< without the prefix
  Summary statistics;
};

struct WorstCase {
  std::uint64_t case_index = 0;
  std::optional<double> value;  ///< none: undefined
  Outcome outcome = Outcome::kCompleted;
};

struct WorstCases {
  std::string metric;
  std::vector<WorstCase> cases;  ///< one lost flight, if any, then the worst of the others
};

struct CampaignSummary {
  std::string name;
  std::string id;
  std::string flight_id;
  std::uint64_t seed = 0;
  std::uint64_t cases = 0;  ///< asked for
  std::uint64_t flown = 0;
  SamplingMethod sampling = SamplingMethod::kMonteCarlo;
  std::string engine;
  std::string vehicle;
  std::string reference;
  Orbit reference_orbit;  ///< that the optimiser reached with it
  std::string autopilot;
  CampaignVerdict verdict = CampaignVerdict::kIncomplete;
  std::array<std::uint64_t, kOutcomeCount> outcomes{};
  std::vector<LostFlight> lost_flights;  ///< the first 20 that were not completed
  std::vector<MetricSummary> metrics;    ///< in the order of MetricNames()
  std::vector<RequirementSummary> requirements;
  std::vector<QuarantinedCase> quarantined;
  std::vector<WorstCases> worst_cases;
  std::vector<DispersionSummary> dispersions;
  std::optional<CaseResult> nominal;  ///< flown without dispersions, when it was flown
};

/// From what is stored, without flying anything (so without `nominal`).
CampaignSummary BuildSummary(const ResultFolder& folder, const Campaign& campaign);
/// The same from columns that hold at least the inputs of DispersedInputs(campaign).
CampaignSummary BuildSummary(const ResultFolder& folder, const Campaign& campaign, const CaseColumns& cases);

/// Metrics of the requirements first, then those that any report shows in full.
std::vector<std::string> KeyMetrics(const Campaign& campaign);

/// What re-flies a case, for a shell in the result folder: no report holds the folder's path.
std::string ReplayCommand(std::uint64_t case_index);

/// The contents of summary.json: schema "dispersa/summary/1", two spaces of indent, a final newline.
std::string SummaryJson(const CampaignSummary& summary);

}  // namespace dispersa
