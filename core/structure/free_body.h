// The rest of a beam after a part has left. It moves on with the momentum of its masses.
#pragma once

#include <vector>

#include "core/structure/mass_points.h"

namespace dispersa {

/// A body after the separation. Its masses keep the positions and velocities that they had in the modes of
/// the whole beam. A shape is a function of a point and its number; it returns the StationShape of the beam
/// there.
struct FreeBody {
  std::vector<MassPoint> points;
  double mass_kg = 0.0, cg_station_m = 0.0, inertia_kg_m2 = 0.0;  ///< across the axis

  /// `cuts_m`: see MassPointsOf.
  FreeBody(const BeamMasses& masses, const std::vector<double>& cuts_m);

  /// The mean displacement and rotation of the body by a shape. A rigid motion by these has the momentum and
  /// the angular momentum of the masses.
  template <typename Shape>
  auto MeanOf(const Shape& at) const {
    decltype(at(points[0], 0)) sum;
    sum.deflection = sum.slope_1_m = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const MassPoint& m = points[i];
      const auto shape = m.Move(at(m, i));
      sum.deflection = sum.deflection + m.mass_kg * shape.deflection;
      sum.slope_1_m = sum.slope_1_m + (m.mass_kg * shape.deflection * (m.cg_station_m - cg_station_m) +
                                       m.inertia_kg_m2 * shape.slope_1_m);
    }
    sum.deflection = sum.deflection / mass_kg;
    sum.slope_1_m = sum.slope_1_m / inertia_kg_m2;
    return sum;
  }

  /// The integral over its masses of one shape times another, kg: the work of the inertia of `b` on `a`.
  template <typename A, typename B>
  double Product(const A& a, const B& b) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const MassPoint& m = points[i];
      const StationShape of_a = m.Move(a(m, i)), of_b = m.Move(b(m, i));
      sum +=
          m.mass_kg * of_a.deflection * of_b.deflection + m.inertia_kg_m2 * of_a.slope_1_m * of_b.slope_1_m;
    }
    return sum;
  }
};

}  // namespace dispersa
