// When stages ignite, burn out and separate. Burns are closed forms of time, so the whole timeline of a
// flight is known beforehand; detection and separation still act on the autopilot's ticks.
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
  double separation_s = 0.0;  ///< of this stage; of the last: its burnout, where the flight ends
};

/// Events within this time of a tick happen on the tick.
inline constexpr double kSameInstant_s = 1e-9;

/// Times since lift-off. Burnout is exact; it is detected on the next tick, and the stage separates
/// `separation_delay_s` later. A stage on burnout detection ignites `ignition_delay_s` after that; a stage
/// on the timer at last_ignition_s, one before the last at earlier_ignition_s, or at separation of the stage
/// below if that is later. `in` has the delays of a flight, which add; none takes an event before what
/// triggers it.
std::vector<StageTimes> BuildTimeline(const Vehicle& vehicle, const std::vector<MotorBurn>& burns,
                                      double tick_s, double last_ignition_s,
                                      const std::array<double, kMaxStages>& earlier_ignition_s = {},
                                      const FlightInputs& in = {});

/// Of boosters that ignite with the first stage: exact burnout, and separation by the flight computer's
/// ticks. They leave no later than the stage burns out.
struct BoosterTimes {
  double burnout_s = 0.0;
  double separation_s = 0.0;
};
BoosterTimes BuildBoosterTimes(const Boosters& boosters, const MotorBurn& burn, const StageTimes& stage,
                               double tick_s);

}  // namespace dispersa
