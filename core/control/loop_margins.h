// Stability margins of one sampled attitude loop: the rigid body, its actuator and its delays are exact in
// discrete time. Bending and slosh are not modelled: these are rigid-body margins.
#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <vector>

#include "core/control/filter.h"
#include "core/math/linear.h"

namespace dispersa {

/// Continuous plant of one axis about an operating point, x' = a x + b d. State: attitude (rad), its rate,
/// nozzle deflection (rad), its rate; d: commanded deflection, rad.
struct AxisPlant {
  Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
  Eigen::Vector4d b = Eigen::Vector4d::Zero();
};

/// A control law about zero error: u = kp e + kd e' + w, and the command is u, filtered, / effectiveness.
///
/// The adaptation law of the fuzzy rules, linearised there, learns in the central rule alone and spreads over
/// all: w is driven by drive_error e + drive_rate e' through the mean of `rules` consequents, an integrator
/// of gain 1 / rules that leaks at `leakage`, and the central rule's departure from the mean, which decays at
/// leakage + spread. With one rule it is the integral of a PID law. Both drives 0: frozen, PD.
struct LinearLaw {
  double kp_1_s2 = 0.0;
  double kd_1_s = 0.0;
  double effectiveness_1_s2 = 0.0;  ///< as the autopilot assumes it
  double drive_error = 0.0;         ///< gamma p12, 1/s³
  double drive_rate = 0.0;          ///< gamma p22, 1/s²
  double leakage_1_s = 0.0;
  double spread_1_s = 0.0;
  int rules = 1;
  /// Composite adaptation: w is driven by this times the miss of a prediction of e', r' = -kp e - kd e' +
  /// predictor (e' - r).
  double drive_prediction = 0.0;  ///< gamma p22 composite, 1/s²
  double predictor_1_s = 0.0;
  std::vector<DigitalSection> filters;  ///< of u, in series

  bool adapts() const { return drive_error != 0.0 || drive_rate != 0.0; }
};

struct LoopMargins {
  bool stable = false;        ///< of the closed loop; the margins of an unstable one are 0
  double gain_up_db = 0.0;    ///< the gain may grow by this; +infinity where nothing limits it
  double gain_down_db = 0.0;  ///< the gain may fall by this; likewise
  double phase_deg = 0.0;     ///< least at any crossover of 0 dB, either way
  double delay_s = 0.0;       ///< further delay that destabilises
  double crossover_rad_s = 0.0;  ///< highest crossover of 0 dB
};

/// The loop cut at the command: measurement at a tick, command held over a tick, `delay_ticks` later.
class SampledLoop {
 public:
  SampledLoop(const AxisPlant& plant, const LinearLaw& law, double tick_s, int delay_ticks);

  /// Return ratio L at z = exp(i w T), negative feedback: the closed loop is critical where L = -1.
  std::complex<double> Response(double frequency_rad_s) const;
  /// Largest modulus of the closed loop's eigenvalues when the gain is multiplied; below 1: stable.
  double SpectralRadius(double gain_factor) const;
  LoopMargins Margins() const;

 private:
  struct Crossing;
  double Refine(double low, double high, bool of_gain) const;

  Eigen::Matrix4d ad_;  ///< x(k+1) = ad x(k) + bd d(k)
  Eigen::Vector4d bd_;
  /// (z I - ad)⁻¹ bd, angle and rate, as quotients of polynomials in z - 1, rising powers.
  std::array<double, 4> angle_, rate_;
  std::array<double, 5> denominator_;
  LinearLaw law_;
  double tick_s_;
  int delay_ticks_;
};

/// exp(m) by a Taylor series with scaling and squaring, to rounding.
Eigen::MatrixXd MatrixExponential(const Eigen::MatrixXd& m);

}  // namespace dispersa
