// Where a flight ends, and whether anything controls it.
#pragma once

#include "core/input/fields.h"

namespace dispersa {

enum class FlightEnd {
  kInjection,  ///< the end of the last burn
  kApogee,     ///< the first one after the last burn; of a body that only descends, the end of that burn
  kImpact,     ///< on the ground
};

/// The steps of a flight that no autopilot divides into ticks, unless its campaign says otherwise.
inline constexpr double kFreeStep_s = 0.005;

/// Simulated time that no flight needs: a day.
inline constexpr double kTimeLimit_s = 86400.0;

struct FlightCourse {
  FlightEnd ends = FlightEnd::kInjection;
  bool is_controlled = true;    ///< by an autopilot, along a reference
  double step_s = kFreeStep_s;  ///< of a flight that is not
};

inline void Describe(Fields& fields, FlightCourse& course) {
  fields.Choice<FlightEnd>(
      "ends",
      {{"injection", FlightEnd::kInjection}, {"apogee", FlightEnd::kApogee}, {"impact", FlightEnd::kImpact}},
      course.ends, "where a flight is completed", FlightEnd::kInjection);
  fields.Choice<bool>("control", {{"autopilot", true}, {"none", false}}, course.is_controlled,
                      "none: no stage has a gimbal, so there is no autopilot and no reference", true);
  fields.When(Is("control", {"none"}), [&] {
    fields.Quantity("step", kTime, Between(1e-4, 0.1), course.step_s,
                    "of the integration; in place of the autopilot's ticks", kFreeStep_s);
  });
}

}  // namespace dispersa
