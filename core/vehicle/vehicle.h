// The launch vehicle as its file describes it: plain data, SI and radians.
//
// Stations are distances aft of the nose tip of the full vehicle, along the axis; they do not change when
// a stage separates. Body axes: x forward, y right, z down at launch attitude zero roll.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/math/linear.h"
#include "core/math/table.h"
#include "core/vehicle/nozzle_layout.h"
#include "core/vehicle/structure_beam.h"
#include "core/vehicle/thrust_curve.h"

namespace dispersa {

/// The largest number of stages.
inline constexpr int kMaxStages = 6;
/// Inputs and metrics have one column a stage: of vehicles with up to so many stages this many, of others
/// kMaxStages.
inline constexpr int kUsualStages = 4;

/// A homogeneous hollow or solid cylinder on the axis: the building block of mass properties.
struct MassElement {
  std::string name;
  double fraction = 0.0;  ///< of the stage's dry mass
  double top_station_m = 0.0;
  double bottom_station_m = 0.0;
  double outer_diameter_m = 0.0;
  double inner_diameter_m = 0.0;
};

/// Solid propellant: a tube that burns from its bore outwards, so its length and station stay.
struct Grain {
  double top_station_m = 0.0;
  double bottom_station_m = 0.0;
  double outer_diameter_m = 0.0;
  double inner_diameter_m = 0.0;  ///< of the bore at ignition
};

/// Liquid propellant in an upright cylinder with flat ends, round the axis. It drains at the bottom: the liquid stands
/// there, and its surface falls.
struct Tank {
  std::string name;
  double top_station_m = 0.0;
  double bottom_station_m = 0.0;
  double diameter_m = 0.0;  ///< inside
  double propellant_mass_kg = 0.0;  ///< at ignition, with what stays as residual
  double density_kg_m3 = 0.0;

  double Volume() const;  ///< m³, of the tank
};

/// What the engine of a liquid stage does by command: thrust as a part of its full one over the time since ignition,
/// linear between the times, and when it ends. Thrust and flow are in proportion whatever the level.
struct Throttle {
  std::vector<double> time_s;  ///< from 0, each larger than the one before; empty: full thrust throughout
  std::vector<double> level;   ///< 0 to 1; the last one holds. A last one of 0 ends the burn

