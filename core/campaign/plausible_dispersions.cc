#include "core/campaign/plausible_dispersions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/campaign/dispersion_table.h"
#include "core/campaign/drawn_value.h"
#include "core/flight/flight_inputs.h"

namespace dispersa {
namespace {

/// Columns that begin so, in their own unit.
struct Usual {
  std::string_view columns;
  double low, high;
  const char* source;
};
constexpr Usual kUsual[] = {
    {"thrust_misalignment_clock", -HUGE_VAL, HUGE_VAL, ""},
    {"thrust_offset_clock", -HUGE_VAL, HUGE_VAL, ""},
    {"cg_offset_clock", -HUGE_VAL, HUGE_VAL, ""},
    {"thrust_misalignment", -1.5, 1.5, "0.1 to 0.5 deg of solid motors"},
    {"thrust_offset", -0.1, 0.1, "millimetres"},
    {"cg_offset", -0.2, 0.2, "millimetres to centimetres"},
    {"thrust_factor", 0.8, 1.2, "1 to 5 % of motors"},
    {"mass_flow_factor", 0.8, 1.2, "1 to 5 % of motors"},
    {"specific_impulse_factor", 0.94, 1.06, "0.3 to 1 %"},
    {"dry_mass_factor", 0.8, 1.2, "1 to 5 %"},
    {"propellant_factor", 0.9, 1.1, "0.3 to 1 %"},
    {"wind_max_speed_m_s", 0.0, 130.0, "the strongest jet streams have 100 to 120 m/s"},
    {"wind_altitude_m", 3000.0, 60000.0, "jet streams are at 9 to 16 km"},
    {"wind_width_m", 1000.0, 60000.0, "some kilometres"},
    {"wind_profile", -130.0, 130.0, "the strongest jet streams have 100 to 120 m/s"},
    {"gust_speed_m_s", -30.0, 30.0, "9 m/s of MIL-F-8785C's and NASA's discrete gusts"},
    {"gust_length_m", 5.0, 3000.0, "30 to 300 m"},
    {"drag_factor", 0.4, 1.6, "10 to 20 %"},
    {"lift_factor", 0.4, 1.6, "10 to 20 %"},
    {"cp_factor", 0.4, 1.6, "of the distance from the nose"},
    {"cg_factor", 0.7, 1.3, "of the distance from the nose"},
    {"density_factor", 0.4, 1.6, "5 to 30 % by altitude and season"},
    {"inertia_factor", 0.5, 1.5, "2 to 10 %"},
    {"actuator_bandwidth_factor", 0.3, 2.0, "10 to 20 %"},
    {"bending_frequency_factor", 0.6, 1.5, "5 to 15 %"},
    {"tip_off", -5.0, 5.0, "0.1 to 2 deg/s of a separation"},
    {"gyro_bias", -0.1, 0.1, "0.0001 to 0.01 deg/s of inertial units"},
    {"gyro_noise", 0.0, 0.5, "0.001 to 0.05 deg/s a sample"},
    {"ignition_delay", -10.0, 10.0, "fractions of a second"},
    {"separation_delay", -10.0, 10.0, "fractions of a second"},
    {"launch_azimuth_error", -2.0, 2.0, "0.01 to 0.2 deg of an alignment"},
    {"initial_", -5.0, 5.0, "fractions of a degree on the pad"},
    {"navigation_position_error", -20000.0, 20000.0, "10 m aided by satellites, kilometres of a free unit"},
    {"navigation_velocity_error", -50.0, 50.0, "0.1 m/s aided by satellites, metres a second of a free unit"},
    {"accelerometer_scale_factor", 0.99, 1.01, "0.0001 to 0.001"},
};

const Usual* Find(const std::string& column) {
  for (const Usual& usual : kUsual)
    if (column.compare(0, usual.columns.size(), usual.columns) == 0) return &usual;
  return nullptr;
}

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
      const Usual* usual = Find(column.name);
      if (usual == nullptr) continue;
      const double low = reach[0] / column.unit, high = reach[1] / column.unit;
      if (low >= usual->low && high <= usual->high) continue;
      add({key,
           fmt::format("draws from {:.4g} to {:.4g} ({}) but for 0.27 % of the cases", low, high,
                       column.name),
           fmt::format("{:g} to {:g} ({})", usual->low, usual->high, usual->source)});
    }
  }
  if (const auto& table = campaign.wind_table) {
    double fastest_m_s = 0.0;
    for (std::size_t i = 0; i < table->altitude_m.size(); ++i)
      fastest_m_s = std::max(fastest_m_s, std::sqrt(table->north_m_s[i] * table->north_m_s[i] +
                                                    table->east_m_s[i] * table->east_m_s[i]));
    CheckWind("wind_profile", fastest_m_s, table->altitude_m.back(), add);
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
