// The result folder of a campaign: its results in SQLite, and the campaign as flown.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/campaign/case_result.h"
#include "core/input/input_error.h"
#include "core/results/folder_lock.h"
#include "core/results/result_error.h"
#include "core/results/result_store.h"

namespace dispersa {

class Database;

/// Of the tables, as SQLite's user_version. 1 (stored as 0): without `audits`. 2: with it; rows hold all
/// inputs. 3: rows hold those that the campaign sets, and the table `nominal` the others. 4: a row digest
/// covers the metrics that the version knows (Metric::since), so that later ones damage no row. 5: with
/// `events`, which the row digest covers. 6: with the input weather_sounding.
inline constexpr int kRowVersion = 6;
/// Numbers of the last inputs that the rows of a version know: a row digest covers no later ones.
constexpr int LastInputOf(int version) { return version < 6 ? 106 : 107; }

/// What a table of cases holds beside outcomes and digests.
struct RowShape {
  RowInputs inputs;
  MetricList list;                   ///< names and positions of the metrics in the results
  std::vector<std::size_t> metrics;  ///< positions of the stored ones
  int version = kRowVersion;
  /// Of inputs, by position, in folders of older releases.
  std::map<std::size_t, std::string> former_names = {};
};

/// A verdict that was read.
struct LookRecord {
  std::string requirements_id;  ///< Campaign's, at the time
  std::string requirement;      ///< RequirementLine()
  std::int64_t n = 0;
  std::int64_t failures = 0;
  std::string verdict;
};

/// Used by one thread at a time. Other processes may read `results.sqlite` meanwhile (WAL). Every method
/// throws ResultError if the disk or the database fails. Some throw InputError, as they say, if the user
/// named the wrong folder or case.
class ResultFolder : public ResultStore {
 public:
  /// Makes the folder, with its parents, with campaign.yaml and an empty results.sqlite. Throws InputError if
  /// it exists and is not empty, cannot be written, or another process writes it. It is locked while the
  /// object lives. `lock` is the caller's lock, if it has one already. `share`: none is for all cases.
  static ResultFolder Create(const std::filesystem::path& directory, const Campaign& campaign,
                             std::optional<FolderLock> lock = {}, std::optional<CaseShare> share = {});
  /// Opens a folder to go on with, possibly with more cases, other requirements or another name. If the
  /// campaign has own metrics that were not measured, every case is flown again. InputError if it holds
  /// another flight id or engine, or more cases than the campaign has. Rows that are damaged are removed, so
  /// that their cases are flown again. Locked as by Create.
  static ResultFolder Resume(const std::filesystem::path& directory, const Campaign& campaign,
                             std::optional<FolderLock> lock = {});
  /// Opens a folder for reading, without a lock. InputError if it is not a result folder, or if this program
  /// has other columns.
  static ResultFolder Open(const std::filesystem::path& directory);

  ResultFolder(ResultFolder&&) noexcept;
  ResultFolder& operator=(ResultFolder&&) noexcept;
  ~ResultFolder() override;

  const std::filesystem::path& directory() const { return directory_; }
  /// Number of stages for which the results have columns: kUsualStages or kMaxStages.
  std::size_t stages() const { return shape_.list.stages(); }
  /// The inputs that the rows hold, and the constants beside them.
  const RowInputs& inputs() const { return shape_.inputs; }
  /// Names and positions of the metrics in the results.
  const MetricList& metric_list() const { return shape_.list; }
  /// Positions of the stored metrics: those of the vehicle, of the control law and of the campaign.
  const std::vector<std::size_t>& metrics() const { return shape_.metrics; }
  /// The campaign's own metrics as they were measured. Their expressions are not parsed.
  const std::vector<OwnMetric>& own_metrics() const { return own_metrics_; }
  /// The highest index that was flown, with or without the campaign's own metrics.
  std::optional<std::uint64_t> LastCase() const;
  /// Cases that were flown without all of the campaign's own metrics.
  std::uint64_t UnmeasuredCount() const;
  /// Value of "campaign_id", "flight_id", "engine", "name", "seed", "cases", "sampling". Three values are
  /// kept as they were before the first case: "planned_cases", "requirements_id" and "requirements"
  /// (RequirementLine() each). ResultError if it is not there.
  std::string Provenance(const std::string& key) const;

