#include "core/environment/sounding.h"

#include <algorithm>
#include <cmath>

#include "core/environment/atmosphere.h"
#include "core/math/constants.h"
#include "core/math/functions.h"

namespace dispersa {
namespace {

using Levels = std::vector<SoundingLevel>;

bool IsGiven(double value) { return !std::isnan(value); }

// Two of pressure, density and temperature give all; vapour counts where density is not measured.
void CompleteAir(SoundingLevel& level) {
  if (!IsGiven(level.pressure_pa) && IsGiven(level.density_kg_m3) && IsGiven(level.temperature_k))
    level.pressure_pa = level.density_kg_m3 * kAirGasConstant_j_kg_k * level.temperature_k;
  if (IsGiven(level.density_kg_m3) || !IsGiven(level.pressure_pa) || !IsGiven(level.temperature_k)) return;
  constexpr double kLighter = 1.0 - 18.01528 / 28.9644;  // vapour than air, by molar mass
  const double vapour_pa = IsGiven(level.vapour_pa) ? std::min(level.vapour_pa, level.pressure_pa) : 0.0;
  level.density_kg_m3 =
      (level.pressure_pa - kLighter * vapour_pa) / (kAirGasConstant_j_kg_k * level.temperature_k);
}

bool HasAir(const SoundingLevel& level) { return IsGiven(level.pressure_pa) && IsGiven(level.density_kg_m3); }

// By pressure: R T / g0 of moist air, which is p / (density g0).
double ScaleHeight(const SoundingLevel& level) {
  return level.pressure_pa / (level.density_kg_m3 * kStandardGravity);
}

// Thickness from each level to the next in order of falling pressure, by the hypsometric equation; where a
// temperature lacks, with the neighbour's.
std::vector<double> Thicknesses(const Levels& falling) {
  std::vector<double> scales;
  for (const SoundingLevel& level : falling)
    scales.push_back(HasAir(level) ? ScaleHeight(level) : SoundingLevel::kNone);
  for (std::size_t i = 1; i < scales.size(); ++i)
    if (!IsGiven(scales[i])) scales[i] = scales[i - 1];
  for (std::size_t i = scales.size(); i-- > 1;)
    if (!IsGiven(scales[i - 1])) scales[i - 1] = scales[i];
  std::vector<double> thicknesses;
  for (std::size_t i = 1; i < falling.size(); ++i)
    thicknesses.push_back(0.5 * (scales[i - 1] + scales[i]) *
                          Log(falling[i - 1].pressure_pa / falling[i].pressure_pa));
  return thicknesses;
}

// Heights of levels that have a pressure alone. Returns how many got one.
std::size_t AddHeights(Levels& levels) {
  std::stable_sort(levels.begin(), levels.end(), [](const SoundingLevel& a, const SoundingLevel& b) {
    return IsGiven(a.pressure_pa) && (!IsGiven(b.pressure_pa) || a.pressure_pa > b.pressure_pa);
  });
  const auto with_pressure = static_cast<std::size_t>(std::count_if(
      levels.begin(), levels.end(), [](const SoundingLevel& level) { return IsGiven(level.pressure_pa); }));
  const Levels falling(levels.begin(), levels.begin() + static_cast<std::ptrdiff_t>(with_pressure));
  const std::vector<double> thicknesses = Thicknesses(falling);
  const auto is_known = [&](std::size_t i) { return IsGiven(falling[i].geopotential_m); };
  std::size_t added = 0, below = with_pressure;  // below: the last one with a height
  for (std::size_t i = 0; i < with_pressure; ++i) {
    if (is_known(i)) {
      below = i;
      continue;
    }
    if (below == with_pressure) continue;
    std::size_t above = i;
    while (above < with_pressure && !is_known(above)) ++above;
    double to_here = 0.0, to_above = 0.0;
    for (std::size_t k = below; k < std::min(above, with_pressure - 1); ++k) {
      if (k < i) to_here += thicknesses[k];
      to_above += thicknesses[k];
    }
    const double from_m = falling[below].geopotential_m;
    // Between two heights their thickness holds: the temperatures between decide only the parts.
    const double to_m = above < with_pressure && to_above > 0.0
                            ? from_m + (falling[above].geopotential_m - from_m) * to_here / to_above
                            : from_m + to_here;
    if (!IsGiven(to_m)) continue;
    levels[i].geopotential_m = to_m;
    ++added;
  }
  return added;
}

// What a level lacks comes from one at the same place.
void Complete(SoundingLevel& level, const SoundingLevel& other) {
  if (!HasAir(level) && HasAir(other))
    level.pressure_pa = other.pressure_pa, level.density_kg_m3 = other.density_kg_m3;
  if (!level.has_wind() && other.has_wind())
    level.north_m_s = other.north_m_s, level.east_m_s = other.east_m_s;
}

Levels InOrder(const Levels& levels) {
  Levels sorted;
  for (const SoundingLevel& level : levels)
    if (level.has_height() && (level.has_wind() || HasAir(level))) sorted.push_back(level);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const SoundingLevel& a, const SoundingLevel& b) { return a.height_m < b.height_m; });
  Levels apart;
  for (const SoundingLevel& level : sorted) {
    if (apart.empty() || level.height_m - apart.back().height_m >= kLeastLevel_m)
      apart.push_back(level);
    else
      Complete(apart.back(), level);
  }
  return apart;
}

