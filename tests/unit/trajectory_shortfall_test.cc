// The statement about a target out of reach. The shipped program meets the shipped target. With its azimuth
// held, its speed is the only one at that altitude and angle, for any speed asked.
#include <fmt/format.h>

#include "core/campaign_yaml/load.h"
#include "core/math/constants.h"
#include "core/trajectory/shortfall.h"
#include "tests/test.h"

namespace dispersa::trajectory_shortfall_test {
namespace {

const AscentModel& Model() {
  static const AscentModel model =
      BuildAscentModel(LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml"), 0.01);
  return model;
}

// A search that ended with the shipped program.
struct Ended {
  Ended() {
    result.reference = LoadReference(DISPERSA_CAMPAIGNS "/references/slv4_500km.yaml");
    result.reference.constraints.clear();
    result.reference.evaluations = 4321;
    result.refined = result.reference.program;
    result.errors = {1234.0, -5.678, 0.1 * kRadPerDeg, -0.25 * kRadPerDeg, 1.5 * kRadPerDeg};
    result.refinement.status = LeastSquaresStatus::kStalled;
    problem = result.reference.problem;
    const double azimuth = result.refined.launch_azimuth_rad;
    problem.launch_azimuth_rad = {azimuth, azimuth};
  }
  std::string Text() const { return DescribeShortfall(Model(), problem, {}, result); }

  OptimizationResult result;
  TrajectoryProblem problem;
};

constexpr const char* kMissed =
    "The target is not reached: the best of 4321 ascents within the bounds ends +1.234 km, -5.678 m/s and "
    "+0.1000 deg from it.";
constexpr const char* kUntried = " Other bounds, populations and seeds were not tried.";

TEST(Shortfall, NamesTheConstraintsThatAreBrokenAndEnforced) {
  Ended ended;
  ended.result.refinement.status = LeastSquaresStatus::kConverged;
  ended.result.reference.constraints = {{"kept", 4.0, 5.0, 1.0, true},
                                        {"met_exactly", 5.0, 5.0, 0.0, true},
                                        {"broken_g", 8.5, 5.0, -3.5, true},
                                        {"reported", 9.0, 5.0, -4.0, false}};
  EXPECT_EQ(ended.Text(),
            kMissed + std::string(" Constraint: broken_g = 8.5 exceeds its limit of 5.") + kUntried);
}

TEST(Shortfall, NamesPlaneAndPerigeeWhereTheTargetDoes) {
  Ended ended;
  ended.result.refinement.status = LeastSquaresStatus::kConverged;
  ended.problem.target_inclination_rad = 1.0;
  ended.problem.target_argument_of_perigee_rad = 1.0;
  EXPECT_EQ(ended.Text(), kMissed +
                              std::string(" Its inclination is off by -0.2500 deg. Its argument of perigee "
                                          "is off by +1.500 deg. The refinement converged: every residual "
                                          "is within its tolerance.") +
                              kUntried);
}

// Of a target that is so much faster than the shipped one, with a reserve.
std::string EnergyOf(double faster_m_s, double reserve_m_s) {
  Ended ended;
  ended.problem.target_velocity_m_s += faster_m_s;
  ended.problem.velocity_reserve_m_s = reserve_m_s;
  return ended.Text();
}
constexpr const char* kSpeed = " Speed: at the target's altitude and angle the ";

TEST(Shortfall, OfSpeedIsWhatTheTargetAndItsReserveAskBeyondTheVehicles) {
  EXPECT_EQ(EnergyOf(60.0, 40.0),
            std::string(kMissed) + kSpeed +
                "faster end of the launch azimuth's bounds (160.452 deg) gives 7612.6 m/s, 100.0 m/s less "
                "than the target asks." +
                kUntried);
}

TEST(Shortfall, OfASurplusIsWhatTheVehicleHasBeyondTheTarget) {
  EXPECT_EQ(EnergyOf(-100.0, 0.0),
            std::string(kMissed) + kSpeed +
                "slower end of the launch azimuth's bounds (160.452 deg) gives 7612.6 m/s, 100.0 m/s more "
                "than the target asks." +
                kUntried);
}

// The Earth turns eastwards: of two azimuths the one nearer to east is the faster, whichever bound it is.
TEST(Shortfall, OfTwoAzimuthsTheOneNearerToEastHasTheMost) {
  Ended ended;
  const double shipped = ended.result.refined.launch_azimuth_rad;
  ended.problem.target_velocity_m_s += 100.0;
  ended.problem.launch_azimuth_rad = {shipped, 178.0 * kRadPerDeg};
  EXPECT_THAT(
      ended.Text(),
      HasSubstr("faster end of the launch azimuth's bounds (160.452 deg) gives 7612.6 m/s, 100.0 m/s less"));
  // As far west of south as the other azimuth is east of it.
  ended.problem.launch_azimuth_rad = {-178.0 * kRadPerDeg, shipped};
  EXPECT_THAT(
      ended.Text(),
      HasSubstr("faster end of the launch azimuth's bounds (160.452 deg) gives 7612.6 m/s, 100.0 m/s less"));
}

// With nothing left to move altitude and angle stay off, and energy carries the speed to the target's radius.
TEST(Shortfall, CarriesTheSpeedToTheTargetsAltitudeByEnergy) {
  Ended ended;
  const FlightProgram& program = ended.result.refined;
  ended.problem.alpha_max_rad = {program.alpha_max_rad, program.alpha_max_rad};
  ended.problem.coast_s = {program.coast_s, program.coast_s};
  ended.problem.target_altitude_m = 400e3;
  AscentOptions options;
  options.steps = TrajectoryOptions().steps;
  const AscentResult ascent = FlyAscent(Model(), program, options);
  const double r = ascent.p_EoC_I.norm(), v = ascent.v_IC_I.norm(), mu = 3.986004418e14;
  const double carried = std::sqrt(v * v + 2.0 * mu / (r - 100e3) - 2.0 * mu / r);
  EXPECT_EQ(ended.Text(),
            kMissed +
                fmt::format(" Speed: carried to the target's altitude the slower end of the launch azimuth's "
                            "bounds (160.452 deg) gives {:.1f} m/s, {:.1f} m/s more than the target asks.",
                            carried, carried - ended.problem.target_velocity_m_s) +
                kUntried);
}

// The shipped program's 5.418 deg is what altitude and angle take.
TEST(Shortfall, NamesTheEndOfTheBoundsThatHoldsAltitudeAndAngle) {
  for (const bool upper : {true, false}) {
    Ended ended;
    ended.problem.velocity_is_free = true;
    const double end = (upper ? 5.0 : 5.8) * kRadPerDeg;
    (upper ? ended.problem.alpha_max_rad.high : ended.problem.alpha_max_rad.low) = end;
    ended.result.refined.alpha_max_rad = end;
    EXPECT_THAT(
        ended.Text(),
        HasSubstr(
            upper
                ? " alpha_max stops at the upper end of its bounds (5 deg); the best program has 5.4178 deg."
                : " alpha_max stops at the lower end of its bounds (5.8 deg); the best program has 5.4178 "
                  "deg."));
    ended.result.reference.program.alpha_max_rad = end;
    EXPECT_THAT(ended.Text(), HasSubstr(upper ? "of its bounds (5 deg)." : "of its bounds (5.8 deg)."));
    EXPECT_THAT(ended.Text(), Not(HasSubstr("Speed:")));
  }
}

TEST(Shortfall, OfAProgramThatFallsBackIsHowLongItFlies) {
  Ended ended;
  ended.result.reference.program.alpha_max_rad = 40.0 * kRadPerDeg;
  const AscentResult fallen =
      FlyAscent(Model(), ended.result.reference.program, {.steps = TrajectoryOptions().steps});
  ASSERT_FALSE(fallen.completed);
  EXPECT_EQ(
      ended.Text(),
      fmt::format("The target is not reached: none of 4321 ascents within the bounds comes to an orbit; the "
                  "best flies {:.1f} s. Other bounds, populations and seeds were not tried.",
                  fallen.end_time_s));
}

// An engine that is cut off at a speed and has propellant left: neither energy nor azimuth is the cause.
TEST(Shortfall, OfAnEngineThatIsCutOffIsItsSpeed) {
  const AscentModel model =
      BuildAscentModel(LoadVehicle(DISPERSA_CAMPAIGNS "/gallery/electron/vehicle.yaml"), 0.01);
  Ended ended;
  ended.result.reference = LoadReference(DISPERSA_CAMPAIGNS "/gallery/electron/reference.yaml");
  ended.result.reference.constraints.clear();
  ended.result.refined = ended.result.reference.program;
  ended.problem = ended.result.reference.problem;
  ended.problem.target_velocity_m_s = 7938.27;
  // Its refinement converges at altitude and angle, whatever the speed.
  for (const LeastSquaresStatus status : {LeastSquaresStatus::kStalled, LeastSquaresStatus::kConverged}) {
    ended.result.refinement.status = status;
    const std::string text = DescribeShortfall(model, ended.problem, {}, ended.result);
    EXPECT_THAT(text,
                HasSubstr(" Cut-off: the last engine is cut off at 7898.270 m/s, 40.000 m/s less than the "
                          "target asks."));
    EXPECT_THAT(text, Not(HasSubstr("Speed:")));
    EXPECT_THAT(text, Not(HasSubstr("converged")));
  }
}

TEST(Shortfall, OfAFewMetresIsNarrow) {
  Ended ended;
  ended.result.refinement.status = LeastSquaresStatus::kConverged;
  ended.result.errors = {0.0, 0.001, 0.0};
  EXPECT_THAT(
      ended.Text(),
      HasSubstr("The target is narrowly missed: the best of 4321 ascents within the bounds ends +0.000 km, "
                "+0.001 m/s and +0.0000 deg from it."));
  // Rounded to what is shown, nothing is negative.
  ended.result.errors = {-1e-4, 0.001, -1e-9};
  EXPECT_THAT(ended.Text(), HasSubstr("ends +0.000 km, +0.001 m/s and +0.0000 deg from it."));
}

// Nothing is missed but a constraint.
TEST(Shortfall, OfAConstraintAloneMissesNoTarget) {
  Ended ended;
  ended.result.refinement.status = LeastSquaresStatus::kConverged;
  ended.result.tolerance = {1.0, 1e-3, 1e-8, 1e-8, 1e-8};
  ended.result.errors = {-0.5, 0.0005, 0.0};
  ended.result.reference.constraints = {{"broken_g", 8.5, 5.0, -3.5, true}};
  EXPECT_EQ(ended.Text(),
            std::string("The target is reached, but by none of 4321 ascents with every constraint met. "
                        "Constraint: broken_g = 8.5 exceeds its limit of 5.") +
                kUntried);
}

}  // namespace
}  // namespace dispersa::trajectory_shortfall_test