  /// Records once that verdicts were read from the first n cases. The record is about reading, not about
  /// flights. So a report of a folder that nobody flies may add one.
  void RecordLook(const LookRecord& look) const;
  /// What was required and planned before the first case of a folder whose results this one took, if it is
  /// not what the campaign requires and plans, and the verdicts that were read of it.
  void TakePlanOf(const ResultFolder& from, const Campaign& campaign);
  /// All of them, by number of cases.
  std::vector<LookRecord> Looks() const;
  /// Numbers of cases at which any verdict was read, ascending.
  std::vector<std::int64_t> PastLooks() const override;
  std::int64_t PlannedCases() const override;
  std::optional<CaseShare> ItsShare() const override;

  /// Stores results in one transaction: all or, on an error, none. A case that is there with the same digest
  /// is left alone. Another digest is an error (kConflict), and so are other constants than the campaign's.
  /// Stored cases leave the quarantine. Values that are not finite become NULL, -0 becomes 0. Returns the
  /// number of new ones.
  std::size_t Append(std::span<const CaseResult> results);
  /// From now on no other process may write here. InputError if one does.
  void Lock();
  /// Results as Append does, and one record of each, in one transaction.
  void Store(std::span<const CaseResult> results, std::span<const ExecutionRecord> records) override;
  /// Remembers a case as quarantined. If it is already, the later reason holds.
  void Quarantine(const QuarantinedCase& quarantined) override;

  /// Cases that have a result.
  std::uint64_t CaseCount() const;
  /// Indices that have a result, ascending.
  std::vector<std::uint64_t> PresentCases() const;
  /// The same with the fingerprint that was stored with each.
  std::vector<std::pair<std::uint64_t, Digest>> Fingerprints() const override;
  std::optional<std::string> WorkerOf(std::uint64_t case_index) const override;
  /// The worker of each case: calls back with worker, host and case, in no order.
  void ForEachFlier(const std::function<void(const std::string& worker, const std::string& host,
                                             std::uint64_t case_index)>& callback) const;
  void AppendAudits(std::span<const Claim> claims) override;
  void ForEachUnaudited(const std::function<void(const Claim&)>& callback) const override;
  std::vector<std::uint64_t> Disown(const std::string& worker) override;
  /// Rows that are not as they were written.
  std::uint64_t CountDamaged() const { return DamagedRows().size(); }
  /// Rows that Resume found damaged and removed.
  const std::vector<std::uint64_t>& damaged() const { return damaged_; }
  /// Ascending by index.
  std::vector<QuarantinedCase> QuarantinedCases() const;
  bool Contains(std::uint64_t case_index) const;
  /// The stored result, with NULL as NaN. Throws InputError if there is none, ResultError if its row does not
  /// fit its fingerprint.
  CaseResult Load(std::uint64_t case_index) const override;
  /// Calls back with each result in ascending order of index, one at a time.
  void ForEach(const std::function<void(const CaseResult&)>& callback) const override;

 private:
  ResultFolder(std::filesystem::path directory, std::unique_ptr<Database> database);
  std::size_t Insert(std::span<const CaseResult> results);
  void Insert(std::span<const ExecutionRecord> records);
  std::vector<std::uint64_t> DamagedRows() const;
  void MeasureOwn(const Campaign& campaign);
  void ReadColumnsOfTable();
  void Remove(const std::vector<std::uint64_t>& cases);

  std::filesystem::path directory_;
  RowShape shape_;
  std::vector<OwnMetric> own_metrics_;
  bool has_unmeasured_ = false;  ///< cases were flown before without all of the campaign's own metrics
  std::optional<FolderLock> lock_;
  std::unique_ptr<Database> database_;
  std::vector<std::uint64_t> damaged_;
};

}  // namespace dispersa
