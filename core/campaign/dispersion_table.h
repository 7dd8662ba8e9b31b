// The dispersions that a campaign may have: one row for each key of its `dispersions`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/campaign/distribution_fields.h"

namespace dispersa {

/// The draws that a dispersion makes from its distribution, and the further keys of its map.
enum class Draws {
  kOnce,             ///< one value for all columns
  kEachAxis,         ///< a value for each axis of the launch-inertial frame
  kEachMode,         ///< `per: mode`, or `vehicle`: one value for all
  kEachStage,        ///< of the stages that `stage` names, else of all
  kStages,           ///< as above, with `per: stage`, or `vehicle` (one value for all stages)
  kVehicleOrStages,  ///< as above; without `per` and `stage` the whole vehicle's column
  kOffAxis,          ///< as kStages, by magnitude and `clock_angle` or by components
  kFixed,            ///< one value, drawn or not: "stem_unit: x" or "stem: {distribution: ...}"
  kFixedOrAbsent,    ///< as above, or absent
  kDirection,        ///< "uniform", {fixed_deg: x} or a distribution
  kParts,            ///< a map of dispersions, one or more
  // With keys of their own (dispersion_fields.cc).
  kThrust,
  kPropellantTemperature,
  kPayloadMass,
  kWind,
  kGust,
  kWindProfile,
  kWeather,
  kTurbulence,
  kStuckNozzle,
  kBoosters,             ///< `per: booster`, or `vehicle`: one value for all
  kBoostersTemperature,  ///< the same of a temperature that sets the burn rate
  kBoostersAside,        ///< components towards body y and z, of each booster
  kAeroUncertainty,
};

/// Why nothing of a vehicle takes a key's values, and what would.
struct Unfit {
  std::string what;
  const char* allowed;
};

struct DispersionRow {
  const char* key;
  const char* meaning;  ///< one line
  Draws draws;
  DispersedScalar scalar = kPositiveFactor;
  /// Columns (FlightInputs) that take the values. {stage}, {nozzle}, {mode}, {level} and {axis} stand for the
  /// name of each. kOffAxis: magnitude, direction, and the components towards body y and z.
  std::vector<std::string> columns = {};
  std::vector<std::string> nozzle_columns = {};  ///< columns for `per: nozzle` (empty: not allowed)
  std::vector<DispersionRow> parts = {};         ///< maps in its map
  std::optional<double> absent = {};             ///< the value in every case if the key is not there
  int first_stage = 1;
  int last_stages_without = 0;  ///< number of last stages that cannot be dispersed
  /// Of a stage of a vehicle, or its boosters: none, if it takes the values.
  std::optional<Unfit> (*unfit)(const Vehicle& vehicle, int stage) = nullptr;
};

/// In the order of the draws.
const std::vector<DispersionRow>& DispersionRows();

/// The names of all columns of a pattern.
std::vector<std::string> ExpandColumn(const std::string& pattern);
/// A pattern with a name in place of {what}.
std::string FillColumn(std::string pattern, const std::string& what, const std::string& name);

/// The file's key for a column of the flight's inputs: "drag_coefficient", "wind.azimuth". Empty if it cannot
/// be dispersed. If several keys draw the column, the first of the table.
std::string InputKey(int column);
/// The same of a campaign: of several keys the one by which its file draws the column.
std::string InputKey(const Campaign& campaign, int column);

}  // namespace dispersa
