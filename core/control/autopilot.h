// The flight computer's attitude loop: errors in, nozzle and thruster commands out, once a tick.
//
// Plain data; the loop itself is autopilot_step.h, written once for any number of flights.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/control/axis_controller.h"
#include "core/control/reaction_control.h"
#include "core/math/aligned_rows.h"
#include "core/math/table.h"

namespace dispersa {

class PluginLaw;

enum Axis : int { kRoll = 0, kPitch = 1, kYaw = 2 };
inline constexpr int kAxes = 3;
inline constexpr const char* kAxisNames[kAxes] = {"roll", "pitch", "yaw"};

/// The autopilot's knowledge of a stage from nominal data: angular acceleration per radian of deflection over
/// the time since ignition, and the limits of the nozzles. Both tables share their arguments.
struct StageControl {
  Table1D pitch_effectiveness_1_s2;  ///< of yaw too
  Table1D roll_effectiveness_1_s2;
  double limit_rad = 0.0;
};

/// StageControl's tables as straight pieces: a row has pitch (constant, slope) and roll (constant, slope)
/// over the time since ignition, held outside [0, end_s]. Time is cut into equal buckets; unless each is a
/// row, `first` is the row at the beginning of each.
struct EffectivenessRows {
  static constexpr int kRowSize = 4;

  AlignedRows rows;
  double buckets_per_s = 0.0;
  double end_s = 0.0;
  std::vector<int> first;
  std::vector<double> row_end_s;  ///< of each row where there is `first`; the last one never ends

  /// The index of the row at a time in [0, end_s].
  int IndexAt(double since_ignition_s) const {
    int row = static_cast<int>(since_ignition_s * buckets_per_s);
    if (!first.empty()) {
      row = first.data()[row];
      while (since_ignition_s >= row_end_s.data()[row]) ++row;
      while (row > 0 && since_ignition_s < row_end_s.data()[row - 1]) --row;  // rounding had put it one on
    }
    return row;
  }
  const double* Row(int index) const { return rows.data() + kRowSize * index; }
};

/// Shared by all flights.
struct AutopilotModel {
  AutopilotConfig config;
  std::array<AxisLaw, kAxes> laws;
  bool is_scheduled = false;  ///< a law changes within a stage
  std::vector<StageControl> stages;
  std::vector<EffectivenessRows> effectiveness;  ///< one a stage
  int thruster_minimum_cycles = 1;
  std::shared_ptr<const PluginLaw> plugin;  ///< null: no axis needs one
};
AutopilotModel BuildAutopilot(const AutopilotConfig& config, std::vector<StageControl> stages,
                              double thruster_minimum_on_time_s);

/// Memory of one flight's autopilot.
struct AutopilotState {
  AxisState axes[kAxes];
  ThrusterState thrusters[kAxes];
};

/// Errors reference - true about body x, y, z: angle (rad) and rate (rad/s). For axes with feed-forward also
/// the angular acceleration that the flight program asks for.
struct AttitudeError {
  Vector3 angle_rad = Vector3::Zero();
  Vector3 rate_rad_s = Vector3::Zero();
  Vector3 program_rad_s2 = Vector3::Zero();
};

struct GimbalCommand {
  double roll_rad = 0.0;   ///< the paper's delta gamma
  double pitch_rad = 0.0;  ///< delta phi
  double yaw_rad = 0.0;    ///< delta psi
  std::array<AxisTelemetry, kAxes> telemetry;

  /// Commands of the nozzles right, left, bottom, top.
  std::array<double, 4> Nozzles() const {
    return {pitch_rad + roll_rad, pitch_rad - roll_rad, yaw_rad + roll_rad, yaw_rad - roll_rad};
  }
};

/// At ignition of a stage: loads the rules of the stage. They restart, or without reset keep what they
/// learnt. Adaptive augmenting control always restarts.
void StartStage(const AutopilotModel& model, int stage, AutopilotState& state);
/// One tick of powered flight. `gain` multiplies every command, the other factors P_n (1 in flight).
GimbalCommand StepGimbals(const AutopilotModel& model, int stage, double since_ignition_s,
                          const AttitudeError& error, const Vector2& pn_factor, double gain,
                          AutopilotState& state);
/// One cycle of coast: direction of the couple about each axis.
std::array<int, kAxes> StepReactionControl(const AutopilotModel& model, const AttitudeError& error,
                                           AutopilotState& state);

}  // namespace dispersa
