// Columns of the attitude program in a reference file.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/flight/attitude_program.h"
#include "core/math/constants.h"

namespace dispersa {

struct AttitudeColumn {
  const char* name;
  double AttitudeKnot::*field;
  double scale;  ///< value inside = value in the file * scale
};

inline constexpr std::array<AttitudeColumn, 7> kAttitudeColumns = {{
    {"time_s", &AttitudeKnot::time_s, 1.0},
    {"pitch_deg", &AttitudeKnot::pitch, kRadPerDeg},
    {"yaw_deg", &AttitudeKnot::yaw, kRadPerDeg},
    {"roll_deg", &AttitudeKnot::roll, kRadPerDeg},
    {"pitch_rate_deg_s", &AttitudeKnot::pitch_rate, kRadPerDeg},
    {"yaw_rate_deg_s", &AttitudeKnot::yaw_rate, kRadPerDeg},
    {"roll_rate_deg_s", &AttitudeKnot::roll_rate, kRadPerDeg},
}};

inline std::vector<std::string> AttitudeColumnNames() {
  std::vector<std::string> names;
  for (const AttitudeColumn& column : kAttitudeColumns) names.emplace_back(column.name);
  return names;
}

}  // namespace dispersa
