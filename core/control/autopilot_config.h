// The autopilot as its file describes it: plain data, SI and radians.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/control/plugin_config.h"
#include "core/math/linear.h"

namespace dispersa {

struct StructProblem;

enum class ControlLaw { kAdaptiveFuzzy, kFrozenFuzzy, kPd, kPid, kPdAac, kPidAac, kPlugin };

/// A law's name, its properties, and the blocks of its axis that it needs.
struct LawInfo {
  ControlLaw law;
  const char* name;  ///< in files
  const char* meaning;
  bool rules = false;
  bool adaptation = false;
  bool integral = false;
  bool augmentation = false;
  bool foreign = false;  ///< commands come from the autopilot's plug-in
};
/// In the order of ControlLaw.
inline constexpr LawInfo kLaws[] = {
    {.law = ControlLaw::kAdaptiveFuzzy,
     .name = "adaptive_fuzzy",
     .meaning = "The paper's direct adaptive fuzzy law, equations (20) to (32). The rules start from the "
                "plane of the gains; P_n follows from the gains and Q.",
     .rules = true,
     .adaptation = true},
    {.law = ControlLaw::kFrozenFuzzy,
     .name = "frozen_fuzzy",
     .meaning = "The rules of the adaptive fuzzy law with their consequents held: gamma = 0.",
     .rules = true},
    {.law = ControlLaw::kPd, .name = "pd", .meaning = "Scheduled proportional-derivative control."},
    {.law = ControlLaw::kPid,
     .name = "pid",
     .meaning = "Scheduled proportional-integral-derivative control; the integral holds while the "
                "deflection is limited in its sense.",
     .integral = true},
    {.law = ControlLaw::kPdAac,
     .name = "pd_aac",
     .meaning = "Scheduled proportional-derivative control under adaptive augmenting control (J. S. Orr "
                "and T. S. VanZwieten, AIAA 2012-4549): the total gain rises with the departure from the "
                "reference model, in rad, falls with fast activity of the command, and leaks to 1, where "
                "margins are computed. Its leakage, filters and floor are not searched.",
     .augmentation = true},
    {.law = ControlLaw::kPidAac,
     .name = "pid_aac",
     .meaning = "Scheduled proportional-integral-derivative control under the same augmentation: the total "
                "gain multiplies the integral too, and the reference model has one of its own.",
     .integral = true,
     .augmentation = true},
    {.law = ControlLaw::kPlugin,
     .name = "plugin",
     .meaning =
         "A law of your own, from the shared object that the autopilot's `plugin` names. The gains are the "
         "error dynamics that are wanted: the law is told them, and V is computed with them.",
     .foreign = true},
};
constexpr const LawInfo& InfoOf(ControlLaw law) { return kLaws[static_cast<int>(law)]; }

/// Desired error dynamics s² + kd s + kp of one axis while one stage burns. The law's output is an angular
/// acceleration. The stage's control effectiveness turns it into a deflection.
struct AxisGains {
  double kp_1_s2 = 0.0;
  double kd_1_s = 0.0;
};

/// Adaptation law (32) and what makes it flyable. Each guard is off at 0 or false.
struct Adaptation {
  std::vector<double> gamma;    ///< adaptation gain, one a stage
  Matrix2 q = Matrix2::Zero();  ///< Q of the Lyapunov equation, symmetric positive definite
  std::optional<Vector2>
      p_n;  ///< last column of P, which must agree with K and Q unless allow_unproven is set
  bool allow_unproven = false;
  double projection_bound_rad_s2 = 0.0;  ///< each consequent stays within this distance of its start
  double leakage_1_s = 0.0;              ///< sigma modification: pulls the consequents to their start
  double spread_1_s = 0.0;               ///< pulls departures from the start to their mean over the rules
  double dead_zone_rad = 0.0;            ///< no adaptation while |e' P_n| / p12 is below
  bool normalized = false;  ///< the regressor of (32) over its squared norm, which lies in [1/4, 1]
  /// Composite adaptation: (32) is driven by e' P_n plus the error of a prediction of de/dt, times
  /// `composite` p22. The prediction follows the error dynamics and is drawn to the measured rate at
  /// predictor_1_s.
  double composite = 0.0;
  double predictor_1_s = 0.0;
  bool freeze_when_saturated = false;  ///< no adaptation into a deflection limit
  bool reset_at_ignition = false;      ///< consequents restart with each stage
  double supervisory_bound = 0.0;      ///< supervisory term acts while V exceeds it
};

struct FuzzyRules {
  double error_range_rad = 0.0;   ///< outer set centres of the pitch error, +-
  double rate_range_rad_s = 0.0;  ///< outer set centres of its rate, +-
};

/// The integral of a PID law: u = kp e + kd e' + w, w' = ki e. w' is 0 while the last deflection command was
/// limited in the direction of e.
struct IntegralAction {
  std::vector<double> ki_1_s3;     ///< one a stage
  double bound_rad_s2 = 0.0;       ///< of |w| (0: none)
  bool reset_at_ignition = false;  ///< w restarts with each stage
};

/// NASA's adaptive augmenting control (J. S. Orr and T. S. VanZwieten, "Robust, Practical Adaptive Control
/// for Launch Vehicles", AIAA 2012-4549). A total gain moves between a floor and a ceiling. The difference
/// from a reference model raises it, high-frequency activity of the command lowers it, and a leak draws it
/// back to 1.
struct AdaptiveAugmentation {
  double adaptive_gain_1_s = 0.0;  ///< a, on the square of the departure in rad
  double leakage_1_s = 0.0;        ///< beta
  double spectral_gain_1_s = 0.0;  ///< alpha, on the square of the command in rad/s²
  double high_pass_rad_s = 0.0;    ///< of the spectral damper, above the loop's bandwidth
  double low_pass_rad_s = 0.0;
  double minimum_total_gain = 1.0;
  double maximum_total_gain = 1.0;
};

/// The program's own angular acceleration, added behind a law and its filters. It is known beforehand, so it
/// is read ahead by what delay and actuators take.
struct FeedForward {
  double lead_s = 0.0;
};

/// A section of the filter behind a law, with unit gain at rest: H(s) = (s²/wz² + 2 dz s/wz + 1) / (s²/wp² +
/// 2 dp s/wp + 1). Without zeros it is a low pass.
struct FilterSection {
  double zeros_rad_s = 0.0;  ///< wz (0: no zeros)
  double zeros_damping = 0.0;
  double poles_rad_s = 0.0;
  double poles_damping = 0.0;
  int stage = 0;  ///< 1-based stage in whose burn it acts (0: all stages)
};
/// Most sections of an axis.
inline constexpr int kFilterSections = 6;

/// A law's numbers at a time within a stage's burn. The stage's own gains, integral and filters hold at
/// ignition. Between two times all are interpolated. After the last time they stay.
struct ScheduleEntry {
  int stage = 0;      ///< 1-based
  double at_s = 0.0;  ///< since its ignition
  AxisGains gains;
  double ki_1_s3 = 0.0;                ///< of a law with an integral
  std::vector<FilterSection> filters;  ///< one for each that acts in the stage, in their order
};

struct AxisConfig {
  ControlLaw law = ControlLaw::kPd;
  std::vector<AxisGains> gains;  ///< one a stage
  FuzzyRules rules;
  Adaptation adaptation;
  IntegralAction integral;
  AdaptiveAugmentation augmentation;
  std::vector<FilterSection> filters;   ///< in series, on the law's output
  std::vector<ScheduleEntry> schedule;  ///< by stage and time
  std::optional<FeedForward> feed_forward;
};
/// A list with one entry for each stage, and the property of the laws that read it.
struct StageList {
  const char* path;
  bool LawInfo::*read_by;
  const std::vector<double>& (*of)(const AxisConfig& axis);
};
inline constexpr StageList kStageLists[] = {
    {"integral.ki_1_s3", &LawInfo::integral,
     [](const AxisConfig& axis) -> const std::vector<double>& { return axis.integral.ki_1_s3; }},
    {"adaptation.gamma", &LawInfo::adaptation,
     [](const AxisConfig& axis) -> const std::vector<double>& { return axis.adaptation.gamma; }},
};
/// The places among an axis' filters of those that act in a stage (1-based).
std::vector<std::size_t> FiltersOfStage(const AxisConfig& axis, int stage);

/// Phase-plane logic of the reaction control in unpowered flight.
struct ReactionControlLogic {
  double deadband_rad = 0.0;
  double rate_gain_s = 0.0;  ///< switching line e + rate_gain * de/dt
  double hysteresis = 0.0;   ///< fraction of the deadband by which a firing overshoots into it
  int cycle_ticks = 1;       ///< ticks between decisions: thrusters open for whole cycles
};

/// A rate gyro's share of the measured rates.
struct GyroShare {
  std::string gyro;  ///< of the vehicle's sensors
  double weight = 1.0;
  int stage = 0;  ///< 1-based stage in whose burn it counts (0: all stages)
};

struct AutopilotConfig {
  std::string name;
  double tick_s = 0.01;
  AxisConfig pitch;
  AxisConfig yaw;
  AxisConfig roll;
  ReactionControlLogic reaction_control;
  std::vector<GyroShare> rate_gyros;   ///< empty: the inertial unit gives the rates
  std::optional<PluginConfig> plugin;  ///< of the axes whose law it is
};
/// Bits (1 << Axis) of the axes whose law is a plug-in's.
unsigned PluginAxes(const AutopilotConfig& autopilot);

/// Contradictions within the autopilot, or with a vehicle of this number of stages.
std::vector<StructProblem> Problems(const AutopilotConfig& autopilot, int stages);

}  // namespace dispersa
