// What a flight can apply of an input, and which parts of a flight read it. Both belong to the input's
// declaration (flight_inputs.h) and hold by every way in which a value reaches a flight.
#pragma once

#include <string>
#include <vector>

#include "core/control/autopilot_config.h"
#include "core/flight/flight_course.h"
#include "core/guidance/guidance_config.h"
#include "core/input/range.h"
#include "core/vehicle/vehicle.h"

namespace dispersa {

struct FlightInputs;

/// What an input belongs to. A further nozzle is one beyond four of its stage, or a booster's. Modes and
/// levels of a profile are the flight's: the same vehicle flies with them and without.
enum class Carrier { kFlight, kStage, kNozzle, kFurtherNozzle, kBooster };
/// Which of its kind an input is.
struct InputPlace {
  Carrier carrier = Carrier::kFlight;
  int stage = 0;  ///< 1-based; 0: of no stage
  int item = 0;   ///< its nozzle, mode, level or further nozzle, from 0
};

/// What decides whether an input is read. `set` has the inputs that may differ from the nominal ones.
struct FlightParts {
  const Vehicle& vehicle;
  const AutopilotConfig& autopilot;
  const GuidanceConfig& guidance;
  const FlightCourse& course;
  const FlightInputs& set;
  std::size_t soundings = 0;  ///< of the campaign
};

/// In internal units. The nominal value is allowed where nothing reads it.
struct AllowedValues {
  Range range = kAnyNumber;
  bool is_whole = false;
  /// Further limits, by the vehicle.
  Range (*of)(const Vehicle& vehicle, const InputPlace& place) = nullptr;
};

struct Readers {
  /// Whether a part of the flight reads the input (null: every flight does).
  bool (*read)(const FlightParts& parts, const InputPlace& place) = nullptr;
  const char* unread = "";   ///< why nothing uses it
  const char* allowed = "";  ///< what would use it
};

/// Of a stage: those of its list, else four in a cross.
int NozzleCount(const Gimbal& gimbal);
/// The numbers that a column may have in flights of a vehicle, in internal units.
Range RangeOf(const Vehicle& vehicle, int column);
/// "a number above 0", "a whole number from 0 to 4", in the column's unit.
std::string RangeText(const Vehicle& vehicle, int column);
/// Whether a value (internal unit) lies in RangeOf() and is whole where it must be.
bool IsAllowed(const Vehicle& vehicle, int column, double value);
/// Whether the vehicle has the part that the column belongs to. In every flight of a vehicle that does not,
/// the input is nominal.
bool HasInput(const Vehicle& vehicle, int column);
/// The columns for which HasInput() holds, ascending.
std::vector<int> InputsOf(const Vehicle& vehicle);
std::vector<std::string> InputNamesOf(const Vehicle& vehicle);
/// Whether some part of the flight reads the column.
bool IsRead(const FlightParts& parts, int column);
/// Why a flight cannot apply these inputs, as a sentence about the first one; empty if it can. Its `set` are
/// the inputs themselves.
std::string WhyNotAllowed(const FlightParts& parts);

// ---- the rules that declarations name ----

// Limits by the vehicle.
Range PropellantThatFits(const Vehicle& vehicle, const InputPlace& place);
Range BoosterPropellantThatFits(const Vehicle& vehicle, const InputPlace& place);
Range ProductsOfABody(const Vehicle& vehicle, const InputPlace& place);
Range IgnitionAfterItsTrigger(const Vehicle& vehicle, const InputPlace& place);
Range SeparationAfterBurnout(const Vehicle& vehicle, const InputPlace& place);
Range PayloadThatMayLeave(const Vehicle& vehicle, const InputPlace& place);
Range NozzlesThatThereAre(const Vehicle& vehicle, const InputPlace& place);
Range StagesThatThereAre(const Vehicle& vehicle, const InputPlace& place);
Range ElementsThatThereAre(const Vehicle& vehicle, const InputPlace& place);

inline constexpr AllowedValues kPositiveValues = {kPositive};
inline constexpr AllowedValues kNoLessThanZero = {kNonNegative};
inline constexpr AllowedValues kProfileWind = {Between(-300.0, 300.0)};  ///< twice any measured wind

// Readers of several inputs.
extern const Readers kByAutopilot, kByAdaptation, kByNavigation, kByDrives, kByModes, kByModeSensors, kByFins,
    kByTailOff, kByMixture, kByBoosterMixture, kByBoosters, kByFirstBurn, kByIgnition, kBySeparation,
    kByNozzle, kByFurtherNozzle, kByUncertainTables, kBySoundings;
// Inputs that have a meaning only beside another.
extern const Readers kWithThrustMisalignment, kWithThrustOffset, kWithCgOffset, kWithNozzleMisalignment,
    kWithNozzleOffset, kWithWind, kWithGust, kWithProfile, kWithTurbulence, kWithStuckNozzle, kWithLoop,
    kWithPayload;

}  // namespace dispersa
