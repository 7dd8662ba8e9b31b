#include "services/ledger/auditor.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "core/containment/interrupted.h"
#include "core/math/assertion.h"
#include "core/results/fingerprint.h"
#include "services/log/log.h"

namespace dispersa {
namespace {

/// Number of campaigns with prepared flights in memory.
constexpr std::size_t kKnownCampaigns = 8;

}  // namespace

/// The claims of one campaign as the engine takes them.
class Auditor::Queue : public CaseQueue {
 public:
  Queue(Auditor& auditor, std::string flight_id) : auditor_(auditor), flight_id_(std::move(flight_id)) {}

  std::optional<std::uint64_t> Next(bool) override {
    const Lock lock(auditor_.mutex_);
    std::deque<Claim>& claims = auditor_.work_.at(flight_id_).claims;
    if (auditor_.closed_ || claims.empty()) return std::nullopt;
    flying_.push_back(std::move(claims.front()));
    claims.pop_front();
    return flying_.back().case_index;
  }
  void Done(CaseResult result) override {
    const auto claim = Find(result.case_index);
    const Lock lock(auditor_.mutex_);
    auditor_.verdicts_.push_back({flight_id_, std::move(*claim), Fingerprint(result)});
    flying_.erase(claim);
  }

  // A case that cannot be flown here is no evidence against a worker.
  void Quarantined(std::uint64_t case_index, const std::string& reason) override {
    const auto claim = Find(case_index);
    LogWarning("case {} is not audited: {}", case_index, reason);
    const Lock lock(auditor_.mutex_);
    const Digest claimed = claim->fingerprint;
    auditor_.verdicts_.push_back({flight_id_, std::move(*claim), claimed});
    flying_.erase(claim);
  }

 private:
  std::vector<Claim>::iterator Find(std::uint64_t case_index) {
    const auto claim = std::find_if(flying_.begin(), flying_.end(),
                                    [&](const Claim& each) { return each.case_index == case_index; });
    DISPERSA_ASSERT(claim != flying_.end(), case_index);
    return claim;
  }

  Auditor& auditor_;
  std::string flight_id_;
  std::vector<Claim> flying_;
};

Auditor::Auditor() : thread_([this] { FlyForEver(); }) {}

Auditor::~Auditor() {
  {
    const Lock lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
}

void Auditor::Fly(const Campaign& campaign, std::vector<Claim> claims) {
  if (claims.empty()) return;
  {
    const Lock lock(mutex_);
    Work& work = work_[campaign.result_id()];
    if (!work.campaign) work.campaign = std::make_shared<const Campaign>(campaign);
    work.claims.insert(work.claims.end(), claims.begin(), claims.end());
    for (auto other = work_.begin(); other != work_.end() && work_.size() > kKnownCampaigns;) {
      const bool is_wanted = other->second.is_flown || !other->second.claims.empty();
      other = is_wanted ? std::next(other) : work_.erase(other);
    }
  }
  changed_.notify_all();
}

std::vector<Auditor::Verdict> Auditor::Take() {
  const Lock lock(mutex_);
  return std::exchange(verdicts_, {});
}

std::vector<Auditor::Fault> Auditor::TakeFaults() {
  const Lock lock(mutex_);
  return std::exchange(faults_, {});
}

std::string Auditor::Await() {
  Lock lock(mutex_);
  for (;;) {
    if (closed_) return "";
    for (auto& [flight_id, work] : work_) {
      if (work.claims.empty()) continue;
      work.is_flown = true;
      return flight_id;
    }
    lock.Wait(changed_);
  }
}

// Preparing flights takes long and must not block others.
std::shared_ptr<const CampaignFlights> Auditor::FlightsOf(const std::string& flight_id) {
  std::shared_ptr<const Campaign> campaign;
  {
    const Lock lock(mutex_);
    const Work& work = work_.at(flight_id);
    if (work.flights) return work.flights;
    campaign = work.campaign;
  }
  auto flights = std::make_shared<const CampaignFlights>(*campaign);
  const Lock lock(mutex_);
  return work_.at(flight_id).flights = std::move(flights);
}

void Auditor::FlyForEver() {
  for (std::string flight_id = Await(); !flight_id.empty(); flight_id = Await()) {
    Queue queue(*this, flight_id);
    try {
      FlightsOf(flight_id)->FlyCases(queue);
    } catch (const Interrupted&) {
      return;  // this process ends
    } catch (const AssertionFailed& fault) {
      const Lock lock(mutex_);
      faults_.push_back({flight_id, fault.what()});
      work_.at(flight_id).claims.clear();
    }
    const Lock lock(mutex_);
    work_.at(flight_id).is_flown = false;
  }
}

}  // namespace dispersa
