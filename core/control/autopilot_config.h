// The autopilot as its file describes it: plain data, SI and radians.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/math/linear.h"

namespace dispersa {

enum class ControlLaw {
  kAdaptiveFuzzy,  ///< the paper's equations (20)-(32)
  kFrozenFuzzy,    ///< the same rules, consequents held (gamma = 0)
  kPd,             ///< gain-scheduled proportional-derivative
  kPdAac,          ///< the PD law under NASA's adaptive augmenting control
};

/// Desired error dynamics s² + kd s + kp of one axis while one stage burns; the law's output is an angular
/// acceleration, which the stage's control effectiveness turns into a deflection.
struct AxisGains {
  double kp_1_s2 = 0.0;
  double kd_1_s = 0.0;
};

/// Adaptation law (32) and what makes it flyable. Each guard is off at 0 or false.
struct Adaptation {
  std::vector<double> gamma;       ///< adaptation gain, one a stage
  Matrix2 q = Matrix2::Zero();     ///< Q of the Lyapunov equation, symmetric positive definite
  std::optional<Vector2> p_n;      ///< last column of P; must agree with K and Q unless allow_unproven
  bool allow_unproven = false;
  double projection_bound_rad_s2 = 0.0;  ///< each consequent stays within this distance of its start
  double leakage_1_s = 0.0;              ///< sigma modification: pulls the consequents to their start
  double spread_1_s = 0.0;               ///< pulls departures from the start to their mean over the rules
  double dead_zone_rad = 0.0;            ///< no adaptation while |e' P_n| / p12 is below
  bool freeze_when_saturated = false;    ///< no adaptation into a deflection limit
  bool reset_at_ignition = false;        ///< consequents start anew with each stage
  double supervisory_bound = 0.0;        ///< supervisory term acts while V exceeds it
};

struct FuzzyRules {
  double error_range_rad = 0.0;     ///< outer set centres of the pitch error, +-
  double rate_range_rad_s = 0.0;    ///< outer set centres of its rate, +-
};

/// NASA's adaptive augmenting control (J. S. Orr and T. S. VanZwieten, "Robust, Practical Adaptive Control
/// for Launch Vehicles", AIAA 2012-4549): a total gain between a floor and a ceiling, raised by the departure
/// from a reference model, lowered by high-frequency activity of the command, drawn back to 1.
struct AdaptiveAugmentation {
  double adaptive_gain_1_s = 0.0;    ///< a, on the square of the departure in rad
  double leakage_1_s = 0.0;          ///< beta
  double spectral_gain_1_s = 0.0;    ///< alpha, on the square of the command in rad/s²
  double high_pass_rad_s = 0.0;      ///< of the spectral damper, above the loop's bandwidth
  double low_pass_rad_s = 0.0;
  double minimum_total_gain = 1.0;
  double maximum_total_gain = 1.0;
};

struct AxisConfig {
  ControlLaw law = ControlLaw::kPd;
  std::vector<AxisGains> gains;  ///< one a stage
  FuzzyRules rules;
  Adaptation adaptation;
  AdaptiveAugmentation augmentation;
};

/// Phase-plane logic of the reaction control in unpowered flight.
struct ReactionControlLogic {
  double deadband_rad = 0.0;
  double rate_gain_s = 0.0;     ///< switching line e + rate_gain * de/dt
  double hysteresis = 0.0;      ///< fraction of the deadband by which a firing overshoots into it
  int cycle_ticks = 1;          ///< ticks between decisions: thrusters open for whole cycles
};

struct AutopilotConfig {
  std::string name;
  double tick_s = 0.01;
  AxisConfig pitch;
  AxisConfig yaw;
  AxisConfig roll;
  ReactionControlLogic reaction_control;
};

/// As Problems(Vehicle): what contradicts itself, by path. `stages` is the vehicle's number of stages.
struct AutopilotProblem {
  std::string path;
  std::string message;
  std::string allowed;
};
std::vector<AutopilotProblem> Problems(const AutopilotConfig& autopilot, int stages);

}  // namespace dispersa
