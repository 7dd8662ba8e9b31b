// The two halves of a history row: motion of any body, and what only a launcher has.
#pragma once

#include <string>
#include <vector>

#include "core/control/autopilot_config.h"
#include "core/dynamics/air_data.h"
#include "core/dynamics/rigid_body.h"
#include "core/flight/flight_model.h"
#include "core/flight/tick_sample.h"

namespace dispersa {

const std::vector<std::string>& KinematicColumnNames();
struct LauncherColumn {
  const char* name;
  bool LawInfo::*of_law =
      nullptr;  ///< property that an axis' law needs for its flights to have the column (null: none)
};
const std::vector<LauncherColumn>& LauncherColumns();

/// Appends one value a name of KinematicColumnNames(). `v_AB_B` is the velocity through the air.
void AppendKinematics(const Earth& earth, double time_s, const RigidBodyState& state, const AirData& air,
                      const Vector3& v_AB_B, double mass_kg, std::vector<double>& row);
/// Appends one value a column of LauncherColumns().
void AppendLauncher(const FlightModel& model, const TickSample& sample, std::vector<double>& row);

}  // namespace dispersa
