// The optimiser's page.
#include "core/pages/trajectory_page.h"

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

}  // namespace
}  // namespace dispersa::pages_trajectory_page_test
