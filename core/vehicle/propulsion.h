// A motor's thrust, flow and remaining propellant in closed form over the time since ignition.
#pragma once

#include "core/vehicle/vehicle.h"

namespace dispersa {

/// A motor as one flight burns it: nominal data times the flight's factors.
struct MotorBurn {
  double vacuum_thrust_n = 0.0;    ///< at full thrust
  double full_flow_kg_s = 0.0;     ///< at full thrust
  double propellant_mass_kg = 0.0;
  double rise_s = 0.0;
  double tail_s = 0.0;
  double exit_area_m2 = 0.0;
  double duration_s = 0.0;         ///< ignition to burnout

  /// Fraction of full thrust and flow, 0 outside [0, duration_s].
  double Fraction(double since_ignition_s) const;
  /// Propellant left, from propellant_mass_kg to 0.
  double Propellant(double since_ignition_s) const;
};

/// The burn with thrust and flow multiplied; ramps keep their durations, propellant is conserved.
MotorBurn BuildBurn(const Stage& stage, double thrust_factor, double flow_factor);

}  // namespace dispersa
