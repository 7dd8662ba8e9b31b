// A store that keeps nothing, for tests of what stands before it.
#pragma once

#include "core/results/result_store.h"

namespace dispersa {

class ForgetfulStore : public ResultStore {
 public:
  void Store(std::span<const CaseResult>, std::span<const ExecutionRecord>) override {}
  void Quarantine(const QuarantinedCase&) override {}
  std::vector<std::pair<std::uint64_t, Digest>> Fingerprints() const override { return {}; }
  CaseResult Load(std::uint64_t) const override { return {}; }
  void ForEach(const std::function<void(const CaseResult&)>&) const override {}
  std::int64_t PlannedCases() const override { return 0; }
  std::vector<std::int64_t> PastLooks() const override { return {}; }
  std::optional<std::string> WorkerOf(std::uint64_t) const override { return std::nullopt; }
  void AppendAudits(std::span<const Claim>) override {}
  void ForEachUnaudited(const std::function<void(const Claim&)>&) const override {}
  std::vector<std::uint64_t> Disown(const std::string&) override { return {}; }
};

}  // namespace dispersa
