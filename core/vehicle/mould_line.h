// The outer mould line of a stack as a body of revolution, and its integrals.
#pragma once

#include <vector>

#include "core/vehicle/vehicle.h"

namespace dispersa {

/// One section of a body of revolution between two stations aft of the nose tip.
struct MouldSection {
  double start_m = 0.0;
  double end_m = 0.0;
  double fore_radius_m = 0.0;
  double aft_radius_m = 0.0;
  double arc_radius_m = 0.0;  ///< of a tangent ogive's arc, 0 for a straight line
  double arc_centre_m = 0.0;  ///< station where the arc is parallel to the axis

  double Radius(double station_m) const;
  double Slope(double station_m) const;  ///< dr/dx
  bool IsCurved() const { return arc_radius_m > 0.0; }
};

/// Contradictions in a profile: non-positive lengths or diameters, a first section without a tip, a tangent
/// ogive that does not widen, or a cylinder with another diameter than the section before. Paths are
/// `profile[i].…`.
std::vector<StructProblem> ProfileProblems(const std::vector<ProfileSection>& profile);

/// The profile's sections from the nose tip to `end_station_m`, the last one cut there. A curved section
/// is an arc that ends parallel to the axis.
/// Precondition: no ProfileProblems.
std::vector<MouldSection> CutMouldLine(const std::vector<ProfileSection>& profile, double end_station_m);

/// Integrals over a body of length l and cross-section A(x) = pi r(x)^2, by Simpson's rule.
struct BodyIntegrals {
  double length_m = 0.0;
  double base_radius_m = 0.0;
  double largest_radius_m = 0.0;
  double volume_m3 = 0.0;
  double volume_moment_m4 = 0.0;    ///< of A x
  double wetted_area_m2 = 0.0;      ///< without the base
  double planform_area_m2 = 0.0;    ///< of 2 r
  double planform_moment_m3 = 0.0;  ///< of 2 r x
  double roll_moment_m4 = 0.0;      ///< of 2 pi r^3
};

BodyIntegrals Integrate(const std::vector<MouldSection>& body);

}  // namespace dispersa
