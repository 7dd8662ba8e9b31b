#include "core/guidance/curve_estimate.h"

#include <cmath>

#include "core/math/functions.h"

namespace dispersa {

namespace {

// Standard deviations: of a reading, and of ln k and ln c before the first one.
constexpr double kCurveReading = 2e-3, kBurnRate = 0.03, kCurveExhaust = 0.01;
constexpr double kMostOfCurve = 0.15;
// The curve is steep if its thrust changes by this part within what burn rates move it.
constexpr double kSteep = 0.1;
constexpr double kRateStep = 0.01;

// ln a of the nominal motor at a burn rate.
double LogAcceleration(const GuidedStage& stage, double mass_kg, double rate, double since_ignition_s) {
  const MotorBurn& burn = stage.burn;
  const double at_s = rate * since_ignition_s;
  return Log(rate * burn.vacuum_thrust_n * burn.Fraction(at_s) /
             (mass_kg - burn.propellant_mass_kg + burn.Propellant(at_s)));
}

}  // namespace

void CurveEstimate::Add(const GuidedStage& nominal, double since_ignition_s, double specific_force_m_s2,
                        double expelled_kg) {
  const MotorBurn& burn = nominal.burn;
  const double before = burn.Fraction((1.0 - kBurnRate) * since_ignition_s),
               after = burn.Fraction((1.0 + kBurnRate) * since_ignition_s);
  if (!(before > 0.0) || !(after > 0.0) || !(specific_force_m_s2 > 0.0)) return;
  if (std::fabs(Log(after / before)) > kSteep) return;
  const double mass_kg = nominal.LessDropped(nominal.ignition_mass_kg - expelled_kg);
  const double log_rate = Found().rate, rate = Exp(log_rate);
  const double faster = LogAcceleration(nominal, mass_kg, (1.0 + kRateStep) * rate, since_ignition_s),
               slower = LogAcceleration(nominal, mass_kg, (1.0 - kRateStep) * rate, since_ignition_s);
  const double x = (faster - slower) / (2.0 * kRateStep);
  const double y =
      Log(specific_force_m_s2) - LogAcceleration(nominal, mass_kg, rate, since_ignition_s) + x * log_rate;
  if (!std::isfinite(x) || !std::isfinite(y)) return;
  sum_ += 1.0;
  sum_x_ += x;
  sum_xx_ += x * x;
  sum_y_ += y;
  sum_xy_ += x * y;
}

CurveEstimate::Logs CurveEstimate::Found() const {
  const double kk = sum_xx_ + Square(kCurveReading / kBurnRate),
               cc = sum_ + Square(kCurveReading / kCurveExhaust);
  const double determinant = kk * cc - Square(sum_x_), most = Log(1.0 + kMostOfCurve);
  return {Clamp((cc * sum_xy_ - sum_x_ * sum_y_) / determinant, -most, most),
          Clamp((kk * sum_y_ - sum_x_ * sum_xy_) / determinant, -most, most)};
}

void CurveEstimate::Apply(MotorBurn& burn) const {
  const Logs found = Found();
  const double rate = Exp(found.rate), exhaust = Exp(found.exhaust);
  burn.vacuum_thrust_n *= rate * exhaust;
  burn.full_flow_kg_s *= rate;
  burn.curve_rate *= rate;
  burn.duration_s /= rate;
}

}  // namespace dispersa
