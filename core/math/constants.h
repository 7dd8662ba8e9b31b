// Unit conversions. SI and radians inside; degrees only where a name says so.
#pragma once

namespace dispersa {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kTwoPi = 2.0 * kPi;
inline constexpr double kRadPerDeg = kPi / 180.0;
inline constexpr double kDegPerRad = 180.0 / kPi;

/// Standard acceleration of free fall, m/s² (CGPM 1901): the g of load factors and specific impulse.
inline constexpr double kStandardGravity = 9.80665;

/// Of three angles of a turn: with a sine within this of ±1 the middle one is so near ±90° that the outer two
/// cannot be told apart.
inline constexpr double kSingularSine = 1e-12;

}  // namespace dispersa
