// Convergence of the shipped fixed-step scheme, of order 4, to an exact solution.
#pragma once

#include "tests/test.h"

namespace dispersa {

/// Errors, lengths not below 0, at some step and at half of it: 12 of 16 is asked for, because terms of
/// higher order still show. `rounding` bounds what the arithmetic of doubles adds; the error at the longer
/// step must stand well above it, or the test would show nothing.
inline void ExpectFourthOrder(double coarse, double fine, double rounding) {
  std::printf("error %.2g, with half the step %.2g, ratio %.3g\n", coarse, fine, coarse / fine);
  EXPECT_GT(coarse, 20.0 * rounding);
  EXPECT_LE(fine, coarse / 12.0 + rounding) << "from " << coarse;
}

}  // namespace dispersa
