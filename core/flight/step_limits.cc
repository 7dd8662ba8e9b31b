#include "core/flight/step_limits.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/dynamics/jettison.h"
#include "core/flight/dispersed_vehicle.h"
#include "core/math/constants.h"
#include "core/vehicle/mass.h"
#include "core/vehicle/propulsion.h"

namespace dispersa {
namespace {

std::string Text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

double ActuatorLimit(double nozzle_inertia_kg_m2) {
  return nozzle_inertia_kg_m2 > 0.0 ? kHeavyActuatorLimit_rad : kActuatorLimit_rad;
}

void Take(const std::string& part, double rad_s, double tick_s, double limit_rad, StepUse& greatest) {
  const double fraction = rad_s * tick_s / limit_rad;
  if (fraction > greatest.fraction)
    greatest = {fraction, part + " (" + Text(rad_s / kTwoPi) + " Hz)", limit_rad / tick_s / kTwoPi};
}

// The jettisons that a plant has, all of them.
unsigned AllJettisoned(const LauncherPlant& plant) {
  return ((1u << plant.jettisons.size()) - 1u) | (plant.boosters ? kBoostersGone : 0u);
}

// f(mode, its highest frequency over the burn in either plane, with the flight's factor) of every mode that
// flies: without what the stack jettisons, as no frequency is lower with less mass.
template <typename F>
void EachMode(const LauncherPlant& plant, std::size_t stack, F f) {
  const ModeTable* table = plant.stacks[stack].BendingWithout(AllJettisoned(plant));
  if (table == nullptr) return;
  for (int mode = 0; mode < table->modes; ++mode) {
    double highest_rad_s = 0.0;
    for (int plane = 0; plane < table->planes; ++plane)
      for (std::size_t level = 0; level < table->propellant_kg.size(); ++level)
        highest_rad_s =
            std::max(highest_rad_s, table->Row(plane, static_cast<int>(level), mode)[ModeTable::kFrequency]);
    f(mode, plant.bending.frequency_factor[static_cast<std::size_t>(mode)] * highest_rad_s);
  }
}

// Altitudes that grow, then zeros.
bool IsProfile(const std::array<double, kWindLevels>& altitude_m) {
  const std::size_t levels = static_cast<std::size_t>(WindLevelsOf(altitude_m));
  return std::all_of(altitude_m.begin() + static_cast<std::ptrdiff_t>(levels), altitude_m.end(),
                     [](double altitude) { return altitude == 0.0; });
}

// Sylvester's criterion for the tensor of a stack that has burnt out and let go of all it may, where the
// moments are least.
bool IsInertia(const LauncherPlant& plant, std::size_t index) {
  const LauncherStack& stack = plant.stacks[index];
  const MassProperties empty = MassOf(plant, static_cast<int>(index), AllJettisoned(plant)).At(0.0);
  const double a = empty.axial_inertia_kg_m2, t = empty.transverse_inertia_kg_m2;
  const double xy = stack.product_xy_kg_m2, xz = stack.product_xz_kg_m2, yz = stack.product_yz_kg_m2;
  const double determinant = a * (t * t - yz * yz) - xy * (xy * t + xz * yz) - xz * (xz * t + xy * yz);
  return a * t - xy * xy > 0.0 && determinant > 0.0;
}

}  // namespace

StepUse GreatestStepUse(const LauncherPlant& plant, double tick_s) {
  StepUse greatest;
  for (std::size_t i = 0; i < plant.stacks.size(); ++i) {
    const Gimbal& gimbal = plant.stacks[i].gimbal;
    if (!gimbal.fixed)
      Take("the actuators of stage " + std::to_string(i + 1), gimbal.bandwidth_rad_s, tick_s,
           ActuatorLimit(gimbal.nozzle_inertia_kg_m2), greatest);
    EachMode(plant, i, [&](int mode, double rad_s) {
      Take("bending mode " + std::to_string(mode + 1) + " of stage " + std::to_string(i + 1), rad_s, tick_s,
           kModeLimit_rad, greatest);
    });
  }
  if (plant.boosters_steer())
    Take("the actuators of the boosters", plant.boosters->gimbal.bandwidth_rad_s, tick_s, kActuatorLimit_rad,
         greatest);
  return greatest;
}

double FastestPart(const LauncherPlant& plant, int stack) {
  const auto i = static_cast<std::size_t>(stack);
  double fastest_rad_s = plant.stacks[i].gimbal.bandwidth_rad_s;
  if (stack == 0 && plant.boosters_steer())
    fastest_rad_s = std::max(fastest_rad_s, plant.boosters->gimbal.bandwidth_rad_s);
  EachMode(plant, i, [&](int, double rad_s) { fastest_rad_s = std::max(fastest_rad_s, rad_s); });
  return fastest_rad_s;
}

std::string RefusalOf(const FlightParts& parts, const LauncherPlant& plant, double tick_s) {
  const Vehicle& vehicle = parts.vehicle;
  const FlightInputs& in = parts.set;
  if (std::string why = WhyNotAllowed(parts); !why.empty()) return why;
  for (std::size_t i = 0; i < vehicle.stages.size(); ++i)
    if (!IsInertia(plant, i))
      return "the products of inertia of stage " + std::to_string(i + 1) + " are no body's";
  if (in.payload_mass_kg != 0.0) {
    const Vehicle dispersed = WithDispersedMasses(vehicle, in);
    const double dry_kg = DryMass(dispersed, static_cast<int>(dispersed.stages.size()) - 1);
    for (const MassElement& element : dispersed.stages.back().structure)
      if (!(element.fraction * dry_kg >= 0.0))
        return "the element '" + element.name + "' weighs less than nothing";
  }
  // The number of a nozzle counts those of its own stage.
  const auto stuck = static_cast<std::size_t>(in.stuck_nozzle_stage);
  if (stuck > 0 && in.stuck_nozzle > NozzleCount(vehicle.stages[stuck - 1].gimbal))
    return "stage " + std::to_string(stuck) + " has no nozzle " + Text(in.stuck_nozzle);
  if (in.air.weather_sounding > static_cast<double>(parts.soundings))
    return "the campaign has no sounding " + Text(in.air.weather_sounding);
  if (!IsProfile(in.air.wind_profile_altitude_m)) return "the altitudes of the wind profile do not grow";
  if (plant.boosters && plant.boosters->burn.duration_s >= plant.stacks[0].burn.duration_s)
    return "the boosters burn as long as their stage, or longer";
  for (std::size_t k = 0; plant.boosters && k < plant.boosters->each.size(); ++k)
    if (plant.boosters->each[k].burn.duration_s >= plant.stacks[0].burn.duration_s)
      return "booster " + std::to_string(k + 1) + " burns as long as its stage, or longer";
  const StepUse use = GreatestStepUse(plant, tick_s);
  if (use.fraction <= 1.0) return "";
  return use.part + ": too fast for ticks of " + Text(1e3 * tick_s) + " ms, at most " + Text(use.limit_hz) +
         " Hz";
}

std::vector<StructProblem> StepProblems(const Vehicle& vehicle, double tick_s) {
  std::vector<StructProblem> problems;
  for (std::size_t i = 0; i < vehicle.stages.size(); ++i) {
    const Gimbal& gimbal = vehicle.stages[i].gimbal;
    const double most_rad_s = ActuatorLimit(gimbal.nozzle_inertia_kg_m2) / tick_s;
    if (gimbal.fixed || gimbal.bandwidth_rad_s <= most_rad_s) continue;
    problems.push_back(
        {"stages[" + std::to_string(i) + "].gimbal.bandwidth_rad_s",
         "is too fast for the autopilot's ticks of " + Text(1e3 * tick_s) +
             " ms, which are the "
             "integration's steps",
         "at most " + Text(most_rad_s) + " rad/s (" + Text(most_rad_s / kTwoPi) + " Hz), or shorter ticks"});
  }
  return problems;
}

}  // namespace dispersa
