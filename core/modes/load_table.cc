#include "core/modes/load_table.h"

#include <algorithm>
#include <vector>

#include "core/math/functions.h"
#include "core/modes/load_stations.h"
#include "core/structure/mass_points.h"
#include "core/vehicle/beam_masses.h"
#include "core/vehicle/mass.h"

namespace dispersa {

LoadTable BuildLoadTable(const Vehicle& vehicle, int stage, const LoadTable* nominal) {
  const Stage& lowest = vehicle.stages[static_cast<std::size_t>(stage)];
  LoadTable table;
  const LoadStations chosen =
      nominal ? LoadStations{{nominal->station_m.begin(), nominal->station_m.begin() + nominal->stations},
                             nominal->scouts_see}
              : ChooseLoadStations(vehicle, stage, kLoadStations);
  const std::vector<double>& stations = chosen.station_m;
  table.stations = static_cast<int>(stations.size());
  table.scouts_see = chosen.scouts_see;
  std::copy(stations.begin(), stations.end(), table.station_m.begin());
  table.lift = DistributeLift(vehicle, stage, stations);
  table.lift.ForEach([](double) { return 1.0; },
                     [&](double at_m, double slender, double shift) {
                       for (std::size_t i = 0; i < stations.size(); ++i) {
                         const double ahead_m = std::max(table.station_m[i] - at_m, 0.0);
                         table.slender_arm_m[i] += slender * ahead_m;
                         table.shift_arm[i] += shift * ahead_m;
                       }
                     });
  const double full = lowest.propellant_mass_kg;
  const auto masses_at = [&](double propellant_kg) {
    return MassPointsOf(BuildBeamMasses(vehicle, stage, propellant_kg, kBoostersGone), stations);
  };
  const std::vector<MassPoint> masses[3] = {masses_at(0.0), masses_at(0.5 * full), masses_at(full)};
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const double station = stations[i];
    // The body accelerated sideways, and turning about the nose.
    double first[3], second[3];
    for (int k = 0; k < 3; ++k) {
      first[k] = InertiaMoment(masses[k], station, [](const MassPoint&, std::size_t) {
        return StationShape{1.0, 0.0};
      });
      second[k] = InertiaMoment(masses[k], station, [](const MassPoint& m, std::size_t) {
        return StationShape{m.fixed_at_m, 1.0};
      });
    }
    // The grain's mass per length follows its mass, its section's inertia the square of it: parabolas.
    const auto parabola = [&](const double(&at)[3]) -> std::array<double, 3> {
      const double curve = 2.0 * (at[2] + at[0] - 2.0 * at[1]) / Square(full);
      return {at[0], (at[2] - at[0]) / full - curve * full, curve};
    };
    table.first_kg_m[i] = {first[0], (first[2] - first[0]) / full, 0.0};
    if (lowest.is_liquid()) table.first_kg_m[i] = parabola(first);
    table.second_kg_m2[i] = parabola(second);
  }
  return table;
}

const LoadTable& NoLoads() {
  static const LoadTable none{};
  return none;
}

}  // namespace dispersa
