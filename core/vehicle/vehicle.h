// The launch vehicle as its file describes it: plain data, SI and radians.
//
// Stations are distances aft of the nose tip of the full vehicle, along the axis. They do not change when a
// stage separates. Body axes: x forward, y right, z down at launch attitude zero roll.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/input/fields.h"
#include "core/math/linear.h"
#include "core/math/stages.h"
#include "core/math/table.h"
#include "core/vehicle/aero_table.h"
#include "core/vehicle/bodies.h"
#include "core/vehicle/boosters.h"
#include "core/vehicle/descent.h"
#include "core/vehicle/fins.h"
#include "core/vehicle/gimbal.h"
#include "core/vehicle/loss_of_control.h"
#include "core/vehicle/mass_table.h"
#include "core/vehicle/motor.h"
#include "core/vehicle/propulsion_fields.h"
#include "core/vehicle/rail.h"
#include "core/vehicle/sensors.h"
#include "core/vehicle/spin_motors.h"
#include "core/vehicle/structure_beam.h"

namespace dispersa {

/// Inputs and metrics have one column for each stage. Vehicles with at most this many stages have this many
/// columns, others kMaxStages.
inline constexpr int kUsualStages = 4;

enum class IgnitionTrigger {
  kLiftOff,           ///< the first stage
  kBurnoutDetection,  ///< `delay_s` after the stage below has separated
  kTimer,             ///< at the flight program's time since lift-off
};

struct Stage {
  std::string name;
  double liftoff_mass_kg = 0.0;  ///< this stage and everything above it (Table 1)
  double propellant_mass_kg = 0.0;
  double diameter_m = 0.0;
  double bottom_station_m = 0.0;  ///< where the stack ends while this stage is its lowest
  Motor motor;
  Grain grain;                         ///< of a solid motor
  std::vector<Tank> tanks;             ///< of a liquid stage, else empty (their propellant is the stage's)
  std::vector<MassElement> structure;  ///< the dry mass, in fractions that sum to 1
  std::vector<Jettison> jettisoned;
  std::vector<FinSet> fins;   ///< they leave with the stage
  MassTable mass_table;       ///< as its file gives it (empty: the tubes above)
  StageMassTable flown_mass;  ///< the same as it flies
  /// As it flies: of the first tank's flow over the others', against the ratio of their loads (MixtureOf).
  double mixture_ratio_factor = 1.0;
  Gimbal gimbal;
  std::optional<SpinMotors> spin_motors;  ///< of a stage without gimbal
  IgnitionTrigger ignition = IgnitionTrigger::kLiftOff;
  double ignition_delay_s = 0.0;    ///< after separation of the stage below (kBurnoutDetection)
  double separation_delay_s = 0.0;  ///< after burnout detection, without effect for the last stage
  /// The stage before burns again: the same body, with the remaining propellant. Nothing separates in
  /// between. Each burn counts as a stage of its own.
  bool restarts = false;

