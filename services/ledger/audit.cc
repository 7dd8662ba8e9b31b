#include "services/ledger/audit.h"

#include <utility>

#include "core/random/draws.h"

namespace dispersa {

void Audit::Consider(const Claim& claim) {
  const bool is_first = known_workers_.insert(claim.worker).second;
  if (is_first || Stream(options_.salt, claim.case_index, "audit").Uniform() < options_.share) Add(claim);
}

std::vector<Claim> Audit::Take() {
  flying_ += waiting_.size();
  return std::exchange(waiting_, {});
}

void Audit::Drop(const std::string& worker) {
  std::erase_if(waiting_, [&](const Claim& claim) { return IsMeantBy(worker, claim.worker, claim.host); });
}

}  // namespace dispersa
