// Boosters that are bodies of their own, as tests compute them by hand, and compared with boosters all alike.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

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
