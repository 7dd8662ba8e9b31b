#pragma once

#include <algorithm>

#include "core/structure/bending_modes.h"
#include "core/vehicle/beam_masses.h"

namespace dispersa {

/// What the mass ahead of a station, accelerated as a shape says (m/s² and 1/s², as deflection and slope),
/// loads the section there with: the integral of m (deflection (s - x) - g² slope), N m; g: the radius of
/// gyration of the mass about its own section. `shape_at`: StationShape of a station, m.
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
