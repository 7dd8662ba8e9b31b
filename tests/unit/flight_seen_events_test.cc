// What a flight tells of its events, against its history, which another model computes.
#include "core/flight/seen_event.h"

#include "core/cases/campaign_flights.h"
#include "core/flight/history.h"
#include "tests/gallery_launcher.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa::flight_seen_events_test {

std::vector<std::string> NamesIn(const std::vector<SeenEvent>& events) {
  std::vector<std::string> names;
  for (const SeenEvent& event : events) names.push_back(event.name);
  return names;
}

/// A row of the history at an event, right after it: the last one of that time.
struct Row {
  const History& history;
  std::size_t row;
  double operator()(const char* column) const { return history.at(row, FindHistoryColumn(column)); }
  double Speed() const {
    return std::hypot((*this)("ned_v_n_m_s"), (*this)("ned_v_e_m_s"), (*this)("ned_v_d_m_s"));
  }
};

void ExpectAsInHistory(const std::vector<SeenEvent>& events, const History& history) {
  for (const SeenEvent& event : events) {
    if (event.name == "apogee" || event.name == "impact") continue;  // of a body that falls as a point
    std::optional<std::size_t> at;
    for (std::size_t row = 0; row < history.rows(); ++row)
      if (std::fabs(history.at(row, 0) - event.time_s) < 1e-9) at = row;
    ASSERT_TRUE(at) << event.name << " at " << event.time_s;
    const Row row{history, *at};
    EXPECT_NEAR(event.altitude_m, row("altitude_m"), 1e-6) << event.name;
    EXPECT_NEAR(event.qbar_pa, row("qbar_pa"), 1e-6 * std::max(1.0, row("qbar_pa"))) << event.name;
    EXPECT_NEAR(event.speed_m_s, row.Speed(), 1e-6) << event.name;
    // Several may happen at one time.
    const bool is_alone = &event == &events.back() || (&event + 1)->time_s > event.time_s;
    if (is_alone) {
      EXPECT_NEAR(event.mass_kg, row("mass_kg"), 1e-9 * row("mass_kg")) << event.name;
    }
  }
}

CaseResult FlyNominal(const std::string& launcher) {
  const CampaignFlights flights(GalleryLauncher(DISPERSA_CAMPAIGNS, launcher));
  History history;
  history.step_s = flights.model().definition().autopilot.tick_s;
  CaseResult flown = flights.FlyNominal(&history);
  ExpectAsInHistory(flown.events, history);
  std::size_t largest = 0;
  const int qbar = FindHistoryColumn("qbar_pa");
  for (std::size_t row = 0; row < history.rows(); ++row)
    if (history.at(row, qbar) > history.at(largest, qbar)) largest = row;
  const SeenEvent* const max_q = FindEvent(flown.events, "max_q");
  EXPECT_EQ(max_q->time_s, history.at(largest, 0));
  EXPECT_EQ(max_q->qbar_pa, flown.metrics[MetricColumn("q_max_pa")]);
  return flown;
}

TEST(SeenEvents, OfALauncherWithBoostersAndAFairing) {
  const CaseResult flown = FlyNominal("soyuz");
  EXPECT_THAT(NamesIn(flown.events),
              ElementsAre("lift_off", "max_q", "booster_1_burnout", "booster_2_burnout", "booster_3_burnout",
                          "booster_4_burnout", "boosters_separation", "stage_1_burnout", "stage_1_separation",
                          "stage_2_ignition", "jettison_1", "jettison_2", "stage_2_cut_off",
                          "stage_2_burnout", "injection"));
}

TEST(SeenEvents, OfEnginesThatAreCutOffAndLitAgain) {
  EXPECT_THAT(NamesIn(FlyNominal("falcon9").events),
              ElementsAre("lift_off", "max_q", "stage_1_cut_off", "stage_1_burnout", "stage_1_separation",
                          "stage_2_ignition", "jettison_1", "stage_2_cut_off", "stage_2_burnout",
                          "stage_3_ignition", "stage_3_cut_off", "stage_3_burnout", "injection"))
      << "nothing separates between two burns of one engine";
}

TEST(SeenEvents, OfARocketFromARailToTheGround) {
  const CaseResult flown = FlyNominal("nike_apache");
  EXPECT_THAT(NamesIn(flown.events),
              ElementsAre("lift_off", "rail_exit", "max_q", "stage_1_burnout", "stage_1_separation",
                          "stage_2_ignition", "stage_2_burnout", "apogee", "impact"));
  const SeenEvent &apogee = *FindEvent(flown.events, "apogee"), &impact = *FindEvent(flown.events, "impact");
  EXPECT_EQ(apogee.altitude_m, 1e3 * flown.metrics[MetricColumn("apogee_altitude_km")]);
  EXPECT_EQ(impact.time_s, flown.end_time_s);
  EXPECT_TRUE(std::isnan(apogee.qbar_pa) && std::isnan(impact.qbar_pa));
  EXPECT_EQ(apogee.mass_kg, impact.mass_kg);
}

TEST(SeenEvents, EachBodyHasItsJettison) {
  FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS);
  Jettison one{.name = "cover",
               .mass_kg = 10.0,
               .top_station_m = 1.0,
               .bottom_station_m = 2.0,
               .outer_diameter_m = 1.0,
               .inner_diameter_m = 0.9,
               .threshold = 60.0};
  Jettison earlier = one, together = one;
  earlier.mass_kg = 25.0;
  earlier.threshold = 40.0;
  definition.vehicle.stages[0].jettisoned = {one, earlier};
  definition.vehicle.stages[1].jettisoned = {together};
  const FlightModel model(definition);
  const FlightResult flown = Fly(model, {});
  const SeenEvent* const first = FindEvent(flown.events, "jettison_2");
  ASSERT_TRUE(first);
  EXPECT_NEAR(first->time_s, 40.0, 0.011);
  const SeenEvent *const second = FindEvent(flown.events, "jettison_1"), *const third = FindEvent(
                                                                             flown.events, "jettison_3");
  ASSERT_TRUE(second && third);
  EXPECT_NEAR(second->time_s, 60.0, 0.011);
  EXPECT_EQ(second->time_s, third->time_s);
}

TEST(SeenEvents, ALostFlightEndsWithItsLoss) {
  const FlightModel model(Slv4Definition(DISPERSA_CAMPAIGNS));
  FlightInputs inputs;
  inputs.stages[0].thrust.misalignment_rad.magnitude = 5.0 * kRadPerDeg;
  const FlightResult lost = Fly(model, inputs);
  ASSERT_EQ(lost.outcome, Outcome::kLostControl);
  EXPECT_EQ(lost.events.front().name, "lift_off");
  EXPECT_EQ(lost.events.back().name, "lost");
  EXPECT_EQ(lost.events.back().time_s, lost.end_time_s);
  EXPECT_EQ(FindEvent(lost.events, "injection"), nullptr);
}

TEST(SeenEvents, NamesAreShortAndPlain) {
  for (const char* name : {"max_q", "stage_12_burnout", "a"}) EXPECT_TRUE(IsEventName(name)) << name;
  for (const char* name : {"", "Max_q", "max q", "max-q", "é"}) EXPECT_FALSE(IsEventName(name)) << name;
  EXPECT_TRUE(IsEventName(std::string(40, 'x')));
  EXPECT_FALSE(IsEventName(std::string(41, 'x')));
}

}  // namespace dispersa::flight_seen_events_test
