// Which results the coordinator flies again itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "core/results/result_store.h"

namespace dispersa {

struct AuditOptions {
  double share = 0.0;      ///< of the results, 0 to 1; 0: none at all
  std::uint64_t salt = 0;  ///< decides which: whoever knows it knows which forgery is seen
};

/// A pure state machine: results come in, those that are to be flown again come out. By the coordinator,
/// since two workers that agree may be one forger's.
class Audit {
 public:
  explicit Audit(const AuditOptions& options) : options_(options) {}

  /// Takes the first result of each worker, and the share of all.
  void Consider(const Claim& claim);
  /// Takes it in any case.
  void Add(const Claim& claim) { waiting_.push_back(claim); }
  /// What is to be flown again now; Settle says of each that it was.
  std::vector<Claim> Take();
  void Settle() { --flying_; }
  /// Nothing that this worker returned needs to be flown again any more.
  void Drop(const std::string& worker);
  bool IsSettled() const { return waiting_.empty() && flying_ == 0; }

 private:
  AuditOptions options_;
  std::set<std::string> known_workers_;  ///< workers
  std::vector<Claim> waiting_;
  std::size_t flying_ = 0;
};

}  // namespace dispersa
