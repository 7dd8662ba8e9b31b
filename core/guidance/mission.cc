#include "core/guidance/mission.h"

#include <algorithm>
#include <cstddef>

#include "core/math/functions.h"
#include "core/vehicle/cut_off.h"

namespace dispersa {

Vector3 UnitVector(const Direction& direction) {
  const SinCos pitch = SineCosine(direction.pitch_rad), yaw = SineCosine(direction.yaw_rad);
  return {pitch.cos * yaw.cos, yaw.sin, -pitch.sin * yaw.cos};
}

namespace {

// The interval that a time falls into, and how far into it.
struct Place {
  std::size_t interval = 0;
  double part = 0.0;
  bool outside = false;
};
Place Find(const DirectionTable& table, double time_s) {
  const double last = static_cast<double>(table.at.size() - 1);
  const double place = (time_s - table.start_s) / table.step_s;
  if (!(place > 0.0)) return {0, 0.0, place < 0.0};
  if (place >= last) return {table.at.size() - 2, 1.0, true};
  const auto interval = static_cast<std::size_t>(place);
  return {interval, place - static_cast<double>(interval), false};
}

}  // namespace

Direction DirectionTable::At(double time_s) const {
  const Place place = Find(*this, time_s);
  const Direction &from = at[place.interval], &to = at[place.interval + 1];
  return {from.pitch_rad + place.part * (to.pitch_rad - from.pitch_rad),
          from.yaw_rad + place.part * (to.yaw_rad - from.yaw_rad)};
}

Direction DirectionTable::RateAt(double time_s) const {
  const Place place = Find(*this, time_s);
  if (place.outside) return {};
  const Direction &from = at[place.interval], &to = at[place.interval + 1];
  return {(to.pitch_rad - from.pitch_rad) / step_s, (to.yaw_rad - from.yaw_rad) / step_s};
}

double GuidedStage::DroppedBy(double time_s) const {
  double dropped_kg = 0.0;
  for (const MassDrop& drop : drops)
    if (drop.time_s <= time_s) dropped_kg += drop.mass_kg;
  return dropped_kg;
}

double GuidedStage::LessDropped(double mass_kg) const {
  for (const MassDrop& drop : drops)
    if (!drop.waits()) mass_kg -= drop.mass_kg;
  return mass_kg;
}

bool GuidedStage::SeeLeft(unsigned bodies, double at_s) {
  bool any = false;
  for (MassDrop& drop : drops) {
    if (!drop.waits() || (bodies & drop.body) == 0u) continue;
    drop.time_s = at_s;
    any = true;
  }
  return any;
}

GuidedStage AfterBurn(const GuidedStage& below, GuidedStage last, double duration_s) {
  const double burnt_kg = below.Burnt(duration_s);
  double dropped_kg = 0.0;  // also between the burns
  for (const MassDrop& drop : below.drops) dropped_kg += drop.mass_kg;
  for (const MassDrop& drop : last.drops) dropped_kg -= drop.mass_kg;
  last.ignition_mass_kg = below.ignition_mass_kg - dropped_kg - burnt_kg;
  last.usable_kg = below.usable_kg - burnt_kg;
  return last;
}

double IdealVelocity(const GuidedStage& stage) {
  const double mass_kg = stage.ignition_mass_kg - stage.early_kg;
  return stage.burn.ExhaustVelocity() *
         Log(mass_kg / (mass_kg - stage.burn.propellant_mass_kg + stage.burn.left_kg));
}

bool IsCutOffByGuidance(const Stage& stage) {
  return stage.is_liquid() && (EndsInFlight(stage.motor) || stage.motor.cut_off == CutOff::kAtTime);
}

std::size_t FirstGuided(const Vehicle& vehicle, const GuidanceConfig& config) {
  const std::size_t burns = vehicle.stages.size();
  std::size_t first = burns - std::min(burns, static_cast<std::size_t>(config.burns));
  for (std::size_t i = first; i + 1 < burns; ++i)
    if (!vehicle.stages[i].is_controlled()) first = i + 1;
  return first;
}

bool SteersBelow(const Vehicle& vehicle, const GuidanceConfig& config) {
  return FirstGuided(vehicle, config) + 1 < vehicle.stages.size();
}

bool PlansBelow(const Vehicle& vehicle, const GuidanceConfig& config) {
  const bool leaves_air_late = vehicle.stages.size() == 2 && vehicle.boosters.count == 0;
  return SteersBelow(vehicle, config) && !leaves_air_late;
}

}  // namespace dispersa
