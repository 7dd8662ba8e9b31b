// Margins from tabulated responses against the exact ones.
#include "core/margins/loop_table.h"

#include "core/math/constants.h"
#include "tests/test.h"

namespace dispersa::margins_loop_table_test {
namespace {

constexpr double kTick_s = 0.01;

// A body that the air turns over, an actuator of 25 rad/s, and one bending mode at 18 rad/s that two gyros
// feel.
AxisPlant Bending(double instability_1_s2) {
  AxisPlant plant;
  plant.a = Eigen::MatrixXd::Zero(6, 6);
  plant.b = Eigen::VectorXd::Zero(6);
  plant.a(0, 1) = plant.a(2, 3) = plant.a(4, 5) = 1.0;
  plant.a(1, 0) = instability_1_s2;
  plant.a(1, 1) = -0.05;
  plant.a(1, 2) = 3.0;
  plant.a(3, 2) = -625.0;
  plant.a(3, 3) = -35.0;
  plant.b[3] = 625.0;
  plant.a(5, 2) = 20.0;
  plant.a(5, 4) = -324.0;
  plant.a(5, 5) = -0.36;
  plant.attitude = Eigen::RowVectorXd::Unit(6, 0);
  Eigen::RowVectorXd fore = Eigen::RowVectorXd::Unit(6, 1), aft = fore;
  fore[5] = -0.05;
  aft[5] = 0.02;
  plant.rates = {{fore, {}, 0.3, 0.0}, {aft, {}, 0.7, 0.0}};
  plant.lowest_mode_rad_s = 18.0;
  return plant;
}

LinearLaw Pid(double kp, double kd, double ki) {
  LinearLaw law;
  law.kp_1_s2 = kp;
  law.kd_1_s = kd;
  law.drive_error = ki;
  law.effectiveness_1_s2 = 3.0;
  law.filters = {Discretise({.poles_rad_s = 200.0, .poles_damping = 0.5}, kTick_s)};
  return law;
}

TEST(LoopTable, HasTheLeastOfTheExactMargins) {
  for (const double instability : {0.0, 0.02, 2.0, 5.0, -3.0}) {
    for (const LinearLaw& law : {Pid(8.0, 4.0, 0.5), Pid(12.0, 4.0, 0.2), Pid(6.0, 3.0, 0.0)}) {
      const AxisPlant plant = Bending(instability);
      const LoopMargins exact = SampledLoop(plant, law, kTick_s, 1).Margins();
      const LoopTable table(plant, kTick_s, 1);
      const std::vector<double> weights = {0.3, 0.7};
      ASSERT_TRUE(exact.stable) << instability;
      // One gate at a time, the others so low that they never decide. A peak of bending that is attenuated by
      // less than the gate is held by its phase.
      const double gain_db = 20.0 * (table.Surplus(law, weights, {20.0, 1e-3, 0.0}) + 1.0);
      const double least_db = std::min(exact.gain_up_db, exact.gain_down_db);
      if (least_db < 20.0) {
        EXPECT_NEAR(gain_db, least_db, 0.1) << instability;
      }
      const double phase_deg = 90.0 * (table.Surplus(law, weights, {1e-3, 90.0, 0.0}) + 1.0);
      if (exact.bending_peak_db < -3.0) {
        EXPECT_NEAR(phase_deg, exact.phase_deg, 1.0) << instability;
      }
    }
  }
}

TEST(LoopTable, TellsAnUnstableLoop) {
  const std::vector<double> weights = {0.3, 0.7};
  for (const LinearLaw& law : {Pid(2.0, 2.0, 0.1), Pid(3.0, 60.0, 0.0), Pid(8.0, 0.1, 5.0)}) {
    const AxisPlant plant = Bending(5.0);
    EXPECT_FALSE(SampledLoop(plant, law, kTick_s, 1).Margins().stable);
    EXPECT_LE(LoopTable(plant, kTick_s, 1).Surplus(law, weights, {6.0, 30.0, 0.0}), -2.0);
  }
}

}  // namespace
}  // namespace dispersa::margins_loop_table_test
