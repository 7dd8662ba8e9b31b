// The limit cycle of a flight's deflections: an oscillation that goes on and on, told from whatever else
// moves the nozzles.
//
// A limit cycle repeats itself: the phase at which a frequency is found in one stretch of time says the phase
// of every later one. The answer of a damped loop to gusts and turbulence forgets its phase within 1/(2 pi
// zeta) periods, a transient decays. So a window of 12 to 24 periods is cut into 12 segments of one to two
// periods, and of the segments' Fourier coefficients c at the frequency at which they agree best
//
//   coherence = |sum of c|² / (12 sum of |c|²)
//
// is 1 for an oscillation of constant amplitude and frequency, and of independent Gaussian c beta-distributed
// with P(coherence > x) = (1 - x)^11. The response of a mode with damping zeta has correlated c, by
// a = exp(-2 pi zeta periods) from one to the next, as good as 12 (1 - a²) / (1 + a²) independent ones: at
// one period a segment 11.4 at zeta 0.3, 6.7 at 0.1 and 3.6 at 0.05. The threshold of kCoherence therefore
// leaves about 3e-9 a window at 0.3, 2e-5 at 0.1 and 7e-3 at 0.05, times the few frequencies that a window
// resolves. tests/unit/flight_limit_cycle_test.cc counts what is raised falsely.
//
// A window is looked at in five octaves from 0.3125 to 10 Hz, each on samples of its own rate (10 to 20 a
// period) that are means over what they stand for: 2.4 s long for 5 to 10 Hz, 38.4 s for 0.3125 to 0.625 Hz.
// What is slower does not repeat itself often enough in a burn to be told from noise, and is not measured.
#pragma once

namespace dispersa {

/// Largest peak to peak of a sustained periodic oscillation of pitch, yaw or roll deflection.
class LimitCycleMeter {
 public:
  static constexpr double kCoherence = 0.85;
  /// The amplitude (of the fundamental) in the last third of a window over that in the first, at least: what
  /// falls faster is a transient.
  static constexpr double kLasting = 0.7;
  /// Peak to peak below which nothing is looked at: a tenth of what any requirement asks.
  static constexpr double kFloor_rad = 1.75e-4;

  explicit LimitCycleMeter(double tick_s);

  /// Windows start anew: a transient, a gust, a coast.
  void Interrupt();
  /// One tick's deflections (rad).
  void Add(double roll_rad, double pitch_rad, double yaw_rad);
  /// 0: windows, and no limit cycle in any; negative without a whole window.
  double worst_rad() const { return worst_; }

 private:
  static constexpr int kChannels = 3;
  static constexpr int kWidth = 4;  ///< of a sample: the channels side by side, the last unused
  static constexpr int kOctaves = 5;
  static constexpr int kWindow = 240;  ///< samples
  static constexpr int kHops = 4;      ///< windows begun in the time of one
  static constexpr int kHop = kWindow / kHops;
  /// Of the second difference that takes trends out: half the shortest period of an octave, so that it
  /// doubles what has that period and lets the longest pass as it is.
  static constexpr int kLag = 5;

  struct Octave {
    int at = 0;                    ///< where the next sample goes
    int hops = 0;                  ///< whole ones since the last interruption, up to a window's
    double energy[kHops][kWidth];  ///< of the second differences
    /// A ring behind a copy of its own end, so that differences find what is before them.
    double sample[2 * kLag + kWindow][kWidth];
  };

  void EndHop(int octave);
  void Evaluate(const Octave& octave, int channel);

  int ticks_;         ///< in a sample of the highest octave
  int summed_ = 0;    ///< of them
  bool idle_ = true;  ///< nothing since the last interruption
  double worst_ = -1.0;
  Octave octave_[kOctaves] = {};
};

}  // namespace dispersa
