// The result of the optimiser, which every flight follows: the trajectory problem, the flight program, the
// orbit reached, and the attitude in the launch-inertial frame over time.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/flight/attitude_program.h"
#include "core/input/fields.h"
#include "core/vehicle/vehicle.h"

namespace dispersa {

/// Incidence of a burning upper stage, or of a first stage from the time when its boosters leave (then that
/// time stands for the ignition). It is added to the zero incidence of a gravity turn. It lies in the plane
/// of ascent, nose up, and is linear in the time since ignition. A long burn needs it: a gravity turn loses
/// too much altitude. It fades in within kSteeringRise_s, and fades out within kSteeringFade_s after the
/// burn.
struct Steering {
  double begin_rad = 0.0;  ///< at ignition; of a first stage, when its boosters leave
  double end_rad = 0.0;    ///< when the propellant would be used up

  bool empty() const { return begin_rad == 0.0 && end_rad == 0.0; }
};
inline constexpr double kSteeringRise_s = 20.0;
inline constexpr double kSteeringFade_s = 60.0;

/// Section II of the paper: vertical flight to t1, a turn with incidence to t2, then zero incidence. The
/// maximum incidence is at t3. Times count from lift-off.
struct FlightProgram {
  double alpha_max_rad = 0.0;  ///< magnitude of the (nose-down) maximum incidence
  double t1_s = 0.0;
  double t3_s = 0.0;
  double t2_s = 0.0;
  double coast_s = 0.0;             ///< from the third stage's burnout to the last stage's ignition
  double launch_azimuth_rad = 0.0;  ///< clockwise from north
  /// By stage: from the burnout below to the ignition by a timer, for stages before the last.
  std::array<double, kMaxStages> earlier_coast_s{};
  std::array<Steering, kMaxStages> steering{};  ///< by stage
};

/// The orbit at injection: geodetic altitude, inertial speed, inertial flight path angle, orbital plane, and
/// distance from the Earth's centre. The node is east of Greenwich at lift-off. The argument of latitude is
/// the angle from the node along the orbit. At the perigee of an ellipse it is the argument of perigee.
struct Orbit {
  double altitude_m = 0.0;
  double velocity_m_s = 0.0;
  double flight_path_angle_rad = 0.0;
  double inclination_rad = 0.0;
  double node_longitude_rad = 0.0;
  double radius_m = 0.0;
  double argument_of_latitude_rad = 0.0;
};

struct ConstraintMargin {
  std::string name;  ///< with the unit
  double value = 0.0;
  double limit = 0.0;
  double margin = 0.0;   ///< limit - value, >= 0 if satisfied
  bool enforced = true;  ///< false: reported only
};

struct Bounds {
  double low = 0.0;
  double high = 0.0;

  bool empty() const { return low == 0.0 && high == 0.0; }
};
struct SteeringBounds {
  Bounds begin_rad, end_rad;

  bool empty() const { return begin_rad.empty() && end_rad.empty(); }
};

/// Target, decision variables' bounds, objective (8) and constraints of section II.
struct TrajectoryProblem {
  double target_altitude_m = 0.0;  ///< geodetic; for an ellipse: of the perigee above the equator's radius
  double target_velocity_m_s = 0.0;
  double target_flight_path_angle_rad = 0.0;
  std::optional<double>
      target_apogee_m;  ///< above the equator's radius; makes the orbit an ellipse, entered at its perigee
  bool is_entered_anywhere = false;  ///< the ellipse, else at its perigee
  bool velocity_is_free = false;     ///< the target names no velocity
  std::optional<double> target_inclination_rad;
  std::optional<double> target_node_rad;  ///< right ascension; the time of day of the lift-off provides it
  std::optional<double> target_argument_of_perigee_rad;  ///< of an ellipse
  std::optional<double> target_true_anomaly_rad;         ///< of its entry, if the target gives one
  /// The target gives these in place of its apsides, which follow from them.
  bool is_given_by_axis = false;
  double target_semi_major_axis_m = 0.0, target_eccentricity = 0.0;
  double velocity_reserve_m_s = 0.0;  ///< extra velocity of the trajectory, which guidance may spend
  Bounds alpha_max_rad, t1_s, t3_s, t2_s, coast_s, launch_azimuth_rad;
  std::array<Bounds, kMaxStages> earlier_coast_s{};
  std::array<SteeringBounds, kMaxStages> steering{};
  double weight_altitude_1_m = 0.0;  ///< G1 of (8)
  double weight_velocity_s_m = 0.0;  ///< G2
  double weight_angle_1_rad = 0.0;   ///< G3
  double weight_inclination_1_rad = 0.0;
  double weight_argument_1_rad = 0.0;
  double axial_load_limit_g = 12.0;
  double lateral_load_limit_g = 1.5;
  double alpha_limit_rad = 0.0;
  double turn_rate_limit_rad_s = 0.0;           ///< of the body axis in the pitch-over (0: reported only)
  double transonic_mach_low = 0.8;              ///< alpha = 0 from here
  double transonic_mach_high = 1.2;             ///< to here
  double q_max_limit_pa = 0.0;                  ///< 0: reported only
  double q_alpha_limit_pa_rad = 0.0;            ///< 0: reported only
  double reaction_control_propellant_kg = 0.0;  ///< expelled by a flight before the last stage burns
  int population = 0;
  int generations = 0;
  std::uint64_t seed = 0;
};

/// The velocity at which the trajectory is aimed.
inline double AimedVelocity(const TrajectoryProblem& problem) {
  return problem.target_velocity_m_s + problem.velocity_reserve_m_s;
}

struct Reference {
  std::string name;
  std::string target_missed;  ///< how near the search came to the target (empty: target reached)
  TrajectoryProblem problem;
  FlightProgram program;
  double last_ignition_s = 0.0;                         ///< timer of the last stage, since lift-off
  std::array<double, kMaxStages> earlier_ignition_s{};  ///< timers of the other stages that have one
  Orbit orbit;                                          ///< reached, by the simulation of the optimiser
  std::vector<ConstraintMargin> constraints;
  std::string engine;          ///< engine version of the search
  std::string vehicle_sha256;  ///< of the canonical vehicle of the search
  std::int64_t evaluations = 0;
  AttitudeProgram attitude;
};

/// The keys of a reference's `problem`, a campaign's `optimize`.
void Describe(Fields& fields, TrajectoryProblem& problem);
/// All keys of a reference file except its schema.
void Describe(Fields& fields, Reference& reference);

}  // namespace dispersa
