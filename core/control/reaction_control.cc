#include "core/control/reaction_control.h"

namespace dispersa {

int StepThrusters(const ReactionControlLogic& logic, double error, double rate, int minimum_ticks,
                  ThrusterState& state) {
  const double s = error + logic.rate_gain_s * rate;
  if (state.direction != 0) {
    ++state.ticks_on;
    const double closing = logic.deadband_rad * (1.0 - logic.hysteresis);
    if (state.ticks_on < minimum_ticks || s * state.direction > closing) return state.direction;
    state = ThrusterState{};
  }
  if (s > logic.deadband_rad)
    state.direction = 1;
  else if (s < -logic.deadband_rad)
    state.direction = -1;
  return state.direction;
}

}  // namespace dispersa
