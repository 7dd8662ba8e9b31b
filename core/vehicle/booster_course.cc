#include "core/vehicle/booster_course.h"

#include "core/math/assertion.h"

namespace dispersa {

BoosterCourse::BoosterCourse(const Vehicle& vehicle)
    : stage_(BuildBurn(vehicle.stages[0], 1.0, 1.0)),
      boosters_(BuildBoosterBurn(vehicle.boosters, 1.0, 1.0)),
      delay_s_(vehicle.boosters.separation_delay_s) {
  DISPERSA_ASSERT(vehicle.boosters.count > 0);
}

double BoosterCourse::PropellantOfAll(double stage_kg) const {
  // The stage's propellant only falls: bisection to the last digit of the time.
  double from_s = 0.0, to_s = boosters_.duration_s;
  if (stage_kg >= stage_.Propellant(from_s)) return boosters_.Propellant(from_s);
  if (stage_kg <= stage_.Propellant(to_s)) return boosters_.Propellant(to_s);
  for (int halving = 0; halving < 50; ++halving) {
    const double middle_s = 0.5 * (from_s + to_s);
    (stage_.Propellant(middle_s) > stage_kg ? from_s : to_s) = middle_s;
  }
  return boosters_.Propellant(0.5 * (from_s + to_s));
}

}  // namespace dispersa
