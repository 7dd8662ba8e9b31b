// Second-order shock-expansion theory for bodies of revolution at small incidence.
#pragma once

#include <vector>

#include "core/vehicle/mould_line.h"
#include "core/vehicle/normal_force.h"

namespace dispersa {

/// The smallest Mach number at which ShockExpansion is used.
inline constexpr double kShockExpansionMach = 1.5;

struct ShockExpansionResult {
  NormalForceSlope normal_force;
  double pressure_drag_area_m2 = 0.0;  ///< of the body without its base: D = q times this
};

/// Loads on a body of revolution in supersonic flow (Syvertson and Dennis, NACA TR 1328).
///
/// The body becomes a chain of conical elements. Behind each corner the pressure follows from a
/// Prandtl-Meyer turn and relaxes exponentially to that of the tangent cone; so does its derivative over
/// incidence, which carries lift over onto cylinders. Tangent cones: pressure by the similarity rule of
/// Linnell and Bailey (1956), shock angle by Rasmussen (1967), normal force 2 cos^2 e on the base area
/// (Newtonian; slender-body at e = 0). Where a tangent cone has no supersonic surface flow (blunt noses)
/// or a compression corner no attached shock, the tangent cone's values hold on the element.
/// Range: Mach 1.5 to about 10 at attached flow; above, entropy layers make it an estimate.
/// Precondition: mach >= kShockExpansionMach.
ShockExpansionResult ShockExpansion(const std::vector<MouldSection>& body, double mach);

/// Pressure coefficient on a cone without incidence (Linnell and Bailey); 0 for angles below 0.
double ConePressureCoefficient(double mach, double half_angle_rad);

}  // namespace dispersa
