#include "core/structure/mass_points.h"

namespace dispersa {

namespace {

// Calls f(weight, station); the weights are lengths.
template <typename F>
void Gauss(double from_m, double to_m, F f) {
  constexpr double kPoint = 0.77459666924148337704, kOuter = 5.0 / 9.0, kMiddle = 8.0 / 9.0;
  const double middle = 0.5 * (from_m + to_m), half = 0.5 * (to_m - from_m);
  f(half * kOuter, middle - half * kPoint);
  f(half * kMiddle, middle);
  f(half * kOuter, middle + half * kPoint);
}

// The points in the order of their stations, and of `points` where these are equal.
std::vector<MassPoint> SortedByCell(const std::vector<MassPoint>& points,
                                    const std::vector<std::size_t>& cells, std::size_t cell_count) {
  std::vector<std::size_t> next(cell_count + 1);
  for (const std::size_t cell : cells) ++next[cell + 1];
  for (std::size_t cell = 0; cell < cell_count; ++cell) next[cell + 1] += next[cell];
  std::vector<MassPoint> sorted(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) sorted[next[cells[i]]++] = points[i];
  // Those of several masses in one cell.
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    const MassPoint point = sorted[i];
    std::size_t to = i;
    for (; to > 0 && sorted[to - 1].fixed_at_m > point.fixed_at_m; --to) sorted[to] = sorted[to - 1];
    if (to < i) sorted[to] = point;
  }
  return sorted;
}

}  // namespace

std::vector<MassPoint> MassPointsOf(const BeamMasses& masses, std::vector<double> cuts_m) {
  if (!std::is_sorted(cuts_m.begin(), cuts_m.end())) std::sort(cuts_m.begin(), cuts_m.end());
  std::vector<MassPoint> points;
  std::vector<std::size_t> cells;  // of the points: number of cuts ahead
  for (const SpreadMass& m : masses.spread) {
    double from_m = m.top_station_m;
    auto cut = std::upper_bound(cuts_m.begin(), cuts_m.end(), from_m);
    const auto add_up_to = [&](double to_m) {
      if (!(to_m > from_m)) return;
      Gauss(from_m, to_m, [&](double length_m, double x) {
        const double mass_kg = length_m * m.MassPerLength(x);
        points.push_back({x, x, mass_kg, mass_kg * m.Gyration2(x)});
        cells.push_back(static_cast<std::size_t>(cut - cuts_m.begin()));
      });
      from_m = to_m;
    };
    for (; cut != cuts_m.end() && *cut < m.bottom_station_m; ++cut) add_up_to(*cut);
    add_up_to(m.bottom_station_m);
  }
  for (const FixedMass& m : masses.fixed) {
    points.push_back({m.station_m, m.cg_station_m, m.mass_kg, m.inertia_kg_m2});
    cells.push_back(static_cast<std::size_t>(std::upper_bound(cuts_m.begin(), cuts_m.end(), m.station_m) -
                                             cuts_m.begin()));
  }
  return SortedByCell(points, cells, cuts_m.size() + 1);
}

}  // namespace dispersa
