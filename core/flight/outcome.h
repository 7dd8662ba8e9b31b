// How a flight ended.
#pragma once

#include <string>

namespace dispersa {

enum class Outcome {
  kCompleted,        ///< reached the end of the last stage's burn
  kLostControl,      ///< attitude error above 15° for 0.5 s, or a rate above 60 °/s
  kStructuralLimit,  ///< only if the vehicle's limits say so
  kImpact,           ///< fell below the launch site, or did not get off its rail
  kNumericalFailure,
  kTimeout,  ///< of simulated time
};
inline constexpr int kOutcomeCount = 6;

/// "completed", "lost_control", ...
const char* OutcomeName(Outcome outcome);
/// The outcome of a name. Returns false if no outcome has this name.
bool ParseOutcome(const std::string& name, Outcome* outcome);

}  // namespace dispersa
