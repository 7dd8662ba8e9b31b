// Results that are flown again on a thread of their own: what it finds, and a fault of the program there.
#include "services/ledger/auditor.h"

#include "core/campaign_yaml/load.h"
#include "core/results/fingerprint.h"
#include "tests/test.h"

namespace dispersa::auditor_test {

constexpr std::chrono::seconds kPatience(60);

/// What `take` gives, as soon as it gives something.
auto Await(auto take) {
  const auto start = std::chrono::steady_clock::now();
  for (;;) {
    auto taken = take();
    if (!taken.empty() || std::chrono::steady_clock::now() - start > kPatience) return taken;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

TEST(Auditor, AFaultOfTheProgramEndsTheAuditOfThatCampaignAlone) {
  const Campaign sound = LoadCampaign(DISPERSA_CAMPAIGNS "/smoke.yaml", {.cases = 2});
  Campaign flawed = sound;
  flawed.flight_id = std::string(64, 'f');
  flawed.autopilot.rate_gyros.push_back({"nowhere"});  // readers of files refuse it
  Auditor auditor;
  auditor.Fly(flawed, {{"w", 0, {}}, {"w", 1, {}}});
  const auto faults = Await([&] { return auditor.TakeFaults(); });
  ASSERT_THAT(faults, SizeIs(1));
  EXPECT_EQ(faults[0].flight_id, flawed.result_id());
  EXPECT_THAT(faults[0].what, StartsWith("engine fault: core/flight/sensor_model.cc:"));

  auditor.Fly(sound, {{"w", 1, {}}});
  const auto verdicts = Await([&] { return auditor.Take(); });
  ASSERT_THAT(verdicts, SizeIs(1));
  EXPECT_EQ(verdicts[0].flight_id, sound.result_id());
  EXPECT_EQ(verdicts[0].truth, Fingerprint(CampaignFlights(sound).FlyCase(1)));
  EXPECT_THAT(auditor.TakeFaults(), SizeIs(0));
}

}  // namespace dispersa::auditor_test
