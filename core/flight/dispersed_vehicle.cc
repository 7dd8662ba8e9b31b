#include "core/flight/dispersed_vehicle.h"

#include <algorithm>
#include <cmath>

#include "core/math/functions.h"
#include "core/vehicle/mass.h"

namespace dispersa {
namespace {

// Adds `added_kg` to one element of a stage's structure. The other elements keep their masses.
void AddToElement(std::size_t element, double added_kg, double& dry_kg, Stage& stage) {
  for (std::size_t i = 0; i < stage.structure.size(); ++i) {
    const double own_kg = dry_kg * stage.structure[i].fraction + (i == element ? added_kg : 0.0);
    stage.structure[i].fraction = own_kg / (dry_kg + added_kg);
  }
  dry_kg += added_kg;
}

}  // namespace

bool ChangesMasses(const FlightInputs& in) {
  for (std::size_t i = 0; i < kMaxStages; ++i)
    if (in.dry_mass_factor[i] != 1.0 || in.propellant_factor[i] != 1.0) return true;
  return in.payload_mass_kg != 0.0;
}

Vehicle WithDispersedMasses(const Vehicle& vehicle, const FlightInputs& in) {
  Vehicle dispersed = vehicle;
  if (!ChangesMasses(in)) return dispersed;
  double above_kg = 0.0;
  for (std::size_t i = vehicle.stages.size(); i-- > 0;) {
    Stage& stage = dispersed.stages[i];
    std::size_t first = i;  // burn of the stage, whose factors are the stage's
    while (vehicle.stages[first].restarts) --first;
    const double nominal_dry_kg = DryMass(vehicle, static_cast<int>(i));
    double dry_kg = nominal_dry_kg * in.dry_mass_factor[first];
    const int element = static_cast<int>(in.payload_element + 0.5) - 1;
    const bool is_last =
        LastBurn(vehicle, static_cast<int>(i)) + 1 == static_cast<int>(vehicle.stages.size());
    if (is_last && element >= 0 && element < static_cast<int>(stage.structure.size()))
      AddToElement(static_cast<std::size_t>(element), in.payload_mass_kg, dry_kg, stage);
    if (stage.flown_mass.rows) {
      stage.flown_mass.dry_factor = in.dry_mass_factor[first];
      stage.flown_mass.added_kg = dry_kg - nominal_dry_kg * in.dry_mass_factor[first];
      stage.flown_mass.element = static_cast<std::size_t>(std::max(element, 0));
    }
    stage.propellant_mass_kg *= in.propellant_factor[first];
    stage.motor.burning_time_s *= in.propellant_factor[first];
    for (Tank& tank : stage.tanks) tank.propellant_mass_kg *= in.propellant_factor[first];
    ThrustCurve& curve = stage.motor.thrust_curve;
    for (double& time_s : curve.time_s) time_s *= in.propellant_factor[first];
    // The density that its volume implies is to stay.
    Grain& grain = stage.grain;
    const double web2 = Square(grain.outer_diameter_m) - Square(grain.inner_diameter_m);
    const double bore2 = Square(grain.outer_diameter_m) - in.propellant_factor[first] * web2;
    grain.inner_diameter_m = bore2 > 0.0 ? Sqrt(bore2) : 0.0;
    double own_kg = dry_kg + stage.propellant_mass_kg;
    const Stage& at_last = vehicle.stages[static_cast<std::size_t>(LastBurn(vehicle, static_cast<int>(i)))];
    for (const Jettison& jettison : at_last.jettisoned) own_kg += jettison.mass_kg;
    const Boosters& boosters = vehicle.boosters;
    if (i == 0) own_kg += boosters.LiftOffMass();
    stage.liftoff_mass_kg = above_kg + own_kg;
    if (!stage.restarts) above_kg = stage.liftoff_mass_kg;
  }
  return dispersed;
}

double LargestPropellantFactor(const Stage& stage) {
  if (stage.is_liquid()) {
    double most = HUGE_VAL;
    for (const Tank& tank : stage.tanks)
      most = std::min(most, tank.Volume() * tank.density_kg_m3 / tank.propellant_mass_kg);
    return std::max(1.0, std::floor(1e6 * most) * 1e-6);
  }
  const double outer2 = Square(stage.grain.outer_diameter_m);
  // A number that a message can show.
  return std::round(1e6 * outer2 / (outer2 - Square(stage.grain.inner_diameter_m))) * 1e-6;
}

}  // namespace dispersa
