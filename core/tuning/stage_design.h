// The searched quantities of a stage, scaled such that one range suits every stage and vehicle.
#pragma once

#include <vector>

#include "core/control/autopilot_config.h"

namespace dispersa {

/// The filters behind the control law in pitch and yaw of a bending stage: a low pass of second order and a
/// notch. Also the shares of two gyros in the rates.
struct StageFilters {
  double low_pass_rad_s = 0.0;  ///< 0: no filters
  double low_pass_damping = 0.7;
  double notch_rad_s = 0.0;
  double notch_zeros_damping = 0.0;
  double notch_poles_damping = 0.0;
  double first_gyro_weight = 1.0;  ///< of the stage's two, if the autopilot names two
};

/// The error dynamics of one stage and the learning of its adaptation or integral.
struct StageDesign {
  double bandwidth_rad_s = 0.0;  ///< natural frequency w of s² + kd s + kp: w² = kp
  double damping = 0.0;          ///< its damping ratio: kd = 2 damping w
  /// The adaptation's lasting part is an integrator of gain gamma p12 / 25 (the mean of 25 rules, see
  /// LinearLaw). A PID law's integrator has the gain ki. `learning` is this gain divided by w³.
  double learning = 0.0;
  StageFilters filters;
};

/// The augmentation of PD (AdaptiveAugmentation), the same in every stage. Its leakage, filters and floor are
/// not searched.
struct AugmentationDesign {
  double adaptive_gain_1_s = 0.0;
  double spectral_gain_1_s = 0.0;
  double maximum_total_gain = 1.0;
};

/// Whether an axis adapts by fuzzy rules or integrates. Otherwise `learning` has no effect.
bool Learns(const AutopilotConfig& autopilot);

/// Gives all axes the gains of a design in one stage (0-based). Adaptive fuzzy axes also get its gamma, PID
/// axes its ki. Values are rounded to `kDesignDigits`, so that a file that prints them holds exactly the
/// flown values.
void ApplyDesign(const StageDesign& design, int stage, AutopilotConfig& autopilot);
inline constexpr int kDesignDigits = 3;

/// Times within a stage (0-based) at which pitch's schedule has an entry, beginning with 0, the ignition.
std::vector<double> ScheduledTimes(const AutopilotConfig& autopilot, int stage);

/// The same for a scheduled stage, with a design for each of its ScheduledTimes. Every axis gets pitch's
/// times. The filters of a time come from its own design, the weights of the gyros from the first design.
void ApplyDesign(const std::vector<StageDesign>& designs, int stage, AutopilotConfig& autopilot);

/// Positions in the autopilot's rate_gyros of the two gyros that are named for a stage (0-based) alone. Empty
/// if there are not two.
std::vector<std::size_t> BlendedGyros(const AutopilotConfig& autopilot, int stage);

/// Whether an axis is PD with augmentation.
bool IsAugmented(const AutopilotConfig& autopilot);

/// Gives all augmented axes a design, with values rounded in the same way.
void ApplyDesign(const AugmentationDesign& design, AutopilotConfig& autopilot);

/// `value` rounded to `digits` significant decimal digits.
double RoundToDigits(double value, int digits);

}  // namespace dispersa
