#include "services/ledger/audit.h"

#include <utility>

#include "core/math/assertion.h"
#include "core/random/draws.h"

namespace dispersa {

Audit::Audit(const AuditOptions& options) : options_(options) {
  DISPERSA_ASSERT(options.share >= 0.0 && options.share <= 1.0, options.share);
}

void Audit::Consider(const Claim& claim) {
  DISPERSA_ASSERT(!claim.worker.empty(), claim.case_index);
  const bool is_first = known_workers_.insert(claim.worker).second;
  if (is_first || Stream(options_.salt, claim.case_index, "audit").Uniform() < options_.share) Add(claim);
}

std::vector<Claim> Audit::Take() {
  flying_ += waiting_.size();
  return std::exchange(waiting_, {});
}

void Audit::Settle() {
  DISPERSA_ASSERT(flying_ > 0);
  --flying_;
}

void Audit::Drop(const std::string& worker) {
  std::erase_if(waiting_, [&](const Claim& claim) { return IsMeantBy(worker, claim.worker, claim.host); });
}

}  // namespace dispersa