  bool empty() const { return time_s.empty(); }
};
enum class CutOff {
  kAtDepletion,  ///< when all but the residual has flown
  kAtTime,       ///< `cut_off_s` after ignition, or by depletion if that comes first
  kAtVelocity,   ///< at the inertial speed `cut_off_velocity_m_s`, or by depletion if that comes first
};

/// Constant thrust between two linear ramps whose impulse is part of the whole, or a thrust curve: propellant
/// flow is proportional to thrust, unless the curve gives it, and the propellant is used up exactly at burnout.
struct Motor {
  double thrust_n = 0.0;  ///< all four nozzles together (the paper's 4P), in vacuum; of a curve the greatest
  double burning_time_s = 0.0;      ///< propellant_mass / burning_time is the flow at full thrust
  double ignition_rise_s = 0.0;     ///< linear rise to full thrust
  double tail_off_s = 0.0;          ///< linear decay at the end
  double nozzle_exit_area_m2 = 0.0; ///< of all nozzles; P = P_vac - p A_e; 0 switches the term off
  double published_mass_flow_kg_s = 0.0;  ///< as printed in the source, 0 if none; only compared
  ThrustCurve thrust_curve = {};          ///< empty: none. Sets thrust_n and burning_time_s; without ramps
  // Of a liquid stage; without ramps and curve. thrust_n is at full thrust, burning_time_s what all propellant would
  // last at that.
  Throttle throttle = {};
  CutOff cut_off = CutOff::kAtDepletion;
  double cut_off_s = 0.0;
  double cut_off_velocity_m_s = 0.0;
  double residual_mass_kg = 0.0;  ///< of the propellant: never flows
};
/// Gives a motor a curve, and the greatest thrust and the time that its propellant would last at the greatest flow.
void SetThrustCurve(ThrustCurve curve, Motor& motor);

/// One nozzle of a list (core/vehicle/nozzle_layout.h).
struct Nozzle {
  std::string name;
  double y_m = 0.0, z_m = 0.0;  ///< of its pivot, off the axis: right, down
  double thrust_share = 1.0;    ///< of the stage's thrust
  /// Directions towards which positive angles of its hinges turn the thrust, from body y towards body z;
  /// none: the nozzle is fixed, two: at right angles.
  std::vector<double> towards_rad = {};
  double limit_rad = 0.0;  ///< of its whole deflection, as commanded; 0: the gimbal's
};

/// Without a list four nozzles at 90°, each hinged in one plane: two for pitch (right, left), two for yaw
/// (bottom, top); all four differentially for roll.
struct Gimbal {
  double pivot_station_m = 0.0;
  double radius_m = 0.0;             ///< of the cross's nozzle centres from the axis (the paper's z_r)
  std::vector<Nozzle> nozzles = {};  ///< in place of the cross
  double limit_rad = 0.0;            ///< of each drive
  double rate_limit_rad_s = 0.0;
  double bandwidth_rad_s = 0.0;   ///< natural frequency of the second-order actuator
  double damping_ratio = 0.7;
  int delay_ticks = 1;            ///< whole autopilot ticks between command and actuator
  double nozzle_mass_kg = 0.0;    ///< what turns, of one nozzle; 0: turning it takes no momentum
  double nozzle_cg_m = 0.0;       ///< its centre of gravity, aft of the pivot
  double nozzle_inertia_kg_m2 = 0.0;  ///< about the hinge
  // What a real drive has besides; 0: not this one.
  double dead_zone_rad = 0.0;  ///< distance from the command that does not move the servo yet
  double friction_rad =
      0.0;  ///< Coulomb's: the distance from the command at which a drive at rest breaks loose
  double resolution_rad = 0.0;  ///< step in which the command reaches the servo
};

/// What makes the flight computer let go of a mass.
enum class JettisonTrigger {
  kAtTime,      ///< s since lift-off
  kAtAltitude,  ///< m, geodetic
  kAtHeatFlux,  ///< W/m², free-molecular: has fallen to this; Jettison says where it counts
};

/// A mass on the axis that leaves while a stage is attached: fairing, skirt, escape tower. A tube, let go of
/// at rest against the body: no impulse, no flow about it; what is left keeps its aerodynamics.
struct Jettison {
  std::string name;
  double mass_kg = 0.0;  ///< part of the stage's lift-off mass, beside its dry mass
  double top_station_m = 0.0;
  double bottom_station_m = 0.0;
  double outer_diameter_m = 0.0;
  double inner_diameter_m = 0.0;
  JettisonTrigger trigger = JettisonTrigger::kAtTime;
  double threshold = 0.0;
};
/// Of a vehicle, at most.
inline constexpr int kMaxJettisons = 8;

enum class IgnitionTrigger {
  kLiftOff,           ///< the first stage
  kBurnoutDetection,  ///< `delay_s` after the stage below has separated
  kTimer,             ///< at the flight program's time since lift-off
};

struct Stage {
  std::string name;
  double liftoff_mass_kg = 0.0;     ///< this stage and everything above it (Table 1)
  double propellant_mass_kg = 0.0;
  double diameter_m = 0.0;
  double bottom_station_m = 0.0;    ///< where the stack ends while this stage is its lowest
  Motor motor;
  Grain grain;               ///< of a solid motor
  std::vector<Tank> tanks;   ///< of a liquid stage, else empty; their propellant is the stage's
  std::vector<MassElement> structure;  ///< the dry mass; the fractions sum to 1
  std::vector<Jettison> jettisoned;
  Gimbal gimbal;
  IgnitionTrigger ignition = IgnitionTrigger::kLiftOff;
  double ignition_delay_s = 0.0;    ///< after separation of the stage below (kBurnoutDetection)
  double separation_delay_s = 0.0;  ///< after burnout detection; the last stage does not separate
  /// It is the stage before, whose engine burns again: the same body, with the propellant that was left.
  /// Nothing separates in between. Each burn counts as a stage of its own.
  bool restarts = false;

  bool is_liquid() const { return !tanks.empty(); }
  /// Where its propellant is, of all tanks together.
  double PropellantTop() const;
  double PropellantBottom() const;
};

/// Cold-gas couples about each axis, on the stack of the last stage: torque without net force.
struct ReactionControl {
  double thrust_n = 0.0;              ///< of one thruster; two fire at a time
  double pitch_yaw_arm_m = 0.0;       ///< half the distance between the two thrusters of a couple
  double roll_arm_m = 0.0;
  double specific_impulse_s = 0.0;
  double minimum_on_time_s = 0.0;     ///< minimum impulse bit / thrust
};

/// Solid motors beside the first stage, all alike, at equal angles round it and ignited with it. Their nozzles are
/// fixed, along the axis. They leave together after they have burnt out, at rest against the body, ahead of the
/// stage's burnout; the aerodynamics of the first stack are theirs too, and stay.
struct Boosters {
  int count = 0;                    ///< 0: none; else 2 to 8
  double dry_mass_kg = 0.0;         ///< of one, a thin tube from top to bottom station
  double propellant_mass_kg = 0.0;  ///< of one
  double radius_m = 0.0;            ///< of their axes from the vehicle's
  double diameter_m = 0.0;          ///< of one
  double top_station_m = 0.0;
  double bottom_station_m = 0.0;
  double nozzle_station_m = 0.0;    ///< where the thrust acts
  Motor motor;                      ///< of one
  Grain grain;                      ///< of one, about its own axis
  double separation_delay_s = 0.0;  ///< after burnout is detected

