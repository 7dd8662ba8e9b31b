// Thrust vector control of a stage as its file describes it.
#pragma once

#include <string>
#include <vector>

#include "core/input/fields.h"
#include "core/vehicle/nozzle_layout.h"

namespace dispersa {

/// One nozzle of a list (core/vehicle/nozzle_layout.h).
struct Nozzle {
  std::string name;
  double y_m = 0.0, z_m = 0.0;
  double thrust_share = 1.0;
  /// None: the nozzle is fixed, two: at right angles.
  std::vector<double> towards_rad = {};
  double limit_rad = 0.0;
};

/// One of `count` nozzles.
inline void Describe(Fields& fields, Nozzle& nozzle, std::size_t count) {
  fields.Text("name", nozzle.name, "used by dispersions");
  fields.Quantity("y", kLength, kAnyNumber, nozzle.y_m, "of its pivot, off the axis to the right", 0.0);
  fields.Quantity("z", kLength, kAnyNumber, nozzle.z_m, "of its pivot, off the axis downwards", 0.0);
  fields.Number("thrust_share", UpTo(1.0), nozzle.thrust_share,
                "of the stage's thrust; default: equal shares", 1.0 / static_cast<double>(count));
  fields.Quantities("turns_towards", kAngle, Between(-2.0 * kPi, 2.0 * kPi), 0, 2, nozzle.towards_rad,
                    "for each hinge, the direction in which a positive angle turns the thrust, from body y "
                    "towards body z; none: fixed");
  fields.Quantity("limit", kAngle, Inside(0.0, kQuarterTurn), nozzle.limit_rad,
                  "of its total deflection; default: the gimbal's", 0.0);
}

/// Without a list: four nozzles at 90°, each hinged in one plane. Two serve pitch (right, left), two yaw
/// (bottom, top), all four together, differentially, roll.
struct Gimbal {
  double pivot_station_m = 0.0;
  double radius_m = 0.0;             ///< the paper's z_r
  std::vector<Nozzle> nozzles = {};  ///< in place of the cross
  double limit_rad = 0.0;
  double rate_limit_rad_s = 0.0;
  double bandwidth_rad_s = 0.0;
  double damping_ratio = 0.7;
  int delay_ticks = 1;
  double nozzle_mass_kg = 0.0;  ///< 0: turning a nozzle takes no momentum
  double nozzle_cg_m = 0.0;
  double nozzle_inertia_kg_m2 = 0.0;
  // Further properties of a real drive (0: not this one).
  double dead_zone_rad = 0.0;
  double friction_rad = 0.0;  ///< Coulomb's
  double resolution_rad = 0.0;
};

inline void Describe(Fields& fields, Gimbal& gimbal) {
  fields.Quantity("pivot_station", kLength, kPositive, gimbal.pivot_station_m, "of the hinges");
  fields.List("nozzles", 0, kNozzles, gimbal.nozzles, "instead of four in a cross",
              [&](Fields& item, Nozzle& nozzle, std::size_t count) { Describe(item, nozzle, count); });
  fields.Unless(Has("nozzles"), [&] {
    fields.Quantity("radius", kLength, kPositive, gimbal.radius_m,
                    "from the axis to the centres of four nozzles in a cross");
  });
  fields.Quantity("limit", kAngle, Inside(0.0, kQuarterTurn), gimbal.limit_rad, "of each drive");
  fields.Quantity("rate_limit", kAngularRate, kPositive, gimbal.rate_limit_rad_s, "of each drive");
  fields.Quantity("bandwidth", kFrequency, kPositive, gimbal.bandwidth_rad_s,
                  "natural frequency of the second-order actuator");
  fields.Number("damping_ratio", kPositive, gimbal.damping_ratio, "of the actuator");
  fields.Integer("delay_ticks", 0, 50, gimbal.delay_ticks,
                 "ticks of the autopilot between command and actuator");
  fields.Quantity("dead_zone", kAngle, kNonNegative, gimbal.dead_zone_rad,
                  "largest error to which the servo does not react", 0.0);
  fields.Quantity("friction", kAngle, kNonNegative, gimbal.friction_rad,
                  "error at which a drive at rest starts to move", 0.0);
  fields.Quantity("resolution", kAngle, kNonNegative, gimbal.resolution_rad,
                  "step of the command at the servo", 0.0);
}

/// The turning mass of one nozzle. In a list each stage has its own entry.
inline void DescribeTurningNozzle(Fields& fields, Gimbal& gimbal) {
  fields.Quantity("mass", kMass, kPositive, gimbal.nozzle_mass_kg, "of the turning part of one nozzle");
  fields.Quantity("cg_aft_of_pivot", kLength, kAnyNumber, gimbal.nozzle_cg_m, "of its centre of gravity");
  fields.Quantity("inertia_about_hinge", kInertia, kPositive, gimbal.nozzle_inertia_kg_m2, "of that part");
}

}  // namespace dispersa
