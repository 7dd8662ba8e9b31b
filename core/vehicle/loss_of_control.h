// When the flight of a controlled vehicle counts as lost.
#pragma once

#include "core/input/fields.h"
#include "core/math/constants.h"

namespace dispersa {

struct LossOfControl {
  double attitude_error_rad = 15.0 * kRadPerDeg;
  double for_s = 0.5;  ///< so long without a break
  double rate_rad_s = 60.0 * kRadPerDeg;

  bool operator==(const LossOfControl&) const = default;
};

inline void Describe(Fields& fields, LossOfControl& loss) {
  const LossOfControl usual;
  fields.Quantity("attitude_error", kAngle, {0.0, kHalfTurn, true, false}, loss.attitude_error_rad,
                  "larger ends the flight", usual.attitude_error_rad);
  fields.Quantity("for", kTime, kNonNegative, loss.for_s, "so long without a break", usual.for_s);
  fields.Quantity("rate", kAngularRate, kPositive, loss.rate_rad_s, "larger ends the flight at once",
                  usual.rate_rad_s);
}

}  // namespace dispersa
