#include "core/structure/load_table.h"

#include <algorithm>
#include <vector>

#include "core/math/functions.h"
#include "core/structure/inertia_moment.h"
#include "core/vehicle/beam_masses.h"
#include "core/vehicle/mould_line.h"

namespace dispersa {

namespace {

// Slender-body shares follow the growth of the cross-section, shifts the planform about its centroid, so that
// all shares together are 1 and their centroid is where the centre of pressure is.
void ShareOut(const Vehicle& vehicle, const Stage& stage, LoadTable& table) {
  const std::vector<MouldSection> body = CutMouldLine(vehicle.profile, stage.bottom_station_m);
  const auto radius = [&](double station_m) {
    for (const MouldSection& section : body)
      if (station_m <= section.end_m) return section.Radius(std::max(station_m, section.start_m));
    return body.back().Radius(body.back().end_m);
  };
  constexpr int kPieces = 50;  // of a strip
  const double strip_m = stage.bottom_station_m / kStrips;
  const double base2 = radius(stage.bottom_station_m) * radius(stage.bottom_station_m);
  std::array<double, kStrips> planform{};
  double planform_sum = 0.0, planform_moment = 0.0;
  for (std::size_t i = 0; i < kStrips; ++i) {
    const double from = strip_m * static_cast<double>(i), to = from + strip_m;
    table.slender[i] = (radius(to) * radius(to) - radius(from) * radius(from)) / base2;
    table.strip_station_m[i] = 0.5 * (from + to);
    for (int k = 0; k < kPieces; ++k) planform[i] += radius(from + strip_m * (k + 0.5) / kPieces);
    table.slender_station_m += table.slender[i] * table.strip_station_m[i];
    planform_sum += planform[i];
    planform_moment += planform[i] * table.strip_station_m[i];
  }
  // The nose tip is a point: the first strip begins with no cross-section, whatever a blunt file says.
  const double blunt = radius(0.0) * radius(0.0) / base2;
  table.slender[0] += blunt;
  table.slender_station_m += blunt * table.strip_station_m[0];
  const double centroid_m = planform_moment / planform_sum;
  double spread = 0.0;
  for (std::size_t i = 0; i < kStrips; ++i) {
    const double arm = table.strip_station_m[i] - centroid_m;
    table.shift_1_m[i] = planform[i] * arm;
    spread += table.shift_1_m[i] * table.strip_station_m[i];
  }
  for (double& shift : table.shift_1_m) shift /= spread;
}

}  // namespace

LoadTable BuildLoadTable(const Vehicle& vehicle, int stage) {
  const Stage& lowest = vehicle.stages[static_cast<std::size_t>(stage)];
  LoadTable table;
  ShareOut(vehicle, lowest, table);
  const double full = lowest.propellant_mass_kg;
  const BeamMasses masses[3] = {BuildBeamMasses(vehicle, stage, 0.0),
                                BuildBeamMasses(vehicle, stage, 0.5 * full),
                                BuildBeamMasses(vehicle, stage, full)};
  for (std::size_t i = 0; i < kLoadStations; ++i) {
    const double station = lowest.bottom_station_m / kStrips * static_cast<double>(i + 1);
    table.station_m[i] = station;
    // The body accelerated sideways, and turning about the nose.
    double first[3], second[3];
    for (int k = 0; k < 3; ++k) {
      first[k] = InertiaMoment(masses[k], station, [](double) { return StationShape{1.0, 0.0}; });
      second[k] = InertiaMoment(masses[k], station, [](double x) { return StationShape{x, 1.0}; });
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

}  // namespace dispersa
