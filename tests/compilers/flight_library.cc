#include "core/campaign/campaign_flights.h"
#include "tests/compilers/fly_cases.h"

void DispersaFlyCases(const dispersa::Campaign& campaign, std::uint64_t first, std::uint64_t count,
                      std::vector<dispersa::CaseResult>* results) {
  const dispersa::CampaignFlights flights(campaign);
  for (std::uint64_t i = 0; i < count; ++i) results->push_back(flights.FlyCase(first + i));
}
