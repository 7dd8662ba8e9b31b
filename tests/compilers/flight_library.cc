#include "core/cases/campaign_flights.h"
#include "tests/compilers/fly_cases.h"

#include <utility>

void DispersaFlyCases(const dispersa::Campaign& campaign, std::uint64_t first, std::uint64_t count,
                      std::vector<dispersa::CaseResult>* results) {
  const dispersa::CampaignFlights flights(campaign);
  const std::size_t before = results->size();
  results->resize(before + count);
  std::vector<dispersa::CaseOrder> orders;
  for (std::uint64_t i = 0; i < count; ++i) orders.push_back({first + i});
  // Side by side, which is what campaigns do.
  flights.FlyCases(orders, 1, [&](std::size_t i, dispersa::CaseResult result, const dispersa::History&) {
    (*results)[before + i] = std::move(result);
  });
}
