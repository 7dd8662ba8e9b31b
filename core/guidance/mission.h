// Data that the guidance of every flight of a campaign has before lift-off: the nominal motors and masses of
// the guided burns, the reference's attitude, and the target.
#pragma once

#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "core/environment/air_table.h"
#include "core/environment/earth.h"
#include "core/guidance/engine_levels.h"
#include "core/guidance/guidance_config.h"
#include "core/guidance/guidance_limits.h"
#include "core/math/assertion.h"
#include "core/math/linear.h"
#include "core/vehicle/bodies.h"
#include "core/vehicle/propulsion.h"

namespace dispersa {

/// The target of a flight: geodetic altitude, inertial speed, inertial flight path angle, inclination.
struct Arrival {
  double altitude_m = 0.0;
  double velocity_m_s = 0.0;
  double flight_path_angle_rad = 0.0;
  double inclination_rad = 0.0;
};

/// Direction of body x in the launch-inertial frame L: R_LB = Ry(pitch) Rz(yaw) Rx(roll).
struct Direction {
  double pitch_rad = 0.0;
  double yaw_rad = 0.0;
};
/// An orbit's size, shape and place, about a point mass.
struct TargetOrbit {
  double semi_major_axis_m = 0.0;
  double eccentricity = 0.0;
  std::optional<double> argument_of_perigee_rad = {};  ///< none: any
  std::optional<double> true_anomaly_rad = {};         ///< of the injection; none: any
};
/// Body x in L.
Vector3 UnitVector(const Direction& direction);

/// The reference's attitude on an even grid, linear between and held outside.
struct DirectionTable {
  double start_s = 0.0;
  double step_s = 1.0;
  std::vector<Direction> at;  ///< two at least

  Direction At(double time_s) const;
  /// Its slope, rad/s; 0 outside the table.
  Direction RateAt(double time_s) const;
};

/// A body that leaves after a burn's ignition: at the reference's time, or as soon as the flight meets a
/// criterion.
struct MassDrop {
  double time_s = 0.0;  ///< since lift-off. Of one with a criterion: never, until it has left
  double mass_kg = 0.0;
  JettisonTrigger trigger = JettisonTrigger::kAtTime;
  double threshold = 0.0;  ///< of the criterion: Jettison's
  unsigned body = 0;       ///< its bit of those that have left

  bool waits() const { return trigger != JettisonTrigger::kAtTime && !(time_s < HUGE_VAL); }
};

/// A stack with its motor as the documents give them.
struct GuidedStage {
  MotorBurn burn;
  double ignition_mass_kg = 0.0;  ///< with everything above
  double cross_section_m2 = 0.0;  ///< of its widest stage
  bool loses_mass = false;        ///< the reference lets go of something while it burns
  // Of an engine that guidance cuts off, or that uses up its propellant. The reference's burn ends after
  // burn.duration_s.
  std::optional<EngineLevels> levels = {};
  bool runs_dry = false;             ///< only its propellant ends its burn
  bool ends_by_time = false;         ///< by a timer, and not at a speed
  double usable_kg = 0.0;            ///< propellant at ignition without the residual
  std::vector<MassDrop> drops = {};  ///< after the reference's ignition
  double early_kg =
      0.0;  ///< of the drops, what the reference lets go of by the middle of a burn that ends by itself

  bool is_engine() const { return levels.has_value(); }
  bool is_cut_off() const { return is_engine() && !runs_dry; }
  double DroppedBy(double time_s) const;
  /// A mass without the bodies that do not wait for a criterion: of a stage whose bodies have one, those that
  /// have left.
  double LessDropped(double mass_kg) const;
  /// Bodies with a criterion that have left, as bits. The flight computer lets go of them. Whether there were
  /// any.
  bool SeeLeft(unsigned bodies, double at_s);
  /// Duration of a burn that uses up the propellant. Precondition of both: is_engine().
  double Depletes() const {
    DISPERSA_ASSERT(is_engine());
    return levels->TimeOf(usable_kg / burn.full_flow_kg_s);
  }
  /// Propellant burnt by an engine, kg.
  double Burnt(double duration_s) const {
    DISPERSA_ASSERT(is_engine());
    return burn.full_flow_kg_s * levels->Sum(duration_s);
  }
};

/// A flight that falls below this altitude comes back into the air at orbital speed: 7 Pa at 105 km. Nozzles
/// hold the attitude there. Thrusters of some tens of newtons do not, and over a coast of an hour they use up
/// hundreds of kilograms: in a coast it is 0.7 Pa, at 120 km.
inline constexpr double kAirBelow_m = 105e3, kCoastAirBelow_m = 120e3;

/// How a burn begins after the one before.
struct BurnStart {
  bool on_timer = false;         ///< at `ignition_s`, else `after_burnout_s` after the one before has ended
  double ignition_s = 0.0;       ///< of the reference
  double after_burnout_s = 0.0;  ///< of the reference
  bool is_restart = false;       ///< of the engine that burnt before
};
/// A guided burn before the last two.
struct EarlierBurn {
  GuidedStage stage;
  BurnStart start;
};

struct GuidanceMission {
  GuidanceConfig config;
  GuidanceLimits limits;
  Earth earth = Wgs84();
  std::shared_ptr<const AirTable> air = {};  ///< measured (null: the standard's)
  Matrix3 R_IL = Matrix3::Identity();
  Arrival target;
  std::optional<TargetOrbit> orbit = {};  ///< then only its inclination and speed count of `target`
  std::optional<double> node_rad = {};    ///< wanted right ascension of the node, from I's x axis
  std::vector<EarlierBurn> earlier = {};  ///< guided burns before the last two, in their order
  BurnStart below_start = {};             ///< if there are any
  GuidedStage below;                      ///< the stage before the last
  GuidedStage last;
  bool steers_below = true;           ///< else guidance begins with the last stage
  bool moves_ignition = true;         ///< the last stage ignites on the timer
  bool holds_last = false;            ///< nothing steers the last stage: it keeps its attitude by its spin
  bool is_restart = false;            ///< the last burn is another one of the engine before
  double below_burnout_s = 0.0;       ///< of the reference
  double last_ignition_s = 0.0;       ///< of the reference
  double velocity_reserve_m_s = 0.0;  ///< by which the reference arrives faster than the target
  DirectionTable program;             ///< from the ignition of the stage before the last on
  /// Predictions have no air: a plan whose way falls below this altitude, in a coast or a burn, is a bad one
  /// (0: any may).
  double air_below_m = 0.0, coast_air_below_m = 0.0;
};

/// The next burn (`last`), if it is another one of the same engine after a burn of `duration_s`: what is left
/// is its mass and its propellant.
GuidedStage AfterBurn(const GuidedStage& below, GuidedStage last, double duration_s);

/// Ideal velocity change of a burn.
double IdealVelocity(const GuidedStage& stage);

/// Whether guidance decides when the burn of a stage ends.
bool IsCutOffByGuidance(const Stage& stage);
/// The first of the burns that guidance plans, as an index of the vehicle's stages: as many as the settings
/// let it plan, after the last one that nothing steers. The last burn at the latest.
std::size_t FirstGuided(const Vehicle& vehicle, const GuidanceConfig& config);
/// Whether it steers the last stage but one.
bool SteersBelow(const Vehicle& vehicle, const GuidanceConfig& config);
/// Whether that one is above the air for long enough to plan the last burn. A first stage without boosters
/// leaves the air in its last seconds, if at all.
bool PlansBelow(const Vehicle& vehicle, const GuidanceConfig& config);

}  // namespace dispersa
