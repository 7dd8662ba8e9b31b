// The rows of the checks in plausibility.h, by what they look at.
#pragma once

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "core/vehicle/vehicle.h"
#include "core/vehicle/vehicle_figures.h"

namespace dispersa::plausibility {

inline constexpr double kAny = std::numeric_limits<double>::infinity();
inline constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

struct Span {
  double low = -kAny;
  double high = kAny;
  bool Holds(double value) const { return value >= low && value <= high; }
};

/// What a value may be.
struct Spans {
  Span usual;          ///< beyond: none is known
  Span possible = {};  ///< beyond: no such thing can exist

  constexpr Spans Possible(double low, double high) const { return {usual, {low, high}}; }
};
constexpr Spans Usual(double low, double high) { return {{low, high}}; }

/// The subject of a check: the vehicle, and one of its stages, nozzles or gyros, or its boosters'
/// motor, gimbal or one of their tanks.
struct Subject {
  const Vehicle& vehicle;
  const std::vector<StageFigures>& figures;
  std::size_t index = 0;
  std::size_t part = 0;  ///< tank, set of fins or jettisoned body of the stage, lighter table (from 1)
  bool is_booster = false;
  bool of_yaw_plane = false;

  const Tank& tank() const { return (is_booster ? vehicle.boosters.tanks : stage().tanks)[part]; }
  const Motor& motor() const { return is_booster ? vehicle.boosters.motor : stage().motor; }
  /// Null: its nozzles do not turn.
  const Gimbal* gimbal() const {
    const Gimbal& one = is_booster ? vehicle.boosters.gimbal : stage().gimbal;
    return (is_booster ? one.limit_rad > 0.0 : stage().is_controlled()) ? &one : nullptr;
  }
  const FinSet& fins() const { return stage().fins[part]; }
  const Jettison& jettison() const { return stage().jettisoned[part]; }
  /// Of the stack, or a lighter one's.
  const AeroTable& table() const {
    const AeroTable& whole = vehicle.aerodynamics[index];
    const AeroTable& one = part == 0 ? whole : whole.lighter[part - 1].table;
    return of_yaw_plane ? one.yaw_plane.front() : one;
  }
  const Stage& stage() const { return vehicle.stages[index]; }
  const StageFigures& figure() const { return figures[index]; }
  std::size_t last_burn() const {
    return static_cast<std::size_t>(LastBurn(vehicle, static_cast<int>(index)));
  }
  bool has_coast_control() const {
    return vehicle.stages.size() > 1 && std::any_of(vehicle.stages.begin(), vehicle.stages.end(),
                                                    [](const Stage& one) { return one.is_controlled(); });
  }
  bool is_last() const { return last_burn() + 1 == vehicle.stages.size(); }
  double length_m() const { return vehicle.stages[0].bottom_station_m; }
};

struct Check {
  const char* field;    ///< of the value that most probably is wrong
  const char* implies;  ///< "implies a specific impulse of"
  const char* unit;
  Spans spans;
  const char* source;
  double (*value)(const Subject&);  ///< NaN: does not apply
};

/// Of engines of stages and of boosters.
struct Known {
  Spans spans;
  const char* source;
};
inline constexpr Known kLiquidImpulse = {
    Usual(200.0, 470.0).Possible(0.0, 1000.0),
    "in vacuum 220 to 240 s of hydrazine alone, 280 to 330 s of storable pairs, 300 to 360 s of oxygen with "
    "kerosene, to 465 s with hydrogen; combustion never gave more than 550 s, reactors 900 s"};
inline constexpr Known kResidual = {Usual(0.0, 0.05),
                                    "0.5 to 3 % of a liquid stage's propellant stays in tanks and lines"};

/// The widest diameter of the mould line between two stations.
double WidestDiameter(const Vehicle& vehicle, double top_m, double bottom_m);

// Of each stage that is no restart (plausibility_stage.cc).
std::span<const Check> StageChecks();
// Of a stage's motor and gimbal, or those of the boosters.
std::span<const Check> PressureChecks();
std::span<const Check> GimbalChecks();
/// Of each burn, restarts too.
std::span<const Check> CutOffChecks();
std::span<const Check> JettisonChecks();
std::span<const Check> FinChecks();
std::span<const Check> TankChecks();
std::span<const Check> TankInStageChecks();
std::span<const Check> NozzleChecks();
/// Of the aerodynamic table of each stack (plausibility_air.cc).
std::span<const Check> AeroChecks();
// Of the whole vehicle (plausibility_vehicle.cc).
std::span<const Check> GyroChecks();
std::span<const Check> VehicleChecks();

}  // namespace dispersa::plausibility
