// Searched quantities with their bounds and starts, and the options of a tuning.
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
/// Reserve if dispersed plants are held themselves. It covers only instants and cases between the checked
/// ones.
inline constexpr double kHeldGainReserve_db = 0.05;
inline constexpr double kHeldPhaseReserve_deg = 0.2;
inline constexpr double kHeldDelayReserve_s = 0.001;
/// Small: a stage has two or three variables, and generations are what a budget of flights is best spent on.
inline constexpr int kTuningPopulation = 8;
/// Population if dispersed plants are held. Margins are then tabulated, designs that miss them cost next to
/// nothing, and the region of admissible designs is small.
inline constexpr int kHeldPopulation = 24;
inline constexpr Bounds kHeldLearning = {0.0, 0.06};
inline constexpr double kHeldLearningStart = 0.002;
inline constexpr Bounds kHeldBandwidthOfActuator = {0.04, 0.22};
/// Such a search also begins with this point: a section that leads far above the first mode keeps the mode's
/// phase instead of attenuating it, for as much bandwidth as possible.
inline constexpr double kHeldDampingStart = 0.53;
inline constexpr double kHeldLowPassPowerStart = 1.158, kHeldLowPassDampingStart = 0.363;
inline constexpr double kHeldNotchPowerStart = 0.441, kHeldNotchZerosDampingStart = 0.265;
inline constexpr double kHeldNotchPolesDampingStart = 0.1, kHeldGyroWeightStart = 0.853;
/// At each of its times a scheduled stage may have these of its damping.
inline constexpr double kDampingFactors[] = {1.0, 0.9, 1.11};
/// Searched quantities. Bandwidths are fractions of the largest admissible one, which is searched between
/// these fractions of the actuator's.
inline constexpr Bounds kBandwidthOfLargest = {0.6, 1.0};
inline constexpr Bounds kBandwidthOfActuator = {0.04, 0.35};
inline constexpr Bounds kDamping = {0.4, 1.6};
inline constexpr Bounds kLearning = {0.0, 0.5};
/// Of ten: a regulator's weights of integral and rate, with that of the angle as 1 and time in units that
/// make it so.
inline constexpr Bounds kIntegralWeightPower = {-4.0, 3.0};
inline constexpr Bounds kRateWeightPower = {-2.0, 2.0};
/// Of a stage that bends. Frequencies are of ten, of its first mode's in the middle of the burn.
inline constexpr Bounds kLowPassPower = {-0.5, 1.2};
/// Of half the sampling frequency, at most.
inline constexpr double kFastestPoles = 0.95;
inline constexpr Bounds kLowPassDamping = {0.3, 1.0};
inline constexpr Bounds kNotchPower = {-0.4, 0.7};
inline constexpr Bounds kNotchZerosDamping = {0.02, 0.6};
inline constexpr Bounds kNotchPolesDamping = {0.1, 1.2};
inline constexpr Bounds kGyroWeight = {-1.0, 2.0};
inline constexpr Bounds kAdaptiveGainPower = {3.0, 8.0};  ///< of ten, 1/s
inline constexpr Bounds kSpectralGainPower = {0.0, 4.0};  ///< of ten, 1/s
inline constexpr Bounds kMaximumTotalGain = {1.1, 2.5};
/// Cautious: every search begins with it, and stages yet to be tuned have it.
inline constexpr double kStartBandwidthOfActuator = 0.1;
inline constexpr double kStartDamping = 0.9;
inline constexpr double kStartLearning = 0.05;
inline constexpr double kStartLowPassPower = 0.85, kStartLowPassDamping = 0.5;
inline constexpr double kStartNotchPower = 0.0, kStartNotchZerosDamping = 0.3, kStartNotchPolesDamping = 0.3;
inline constexpr double kStartGyroWeight = 0.6;
/// Weights that give about that damping and learning.
inline constexpr double kStartIntegralWeightPower = -2.5;
inline constexpr double kStartRateWeightPower = 0.14;
inline constexpr AugmentationDesign kStartAugmentation = {1e4, 100.0, 1.5};

struct TuningOptions {
  std::uint64_t seed = 1;  ///< of the cases and of the search (must not be the campaign's)
  int cases = 4;           ///< cases flown for each design, 1 to 10,000
  int evaluations = 160;   ///< designs tried in all searches, at least 2 kTuningPopulation in each
  int threads = 1;         ///< 1 to 1024, without effect on the result
  /// Draws whose plants must meet the gates of dispersed flights, at every instant and by every design. 0
  /// (none) to 1000.
  int dispersed = 0;
  bool regulator =
      false;  ///< search the weights of a linear-quadratic regulator (laws with an integral only)
};

}  // namespace dispersa
