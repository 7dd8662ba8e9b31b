#include "core/environment/wind.h"

#include <cmath>
#include <cstddef>

#include "core/math/constants.h"
#include "core/math/functions.h"
#include "core/math/table.h"

namespace dispersa {
namespace {

void Add(const WindNorthEast& part, WindNorthEast& sum) {
  sum.north_m_s += part.north_m_s;
  sum.east_m_s += part.east_m_s;
}

WindNorthEast Evaluate(const JetStream& jet, double altitude_m) {
  const double x = (altitude_m - jet.altitude_m) / jet.width_m;
  if (!(std::fabs(x) < 1.0)) return {};
  return FromAzimuth(jet.max_speed_m_s * Square(Cos(0.5 * kPi * x)), jet.azimuth_from_rad);
}

WindNorthEast Evaluate(const Gust& gust, double altitude_m) {
  const double x = (altitude_m - gust.start_altitude_m) / gust.length_m;
  if (!(x > 0.0 && x < 1.0)) return {};
  return FromAzimuth(0.5 * gust.speed_m_s * (1.0 - Cos(kTwoPi * x)), gust.azimuth_from_rad);
}

WindNorthEast Evaluate(const WindTable& table, double altitude_m) {
  const double above = (altitude_m - table.altitude_m.back()) / kWindFade_m;
  if (above >= 1.0) return {};
  const double fade = above > 0.0 ? 1.0 - above : 1.0;
  const GridPosition at = Locate(table.altitude_m, altitude_m);
  const double low = fade * (1.0 - at.fraction);
  const double high = fade * at.fraction;
  return {low * table.north_m_s[at.index] + high * table.north_m_s[at.index + 1],
          low * table.east_m_s[at.index] + high * table.east_m_s[at.index + 1]};
}

}  // namespace

WindNorthEast FromAzimuth(double speed_m_s, double azimuth_from_rad) {
  const SinCos azimuth = SineCosine(azimuth_from_rad);
  return {-speed_m_s * azimuth.cos, -speed_m_s * azimuth.sin};
}

WindNorthEast Evaluate(const Wind& wind, double altitude_m) {
  WindNorthEast sum = wind.steady;
  for (const JetStream& jet : wind.jets) Add(Evaluate(jet, altitude_m), sum);
  for (const WindTable& table : wind.tables) Add(Evaluate(table, altitude_m), sum);
  for (const Gust& gust : wind.gusts) Add(Evaluate(gust, altitude_m), sum);
  return sum;
}

}  // namespace dispersa
