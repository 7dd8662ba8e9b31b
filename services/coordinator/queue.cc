#include "services/coordinator/queue.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>

namespace dispersa {

const CatalogueEntry* NextOf(const std::vector<const CatalogueEntry*>& open, const Quotas& quotas,
                             const std::function<bool(const std::string& id)>& is_delayed) {
  std::set<std::string> busy;
  std::map<std::string, std::uint64_t> flying;  // by owner
  for (const CatalogueEntry* entry : open) {
    if (entry->state == CampaignState::kFlying || entry->state == CampaignState::kReporting)
      busy.insert(entry->flight_id);
    if (entry->state == CampaignState::kFlying) ++flying[entry->owner];
  }
  const auto has_no_place = [&](const CatalogueEntry& entry) {
    const auto places = quotas.Of(entry.owner).places;
    return places && flying[entry.owner] >= *places;
  };
  const auto comes_before = [](const CatalogueEntry& a, const CatalogueEntry& b) {
    const auto is_flown = [](const CatalogueEntry& entry) {
      return entry.done + entry.quarantined >= entry.cases;
    };
    return is_flown(a) == is_flown(b) ? ComesBefore(a, b) : is_flown(b);
  };
  const CatalogueEntry* next = nullptr;
  for (const CatalogueEntry* entry : open) {
    if (entry->state != CampaignState::kWaiting || busy.contains(entry->flight_id) || is_delayed(entry->id) ||
        has_no_place(*entry))
      continue;
    if (next == nullptr || comes_before(*entry, *next)) next = entry;
  }
  return next;
}

const CatalogueEntry* WhoGivesWayTo(const CatalogueEntry& entry,
                                    const std::vector<const CatalogueEntry*>& flying) {
  const auto last =
      std::max_element(flying.begin(), flying.end(),
                       [](const CatalogueEntry* a, const CatalogueEntry* b) { return ComesBefore(*a, *b); });
  return last != flying.end() && (*last)->priority < entry.priority ? *last : nullptr;
}

}  // namespace dispersa
