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
void CheckWind(const std::string& key, double speed_m_s, double top_m, const Add& add) {
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
void CheckAir(const std::string& key, const WeatherTable& table, const Add& add) {
  if (!table.has_air()) return;
  const GasLawMiss miss = MissOfGasLaw(table);
  if (std::fabs(miss.part) > kGasLawPart)
    add({key,
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
    add({key,
         fmt::format("has at {:.6g} m a density of {:.4g} kg/m3", table.altitude_m[level],
                     AirOfLevel(table, level).density_kg_m3),
         fmt::format("within a factor of {:.2g} of the standard's, {:.4g} kg/m3 (to 60 km seasons and "
                     "latitudes change it by up to 40 %)",
                     std::exp(kAirPart), StandardAtmosphere1976(table.altitude_m[level]).density_kg_m3)});
}

template <typename Add>
void CheckWeather(const std::string& key, const WeatherTable& table, const Add& add) {
  double fastest_m_s = 0.0;
  for (std::size_t i = 0; i < table.altitude_m.size(); ++i)
    fastest_m_s = std::max(fastest_m_s, std::sqrt(table.north_m_s[i] * table.north_m_s[i] +
                                                  table.east_m_s[i] * table.east_m_s[i]));
  CheckWind(key, fastest_m_s, table.altitude_m.back(), add);
  CheckAir(key, table, add);
}

std::string PathOf(const Dispersion& dispersion, int input) {
  if (dispersion.replaces) return "sampling.table." + InputColumns()[static_cast<std::size_t>(input)].name;
  return "dispersions." + InputKey(input);
}

double NominalOf(int input) {
  static FlightInputs nominal;
  return InputValue(nominal, input);
}

// Values of every input, each away from the nominal one if any case may have it so.
FlightInputs FarthestInputs(const Campaign& campaign) {
  FlightInputs set;
  for (const Dispersion& dispersion : campaign.dispersions)
    for (const double reach : ReachOf(dispersion.distribution))
      for (const int input : dispersion.inputs)
        if (reach != NominalOf(input)) InputValue(set, input) = reach;
  // An expression may give anything.
  for (const DerivedInput& derived : campaign.derived) InputValue(set, derived.column) = HUGE_VAL;
  return set;
}

// The flight draws noise of its own from these, in every case another.
bool IsOfNoise(int input) {
  const std::string& name = InputColumns()[static_cast<std::size_t>(input)].name;
  return name == "gyro_noise_deg_s" || name == "turbulence_exceedance";
}

// Keys none of whose inputs is read, each once.
template <typename Add>
void FindUnread(const Campaign& campaign, const Add& add) {
  const std::vector<SetInput> inputs = SetInputs(campaign);
  for (const SetInput& one : inputs) {
    const bool is_read = std::any_of(inputs.begin(), inputs.end(), [&](const SetInput& other) {
      return other.key == one.key && other.unread.empty();
    });
    if (!is_read) add({one.key, "nothing uses it: " + one.unread, one.allowed});
  }
}

}  // namespace

std::vector<SetInput> SetInputs(const Campaign& campaign) {
  const FlightInputs set = FarthestInputs(campaign);
  const FlightParts parts{
      campaign.vehicle,         campaign.autopilot, campaign.guidance, campaign.course, set,
      campaign.soundings.size()};
  std::vector<SetInput> found;
  const auto add = [&](const std::string& key, int input, bool varies) {
    const Readers& readers = InputColumns()[static_cast<std::size_t>(input)].readers;
    const bool is_read = IsRead(parts, input);
    found.push_back({key, input, varies || IsOfNoise(input), is_read ? "" : readers.unread,
                     is_read ? "" : readers.allowed});
  };
  for (const Dispersion& dispersion : campaign.dispersions)
    for (const int input : dispersion.inputs) {
      const auto [low, high] = ReachOf(dispersion.distribution);
      if (low != high || low != NominalOf(input)) add(PathOf(dispersion, input), input, low != high);
    }
  for (std::size_t i = 0; i < campaign.derived.size(); ++i)
    add("derived[" + std::to_string(i) + "]", campaign.derived[i].column, true);
  return found;
}

std::vector<UnusualDispersion> UnusualDispersions(const Campaign& campaign) {
  std::vector<UnusualDispersion> found;
  const auto add = [&](UnusualDispersion one) {
    const auto same = [&](const UnusualDispersion& other) { return other.key == one.key; };
    if (std::none_of(found.begin(), found.end(), same)) found.push_back(std::move(one));
  };
  FindUnread(campaign, add);
  for (const Dispersion& dispersion : campaign.dispersions) {
    for (const int input : dispersion.inputs) {
      const InputColumn& column = InputColumns()[static_cast<std::size_t>(input)];
      const std::array<double, 2> reach = ReachOf(dispersion.distribution);
      const UsualValues& usual = column.usual;
      const double low = reach[0] / column.unit, high = reach[1] / column.unit;
      if (low >= usual.low && high <= usual.high) continue;
      add({PathOf(dispersion, input),
           fmt::format("draws from {:.4g} to {:.4g} ({}) but for 0.27 % of the cases", low, high,
                       column.name),
           fmt::format("{:g} to {:g} ({})", usual.low, usual.high, usual.source)});
    }
  }
  const auto draws_tables = [](const Dispersion& dispersion) {
    return dispersion.name.starts_with("aerodynamic_uncertainty/");
  };
  const std::vector<AeroTable>& tables = campaign.vehicle.aerodynamics;
  if (!campaign.dispersions.empty() && std::any_of(tables.begin(), tables.end(), IsUncertain) &&
      std::none_of(campaign.dispersions.begin(), campaign.dispersions.end(), draws_tables))
    add({"dispersions", "do not draw the uncertainty that the vehicle's aerodynamic tables state",
         "aerodynamic_uncertainty: {of: [ca, cn, xcp, damping]}"});
  if (campaign.wind_table) CheckWeather("dispersions.wind_profile", *campaign.wind_table, add);
  for (std::size_t k = 0; k < campaign.soundings.size(); ++k)
    CheckWeather(fmt::format("dispersions.weather.ensemble[{}]", k), campaign.soundings[k].table, add);
  if (const auto& statistics = campaign.wind_statistics) {
    double fastest_m_s = 0.0;
    for (std::size_t i = 0; i < statistics->altitude_m.size(); ++i)
      fastest_m_s = std::max({fastest_m_s,
                              std::fabs(statistics->mean_north_m_s[i]) + 3.0 * statistics->sigma_north_m_s[i],
                              std::fabs(statistics->mean_east_m_s[i]) + 3.0 * statistics->sigma_east_m_s[i]});
    CheckWind("dispersions.wind_profile", fastest_m_s, statistics->altitude_m.back(), add);
  }
  return found;
}

}  // namespace dispersa
