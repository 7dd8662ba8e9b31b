// Results in memory instead of a result folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/results/fingerprint.h"
#include "core/results/result_error.h"
#include "core/results/result_store.h"

namespace dispersa {

class MemoryStore : public ResultStore {
 public:
  void Store(std::span<const CaseResult> results, std::span<const ExecutionRecord> records) override {
    stored += results.size();
    for (const CaseResult& result : results) rows[result.case_index] = result;
    for (const ExecutionRecord& record : records) {
      worker_of[record.case_index] = record.worker;
      host_of[record.case_index] = record.host;
      seconds[record.case_index] = record.seconds;
    }
  }
  void Quarantine(const QuarantinedCase& one) override { quarantined[one.case_index] = one.reason; }
  std::vector<std::pair<std::uint64_t, Digest>> Fingerprints() const override {
    std::vector<std::pair<std::uint64_t, Digest>> all;
    for (const auto& [case_index, result] : rows) all.emplace_back(case_index, Fingerprint(result));
    return all;
  }
  CaseResult Load(std::uint64_t case_index) const override { return rows.at(case_index); }
  void ForEach(const std::function<void(const CaseResult&)>& callback) const override {
    for (const auto& [case_index, result] : rows) callback(result);
  }
  std::int64_t PlannedCases() const override { return planned_cases; }
  std::vector<std::int64_t> PastLooks() const override { return {}; }
  std::optional<std::string> WorkerOf(std::uint64_t case_index) const override {
    const auto found = worker_of.find(case_index);
    return found == worker_of.end() ? std::nullopt : std::optional(found->second);
  }
  void AppendAudits(std::span<const Claim> claims) override {
    for (const Claim& claim : claims) audited.insert(claim.case_index);
  }
  void ForEachUnaudited(const std::function<void(const Claim&)>&) const override {}
  std::vector<std::uint64_t> Disown(const std::string& worker) override {
    std::vector<std::uint64_t> cases;
    for (const auto& [case_index, who] : worker_of)
      if (IsMeantBy(worker, who, host_of.at(case_index))) cases.push_back(case_index);
    for (const std::uint64_t case_index : cases) rows.erase(case_index), worker_of.erase(case_index);
    stored -= cases.size();
    return cases;
  }
  std::map<std::uint64_t, CaseResult> rows;
  std::map<std::uint64_t, std::string> worker_of, host_of;
  std::map<std::uint64_t, double> seconds;  ///< that each took
  std::map<std::uint64_t, std::string> quarantined;
  std::set<std::uint64_t> audited;
  std::size_t stored = 0;
  std::int64_t planned_cases = 0;
};

/// On a disk that is full, or broken, as long as somebody says so.
struct FullStore : MemoryStore {
  void Store(std::span<const CaseResult> results, std::span<const ExecutionRecord> records) override {
    Try();
    MemoryStore::Store(results, records);
  }
  std::vector<std::uint64_t> Disown(const std::string& worker) override {
    Try();
    return MemoryStore::Disown(worker);
  }
  void Try() const {
    if (problem) throw ResultError(*problem, "the disk is what it is");
  }
  std::optional<ResultError::Kind> problem;
};

}  // namespace dispersa
