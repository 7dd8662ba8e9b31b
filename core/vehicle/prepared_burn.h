// A motor's burn, prepared once for many evaluations.
#pragma once

#include "core/vehicle/burning_stack.h"

namespace dispersa {

class PreparedBurn {
 public:
  /// Refers to the motor's curve.
  explicit PreparedBurn(const MotorBurn& motor) { lanes::SetBurn(burn_, 0, motor); }

  /// At a time within the burn: MotorBurn's Fraction() and Propellant().
  lanes::BurnState<double> At(double since_ignition_s) const {
    return lanes::BurnAt(burn_, since_ignition_s);
  }

 private:
  lanes::BurningMotor<double> burn_;
};

}  // namespace dispersa
