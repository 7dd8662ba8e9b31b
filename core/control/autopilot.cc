#include "core/control/autopilot.h"

#include <cmath>

namespace dispersa {

AutopilotModel BuildAutopilot(const AutopilotConfig& config, std::vector<StageControl> stages,
                              double thruster_minimum_on_time_s) {
  AutopilotModel model;
  model.config = config;
  model.laws = {BuildAxisLaw(config.roll), BuildAxisLaw(config.pitch), BuildAxisLaw(config.yaw)};
  model.stages = std::move(stages);
  const double cycle_s = config.tick_s * config.reaction_control.cycle_ticks;
  model.thruster_minimum_cycles = static_cast<int>(std::ceil(thruster_minimum_on_time_s / cycle_s - 1e-9));
  return model;
}

void StartStage(const AutopilotModel& model, int stage, AutopilotState& state) {
  const std::size_t to = static_cast<std::size_t>(stage);
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    const AxisLaw& law = model.laws[axis];
    AxisState& memory = state.axes[axis];
    if (stage == 0 || law.config.adaptation.reset_at_ignition || law.config.law == ControlLaw::kPdAac) {
      ResetAxis(law, stage, memory);
    } else {
      // What was learnt is a departure from the start of the stage before; it is carried over.
      for (std::size_t i = 0; i < kFuzzyRules; ++i)
        memory.consequents[i] += law.stages[to].consequents[i] - law.stages[to - 1].consequents[i];
    }
    state.saturation[axis] = 0;
    state.thrusters[axis] = ThrusterState{};
  }
}

GimbalCommand StepGimbals(const AutopilotModel& model, int stage, double since_ignition_s,
                          const AttitudeError& error, const Vector2& pn_factor, double gain,
                          AutopilotState& state) {
  const StageControl& control = model.stages[static_cast<std::size_t>(stage)];
  const double pitch_effectiveness = control.pitch_effectiveness_1_s2(since_ignition_s);
  const double roll_effectiveness = control.roll_effectiveness_1_s2(since_ignition_s);
  GimbalCommand command;
  double* out[kAxes] = {&command.roll_rad, &command.pitch_rad, &command.yaw_rad};
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    const int index = static_cast<int>(axis);
    const double u =
        StepAxis(model.laws[axis], stage, error.angle_rad[index], error.rate_rad_s[index],
                 state.saturation[axis], pn_factor, model.config.tick_s, state.axes[axis],
                 command.telemetry[axis]);
    const double deflection =
        gain * u / (axis == kRoll ? roll_effectiveness : pitch_effectiveness);
    state.saturation[axis] =
        deflection > control.limit_rad ? 1 : (deflection < -control.limit_rad ? -1 : 0);
    *out[axis] = deflection;
  }
  return command;
}

std::array<int, kAxes> StepReactionControl(const AutopilotModel& model, const AttitudeError& error,
                                           AutopilotState& state) {
  std::array<int, kAxes> direction{};
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    const int index = static_cast<int>(axis);
    direction[axis] =
        StepThrusters(model.config.reaction_control, error.angle_rad[index], error.rate_rad_s[index],
                      model.thruster_minimum_cycles, state.thrusters[axis]);
  }
  return direction;
}

}  // namespace dispersa
