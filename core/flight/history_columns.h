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

/// Parts of a row that take time to compute. A row without a part has no meaningful value in its columns.
enum RowPart : unsigned {
  kPlace = 1u << 0,           ///< geodetic place
  kNorthEastDown = 1u << 1,   ///< velocity and attitude against local axes
  kFlow = 1u << 2,            ///< angles of the air's velocity
  kOrbit = 1u << 4,           ///< inertial speed and path angle
  kProgram = 1u << 5,         ///< the reference's attitude
  kLaunchAttitude = 1u << 6,  ///< attitude against the launch axes
  kLearnt = 1u << 7,          ///< what the pitch law's rules say
};
inline constexpr unsigned kWholeRow = ~0u;

/// Columns of any body, and behind them those of a launcher.
inline constexpr int kBodyColumns = 24, kLauncherColumns = 37;

const std::vector<std::string>& KinematicColumnNames();
struct LauncherColumn {
  const char* name;
  bool LawInfo::*of_law =
      nullptr;  ///< property that an axis' law needs for its flights to have the column (null: none)
};
const std::vector<LauncherColumn>& LauncherColumns();

/// Bits of RowPart that the value of a column needs. `column`: its position in HistoryColumns().
unsigned PartsOf(int column);

/// Appends a row of a body, one value a name of KinematicColumnNames(). `v_AB_B` is the velocity through the
/// air.
void AppendKinematics(const Earth& earth, double time_s, const RigidBodyState& state, const AirData& air,
                      const Vector3& v_AB_B, double mass_kg, std::vector<double>& rows);
/// Appends a row of HistoryColumns().
void AppendRow(const FlightModel& model, const TickSample& sample, std::vector<double>& rows);

}  // namespace dispersa
