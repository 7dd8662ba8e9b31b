// The ledger of attempts. It records which campaigns flew a design, with seed, number of cases and the
// verdict on each requirement. It is a text file with one JSON object in each line, in the parent of the
// result folders. Each result folder has a copy of the lines that its verdict depends on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"

namespace dispersa {

/// File names: in the parent of the result folders, and in each result folder.
inline constexpr char kLedgerName[] = "dispersa-attempts.jsonl";
inline constexpr char kFolderLedgerName[] = "attempts.jsonl";

/// A requirement of an attempt.
struct RequirementRecord {
  std::string limit;  ///< LimitText(): metric, side and limit, by which attempts are matched
  std::string line;   ///< RequirementLine()
  double probability = 0.0;
  double consumer_risk = 0.0;
  VerdictPlan plan;
  std::int64_t failures = 0;  ///< among the cases that count; a case without a result is a failure
  std::string verdict;        ///< by its own plan: "pass", "fail", "inconclusive"; empty: none yet
};

struct AttemptRecord {
  std::string id;         ///< Campaign::id: the same campaign again is the same attempt
  std::string design_id;  ///< Campaign::design_id
  std::string name;
  std::string engine;
  std::uint64_t seed = 0;
  std::int64_t planned = 0;  ///< planned number of cases
  std::int64_t cases = 0;    ///< cases that count: up to the last one assigned; 0: none yet
  std::string begun_utc;
  std::string fresh;    ///< reason of `--fresh`: earlier attempts do not count; empty: they do
  std::string verdict;  ///< StandingVerdictName(); empty: it has not ended
  /// Number of other designs that were flown here before, and of those with this seed.
  std::int64_t earlier_designs = 0;
  std::int64_t earlier_designs_of_seed = 0;
  std::vector<RequirementRecord> requirements;
};

/// The record of a campaign before its first case.
AttemptRecord RecordOf(const Campaign& campaign);

/// Reads and writes the file. Throws ResultError on an error of the file system, for a link, pipe or device,
/// and for a file of another user in a folder that everybody may write.
class AttemptLedger {
 public:
  explicit AttemptLedger(std::filesystem::path file) : file_(std::move(file)) {}

  /// Each attempt once, in the order of beginning. The last line of an attempt counts. Lines that are not
  /// records are skipped.
  std::vector<AttemptRecord> Read() const;
  /// Adds a line. Several processes may do so at the same time.
  void Write(const AttemptRecord& record) const;

 private:
  std::filesystem::path file_;
};

/// Enters a campaign in the ledger of the folder `root` before its first case. The copy in its result folder
/// also gets the earlier attempts at the same design. If `root` cannot be written, the error text is
/// returned. The campaign then flies, and only its own folder records the attempt.
std::optional<std::string> BeginAttempt(const std::filesystem::path& root,
                                        const std::filesystem::path& results, const Campaign& campaign,
                                        const std::string& begun_utc, const std::string& fresh = "");
/// Writes the present record into both files. Returns the error text if `root` cannot be written.
std::optional<std::string> NoteAttempt(const std::filesystem::path& root,
                                       const std::filesystem::path& results, const AttemptRecord& record);

}  // namespace dispersa
