// Rule base of the paper: five triangular sets for the error, five for its rate, 25 rules with singleton
// consequents, centre-of-gravity defuzzification: equations (20) to (22).
#pragma once

#include <array>

#include "core/control/autopilot_config.h"

namespace dispersa {

inline constexpr int kFuzzySets = 5;
inline constexpr int kFuzzyRules = kFuzzySets * kFuzzySets;

/// Grades of the five sets, centred at -range, -range/2, 0, range/2, range. Neighbours cross at one half
/// and the outer sets are shoulders, so the grades of any x sum to 1.
std::array<double, kFuzzySets> Memberships(double x, double range);

/// Regressive vector zeta of (22), with the product as the rules' AND. Rule i * 5 + j has the error's set
/// i and the rate's set j.
std::array<double, kFuzzyRules> Regressor(const FuzzyRules& rules, double error_rad, double rate_rad_s);

/// Consequents, rad/s², that make the rule surface the plane kp e + kd de/dt between the outer centres.
std::array<double, kFuzzyRules> PlaneConsequents(const FuzzyRules& rules, const AxisGains& gains);

}  // namespace dispersa
