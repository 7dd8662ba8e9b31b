// The propellant of boosters over that of the stage that they stand beside.
#pragma once

#include "core/vehicle/propulsion.h"

namespace dispersa {

/// Both burn at once, so one mass of propellant gives the other. The relation is that of the nominal burns. A
/// flight whose stage and boosters burn faster by one factor keeps it.
class BoosterCourse {
 public:
  /// Precondition: the vehicle has boosters. They burn out before their stage.
  explicit BoosterCourse(const Vehicle& vehicle);

  /// What all boosters together have, where the stage has `stage_kg` left.
  double PropellantOfAll(double stage_kg) const;
  /// Of the stage, where the boosters burn out and where they leave.
  double StageAtBurnout() const { return stage_.Propellant(boosters_.duration_s); }
  double StageAtSeparation() const { return stage_.Propellant(boosters_.duration_s + delay_s_); }

 private:
  MotorBurn stage_, boosters_;
  double delay_s_;
};

}  // namespace dispersa
