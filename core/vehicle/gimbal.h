// Thrust vector control of a stage as its file describes it.
#pragma once

#include <string>
#include <vector>

#include "core/input/fields.h"
#include "core/vehicle/nozzle_layout.h"

namespace dispersa {

/// Equal nozzles at equal angles on a circle about the axis.
struct NozzleRing {
  int count = 1;  ///< 1: a single nozzle, no ring
  double radius_m = 0.0;
  double first_rad = 0.0;  ///< place of the first, from body y towards body z
  bool turned = false;     ///< hinges are named from each one's own place on, not from body y on
};

inline void Describe(Fields& fields, NozzleRing& ring) {
  fields.Integer("count", 2, kListedNozzles, ring.count, "of equal nozzles at equal angles");
  fields.Quantity("radius", kLength, kPositive, ring.radius_m, "from the axis to their pivots");
  fields.Quantity("first", kAngle, Between(-2.0 * kPi, 2.0 * kPi), ring.first_rad,
                  "place of the first, from body y towards body z", 0.0);
  fields.Choice<bool>("hinges_from", {{"body", false}, {"place", true}}, ring.turned,
                      "where turns_towards counts from: body y, or each one's own place (90: along the ring)",
                      false);
}

/// An entry of a list of nozzles (core/vehicle/nozzle_layout.h): one nozzle, or a ring.
struct Nozzle {
  std::string name;
  double y_m = 0.0, z_m = 0.0;
  double thrust_share = 0.0;  ///< of each (0: equal parts of what others leave)
  /// None: the nozzle is fixed, two: at right angles.
  std::vector<double> towards_rad = {};
  double limit_rad = 0.0;
  NozzleRing ring = {};
  std::string group = {};  ///< empty: it has commands of its own
};

inline void Describe(Fields& fields, Nozzle& nozzle) {
  fields.Text("name", nozzle.name, "used by dispersions; nozzles of a ring get a number behind it");
  bool is_ring = nozzle.ring.count > 1;
  fields.OptionalMap("ring", is_ring, "several equal nozzles in place of one",
                     [&](Fields& ring) { Describe(ring, nozzle.ring); });
  fields.Unless(Has("ring"), [&] {
    fields.Quantity("y", kLength, kAnyNumber, nozzle.y_m, "of its pivot, off the axis to the right", 0.0);
    fields.Quantity("z", kLength, kAnyNumber, nozzle.z_m, "of its pivot, off the axis downwards", 0.0);
  });
  fields.Number("thrust_share", Between(0.0, 1.0), nozzle.thrust_share,
                "of the stage's thrust, of each; 0: equal parts of what the others leave", 0.0);
  fields.Quantities("turns_towards", kAngle, Between(-2.0 * kPi, 2.0 * kPi), 0, 2, nozzle.towards_rad,
                    "for each hinge, the direction in which a positive angle turns the thrust, from body y "
                    "towards body z; none: fixed");
  fields.Quantity("limit", kAngle, Inside(0.0, kQuarterTurn), nozzle.limit_rad,
                  "of its total deflection; default: the gimbal's", 0.0);
  fields.Text("group", nozzle.group, "nozzles with the same word share one command of each hinge", "");
}

/// Without a list: four nozzles at 90°, each hinged in one plane. Two serve pitch (right, left), two yaw
/// (bottom, top), all four together, differentially, roll.
struct Gimbal {
  double pivot_station_m = 0.0;
  double radius_m = 0.0;             ///< the paper's z_r
  std::vector<Nozzle> nozzles = {};  ///< in place of the cross, as listed (NozzlesOf)
  double limit_rad = 0.0;
  double rate_limit_rad_s = 0.0;
  double bandwidth_rad_s = 0.0;
  double damping_ratio = 0.7;
  int delay_ticks = 1;
  /// No gimbal: the thrust acts along the axis at the pivot station. Drives stay at rest.
  bool fixed = false;
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
  fields.List("nozzles", 0, kListedNozzles, gimbal.nozzles,
              "instead of four in a cross: nozzles and rings of them, 33 in all");
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
  fields.Deciding(Decides::kFlightOnly, [&] {
    fields.Quantity("dead_zone", kAngle, kNonNegative, gimbal.dead_zone_rad,
                    "largest error to which the servo does not react", 0.0);
    fields.Quantity("friction", kAngle, kNonNegative, gimbal.friction_rad,
                    "error at which a drive at rest starts to move", 0.0);
    fields.Quantity("resolution", kAngle, kNonNegative, gimbal.resolution_rad,
                    "step of the command at the servo", 0.0);
  });
}

/// In place of a gimbal. Its drives stay at rest. Their numbers are finite, and nothing reads them.
inline Gimbal FixedNozzle(double station_m) {
  Gimbal gimbal;
  gimbal.fixed = true;
  gimbal.pivot_station_m = station_m;
  gimbal.rate_limit_rad_s = gimbal.bandwidth_rad_s = 1.0;
  gimbal.delay_ticks = 0;
  return gimbal;
}

/// The turning mass of one nozzle. In a list each stage has its own entry.
inline void DescribeTurningNozzle(Fields& fields, Gimbal& gimbal) {
  fields.Quantity("mass", kMass, kPositive, gimbal.nozzle_mass_kg, "of the turning part of one nozzle");
  fields.Quantity("cg_aft_of_pivot", kLength, kAnyNumber, gimbal.nozzle_cg_m, "of its centre of gravity");
  fields.Quantity("inertia_about_hinge", kInertia, kPositive, gimbal.nozzle_inertia_kg_m2, "of that part");
}

}  // namespace dispersa
