// A service of many campaigns in a folder of its own, without a network.
#pragma once

#include "core/campaign_yaml/load.h"
#include "made_up_workforce.h"
#include "services/coordinator/front_desk.h"
#include "services/coordinator/service.h"
#include "tests/temporary_folder.h"
#include "tests/test.h"

namespace dispersa {

class ServiceTest : public testing::Test {
 protected:
  /// Campaigns of the same seed have the same flights.
  static Campaign Smoke(std::uint64_t cases, std::uint64_t seed = 1) {
    return LoadCampaign(DISPERSA_CAMPAIGNS "/smoke.yaml", {.cases = cases, .seed = seed});
  }

  void StartService(std::size_t flying_at_once = 8, std::uint64_t max_cases = kDefaultMaxCases) {
    service_.reset();
    service_ =
        std::make_unique<Service>(ServiceOptions{folder_ / "data", 1, flying_at_once, max_cases}, workforce_);
    desk_ = std::make_unique<FrontDesk>(*service_, workforce_, "ann");
  }

  /// Its id.
  std::string Launch(const Campaign& campaign, int priority = 0) {
    CatalogueEntry entry;
    entry.id = campaign.id;
    entry.flight_id = campaign.flight_id;
    entry.name = campaign.name;
    entry.cases = campaign.sampling.cases;
    entry.seed = campaign.sampling.seed;
    entry.priority = priority;
    service_->Launch(entry, campaign.canonical_yaml);
    return campaign.id;
  }
  CampaignState StateOf(const std::string& id) { return service_->catalogue().entries().at(id).state; }
  /// Campaigns are opened, and reports written, on threads of their own.
  [[nodiscard]] bool Until(const std::function<bool()>& condition) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!condition()) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      service_->Step();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
  }
  [[nodiscard]] bool Reaches(const std::string& id, CampaignState state) {
    return Until([&] { return StateOf(id) == state; });
  }

  TemporaryFolder folder_;
  MadeUpWorkforce workforce_;
  std::unique_ptr<Service> service_;
  std::unique_ptr<FrontDesk> desk_;
};

}  // namespace dispersa
