// The engine's step and its right-hand side without the rest of a flight: a lower bound of a flight's time.
#pragma once

#include <vector>

#include "core/dynamics/launcher.h"
#include "core/environment/weather_profile.h"

namespace dispersa {

/// The state of all lanes: on the first stack.
struct StepSetting {
  const LauncherPlant* plant;
  const FlightWeather* weather;
  bool burning;
  double from_s, tick_s;
  double y[kLauncherSize];
};

/// As compiled for an instruction set and a number of lanes, like LaneEngine.
struct StepInstance {
  const char* isa;
  int lanes;
  /// So many ticks in each lane; the state is set back every second, because nothing steers. `y`: of lane 0
  /// at the end.
  void (*step)(const StepSetting& setting, long ticks, double* y);
  /// So many evaluations in each lane, of everything that depends on time, position and the rest. `dv`: of
  /// lane 0.
  void (*evaluate)(const StepSetting& setting, long evaluations, double* dv);
};

/// Those of them that this processor can run.
std::vector<StepInstance> UsableSteps();

}  // namespace dispersa
