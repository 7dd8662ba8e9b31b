// Many laws for one plant: what its sensors answer, tabulated over frequency once, makes a law's margins a
// matter of some ten microseconds. For searches; LoopMargins' are exact where these interpolate, which is
// worth 0.1 dB and 1°.
#pragma once

#include <complex>
#include <vector>

#include "core/margins/loop_margins.h"

namespace dispersa {

/// What a loop must have: gain both ways, phase at crossovers and of bending that is not attenuated by the
/// gain's gate, and delay.
struct LoopGates {
  double gain_db = 0.0;
  double phase_deg = 0.0;
  double delay_s = 0.0;  ///< 0: none asked for
};

class LoopTable {
 public:
  /// `plant` with every sensor that a law may come to weigh; its weights do not matter. No undamped
  /// oscillation.
  LoopTable(const AxisPlant& plant, double tick_s, int delay_ticks);

  /// The least of (margin - gate) / gate over all gates; where the body bends the larger of gain's and
  /// phase's at each frequency. -2 or below: the closed loop is unstable, by the encirclements of -1
  /// (Nyquist).
  double Surplus(const LinearLaw& law, const std::vector<double>& weights, const LoopGates& gates) const;

 private:
  double tick_s_;
  double bends_above_rad_s_;
  /// Unstable poles of the plant, and half of those on the circle: half turns of 1 + L about 0 that a stable
  /// loop makes.
  double half_turns_ = 0.0;
  std::vector<double> frequency_rad_s_;
  std::vector<std::complex<double>> s_, angle_;
  std::vector<std::vector<std::complex<double>>> rates_;  ///< by frequency and sensor
};

}  // namespace dispersa
