// The destination of results: a result folder, or memory in a simulation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/campaign/case_range.h"
#include "core/campaign/case_result.h"

namespace dispersa {

/// Worker and times of a case: the only place in the database that differs between runs.
struct ExecutionRecord {
  std::uint64_t case_index = 0;
  std::string worker;
  std::string host;
  std::string started_utc;  ///< ISO 8601 (empty: unknown)
  double seconds = 0.0;     ///< wall clock (NaN: unknown)
};

/// Name of an unknown worker. Cases in a folder of an older release have it.
inline constexpr char kUnknownWorker[] = "unknown";

/// "node1@rack7": the workers with these keys on this host.
inline std::string NameOnHost(const std::string& keys, const std::string& host) { return keys + "@" + host; }

/// Whether `name` denotes the worker "node1_5f3a..." on `host`: by its full name, by its keys and host
/// ("node1@rack7"), or by its keys ("node1").
inline bool IsMeantBy(const std::string& name, const std::string& worker, const std::string& host) {
  const std::size_t at = name.find('@');  // in no worker's name, and in no name of keys
  if (at != std::string::npos)
    return name.substr(at + 1) == host && worker.starts_with(name.substr(0, at) + "_");
  return worker == name || worker.starts_with(name + "_");
}

/// A result as a worker returned it.
struct Claim {
  std::string worker;
  std::uint64_t case_index = 0;
  Digest fingerprint;
  bool is_dispute = false;  ///< true: another worker's result of this case, with other bits, was accepted
  std::string host = {};    ///< of the worker; empty: unknown
};

/// A case that killed or hung its workers: it has no result and is not flown any more.
struct QuarantinedCase {
  std::uint64_t case_index = 0;
  std::string reason;  ///< one sentence without names or times, so that reports of two runs are equal
};

/// When a method returns, its effect survives the end of this process. ResultFolder documents the methods.
class ResultStore {
 public:
  virtual ~ResultStore() = default;
  /// All or nothing: a result without a known worker could not be disowned later.
  virtual void Store(std::span<const CaseResult> results, std::span<const ExecutionRecord> records) = 0;
  virtual void Quarantine(const QuarantinedCase& quarantined) = 0;
  /// The cases that it is for; none: all of the campaign.
  virtual std::optional<CaseShare> ItsShare() const { return std::nullopt; }
  virtual std::vector<std::pair<std::uint64_t, Digest>> Fingerprints() const = 0;
  /// The stored result of a case that has one.
  virtual CaseResult Load(std::uint64_t case_index) const = 0;
  /// Every stored result, ascending by index.
  virtual void ForEach(const std::function<void(const CaseResult&)>& callback) const = 0;
  /// Number of cases planned before the first case was flown.
  virtual std::int64_t PlannedCases() const = 0;
  /// Numbers of cases at which verdicts were read, ascending.
  virtual std::vector<std::int64_t> PastLooks() const = 0;
  /// The worker that returned the result of a case.
  virtual std::optional<std::string> WorkerOf(std::uint64_t case_index) const = 0;
  /// Records that these results were flown again and confirmed.
  virtual void AppendAudits(std::span<const Claim> claims) = 0;
  virtual void ForEachUnaudited(const std::function<void(const Claim&)>& callback) const = 0;
  /// Removes all results of the workers that `worker` denotes. Returns the indices of their cases.
  virtual std::vector<std::uint64_t> Disown(const std::string& worker) = 0;
};

}  // namespace dispersa
