// Stability margins of one sampled attitude loop: body, bending modes, actuator, gyros and delays are exact
// in discrete time. Slosh is not modelled.
#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <limits>
#include <vector>

#include "core/control/filter.h"
#include "core/math/linear.h"

namespace dispersa {

/// Above this of the lowest mode's frequency a response is the bending's.
inline constexpr double kBelowModes = 0.7;

/// A part of the measured rate: that of a place, through a gyro.
struct RateSensor {
  Eigen::RowVectorXd rate;  ///< of the plant's state
  DigitalSection section;   ///< from its values at ticks to what the gyro shows
  double weight = 1.0;
  double delay_ticks = 0.0;  ///< what holding a sample over several ticks is worth
};

/// Continuous plant of one axis about an operating point, x' = a x + b d, with d the commanded deflection,
/// rad. State: attitude (rad), its rate, nozzle deflection (rad), its rate. A bending body adds the modal
/// coordinates and their rates, a drifting one its lateral velocity (m/s).
struct AxisPlant {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(4, 4);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(4);
  Eigen::RowVectorXd attitude = Eigen::RowVectorXd::Unit(4, 0);  ///< as measured
  std::vector<RateSensor> rates = {{Eigen::RowVectorXd::Unit(4, 1), {}, 1.0, 0.0}};
  double lowest_mode_rad_s = 0.0;  ///< 0: a rigid body
  /// Its path takes part: one that departs more slowly than 0.01 1/s is guidance's matter, and no loss.
  bool drifts = false;
};

/// A control law about zero error: u = kp e + kd e' + w. The command is u, filtered, / effectiveness.
///
/// The adaptation law of the fuzzy rules, linearised there, learns in the central rule alone and spreads over
/// all. drive_error e + drive_rate e' drives two parts of w. One is the mean of `rules` consequents, an
/// integrator of gain 1 / rules that leaks at `leakage`. The other is the central rule's departure from the
/// mean, which decays at leakage + spread. With one rule it is the integral of a PID law. With both drives 0
/// the law is frozen, or PD.
struct LinearLaw {
  double kp_1_s2 = 0.0;
  double kd_1_s = 0.0;
  double effectiveness_1_s2 = 0.0;  ///< as the autopilot assumes it
  double drive_error = 0.0;         ///< gamma p12, 1/s³
  double drive_rate = 0.0;          ///< gamma p22, 1/s²
  double leakage_1_s = 0.0;
  double spread_1_s = 0.0;
  int rules = 1;
  /// Composite adaptation: w is also driven by this factor times the prediction error of e'. The prediction
  /// follows r' = -kp e - kd e' + predictor (e' - r).
  double drive_prediction = 0.0;  ///< gamma p22 composite, 1/s²
  double predictor_1_s = 0.0;
  std::vector<DigitalSection> filters;  ///< of u, in series

  bool adapts() const { return drive_error != 0.0 || drive_rate != 0.0; }
};

struct LoopMargins {
  bool stable = false;           ///< of the closed loop (the margins of an unstable one are 0)
  double gain_up_db = 0.0;       ///< the gain may grow by this (+infinity: no limit)
  double gain_down_db = 0.0;     ///< the gain may fall by this (+infinity: no limit)
  double phase_deg = 0.0;        ///< least at any crossover of 0 dB, either way
  double delay_s = 0.0;          ///< further delay that destabilises
  double crossover_rad_s = 0.0;  ///< highest crossover of 0 dB
  // Values above 0.7 of a bending body's lowest mode. Phase and crossover above are then those below it, and
  // delay is that of every crossover. The peak is that of the open loop, also of an unstable one.
  double bending_peak_db = -std::numeric_limits<double>::infinity();
  /// Least angle between the response and -1 wherever it is not attenuated by 6 dB, and by 3 dB; 180 if it is
  /// attenuated everywhere.
  double bending_phase_6db_deg = 180.0;
  double bending_phase_3db_deg = 180.0;
};

/// u, filtered, of what is measured: angle and rate at z = 1 + s.
std::complex<double> ResponseOf(const LinearLaw& law, std::complex<double> s, std::complex<double> angle,
                                std::complex<double> rate, double tick_s);

/// The loop cut at the command: measurement at a tick, command held over a tick, `delay_ticks` later.
class SampledLoop {
 public:
  SampledLoop(const AxisPlant& plant, const LinearLaw& law, double tick_s, int delay_ticks);

  /// Return ratio L at z = exp(i w T), negative feedback: the closed loop is critical where L = -1.
  std::complex<double> Response(double frequency_rad_s) const;
  /// Largest modulus of the closed loop's eigenvalues with the gain multiplied. Below 1: stable.
  double SpectralRadius(double gain_factor) const;
  LoopMargins Margins() const;

  /// Frequencies of Margins(), rising: 2 % apart, and closer about the modes.
  std::vector<double> Frequencies() const;
  /// Attitude and the rate that each sensor shows, before its weight, per command that is on its way for the
  /// delay.
  struct Sensed {
    std::complex<double> angle;
    std::vector<std::complex<double>> rates;
  };
  Sensed SensedAt(double frequency_rad_s) const;

 private:
  /// Attitude and rate as measured, per command, at s = z - 1.
  struct Measured {
    std::complex<double> angle, rate;
  };
  Measured Rigid(std::complex<double> s) const;
  Measured Bent(std::complex<double> s, double angle_rad) const;
  Sensed BentSensed(std::complex<double> s, double angle_rad) const;
  template <typename Value>
  double Refine(double low, double high, const Value& of_response) const;
  double CrossingOf(double level2, double low, double high) const;

  AxisPlant plant_;
  bool is_rigid_;       ///< of four states, measured as they are
  Eigen::MatrixXd ad_;  ///< x(k+1) = ad x(k) + bd d(k)
  Eigen::VectorXd bd_;
  /// Rigid: (z I - ad)⁻¹ bd, angle and rate, as quotients of polynomials in z - 1, rising powers.
  std::array<double, 4> angle_, rate_;
  std::array<double, 5> denominator_;
  /// Otherwise: ad - I in upper Hessenberg form, with bd and the measured rows in its coordinates
  Eigen::MatrixXd hessenberg_;
  Eigen::VectorXd driven_;
  Eigen::RowVectorXd attitude_row_;
  std::vector<Eigen::RowVectorXd> rate_rows_;
  LinearLaw law_;
  double tick_s_;
  int delay_ticks_;
};

}  // namespace dispersa
