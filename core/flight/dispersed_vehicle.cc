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

// Of a stage, or of boosters, which have the same members.
template <class Tanked>
void Load(double factor, Tanked& loaded) {
  loaded.propellant_mass_kg *= factor;
  loaded.motor.burning_time_s *= factor;
  for (Tank& tank : loaded.tanks) tank.propellant_mass_kg *= factor;
  for (double& time_s : loaded.motor.thrust_curve.time_s) time_s *= factor;
  // The density that its volume implies is to stay.
  Grain& grain = loaded.grain;
  const double web2 = Square(grain.outer_diameter_m) - Square(grain.inner_diameter_m);
  const double bore2 = Square(grain.outer_diameter_m) - factor * web2;
  grain.inner_diameter_m = bore2 > 0.0 ? Sqrt(bore2) : 0.0;
}

// `at_first`: its first burn, with its nominal load. A restart has what that one has left in its tanks.
void Mix(Stage at_first, double load, double factor, Stage& stage) {
  if (factor == 1.0 || stage.tanks.size() < 2) return;
  Load(load, at_first);
  stage.mixture_ratio_factor = factor;
  stage.motor.residual_mass_kg =
      BuildMixture(at_first.tanks, at_first.propellant_mass_kg, stage.motor.residual_mass_kg, factor)
          .residual_kg;
}

// Place of a booster among the further nozzles.
std::size_t PlaceOf(const Vehicle& vehicle, std::size_t booster) {
  return static_cast<std::size_t>(FurtherNozzlesBefore(vehicle, vehicle.stages.size())) + booster;
}

void LoadMean(const FlightInputs& in, Vehicle& vehicle) {
  Boosters& boosters = vehicle.boosters;
  if (boosters.count == 0) return;
  double dry = 0.0, propellant = 0.0;
  for (std::size_t k = 0; k < boosters.angles_rad.size(); ++k) {
    dry += in.further[PlaceOf(vehicle, k)].booster.dry_mass_factor - 1.0;
    propellant += in.further[PlaceOf(vehicle, k)].booster.propellant_factor - 1.0;
  }
  boosters.dry_mass_kg *= 1.0 + dry / boosters.count;
  if (propellant != 0.0) Load(1.0 + propellant / boosters.count, boosters);
}

}  // namespace

bool ChangesMasses(const FlightInputs& in) {
  for (std::size_t i = 0; i < kMaxStages; ++i)
    if (in.stages[i].dry_mass_factor != 1.0 || in.stages[i].propellant_factor != 1.0 ||
        in.stages[i].mixture_ratio_factor != 1.0)
      return true;
  for (std::size_t i = 0; i < kFurtherNozzles; ++i)
    if (in.further[i].booster.dry_mass_factor != 1.0 || in.further[i].booster.propellant_factor != 1.0)
      return true;
  return in.payload_mass_kg != 0.0;
}

Vehicle WithDispersedMasses(const Vehicle& vehicle, const FlightInputs& in) {
  Vehicle dispersed = vehicle;
  if (!ChangesMasses(in)) return dispersed;
  LoadMean(in, dispersed);
  double above_kg = 0.0;
  for (std::size_t i = vehicle.stages.size(); i-- > 0;) {
    Stage& stage = dispersed.stages[i];
    std::size_t first = i;  // burn of the stage, whose factors are the stage's
    while (vehicle.stages[first].restarts) --first;
    const double nominal_dry_kg = DryMass(vehicle, static_cast<int>(i));
    double dry_kg = nominal_dry_kg * in.stages[first].dry_mass_factor;
    const int element = static_cast<int>(in.payload_element + 0.5) - 1;
    const bool is_last =
        LastBurn(vehicle, static_cast<int>(i)) + 1 == static_cast<int>(vehicle.stages.size());
    if (is_last && element >= 0 && element < static_cast<int>(stage.structure.size()))
      AddToElement(static_cast<std::size_t>(element), in.payload_mass_kg, dry_kg, stage);
    if (stage.flown_mass.rows) {
      stage.flown_mass.dry_factor = in.stages[first].dry_mass_factor;
      stage.flown_mass.added_kg = dry_kg - nominal_dry_kg * in.stages[first].dry_mass_factor;
      stage.flown_mass.element = static_cast<std::size_t>(std::max(element, 0));
    }
    Load(in.stages[first].propellant_factor, stage);
    Mix(vehicle.stages[first], in.stages[first].propellant_factor, in.stages[first].mixture_ratio_factor,
        stage);
    double own_kg = dry_kg + stage.propellant_mass_kg;
    const Stage& at_last = vehicle.stages[static_cast<std::size_t>(LastBurn(vehicle, static_cast<int>(i)))];
    for (const Jettison& jettison : at_last.jettisoned) own_kg += jettison.mass_kg;
    if (i == 0) own_kg += dispersed.boosters.LiftOffMass();
    stage.liftoff_mass_kg = above_kg + own_kg;
    if (!stage.restarts) above_kg = stage.liftoff_mass_kg;
  }
  return dispersed;
}

DispersedBooster BoosterOf(const Vehicle& nominal, const FlightInputs& in, std::size_t booster) {
  const std::size_t k = PlaceOf(nominal, booster);
  DispersedBooster dispersed{nominal.boosters, {}};
  Boosters& one = dispersed.one;
  one.dry_mass_kg *= in.further[k].booster.dry_mass_factor;
  if (in.further[k].booster.propellant_factor != 1.0) Load(in.further[k].booster.propellant_factor, one);
  if (!one.is_liquid()) return dispersed;
  dispersed.mixture = BuildMixture(one.tanks, one.propellant_mass_kg, one.motor.residual_mass_kg,
                                   in.further[k].booster.mixture_ratio_factor);
  one.motor.residual_mass_kg = dispersed.mixture.residual_kg;
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
