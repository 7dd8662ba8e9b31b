// The state of a flight at one tick or event, for histories and observers.
#pragma once

#include <array>
#include <optional>

#include "core/control/autopilot.h"
#include "core/control/plugin.h"
#include "core/dynamics/launcher.h"
#include "core/flight/attitude_program.h"

namespace dispersa {

struct TickSample {
  double time_s = 0.0;
  int stack = 0;  ///< 0-based
  bool burning = false;
  bool unsteered = false;         ///< nothing controls the attitude
  bool coasting = false;          ///< before an ignition by a timer (last stack: before its own)
  double since_ignition_s = 0.0;  ///< of the burning stage
  RigidBodyState state;
  std::array<double, kMostDrives> nozzle_rad{};  ///< by drive (core/vehicle/nozzle_layout.h)
  std::array<double, kMostDrives> nozzle_rate_rad_s{};
  std::array<double, 2 * kPlanes * kModes> bending{};  ///< modal coordinates (m), then their rates
  std::array<double, kMostDrives> command_rad{};       ///< at the actuators
  double limit_rad = 0.0;
  AttitudeError error;  ///< true, not measured
  ReferenceAttitude reference;
  GimbalCommand gimbal;                     ///< of this tick
  std::array<AxisState, kAxes> memories{};  ///< of the burning stage's laws, after this tick
  std::optional<std::array<double, kLawTelemetry>> law_telemetry =
      {};                 ///< of a plug-in's law, after this tick
  int stuck_nozzle = -1;  ///< index, or none
  std::array<int, kAxes> thrusters{};
  double expelled_mass_kg = 0.0;
  unsigned jettisoned = 0;  ///< as in LauncherPhase, as is
  bool boosting = false;
  unsigned boosters_burning = 0;
  LauncherInstant instant;
};

}  // namespace dispersa
