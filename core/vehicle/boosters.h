// Boosters beside the first stage, as the vehicle file describes them.
#pragma once

#include <vector>

#include "core/input/fields.h"
#include "core/vehicle/bodies.h"
#include "core/vehicle/gimbal.h"
#include "core/vehicle/motor.h"
#include "core/vehicle/propulsion_fields.h"

namespace dispersa {

/// Boosters at most.
inline constexpr int kMaxBoosters = 8;

/// Solid motors or liquid engines of one type beside the first stage, ignited with it. They leave together,
/// after the last has burnt out and before the stage does, at rest against the body, with what their tanks
/// have left. The aerodynamics of the first stack include them and stay after they have left.
///
/// Each is a body of its own: it has its place, its burn, its nozzle, and a centre of gravity off the
/// vehicle's axis. A file with their number in place of their angles has them at equal angles (SpreadOut()),
/// with nozzles that are fixed along the axis.
struct Boosters {
  int count = 0;                    ///< 0: none
  double dry_mass_kg = 0.0;         ///< of one, a thin tube from top to bottom station
  double propellant_mass_kg = 0.0;  ///< of one
  double radius_m = 0.0;            ///< of their axes from the vehicle's
  double diameter_m = 0.0;          ///< of one
  double top_station_m = 0.0;
  double bottom_station_m = 0.0;
  double nozzle_station_m = 0.0;         ///< where the thrust acts
  Motor motor;                           ///< of one
  Grain grain;                           ///< of one, about its own axis, of a solid motor
  double separation_delay_s = 0.0;       ///< after burnout is detected
  std::vector<double> angles_rad = {};   ///< of each, from body y towards body z
  double cant_rad = 0.0;                 ///< by which the thrust is turned towards the vehicle's axis
  Gimbal gimbal = {};                    ///< its drives (a limit of 0: the nozzles are fixed)
  std::vector<double> towards_rad = {};  ///< their hinges, as of a Nozzle
  bool steer_alone = false;              ///< the stage's own nozzles stay centred while they burn
  double attachment_station_m = 0.0;     ///< of the stage, which carries them there (0: not given)
  std::vector<Tank> tanks = {};          ///< of one, about its own axis, of a liquid engine, else empty
  bool are_spread = false;               ///< the angles are not the file's: SpreadOut() has set them

  bool turn_nozzles() const { return gimbal.limit_rad > 0.0; }
  bool is_liquid() const { return !tanks.empty(); }
  /// Mass of all boosters with their propellant.
  double LiftOffMass() const { return count * (dry_mass_kg + propellant_mass_kg); }
};

/// Gives boosters without angles equal ones, the first one at body y.
inline void SpreadOut(Boosters& boosters) {
  if (!boosters.angles_rad.empty()) return;
  for (int k = 0; k < boosters.count; ++k) boosters.angles_rad.push_back(2.0 * kPi * k / boosters.count);
  boosters.are_spread = true;
}

/// The drives of nozzles without pivots and delay of their own: a booster's.
inline void DescribeDrives(Fields& fields, Boosters& boosters) {
  Gimbal& gimbal = boosters.gimbal;
  fields.Quantities("turns_towards", kAngle, Between(-2.0 * kPi, 2.0 * kPi), 1, 2, boosters.towards_rad,
                    "for each hinge, the direction in which a positive angle turns the thrust, from body y "
                    "towards body z");
  fields.Quantity("limit", kAngle, Inside(0.0, kQuarterTurn), gimbal.limit_rad,
                  "of each drive, and of the total deflection");
  fields.Quantity("rate_limit", kAngularRate, kPositive, gimbal.rate_limit_rad_s, "of each drive");
  fields.Quantity("bandwidth", kFrequency, kPositive, gimbal.bandwidth_rad_s,
                  "natural frequency of the second-order actuator");
  fields.Number("damping_ratio", kPositive, gimbal.damping_ratio, "of the actuator");
  fields.Flag("steer_alone", boosters.steer_alone, false,
              "the stage's own nozzles stay centred while any booster burns");
}

inline void Describe(Fields& fields, Boosters& boosters) {
  const auto each = [&] {
    fields.Quantities("angles", kAngle, Between(-2.0 * kPi, 2.0 * kPi), 1, kMaxBoosters, boosters.angles_rad,
                      "place of each, from body y towards body z, in place of count; each flies as a body of "
                      "its own");
    if (!boosters.angles_rad.empty()) boosters.count = static_cast<int>(boosters.angles_rad.size());
    fields.Quantity("cant", kAngle, {0.0, 0.25 * kPi, false, true}, boosters.cant_rad,
                    "by which each thrust is turned towards the vehicle's axis", 0.0);
    bool turn = boosters.turn_nozzles();
    fields.OptionalMap("gimbal", turn, "drives of their nozzles, at nozzle_station; default: fixed",
                       [&](Fields& gimbal) { DescribeDrives(gimbal, boosters); });
  };
  fields.Either({{Has("angles", kAngle), each, !boosters.angles_rad.empty() && !boosters.are_spread},
                 {Else(), [&] {
                    constexpr const char* kAlike =
                        "boosters without angles are all alike, with fixed nozzles";
                    fields.Misplaced("cant", kAngle, kAlike, "angles_deg in place of count");
                    fields.Misplaced("gimbal", {}, kAlike, "angles_deg in place of count");
                    fields.Integer("count", 2, kMaxBoosters, boosters.count,
                                   "number of equal boosters, at equal angles");
                    SpreadOut(boosters);
                  }}});
  fields.Quantity("dry_mass", kMass, kPositive, boosters.dry_mass_kg,
                  "of one: a thin tube from top to bottom station");
  fields.Quantity("propellant_mass", kMass, kPositive, boosters.propellant_mass_kg, "of one");
  fields.Quantity("radius", kLength, kPositive, boosters.radius_m, "from the vehicle's axis to theirs");
  fields.Quantity("diameter", kLength, kPositive, boosters.diameter_m, "of one");
  fields.Quantity("top_station", kLength, kNonNegative, boosters.top_station_m, "upper end");
  fields.Quantity("bottom_station", kLength, kPositive, boosters.bottom_station_m, "lower end");
  fields.Quantity("nozzle_station", kLength, kPositive, boosters.nozzle_station_m, "where the thrust acts");
  DescribePropulsion(fields, boosters.motor, boosters.grain, boosters.tanks);
  fields.Quantity("separation_delay", kTime, kNonNegative, boosters.separation_delay_s,
                  "from detected burnout of the last; before the stage separates", 0.0);
  fields.Deciding(Decides::kFlightOnly, [&] {
    fields.Quantity("attachment_station", kLength, kPositive, boosters.attachment_station_m,
                    "of the stage, which carries them there by a rigid link; bending and section loads "
                    "need it",
                    0.0);
  });
}

}  // namespace dispersa
