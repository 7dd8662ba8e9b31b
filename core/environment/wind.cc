#include "core/environment/wind.h"

#include <algorithm>
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

bool AllFinite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

template <typename Part>
void Append(const std::vector<Part>& parts, const std::string& name, std::vector<std::string>& problems) {
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (const std::string& problem : Problems(parts[i]))
      problems.push_back(name + "[" + std::to_string(i) + "]: " + problem);
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

std::vector<std::string> Problems(const JetStream& jet) {
  std::vector<std::string> problems;
  if (!(std::isfinite(jet.max_speed_m_s) && jet.max_speed_m_s >= 0.0))
    problems.emplace_back("the maximum speed of a jet stream must be finite and not negative");
  if (!std::isfinite(jet.altitude_m)) problems.emplace_back("the altitude of a jet stream must be finite");
  if (!(std::isfinite(jet.width_m) && jet.width_m > 0.0))
    problems.emplace_back("the width of a jet stream must be finite and positive");
  if (!std::isfinite(jet.azimuth_from_rad))
    problems.emplace_back("the azimuth of a jet stream must be finite");
  return problems;
}

std::vector<std::string> Problems(const WindTable& table) {
  std::vector<std::string> problems;
  if (table.altitude_m.size() < 2) problems.emplace_back("a wind table needs at least two altitudes");
  if (!IsStrictlyIncreasing(table.altitude_m))
    problems.emplace_back("the altitudes of a wind table must be finite and strictly increasing");
  if (table.north_m_s.size() != table.altitude_m.size() || table.east_m_s.size() != table.altitude_m.size())
    problems.emplace_back("a wind table needs one north and one east value for each altitude");
  if (!AllFinite(table.north_m_s) || !AllFinite(table.east_m_s))
    problems.emplace_back("the values of a wind table must be finite");
  return problems;
}

std::vector<std::string> Problems(const Gust& gust) {
  std::vector<std::string> problems;
  if (!(std::isfinite(gust.speed_m_s) && gust.speed_m_s >= 0.0))
    problems.emplace_back("the speed of a gust must be finite and not negative");
  if (!std::isfinite(gust.start_altitude_m))
    problems.emplace_back("the start altitude of a gust must be finite");
  if (!(std::isfinite(gust.length_m) && gust.length_m > 0.0))
    problems.emplace_back("the length of a gust must be finite and positive");
  if (!std::isfinite(gust.azimuth_from_rad)) problems.emplace_back("the azimuth of a gust must be finite");
  return problems;
}

std::vector<std::string> Problems(const SteadyWind& steady) {
  if (std::isfinite(steady.north_m_s) && std::isfinite(steady.east_m_s)) return {};
  return {"the components of a steady wind must be finite"};
}

std::vector<std::string> Problems(const Wind& wind) {
  std::vector<std::string> problems;
  Append(wind.jets, "jets", problems);
  Append(wind.tables, "tables", problems);
  Append(wind.gusts, "gusts", problems);
  for (const std::string& problem : Problems(wind.steady)) problems.push_back("steady: " + problem);
  return problems;
}

}  // namespace dispersa
