// The motor or engine of a stage, as its file describes it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/input/fields.h"
#include "core/vehicle/thrust_curve.h"

namespace dispersa {

/// Commands of a liquid stage's engine: thrust as a part of full thrust over the time since ignition, linear
/// between the times, and the time of cut-off. Thrust and flow are in proportion at any level.
struct Throttle {
  std::vector<double> time_s;
  std::vector<double> level;

  bool empty() const { return time_s.empty(); }
};
enum class CutOff {
  kAtDepletion,  ///< when all but the residual has flown
  kAtTime,       ///< `cut_off_s` after ignition, or by depletion if that comes first
  kAtVelocity,   ///< at the inertial speed `cut_off_velocity_m_s`, or by depletion if that comes first
  kAtTarget,     ///< when the orbit has the energy of the trajectory's target, or by depletion
  kByGuidance,   ///< in no file: kAtTime, of a burn whose duration closed-loop guidance computes in flight
};

/// The energy at which cut_off: {at: target} ends a burn. The file does not have it: it is the trajectory's.
struct AimedEnergy {
  bool is_known = false;
  bool is_ellipse = false;
  double mu_m3_s2 = 0.0;
  double energy_m2_s2 = 0.0;                    ///< of an ellipse
  double altitude_m = 0.0, velocity_m_s = 0.0;  ///< else of this speed at this geodetic altitude
};

inline void Describe(Fields& fields, Throttle& throttle) {
  fields.Quantities("time", kTime, kNonNegative, 2, kThrustCurveCorners, throttle.time_s,
                    "since ignition, from 0; linear between points");
  fields.Quantities("level", kShare, Between(0.0, 1.0), 2, kThrustCurveCorners, throttle.level,
                    "of full thrust; the last one holds; a last value of 0 ends the burn");
  fields.Check([&] {
    if (throttle.time_s.size() != throttle.level.size())
      fields.Refuse("",
                    "there are " + std::to_string(throttle.time_s.size()) + " times and " +
                        std::to_string(throttle.level.size()) + " levels",
                    "one level for each time");
    if (throttle.time_s[0] != 0.0)
      fields.Refuse("time[0]", fields.Quote("time[0]") + " is not the time of ignition",
                    "0 as the first time");
    CheckIncreasing(fields, "time", throttle.time_s);
    if (std::all_of(throttle.level.begin(), throttle.level.end(), [](double level) { return level == 0.0; }))
      fields.Refuse("level", "the level is 0 at all times", "a level above 0 somewhere");
  });
}

/// Constant thrust between two linear ramps whose impulse is part of the whole, or a thrust curve. Propellant
/// flow is proportional to thrust unless the curve gives it. The propellant is used up exactly at burnout.
struct Motor {
  double thrust_n =
      0.0;  ///< all nozzles together (the paper's 4P), in vacuum, for a curve its greatest value
  double burning_time_s = 0.0;  ///< propellant_mass / burning_time is the flow at full thrust
  double ignition_rise_s = 0.0;
  double tail_off_s = 0.0;  ///< of a liquid stage: after a cut-off (CutOffLead)
  double nozzle_exit_area_m2 = 0.0;
  double published_mass_flow_kg_s = 0.0;
  ThrustCurve thrust_curve = {};  ///< replaces ramps, thrust_n and burning_time_s (empty: no curve)
  // Of a liquid stage, which has no ramps and no curve. thrust_n is full thrust. burning_time_s is the time
  // in which full thrust uses all propellant.
  Throttle throttle = {};
  CutOff cut_off = CutOff::kAtDepletion;
  double cut_off_s = 0.0;
  double cut_off_velocity_m_s = 0.0;
  double specific_impulse_s = 0.0;
  double residual_mass_kg = 0.0;
  AimedEnergy aimed_energy = {};
};
/// Gives a motor a curve, and the greatest thrust and the time that its propellant would last at the greatest
/// flow.
void SetThrustCurve(ThrustCurve curve, Motor& motor);

/// Commands of an engine in one of its burns.
inline void DescribeCommands(Fields& fields, Motor& motor) {
  bool is_throttled = !motor.throttle.empty(), is_cut_off = motor.cut_off != CutOff::kAtDepletion;
  fields.OptionalTable("throttle", is_throttled, "thrust over time since ignition, or its CSV file",
                       [&](Fields& throttle) { Describe(throttle, motor.throttle); });
  fields.OptionalMap(
      "cut_off", is_cut_off, "end of the burn, unless the propellant is used up before", [&](Fields& cut) {
        cut.Choice<CutOff>("at",
                           {{"depletion", CutOff::kAtDepletion},
                            {"time", CutOff::kAtTime},
                            {"inertial_velocity", CutOff::kAtVelocity},
                            {"target", CutOff::kAtTarget}},
                           motor.cut_off,
                           "event that ends the burn; target, of the last burn: the energy of the target "
                           "orbit");
        cut.When(Is("at", {"time"}),
                 [&] { cut.Quantity("after", kTime, kPositive, motor.cut_off_s, "since ignition"); });
        cut.When(Is("at", {"inertial_velocity"}), [&] {
          cut.Quantity("velocity", kSpeed, kPositive, motor.cut_off_velocity_m_s, "inertial speed");
        });
      });
}

inline void DescribeLiquid(Fields& fields, Motor& motor) {
  fields.Quantity("thrust", kForce, kPositive, motor.thrust_n, "at full thrust, of all nozzles, in vacuum");
  fields.Quantity("specific_impulse", kTime, kPositive, motor.specific_impulse_s, "in vacuum");
  fields.Quantity("residual_mass", kMass, kNonNegative, motor.residual_mass_kg,
                  "propellant that stays in the tanks", 0.0);
  fields.Deciding(Decides::kFlightOnly, [&] {
    fields.Quantity("tail_off", kTime, Between(0.0, 2.0), motor.tail_off_s,
                    "linear decay of the thrust by a cut-off, which is commanded half of it earlier", 0.0);
  });
  DescribeCommands(fields, motor);
  fields.Check([&] {
    if (motor.cut_off == CutOff::kAtTime && motor.cut_off_s < 0.5 * motor.tail_off_s)
      fields.Refuse("tail_off",
                    "is more than twice cut_off.after_*: its command would be before the ignition",
                    "at most twice cut_off.after_*");
  });
}

inline void DescribeThrustCurve(Fields& fields, Motor& motor) {
  bool in_vacuum = true;
  fields.Choice<bool>("reference", {{"vacuum", true}, {"sea_level", false}}, in_vacuum,
                      "where the thrust was measured; p A_e is added at sea level");
  fields.Table("table",
               "a CSV file (time_s, thrust_n, optional mass_flow_kg_s), an .eng file, or the columns",
               "a CSV file, an .eng file, or the columns",
               [&](Fields& table) { Describe(table, motor.thrust_curve); });
  fields.Check([&fields, &motor, in_vacuum] {
    if (in_vacuum) return;
    if (motor.nozzle_exit_area_m2 == 0.0)
      fields.Refuse(
          "reference",
          "the thrust in vacuum is that at sea level and p A_e, but the motor has no nozzle_exit_area_m2",
          "nozzle_exit_area_m2 above 0, or reference: vacuum");
    motor.thrust_curve = InVacuum(motor.thrust_curve, motor.nozzle_exit_area_m2);
  });
}

inline void DescribeExit(Fields& fields, Motor& motor) {
  fields.Quantity("nozzle_exit_area", kArea, kNonNegative, motor.nozzle_exit_area_m2,
                  "of all nozzles; thrust = vacuum thrust - p A_e. 0: without this term", 0.0);
  fields.Quantity("published_mass_flow", kMassFlow, kNonNegative, motor.published_mass_flow_kg_s,
                  "as printed in the source; for comparison only", 0.0);
}

/// `message` says why a map may not have constant thrust and its ramps. {} is replaced by the key.
inline void RefuseRamps(Fields& fields, const char* message, const char* allowed) {
  fields.Misplaced("thrust", kForce, message, allowed);
  fields.Misplaced("burning_time", kTime, message, allowed);
  fields.Misplaced("ignition_rise", kTime, message, allowed);
  fields.Misplaced("tail_off", kTime, message, allowed);
}

inline void DescribeSolid(Fields& fields, Motor& motor) {
  DescribeExit(fields, motor);
  fields.Either({{Has("thrust_curve"),
                  [&] {
                    RefuseRamps(fields, "'{}' and 'thrust_curve' are both given, and the curve says it all",
                                "either thrust_curve, or thrust_* with burning_time_* and ramps");
                    fields.Map("thrust_curve", "thrust over time since ignition",
                               [&](Fields& curve) { DescribeThrustCurve(curve, motor); });
                  }},
                 {Else(), [&] {
                    fields.Quantity("thrust", kForce, kPositive, motor.thrust_n, "of all nozzles, in vacuum");
                    fields.Quantity("burning_time", kTime, kPositive, motor.burning_time_s,
                                    "to use up the propellant at full thrust");
                    fields.Quantity("ignition_rise", kTime, kNonNegative, motor.ignition_rise_s,
                                    "linear rise to full thrust", 0.0);
                    fields.Quantity("tail_off", kTime, kNonNegative, motor.tail_off_s,
                                    "linear decay at the end", 0.0);
                  }}});
}

inline void Describe(Fields& fields, Motor& motor) {
  fields.Either(
      {{Has("liquid"),
        [&] {
          constexpr const char* kEither = "either liquid, or what a solid motor has";
          RefuseRamps(fields, "'{}' and 'liquid' are both given, and the engine has them inside", kEither);
          fields.Misplaced("thrust_curve", {}, "'thrust_curve' and 'liquid' are both given", kEither);
          DescribeExit(fields, motor);
          fields.Map("liquid", "an engine with tanks",
                     [&](Fields& liquid) { DescribeLiquid(liquid, motor); });
        }},
       {Else(), [&] { DescribeSolid(fields, motor); }}});
}

}  // namespace dispersa
