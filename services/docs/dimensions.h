// The dimensions of the input files by their names.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/input/fields.h"

namespace dispersa {

inline const std::vector<std::pair<const char*, Dimension>> kDimensions = {
    {"length", kLength},
    {"area", kArea},
    {"time", kTime},
    {"mass", kMass},
    {"mass flow", kMassFlow},
    {"inertia", kInertia},
    {"mass per length", kMassPerLength},
    {"modulus", kModulus},
    {"bending stiffness", kBendingStiffness},
    {"force", kForce},
    {"moment", kMoment},
    {"pressure", kPressure},
    {"pressure of a gas", kGasPressure},
    {"pressure times angle", kPressureAngle},
    {"heat flux", kHeatFlux},
    {"speed", kSpeed},
    {"acceleration", kAcceleration},
    {"angle", kAngle},
    {"angular rate", kAngularRate},
    {"frequency", kFrequency},
    {"angular acceleration", kAngularAcceleration},
    {"per time", kPerTime},
    {"per time squared", kPerTimeSquared},
    {"per length", kPerLength},
    {"per speed", kPerSpeed},
    {"density", kDensity},
    {"share", kShare},
    {"temperature", kTemperature},
    {"temperature difference", kTemperatureDifference},
    {"per temperature", kPerTemperature},
    {"per angle", kPerAngle}};

/// By its units, of whose order nothing depends.
inline std::string DimensionName(Dimension dimension) {
  for (const auto& [name, units] : kDimensions) {
    std::size_t shared = 0;
    for (const Unit& unit : units)
      for (const Unit& own : dimension) shared += unit.suffix == own.suffix;
    if (shared == units.size() && shared == dimension.size()) return name;
  }
  return "number";
}

}  // namespace dispersa
