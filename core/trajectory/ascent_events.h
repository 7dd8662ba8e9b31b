// Events of an ascent and their times.
#pragma once

#include <vector>

#include "core/trajectory/ascent.h"

namespace dispersa {

struct AscentEvent {
  enum Kind {
    kIgnition,
    kBurnout,
    kSeparation,
    kBoosterBurnout,
    kBoosterSeparation,
    kTurnBegin,
    kTurnEnd,
    kKink
  };

  double time_s;  ///< since lift-off, exact (an ignition may be earlier)
  Kind kind;      ///< kKink: thrust or program bend there, and no step may go across
  int stage;
};

/// In the order of time.
struct AscentEvents {
  std::vector<AscentEvent> events;
  double last_ignition_s = 0.0;                         ///< the last stage's timer, 0 for a single stage
  std::array<double, kMaxStages> earlier_ignition_s{};  ///< the others'
};
AscentEvents EventsOf(const AscentModel& model, const std::vector<MotorBurn>& burns,
                      const FlightProgram& program);
/// Nominal ones of a model's stages.
std::vector<MotorBurn> BurnsOf(const AscentModel& model);

}  // namespace dispersa
