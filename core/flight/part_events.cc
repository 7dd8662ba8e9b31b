#include "core/flight/part_events.h"

#include <algorithm>

namespace dispersa {

void Kink::Times(const StageCourse& course, PartTimes& times) {
  const auto add = [&](const MotorBurn& burn) {
    for (const double kink_s : burn.Kinks(course.times.ignition_s)) times.push_back({kink_s});
  };
  add(course.plant.stacks[static_cast<std::size_t>(course.stage)].burn);
  if (course.stage > 0 || !course.plant.boosters) return;
  for (const EachBooster& booster : course.plant.boosters->each) add(booster.burn);
}

void BoosterBurnout::Times(const StageCourse& course, PartTimes& times) {
  if (course.stage > 0 || !course.plant.boosters) return;
  int item = 0;
  for (const EachBooster& booster : course.plant.boosters->each)
    times.push_back(
        {BuildBoosterTimes(course.vehicle.boosters, booster.burn, course.times, course.tick_s).burnout_s,
         item++});
}

void BoosterSeparation::Times(const StageCourse& course, PartTimes& times) {
  if (course.stage > 0 || !course.plant.boosters) return;
  const std::vector<EachBooster>& boosters = course.plant.boosters->each;
  const EachBooster& last = *std::max_element(
      boosters.begin(), boosters.end(),
      [](const EachBooster& a, const EachBooster& b) { return a.burn.duration_s < b.burn.duration_s; });
  times.push_back(
      {BuildBoosterTimes(course.vehicle.boosters, last.burn, course.times, course.tick_s).separation_s});
}

void RailExit::Times(const StageCourse& course, PartTimes& times) {
  if (course.stage > 0 || course.rail_exit_s < 0.0) return;
  times.push_back({course.rail_exit_s, -1, course.rail_exit_s >= course.times.burnout_s});
}

void SpinEnd::Times(const StageCourse& course, PartTimes& times) {
  const auto& spin = course.vehicle.stages[static_cast<std::size_t>(course.stage)].spin_motors;
  if (!spin) return;
  const double end_s = course.times.ignition_s + spin->duration_s;
  if (end_s < course.times.burnout_s) times.push_back({end_s});  // else with the stage's own burnout
}

std::string NameOf(const Vehicle& vehicle, const FlightEvent& event) {
  const std::string stage = "stage_" + std::to_string(event.stage + 1);
  switch (event.kind) {
    case EventKind::kIgnition:
      return event.stage == 0 ? "lift_off" : stage + "_ignition";
    case EventKind::kBurnout:
      return stage + "_burnout";
    case EventKind::kSeparation:
      // Between two burns of one engine nothing leaves.
      return vehicle.stages[static_cast<std::size_t>(event.stage) + 1].restarts ? "" : stage + "_separation";
    case EventKind::kPart:
      break;
  }
  if (Is<BoosterBurnout>(event)) return "booster_" + std::to_string(event.item + 1) + "_burnout";
  if (Is<BoosterSeparation>(event)) return "boosters_separation";
  if (Is<RailExit>(event)) return "rail_exit";
  return Is<SpinEnd>(event) ? stage + "_spin_end" : "";
}

void AddEvents(const StageCourse& course, bool is_last, std::vector<FlightEvent>& events) {
  std::vector<FlightEvent> during, after;
  PartEvents::Each([&](auto of, int part) {
    PartTimes times;
    decltype(of)::Times(course, times);
    for (const PartTime& at : times)
      (at.after_burnout ? after : during)
          .push_back({at.time_s, EventKind::kPart, course.stage, part, at.item});
  });
  std::stable_sort(during.begin(), during.end(),
                   [](const FlightEvent& a, const FlightEvent& b) { return a.time_s < b.time_s; });
  events.push_back({course.times.ignition_s, EventKind::kIgnition, course.stage});
  events.insert(events.end(), during.begin(), during.end());
  events.push_back({course.times.burnout_s, EventKind::kBurnout, course.stage});
  events.insert(events.end(), after.begin(), after.end());
  if (!is_last) events.push_back({course.times.separation_s, EventKind::kSeparation, course.stage});
}

}  // namespace dispersa
