// Motors that spin a stage up: a constant roll moment from its ignition on. Their mass does not change, and
// they give no thrust along the axis.
#pragma once

#include "core/input/fields.h"

namespace dispersa {

struct SpinMotors {
  double moment_n_m = 0.0;  ///< about body x; 0: none
  double duration_s = 0.0;  ///< since ignition; they end with the stage's burn at the latest
};

inline void Describe(Fields& fields, SpinMotors& spin) {
  fields.Quantity("moment", kMoment, kAnyNumber, spin.moment_n_m, "about the body axis, constant");
  fields.Quantity("duration", kTime, kPositive, spin.duration_s,
                  "since ignition; at most to the stage's burnout");
}

}  // namespace dispersa
