// The vehicle of one flight with dispersed masses.
//
// Definitions of this program, one key for one cause:
//   dry mass of a stage   Every element of the stage's structure gets the same factor. Its centre of gravity
//                         and radii of gyration stay. The payload belongs to the last stage. Jettisoned
//                         bodies stay as they are.
//   propellant load       The grain's outer diameter, length and density stay. More propellant narrows the
//                         bore, down to a grain without a bore. Tanks are filled higher, up to full tanks.
//                         Thrust, flow at full thrust and specific impulse stay, so the burn lasts longer in
//                         proportion. A heavier charge that burns in the same time is propellant_load and
//                         burn_rate together: correlate the two.
//   mixture ratio         Of the first tank's flow to the others' (core/vehicle/mass.h). The burn
//                         ends with the first tank that has only its part of the residual left. The residual
//                         grows.
//   payload mass          The difference is added to one element of the last stage's structure, at its place
//                         and with its shape.
//   boosters              Shell, propellant and mixture of each that is a body of its own, as those of
//                         a stage.
// Masses above a stage, centre of gravity, inertia, section loads and bending follow. A beam carries all
// boosters as their mean, and liquids in the mixture of their loads. So does a table of a stage's masses.
// Control laws, their schedules and guidance keep the nominal values.
#pragma once

#include "core/flight/flight_inputs.h"
#include "core/vehicle/mass.h"
#include "core/vehicle/vehicle.h"

namespace dispersa {

/// Whether any mass differs from the nominal one.
bool ChangesMasses(const FlightInputs& inputs);
/// The vehicle with a flight's masses. Its boosters are the mean of them all.
Vehicle WithDispersedMasses(const Vehicle& vehicle, const FlightInputs& inputs);
/// One booster of a flight, of the nominal vehicle's that are bodies of their own.
struct DispersedBooster {
  Boosters one;  ///< its shell, propellant, motor, grain and tanks
  MixtureOf mixture;
};
DispersedBooster BoosterOf(const Vehicle& nominal, const FlightInputs& inputs, std::size_t booster);
/// The most that a stage's grain holds, as a factor of its propellant: until the bore is gone, or a tank is
/// full.
double LargestPropellantFactor(const Stage& stage);

}  // namespace dispersa
