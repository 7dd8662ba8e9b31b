#include "core/control/reaction_control.h"

#include "core/control/autopilot_step.h"

namespace dispersa {

int StepThrusters(const ReactionControlLogic& logic, double error_rad, double rate_rad_s, int minimum_cycles,
                  ThrusterState& state) {
  lanes::StepThrusters(logic, minimum_cycles, true, error_rad, rate_rad_s, state);
  return static_cast<int>(state.direction);
}

}  // namespace dispersa