  bool is_liquid() const { return !tanks.empty(); }
  bool is_controlled() const { return !gimbal.fixed; }
  /// Station of the propellant's top, for all tanks together.
  double PropellantTop() const;
  double PropellantBottom() const;
};

inline void DescribeIgnition(Fields& fields, Stage& stage) {
  fields.Map("ignition", "event that ignites the stage", [&](Fields& ignition) {
    ignition.Choice<IgnitionTrigger>("trigger",
                                     {{"lift_off", IgnitionTrigger::kLiftOff},
                                      {"burnout_detection", IgnitionTrigger::kBurnoutDetection},
                                      {"timer", IgnitionTrigger::kTimer}},
                                     stage.ignition,
                                     "lift-off; separation of the stage below; or the flight program's "
                                     "timer, after a coast under reaction control");
    ignition.Quantity("delay", kTime, kNonNegative, stage.ignition_delay_s,
                      "after separation of the stage below", 0.0);
  });
}

inline void Describe(Fields& fields, Stage& stage) {
  fields.Flag(
      "restarts", stage.restarts, false,
      "the liquid stage before burns again, with what is left. Its jettisoned masses may leave in any burn");
  fields.Text("name", stage.name, "name of the stage");
  fields.Either(
      {{Is("restarts", {"true"}), [&] { DescribeCommands(fields, stage.motor); }},
       {Else(), [&] {
          fields.Quantity("liftoff_mass", kMass, kPositive, stage.liftoff_mass_kg,
                          "of this stage and all above it (Table 1)");
          fields.Quantity("propellant_mass", kMass, kPositive, stage.propellant_mass_kg, "at ignition");
          fields.Quantity("diameter", kLength, kPositive, stage.diameter_m, "of its body");
          fields.Quantity("bottom_station", kLength, kPositive, stage.bottom_station_m,
                          "aft end of the stack, while this stage is its lowest");
          DescribePropulsion(fields, stage.motor, stage.grain, stage.tanks);
          fields.List("structure", 1, SIZE_MAX, stage.structure,
                      "elements of its dry mass; the fractions add up to 1");
          bool has_table = !stage.mass_table.empty();
          fields.OptionalTable("mass_table", has_table,
                               "mass properties of the stage alone, in place of its tubes, or their CSV file",
                               [&](Fields& table) { Describe(table, stage.mass_table); });
          fields.List("jettisoned", 0, kMaxJettisons, stage.jettisoned,
                      "masses on the axis, jettisoned while the stage is attached: fairing, tower, skirt");
          fields.List("fins", 0, 4, stage.fins,
                      "sets of fins; computed aerodynamics have their forces, tables have their own");
          const auto gimbal = [&] {
            fields.Map("gimbal", "actuators of the nozzle",
                       [&](Fields& map) { Describe(map, stage.gimbal); });
          };
          fields.Either(
              {{Has("gimbal"), gimbal},
               {Has("nozzle_station", kLength),
                [&] {
                  stage.gimbal = FixedNozzle(stage.gimbal.pivot_station_m);
                  fields.Quantity("nozzle_station", kLength, kPositive, stage.gimbal.pivot_station_m,
                                  "in place of a gimbal: where the thrust acts, along the axis; "
                                  "nothing controls the stage");
                  bool spins = stage.spin_motors.has_value();
                  fields.OptionalMap("spin_motors", spins, "a roll moment from ignition on",
                                     [&](Fields& spin) { Describe(spin, stage.spin_motors.emplace()); });
                  if (!spins) stage.spin_motors.reset();
                },
                stage.gimbal.fixed},
               {Else(), gimbal}});
        }}});
  DescribeIgnition(fields, stage);
  fields.Quantity("separation_delay", kTime, kNonNegative, stage.separation_delay_s,
                  "from detected burnout; the last stage does not separate", 0.0);
}

/// Cold-gas couples about each axis, on the stack of the last stage: torque without net force.
struct ReactionControl {
  double thrust_n = 0.0;
  double pitch_yaw_arm_m = 0.0;
  double roll_arm_m = 0.0;
  double specific_impulse_s = 0.0;
  double minimum_on_time_s = 0.0;
};

inline void Describe(Fields& fields, ReactionControl& control) {
  fields.Quantity("thrust", kForce, kPositive, control.thrust_n, "of one thruster; they fire in pairs");
  fields.Quantity("pitch_yaw_arm", kLength, kPositive, control.pitch_yaw_arm_m,
                  "half the distance between the two thrusters of a couple");
  fields.Quantity("roll_arm", kLength, kPositive, control.roll_arm_m, "the same for a roll couple");
  fields.Quantity("specific_impulse", kTime, kPositive, control.specific_impulse_s, "of the thrusters");
  fields.Quantity("minimum_on_time", kTime, kPositive, control.minimum_on_time_s,
                  "shortest firing of a thruster");
}

enum class ProfileShape { kTangentOgive, kCone, kCylinder, kFrustum };

/// A piece of the outer mould line. The pieces follow one another from the nose tip aft.
struct ProfileSection {
  ProfileShape shape = ProfileShape::kCylinder;
  double length_m = 0.0;
  double aft_diameter_m = 0.0;  ///< the fore diameter is that of the section before, or 0 at the nose tip
};

inline void Describe(Fields& fields, ProfileSection& section) {
  fields.Choice<ProfileShape>("shape",
                              {{"tangent_ogive", ProfileShape::kTangentOgive},
                               {"cone", ProfileShape::kCone},
                               {"cylinder", ProfileShape::kCylinder},
                               {"frustum", ProfileShape::kFrustum}},
                              section.shape, "of the piece");
  fields.Quantity("length", kLength, kPositive, section.length_m, "along the axis");
  fields.Quantity("aft_diameter", kLength, kPositive, section.aft_diameter_m,
                  "aft; its fore diameter is that of the piece before, 0 at the tip");
}

/// Limits of the structure (0: not given). core/flight/structural_limits.h names the load of each limit.
struct StructuralLimits {
  double q_max_pa = 0.0;
  double q_alpha_pa_rad = 0.0;
  double axial_load_g = 0.0;
  double lateral_load_g = 0.0;
  double bending_moment_n_m = 0.0;
  bool terminate = false;  ///< end the flight as `structural_limit`, else only flag it
};

inline void Describe(Fields& fields, StructuralLimits& limits) {
  fields.Quantity("q_max", kPressure, kPositive, limits.q_max_pa, "dynamic pressure", 0.0);
  fields.Quantity("q_alpha", kPressureAngle, kPositive, limits.q_alpha_pa_rad,
                  "dynamic pressure times incidence", 0.0);
  fields.Quantity("axial_load", kAcceleration, kPositive, limits.axial_load_g,
                  "specific force along the axis", 0.0);
  fields.Quantity("lateral_load", kAcceleration, kPositive, limits.lateral_load_g,
                  "specific force across the axis", 0.0);
  fields.Quantity("bending_moment", kMoment, kPositive, limits.bending_moment_n_m, "at any station", 0.0);
  fields.Flag("terminate", limits.terminate, false,
              "a violation ends the flight as structural_limit; false: it is only flagged");
}

struct LaunchSite {
  double latitude_rad = 0.0;  ///< geodetic
  double longitude_rad = 0.0;
  double altitude_m = 0.0;  ///< geodetic, of the vehicle's CG at rest
};

inline void Describe(Fields& fields, LaunchSite& site) {
  fields.Quantity("latitude", kAngle, Between(-kQuarterTurn, kQuarterTurn), site.latitude_rad, "geodetic");
  fields.Quantity("longitude", kAngle, Between(-kHalfTurn, kHalfTurn), site.longitude_rad, "east");
  fields.Quantity("altitude", kLength, Between(-500.0, 9000.0), site.altitude_m,
                  "geodetic, of the vehicle's centre of gravity at rest");
}

struct Vehicle {
  std::string name;
  bool made_up = false;  ///< it need not be possible: a textbook's coefficients, a limiting case
  LaunchSite site;
  double hold_down_s = 0.0;             ///< stage 1 burns this long before release (lift-off is time 0)
  bool jet_damping = true;              ///< moment of the flow from CG to nozzle on a turning vehicle
  bool flow_coriolis = true;            ///< force of that flow, and the motion of the CG through the body
  std::vector<Stage> stages;            ///< in the order of flight
  Boosters boosters;                    ///< of the first stage, part of its lift-off mass
  std::vector<ProfileSection> profile;  ///< outer mould line of the full vehicle
  double surface_roughness_m = 0.0;     ///< equivalent sand grain, for skin friction
  std::vector<AeroTable> aerodynamics;  ///< one a stack (empty: built up from the profile)
  ReactionControl reaction_control;
  StructuralLimits limits;
  LossOfControl loss_of_control;
  std::optional<Rail> rail;  ///< none: it stands free
  Descent descent;
  Sensors sensors;
  std::optional<StructureBeam> structure_beam;  ///< none: the vehicle is rigid
};

/// Keys on which no other key depends.
inline void DescribePlainKeys(Fields& fields, Vehicle& vehicle) {
  fields.Text("name", vehicle.name, "of the vehicle");
  fields.Map("site", "launch site", [&](Fields& site) { Describe(site, vehicle.site); });
  fields.Quantity("hold_down", kTime, kNonNegative, vehicle.hold_down_s,
                  "burn of stage 1 before release; lift-off is time 0", 0.0);
  fields.Flag("made_up", vehicle.made_up, false,
              "not a real vehicle: impossible values (frozen coefficients) give warnings, not errors");
  fields.Flag("jet_damping", vehicle.jet_damping, true, "moment of the flow through a turning vehicle");
  fields.Flag("flow_coriolis", vehicle.flow_coriolis, true,
              "Coriolis force of that flow, and motion of the centre of gravity in the body");
  fields.Quantity("surface_roughness", kLength, kNonNegative, vehicle.surface_roughness_m,
                  "equivalent sand grain size, for skin friction", 0.0);
}
/// All keys.
void Describe(Fields& fields, Vehicle& vehicle);

/// The last burn of the stage whose burn this is: itself unless the next one restarts it.
int LastBurn(const Vehicle& vehicle, int stage);
/// Whether some engine is cut off at a velocity or by guidance: when it will is known only in flight.
bool CutsOffInFlight(const Vehicle& vehicle);

/// Whether bending moments are known: of a body with a profile, and of one with boosters where the station is
/// known at which it carries them.
bool HasSectionLoads(const Vehicle& vehicle);
/// Contradictions within a vehicle.
std::vector<StructProblem> Problems(const Vehicle& vehicle);

}  // namespace dispersa
