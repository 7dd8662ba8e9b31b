// Aerodynamic coefficients of a stack, as tables give them.
#pragma once

#include <vector>

namespace dispersa {

class Fields;

/// Aerodynamic coefficients of one stack (the stages still attached) over Mach number and total incidence, in
/// body axes: F = -q S (CA x + CN n), n the direction of the cross-flow. Outside the grid the end value
/// holds.
struct AeroTable {
  double reference_area_m2 = 0.0;
  double reference_length_m = 0.0;  ///< the diameter
  std::vector<double> mach;
  std::vector<double> incidence_rad;  ///< >= 0
  std::vector<double> ca;             ///< shape (mach, incidence), row by row, power on
  std::vector<double> cn;
  std::vector<double> xcp_station_m;  ///< where the normal force acts
  std::vector<double> cmq_per_rad;    ///< shape (mach): pitch and yaw damping, on q d / (2 V), about the CG
  std::vector<double> clp_per_rad;    ///< shape (mach): roll damping on p d / (2 V)
};

void Describe(Fields& fields, AeroTable& table);

}  // namespace dispersa
