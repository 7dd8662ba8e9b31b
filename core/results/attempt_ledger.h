// The attempts at one design: which campaigns flew it, with which seeds and numbers of cases, and what came
// of each requirement. A text file of one JSON object a line, in the folder that result folders are made in,
// and a copy of what mattered beside the results.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"

namespace dispersa {

/// Beside the result folders, and in each of them.
inline constexpr char kLedgerName[] = "dispersa-attempts.jsonl";
inline constexpr char kFolderLedgerName[] = "attempts.jsonl";

/// One requirement of an attempt.
struct RequirementRecord {
  std::string limit;  ///< LimitText(): metric, side and limit, by which attempts are matched
  std::string line;   ///< RequirementLine()
  double probability = 0.0;
  double consumer_risk = 0.0;
  VerdictPlan plan;
  bool by_default = false;
  std::int64_t failures = 0;  ///< of the cases that count; one without a result is a failure
  std::string verdict;        ///< by its own plan: "pass", "fail", "inconclusive"; empty: none yet
};

struct AttemptRecord {
  std::string id;         ///< Campaign::id: the same campaign again is the same attempt
  std::string design_id;  ///< Campaign::design_id
  std::string name;
  std::string engine;
  std::uint64_t seed = 0;
  std::int64_t planned = 0;  ///< cases that it was to fly
  std::int64_t cases = 0;    ///< that count: up to the last one assigned; 0: none yet
  std::string begun_utc;
  std::string fresh;    ///< why it starts anew in spite of earlier attempts; empty: it does not
  std::string verdict;  ///< StandingVerdictName(); empty: it has not ended
  /// Other designs that were flown here before it, and how many of those with its seed.
  std::int64_t earlier_designs = 0;
  std::int64_t earlier_designs_of_seed = 0;
  std::vector<RequirementRecord> requirements;
};

/// As it is before the first case.
AttemptRecord RecordOf(const Campaign& campaign);

/// Throws ResultError when it cannot be read or written.
class AttemptLedger {
 public:
  explicit AttemptLedger(std::filesystem::path file) : file_(std::move(file)) {}

  /// Every attempt once, in the order in which they began, each as it was written last. Lines that are no
  /// record are left out.
  std::vector<AttemptRecord> Read() const;
  /// Adds a line; several processes may do so at once.
  void Write(const AttemptRecord& record) const;

 private:
  std::filesystem::path file_;
};

/// Enters a campaign, before its first case, in the ledger of the folder `root` (and completes the copy in
/// its result folder by the attempts at the same design that began before it). When `root` cannot be written
/// the reason is returned: the campaign flies all the same, and only its own folder remembers it.
std::optional<std::string> BeginAttempt(const std::filesystem::path& root,
                                        const std::filesystem::path& results, const Campaign& campaign,
                                        const std::string& begun_utc, const std::string& fresh = "");
/// Notes in both what has come of it.
std::optional<std::string> NoteAttempt(const std::filesystem::path& root,
                                       const std::filesystem::path& results, const AttemptRecord& record);

}  // namespace dispersa
