// Normal force of a body of revolution: potential part at small incidence, and cross-flow.
#pragma once

#include <vector>

#include "core/vehicle/mould_line.h"

namespace dispersa {

/// Slope of the normal force over incidence, as an area and its moment about the nose tip: N = q `area_m2`
/// alpha, at moment / area.
struct NormalForceSlope {
  double area_m2 = 0.0;
  double moment_m3 = 0.0;
};

/// Slender-body theory (Munk, NACA TR 184; Barrowman): 2 dA/dx, in all 2 A_base, at every Mach number.
NormalForceSlope SlenderBody(const BodyIntegrals& body);

/// Drag coefficient of an infinite circular cylinder across the stream, on its planform area, over the Mach
/// number of the cross-flow. Read from the curve of Jorgensen (NASA TR R-474, figure 1, after NACA TN 2960
/// and others) to about 5 %, for laminar separation. The end values hold outside 0 to 8.
double CrossFlowDrag(double cross_flow_mach);

/// Ratio of a finite cylinder's cross-flow drag to an infinite one's, over fineness (length over mean
/// diameter), at subsonic speed (Jorgensen, NASA TR R-474, figure 2). It rises to 1 between Mach 0.8 and 1.2.
/// The end values hold outside fineness 2 to 40.
double CrossFlowEndFactor(double fineness, double mach);

}  // namespace dispersa