  /// Of all of them, with their propellant.
  double LiftOffMass() const { return count * (dry_mass_kg + propellant_mass_kg); }
};
/// Boosters at most.
inline constexpr int kMaxBoosters = 8;

enum class ProfileShape { kTangentOgive, kCone, kCylinder, kFrustum };

/// A piece of the outer mould line; the pieces follow one another from the nose tip aft.
struct ProfileSection {
  ProfileShape shape = ProfileShape::kCylinder;
  double length_m = 0.0;
  double aft_diameter_m = 0.0;  ///< the fore diameter is the section's before; 0 at the nose tip
};

/// Aerodynamic coefficients of one stack (the stages still attached) over Mach number and total
/// incidence, in body axes: F = -q S (CA x + CN n), n the direction of the cross-flow.
/// Outside the grid the end value holds.
struct AeroTable {
  double reference_area_m2 = 0.0;
  double reference_length_m = 0.0;      ///< the diameter
  std::vector<double> mach;
  std::vector<double> incidence_rad;    ///< >= 0
  std::vector<double> ca;               ///< shape (mach, incidence), row by row; power on
  std::vector<double> cn;
  std::vector<double> xcp_station_m;    ///< where the normal force acts
  std::vector<double> cmq_per_rad;      ///< shape (mach): pitch and yaw damping, on q d / (2 V), about the CG
  std::vector<double> clp_per_rad;      ///< shape (mach): roll damping on p d / (2 V)
};

/// Limits of the structure; 0 = none given. core/flight/structural_limits.h says which load each one limits.
struct StructuralLimits {
  double q_max_pa = 0.0;
  double q_alpha_pa_rad = 0.0;
  double axial_load_g = 0.0;
  double lateral_load_g = 0.0;
  double bending_moment_n_m = 0.0;
  bool terminate = false;  ///< end the flight as `structural_limit`, else only flag it
};

struct LaunchSite {
  double latitude_rad = 0.0;   ///< geodetic
  double longitude_rad = 0.0;
  double altitude_m = 0.0;     ///< geodetic, of the vehicle's CG at rest
};

/// A rate gyro of three axes: second order over the true rate of its place, sampled and rounded.
struct RateGyro {
  std::string name;
  double station_m = 0.0;
  double bandwidth_rad_s = 0.0;  ///< natural frequency; 0: follows at once
  double damping_ratio = 0.7;
  double quantum_rad_s = 0.0;  ///< of its output; 0: none
  int sample_ticks = 1;        ///< ticks of the autopilot between samples
};
/// Rate gyros a vehicle has at most.
inline constexpr int kRateGyros = 3;

/// What measures attitude and rates. Without rate gyros the inertial unit gives the rates.
struct Sensors {
  double inertial_unit_station_m = 0.0;  ///< whose attitude is measured
  std::vector<RateGyro> rate_gyros;
};

struct Vehicle {
  std::string name;
  bool made_up = false;  ///< it need not be possible: a textbook's coefficients, a limiting case
  LaunchSite site;
  double hold_down_s = 0.0;             ///< stage 1 burns this long before release; lift-off is time 0
  bool jet_damping = true;              ///< moment of the flow from CG to nozzle on a turning vehicle
  bool flow_coriolis = true;            ///< force of that flow, and the motion of the CG through the body
  std::vector<Stage> stages;            ///< in the order of flight
  Boosters boosters;                    ///< of the first stage, part of its lift-off mass
  std::vector<ProfileSection> profile;  ///< outer mould line of the full vehicle
  double surface_roughness_m = 0.0;     ///< equivalent sand grain, for skin friction
  std::vector<AeroTable> aerodynamics;  ///< one a stack; empty: built up from the profile
  ReactionControl reaction_control;
  StructuralLimits limits;
  Sensors sensors;
  std::optional<StructureBeam> structure_beam;  ///< none: the vehicle is rigid
};

/// The last burn of the stage whose burn this is: itself unless the next one restarts it.
int LastBurn(const Vehicle& vehicle, int stage);
/// Whether some engine is cut off at a velocity: when it will is known only in flight.
bool CutsOffAtVelocity(const Vehicle& vehicle);

/// What contradicts itself in a vehicle, each with the path of the value ("stages[1].propellant_mass_kg").
struct VehicleProblem {
  std::string path;
  std::string message;  ///< what is wrong
  std::string allowed;  ///< what is allowed
};
std::vector<VehicleProblem> Problems(const Vehicle& vehicle);

}  // namespace dispersa
