#pragma once

#include <algorithm>

#include "core/structure/bending_modes.h"
#include "core/vehicle/beam_masses.h"

namespace dispersa {

/// Bending moment (N m) at a station from the inertia of the mass ahead of it: the integral of m (deflection
/// (s - x) - g² slope). `shape_at` gives the acceleration at a station (m) as a StationShape: deflection in
/// m/s², slope in 1/s². g is the radius of gyration of the mass about its own section.
template <typename Shape>
double InertiaMoment(const BeamMasses& masses, double station_m, const Shape& shape_at) {
  constexpr int kPieces = 200;
  double sum = 0.0;
  for (const SpreadMass& m : masses.spread) {
    const double from = m.top_station_m, to = std::min(m.bottom_station_m, station_m);
    if (to <= from) continue;
    const double step = (to - from) / kPieces;
    const auto at = [&](double x) {
      const StationShape shape = shape_at(x);
      return m.MassPerLength(x) * (shape.deflection * (station_m - x) - m.Gyration2(x) * shape.slope_1_m);
    };
    // Simpson's rule: exact up to the third power.
    for (int i = 0; i < kPieces; ++i) {
      const double x = from + step * i;
      sum += step / 6.0 * (at(x) + 4.0 * at(x + 0.5 * step) + at(x + step));
    }
  }
  for (const FixedMass& m : masses.fixed) {
    if (m.station_m > station_m) continue;
    const StationShape shape = shape_at(m.station_m);
    const double deflection = shape.deflection + shape.slope_1_m * (m.cg_station_m - m.station_m);
    sum += m.mass_kg * deflection * (station_m - m.cg_station_m) - m.inertia_kg_m2 * shape.slope_1_m;
  }
  return sum;
}

}  // namespace dispersa
