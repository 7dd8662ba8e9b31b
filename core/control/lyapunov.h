// The Lyapunov equation behind the adaptation law: A' P + P A = -Q for the error dynamics of one axis.
#pragma once

#include "core/control/autopilot_config.h"
#include "core/math/linear.h"

namespace dispersa {

/// P, symmetric, shape (2, 2), of A = [0 1; -kp -kd] with state (e, de/dt). Exists and is positive definite
/// whenever kp > 0, kd > 0 and Q is symmetric positive definite. Source: the paper's text under (29), with
/// "semi-definite" corrected to definite.
Matrix2 SolveLyapunov(const AxisGains& gains, const Matrix2& q);

/// By Sylvester's criterion.
bool IsPositiveDefinite(const Matrix2& m);

}  // namespace dispersa
