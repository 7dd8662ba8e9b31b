#include "core/control/lyapunov.h"

namespace dispersa {

Matrix2 SolveLyapunov(const AxisGains& gains, const Matrix2& q) {
  // The three distinct elements of A'P + PA = -Q, solved from the first, the last and the mixed one.
  const double p12 = q(0, 0) / (2.0 * gains.kp_1_s2);
  const double p22 = (q(1, 1) + 2.0 * p12) / (2.0 * gains.kd_1_s);
  const double p11 = gains.kd_1_s * p12 + gains.kp_1_s2 * p22 - q(0, 1);
  Matrix2 p;
  p << p11, p12, p12, p22;
  return p;
}

bool IsPositiveDefinite(const Matrix2& m) { return m(0, 0) > 0.0 && m.determinant() > 0.0; }

}  // namespace dispersa
