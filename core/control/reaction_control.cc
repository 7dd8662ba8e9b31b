#include "core/control/reaction_control.h"

#include "core/control/autopilot_step.h"

namespace dispersa {

int StepThrusters(const ReactionControlLogic& logic, double error_rad, double rate_rad_s, int minimum_cycles,
                  ThrusterState& state) {
  lanes::ThrusterStateLanes<double> memory{static_cast<double>(state.direction),
                                           static_cast<double>(state.cycles_on)};
  lanes::StepThrusters(logic, minimum_cycles, true, error_rad, rate_rad_s, memory);
  state.direction = static_cast<int>(memory.direction);
  state.cycles_on = static_cast<int>(memory.cycles_on);
  return state.direction;
}

}  // namespace dispersa
