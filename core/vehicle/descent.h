// How the last stage comes down: as a point mass that tumbles, under a parachute if it has one.
#pragma once

#include "core/input/fields.h"

namespace dispersa {

struct Descent {
  double drag_area_m2 = 0.0;  ///< drag coefficient times area (0: of a tumbling cylinder, dynamics/fall.h)
  double parachute_area_m2 = 0.0;  ///< 0: none
  double parachute_drag_coefficient = 0.0;
  double parachute_altitude_m = 0.0;  ///< geodetic, at which it opens
  double ground_altitude_m = 0.0;     ///< geodetic, of the impact area
};

inline void Describe(Fields& fields, Descent& descent) {
  fields.Quantity("drag_area", kArea, kPositive, descent.drag_area_m2,
                  "drag coefficient times area; default: of a tumbling cylinder", 0.0);
  bool has_parachute = descent.parachute_area_m2 > 0.0;
  fields.OptionalMap("parachute", has_parachute, "opens in descent", [&](Fields& parachute) {
    parachute.Quantity("area", kArea, kPositive, descent.parachute_area_m2, "of the open canopy");
    parachute.Number("drag_coefficient", kPositive, descent.parachute_drag_coefficient, "on that area");
    parachute.Quantity("deployment_altitude", kLength, kNonNegative, descent.parachute_altitude_m,
                       "geodetic");
  });
  fields.Quantity("ground_altitude", kLength, Between(-500.0, 9000.0), descent.ground_altitude_m,
                  "geodetic, of the impact area", 0.0);
}

}  // namespace dispersa
