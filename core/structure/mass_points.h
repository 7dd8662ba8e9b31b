// The masses of a beam as points. Sums over the masses are sums over these points.
#pragma once

#include <algorithm>
#include <vector>

#include "core/structure/bending_modes.h"
#include "core/vehicle/beam_masses.h"

namespace dispersa {

/// A small part of a beam's mass. It moves with the beam's cross-section at `fixed_at_m`.
struct MassPoint {
  double fixed_at_m = 0.0;    ///< station of the beam
  double cg_station_m = 0.0;  ///< of the part; a lumped body has its own
  double mass_kg = 0.0;
  double inertia_kg_m2 = 0.0;  ///< about its own centre, across the axis

  /// The motion of the part, as a rigid body that is fixed to the beam at `fixed_at_m`. A shape is a
  /// StationShape, or has the same members for several modes side by side.
  template <typename Shape>
  Shape Move(Shape at_fixed) const {
    at_fixed.deflection = at_fixed.deflection + at_fixed.slope_1_m * (cg_station_m - fixed_at_m);
    return at_fixed;
  }
};

/// The masses, from the nose aft by their stations on the beam. Spread masses are taken by Gauss's rule of
/// three points between the stations `cuts_m` (in any order), which is exact to the fifth power. So sums over
/// modes are cut at the nodes, between which a mode is a cubic. Cells of half the length change a moment of a
/// mode by less than 1e-6 (structure_near_modes_test).
std::vector<MassPoint> MassPointsOf(const BeamMasses& masses, std::vector<double> cuts_m);

/// A shape that is a function of the beam's station, for the sums over points.
template <typename Shape>
auto AtStations(const Shape& shape) {
  return [&shape](const MassPoint& m, std::size_t) { return StationShape(shape(m.fixed_at_m)); };
}

/// Moment (N m) on the section at a station s by the inertia of the mass ahead of it. A shape gives the
/// acceleration: m/s² as deflection, 1/s² as slope. The moment is the integral of m (deflection (s - x) - g²
/// slope); g is the radius of gyration of the mass about its own section. `points` are cut at the station.
/// `shape_at` returns the StationShape of the beam at a point, by the point and its number.
template <typename Shape>
auto InertiaMoment(const std::vector<MassPoint>& points, double station_m, const Shape& shape_at) {
  decltype(shape_at(points[0], 0).deflection) sum = 0.0;
  for (std::size_t i = 0; i < points.size() && points[i].fixed_at_m <= station_m; ++i) {
    const MassPoint& m = points[i];
    const auto shape = m.Move(shape_at(m, i));
    sum = sum +
          (m.mass_kg * shape.deflection * (station_m - m.cg_station_m) - m.inertia_kg_m2 * shape.slope_1_m);
  }
  return sum;
}

}  // namespace dispersa
