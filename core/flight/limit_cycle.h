// The limit cycle of a flight's deflections: a lasting oscillation, told apart from all other motion of the
// nozzles.
//
// A limit cycle repeats itself: its phase in one stretch of time gives its phase in every later one. A damped
// loop's answer to gusts and turbulence forgets its phase within 1/(2 pi zeta) periods. A transient decays. A
// window of 12 to 24 periods is cut into 12 segments of one to two periods. c is a segment's Fourier
// coefficient at the frequency at which the segments agree best. Then
//
//   coherence = |sum of c|² / (12 sum of |c|²)
//
// is 1 for an oscillation of constant amplitude and frequency. For independent Gaussian c it is
// beta-distributed with P(coherence > x) = (1 - x)^11. The response of a mode with damping zeta has
// correlated c: a = exp(-2 pi zeta periods) from one to the next. They count as 12 (1 - a²) / (1 + a²)
// independent ones: at one period a segment 11.4 at zeta 0.3, 6.7 at 0.1 and 3.6 at 0.05. So the threshold
// kCoherence is exceeded by chance in about 3e-9 of windows at 0.3, 2e-5 at 0.1 and 7e-3 at 0.05, times the
// few frequencies that a window resolves. tests/unit/flight_limit_cycle_test.cc counts false alarms.
//
// Windows cover five octaves from 0.3125 to 10 Hz. Each octave has its own sample rate (10 to 20 a period). A
// sample is the mean over its interval. A window lasts 2.4 s for 5 to 10 Hz and 38.4 s for 0.3125 to 0.625
// Hz. Slower oscillations do not repeat often enough in a burn to be told from noise, and are not measured.
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

  /// Restarts the windows, after a transient, a gust or a coast.
  void Interrupt();
  /// One tick's deflections (rad).
  void Add(double roll_rad, double pitch_rad, double yaw_rad);
  /// 0 if no window has a limit cycle; negative without a whole window.
  double worst_rad() const { return worst_; }

 private:
  static constexpr int kChannels = 3;
  static constexpr int kWidth = 4;  ///< of a sample: the channels side by side, the last unused
  static constexpr int kOctaves = 5;
  static constexpr int kWindow = 240;  ///< samples
  static constexpr int kHops = 4;      ///< windows begun in the time of one
  static constexpr int kHop = kWindow / kHops;
  /// Lag of the second difference that takes trends out: half the shortest period of an octave. It doubles
  /// that period's amplitude and leaves the longest period as it is.
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
