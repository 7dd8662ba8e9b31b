#include "core/structure/free_body.h"

#include "core/math/functions.h"

namespace dispersa {

FreeBody::FreeBody(const BeamMasses& masses, const std::vector<double>& cuts_m)
    : points(MassPointsOf(masses, cuts_m)) {
  double first = 0.0;
  for (const MassPoint& m : points) {
    mass_kg += m.mass_kg;
    first += m.mass_kg * m.cg_station_m;
  }
  cg_station_m = first / mass_kg;
  for (const MassPoint& m : points)
    inertia_kg_m2 += m.mass_kg * Square(m.cg_station_m - cg_station_m) + m.inertia_kg_m2;
}

}  // namespace dispersa
