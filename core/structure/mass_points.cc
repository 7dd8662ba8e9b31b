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

// f(cell, from, to) for each piece of a mass between cuts; a cell has so many cuts ahead.
template <typename F>
void ForEachCell(const SpreadMass& m, const std::vector<double>& cuts_m, F f) {
  double from_m = m.top_station_m;
  std::size_t cell =
      static_cast<std::size_t>(std::upper_bound(cuts_m.begin(), cuts_m.end(), from_m) - cuts_m.begin());
  for (; cell < cuts_m.size() && cuts_m[cell] < m.bottom_station_m; ++cell) {
    if (cuts_m[cell] > from_m) f(cell, from_m, cuts_m[cell]);
    from_m = cuts_m[cell];
  }
  if (m.bottom_station_m > from_m) f(cell, from_m, m.bottom_station_m);
}

std::size_t CellOf(const FixedMass& m, const std::vector<double>& cuts_m) {
  return static_cast<std::size_t>(std::upper_bound(cuts_m.begin(), cuts_m.end(), m.station_m) -
                                  cuts_m.begin());
}

}  // namespace

std::vector<MassPoint> MassPointsOf(const BeamMasses& masses, std::vector<double> cuts_m) {
  if (!std::is_sorted(cuts_m.begin(), cuts_m.end())) std::sort(cuts_m.begin(), cuts_m.end());
  // The place of the next point of each cell.
  std::vector<std::size_t> next(cuts_m.size() + 2);
  for (const SpreadMass& m : masses.spread)
    ForEachCell(m, cuts_m, [&](std::size_t cell, double, double) { next[cell + 1] += 3; });
  for (const FixedMass& m : masses.fixed) ++next[CellOf(m, cuts_m) + 1];
  for (std::size_t cell = 0; cell + 1 < next.size(); ++cell) next[cell + 1] += next[cell];
  std::vector<MassPoint> points(next.back());
  for (const SpreadMass& m : masses.spread) {
    const bool is_uniform = m.IsUniform();
    ForEachCell(m, cuts_m, [&](std::size_t cell, double from_m, double to_m) {
      MassPoint* point = &points[next[cell]];
      next[cell] += 3;
      Gauss(from_m, to_m, [&](double length_m, double x) {
        const double mass_kg = length_m * (is_uniform ? m.mass_per_length_kg_m.top : m.MassPerLength(x));
        *point++ = {x, x, mass_kg, mass_kg * (is_uniform ? m.gyration2_m2.top : m.Gyration2(x))};
      });
    });
  }
  for (const FixedMass& m : masses.fixed)
    points[next[CellOf(m, cuts_m)]++] = {m.station_m, m.cg_station_m, m.mass_kg, m.inertia_kg_m2};
  // Those of several masses in one cell. Masses at one station stay in their order.
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (!(points[i - 1].fixed_at_m > points[i].fixed_at_m)) continue;
    const MassPoint point = points[i];
    std::size_t to = i;
    for (; to > 0 && points[to - 1].fixed_at_m > point.fixed_at_m; --to) points[to] = points[to - 1];
    points[to] = point;
  }
  return points;
}

}  // namespace dispersa
