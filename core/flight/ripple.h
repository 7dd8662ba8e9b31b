// The ripple of a flight's deflections: their peak-to-peak within a second, of any cause.
#pragma once

#include <vector>

namespace dispersa {

/// Worst peak-to-peak of pitch, yaw and roll deflection in windows of one second, after a straight line is
/// removed. A window is ten blocks of a tenth of a second, rounded down to whole ticks. A window starts with
/// each block: neighbours overlap by nine tenths, so no oscillation is missed between them.
class RippleMeter {
 public:
  explicit RippleMeter(double tick_s);

  /// Restarts the windows, after a transient, a gust or a coast.
  void Interrupt() { filled_ = 0; }
  /// One tick's deflections (rad).
  void Add(double roll_rad, double pitch_rad, double yaw_rad);
  double worst_rad() const { return worst_; }  ///< negative without a whole window

 private:
  static constexpr int kChannels = 3;
  static constexpr int kWidth = 4;  ///< of a sample: the channels side by side, the last unused
  static constexpr int kBlocks = 10;
  /// Sums over one block. The moment counts samples from the block's first.
  struct Block {
    double sum[kWidth], moment[kWidth], low[kWidth], high[kWidth];
  };

  void Evaluate();

  int block_size_;
  int blocks_;                   ///< in a window
  double begin_[kBlocks];        ///< of each block in a window, from the window's middle
  int block_at_ = 0;             ///< where the next sample goes: which block,
  int within_ = 0;               ///< and where in it
  int filled_ = 0;               ///< samples since the last interruption, up to a window
  std::vector<double> samples_;  ///< the window as a ring
  Block block_[kBlocks];
  double worst_ = -1.0;
};

}  // namespace dispersa
