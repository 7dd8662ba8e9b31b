// The folder that a campaign leaves: its results in SQLite, and the campaign as flown beside them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/campaign/case_result.h"
#include "core/campaign/input_error.h"
#include "core/report/result_error.h"

namespace dispersa {

class Database;

/// Who flew a case, and when: the only place in the database that differs between runs.
struct ExecutionRecord {
  std::uint64_t case_index = 0;
  std::string worker;
  std::string host;
  std::string started_utc;  ///< ISO 8601
  double seconds = 0.0;     ///< wall clock
};

/// A case that was given up because it killed or hung its workers; it has no result.
struct QuarantinedCase {
  std::uint64_t case_index = 0;
  std::string reason;  ///< one sentence without names or times, so that reports do not differ between runs
};

/// Not thread-safe: one thread at a time. Other processes may read `results.sqlite` meanwhile (WAL).
/// Every method throws ResultError when the disk or the database fails; InputError, where it says so, when
/// the user named the wrong folder or case.
class ResultFolder {
 public:
  /// Makes the folder (parents too) with campaign.yaml and an empty results.sqlite.
  /// InputError if it exists and is not empty, or cannot be written.
  static ResultFolder Create(const std::filesystem::path& directory, const Campaign& campaign);
  /// Opens a folder to go on with, possibly with more cases, other requirements or another name.
  /// InputError if it holds another flight id or engine, or more cases than the campaign has.
  static ResultFolder Resume(const std::filesystem::path& directory, const Campaign& campaign);
  /// Opens a folder as it is. InputError if it is none, or its columns are not this program's.
  static ResultFolder Open(const std::filesystem::path& directory);

  ResultFolder(ResultFolder&&) noexcept;
  ResultFolder& operator=(ResultFolder&&) noexcept;
  ~ResultFolder();

  const std::filesystem::path& directory() const { return directory_; }
  /// Value of "campaign_id", "flight_id", "engine", "name", "seed", "cases" or "sampling".
  std::string Provenance(const std::string& key) const;

  /// Stores results in one transaction: all or, on an error, none. A case that is already there with the same
  /// digest is left alone; with another digest: kConflict. Lifts the quarantine of what it stores. Values
  /// that are not finite become NULL, -0 becomes 0. Returns how many were new.
  std::size_t Append(std::span<const CaseResult> results);
  /// Telemetry, one transaction. A case may have several records.
  void AppendExecution(std::span<const ExecutionRecord> records);
  /// Remembers a case as given up (again: the later reason holds).
  void Quarantine(const QuarantinedCase& quarantined);

  /// Indices that have a result, ascending.
  std::vector<std::uint64_t> PresentCases() const;
  /// Ascending by index.
  std::vector<QuarantinedCase> QuarantinedCases() const;
  bool Contains(std::uint64_t case_index) const;
  /// The stored result, NULL as NaN. InputError if there is none.
  CaseResult Load(std::uint64_t case_index) const;
  /// Calls back with each result in ascending order of index; holds one at a time.
  void ForEach(const std::function<void(const CaseResult&)>& callback) const;

 private:
  ResultFolder(std::filesystem::path directory, std::unique_ptr<Database> database);

  std::filesystem::path directory_;
  std::unique_ptr<Database> database_;
};

}  // namespace dispersa
