#include "core/control/autopilot.h"

#include <cmath>
#include <limits>

#include "core/control/autopilot_step.h"
#include "core/control/plugin.h"

namespace dispersa {

namespace {

constexpr double kSameNode = 1e-6;  // of a step: rounding

EffectivenessRows RowsOf(const StageControl& stage) {
  const Table1D& pitch = stage.pitch_effectiveness_1_s2;
  const Table1D& roll = stage.roll_effectiveness_1_s2;
  const std::size_t rows = pitch.x.size() - 1;
  EffectivenessRows table;
  table.end_s = pitch.x.back();
  table.buckets_per_s = static_cast<double>(rows) / table.end_s;
  const auto add = [&](std::size_t i) {
    for (const Table1D* t : {&pitch, &roll}) {
      const double slope = (t->y[i + 1] - t->y[i]) / (t->x[i + 1] - t->x[i]);
      table.rows.insert(table.rows.end(), {t->y[i] - slope * t->x[i], slope});
    }
  };
  for (std::size_t i = 0; i < rows; ++i) add(i);
  add(rows - 1);  // the end itself
  const double step = table.end_s / static_cast<double>(rows);
  bool is_even = true;
  for (std::size_t i = 0; i < rows; ++i)
    is_even &= std::fabs(pitch.x[i] - step * static_cast<double>(i)) < kSameNode * step;
  if (is_even) return table;
  table.row_end_s.assign(pitch.x.begin() + 1, pitch.x.end());
  table.row_end_s.back() = std::numeric_limits<double>::infinity();
  int row = 0;
  for (std::size_t bucket = 0; bucket <= rows; ++bucket) {
    while (table.row_end_s[static_cast<std::size_t>(row)] * table.buckets_per_s <=
           static_cast<double>(bucket))
      ++row;
    table.first.push_back(row);
  }
  return table;
}

}  // namespace

AutopilotModel BuildAutopilot(const AutopilotConfig& config, std::vector<StageControl> stages,
                              double thruster_minimum_on_time_s) {
  AutopilotModel model;
  model.config = config;
  model.laws = {BuildAxisLaw(config.roll, config.tick_s), BuildAxisLaw(config.pitch, config.tick_s),
                BuildAxisLaw(config.yaw, config.tick_s)};
  for (const AxisLaw& law : model.laws) model.is_scheduled |= !law.config.schedule.empty();
  for (const StageControl& stage : stages) model.effectiveness.push_back(RowsOf(stage));
  model.stages = std::move(stages);
  if (config.plugin && PluginAxes(config) != 0) model.plugin = std::make_shared<PluginLaw>(*config.plugin);
  const double cycle_s = config.tick_s * config.reaction_control.cycle_ticks;
  model.thruster_minimum_cycles = static_cast<int>(std::ceil(thruster_minimum_on_time_s / cycle_s - 1e-9));
  return model;
}

void StartStage(const AutopilotModel& model, int stage, AutopilotState& state) {
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    const AxisConfig& config = model.laws[axis].config;
    lanes::WithLaw(config.law, [&](auto law) { decltype(law)::StartStage(config, stage, state.axes[axis]); });
    state.axes[axis].saturation = state.axes[axis].model_started = 0.0;
    for (double(&memory)[2] : state.axes[axis].filters) memory[0] = memory[1] = 0.0;
    state.thrusters[axis] = ThrusterState{};
  }
}

GimbalCommand StepGimbals(const AutopilotModel& model, int stage, double since_ignition_s,
                          const AttitudeError& error, const Vector2& pn_factor, double gain,
                          AutopilotState& state) {
  using namespace lanes;
  GimbalLoop<double> loop;
  SetLoop(loop, 0, model, stage, pn_factor.x(), pn_factor.y(), gain);
  AxisMemory<double> memory[kAxes];
  for (int axis = 0; axis < kAxes; ++axis) SetLaneValues<double>(memory[axis], 0, state.axes[axis]);
  const Vector<double> angle{error.angle_rad.x(), error.angle_rad.y(), error.angle_rad.z()};
  const Vector<double> rate{error.rate_rad_s.x(), error.rate_rad_s.y(), error.rate_rad_s.z()};
  const double program[kAxes] = {error.program_rad_s2.x(), error.program_rad_s2.y(),
                                 error.program_rad_s2.z()};
  GimbalOutput<double> out;
  lanes::StepGimbals<true>(model, loop, true, since_ignition_s, angle, rate, program,
                           static_cast<const double*>(nullptr), memory, out);
  GimbalCommand command{out.deflection_rad[kRoll], out.deflection_rad[kPitch], out.deflection_rad[kYaw], {}};
  for (int axis = 0; axis < kAxes; ++axis) {
    ReadLaneValues<double>(memory[axis], 0, state.axes[axis]);
    command.telemetry[static_cast<std::size_t>(axis)] =
        TelemetryOf(model.laws[static_cast<std::size_t>(axis)].config, out.axes[axis], memory[axis], 0);
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
