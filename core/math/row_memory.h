// The row of a table that each lane (core/math/lanes.h) looked up last, and the range of arguments in which
// the row holds. A flight stays in a row for many steps. No lane searches or loads a row then.
//
// A row must follow from the argument alone, never from the row before: a lane's bits do not depend on what
// the lane looked up earlier.
#pragma once

#include "core/math/lanes.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

inline constexpr double kNoEnd = __builtin_inf();

/// Arguments from `low` to below `high`, by lane. All zeros contain nothing.
template <class T>
struct RowRange {
  T low, high;

  DISPERSA_INLINE MaskOf<T> Contains(T x) const { return (x >= low) & (x < high); }
  DISPERSA_INLINE void Set(int lane, double from, double to) {
    Lane(low, lane) = from;
    Lane(high, lane) = to;
  }
  /// No argument is in the range of the lane.
  DISPERSA_INLINE void Forget(int lane) { Set(lane, 0.0, 0.0); }
};

/// Element i of each lane's row in `c[i]`.
template <class T, int kSize>
struct RowMemory {
  RowRange<T> range;
  T c[kSize];

  DISPERSA_INLINE void SetRow(int lane, const double* row) {
    for (int i = 0; i < kSize; ++i) Lane(c[i], lane) = row[i];
  }
};

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
