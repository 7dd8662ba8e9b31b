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

}  // namespace

std::vector<MassPoint> MassPointsOf(const BeamMasses& masses, std::vector<double> cuts_m) {
  std::vector<MassPoint> points;
  std::sort(cuts_m.begin(), cuts_m.end());
  for (const SpreadMass& m : masses.spread) {
    double from_m = m.top_station_m;
    const auto add_up_to = [&](double to_m) {
      if (!(to_m > from_m)) return;
      Gauss(from_m, to_m, [&](double length_m, double x) {
        const double mass_kg = length_m * m.MassPerLength(x);
        points.push_back({x, x, mass_kg, mass_kg * m.Gyration2(x)});
      });
      from_m = to_m;
    };
    for (const double cut_m : cuts_m)
      if (cut_m > m.top_station_m && cut_m < m.bottom_station_m) add_up_to(cut_m);
    add_up_to(m.bottom_station_m);
  }
  for (const FixedMass& m : masses.fixed)
    points.push_back({m.station_m, m.cg_station_m, m.mass_kg, m.inertia_kg_m2});
  std::stable_sort(points.begin(), points.end(),
                   [](const MassPoint& a, const MassPoint& b) { return a.fixed_at_m < b.fixed_at_m; });
  return points;
}

}  // namespace dispersa
