// The launcher rail along which a vehicle moves until it leaves.
//
// The rail is fixed to the Earth, and holds the attitude until the vehicle has travelled its length. Then it
// lets go at once: the turn that the rear lug causes while the front one is free (tip-off) is neglected. The
// rail carries the forces across it; they slow the vehicle down by friction with the stated coefficient.
// Until thrust exceeds weight and friction, the vehicle stands at the rail's end.
#pragma once

#include "core/input/fields.h"

namespace dispersa {

struct Rail {
  double length_m = 0.0;  ///< of travel until the last lug leaves; 0: no rail
  double friction = 0.0;  ///< coefficient
  /// Of vehicles that nothing controls; others begin as their reference does.
  double azimuth_rad = 0.0;  ///< clockwise from north
  double elevation_rad = 0.0;
};

inline void Describe(Fields& fields, Rail& rail) {
  fields.Quantity("length", kLength, kNonNegative, rail.length_m,
                  "travel until the last lug leaves; 0: only the direction is given");
  fields.Number("friction", Between(0.0, 1.0), rail.friction, "coefficient of the sliding lugs", 0.0);
  fields.Quantity("azimuth", kAngle, Between(0.0, kTwoPi), rail.azimuth_rad,
                  "clockwise from north, of a vehicle without control; others begin as their reference", 0.0);
  fields.Quantity("elevation", kAngle, Between(0.0, kQuarterTurn), rail.elevation_rad,
                  "above the horizon, of a vehicle without control", kQuarterTurn);
}

}  // namespace dispersa
