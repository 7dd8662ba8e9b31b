// Margins of many control laws for one plant. The answers of its sensors are tabulated over frequency once,
// so a law's margins take some ten microseconds. For searches: LoopMargins' are exact. These interpolate,
// with errors of 0.1 dB and 1°.
#pragma once

#include <complex>
#include <vector>

#include "core/margins/loop_margins.h"

namespace dispersa {

/// The margins that a loop must have: gain both ways, phase at crossovers, phase of bending that is not
/// attenuated by the gain's gate, and delay.
struct LoopGates {
  double gain_db = 0.0;
  double phase_deg = 0.0;
  double delay_s = 0.0;  ///< 0: none asked for
};

class LoopTable {
 public:
  /// `plant` has every sensor to which a law may give weight. Its own weights do not matter. It has no
  /// undamped oscillation.
  LoopTable(const AxisPlant& plant, double tick_s, int delay_ticks);

  /// The least of (margin - gate) / gate over all gates. For bending the larger of gain's and phase's counts
  /// at each frequency. -2 or below: the closed loop is unstable, by the encirclements of -1 (Nyquist).
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
