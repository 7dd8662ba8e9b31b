#include "core/trajectory/ascent_events.h"

#include <algorithm>

#include "core/flight/sequence.h"

namespace dispersa {

std::vector<MotorBurn> BurnsOf(const AscentModel& model) {
  std::vector<MotorBurn> burns;
  for (const LauncherStack& stack : model.plant.stacks) burns.push_back(stack.burn);
  return burns;
}

AscentEvents EventsOf(const AscentModel& model, const std::vector<MotorBurn>& burns,
                      const FlightProgram& program) {
  const std::size_t last = burns.size() - 1;
  AscentEvents all;
  // A coast counts from the burnout below. No later timer moves that burnout.
  const auto timeline = [&] {
    return BuildTimeline(model.vehicle, burns, model.tick_s, all.last_ignition_s, all.earlier_ignition_s);
  };
  std::vector<StageTimes> times = timeline();
  for (std::size_t i = 1; i < last; ++i) {
    if (model.vehicle.stages[i].ignition != IgnitionTrigger::kTimer) continue;
    all.earlier_ignition_s[i] = times[i - 1].burnout_s + program.earlier_coast_s[i];
    times = timeline();
  }
  if (last > 0) all.last_ignition_s = times[last - 1].burnout_s + program.coast_s;
  times = timeline();

  std::vector<AscentEvent>& events = all.events;
  for (std::size_t i = 0; i <= last; ++i) {
    const int stage = static_cast<int>(i);
    events.push_back({times[i].ignition_s, AscentEvent::kIgnition, stage});
    for (const double kink_s : burns[i].Kinks(times[i].ignition_s))
      events.push_back({kink_s, AscentEvent::kKink, stage});
    events.push_back({times[i].burnout_s, AscentEvent::kBurnout, stage});
    if (i < last) events.push_back({times[i].separation_s, AscentEvent::kSeparation, stage});
  }
  if (const BoosterSet* boosters = model.plant.boosters.get()) {
    const BoosterTimes beside =
        BuildBoosterTimes(model.vehicle.boosters, boosters->burn, times[0], model.tick_s);
    for (const double kink_s : boosters->burn.Kinks(times[0].ignition_s))
      events.push_back({kink_s, AscentEvent::kKink, 0});
    events.push_back({beside.burnout_s, AscentEvent::kBoosterBurnout, 0});
    events.push_back({beside.separation_s, AscentEvent::kBoosterSeparation, 0});
  }
  events.push_back({program.t1_s, AscentEvent::kTurnBegin, 0});
  events.push_back({program.t3_s, AscentEvent::kKink, 0});
  events.push_back({program.t2_s, AscentEvent::kTurnEnd, 0});
  std::stable_sort(events.begin(), events.end(),
                   [](const AscentEvent& a, const AscentEvent& b) { return a.time_s < b.time_s; });
  return all;
}

}  // namespace dispersa