// The neighbours of an altitude among some levels: the last at or below it, the first above it.
struct Neighbours {
  const SoundingLevel* below = nullptr;
  const SoundingLevel* above = nullptr;
};
template <typename Has>
Neighbours NeighboursOf(const Levels& levels, double height_m, const Has& has) {
  Neighbours of;
  for (const SoundingLevel& level : levels) {
    if (!has(level)) continue;
    if (level.height_m > height_m) {
      of.above = &level;
      break;
    }
    of.below = &level;
  }
  return of;
}

WindNorthEast WindAt(const Levels& levels, double height_m) {
  const auto [below, above] =
      NeighboursOf(levels, height_m, [](const SoundingLevel& level) { return level.has_wind(); });
  if (below == nullptr && above == nullptr) return {};
  if (below == nullptr) return {above->north_m_s, above->east_m_s};
  if (above == nullptr) {
    const double left = std::max(0.0, 1.0 - (height_m - below->height_m) / kWindFade_m);
    return {left * below->north_m_s, left * below->east_m_s};
  }
  const double part = (height_m - below->height_m) / (above->height_m - below->height_m);
  return {below->north_m_s + part * (above->north_m_s - below->north_m_s),
          below->east_m_s + part * (above->east_m_s - below->east_m_s)};
}

LevelAir AirAt(const Levels& levels, double height_m) {
  const auto [below, above] = NeighboursOf(levels, height_m, HasAir);
  if (below != nullptr && above != nullptr) {
    const double part = (height_m - below->height_m) / (above->height_m - below->height_m);
    return {below->pressure_pa * Exp(part * Log(above->pressure_pa / below->pressure_pa)),
            below->density_kg_m3 * Exp(part * Log(above->density_kg_m3 / below->density_kg_m3))};
  }
  const SoundingLevel& end = below != nullptr ? *below : *above;
  const AirState there = StandardAtmosphere1976(end.height_m), here = StandardAtmosphere1976(height_m);
  const double left = below == nullptr ? 1.0 : std::max(0.0, 1.0 - (height_m - end.height_m) / kWindFade_m);
  return {here.pressure_pa * (1.0 + left * (end.pressure_pa / there.pressure_pa - 1.0)),
          here.density_kg_m3 * (1.0 + left * (end.density_kg_m3 / there.density_kg_m3 - 1.0))};
}

// At the ellipsoid, in standard gravities, and the radius with which it falls over height.
struct Gravity {
  double gravities, radius_m;
};
Gravity NormalGravity(double latitude_rad) {
  const double sine2 = Sin(latitude_rad) * Sin(latitude_rad);
  return {9.780325 * (1.0 + 0.00193185 * sine2) / Sqrt(1.0 - 0.00669435 * sine2) / kStandardGravity,
          6378137.0 / (1.006803 - 0.006706 * sine2)};
}

}  // namespace

double GeometricHeight(double geopotential_m, double latitude_rad) {
  const auto [gravities, radius_m] = NormalGravity(latitude_rad);
  return radius_m * geopotential_m / (gravities * radius_m - geopotential_m);
}

double GeopotentialHeight(double height_m, double latitude_rad) {
  const auto [gravities, radius_m] = NormalGravity(latitude_rad);
  return gravities * radius_m * height_m / (radius_m + height_m);
}

double SaturationPressure(double temperature_k) {
  const double celsius = temperature_k - 273.15;
  return 611.2 * Exp(17.67 * celsius / (celsius + 243.5));
}

SoundingProfile ProfileOf(std::vector<SoundingLevel> levels, std::optional<double> latitude_rad) {
  SoundingProfile profile;
  profile.levels = levels.size();
  const double latitude = latitude_rad.value_or(0.25 * kPi);
  for (SoundingLevel& level : levels) {
    CompleteAir(level);
    if (level.has_height() && !IsGiven(level.geopotential_m))
      level.geopotential_m = GeopotentialHeight(level.height_m, latitude);
  }
  profile.with_heights_by_pressure = AddHeights(levels);
  for (SoundingLevel& level : levels)
    if (!level.has_height() && IsGiven(level.geopotential_m))
      level.height_m = GeometricHeight(level.geopotential_m, latitude);
  const Levels apart = InOrder(levels);
  profile.dropped = levels.size() - apart.size();
  std::size_t with_air = 0;
  for (const SoundingLevel& level : apart) {
    with_air += HasAir(level) ? 1 : 0;
    profile.without_wind += level.has_wind() ? 0 : 1;
    if (level.has_wind()) profile.wind_top_m = level.height_m;
  }
  profile.without_air = apart.size() - with_air;
  for (const SoundingLevel& level : apart) {
    profile.table.altitude_m.push_back(level.height_m);
    profile.sources.push_back(level.source);
    const WindNorthEast wind = WindAt(apart, level.height_m);
    profile.table.north_m_s.push_back(wind.north_m_s);
    profile.table.east_m_s.push_back(wind.east_m_s);
    if (with_air < 2) continue;
    const LevelAir air = AirAt(apart, level.height_m);
    profile.table.pressure_pa.push_back(air.pressure_pa);
    profile.table.density_kg_m3.push_back(air.density_kg_m3);
  }
  return profile;
}

}  // namespace dispersa
