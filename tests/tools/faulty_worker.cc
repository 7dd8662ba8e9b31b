// dispersa-worker in which a rule of the program breaks: in each first flight of the campaign that the
// variable DISPERSA_FAULTY_CAMPAIGN names. The linker puts these functions in the place of CampaignFlights'
// own (--wrap).
#include <cstdlib>
#include <mutex>
#include <set>

#include "core/cases/campaign_flights.h"
#include "core/math/assertion.h"
#include "services/worker/program.h"

using dispersa::Campaign;
using dispersa::CampaignFlights;
using dispersa::CaseQueue;

// CampaignFlights::CampaignFlights(const Campaign&) and FlyCases(CaseQueue&) const.
#define CONSTRUCT _ZN8dispersa15CampaignFlightsC1ERKNS_8CampaignE
#define FLY_CASES _ZNK8dispersa15CampaignFlights8FlyCasesERNS_9CaseQueueE
#define JOINED_(a, b) a##b
#define JOINED(a, b) JOINED_(a, b)
#define WRAPPED(name) JOINED(__wrap_, name)
#define REAL(name) JOINED(__real_, name)

extern "C" {
void REAL(CONSTRUCT)(CampaignFlights*, const Campaign&);
void REAL(FLY_CASES)(const CampaignFlights*, CaseQueue&);
void WRAPPED(CONSTRUCT)(CampaignFlights*, const Campaign&);
void WRAPPED(FLY_CASES)(const CampaignFlights*, CaseQueue&);
}

namespace {

std::mutex mutex;
std::set<const CampaignFlights*> faulty;

}  // namespace

void WRAPPED(CONSTRUCT)(CampaignFlights* flights, const Campaign& campaign) {
  REAL(CONSTRUCT)(flights, campaign);
  const char* const name = std::getenv("DISPERSA_FAULTY_CAMPAIGN");
  const std::lock_guard lock(mutex);
  if (name != nullptr && campaign.name == name) faulty.insert(flights);
}

void WRAPPED(FLY_CASES)(const CampaignFlights* flights, CaseQueue& queue) {
  const bool is_faulty = [&] {
    const std::lock_guard lock(mutex);
    return faulty.contains(flights);
  }();
  if (!is_faulty) return REAL(FLY_CASES)(flights, queue);
  const auto begun = queue.Next(false);  // the coordinator knows that it is in flight
  DISPERSA_ASSERT(!begun, *begun);
}

int main(int argc, char** argv) { return dispersa::RunWorker(argc, argv); }
