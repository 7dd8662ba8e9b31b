#include "core/vehicle/vehicle_figures.h"

#include <algorithm>

#include "core/math/assertion.h"
#include "core/math/constants.h"
#include "core/math/functions.h"
#include "core/vehicle/cut_off.h"
#include "core/vehicle/mass.h"
#include "core/vehicle/propulsion.h"

namespace dispersa {

double SitePressure(double altitude_m) {
  // NOAA-S/T 76-1562: 288.15 K and 101325 Pa at the sea, -6.5 K/km; geometric altitude for the geopotential
  // one.
  return 101325.0 * Pow(1.0 - 6.5e-3 / 288.15 * std::min(altitude_m, 11000.0), 5.25588);
}

namespace {

// The largest value in the first second of a burn. A motor without curve is taken to have no ramps.
double GreatestOfFirstSecond(const MotorBurn& burn, double from_s) {
  if (!burn.curve) return burn.vacuum_thrust_n;
  double level = std::max(burn.Fraction(from_s), burn.Fraction(from_s + 1.0));
  for (const double kink_s : burn.Kinks(0.0))
    if (kink_s > from_s && kink_s < from_s + 1.0) level = std::max(level, burn.Fraction(kink_s));
  return burn.vacuum_thrust_n * level;
}

// At corners of the curve: between them it grows no further than by a piece's curvature.
double GreatestLoad_m_s2(const MotorBurn& burn, double empty_kg) {
  if (!burn.curve) return burn.vacuum_thrust_n / empty_kg;
  double greatest = 0.0;
  std::vector<double> corners = burn.Kinks(0.0);
  corners.insert(corners.end(), {0.0, burn.duration_s});
  for (const double at_s : corners)
    greatest =
        std::max(greatest, burn.vacuum_thrust_n * burn.Fraction(at_s) / (empty_kg + burn.Propellant(at_s)));
  return greatest;
}

// Velocity gain of the first stage with boosters. First both flows with their thrusts, as means over the
// boosters' burn; then the stage alone.
double BoostedDeltaV(const Vehicle& vehicle, const MotorBurn& core, const MotorBurn& boost) {
  const double boost_s = boost.duration_s;
  const double core_kg = core.propellant_mass_kg - core.Propellant(boost_s);
  const double boost_kg = boost.propellant_mass_kg - boost.left_kg;
  const double flown_kg = core_kg + boost_kg;
  const double impulse_n_s = core_kg * core.ExhaustVelocity() + boost_kg * boost.ExhaustVelocity();
  const double whole_kg = vehicle.stages[0].liftoff_mass_kg, left_kg = whole_kg - flown_kg;
  const double alone_kg = left_kg - vehicle.boosters.count * vehicle.boosters.dry_mass_kg - boost.left_kg;
  const double last_kg = core.Propellant(boost_s) - core.left_kg;
  return impulse_n_s / flown_kg * Log(whole_kg / left_kg) +
         core.ExhaustVelocity() * Log(alone_kg / (alone_kg - last_kg));
}

}  // namespace

std::vector<StageFigures> FiguresOf(const Vehicle& vehicle) {
  DISPERSA_ASSERT(!vehicle.stages.empty());
  std::vector<StageFigures> all;
  for (std::size_t i = 0; i < vehicle.stages.size(); ++i) {
    const Stage& stage = vehicle.stages[i];
    const MotorBurn burn = BuildBurn(stage, 1.0, 1.0);
    const Boosters& beside = vehicle.boosters;
    const double beside_kg = i == 0 ? beside.LiftOffMass() : 0.0;
    const double empty_kg = stage.liftoff_mass_kg - stage.propellant_mass_kg - beside_kg;
    const double burnt_kg = stage.propellant_mass_kg - burn.left_kg;
    StageFigures one;
    one.dry_mass_kg = DryMass(vehicle, static_cast<int>(i));
    one.own_mass_kg = one.dry_mass_kg + stage.propellant_mass_kg;
    one.structural_fraction = one.dry_mass_kg / one.own_mass_kg;
    one.burning_time_s = burn.curve ? burn.duration_s : stage.motor.burning_time_s;
    one.flow_kg_s = burnt_kg / one.burning_time_s;
    one.specific_impulse_s = burn.ExhaustVelocity() / kStandardGravity;
    one.ideal_delta_v_m_s =
        burn.ExhaustVelocity() * Log(stage.liftoff_mass_kg / (stage.liftoff_mass_kg - burnt_kg));
    // It has counted what a cut-off by velocity leaves it as burnt.
    if (stage.restarts && EndsAtSpeed(vehicle.stages[i - 1].motor)) one.ideal_delta_v_m_s = 0.0;
    double thrust_n = GreatestOfFirstSecond(burn, i == 0 ? vehicle.hold_down_s : 0.0);
    if (i == 0) {
      double released_kg = empty_kg + burn.Propellant(vehicle.hold_down_s);
      double exit_area_m2 = stage.motor.nozzle_exit_area_m2;
      if (beside.count > 0) {
        const MotorBurn boost = BuildBoosterBurn(beside, 1.0, 1.0);
        one.ideal_delta_v_m_s = BoostedDeltaV(vehicle, burn, boost);
        released_kg += beside.count * beside.dry_mass_kg + boost.Propellant(vehicle.hold_down_s);
        thrust_n += GreatestOfFirstSecond(boost, vehicle.hold_down_s);
        exit_area_m2 += boost.exit_area_m2;
      }
      const double against_air_n = SitePressure(vehicle.site.altitude_m) * exit_area_m2;
      one.thrust_to_weight = (thrust_n - against_air_n) / (released_kg * kStandardGravity);
    } else {
      one.thrust_to_weight = thrust_n / (stage.liftoff_mass_kg * kStandardGravity);
    }
    one.burnout_load_g = GreatestLoad_m_s2(burn, empty_kg) / kStandardGravity;
    if (i == 0 && beside.count > 0) {
      const MotorBurn boost = BuildBoosterBurn(beside, 1.0, 1.0);
      const double at_s = boost.duration_s;
      const double at_kg =
          empty_kg + burn.Propellant(at_s) + beside.count * beside.dry_mass_kg + boost.left_kg;
      const double together_n =
          burn.vacuum_thrust_n * burn.Fraction(at_s) + boost.vacuum_thrust_n * boost.Fraction(at_s);
      one.burnout_load_g = std::max(one.burnout_load_g, together_n / (at_kg * kStandardGravity));
    }
    all.push_back(one);
  }
  return all;
}

}  // namespace dispersa
