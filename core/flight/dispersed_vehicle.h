// The vehicle of one flight whose masses differ from the nominal ones.
//
// What changes with a mass, and what is held (definitions of ours, one key for one cause):
//   dry mass of a stage   every element of its structure by the same factor, so its own centre of gravity and
//                         radii of gyration stay; of the last stage the payload too. Boosters and what is
//                         jettisoned stay as they are.
//   propellant load       the grain's outer diameter, length and density stay: more propellant narrows the
//                         bore, up to a grain without one; tanks are filled higher, up to full ones. Thrust,
//                         flow at full thrust and specific impulse stay, so the burn lasts longer by what
//                         there is more. (A heavier charge that burns in the same time is propellant_load and
//                         burn_rate together: correlate the two.)
//   payload mass          added to one element of the last stage's structure, whose place and shape it has.
// Masses above a stage, centre of gravity, inertia, what sections carry and bending follow. Control laws,
// their schedules and guidance keep the nominal values.
#pragma once

#include "core/flight/flight_inputs.h"
#include "core/vehicle/vehicle.h"

namespace dispersa {

/// Whether any mass differs from the nominal one.
bool ChangesMasses(const FlightInputs& inputs);
/// The vehicle with a flight's masses.
Vehicle WithDispersedMasses(const Vehicle& vehicle, const FlightInputs& inputs);
/// The most that a stage's grain holds, as a factor of its propellant: until the bore is gone, or a tank is
/// full.
double LargestPropellantFactor(const Stage& stage);

}  // namespace dispersa
