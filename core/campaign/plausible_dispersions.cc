#include "core/campaign/plausible_dispersions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/campaign/dispersion_table.h"
#include "core/campaign/drawn_value.h"
#include "core/environment/atmosphere.h"
#include "core/flight/flight_inputs.h"
#include "core/math/functions.h"

namespace dispersa {
namespace {

bool IsOfNavigation(const std::string& column) {
  return column.rfind("navigation_", 0) == 0 || column.rfind("accelerometer_", 0) == 0;
}

// What a distribution draws but for 0.27 % of the cases, least and greatest.
std::array<double, 2> ReachOf(const ScalarDistribution& distribution) {
  constexpr double kTail = 0.00135;
  if (distribution.kind == Distribution::kValues || distribution.kind == Distribution::kConstant) {
    const auto [least, most] = std::minmax_element(distribution.values.begin(), distribution.values.end());
    return {*least, *most};
  }
  const std::array<double, 2> truncation = TruncationOf(distribution);
  const double a = DrawnValue(distribution, truncation, kTail),
               b = DrawnValue(distribution, truncation, 1.0 - kTail);
  return {std::min(a, b), std::max(a, b)};
}

constexpr double kStrongestWind_m_s = 150.0;
constexpr double kLowestTop_m = 5000.0;

// Of a profile of wind: its greatest speed, and where it ends.
template <typename Add>
void CheckWind(const char* key, double speed_m_s, double top_m, const Add& add) {
  if (speed_m_s > kStrongestWind_m_s)
    add({key, fmt::format("has a wind of {:.4g} m/s", speed_m_s),
         fmt::format("up to {:g} m/s (the strongest jet streams have 100 to 120 m/s)", kStrongestWind_m_s)});
  if (top_m < kLowestTop_m)
    add({key, fmt::format("ends at {:.4g} m, above which the wind fades within {:g} m", top_m, kWindFade_m),
         fmt::format("{:g} m or more (altitudes may be in kilometres)", kLowestTop_m)});
}

constexpr double kGasLawPart = 0.02;
constexpr double kAirPart = 0.35;
constexpr double kOfThin_m = 60000.0;

// Of a measured air: whether its columns agree, and with any air of the Earth.
template <typename Add>
void CheckAir(const WeatherTable& table, const Add& add) {
  if (!table.has_air()) return;
  const GasLawMiss miss = MissOfGasLaw(table);
  if (std::fabs(miss.part) > kGasLawPart)
    add({"wind_profile",
         fmt::format("has at {:.6g} m a pressure {:.3g} times that of its density and temperature",
                     table.altitude_m[miss.level], 1.0 + miss.part),
         fmt::format("within {:g} % (the gas law of dry air; vapour makes up to 1.5 %)",
                     100.0 * kGasLawPart)});
  double worst = 0.0;
  std::size_t level = 0;
  for (std::size_t i = 0; i < table.altitude_m.size() && table.altitude_m[i] <= kOfThin_m; ++i) {
    const double standard = StandardAtmosphere1976(table.altitude_m[i]).density_kg_m3;
    const double part = std::fabs(Log(AirOfLevel(table, i).density_kg_m3 / standard));
    if (part > worst) worst = part, level = i;
  }
  if (worst > kAirPart)
    add({"wind_profile",
         fmt::format("has at {:.6g} m a density of {:.4g} kg/m3", table.altitude_m[level],
                     AirOfLevel(table, level).density_kg_m3),
         fmt::format("within a factor of {:.2g} of the standard's, {:.4g} kg/m3 (to 60 km seasons and "
                     "latitudes change it by up to 40 %)",
                     std::exp(kAirPart), StandardAtmosphere1976(table.altitude_m[level]).density_kg_m3)});
}

bool DrawsTailOffOfNone(const Campaign& campaign) {
  bool draws = false;
  for (const Dispersion& dispersion : campaign.dispersions)
    for (const int input : dispersion.inputs)
      for (std::size_t i = 0; i < campaign.vehicle.stages.size(); ++i) {
        if (InputColumns()[static_cast<std::size_t>(input)].name !=
            "tail_off_factor_stage" + std::to_string(i + 1))
          continue;
        if (campaign.vehicle.stages[i].motor.tail_off_s > 0.0) return false;
        draws = true;
      }
  return draws;
}

}  // namespace

std::vector<UnusualDispersion> UnusualDispersions(const Campaign& campaign) {
  std::vector<UnusualDispersion> found;
  const auto add = [&](UnusualDispersion one) {
    const auto same = [&](const UnusualDispersion& other) { return other.key == one.key; };
    if (std::none_of(found.begin(), found.end(), same)) found.push_back(std::move(one));
  };
  for (const Dispersion& dispersion : campaign.dispersions) {
    for (const int input : dispersion.inputs) {
      const InputColumn& column = InputColumns()[static_cast<std::size_t>(input)];
      const std::string key = InputKey(input);
      if (key.empty()) continue;
      const std::array<double, 2> reach = ReachOf(dispersion.distribution);
      if (IsOfNavigation(column.name) && !campaign.guidance.closed_loop &&
          (reach[0] != 0.0 || reach[1] != 0.0))
        add({key,
             "nothing uses it: the flight has no closed-loop guidance, and the autopilot has sensors of its "
             "own",
             "guidance: {mode: closed_loop}, or none of navigation's errors"});
      const UsualValues& usual = column.usual;
      const double low = reach[0] / column.unit, high = reach[1] / column.unit;
      if (low >= usual.low && high <= usual.high) continue;
      add({key,
           fmt::format("draws from {:.4g} to {:.4g} ({}) but for 0.27 % of the cases", low, high,
                       column.name),
           fmt::format("{:g} to {:g} ({})", usual.low, usual.high, usual.source)});
    }
  }
  if (DrawsTailOffOfNone(campaign))
    add({"tail_off", "nothing uses it: no stage that it draws for has a tail_off_*",
         "tail_off_* of the stages' motors, or no tail_off"});
  const auto draws_tables = [](const Dispersion& dispersion) {
    return dispersion.name.starts_with("aerodynamic_uncertainty/");
  };
  const std::vector<AeroTable>& tables = campaign.vehicle.aerodynamics;
  if (!campaign.dispersions.empty() && std::any_of(tables.begin(), tables.end(), IsUncertain) &&
      std::none_of(campaign.dispersions.begin(), campaign.dispersions.end(), draws_tables))
    add({"", "do not draw the uncertainty that the vehicle's aerodynamic tables state",
         "aerodynamic_uncertainty: {of: [ca, cn, xcp, damping]}"});
  if (const auto& table = campaign.wind_table) {
    double fastest_m_s = 0.0;
    for (std::size_t i = 0; i < table->altitude_m.size(); ++i)
      fastest_m_s = std::max(fastest_m_s, std::sqrt(table->north_m_s[i] * table->north_m_s[i] +
                                                    table->east_m_s[i] * table->east_m_s[i]));
    CheckWind("wind_profile", fastest_m_s, table->altitude_m.back(), add);
    CheckAir(*table, add);
  }
  if (const auto& statistics = campaign.wind_statistics) {
    double fastest_m_s = 0.0;
    for (std::size_t i = 0; i < statistics->altitude_m.size(); ++i)
      fastest_m_s = std::max({fastest_m_s,
                              std::fabs(statistics->mean_north_m_s[i]) + 3.0 * statistics->sigma_north_m_s[i],
                              std::fabs(statistics->mean_east_m_s[i]) + 3.0 * statistics->sigma_east_m_s[i]});
    CheckWind("wind_profile", fastest_m_s, statistics->altitude_m.back(), add);
  }
  return found;
}

}  // namespace dispersa
