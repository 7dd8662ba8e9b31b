#include "core/flight/sequence.h"

#include <algorithm>
#include <cmath>

namespace dispersa {

namespace {

double DetectionOf(double burnout_s, double tick_s) {
  return std::ceil((burnout_s - kSameInstant_s) / tick_s) * tick_s;
}

}  // namespace

BoosterTimes BuildBoosterTimes(const Boosters& boosters, const MotorBurn& burn, const StageTimes& stage,
                               double tick_s) {
  BoosterTimes times;
  times.burnout_s = std::min(stage.ignition_s + burn.duration_s, stage.burnout_s);
  times.separation_s =
      std::min(DetectionOf(times.burnout_s, tick_s) + boosters.separation_delay_s, stage.burnout_s);
  return times;
}

std::vector<StageTimes> BuildTimeline(const Vehicle& vehicle, const std::vector<MotorBurn>& burns,
                                      double tick_s, double last_ignition_s,
                                      const std::array<double, kMaxStages>& earlier_ignition_s,
                                      const FlightInputs& in) {
  std::vector<StageTimes> times(burns.size());
  for (std::size_t i = 0; i < burns.size(); ++i) {
    const Stage& stage = vehicle.stages[i];
    switch (stage.ignition) {
      case IgnitionTrigger::kLiftOff:
        times[i].ignition_s = -vehicle.hold_down_s;
        break;
      case IgnitionTrigger::kBurnoutDetection:
        times[i].ignition_s =
            times[i - 1].separation_s + std::max(stage.ignition_delay_s + in.stages[i].ignition_delay_s, 0.0);
        break;
      case IgnitionTrigger::kTimer: {
        const double timer_s = i + 1 == burns.size() ? last_ignition_s : earlier_ignition_s[i];
        times[i].ignition_s = std::max(timer_s + in.stages[i].ignition_delay_s, times[i - 1].separation_s);
        break;
      }
    }
    times[i].burnout_s = times[i].ignition_s + burns[i].duration_s;
    const double detection_s = DetectionOf(times[i].burnout_s, tick_s);
    const bool last = i + 1 == burns.size();
    times[i].separation_s =
        last ? times[i].burnout_s
             : detection_s + std::max(stage.separation_delay_s + in.stages[i].separation_delay_s, 0.0);
  }
  return times;
}

}  // namespace dispersa
