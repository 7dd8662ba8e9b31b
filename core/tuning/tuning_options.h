// The searched quantities of a tuning with their bounds and starting points, and its options.
#pragma once

#include <cstdint>

#include "core/optimization/genetic_algorithm.h"
#include "core/tuning/stage_design.h"

namespace dispersa {

inline constexpr double kObjectiveTolerance_deg = 1e-4;
inline constexpr double kLimitCycleLimit_deg = 0.2;
/// Reserve of a computed margin above the gates of flight_margins.h. Measured gain margins, with all axes at
/// work on a disturbed flight, were found up to 0.6 dB below the computed ones.
inline constexpr double kGainReserve_db = 0.8;
inline constexpr double kPhaseReserve_deg = 2.0;
inline constexpr double kDelayReserve_s = 0.002;
/// Reserve if dispersed plants are held. It only covers instants and cases between the checked ones.
inline constexpr double kHeldGainReserve_db = 0.05;
inline constexpr double kHeldPhaseReserve_deg = 0.2;
inline constexpr double kHeldDelayReserve_s = 0.001;
/// A small population: a stage has two or three variables, and more generations use a budget of flights
/// better.
inline constexpr int kTuningPopulation = 8;
/// Population if dispersed plants are held. Margins are then tabulated, so that a design that misses them
/// costs little. The region of admissible designs is small.
inline constexpr int kHeldPopulation = 24;
inline constexpr Bounds kHeldLearning = {0.0, 0.06};
inline constexpr double kHeldLearningStart = 0.002;
inline constexpr Bounds kHeldBandwidthOfActuator = {0.04, 0.22};
/// A second starting point if plants are held. A filter with a resonance far above the first mode keeps the
/// mode's phase instead of attenuating the mode. This allows the largest bandwidth.
inline constexpr double kHeldDampingStart = 0.53;
inline constexpr double kHeldLowPassPowerStart = 1.158, kHeldLowPassDampingStart = 0.363;
inline constexpr double kHeldNotchPowerStart = 0.441, kHeldNotchZerosDampingStart = 0.265;
inline constexpr double kHeldNotchPolesDampingStart = 0.1, kHeldGyroWeightStart = 0.853;
/// Factors of a scheduled stage's damping that are tried at each of its times.
inline constexpr double kDampingFactors[] = {1.0, 0.9, 1.11};
/// Searched quantities. Bandwidths are fractions of the largest admissible one. That one is searched between
/// these fractions of the actuator's bandwidth.
inline constexpr Bounds kBandwidthOfLargest = {0.6, 1.0};
inline constexpr Bounds kBandwidthOfActuator = {0.04, 0.35};
inline constexpr Bounds kDamping = {0.4, 1.6};
inline constexpr Bounds kLearning = {0.0, 0.5};
/// Exponents of ten: a regulator's weights of integral and rate. The weight of the angle is 1, by the choice
/// of the unit of time.
inline constexpr Bounds kIntegralWeightPower = {-4.0, 3.0};
inline constexpr Bounds kRateWeightPower = {-2.0, 2.0};
/// For a stage that bends. Frequencies are exponents of ten, relative to the first mode in the middle of the
/// burn.
inline constexpr Bounds kLowPassPower = {-0.5, 1.2};
/// Largest pole frequency, as a fraction of half the sampling frequency.
inline constexpr double kFastestPoles = 0.95;
inline constexpr Bounds kLowPassDamping = {0.3, 1.0};
inline constexpr Bounds kNotchPower = {-0.4, 0.7};
inline constexpr Bounds kNotchZerosDamping = {0.02, 0.6};
inline constexpr Bounds kNotchPolesDamping = {0.1, 1.2};
inline constexpr Bounds kGyroWeight = {-1.0, 2.0};
inline constexpr Bounds kAdaptiveGainPower = {3.0, 8.0};  ///< exponents of ten, 1/s
inline constexpr Bounds kSpectralGainPower = {0.0, 4.0};  ///< exponents of ten, 1/s
inline constexpr Bounds kMaximumTotalGain = {1.1, 2.5};
/// A cautious design. Every search begins with it, and stages that are not tuned yet have it.
inline constexpr double kStartBandwidthOfActuator = 0.1;
inline constexpr double kStartDamping = 0.9;
inline constexpr double kStartLearning = 0.05;
inline constexpr double kStartLowPassPower = 0.85, kStartLowPassDamping = 0.5;
inline constexpr double kStartNotchPower = 0.0, kStartNotchZerosDamping = 0.3, kStartNotchPolesDamping = 0.3;
inline constexpr double kStartGyroWeight = 0.6;
/// Weights that give about this damping and learning.
inline constexpr double kStartIntegralWeightPower = -2.5;
inline constexpr double kStartRateWeightPower = 0.14;
inline constexpr AugmentationDesign kStartAugmentation = {1e4, 100.0, 1.5};

struct TuningOptions {
  std::uint64_t seed = 1;  ///< of the cases and of the search (must not be the campaign's)
  int cases = 4;           ///< cases flown for each design, 1 to 10,000
  int evaluations =
      160;          ///< designs tried in all searches together, at least 2 kTuningPopulation for each search
  int threads = 1;  ///< 1 to 1024; the result does not depend on it
  /// Number of draws whose plants must meet the gates of dispersed flights at every instant. 0 (none) to
  /// 1000.
  int dispersed = 0;
  bool regulator =
      false;  ///< search the weights of a linear-quadratic regulator (control laws with an integral only)
};

}  // namespace dispersa
