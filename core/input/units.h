// The units in which the files may write a quantity: always the last part of its key.
#pragma once

#include <span>
#include <string_view>

#include "core/math/constants.h"

namespace dispersa {

struct Unit {
  std::string_view suffix;  ///< "altitude" in "km" is the key "altitude_km"
  double scale;             ///< value inside = value in the file * scale + offset
  double offset = 0.0;
};

inline constexpr Unit kNoUnit = {"", 1.0};

using Dimension = std::span<const Unit>;

inline constexpr Unit kLength[] = {{"m", 1.0}, {"km", 1e3}, {"mm", 1e-3}, {"um", 1e-6}};
inline constexpr Unit kArea[] = {{"m2", 1.0}};
inline constexpr Unit kTime[] = {{"s", 1.0}, {"ms", 1e-3}};
inline constexpr Unit kMass[] = {{"kg", 1.0}, {"ton", 1e3}};
inline constexpr Unit kMassFlow[] = {{"kg_s", 1.0}};
inline constexpr Unit kInertia[] = {{"kg_m2", 1.0}};
inline constexpr Unit kMassPerLength[] = {{"kg_m", 1.0}};
inline constexpr Unit kModulus[] = {{"gpa", 1e9}, {"mpa", 1e6}, {"pa", 1.0}};
inline constexpr Unit kBendingStiffness[] = {{"n_m2", 1.0}, {"kn_m2", 1e3}, {"mn_m2", 1e6}};
inline constexpr Unit kForce[] = {{"n", 1.0}, {"kn", 1e3}};
inline constexpr Unit kMoment[] = {{"n_m", 1.0}, {"kn_m", 1e3}};
inline constexpr Unit kPressure[] = {{"pa", 1.0}, {"kpa", 1e3}};
inline constexpr Unit kGasPressure[] = {{"pa", 1.0}, {"kpa", 1e3}, {"hpa", 1e2}, {"mpa", 1e6}, {"bar", 1e5}};
inline constexpr Unit kPressureAngle[] = {{"pa_rad", 1.0}, {"kpa_rad", 1e3}, {"pa_deg", kRadPerDeg}};
inline constexpr Unit kHeatFlux[] = {{"w_m2", 1.0}, {"kw_m2", 1e3}};
inline constexpr Unit kSpeed[] = {{"m_s", 1.0}, {"km_s", 1e3}, {"km_h", 1.0 / 3.6}};
inline constexpr Unit kAcceleration[] = {{"g", 1.0}};
inline constexpr Unit kAngle[] = {{"deg", kRadPerDeg}, {"rad", 1.0}};
inline constexpr Unit kAngularRate[] = {{"deg_s", kRadPerDeg}, {"rad_s", 1.0}};
inline constexpr Unit kFrequency[] = {{"rad_s", 1.0}, {"hz", kTwoPi}};
inline constexpr Unit kAngularAcceleration[] = {{"deg_s2", kRadPerDeg}, {"rad_s2", 1.0}};
inline constexpr Unit kPerTime[] = {{"1_s", 1.0}};
inline constexpr Unit kPerTimeSquared[] = {{"1_s2", 1.0}};
inline constexpr Unit kPerLength[] = {{"per_km", 1e-3}, {"per_m", 1.0}};
inline constexpr Unit kPerSpeed[] = {{"per_m_s", 1.0}};
inline constexpr Unit kDensity[] = {{"kg_m3", 1.0}};
inline constexpr Unit kShare[] = {{"percent", 1e-2}};
inline constexpr Unit kFactor[] = {{"percent", 1e-2, 1.0},
                                   {"factor", 1.0}};  ///< in percent: by how much it is not 1
inline constexpr Unit kTemperature[] = {{"k", 1.0}};
inline constexpr Unit kTemperatureDifference[] = {{"k", 1.0}};
inline constexpr Unit kPerTemperature[] = {{"percent_per_k", 1e-2}};
inline constexpr Unit kPerAngle[] = {{"per_deg", kDegPerRad}, {"per_rad", 1.0}};

/// Endings of keys, after the last underscores, that are units, ours or not. They tell a wrong unit from a
/// wrong name.
inline constexpr std::string_view kUnitLike[] = {"m",       "km",      "mm",      "um",
                                                 "cm",      "ft",      "in",      "mi",
                                                 "nmi",     "m2",      "ft2",     "s",
                                                 "ms",      "min",     "h",       "kg",
                                                 "ton",     "t",       "g",       "lb",
                                                 "lbm",     "slug",    "kg_s",    "lb_s",
                                                 "n",       "kn",      "mn",      "lbf",
                                                 "pa",      "kpa",     "bar",     "psf",
                                                 "psi",     "pa_rad",  "pa_deg",  "kpa_rad",
                                                 "m_s",     "km_s",    "km_h",    "ft_s",
                                                 "kt",      "kts",     "mph",     "deg",
                                                 "rad",     "arcmin",  "deg_s",   "rad_s",
                                                 "hz",      "rpm",     "deg_s2",  "rad_s2",
                                                 "1_s",     "1_s2",    "1_s3",    "per_km",
                                                 "per_m",   "per_m_s", "per_deg", "per_rad",
                                                 "percent", "factor",  "kg_m2",   "kg_m",
                                                 "gpa",     "mpa",     "n_m2",    "kn_m2",
                                                 "mn_m2",   "1_m",     "n_m",     "kn_m",
                                                 "w_m2",    "kw_m2",   "k",       "percent_per_k",
                                                 "kg_m3",   "hpa"};

/// Other spellings of a unit, and its name here.
struct UnitSpelling {
  std::string_view written;
  std::string_view meant;
};
inline constexpr UnitSpelling kUnitSpellings[] = {
    {"kmh", "km_h"},   {"kph", "km_h"},    {"kmph", "km_h"},     {"km_hr", "km_h"},    {"mps", "m_s"},
    {"ms", "m_s"},     {"kms", "km_s"},    {"kmps", "km_s"},     {"meter", "m"},       {"meters", "m"},
    {"metre", "m"},    {"metres", "m"},    {"kilometers", "km"}, {"kilometres", "km"}, {"sec", "s"},
    {"secs", "s"},     {"seconds", "s"},   {"msec", "ms"},       {"degree", "deg"},    {"degrees", "deg"},
    {"radian", "rad"}, {"radians", "rad"}, {"degs", "deg_s"},    {"dps", "deg_s"},     {"deg_sec", "deg_s"},
    {"rads", "rad_s"}, {"rps", "rad_s"},   {"rad_sec", "rad_s"}, {"hertz", "hz"},      {"tons", "ton"},
    {"tonne", "ton"},  {"tonnes", "ton"},  {"t", "ton"},         {"kgs", "kg"},        {"newton", "n"},
    {"newtons", "n"},  {"pascal", "pa"},   {"kgm2", "kg_m2"},    {"kgs2", "kg_s"},     {"sqm", "m2"}};

inline constexpr double kHalfTurn = kPi;
inline constexpr double kQuarterTurn = kPi / 2.0;

}  // namespace dispersa
