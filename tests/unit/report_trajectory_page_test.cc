// The optimiser's page.
#include "core/report/trajectory_page.h"

#include <gmock/gmock.h>

namespace dispersa {
namespace {

using testing::HasSubstr;
using testing::Not;

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

}  // namespace
}  // namespace dispersa
