// The search on flights: one of the dispersions of `full` is made to matter, and the search finds it.
#include "core/campaign_yaml/load.h"
#include "core/cases/campaign_flights.h"
#include "core/flight/flight.h"
#include "core/search/smallest_failure.h"
#include "tests/test.h"

namespace dispersa::search_planted_cause_test {

constexpr char kMetric[] = "pitch_error_peak_stage2_deg";
constexpr double kLimit_deg = 1.0;

TEST(SmallestFailure, FindsAPlantedCauseInFlight) {
  Campaign campaign = LoadCampaign(DISPERSA_CAMPAIGNS "/full.yaml");
  // Ten times the tilt of stage 2's thrust; everything else stays as it is shipped.
  std::size_t cause = campaign.dispersions.size();
  for (std::size_t i = 0; i < campaign.dispersions.size(); ++i) {
    const Dispersion& dispersion = campaign.dispersions[i];
    const int input = dispersion.inputs.front();
    if (InputColumns()[static_cast<std::size_t>(input)].name == "thrust_misalignment_stage2_deg") cause = i;
  }
  ASSERT_LT(cause, campaign.dispersions.size());
  campaign.dispersions[cause].distribution.sigma *= 10.0;

  const CampaignFlights flights(campaign);
  const DispersionSpace space(campaign);
  const PointMargins margins_at = [&](const std::vector<std::vector<double>>& points) {
    std::vector<FlightOrder> orders;
    for (const FlightInputs& inputs : space.Inputs(points)) orders.push_back({inputs, {}});
    std::vector<double> margins;
    for (const FlightResult& flown : FlyAll(flights.model(), orders))
      margins.push_back(flown.outcome == Outcome::kCompleted
                            ? kLimit_deg - flown.metrics[MetricColumn(kMetric)]
                            : std::nan(""));
    return margins;
  };
  FailureSearchOptions options;
  options.max_flights = 600;
  const FailureSearchResult found = FindSmallestFailure(space.coordinates(), margins_at, options);
  ASSERT_TRUE(found.found);
  EXPECT_LE(found.flights, options.max_flights);
  // The returned point has been flown and fails.
  EXPECT_FALSE(margins_at({found.point})[0] > 0.0);
  const double share = found.point[cause] * found.point[cause] / (found.distance * found.distance);
  EXPECT_GT(share, 0.9);
  // The cause alone, in the direction that was found, fails not much farther out, and half of it does not
  // fail.
  std::vector<double> alone(found.point.size(), 0.0);
  for (std::size_t i = 0; i < alone.size(); ++i)
    if (space.coordinates()[i].kind == CoordinateKind::kDirection) alone[i] = found.point[i];
  alone[cause] = 1.1 * std::copysign(found.distance, found.point[cause]);
  EXPECT_FALSE(margins_at({alone})[0] > 0.0);
  alone[cause] *= 0.5;
  EXPECT_GT(margins_at({alone})[0], 0.0);
}

}  // namespace dispersa::search_planted_cause_test
