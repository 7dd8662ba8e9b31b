// Fins: what a set of equal flat fins adds to a stack's coefficients, and the spin that their cant asks for.
//
// Sources:
//  - J. S. Barrowman, "The Practical Calculation of the Aerodynamic Characteristics of Slender Finned
//    Vehicles", M. S. thesis, The Catholic University of America, 1967: lift of one fin below Mach 1 by F. W.
//    Diederich's formula, the mean aerodynamic chord, and strip theory for cant and damping in roll.
//  - W. C. Pitts, J. N. Nielsen, G. E. Kaattari, NACA Report 1307, 1957: fin and body together, slender
//  theory.
//  - E. A. Bonney, "Aerodynamic characteristics of rectangular wings at supersonic speeds", 1947; J.
//  Ackeret's
//    linear theory: lift and wave drag of thin fins above Mach 1.
//
// One fin of area A and aspect ratio R = 2 s²/A (both of a pair) has the lift area, force over q and
// incidence,
//   below Mach 0.9        2 pi R A / (2 + sqrt(4 + (b R / cos G)²)), b² = 1 - M², G the sweep at half chord
//   above, with b R >= 1  4 A / b (1 - 1 / (2 b R)), b² = M² - 1,
// straight between them. It acts at the mean aerodynamic chord's quarter up to Mach 0.9 and at its half from
// Mach 2 on, straight between. A set of n = 3 or 4 fins has n/2 of it whatever its roll angle, times
// (1 + r / (r + s))² with the body.
//
// Valid for thin fins below some 15 deg of incidence. Beyond, and for other shapes, give tables. Left out:
// interference between the sets and with the wake of bodies ahead, bending of the fins.
#pragma once

#include <vector>

#include "core/input/fields.h"

namespace dispersa {

struct FinSet {
  int count = 4;
  double leading_edge_station_m = 0.0;  ///< of the root chord
  double root_chord_m = 0.0;
  double tip_chord_m = 0.0;
  double span_m = 0.0;   ///< of one fin, from the body's surface
  double sweep_m = 0.0;  ///< by which the tip's leading edge is aft of the root's
  double thickness_m = 0.0;
  double cant_rad = 0.0;  ///< positive: turns the body about +x
};

inline void Describe(Fields& fields, FinSet& fins) {
  fields.Integer("count", 3, 4, fins.count, "equal fins at equal angles");
  fields.Quantity("leading_edge_station", kLength, kNonNegative, fins.leading_edge_station_m,
                  "of the root's leading edge");
  fields.Quantity("root_chord", kLength, kPositive, fins.root_chord_m, "at the body");
  fields.Quantity("tip_chord", kLength, kNonNegative, fins.tip_chord_m, "at the tip");
  fields.Quantity("span", kLength, kPositive, fins.span_m, "of one fin, from the body's surface");
  fields.Quantity("sweep", kLength, kAnyNumber, fins.sweep_m,
                  "by which the tip's leading edge is aft of the root's", 0.0);
  fields.Quantity("thickness", kLength, kNonNegative, fins.thickness_m, "greatest, for drag", 0.0);
  fields.Quantity("cant", kAngle, Between(-kPi / 15.0, kPi / 15.0), fins.cant_rad,
                  "of all fins; positive turns the body clockwise, seen from behind", 0.0);
}

/// Of one fin without a body, m²: normal force over dynamic pressure and incidence (rad).
double FinLiftArea(const FinSet& fins, double mach);
double FinArea(const FinSet& fins);
/// Of the set on a body of radius r, with what it carries over to the body.
struct FinForce {
  double area_m2 = 0.0;    ///< normal force over dynamic pressure and incidence
  double station_m = 0.0;  ///< where it acts
};
FinForce ForceOfFins(const FinSet& fins, double radius_m, double mach);
/// Of the set, over dynamic pressure and the helix angle p / V at 1 m off the axis: m⁴.
double FinRollDamping(const FinSet& fins, double radius_m, double mach);
/// Of the set, over dynamic pressure, m²: wave drag of double wedges.
double FinWaveDragArea(const FinSet& fins, double mach);

/// Sums over the fins of one set that decide its spin: of chord times distance from the axis, and times its
/// square.
struct FinStrips {
  double first_m3 = 0.0, second_m4 = 0.0;
};
FinStrips StripsOf(const FinSet& fins, double radius_m);

}  // namespace dispersa
