#include "core/flight/input_rules.h"

#include <algorithm>
#include <cmath>

#include "core/environment/turbulence.h"
#include "core/flight/dispersed_vehicle.h"
#include "core/flight/flight_inputs.h"
#include "core/input/number_text.h"
#include "core/vehicle/aero_table.h"
#include "core/vehicle/mass.h"
#include "core/vehicle/propulsion.h"

namespace dispersa {
namespace {

const InputColumn& ColumnAt(int column) { return InputColumns()[static_cast<std::size_t>(column)]; }

double NominalValue(int column) {
  static FlightInputs nominal;
  return InputValue(nominal, column);
}

// Null: the vehicle has no such stage, or the input belongs to none.
const Stage* StageAt(const Vehicle& vehicle, const InputPlace& place) {
  const auto i = static_cast<std::size_t>(place.stage) - 1;
  return place.stage > 0 && i < vehicle.stages.size() ? &vehicle.stages[i] : nullptr;
}

// Of the place's stage, or of any if it belongs to none.
template <typename Holds>
bool SomeStage(const FlightParts& parts, const InputPlace& place, Holds holds) {
  if (place.stage > 0) {
    const Stage* stage = StageAt(parts.vehicle, place);
    return stage != nullptr && holds(*stage);
  }
  return std::any_of(parts.vehicle.stages.begin(), parts.vehicle.stages.end(), holds);
}

bool IsControlled(const FlightParts& parts, const InputPlace&) { return parts.course.is_controlled; }

bool HasModes(const FlightParts& parts, const InputPlace& place) {
  const auto& beam = parts.vehicle.structure_beam;
  return beam && place.item < beam->flown_modes;
}

// Boosters are the last ones among the further nozzles.
int FirstBooster(const Vehicle& vehicle) { return FurtherNozzlesBefore(vehicle, vehicle.stages.size()); }
int FurtherNozzlesOf(const Vehicle& vehicle) {
  return FirstBooster(vehicle) + static_cast<int>(vehicle.boosters.angles_rad.size());
}
bool IsBooster(const FlightParts& parts, const InputPlace& place) {
  return place.item >= FirstBooster(parts.vehicle) && place.item < FurtherNozzlesOf(parts.vehicle);
}

bool IsSteered(const FlightParts& parts, const InputPlace& place) {
  return SomeStage(parts, place, [](const Stage& stage) { return stage.is_controlled(); }) ||
         (place.stage <= 1 && parts.vehicle.boosters.turn_nozzles());
}

// The next burn is of another body.
bool Separates(const FlightParts& parts, const InputPlace& place) {
  const Stage* next = StageAt(parts.vehicle, {Carrier::kStage, place.stage + 1, 0});
  return next != nullptr && !next->restarts;
}

// Columns of further nozzles are those that the vehicle has.
bool IsNozzle(const FlightParts& parts, const InputPlace& place) {
  if (place.stage == 0) return true;
  const Stage* stage = StageAt(parts.vehicle, place);
  return stage != nullptr && place.item < NozzleCount(stage->gimbal);
}

// The value beside an input, at the same place, without which the input means nothing.
using Beside = double (*)(const FlightInputs& in, const InputPlace& place);
template <Beside kValue>
bool IsSet(const FlightParts& parts, const InputPlace& place) {
  return kValue(parts.set, place) != 0.0;
}
const StageInputs& StageAt(const FlightInputs& in, const InputPlace& place) {
  return in.stages[static_cast<std::size_t>(place.stage) - 1];
}
double ThrustMisalignment(const FlightInputs& in, const InputPlace& place) {
  return StageAt(in, place).thrust.misalignment_rad.magnitude;
}
double ThrustOffset(const FlightInputs& in, const InputPlace& place) {
  return StageAt(in, place).thrust.offset_m.magnitude;
}
double CgOffset(const FlightInputs& in, const InputPlace& place) {
  return StageAt(in, place).cg_offset_m.magnitude;
}
double NozzleMisalignment(const FlightInputs& in, const InputPlace& place) {
  return NozzleAt(in, place).line.misalignment_rad.magnitude;
}
double NozzleOffset(const FlightInputs& in, const InputPlace& place) {
  return NozzleAt(in, place).line.offset_m.magnitude;
}
double JetSpeed(const FlightInputs& in, const InputPlace&) { return in.air.wind_max_speed_m_s; }
double GustSpeed(const FlightInputs& in, const InputPlace&) { return in.air.gust_speed_m_s; }
double Exceedance(const FlightInputs& in, const InputPlace&) { return in.air.turbulence_exceedance; }
double StuckNozzle(const FlightInputs& in, const InputPlace&) { return in.stuck_nozzle; }
double PayloadMass(const FlightInputs& in, const InputPlace&) { return in.payload_mass_kg; }

constexpr char kNoMagnitude[] = "it is a direction, and nothing draws its magnitude";
constexpr char kMagnitude[] = "the magnitude beside it, or no direction";

}  // namespace

int NozzleCount(const Gimbal& gimbal) {
  const std::size_t listed = NozzlesOf(gimbal).size();
  return listed == 0 ? kNozzles : static_cast<int>(listed);
}

// ---- limits by the vehicle ----

// At most what the grain's case, or the tanks, hold.
Range PropellantThatFits(const Vehicle& vehicle, const InputPlace& place) {
  const Stage* stage = StageAt(vehicle, place);
  return stage == nullptr ? kPositive : UpTo(LargestPropellantFactor(*stage));
}
Range BoosterPropellantThatFits(const Vehicle& vehicle, const InputPlace&) {
  return vehicle.boosters.count == 0 ? kPositive : UpTo(LargestPropellantFactor(AsStage(vehicle.boosters)));
}

// Half the least moment of inertia, about either axis, of the stack without its own propellant and without
// masses that may leave. With three such products the tensor is still that of a body.
Range ProductsOfABody(const Vehicle& vehicle, const InputPlace& place) {
  if (StageAt(vehicle, place) == nullptr) return kAnyNumber;
  StackMass left = Without(BuildStackMasses(vehicle)[static_cast<std::size_t>(place.stage) - 1],
                           place.stage - 1, BuildJettisonedMasses(vehicle), ~0u);
  if (place.stage == 1 && vehicle.boosters.count > 0)
    left = Without(left, 0, {BuildBoosterMass(vehicle.boosters)}, 1u);
  const MassProperties empty = left.At(0.0);
  const double most = 0.5 * std::min(empty.axial_inertia_kg_m2, empty.transverse_inertia_kg_m2);
  return Between(-most, most);
}

// Nothing happens before what triggers it.
Range IgnitionAfterItsTrigger(const Vehicle& vehicle, const InputPlace& place) {
  const Stage* stage = StageAt(vehicle, place);
  const bool follows = stage != nullptr && stage->ignition == IgnitionTrigger::kBurnoutDetection;
  return {follows ? -stage->ignition_delay_s : -HUGE_VAL, HUGE_VAL, false, false};
}
Range SeparationAfterBurnout(const Vehicle& vehicle, const InputPlace& place) {
  const Stage* stage = StageAt(vehicle, place);
  return stage == nullptr ? kAnyNumber : Range{-stage->separation_delay_s, HUGE_VAL, false, false};
}

// As much as the heaviest element weighs. Which of them it is, only a flight's inputs say together.
Range PayloadThatMayLeave(const Vehicle& vehicle, const InputPlace&) {
  if (vehicle.stages.empty()) return kAnyNumber;
  double most = 0.0;
  for (const MassElement& element : vehicle.stages.back().structure)
    most = std::max(most, element.fraction * DryMass(vehicle, static_cast<int>(vehicle.stages.size()) - 1));
  return {-most, HUGE_VAL, false, false};
}

Range NozzlesThatThereAre(const Vehicle& vehicle, const InputPlace&) {
  int most = 0;
  for (const Stage& stage : vehicle.stages) most = std::max(most, NozzleCount(stage.gimbal));
  return Between(0.0, most);
}
Range StagesThatThereAre(const Vehicle& vehicle, const InputPlace&) {
  return Between(0.0, static_cast<double>(vehicle.stages.size()));
}
Range ElementsThatThereAre(const Vehicle& vehicle, const InputPlace&) {
  return Between(0.0,
                 vehicle.stages.empty() ? 0.0 : static_cast<double>(vehicle.stages.back().structure.size()));
}

// ---- readers ----

const Readers kByAutopilot = {IsControlled, "the flight has no autopilot", "a campaign with an autopilot"};
const Readers kByAdaptation = {
    [](const FlightParts& parts, const InputPlace&) {
      const auto adapts = [](const AxisConfig& axis) { return InfoOf(axis.law).adaptation; };
      const AutopilotConfig& autopilot = parts.autopilot;
      return parts.course.is_controlled &&
             (adapts(autopilot.pitch) || adapts(autopilot.yaw) || adapts(autopilot.roll));
    },
    "no axis has a law that adapts", "law: adaptive_fuzzy of an axis"};
const Readers kByNavigation = {
    [](const FlightParts& parts, const InputPlace&) { return parts.guidance.closed_loop; },
    "the flight has no closed-loop guidance, and the autopilot has sensors of its own",
    "guidance: {mode: closed_loop}, or none of navigation's errors"};
const Readers kByDrives = {IsSteered, "no stage that it draws for has a gimbal", "stages with gimbal"};
const Readers kByModes = {HasModes, "the vehicle flies as a rigid body, or has fewer modes",
                          "a vehicle with structure_beam and flown_modes"};
const Readers kByModeSensors = {[](const FlightParts& parts, const InputPlace& place) {
                                  return HasModes(parts, place) && parts.course.is_controlled;
                                },
                                "the vehicle flies as a rigid body, or without autopilot",
                                "a vehicle with structure_beam and flown_modes, under an autopilot"};
const Readers kByFins = {[](const FlightParts& parts, const InputPlace& place) {
                           return SomeStage(parts, place, [](const Stage& stage) {
                             return !stage.fins.empty() && !stage.restarts;
                           });
                         },
                         "no stage that it draws for has fins", "stages with fins"};
const Readers kByTailOff = {
    [](const FlightParts& parts, const InputPlace& place) {
      return SomeStage(parts, place, [](const Stage& stage) { return stage.motor.tail_off_s > 0.0; });
    },
    "no stage that it draws for has a tail_off_*", "tail_off_* of the stages' motors, or no tail_off"};
const Readers kByMixture = {
    [](const FlightParts& parts, const InputPlace& place) {
      return SomeStage(parts, place,
                       [](const Stage& stage) { return stage.tanks.size() >= 2 && !stage.restarts; });
    },
    "no stage that it draws for has two tanks", "stages with liquid engines of two propellants"};
const Readers kByBoosters = {IsBooster, "it is of no booster", "a booster's place among the nozzles"};
const Readers kByBoosterMixture = {
    [](const FlightParts& parts, const InputPlace& place) {
      return IsBooster(parts, place) && parts.vehicle.boosters.tanks.size() >= 2;
    },
    "the boosters have no two tanks", "boosters with liquid engines of two propellants"};
const Readers kByFirstBurn = {
    [](const FlightParts& parts, const InputPlace& place) {
      return SomeStage(parts, place, [](const Stage& stage) { return !stage.restarts; });
    },
    "the stage restarts: the draws of its first burn hold", "the number of its first burn"};
const Readers kByIgnition = {[](const FlightParts&, const InputPlace& place) { return place.stage > 1; },
                             "stage 1 ignites before lift-off", "stage: 2 or more"};
const Readers kBySeparation = {Separates, "no stage that it draws for separates from one above",
                               "stages that separate"};
const Readers kByNozzle = {IsNozzle, "the stage has no such nozzle", "a nozzle of the stage"};
const Readers kByFurtherNozzle = {
    [](const FlightParts& parts, const InputPlace& place) { return !IsBooster(parts, place); },
    "a booster's nozzle has no offset", "a nozzle of a stage"};
const Readers kByUncertainTables = {[](const FlightParts& parts, const InputPlace&) {
                                      const auto& tables = parts.vehicle.aerodynamics;
                                      return std::any_of(tables.begin(), tables.end(), IsUncertain);
                                    },
                                    "the vehicle has no aerodynamic table that states an uncertainty",
                                    "tables with an uncertainty"};

const Readers kBySoundings = {[](const FlightParts& parts, const InputPlace&) { return parts.soundings > 0; },
                              "the campaign has no soundings to choose from",
                              "dispersions: {weather: {ensemble: FOLDER}}"};

const Readers kWithThrustMisalignment = {IsSet<ThrustMisalignment>, kNoMagnitude, kMagnitude};
const Readers kWithThrustOffset = {IsSet<ThrustOffset>, kNoMagnitude, kMagnitude};
const Readers kWithCgOffset = {IsSet<CgOffset>, kNoMagnitude, kMagnitude};
const Readers kWithNozzleMisalignment = {IsSet<NozzleMisalignment>, kNoMagnitude, kMagnitude};
const Readers kWithNozzleOffset = {IsSet<NozzleOffset>, kNoMagnitude, kMagnitude};
const Readers kWithWind = {IsSet<JetSpeed>, "the jet stream's speed is 0", "wind_max_speed_m_s above 0"};
const Readers kWithGust = {IsSet<GustSpeed>, "the gust's speed is 0", "gust_speed_m_s other than 0"};
const Readers kWithProfile = {[](const FlightParts& parts, const InputPlace& place) {
                                const auto& altitude_m = parts.set.air.wind_profile_altitude_m;
                                // The lowest may lie at 0.
                                return altitude_m[static_cast<std::size_t>(std::max(place.item, 1))] != 0.0;
                              },
                              "its level has no altitude", "wind_profile_altitude_*_m beside it"};
const Readers kWithTurbulence = {IsSet<Exceedance>, "the turbulence's exceedance is 0",
                                 "turbulence_exceedance above 0"};
const Readers kWithStuckNozzle = {IsSet<StuckNozzle>, "no nozzle is stuck", "stuck_nozzle above 0"};
const Readers kWithLoop = {[](const FlightParts& parts, const InputPlace&) {
                             return parts.course.is_controlled &&
                                    (parts.set.loop_gain_factor != 1.0 || parts.set.loop_delay_s != 0.0);
                           },
                           "neither the loop's gain nor its delay is changed",
                           "loop_gain_factor or loop_delay_s beside it"};
const Readers kWithPayload = {IsSet<PayloadMass>, "no payload is added", "payload_mass_kg other than 0"};

// ---- what holds for a column ----

Range RangeOf(const Vehicle& vehicle, int column) {
  const InputColumn& input = ColumnAt(column);
  Range range = input.allowed.range;
  if (input.allowed.of == nullptr) return range;
  const Range narrower = input.allowed.of(vehicle, input.place);
  if (narrower.low >= range.low) range.low = narrower.low, range.low_open = narrower.low_open;
  if (narrower.high <= range.high) range.high = narrower.high, range.high_open = narrower.high_open;
  return range;
}

std::string RangeText(const Vehicle& vehicle, int column) {
  const InputColumn& input = ColumnAt(column);
  const std::string text = RangeOf(vehicle, column).Text(input.unit);
  return input.allowed.is_whole ? "a whole " + text.substr(text.find(' ') + 1) : text;
}

bool IsAllowed(const Vehicle& vehicle, int column, double value) {
  return RangeOf(vehicle, column).Contains(value) &&
         !(ColumnAt(column).allowed.is_whole && value != std::floor(value));
}

bool HasInput(const Vehicle& vehicle, int column) {
  const InputPlace& place = ColumnAt(column).place;
  const Stage* stage = StageAt(vehicle, place);
  switch (place.carrier) {
    case Carrier::kFlight:
      return true;
    case Carrier::kStage:
      return stage != nullptr;
    case Carrier::kNozzle:
      return stage != nullptr && place.item < NozzleCount(stage->gimbal);
    case Carrier::kFurtherNozzle:
      return place.item < FurtherNozzlesOf(vehicle);
    case Carrier::kBooster:
      return place.item >= FirstBooster(vehicle) && place.item < FurtherNozzlesOf(vehicle);
  }
  return false;
}

std::vector<int> InputsOf(const Vehicle& vehicle) {
  std::vector<int> columns;
  for (int column = 0; column < static_cast<int>(InputColumns().size()); ++column)
    if (HasInput(vehicle, column)) columns.push_back(column);
  return columns;
}

std::vector<std::string> InputNamesOf(const Vehicle& vehicle) {
  std::vector<std::string> names;
  for (const int column : InputsOf(vehicle)) names.push_back(ColumnAt(column).name);
  return names;
}

bool IsRead(const FlightParts& parts, int column) {
  const InputColumn& input = ColumnAt(column);
  return input.readers.read == nullptr || input.readers.read(parts, input.place);
}

std::string WhyNotAllowed(const FlightParts& parts) {
  FlightInputs inputs = parts.set;
  const int columns = static_cast<int>(InputCount(ColumnClass(parts.vehicle)));
  for (int column = 0; column < columns; ++column) {
    const double value = InputValue(inputs, column);
    const InputColumn& input = ColumnAt(column);
    if (!std::isfinite(value)) return "the input " + input.name + " has no value";
    if (value == NominalValue(column) ? input.allowed.range.Contains(value) || !IsRead(parts, column)
                                      : IsAllowed(parts.vehicle, column, value))
      continue;
    return "the input " + input.name + " is " + FormatRounded(value / input.unit) +
           "; allowed: " + RangeText(parts.vehicle, column);
  }
  return "";
}

}  // namespace dispersa
