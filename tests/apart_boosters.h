// Boosters, as tests compute them by hand.
#pragma once

#include "core/dynamics/jettison.h"
#include "core/math/linear.h"
#include "tests/test.h"

namespace dispersa {

/// One body: its mass, its moments of inertia along and across its axis, and its place: station, y, z.
struct Part {
  double kg, axial, across;
  Vector3 place;
};
/// Several bodies together.
struct Bodies {
  double mass_kg;
  Vector3 cg;  ///< station, y, z
  Matrix3 inertia;
};
/// By Huygens and Steiner.
inline Bodies SumOf(const std::vector<Part>& parts) {
  Bodies all{0.0, Vector3::Zero(), Matrix3::Zero()};
  for (const Part& part : parts) {
    all.mass_kg += part.kg;
    all.cg += part.kg * part.place;
  }
  all.cg /= all.mass_kg;
  for (const Part& part : parts) {
    Vector3 r = part.place - all.cg;
    r.x() = -r.x();  // stations count aft
    all.inertia += Matrix3(Vector3(part.axial, part.across, part.across).asDiagonal()) +
                   part.kg * (r.squaredNorm() * Matrix3::Identity() - r * r.transpose());
  }
  return all;
}

/// When boosters leave a turning launcher, the momentum and the centre of all parts stay. `all`: everything,
/// by hand; `leaving`: the bodies that leave. Returns by how much the launcher's centre of gravity has moved.
inline double ExpectSeparationKeepsMomentum(const LauncherPlant& plant, double since_s, const Bodies& all,
                                            const std::vector<Bodies>& leaving) {
  RigidBodyState s;
  s.p_EoC_I = {7e6, 1e5, -2e5};
  s.v_IC_I = {100.0, 7000.0, 50.0};
  s.w_IB_B = {0.01, -0.02, 0.03};
  s.q_IB = FromRotationVector(Vector3(0.3, -0.7, 0.2));
  const double propellant_kg = plant.stacks[0].burn.Propellant(since_s);
  const RigidBodyState left = AfterJettison(plant, 0, 0u, kBoostersGone, propellant_kg, since_s, s);
  double left_kg = all.mass_kg;
  Vector3 momentum = Vector3::Zero(), place = Vector3::Zero();
  for (const Bodies& body : leaving) {
    const RigidBodyState spent =
        AtPoint(s, Vector3(all.cg.x() - body.cg.x(), body.cg.y() - all.cg.y(), body.cg.z() - all.cg.z()));
    left_kg -= body.mass_kg;
    momentum += body.mass_kg * spent.v_IC_I;
    place += body.mass_kg * (spent.p_EoC_I - s.p_EoC_I);
  }
  momentum += left_kg * left.v_IC_I;
  place += left_kg * (left.p_EoC_I - s.p_EoC_I);
  EXPECT_NEAR((momentum - all.mass_kg * s.v_IC_I).norm(), 0.0, 1e-10 * momentum.norm());
  EXPECT_NEAR(place.norm() / all.mass_kg, 0.0, 1e-8);
  return (left.p_EoC_I - s.p_EoC_I).norm();
}

}  // namespace dispersa
