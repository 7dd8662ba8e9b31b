// The least margins over a campaign's cases, against those of each case by itself.
#include "core/margins/dispersed_margins.h"

#include "core/campaign_yaml/load.h"
#include "core/math/constants.h"
#include "tests/test.h"

namespace dispersa::margins_dispersed_test {
namespace {

// A column of four cases.
Dispersion Column(const std::string& input, std::vector<double> values) {
  return {input, {.kind = Distribution::kValues, .values = std::move(values)}, {FindInput(input)}, false};
}

// Four cases: as the autopilot expects them; with a loop of stage 1 that has 4.6 dB more gain; with a thrust
// so far aside that the flight fails; and the first one again.
Campaign FourCases() {
  Campaign campaign = LoadCampaign(DISPERSA_CAMPAIGNS "/smoke.yaml");
  campaign.sampling = {SamplingMethod::kList, 4, 1};
  campaign.dispersions = {Column("loop_gain_factor", {1.0, 1.7, 1.0, 1.0}),
                          Column("loop_stage", {1.0, 1.0, 1.0, 1.0}),
                          Column("thrust_misalignment_stage2_deg", {0.0, 0.0, 20.0 * kRadPerDeg, 0.0})};
  return campaign;
}

DispersedMargins OfCase(const CampaignFlights& flights, std::uint64_t case_index, LateralPath path) {
  FlightOrder order{flights.Draw(case_index), {}};
  order.options.case_index = case_index;
  return ComputeDispersedMargins(flights.model(), order, 5.0, path);
}

using Margin = double LoopMargins::*;
using Least = LeastMargin LeastLoopMargins::*;
constexpr std::pair<Margin, Least> kMargins[] = {
    {&LoopMargins::gain_up_db, &LeastLoopMargins::gain_up_db},
    {&LoopMargins::gain_down_db, &LeastLoopMargins::gain_down_db},
    {&LoopMargins::phase_deg, &LeastLoopMargins::phase_deg},
    {&LoopMargins::delay_s, &LeastLoopMargins::delay_s}};

TEST(CampaignMargins, AreTheLeastOfAllCasesByStageAndAxis) {
  const CampaignFlights flights(FourCases());
  for (const LateralPath path : {LateralPath::kHeld, LateralPath::kDrifts}) {
    const CampaignMargins found = ComputeCampaignMargins(flights, 4, 2, path);
    EXPECT_EQ(found.cases, 4u);
    std::map<std::pair<int, Axis>, std::vector<std::pair<LoopMargins, LeastMargin>>>
        all;  // margins; their case and time
    for (std::uint64_t i = 0; i < 4; ++i) {
      for (const ComputedMargins& m : OfCase(flights, i, path).margins) {
        auto& loop = all[{m.stage, m.axis}];
        const LeastMargin at{0.0, i, m.time_s};
        loop.insert(loop.end(), {{m.frozen, at}, {m.adapting, at}});
        if (m.learnt) loop.emplace_back(*m.learnt, at);
      }
    }
    ASSERT_EQ(found.loops.size(), all.size());
    EXPECT_GT(all.size(), 8u);
    EXPECT_TRUE(std::is_sorted(found.loops.begin(), found.loops.end(),
                               [](const auto& a, const auto& b) { return a.stage < b.stage; }));
    for (const LeastLoopMargins& loop : found.loops) {
      const auto& of_loop = all.at({loop.stage, loop.axis});
      for (const auto& [margin, least] : kMargins) {
        const auto first =
            std::min_element(of_loop.begin(), of_loop.end(),
                             [m = margin](const auto& a, const auto& b) { return a.first.*m < b.first.*m; });
        EXPECT_EQ((loop.*least).value, first->first.*margin)
            << "stage " << loop.stage << ", axis " << loop.axis;
        if (std::isinf(first->first.*margin)) continue;  // nobody has one
        EXPECT_EQ((loop.*least).case_index, first->second.case_index)
            << "stage " << loop.stage << ", axis " << loop.axis;
        EXPECT_EQ((loop.*least).time_s, first->second.time_s)
            << "stage " << loop.stage << ", axis " << loop.axis;
      }
    }
  }
}

// The second case misses its gates in stage 1 and meets them from then on.
TEST(CampaignMargins, NameTheCasesThatMissAGateAndCountThoseThatEndEarly) {
  const CampaignFlights flights(FourCases());
  const DispersedMargins second = OfCase(flights, 1, LateralPath::kHeld);
  ASSERT_EQ(second.outcome, Outcome::kCompleted);
  ASSERT_TRUE(PassesDispersedGates(second.margins.back()));
  const CampaignMargins found = ComputeCampaignMargins(flights, 4, 1);
  EXPECT_EQ(found.ended_early, 1u);
  std::vector<std::uint64_t> missed;
  for (std::uint64_t i = 0; i < 4; ++i) {
    const std::vector<ComputedMargins> margins = OfCase(flights, i, LateralPath::kHeld).margins;
    if (!std::all_of(margins.begin(), margins.end(), [](const auto& m) { return PassesDispersedGates(m); }))
      missed.push_back(i);
  }
  EXPECT_EQ(found.missed, missed);
  EXPECT_EQ(std::count(missed.begin(), missed.end(), 1u), 1);
  EXPECT_EQ(std::count(missed.begin(), missed.end(), 0u), 0);
  EXPECT_FALSE(found.Passed());
  EXPECT_TRUE(ComputeCampaignMargins(flights, 1, 1).Passed());
}

}  // namespace
}  // namespace dispersa::margins_dispersed_test
