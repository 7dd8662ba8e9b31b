// The optimiser's page.
#include "core/pages/trajectory_page.h"

#include <cmath>

#include "core/environment/earth.h"
#include "core/math/constants.h"
#include "tests/test.h"

namespace dispersa::pages_trajectory_page_test {
namespace {

OptimizationResult Result(double t1_s) {
  OptimizationResult result;
  result.reference.name = "made up";
  TrajectoryProblem& problem = result.reference.problem;
  problem.alpha_max_rad = problem.t3_s = problem.t2_s = problem.launch_azimuth_rad = {-10.0, 10.0};
  problem.t1_s = {3.0, 8.0};
  problem.coast_s = {50.0, 50.0};
  result.reference.program.t1_s = t1_s;
  result.reference.program.coast_s = 50.0;
  return result;
}

TEST(TrajectoryPage, FlagsVariablesAtTheirBounds) {
  const std::string low = TrajectoryPage(Result(3.0), std::nullopt);
  EXPECT_THAT(low, HasSubstr("at its lower bound</span>"));
  EXPECT_THAT(low, Not(HasSubstr("at its upper bound")));
  EXPECT_THAT(low, HasSubstr("fixed</span>"));  // the coast
  EXPECT_THAT(TrajectoryPage(Result(7.999), std::nullopt), HasSubstr("at its upper bound</span>"));
  EXPECT_THAT(TrajectoryPage(Result(5.0), std::nullopt), Not(HasSubstr("er bound</span>")));
}

// The tables, figures and equations that are numbered are another document's.
TEST(TrajectoryPage, SpeaksOfTheTargetAndOfNothingElse) {
  OptimizationResult result = Result(5.0);
  TrajectoryProblem& problem = result.reference.problem;
  problem.target_altitude_m = 500e3;  // a published target is a target
  problem.target_velocity_m_s = 7612.60;
  std::string page = TrajectoryPage(result, std::nullopt);
  page.erase(0, page.find("</style>"));
  for (const char* text : {"Table 2", "Fig. ", "(8)", "the paper", "inclination, deg"})
    EXPECT_THAT(page, Not(HasSubstr(text)));
  EXPECT_THAT(page, HasSubstr("velocity, m/s"));
  EXPECT_EQ(InjectionRows(result, std::nullopt).size(), 3u);

  problem.velocity_is_free = true;
  problem.target_inclination_rad = 1.0;
  const std::string inclined = TrajectoryPage(result, std::nullopt);
  EXPECT_THAT(inclined, HasSubstr("inclination, deg"));
  EXPECT_THAT(inclined, Not(HasSubstr("<td>velocity, m/s")));
}

TEST(TrajectoryPage, SaysWhenToLiftOffForANode) {
  OptimizationResult result = Result(5.0);
  EXPECT_FALSE(LiftOffSidereal(result.reference));
  result.reference.problem.target_node_rad = 20.0 * kRadPerDeg;
  result.reference.orbit.node_longitude_rad = 110.0 * kRadPerDeg;
  EXPECT_NEAR(*LiftOffSidereal(result.reference), 270.0 * kRadPerDeg, 1e-14);
  EXPECT_EQ(OrbitSentence(result.reference),
            "inclination 0.0000 deg, ascending node 110.0000 deg east of Greenwich at lift-off; for the node "
            "at 20 deg lift off at 270.0000 deg (18.0000 h) of Greenwich sidereal time");
}

TEST(TrajectoryPage, ShowsAnAzimuthWithinBoundsThatPassNorth) {
  OptimizationResult result = Result(5.0);
  result.reference.problem.launch_azimuth_rad = {350.0 * kRadPerDeg, 370.0 * kRadPerDeg};
  result.reference.program.launch_azimuth_rad = 5.0 * kRadPerDeg;
  EXPECT_THAT(TrajectoryPage(result, std::nullopt), HasSubstr("365.000000"));
}

/// On a circle of this altitude above the equator's radius.
AscentSample Sample(double time_s, int stage, double load_g, double qbar_pa, double altitude_m) {
  const Earth earth = Wgs84();
  AscentSample s;
  s.time_s = time_s;
  s.stage = stage;
  s.axial_load_g = load_g;
  s.qbar_pa = qbar_pa;
  s.altitude_m = altitude_m;
  s.p_EoC_I = {earth.equatorial_radius_m + altitude_m, 0.0, 0.0};
  s.v_IC_I = {0.0, std::sqrt(earth.mu_m3_s2 / s.p_EoC_I.x()), 0.0};
  return s;
}

TEST(TrajectoryPage, HasEventsApsidesAndTheCheckFlight) {
  OptimizationResult result = Result(5.0);
  result.history = {Sample(0.0, 1, 1.5, 0.0, 100e3),   Sample(20.0, 1, 2.0, 40e3, 101e3),
                    Sample(40.0, 1, 3.0, 9e3, 102e3),  Sample(60.0, 2, 0.0, 1.0, 103e3),
                    Sample(100.0, 2, 1.0, 0.0, 104e3), Sample(140.0, 2, 2.0, 0.0, 150e3)};
  const std::string page = TrajectoryPage(result, std::nullopt);
  std::size_t at = page.find("<h2>Events</h2>");
  for (const char* row :
       {"<td>lift-off, ignition of stage 1</td><td class=\"n\">0.0<",
        "<td>largest dynamic pressure</td><td class=\"n\">20.0<",
        "<td>end of the burn of stage 1</td><td class=\"n\">40.0<",
        "<td>ignition of stage 2</td><td class=\"n\">100.0<", "<td>injection</td><td class=\"n\">140.0<"}) {
    const std::size_t next = page.find(row, at);
    ASSERT_NE(next, std::string::npos) << row;
    at = next;
  }
  EXPECT_THAT(page.substr(at, 400), HasSubstr("<td class=\"n\">150.0</td><td class=\"n\">150.0</td></tr>"));
  EXPECT_THAT(page, AllOf(HasSubstr("dynamic pressure, kPa"), HasSubstr(">apogee</text>"),
                          HasSubstr(">perigee</text>")));
  EXPECT_THAT(page, AllOf(HasSubstr("No check flight was flown"), HasSubstr("<h2>Injection</h2>")));
  CheckFlight check;
  check.end_time_s = 140.0;
  EXPECT_THAT(TrajectoryPage(result, check), HasSubstr("check flight: completed at 140 s."));
  check.outcome = Outcome::kImpact;
  const std::string lost = TrajectoryPage(result, check);
  EXPECT_THAT(lost, HasSubstr("check flight: lost at 140 s"));
  EXPECT_LT(lost.find("<span class=\"badge fail\""), lost.find("check flight: lost"));

  result.history.back().v_IC_I *= 0.9;
  const std::string suborbital = TrajectoryPage(result, std::nullopt);
  EXPECT_THAT(suborbital,
              AllOf(HasSubstr("<h2>End of the ascent</h2>"), HasSubstr("<td>end of the ascent</td>")));
  EXPECT_THAT(suborbital, Not(HasSubstr("njection</")));
}

}  // namespace
}  // namespace dispersa::pages_trajectory_page_test
