#include "core/environment/weather_ensemble.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/environment/surroundings.h"
#include "core/input/fields.h"
#include "core/math/assertion.h"
#include "core/math/functions.h"

namespace dispersa {

void Describe(Fields& fields, DatedWeather& sounding) {
  fields.Text("file", sounding.file, "name of its file");
  fields.Text("time", sounding.time, "UTC: YYYY-MM-DD or YYYY-MM-DDTHH", "");
  fields.Table("table", "a sounding, or a CSV file with altitude_m, north_m_s, east_m_s",
               "its levels, as those of `wind_profile`",
               [&](Fields& columns) { Describe(columns, sounding.table); });
  fields.Check([&] {
    if (!sounding.time.empty() && MonthOf(sounding.time) == 0)
      fields.Refuse("time", "'" + sounding.time + "' is no time", "YYYY-MM-DD or YYYY-MM-DDTHH, UTC");
  });
}

int MonthOf(const std::string& time) {
  constexpr char kForm[] = "0000-00-00T00";
  if (time.size() != 10 && time.size() != 13) return 0;
  for (std::size_t i = 0; i < time.size(); ++i)
    if (kForm[i] == '0' ? time[i] < '0' || time[i] > '9' : time[i] != kForm[i]) return 0;
  const auto two = [&](std::size_t at) { return 10 * (time[at] - '0') + time[at + 1] - '0'; };
  const bool is_day = two(8) >= 1 && two(8) <= 31 && (time.size() == 10 || two(11) <= 24);
  return is_day && two(5) <= 12 ? two(5) : 0;
}

void WeighByMonth(std::vector<DatedWeather>& soundings) {
  std::array<double, 13> count{};
  for (const DatedWeather& one : soundings) count[static_cast<std::size_t>(MonthOf(one.time))] += 1.0;
  DISPERSA_ASSERT(count[0] == 0.0);
  for (DatedWeather& one : soundings) one.weight = 1.0 / count[static_cast<std::size_t>(MonthOf(one.time))];
}

WeatherTable MeanWeather(const std::vector<DatedWeather>& soundings) {
  DISPERSA_ASSERT(soundings.size() >= 2, soundings.size());
  constexpr double kStep_m = 100.0;
  double low_m = HUGE_VAL, high_m = -HUGE_VAL, weights = 0.0;
  bool has_air = false;
  std::vector<Wind> winds;
  std::vector<AirTable> airs;
  for (const DatedWeather& one : soundings) {
    low_m = std::min(low_m, one.table.altitude_m.front());
    high_m = std::max(high_m, one.table.altitude_m.back());
    weights += one.weight;
    has_air |= one.table.has_air();
    winds.push_back({{}, {one.table}, {}, {}});
    airs.push_back(one.table.has_air() ? MeasuredAir(one.table) : StandardAir());
  }
  WeatherTable mean;
  for (int step = 0; mean.altitude_m.empty() || mean.altitude_m.back() < high_m; ++step) {
    const double altitude_m = low_m + step * kStep_m;
    double north_m_s = 0.0, east_m_s = 0.0, log_pressure = 0.0, log_density = 0.0;
    for (std::size_t i = 0; i < soundings.size(); ++i) {
      const double part = soundings[i].weight / weights;
      const WindNorthEast wind = Evaluate(winds[i], altitude_m);
      north_m_s += part * wind.north_m_s;
      east_m_s += part * wind.east_m_s;
      if (!has_air) continue;
      const lanes::AirPressure<double> air = lanes::AirAt(airs[i], altitude_m);
      log_pressure += part * Log(air.pressure_pa);
      log_density += part * Log(air.pressure_pa / air.energy_j_kg);
    }
    mean.altitude_m.push_back(altitude_m);
    mean.north_m_s.push_back(north_m_s);
    mean.east_m_s.push_back(east_m_s);
    if (!has_air) continue;
    mean.pressure_pa.push_back(Exp(log_pressure));
    mean.density_kg_m3.push_back(Exp(log_density));
  }
  return mean;
}

double WindTop(const WeatherTable& table) {
  constexpr double kRounding_m_s = 2e-3, kCalm_m_s = 0.1;
  const std::vector<double>& z = table.altitude_m;
  for (std::size_t top = 0; top < z.size(); ++top) {
    const double north = table.north_m_s[top], east = table.east_m_s[top];
    if (std::max(std::fabs(north), std::fabs(east)) < kCalm_m_s) continue;
    std::size_t i = top + 1;
    const auto fades = [&] {
      const double left = std::max(0.0, 1.0 - (z[i] - z[top]) / kWindFade_m);
      return std::fabs(table.north_m_s[i] - left * north) < kRounding_m_s &&
             std::fabs(table.east_m_s[i] - left * east) < kRounding_m_s;
    };
    while (i < z.size() && fades()) ++i;
    if (i == z.size()) return z[top];
  }
  return z.back();
}

}  // namespace dispersa
