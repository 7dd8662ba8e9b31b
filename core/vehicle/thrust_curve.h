// A motor's thrust over the time since ignition, as tests give it, and the same prepared for burns.
//
// Thrust is linear between the corners. The exhaust velocity is constant, so the flow is proportional to the
// vacuum thrust and what has been burnt is a parabola on each piece, in closed form; the propellant is used
// up where the curve ends.
#pragma once

#include <cstddef>
#include <vector>

#include "core/math/aligned_rows.h"

namespace dispersa {

/// Sea level of the U.S. Standard Atmosphere, 1976: what a static firing "at sea level" stands for.
inline constexpr double kSeaLevelPressure_pa = 101325.0;
/// Every corner ends an integration step.
inline constexpr std::size_t kThrustCurveCorners = 1000;

struct ThrustCurve {
  std::vector<double> time_s;    ///< since ignition, from 0, each larger than the one before
  std::vector<double> thrust_n;  ///< in vacuum; 0 or more

  bool empty() const { return time_s.empty(); }
  double Greatest() const;
  double Impulse() const;  ///< N s
};

/// A curve measured under the pressure of sea level, in vacuum: P + p A_e. Where the measured thrust is 0
/// nothing flows, and it stays 0.
ThrustCurve InVacuum(ThrustCurve at_sea_level, double exit_area_m2);

/// A curve by level, thrust over its greatest thrust, prepared to be looked up.
struct BurnCurve {
  /// Of each piece: a time on it, s, the level there, its slope, 1/s, and the part of the propellant that is
  /// left there. That time is the piece's beginning, but of the last piece its end, so that nothing is left
  /// there.
  static constexpr int kRowSize = 4;
  AlignedRows rows;
  std::vector<double> begin_s;  ///< of each piece
  double end_s = 0.0;
};
BurnCurve Prepare(const ThrustCurve& curve);

}  // namespace dispersa
