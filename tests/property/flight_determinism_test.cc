// A flight is a pure function of its arguments. Flights before it or beside it, and its thread, do not change
// it.
#include "core/cases/campaign_flights.h"
#include "tests/same_events.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa::flight_determinism_test {
namespace {

const FlightModel& Model() {
  static const FlightModel model(Slv4Definition(DISPERSA_CAMPAIGNS));
  return model;
}

// Different in every state that a flight has: rules learnt, thrusters, sensors, winds, a lost vehicle.
std::vector<FlightInputs> Flights() {
  std::vector<FlightInputs> all(5);
  all[1] = Table3Inputs();
  all[2].sensors.gyro_noise_rad_s = 0.01 * kRadPerDeg;
  all[2].stages[2].tip_off_pitch_rad_s = 1.0 * kRadPerDeg;
  all[3].stuck_nozzle = 1.0;
  all[3].stuck_nozzle_stage = 1.0;
  all[3].stuck_nozzle_rad = 6.0 * kRadPerDeg;
  all[4].air.gust_speed_m_s = 9.0;
  all[4].air.gust_altitude_m = 9000.0;
  all[4].air.gust_length_m = 500.0;
  return all;
}

FlightResult FlyCase(std::size_t k) {
  FlightOptions options;
  options.case_index = k;
  return Fly(Model(), Flights()[k], options);
}

const std::vector<FlightResult>& Alone() {
  static const std::vector<FlightResult> results = [] {
    std::vector<FlightResult> all;
    for (std::size_t k = 0; k < Flights().size(); ++k) all.push_back(FlyCase(k));
    return all;
  }();
  return results;
}

void ExpectSame(const FlightResult& a, const FlightResult& b, std::size_t k) {
  EXPECT_EQ(a.digest, b.digest) << "case " << k;
  EXPECT_TRUE(AreSame(a.events, b.events)) << "case " << k;
  EXPECT_EQ(a.outcome, b.outcome) << "case " << k;
  EXPECT_EQ(a.end_time_s, b.end_time_s) << "case " << k;
  ASSERT_EQ(a.metrics.size(), b.metrics.size());
  for (std::size_t i = 0; i < a.metrics.size(); ++i)
    // Not a number equals itself here.
    EXPECT_TRUE(a.metrics[i] == b.metrics[i] ||
                (a.metrics[i] != a.metrics[i] && b.metrics[i] != b.metrics[i]))
        << "case " << k << ", " << MetricNames()[i];
}

TEST(FlightDeterminism, CasesDiffer) {
  for (std::size_t a = 0; a < Alone().size(); ++a)
    for (std::size_t b = 0; b < a; ++b) EXPECT_NE(Alone()[a].digest, Alone()[b].digest) << a << ", " << b;
}

TEST(FlightDeterminism, TwiceIsTheSame) {
  for (std::size_t k = 0; k < Flights().size(); ++k) ExpectSame(FlyCase(k), Alone()[k], k);
}

TEST(FlightDeterminism, OrderDoesNotMatter) {
  for (const std::size_t k : {3u, 1u, 4u, 0u, 2u, 2u, 1u}) ExpectSame(FlyCase(k), Alone()[k], k);
}

TEST(FlightDeterminism, ThreadsDoNotMatter) {
  Alone();
  const std::size_t count = Flights().size();
  std::vector<FlightResult> results(2 * count);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < results.size(); ++t)
    threads.emplace_back([&, t] { results[t] = FlyCase((t * 3) % count); });
  for (std::thread& thread : threads) thread.join();
  for (std::size_t t = 0; t < results.size(); ++t)
    ExpectSame(results[t], Alone()[(t * 3) % count], (t * 3) % count);
}

TEST(FlightDeterminism, AModelBuiltAnewFliesTheSame) {
  const FlightModel again(Slv4Definition(DISPERSA_CAMPAIGNS));
  FlightOptions options;
  options.case_index = 1;
  ExpectSame(Fly(again, Flights()[1], options), Alone()[1], 1);
}

TEST(FlightDeterminism, RecordingAHistoryDoesNotMatter) {
  for (std::size_t k = 0; k < Flights().size(); ++k) {
    History history;
    FlightOptions options;
    options.case_index = k;
    options.history = &history;
    ExpectSame(Fly(Model(), Flights()[k], options), Alone()[k], k);
    EXPECT_GT(history.rows(), 10u);
  }
}

TEST(FlightDeterminism, OnlyANoisySensorKnowsItsCaseIndex) {
  FlightOptions other;
  other.case_index = 1000;
  EXPECT_EQ(Fly(Model(), Flights()[1], other).digest, Alone()[1].digest);
  EXPECT_NE(Fly(Model(), Flights()[2], other).digest, Alone()[2].digest);
}

// Measurements of one flight must not reach another: a quiet flight after a violent one is quiet.
TEST(FlightDeterminism, MetricsDoNotLeak) {
  FlyCase(3);
  const FlightResult quiet = FlyCase(0);
  EXPECT_EQ(quiet.outcome, Outcome::kCompleted);
  EXPECT_LT(MetricOf(quiet, "deflection_peak_deg"), MetricOf(Alone()[3], "deflection_peak_deg"));
  ExpectSame(quiet, Alone()[0], 0);
}

TEST(CampaignDeterminism, ACaseNeedsNoOtherCaseAndNoTotal) {
  Campaign campaign;
  const FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS);
  campaign.vehicle = definition.vehicle;
  campaign.autopilot = definition.autopilot;
  campaign.reference = LoadReference(DISPERSA_CAMPAIGNS "/references/slv4_500km.yaml");
  campaign.sampling = {SamplingMethod::kMonteCarlo, 10, 7};
  Dispersion drag;
  drag.name = "drag";
  drag.distribution.kind = Distribution::kNormal;
  drag.distribution.nominal = 1.0;
  drag.distribution.sigma = 0.02;
  drag.inputs = {FindInput("drag_factor")};
  campaign.dispersions = {drag};
  const CampaignFlights ten(campaign);
  campaign.sampling.cases = 5000;
  const CampaignFlights many(campaign);
  const CaseResult late = many.FlyCase(4), early = ten.FlyCase(4);
  EXPECT_EQ(late.digest, early.digest);
  EXPECT_EQ(late.inputs, early.inputs);
  EXPECT_NE(many.FlyCase(5).digest, early.digest);
  EXPECT_EQ(many.FlyCase(4).digest, early.digest);
}

}  // namespace
}  // namespace dispersa::flight_determinism_test
