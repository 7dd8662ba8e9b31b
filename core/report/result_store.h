// Where results go: a result folder, or memory in a simulation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/campaign/case_result.h"

namespace dispersa {

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

/// Each method is durable against the end of this process when it returns. ResultFolder says what they mean.
class ResultStore {
 public:
  virtual ~ResultStore() = default;
  virtual std::size_t Append(std::span<const CaseResult> results) = 0;
  virtual void AppendExecution(std::span<const ExecutionRecord> records) = 0;
  virtual void Quarantine(const QuarantinedCase& quarantined) = 0;
  virtual std::vector<std::pair<std::uint64_t, Digest>> Fingerprints() const = 0;
};

}  // namespace dispersa
