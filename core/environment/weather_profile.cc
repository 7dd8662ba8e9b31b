#include "core/environment/weather_profile.h"

#include <algorithm>
#include <utility>

#include "core/math/assertion.h"

namespace dispersa {

namespace {

// Wind of the tables, the steady part and the turbulence alone, from one side of an altitude at which a piece
// may end.
struct Weather {
  double north_m_s, east_m_s, factor, up_m_s;
};

Weather WeatherAt(const Wind& tables, const DensityFactor& density, const TurbulenceField* turbulence,
                  double altitude_m) {
  const WindNorthEast wind = Evaluate(tables, altitude_m);
  if (turbulence == nullptr) return {wind.north_m_s, wind.east_m_s, density(altitude_m), 0.0};
  const TurbulentWind gusts = Evaluate(*turbulence, altitude_m);
  return {wind.north_m_s + gusts.north_m_s, wind.east_m_s + gusts.east_m_s, density(altitude_m),
          gusts.up_m_s};
}

}  // namespace

WeatherProfile BuildWeatherProfile(const Wind& wind, const DensityFactor& density,
                                   const TurbulenceField* turbulence) {
  WeatherProfile profile;
  const Wind tables{{}, wind.tables, {}, wind.steady};
  const bool is_calm = wind.tables.empty() && wind.steady.north_m_s == 0.0 && wind.steady.east_m_s == 0.0;
  if (is_calm && density.by_altitude.x.empty() && density.scale == 1.0 && turbulence == nullptr)
    return profile;
  profile.has_updraft = turbulence != nullptr;

  for (const WindTable& table : wind.tables) {
    profile.edges.insert(profile.edges.end(), table.altitude_m.begin(), table.altitude_m.end());
    profile.edges.push_back(table.altitude_m.back() + kWindFade_m);
  }
  if (turbulence != nullptr)
    profile.edges.insert(profile.edges.end(), turbulence->altitude_m.begin(), turbulence->altitude_m.end());
  const std::vector<double>& factor_altitudes = density.by_altitude.x;
  profile.edges.insert(profile.edges.end(), factor_altitudes.begin(), factor_altitudes.end());
  std::sort(profile.edges.begin(), profile.edges.end());
  profile.edges.erase(std::unique(profile.edges.begin(), profile.edges.end()), profile.edges.end());

  const auto constant = [&](double altitude_m) {
    const Weather w = WeatherAt(tables, density, turbulence, altitude_m);
    profile.rows.insert(profile.rows.end(),
                        {w.north_m_s, 0.0, w.east_m_s, 0.0, w.factor, 0.0, w.up_m_s, 0.0});
  };
  constant(profile.edges.empty() ? 0.0 : profile.edges.front());
  for (std::size_t i = 1; i < profile.edges.size(); ++i) {
    const double bottom = profile.edges[i - 1], top = profile.edges[i];
    const Weather low = WeatherAt(tables, density, turbulence, bottom);
    const Weather high = WeatherAt(tables, density, turbulence, top);
    for (const auto& [a, b] :
         {std::pair(low.north_m_s, high.north_m_s), std::pair(low.east_m_s, high.east_m_s),
          std::pair(low.factor, high.factor), std::pair(low.up_m_s, high.up_m_s)}) {
      const double slope = (b - a) / (top - bottom);
      profile.rows.insert(profile.rows.end(), {a - slope * bottom, slope});
    }
  }
  if (!profile.edges.empty()) constant(profile.edges.back());
  return profile;
}

FlightWeather PrepareWeather(const Wind& wind, const DensityFactor& density,
                             std::shared_ptr<const AirTable> air, const TurbulenceField* turbulence) {
  DISPERSA_ASSERT(wind.jets.size() <= 1 && wind.gusts.size() <= 1, wind.jets.size(), wind.gusts.size());
  FlightWeather w;
  w.air = std::move(air);
  w.density_factor = density.scale;
  if (!wind.jets.empty()) {
    const JetStream& jet = wind.jets.front();
    const WindNorthEast to = FromAzimuth(1.0, jet.azimuth_from_rad);
    w.jet_speed_m_s = jet.max_speed_m_s;
    w.jet_altitude_m = jet.altitude_m;
    w.jet_inverse_width = 1.0 / jet.width_m;
    w.jet_north = to.north_m_s;
    w.jet_east = to.east_m_s;
  }
  if (!wind.gusts.empty()) {
    const Gust& gust = wind.gusts.front();
    const WindNorthEast to = FromAzimuth(1.0, gust.azimuth_from_rad);
    w.gust_speed_m_s = gust.speed_m_s;
    w.gust_start_m = gust.start_altitude_m;
    w.gust_inverse_length = 1.0 / gust.length_m;
    w.gust_north = to.north_m_s;
    w.gust_east = to.east_m_s;
  }
  w.profile = BuildWeatherProfile(wind, {1.0, density.by_altitude}, turbulence);
  return w;
}

}  // namespace dispersa
