// The refinement finds the one program of its unknowns that meets the target, from wherever the search ended, in a
// few steps; and the attitude program that comes of it has a knot at every kink.
#include "core/trajectory/refine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/campaign_yaml/load.h"
#include "core/math/constants.h"

namespace dispersa::trajectory_refine_test {
namespace {

struct Shipped {
  const OptimizationInput input = LoadOptimization(DISPERSA_CAMPAIGNS "/slv4_500km.yaml");
  const FlightProgram program = LoadReference(DISPERSA_CAMPAIGNS "/references/slv4_500km.yaml").program;
  const TrajectoryOptions options;
  const AscentModel model = BuildAscentModel(input.vehicle, options.tick_s);
};

TEST(RefineProgram, FindsTheSameProgramFromAroundInAFewSteps) {
  const Shipped shipped;
  for (const double way : {-1.0, 1.0}) {
    FlightProgram program = shipped.program;
    program.alpha_max_rad += way * 0.3 * kRadPerDeg;
    program.coast_s -= way * 15.0;
    program.launch_azimuth_rad += way * 2.0 * kRadPerDeg;
    AscentResult ascent;
    const LeastSquaresResult refined =
        RefineProgram(shipped.model, shipped.input.problem, shipped.options, &program, &ascent);
    EXPECT_EQ(refined.status, LeastSquaresStatus::kConverged);
    EXPECT_TRUE(refined.held_at_bound.empty());
    EXPECT_TRUE(IsWithin(ErrorsOf(shipped.input.problem, ascent.orbit), shipped.options.tolerance));
    // A metre of altitude, a millimetre a second and a microdegree: what the tolerances leave of each unknown.
    EXPECT_NEAR(program.alpha_max_rad, shipped.program.alpha_max_rad, 1e-6);
    EXPECT_NEAR(program.coast_s, shipped.program.coast_s, 1e-3);
    EXPECT_NEAR(program.launch_azimuth_rad, shipped.program.launch_azimuth_rad, 1e-6);
    // Four flights a step of three unknowns; Newton's method doubles the right digits with each.
    EXPECT_LE(refined.evaluations, 40);
  }
}

TEST(AscentRecord, HasAKnotWhereTheProgramsSlopeChanges) {
  const Shipped shipped;
  AscentOptions options;
  options.record = true;
  const AscentResult ascent = FlyAscent(shipped.model, shipped.program, options);
  for (const double kink_s : {shipped.program.t1_s, shipped.program.t3_s, shipped.program.t2_s, ascent.last_ignition_s}) {
    const auto& knots = ascent.attitude.knots;
    EXPECT_TRUE(std::any_of(knots.begin(), knots.end(),
                            [&](const AttitudeKnot& knot) { return std::fabs(knot.time_s - kink_s) < 1e-9; }))
        << kink_s;
  }
}

}  // namespace
}  // namespace dispersa::trajectory_refine_test
