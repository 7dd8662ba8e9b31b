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
  Kind kind;      ///< kKink: thrust or program has a kink; no step may cross it
  int stage;
};

/// Ascending in time.
struct AscentEvents {
  std::vector<AscentEvent> events;
  double last_ignition_s = 0.0;                         ///< timer of the last stage; 0 for a single stage
  std::array<double, kMaxStages> earlier_ignition_s{};  ///< timers of the other stages
};
AscentEvents EventsOf(const AscentModel& model, const std::vector<MotorBurn>& burns,
                      const FlightProgram& program);
/// The nominal burns of a model's stages.
std::vector<MotorBurn> BurnsOf(const AscentModel& model);

}  // namespace dispersa
