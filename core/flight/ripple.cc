#include "core/flight/ripple.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/lanes.h"

namespace dispersa {
namespace {

using Channels = lanes::Pack<4>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Channels Load(const double* values) { return Channels(_mm256_loadu_pd(values)); }
void Store(double* values, Channels value) { _mm256_storeu_pd(values, value.v); }

}  // namespace

RippleMeter::RippleMeter(double tick_s) {
  const int ticks = std::max(1, static_cast<int>(std::lround(1.0 / tick_s)));
  block_size_ = std::max(1, ticks / kBlocks);
  blocks_ = std::min(kBlocks, ticks);
  samples_.resize(static_cast<std::size_t>(kWidth * blocks_ * block_size_));
  for (int k = 0; k < blocks_; ++k) begin_[k] = k * block_size_ - 0.5 * (blocks_ * block_size_ - 1);
  for (int k = blocks_; k < kBlocks; ++k) {  // of a window of fewer blocks
    Store(block_[k].low, Channels(kInfinity));
    Store(block_[k].high, Channels(-kInfinity));
  }
}

void RippleMeter::Add(double roll_rad, double pitch_rad, double yaw_rad) {
  if (filled_ == 0) block_at_ = within_ = 0;
  const Channels value(_mm256_set_pd(0.0, yaw_rad, pitch_rad, roll_rad));
  Store(samples_.data() + kWidth * (block_at_ * block_size_ + within_), value);
  Block& b = block_[block_at_];
  if (within_ == 0) {
    Store(b.sum, value);
    Store(b.moment, Channels(0.0));
    Store(b.low, value);
    Store(b.high, value);
  } else {
    Store(b.sum, Load(b.sum) + value);
    Store(b.moment, Load(b.moment) + Channels(within_) * value);
    Store(b.low, Min(value, Load(b.low)));
    Store(b.high, Max(value, Load(b.high)));
  }
  const int window = blocks_ * block_size_;
  if (filled_ < window) ++filled_;
  if (++within_ < block_size_) return;
  within_ = 0;
  block_at_ = block_at_ + 1 == blocks_ ? 0 : block_at_ + 1;
  if (filled_ == window) Evaluate();
}

// The least-squares line over sample numbers centred at 0, from the blocks' sums. Called after a whole block:
// the one that comes next is the oldest.
void RippleMeter::Evaluate() {
  Channels low = Load(block_[0].low), high = Load(block_[0].high);
#pragma GCC unroll 10
  for (int k = 1; k < kBlocks; ++k) {
    low = Min(Load(block_[k].low), low);
    high = Max(Load(block_[k].high), high);
  }
  // Among samples within a range, the fitted line rises by at most one and a half ranges. Removing it raises
  // the range by no more than that.
  const Channels range = high - low, raised = Channels(2.5) * range;
  if (!Any(raised > Channels(worst_))) return;
  const int n = blocks_ * block_size_;
  const auto each_block = [this](auto&& add) {
    int k = 0;
    for (int b = block_at_; b < blocks_; ++b) add(k++, block_[b]);
    for (int b = 0; b < block_at_; ++b) add(k++, block_[b]);
  };
  Channels sum(0.0), moment(0.0);
  each_block([&](int k, const Block& block) __attribute__((always_inline)) {
    const Channels of_block = Load(block.sum);
    sum = sum + of_block;
    moment = moment + (Channels(begin_[k]) * of_block + Load(block.moment));
  });
  // The sum of squares of the sample numbers: n (n² - 1) / 12.
  const double weight = n * (static_cast<double>(n) * n - 1.0) / 12.0;
  const Channels mean = sum / Channels(n), slope = n > 1 ? moment / Channels(weight) : Channels(0.0);
  const Channels turned = range + Abs(slope) * Channels(n - 1);
  if (!Any(turned > Channels(worst_))) return;
  const double centre = 0.5 * (n - 1);
  // The same block by block: the line's own range within a block at most is added to the block's.
  Channels most(-kInfinity), least(kInfinity);
  const Channels half_block = Channels(0.5) * Abs(slope) * Channels(block_size_ - 1);
  each_block([&](int k, const Block& block) __attribute__((always_inline)) {
    const Channels line = mean + slope * Channels((k + 0.5) * block_size_ - 0.5 - centre);
    most = Max(Load(block.high) - line + half_block, most);
    least = Min(Load(block.low) - line - half_block, least);
  });
  const Channels blockwise = most - least;
  for (int c = 0; c < kChannels; ++c) {
    if (Lane(raised, c) <= worst_ || Lane(turned, c) <= worst_ || Lane(blockwise, c) <= worst_) continue;
    double lowest = kInfinity, highest = -kInfinity;
    const auto pass = [&](int from, int to, double x) {
      for (int i = from; i < to; ++i, x += 1.0) {
        const double left =
            samples_[static_cast<std::size_t>(kWidth * i + c)] - Lane(mean, c) - Lane(slope, c) * x;
        lowest = std::min(lowest, left);
        highest = std::max(highest, left);
      }
    };
    const int oldest = block_at_ * block_size_;
    pass(oldest, n, -centre);
    pass(0, oldest, n - oldest - centre);
    worst_ = std::max(worst_, highest - lowest);
  }
}

}  // namespace dispersa
