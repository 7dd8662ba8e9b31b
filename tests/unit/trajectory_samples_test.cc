// The quantities of each sample of a recorded ascent, from its position and velocity.
#include "core/campaign_yaml/load.h"
#include "core/math/constants.h"
#include "core/trajectory/ascent.h"
#include "tests/test.h"

namespace dispersa::trajectory_samples_test {
namespace {

TEST(AscentSamples, SpeedsAnglesAndLoadsAreThoseOfTheirState) {
  const Vehicle vehicle = LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml");
  const Reference reference = LoadReference(DISPERSA_CAMPAIGNS "/references/slv4_500km.yaml");
  const AscentModel model = BuildAscentModel(vehicle, 0.01);
  AscentOptions options;
  options.record = true;
  const AscentResult ascent = FlyAscent(model, reference.program, options);
  ASSERT_TRUE(ascent.completed);
  ASSERT_GT(ascent.samples.size(), 100u);
  const Earth& earth = model.plant.environment.earth;
  const Stage& last = vehicle.stages.back();
  int in_last_burn = 0;
  for (const AscentSample& s : ascent.samples) {
    const Vector3 over_ground = s.v_IC_I - Vector3(0.0, 0.0, earth.rotation_rate_rad_s).cross(s.p_EoC_I);
    EXPECT_NEAR(s.velocity_m_s, s.v_IC_I.norm(), 1e-9);
    EXPECT_NEAR(s.relative_velocity_m_s, over_ground.norm(), 1e-6);
    const double up = s.p_EoC_I.normalized().dot(s.v_IC_I) / s.v_IC_I.norm();
    EXPECT_NEAR(std::sin(s.flight_path_angle_rad), up, 1e-12) << s.time_s;
    if (over_ground.norm() > 1.0) {
      const double relative_up = s.p_EoC_I.normalized().dot(over_ground) / over_ground.norm();
      EXPECT_NEAR(std::sin(s.relative_path_angle_rad), relative_up, 1e-9) << s.time_s;
    }
    // The last motor above the air: thrust over weight at the standard gravity.
    if (s.stage < 4 || s.axial_load_g < 1.0) continue;
    EXPECT_NEAR(s.axial_load_g, last.motor.thrust_n / (s.mass_kg * 9.80665), 1e-5 * s.axial_load_g)
        << s.time_s;
    ++in_last_burn;
  }
  EXPECT_GT(in_last_burn, 10);
}

}  // namespace
}  // namespace dispersa::trajectory_samples_test
