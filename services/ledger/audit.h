// Decides which results the coordinator flies again itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "core/results/result_store.h"

namespace dispersa {

/// Default share. A forger of 500 results passes one time in 150.
inline constexpr double kUsualAuditShare = 0.01;

struct AuditOptions {
  double share = 0.0;      ///< of the results, 0 (none) to 1
  std::uint64_t salt = 0;  ///< selects the audited results; secret, so that a forger cannot avoid the audit
  /// Audit campaigns with a plug-in too. If its results differ between machines, their workers are then
  /// expelled. Without this option the campaign is refused.
  bool with_plugins = true;
};

/// A pure state machine: takes results, and returns those to be flown again. The coordinator flies them,
/// because one forger may own two workers that agree.
class Audit {
 public:
  explicit Audit(const AuditOptions& options);

  /// Selects the first result of each worker, and the given share of all results.
  void Consider(const Claim& claim);
  /// Selects this result.
  void Add(const Claim& claim) { waiting_.push_back(claim); }
  /// Results to be flown again now. Call Settle once for each of them.
  std::vector<Claim> Take();
  void Settle();
  /// Forgets all results of the workers that `worker` denotes: they need not be flown again.
  void Drop(const std::string& worker);
  bool IsSettled() const { return waiting_.empty() && flying_ == 0; }

 private:
  AuditOptions options_;
  std::set<std::string> known_workers_;  ///< workers
  std::vector<Claim> waiting_;
  std::size_t flying_ = 0;
};

}  // namespace dispersa
