#include "core/control/reaction_control.h"

namespace dispersa {

int StepThrusters(const ReactionControlLogic& logic, double error, double rate, int minimum_cycles,
                  ThrusterState& state) {
  const double s = error + logic.rate_gain_s * rate;
  if (state.direction != 0) {
    ++state.cycles_on;
    const double closing = logic.deadband_rad * (1.0 - logic.hysteresis);
    if (state.cycles_on < minimum_cycles || s * state.direction > closing) return state.direction;
    state = ThrusterState{};
  }
  if (s > logic.deadband_rad)
    state.direction = 1;
  else if (s < -logic.deadband_rad)
    state.direction = -1;
  return state.direction;
}

}  // namespace dispersa
