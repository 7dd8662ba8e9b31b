// Boosters that are bodies of their own, as tests compute them by hand, and compared with boosters all alike.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/dynamics/jettison.h"
#include "core/math/linear.h"
#include "tests/flown_ticks.h"

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

/// Boosters at equal angles with nothing to tell them apart fly as the model of boosters all alike says.
inline void ExpectFliesAsAllAlike(const FlightDefinition& apart, const FlightInputs& inputs) {
  FlightDefinition together = apart;
  together.vehicle.boosters.angles_rad = {};
  FlightResult one, many;
  const auto a = TicksOf(together, inputs, &one), b = TicksOf(apart, inputs, &many);
  ASSERT_EQ(one.outcome, Outcome::kCompleted) << one.reason;
  ASSERT_EQ(a.size(), b.size());
  double rates = 0.0, speeds = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    rates = std::max(rates, (a[i].state.w_IB_B - b[i].state.w_IB_B).norm());
    speeds = std::max(speeds, (a[i].state.v_IC_I - b[i].state.v_IC_I).norm());
  }
  EXPECT_LT(rates, 1e-7);
  EXPECT_LT(speeds, 1e-5);
}

}  // namespace dispersa
