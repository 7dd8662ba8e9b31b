#include "core/vehicle/thrust_curve.h"

#include <algorithm>

namespace dispersa {

double ThrustCurve::Greatest() const {
  return thrust_n.empty() ? 0.0 : *std::max_element(thrust_n.begin(), thrust_n.end());
}

double ThrustCurve::Impulse() const {
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < time_s.size(); ++i)
    sum += 0.5 * (thrust_n[i] + thrust_n[i + 1]) * (time_s[i + 1] - time_s[i]);
  return sum;
}

ThrustCurve InVacuum(ThrustCurve at_sea_level, double exit_area_m2) {
  for (double& thrust_n : at_sea_level.thrust_n)
    if (thrust_n > 0.0) thrust_n += kSeaLevelPressure_pa * exit_area_m2;
  return at_sea_level;
}

BurnCurve Prepare(const ThrustCurve& curve) {
  const double greatest_n = curve.Greatest(), impulse_n_s = curve.Impulse();
  const std::size_t pieces = curve.time_s.size() - 1;
  BurnCurve prepared;
  prepared.end_s = curve.time_s.back();
  double burnt_n_s = 0.0;
  for (std::size_t i = 0; i < pieces; ++i) {
    const double length_s = curve.time_s[i + 1] - curve.time_s[i];
    const double from_n = curve.thrust_n[i], to_n = curve.thrust_n[i + 1];
    const bool is_last = i + 1 == pieces;
    prepared.begin_s.push_back(curve.time_s[i]);
    prepared.rows.insert(
        prepared.rows.end(),
        {is_last ? prepared.end_s : curve.time_s[i], (is_last ? to_n : from_n) / greatest_n,
         (to_n - from_n) / length_s / greatest_n, is_last ? 0.0 : 1.0 - burnt_n_s / impulse_n_s});
    burnt_n_s += 0.5 * (from_n + to_n) * length_s;
  }
  return prepared;
}

}  // namespace dispersa
