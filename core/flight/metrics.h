// What is measured of a flight, under the names that results carry.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "core/vehicle/vehicle.h"

namespace dispersa {

/// The metrics in the order of their columns. A metric that a flight does not define (a stage that it
/// never reached) is NaN inside and NULL, empty or null outside.
const std::vector<std::string>& MetricNames();
/// The column of a metric that exists.
std::size_t MetricColumn(const std::string& name);

enum class Outcome {
  kCompleted,        ///< reached the end of the last stage's burn
  kLostControl,      ///< attitude error above 15° for 0.5 s, or a rate above 60 °/s
  kStructuralLimit,  ///< only if the vehicle's limits say so
  kImpact,
  kNumericalFailure,
  kTimeout,          ///< of simulated time
};
inline constexpr int kOutcomeCount = 6;

/// "completed", "lost_control", ...
const char* OutcomeName(Outcome outcome);
/// Of a name; false if there is none such.
bool ParseOutcome(const std::string& name, Outcome* outcome);

}  // namespace dispersa
