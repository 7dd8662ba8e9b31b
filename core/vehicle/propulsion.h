// A motor's thrust, flow and remaining propellant in closed form over the time since ignition.
#pragma once

#include <memory>
#include <vector>

#include "core/vehicle/vehicle.h"

namespace dispersa {

/// Fraction of full thrust below which a motor hardly controls the attitude. An autopilot that knows a thrust
/// curve raises its commands no further, and no margins are computed.
inline constexpr double kLeastThrustFraction = 0.2;

/// A motor as one flight burns it: nominal data times the flight's factors.
template <class T>
struct BurnNumbers {
  T vacuum_thrust_n = T(0.0);  ///< at full thrust
  T full_flow_kg_s = T(0.0);   ///< at full thrust
  T propellant_mass_kg = T(0.0);
  T rise_s = T(0.0);
  T tail_s = T(0.0);
  T exit_area_m2 = T(0.0);
  T duration_s = T(0.0);  ///< ignition to burnout
  T left_kg = T(0.0);     ///< of the propellant, then
  /// The curve's time runs so many times as fast as in the file, by the flight's burn rate (in lanes 0:
  /// none).
  T curve_rate = T(1.0);
};
struct MotorBurn : BurnNumbers<double> {
  std::shared_ptr<const BurnCurve> curve;  ///< replaces the ramps
  double residual_kg = 0.0;                ///< of a liquid engine: never flows, by the flight's mixture

  /// Fraction of full thrust and flow, 0 outside [0, duration_s].
  double Fraction(double since_ignition_s) const;
  /// Propellant left, from propellant_mass_kg to left_kg.
  double Propellant(double since_ignition_s) const;
  /// Impulse over propellant, m/s.
  double ExhaustVelocity() const;
  /// Times within the burn of a motor ignited at ignition_s at which the thrust bends, in their order: no
  /// integration step may go across.
  std::vector<double> Kinks(double ignition_s) const;
};

/// The burn with multiplied thrust and flow. Propellant is conserved. Ramps keep their durations. The flow's
/// factor shortens a thrust curve in time. `curve`: the stage's prepared curve, or null. A throttle keeps its
/// commanded times, and the time of depletion changes.
MotorBurn BuildBurn(const Stage& stage, double thrust_factor, double flow_factor,
                    std::shared_ptr<const BurnCurve> curve);
/// The same, preparing the curve if the stage has one.
MotorBurn BuildBurn(const Stage& stage, double thrust_factor, double flow_factor);

/// Gives a restarted engine's burn the propellant that its burn before left.
void SetPropellant(const Motor& engine, double propellant_kg, MotorBurn& burn);
/// Gives a burn a tail-off of another duration. A solid motor burns its propellant all the same; after a
/// cut-off the propellant of the decay changes. A thrust curve has its own tail-off.
void SetTailOff(double factor, const Stage& stage, MotorBurn& burn);
/// Ends a throttled burn at once.
void CutOffAt(double since_ignition_s, MotorBurn& burn);
/// Ends it by a command, after which its thrust decays in burn.tail_s.
void CommandCutOff(const Motor& engine, double since_ignition_s, MotorBurn& burn);

/// Propellant, motor, grain and tanks of one booster, as those of a stage.
Stage AsStage(const Boosters& boosters);
/// The burn of one booster, with the factors of its thrust and flow.
MotorBurn BuildOneBoosterBurn(const Boosters& boosters, double thrust_factor, double flow_factor);
/// The burn of all boosters together, with the first stage's factors. Thrust is that along the axis.
MotorBurn BuildBoosterBurn(const Boosters& boosters, double thrust_factor, double flow_factor);

}  // namespace dispersa
