// The vehicle's sensors as flights use them.
#pragma once

#include <array>
#include <vector>

#include "core/control/autopilot_config.h"
#include "core/control/filter.h"
#include "core/vehicle/vehicle.h"

namespace dispersa {

struct GyroModel {
  DigitalSection section;  ///< from the rates at ticks to what the gyro shows
  double quantum_rad_s = 0.0;
  int sample_ticks = 1;
};

struct SensorModel {
  std::vector<GyroModel> gyros;
  /// The weights in a stage's rates: of each gyro, and of the inertial unit. Their sum is 1.
  struct Weights {
    std::array<double, kRateGyros> gyro{};
    double unit = 1.0;
  };
  std::vector<Weights> stages;
  bool uses_gyros = false;  ///< in any stage
};

/// Precondition: no GyroProblems.
SensorModel BuildSensors(const Vehicle& vehicle, const AutopilotConfig& autopilot);

/// Gyros that the autopilot needs and the vehicle does not have at that place. Paths are those of
/// Problems(AutopilotConfig).
std::vector<StructProblem> GyroProblems(const Vehicle& vehicle, const AutopilotConfig& autopilot);

/// Second order under an input that is straight between ticks, exactly: ramp invariance.
DigitalSection RampInvariant(double frequency_rad_s, double damping_ratio, double tick_s);

}  // namespace dispersa
