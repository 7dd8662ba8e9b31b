// The linear-quadratic regulator of an axis: state feedback with the integral as a state.
//
// Plant: the law's command is divided by the stage's effectiveness, so e'' = -u with e = reference - true.
// The margins check the effects that this leaves out: air, actuator and delay. State x = (∫e, e, e'). The
// regulator u = ki ∫e + kp e + kd e' minimises ∫ (q_integral (∫e)² + q_angle e² + q_rate e'² + u²) dt. A PID
// law flies this feedback.
#pragma once

namespace dispersa {

/// Weights of the squared states, relative to that of u, which is 1.
struct RegulatorWeights {
  double integral_1_s6 = 0.0;
  double angle_1_s4 = 0.0;
  double rate_1_s2 = 0.0;
};

struct RegulatorGains {
  double ki_1_s3 = 0.0;
  double kp_1_s2 = 0.0;
  double kd_1_s = 0.0;
};

/// Solves the algebraic Riccati equation A'P + PA - PBB'P + Q = 0 by Newton's iteration from stabilising
/// gains, to rounding. Each step solves the Lyapunov equation of the loop closed by the previous gains.
/// Weights must be positive, and near 1: the unit of time must suit the loop.
RegulatorGains SolveRegulator(const RegulatorWeights& weights);

/// The weights for which the gains are optimal: ki², kp² - 2 ki kd, kd² - 2 kp. If one is negative, there are
/// no such weights.
RegulatorWeights WeightsOf(const RegulatorGains& gains);

}  // namespace dispersa
