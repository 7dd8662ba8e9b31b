// The two halves of a history row: motion of any body, and what only a launcher has.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/control/autopilot_config.h"
#include "core/dynamics/air_data.h"
#include "core/dynamics/rigid_body.h"
#include "core/flight/flight_model.h"
#include "core/flight/tick_sample.h"

namespace dispersa {

/// Columns of a row that are read: bit i is column i. All others have no meaningful value.
using RowColumns = std::uint64_t;
inline constexpr RowColumns kWholeRow = ~RowColumns{0};

/// Columns of any body, and behind them those of a launcher.
inline constexpr int kBodyColumns = 24, kLauncherColumns = 37;

const std::vector<std::string>& KinematicColumnNames();
struct LauncherColumn {
  const char* name;
  bool LawInfo::*of_law =
      nullptr;  ///< property that an axis' law needs for its flights to have the column (null: none)
};
const std::vector<LauncherColumn>& LauncherColumns();

/// A group of neighbouring columns that are made together.
struct ColumnGroup {
  int first, last;
  constexpr bool IsRead(RowColumns read) const {
    return (read >> first & ((RowColumns{2} << (last - first)) - 1)) != 0;
  }
};
inline constexpr ColumnGroup kLocalVelocity{7, 9}, kPlaceColumns{10, 12}, kLocalAttitude{13, 15},
    kFlowAngles{21, 22}, kOrbitColumns{26, 27}, kProgramPitch{28, 28}, kLaunchPitch{29, 29}, kSteered{30, 40},
    kLawColumns{41, 49}, kLearntColumns{46, 48}, kThrusters{50, 52}, kLoadColumns{54, 55}, kIncidence{56, 56},
    kToldByLaw{57, 60};

/// Appends a row of a body, one value a name of KinematicColumnNames(). `v_AB_B` is the velocity through the
/// air.
void AppendKinematics(const Earth& earth, double time_s, const RigidBodyState& state, const AirData& air,
                      const Vector3& v_AB_B, double mass_kg, std::vector<double>& rows);
/// Appends a row of HistoryColumns().
void AppendRow(const FlightModel& model, const TickSample& sample, std::vector<double>& rows);

}  // namespace dispersa
