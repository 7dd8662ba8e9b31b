#include "core/flight/ripple.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dispersa {

RippleMeter::RippleMeter(double tick_s) {
  const int ticks = std::max(1, static_cast<int>(std::lround(1.0 / tick_s)));
  block_size_ = std::max(1, ticks / kBlocks);
  blocks_ = std::min(kBlocks, ticks);
  for (std::vector<double>& samples : samples_)
    samples.resize(static_cast<std::size_t>(blocks_ * block_size_));
}

void RippleMeter::Add(double roll_rad, double pitch_rad, double yaw_rad) {
  if (filled_ == 0) at_ = 0;
  const double values[kChannels] = {roll_rad, pitch_rad, yaw_rad};
  const int block = at_ / block_size_, within = at_ % block_size_;
  for (int c = 0; c < kChannels; ++c) {
    const double value = values[c];
    samples_[c][static_cast<std::size_t>(at_)] = value;
    Block& b = block_[c][block];
    if (within == 0) {
      b = {value, 0.0, value, value};
      continue;
    }
    b.sum += value;
    b.moment += within * value;
    b.low = std::min(b.low, value);
    b.high = std::max(b.high, value);
  }
  const int window = blocks_ * block_size_;
  at_ = at_ + 1 == window ? 0 : at_ + 1;
  filled_ = std::min(filled_ + 1, window);
  if (filled_ == window && within + 1 == block_size_)
    for (int c = 0; c < kChannels; ++c) Evaluate(c);
}

// The least-squares line over sample numbers centred at 0, from the blocks' sums.
void RippleMeter::Evaluate(int channel) {
  const Block* blocks = block_[channel];
  double low = blocks[0].low, high = blocks[0].high;
  for (int k = 1; k < blocks_; ++k) {
    low = std::min(low, blocks[k].low);
    high = std::max(high, blocks[k].high);
  }
  // Among samples within a range, the fitted line rises by at most one and a half ranges. Removing it raises
  // the range by no more than that.
  if (2.5 * (high - low) <= worst_) return;
  const int n = blocks_ * block_size_;
  const double centre = 0.5 * (n - 1);
  const int oldest = at_ / block_size_;  // after the last sample: the block that comes next
  double sum = 0.0, moment = 0.0;
  for (int k = 0, b = oldest; k < blocks_; ++k, b = b + 1 == blocks_ ? 0 : b + 1) {
    sum += blocks[b].sum;
    moment += (k * block_size_ - centre) * blocks[b].sum + blocks[b].moment;
  }
  // The sum of squares of the sample numbers: n (n² - 1) / 12.
  const double weight = n * (static_cast<double>(n) * n - 1.0) / 12.0;
  const double mean = sum / n, slope = n > 1 ? moment / weight : 0.0;
  if (high - low + std::fabs(slope) * (n - 1) <= worst_) return;
  // The same block by block: the line's own range within a block at most is added to the block's.
  double most = -std::numeric_limits<double>::infinity(), least = -most;
  const double half_block = 0.5 * std::fabs(slope) * (block_size_ - 1);
  for (int k = 0, b = oldest; k < blocks_; ++k, b = b + 1 == blocks_ ? 0 : b + 1) {
    const double line = mean + slope * ((k + 0.5) * block_size_ - 0.5 - centre);
    most = std::max(most, blocks[b].high - line + half_block);
    least = std::min(least, blocks[b].low - line - half_block);
  }
  if (most - least <= worst_) return;
  low = std::numeric_limits<double>::infinity();
  high = -low;
  const double* samples = samples_[channel].data();
  const auto pass = [&](int from, int to, double x) {
    for (int i = from; i < to; ++i, x += 1.0) {
      const double left = samples[i] - mean - slope * x;
      low = std::min(low, left);
      high = std::max(high, left);
    }
  };
  pass(at_, n, -centre);
  pass(0, at_, n - at_ - centre);
  worst_ = std::max(worst_, high - low);
}

}  // namespace dispersa
