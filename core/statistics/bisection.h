#pragma once

#include <cstdint>

namespace dispersa {

/// The smallest integer in (low, high] at which a condition holds. The condition must be monotonic: once
/// true, true for all larger integers. It is taken as true at `high`. low < high.
template <typename Condition>
std::int64_t FirstTrue(std::int64_t low, std::int64_t high, Condition condition) {
  while (high - low > 1) {
    const std::int64_t middle = low + (high - low) / 2;
    (condition(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace dispersa
