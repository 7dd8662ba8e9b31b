// The linear-quadratic regulator of an axis: state feedback with the integral as a state.
//
// Plant: what a law commands is divided by the stage's effectiveness, so that e'' = -u with e = reference -
// true; air, actuator and delay are left to the margins. State x = (∫e, e, e'). The regulator u = ki ∫e + kp
// e + kd e' minimises ∫ (q_integral (∫e)² + q_angle e² + q_rate e'² + u²) dt. Its feedback is that of a PID
// law, which flies it.
#pragma once

namespace dispersa {

/// Of the states' squares beside that of u, which weighs 1.
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
/// gains: each step is the Lyapunov equation of the loop closed by the gains before, to rounding. Weights
/// positive; meant for those near 1, that is, for time in units of the loop's own.
RegulatorGains SolveRegulator(const RegulatorWeights& weights);

/// The weights for which gains are optimal: ki², kp² - 2 ki kd, kd² - 2 kp. Some negative: for none.
RegulatorWeights WeightsOf(const RegulatorGains& gains);

}  // namespace dispersa
