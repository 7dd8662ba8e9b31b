// Times at which stages ignite, burn out and separate. Burns are closed forms of time, so the whole timeline
// is known before the flight. Detection and separation still act on the autopilot's ticks.
#pragma once

#include <array>
#include <vector>

#include "core/flight/flight_inputs.h"
#include "core/vehicle/propulsion.h"
#include "core/vehicle/vehicle.h"

namespace dispersa {

struct StageTimes {
  double ignition_s = 0.0;
  double burnout_s = 0.0;
  double separation_s = 0.0;  ///< of this stage (of the last stage: its burnout, where the flight ends)
};

/// Events within this time of a tick happen on the tick.
inline constexpr double kSameInstant_s = 1e-9;

/// Times since lift-off. Burnout is exact. It is detected on the next tick, and the stage separates
/// `separation_delay_s` later. A stage that ignites on burnout detection does so `ignition_delay_s` after it.
/// A stage on the timer ignites at last_ignition_s if it is the last, else at earlier_ignition_s, but not
/// before the stage below has separated. The delays of a flight (`in`) are added. No delay moves an event
/// before its trigger.
std::vector<StageTimes> BuildTimeline(const Vehicle& vehicle, const std::vector<MotorBurn>& burns,
                                      double tick_s, double last_ignition_s,
                                      const std::array<double, kMaxStages>& earlier_ignition_s = {},
                                      const FlightInputs& in = {});

/// Times of boosters that ignite with the first stage: exact burnout, and separation on the flight computer's
/// ticks. They separate no later than the stage burns out.
struct BoosterTimes {
  double burnout_s = 0.0;
  double separation_s = 0.0;
};
BoosterTimes BuildBoosterTimes(const Boosters& boosters, const MotorBurn& burn, const StageTimes& stage,
                               double tick_s);

}  // namespace dispersa
