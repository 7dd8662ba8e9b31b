// Every number that a report shows.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/analysis/dispersion_summary.h"
#include "core/analysis/drivers.h"
#include "core/analysis/event_summary.h"
#include "core/analysis/injection_summary.h"
#include "core/analysis/load_check.h"
#include "core/analysis/requirement_summary.h"
#include "core/analysis/standing.h"
#include "core/campaign/campaign.h"
#include "core/campaign/case_result.h"
#include "core/results/case_columns.h"
#include "core/results/lost_flight.h"
#include "core/results/result_folder.h"
#include "core/statistics/percentiles.h"
#include "core/statistics/summary.h"

namespace dispersa {

/// The verdict of a campaign by itself. A study's points are chosen, so it neither passes nor fails. But a
/// point that violates a requirement is reported.
enum class CampaignVerdict {
  kPass,
  kNothingJudged,
  kInconclusive,
  kNotEvidence,
  kStudy,
  kStudyViolated,
  kFail,
  kIncomplete
};
/// "pass", "nothing_judged", "inconclusive", "not_evidence", "study", "study", "fail", "incomplete".
const char* CampaignVerdictName(CampaignVerdict verdict);

struct MetricSummary {
  std::string name;    ///< without the prefix
  Summary statistics;  ///< of the flights that were completed
  double skewness = kUndefined;
  std::vector<Percentile> percentiles;  ///< each with its confidence limits
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
  std::uint64_t cases = 0;      ///< requested; in a campaign that stops when decided: flown until it stopped
  std::uint64_t max_cases = 0;  ///< largest number that it could have flown
  std::uint64_t flown = 0;
  std::uint64_t reached = 0;  ///< up to the last case that has a result
  std::uint64_t replicates = 1;
  std::uint64_t design_points = 1;  ///< of a corner, one-at-a-time, grid or list design
  SamplingMethod sampling = SamplingMethod::kMonteCarlo;
  std::string engine;
  std::string vehicle;
  std::string reference;
  Orbit reference_orbit;  ///< that the optimiser reached with it
  std::string autopilot;
  /// A control law in Python. Without it the cases cannot be flown again, so no replay command is shown.
  struct PythonLaw {
    std::string name;
    std::string sha256;
  };
  std::optional<PythonLaw> python_law;
  CampaignVerdict verdict = CampaignVerdict::kIncomplete;
  std::array<std::uint64_t, kOutcomeCount> outcomes{};
  std::vector<LostFlight> lost_flights;  ///< the first kListedLostFlights
  std::vector<MetricSummary> metrics;    ///< that the flights have, in the order of MetricNames()
  MetricList metric_list;                ///< of the nominal flight and of every result
  std::vector<OwnMetric> own_metrics;
  std::vector<RequirementSummary> requirements;
  /// A limit of the vehicle, compared with the largest load of every flown case, completed or not.
  struct Limit {
    std::string metric;  ///< of the load
    double limit = 0.0;  ///< in the metric's unit
    std::uint64_t exceeded = 0;
    std::optional<double> largest = {};  ///< largest load; none: no case defines it
    std::uint64_t largest_case = 0;
  };
  std::vector<Limit> limits;
  std::uint64_t beyond_limits = 0;  ///< flights that exceeded any
  std::vector<LoadCheck> load_checks;
  std::uint64_t near_step_limit = 0;  ///< flights whose fastest part comes near what a step resolves
  bool holm = false;                  ///< the requirements' verdicts hold together
  /// Upper bound of the probability that a campaign which misses any requirement passes them all.
  double overall_risk = 0.0;
  double any_risk = 0.0;                   ///< upper bound of the probability that any single pass is wrong
  std::string requirements_id;             ///< hash of the requirements now
  std::string registered_requirements_id;  ///< the same before the first case was flown
  std::int64_t planned_cases = 0;          ///< of the plan by which the requirements are judged
  std::vector<QuarantinedCase> quarantined;
  std::vector<WorstCases> worst_cases;
  std::vector<DispersionSummary> dispersions;
  bool is_controlled = true;                    ///< by an autopilot
  std::vector<EventSummary> events;             ///< of folders of this release
  std::optional<InjectionSummary> injection;    ///< none with fewer than two injections
  std::vector<MetricDrivers> drivers;           ///< of KeyMetrics()
  std::vector<FailureDrivers> failure_drivers;  ///< of the requirements
  /// Numbers of flights in the envelope. Percentiles come from the first cases. Minimum and maximum also come
  /// from cases that are extreme in any metric.
  struct Envelope {
    std::size_t flights = 0;
    std::size_t extreme_flights = 0;
  };
  std::optional<Envelope> envelope;
  std::optional<CaseResult> nominal;  ///< the flight without dispersions, if it was flown
  /// The verdict after earlier attempts and changes. It is no part of summary.json.
  Standing standing;
};

/// Cases that the campaign flies: where it stops, if it stops by itself. `cases` are its results.
std::uint64_t CasesToFly(const ResultFolder& folder, const Campaign& campaign, const CaseColumns& cases);

/// InputError if the folder is a share: nothing is judged of one. Reports and summaries begin with it.
void RequireWhole(const ResultFolder& folder);

/// "160 of 3000 cases have a result".
std::string MissingWords(std::uint64_t flown, std::uint64_t cases);

/// Sentences that the first screen shows before any number, after those of StandingNotes(): missing cases,
/// studies, lost flights.
std::vector<std::string> Warnings(const CampaignSummary& summary);

/// The notes, and the warnings after them. A lost nominal flight goes before all of them.
std::vector<std::string> WithWarnings(std::vector<std::string> notes, const CampaignSummary& summary);

/// The sentence for each requirement's verdict taken together.
std::string JointRiskSentence(const CampaignSummary& summary);

/// How many flights could decide all that is inconclusive, said once; empty where nothing is.
std::string AdviceTogether(const CampaignSummary& summary);

/// Records in the folder that these verdicts were read, if the campaign is complete and has verdicts.
void RecordLooks(const ResultFolder& folder, const Campaign& campaign, const CampaignSummary& summary);

/// From the stored results. It flies nothing, so `nominal` is empty.
CampaignSummary BuildSummary(const ResultFolder& folder, const Campaign& campaign);
/// The same from columns that hold at least the inputs of DispersedInputs(campaign), on at most two threads.
CampaignSummary BuildSummary(const ResultFolder& folder, const Campaign& campaign, const CaseColumns& cases,
                             int threads = 1);

/// Metrics of the requirements first, then those that every report shows in full.
std::vector<std::string> KeyMetrics(const Campaign& campaign);

/// The command that flies a case again, for a shell in the result folder. No report holds the folder's path.
std::string ReplayCommand(std::uint64_t case_index);
/// The same without the index.
std::string ReplayCommand();

/// The contents of summary.json: schema "dispersa/summary/1", two spaces of indent, a final newline.
std::string SummaryJson(const CampaignSummary& summary);

}  // namespace dispersa
