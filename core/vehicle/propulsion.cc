#include "core/vehicle/propulsion.h"

#include "core/math/functions.h"

namespace dispersa {

double MotorBurn::Fraction(double since_ignition_s) const {
  if (since_ignition_s < 0.0 || since_ignition_s > duration_s) return 0.0;
  if (since_ignition_s < rise_s) return since_ignition_s / rise_s;
  const double left = duration_s - since_ignition_s;
  return left < tail_s ? left / tail_s : 1.0;
}

double MotorBurn::Propellant(double since_ignition_s) const {
  if (since_ignition_s <= 0.0) return propellant_mass_kg;
  if (since_ignition_s >= duration_s) return 0.0;
  if (since_ignition_s < rise_s)
    return propellant_mass_kg - 0.5 * full_flow_kg_s * Square(since_ignition_s) / rise_s;
  const double left = duration_s - since_ignition_s;
  if (left < tail_s) return 0.5 * full_flow_kg_s * Square(left) / tail_s;
  return full_flow_kg_s * (left - 0.5 * tail_s);
}

MotorBurn BuildBurn(const Stage& stage, double thrust_factor, double flow_factor) {
  const Motor& motor = stage.motor;
  MotorBurn burn;
  burn.vacuum_thrust_n = motor.thrust_n * thrust_factor;
  burn.full_flow_kg_s = stage.propellant_mass_kg / motor.burning_time_s * flow_factor;
  burn.propellant_mass_kg = stage.propellant_mass_kg;
  burn.rise_s = motor.ignition_rise_s;
  burn.tail_s = motor.tail_off_s;
  burn.exit_area_m2 = motor.nozzle_exit_area_m2;
  // The area under the trapezoid is the propellant: two half ramps lengthen the burn.
  burn.duration_s = stage.propellant_mass_kg / burn.full_flow_kg_s + 0.5 * (burn.rise_s + burn.tail_s);
  return burn;
}

}  // namespace dispersa
