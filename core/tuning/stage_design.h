// The gains of one stage as numbers without unit, so that one search box suits every stage and vehicle.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/control/autopilot_config.h"

namespace dispersa {

struct DesignVariable {
  const char* name;
  double lower;
  double upper;
  double start;  ///< cautious: every search begins with it
};

/// - bandwidth: natural frequency w = sqrt(kp) of the error dynamics over that of the stage's actuator;
/// - damping: its damping ratio kd / (2 w);
/// - learning: what lasts of the adaptation is an integrator of gain gamma p12 / 25 (of the mean of 25 rules,
///   see LinearLaw); its ratio to w³. Only where the law adapts.
inline constexpr std::array<DesignVariable, 3> kDesignVariables = {{
    {"bandwidth", 0.04, 0.35, 0.10},
    {"damping", 0.4, 1.6, 0.9},
    {"learning", 0.0, 0.5, 0.05},
}};

/// How many of them a stage of this autopilot has: 3 if an axis adapts by fuzzy rules, else 2.
std::size_t DesignSize(const AutopilotConfig& autopilot);

/// Gives one stage (0-based) of all axes the gains of a design, shape (DesignSize), and adaptive fuzzy axes
/// its gamma; rounded to `kDesignDigits`, so that a file that prints them holds exactly what was flown.
void ApplyDesign(const std::vector<double>& design, int stage, double actuator_rad_s,
                 AutopilotConfig& autopilot);
inline constexpr int kDesignDigits = 3;

/// The nearest number of so many significant decimal digits.
double RoundToDigits(double value, int digits);

}  // namespace dispersa
