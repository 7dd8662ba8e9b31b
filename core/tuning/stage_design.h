// What is searched, as quantities of which one range suits every stage and vehicle.
#pragma once

#include <vector>

#include "core/control/autopilot_config.h"

namespace dispersa {

/// What is behind the law in pitch and yaw of a stage that bends: a low pass of second order and a notch; and
/// how two gyros share the rates.
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
  /// What lasts of the adaptation is an integrator of gain gamma p12 / 25 (of the mean of 25 rules, see
  /// LinearLaw); that of a PID law is ki. Its ratio to w³, where the law has one.
  double learning = 0.0;
  StageFilters filters;
};

/// What augments PD in every stage alike (AdaptiveAugmentation); its leakage, filters and floor are given.
struct AugmentationDesign {
  double adaptive_gain_1_s = 0.0;
  double spectral_gain_1_s = 0.0;
  double maximum_total_gain = 1.0;
};

/// Whether an axis adapts by fuzzy rules or integrates: only then there is something to learn.
bool Learns(const AutopilotConfig& autopilot);

/// Gives one stage (0-based) of all axes the gains of a design, adaptive fuzzy axes its gamma, PID axes its
/// ki; rounded to `kDesignDigits`, so that a file that prints them holds exactly what was flown.
void ApplyDesign(const StageDesign& design, int stage, AutopilotConfig& autopilot);
inline constexpr int kDesignDigits = 3;

/// The times within a stage (0-based) at which pitch's schedule has an entry; 0, the ignition, is the first.
std::vector<double> ScheduledTimes(const AutopilotConfig& autopilot, int stage);

/// The same for a scheduled stage: designs at its ScheduledTimes. Every axis gets pitch's times, and all
/// filters of a time those of its design; the blend of gyros is the first one's.
void ApplyDesign(const std::vector<StageDesign>& designs, int stage, AutopilotConfig& autopilot);

/// The places in the autopilot's rate_gyros of a stage's (0-based) two gyros that are named for it alone;
/// empty where there are not two.
std::vector<std::size_t> BlendedGyros(const AutopilotConfig& autopilot, int stage);

/// Whether an axis is PD with augmentation.
bool IsAugmented(const AutopilotConfig& autopilot);

/// Gives all augmented axes a design, rounded likewise.
void ApplyDesign(const AugmentationDesign& design, AutopilotConfig& autopilot);

/// The nearest number of so many significant decimal digits.
double RoundToDigits(double value, int digits);

}  // namespace dispersa
