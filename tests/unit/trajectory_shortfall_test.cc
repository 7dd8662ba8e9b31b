// What the user is told of a target that is out of reach: each sentence with its numbers.
#include "core/trajectory/shortfall.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/campaign_yaml/load.h"
#include "core/math/constants.h"
#include "core/trajectory/refine.h"

namespace dispersa::trajectory_shortfall_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// The shipped launcher and its shipped program, which reaches the shipped target.
class Shortfall : public testing::Test {
 protected:
  std::string Describe() const { return DescribeShortfall(model_, problem_, options_, result_); }

  /// The speed with which the vehicle arrives at the target's altitude and angle toward an azimuth.
  double SpeedToward(double azimuth_rad) const {
    FlightProgram program = result_.refined;
    program.launch_azimuth_rad = azimuth_rad;
    EXPECT_EQ(RefineAltitudeAndAngle(model_, problem_, options_, &program).status, LeastSquaresStatus::kConverged);
    return FlyAscent(model_, program, AscentOptionsOf(problem_, options_.steps)).orbit.velocity_m_s;
  }

  const OptimizationInput input_ = LoadOptimization(DISPERSA_CAMPAIGNS "/slv4_500km.yaml");
  TrajectoryProblem problem_ = input_.problem;
  TrajectoryOptions options_;
  AscentModel model_ = BuildAscentModel(input_.vehicle, options_.tick_s);
  OptimizationResult result_ = [] {
    OptimizationResult result;
    result.reference = LoadReference(DISPERSA_CAMPAIGNS "/references/slv4_500km.yaml");
    result.reference.constraints.clear();
    result.refined = result.reference.program;
    result.refinement.status = LeastSquaresStatus::kConverged;
    return result;
  }();
};

TEST_F(Shortfall, SaysHowFarEachValueIsOff) {
  result_.errors = {1500.0, -2.5, 0.1 * kRadPerDeg, 0.25 * kRadPerDeg, -1.5 * kRadPerDeg};
  EXPECT_THAT(Describe(), testing::StartsWith("The target is out of reach: the best program ends +1.500 km, -2.500 m/s "
                                              "and +0.1000 deg from it. The refinement "));
  EXPECT_THAT(Describe(), Not(HasSubstr("inclination")));
  problem_.target_inclination_rad = 1.0;
  problem_.target_argument_of_perigee_rad = 1.0;
  EXPECT_THAT(Describe(), HasSubstr("from it. Its inclination is off by +0.2500 deg. Its argument of perigee is off by "
                                    "-1.500 deg. The refinement "));
}

TEST_F(Shortfall, NamesTheConstraintsThatAreBroken) {
  result_.reference.constraints = {{"q_max_pa", 90000.0, 80000.0, -10000.0, true},
                                   {"axial_load_max_g", 8.0, 12.0, 4.0, true},
                                   {"q_alpha_max_pa_rad", 5.0, 4.0, -1.0, false}};
  EXPECT_EQ(Describe(),
            "The target is out of reach: the best program ends +0.000 km, +0.000 m/s and +0.0000 deg from it. "
            "Constraint: q_max_pa = 90000 exceeds its limit of 80000.");
}

TEST_F(Shortfall, OfAProgramThatFallsBackSaysWhen) {
  result_.reference.program.alpha_max_rad = 40.0 * kRadPerDeg;
  const AscentResult ascent =
      FlyAscent(model_, result_.reference.program, AscentOptionsOf(problem_, options_.steps));
  ASSERT_FALSE(ascent.completed);
  EXPECT_EQ(Describe(), fmt::format("The target is out of reach: every program falls back to the ground; the best flies "
                                    "{:.1f} s.",
                                    ascent.end_time_s));
}

// Eastward the Earth's turning helps: the least azimuth has the most speed.
TEST_F(Shortfall, SaysHowMuchSpeedThereIsAndWhere) {
  result_.refinement.status = LeastSquaresStatus::kStalled;
  const double most_m_s = SpeedToward(problem_.launch_azimuth_rad.low);
  const double least_m_s = SpeedToward(problem_.launch_azimuth_rad.high);
  ASSERT_GT(most_m_s, least_m_s + 100.0);

  problem_.target_velocity_m_s = most_m_s + 50.0;
  EXPECT_THAT(Describe(),
              HasSubstr(fmt::format(" Energy: at the target's altitude and angle the vehicle has at most {:.1f} m/s "
                                    "(launch azimuth {:.6g} deg), 50.0 m/s less than the target asks.",
                                    most_m_s, problem_.launch_azimuth_rad.low * kDegPerRad)));
  problem_.target_velocity_m_s = least_m_s - 30.0;
  EXPECT_THAT(Describe(),
              HasSubstr(fmt::format(" Energy: at the target's altitude and angle the vehicle has at least {:.1f} m/s "
                                    "(launch azimuth {:.6g} deg), 30.0 m/s more than the target asks; the bounds of the "
                                    "launch azimuth do not let it spend the surplus.",
                                    least_m_s, problem_.launch_azimuth_rad.high * kDegPerRad)));
  problem_.target_velocity_m_s = 0.5 * (least_m_s + most_m_s);
  EXPECT_THAT(Describe(), Not(HasSubstr("Energy")));
}

// The shipped coast, 374 s, is beyond either range.
TEST_F(Shortfall, NamesTheBoundThatIsInTheWay) {
  result_.refinement.status = LeastSquaresStatus::kStalled;
  problem_.coast_s = {200.0, 250.0};
  result_.refined.coast_s = 225.0;
  EXPECT_THAT(Describe(), HasSubstr(" Bound: for altitude and angle coast is at the upper end of its bounds (250 s)."));
  problem_.coast_s = {430.0, 600.0};
  result_.refined.coast_s = 500.0;
  EXPECT_THAT(Describe(), HasSubstr(" Bound: for altitude and angle coast is at the lower end of its bounds (430 s)."));
}

}  // namespace
}  // namespace dispersa::trajectory_shortfall_test
