// The parts of a campaign's flights. A queue of cases gives the same results as each case by itself.
#include "core/cases/campaign_flights.h"

#include "core/campaign_yaml/load.h"
#include "core/flight/flight_model.h"
#include "tests/test.h"

namespace dispersa::cases_campaign_flights_test {
namespace {

class FirstCases : public CaseQueue {
 public:
  explicit FirstCases(std::uint64_t count) : count_(count) {}
  std::optional<std::uint64_t> Next(bool) override {
    return next_ < count_ ? std::optional(next_++) : std::nullopt;
  }
  void Done(CaseResult result) override { flown.emplace(result.case_index, std::move(result)); }
  void Quarantined(std::uint64_t, const std::string&) override { ADD_FAILURE(); }

  std::map<std::uint64_t, CaseResult> flown;

 private:
  std::uint64_t count_, next_ = 0;
};

// The sensors' noise is of the case.
TEST(CampaignFlights, OfAQueueAreThoseOfEachCaseWithItsOwnNoise) {
  const CampaignFlights flights(LoadCampaign(DISPERSA_CAMPAIGNS "/full.yaml"));
  FirstCases queue(2);
  flights.FlyCases(queue);
  ASSERT_EQ(queue.flown.size(), 2u);
  for (const auto& [i, result] : queue.flown)
    EXPECT_EQ(result.digest.Hex(), flights.FlyCase(i).digest.Hex()) << i;
}

// The target of guidance. If the target names no speed, it is that of the reference minus its reserve.
TEST(CampaignFlights, AimForTheTargetAndForWhatTheReferenceHasWhereItIsOpen) {
  Campaign campaign = LoadCampaign(DISPERSA_CAMPAIGNS "/smoke.yaml");
  TrajectoryProblem& problem = campaign.reference.problem;
  const Orbit& orbit = campaign.reference.orbit;
  problem.velocity_reserve_m_s = 40.0;
  const auto target = [&] { return CampaignFlights(campaign).model().definition().target; };
  EXPECT_EQ(target().velocity_m_s, problem.target_velocity_m_s);
  EXPECT_EQ(target().altitude_m, problem.target_altitude_m);
  EXPECT_EQ(target().inclination_rad, orbit.inclination_rad);
  problem.velocity_is_free = true;
  EXPECT_EQ(target().velocity_m_s, orbit.velocity_m_s - 40.0);
  problem.target_inclination_rad = 1.25;
  EXPECT_EQ(target().inclination_rad, 1.25);
  problem.target_apogee_m = 600e3;
  EXPECT_EQ(target().altitude_m, orbit.altitude_m);
}

}  // namespace
}  // namespace dispersa::cases_campaign_flights_test
