// Shock-expansion theory for bodies of revolution at small incidence.
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

/// Loads on a body of revolution in supersonic flow, after Syvertson and Dennis (NACA TR 1328).
///
/// The body becomes a chain of conical elements. Behind each corner the pressure follows from a Prandtl-Meyer
/// turn, and its derivative over incidence from the strength of that wave. Both then relax exponentially to
/// those of the tangent cone. So lift is carried over onto cylinders. Tangent cones: pressure by the
/// similarity rule of Linnell and Bailey (1956), shock angle by Rasmussen (1967), normal force 2 cos^2 e on
/// the base area (Newtonian; slender-body at e = 0).
///
/// The rate of relaxation is 0.65 / (r sqrt(M^2 - 1)). The report's own rate is a quotient of two differences
/// with poles on curved noses. In the same unit it is 0.5 for slender corners, and 0.54 to 0.82 at the
/// shoulder of a 10-degree cone or an ogive of fineness 3 from Mach 1.5 to 8.
///
/// Ahead of the point where the surface flow is supersonic (blunt noses) the tangent cone's values hold.
/// Behind it the surface Mach number is at least 1.1, also where a compression corner is too steep for an
/// attached shock. Range: Mach 1.5 to 8. It overestimates the carry-over below Mach 3 (see the build-up).
/// Precondition: mach >= kShockExpansionMach.
ShockExpansionResult ShockExpansion(const std::vector<MouldSection>& body, double mach);

/// Pressure coefficient on a cone without incidence (Linnell and Bailey); 0 for angles below 0.
double ConePressureCoefficient(double mach, double half_angle_rad);

}  // namespace dispersa
