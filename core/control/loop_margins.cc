#include "core/control/loop_margins.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/constants.h"
#include "core/math/functions.h"

namespace dispersa {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// The slowest frequency that counts: loops of a launcher live above 0.1 rad/s and burns last a minute.
constexpr double kLowest_rad_s = 0.01;
// Neighbours of the frequency grid lie 2 % apart; crossings are then refined.
constexpr int kFrequencies = 500;
constexpr int kRefinements = 50;

std::complex<double> UnitCircle(double angle_rad) {
  const SinCos c = SineCosine(angle_rad);
  return {c.cos, c.sin};
}

// Without the checks for infinities of the standard's, which cost most of it.
std::complex<double> Times(std::complex<double> a, std::complex<double> b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}
std::complex<double> Inverse(std::complex<double> a) { return std::conj(a) / std::norm(a); }

double Modulus(std::complex<double> z) { return Sqrt(std::norm(z)); }

double Decibel(double ratio) { return 20.0 * Log10(ratio); }

}  // namespace

Eigen::MatrixXd MatrixExponential(const Eigen::MatrixXd& m) {
  int halvings = 0;
  for (double norm = m.cwiseAbs().rowwise().sum().maxCoeff(); norm > 0.5; norm *= 0.5) ++halvings;
  Eigen::MatrixXd scaled = m;
  for (int i = 0; i < halvings; ++i) scaled *= 0.5;
  // 0.5^16 / 16! is below rounding.
  Eigen::MatrixXd term = Eigen::MatrixXd::Identity(m.rows(), m.cols());
  Eigen::MatrixXd sum = term;
  for (int k = 1; k <= 16; ++k) {
    term = term * scaled / k;
    sum += term;
  }
  for (int i = 0; i < halvings; ++i) sum = (sum * sum).eval();
  return sum;
}

SampledLoop::SampledLoop(const AxisPlant& plant, const LinearLaw& law, double tick_s, int delay_ticks)
    : law_(law), tick_s_(tick_s), delay_ticks_(delay_ticks) {
  // Zero-order hold: exp([a b; 0 0] T) = [ad bd; 0 1].
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(5, 5);
  m.topLeftCorner<4, 4>() = plant.a * tick_s;
  m.topRightCorner<4, 1>() = plant.b * tick_s;
  const Eigen::MatrixXd held = MatrixExponential(m);
  ad_ = held.topLeftCorner<4, 4>();
  bd_ = held.topRightCorner<4, 1>();

  // Faddeev and Le Verrier: with D = ad - I, adj(s I - D) = sum of adjoint_k s^k, by falling powers.
  const Eigen::Matrix4d d = ad_ - Eigen::Matrix4d::Identity();
  Eigen::Matrix4d adjoint = Eigen::Matrix4d::Identity();
  denominator_[4] = 1.0;
  for (int k = 3; k >= 0; --k) {
    const Eigen::Vector4d numerator = adjoint * bd_;
    angle_[k] = numerator[0];
    rate_[k] = numerator[1];
    const Eigen::Matrix4d product = d * adjoint;
    denominator_[k] = -product.trace() / (4 - k);
    adjoint = product + denominator_[k] * Eigen::Matrix4d::Identity();
  }
}

std::complex<double> SampledLoop::Response(double frequency_rad_s) const {
  // s = z - 1 keeps its digits near z = 1, where rigid body and integrators have their poles.
  const SinCos half = SineCosine(0.5 * frequency_rad_s * tick_s_);
  const std::complex<double> s(-2.0 * half.sin * half.sin, 2.0 * half.sin * half.cos);
  const auto at = [&](const auto& polynomial) {
    std::complex<double> sum = 0.0;
    for (auto k = polynomial.rbegin(); k != polynomial.rend(); ++k) sum = Times(sum, s) + *k;
    return sum;
  };
  const std::complex<double> inverse = Inverse(at(denominator_));
  const std::complex<double> angle = Times(at(angle_), inverse), rate = Times(at(rate_), inverse);
  std::complex<double> u = law_.kp_1_s2 * angle + law_.kd_1_s * rate;
  if (law_.adapts()) {
    const double share = 1.0 / law_.rules;
    const std::complex<double> mean = s + tick_s_ * law_.leakage_1_s;
    const std::complex<double> departure = mean + tick_s_ * law_.spread_1_s;
    std::complex<double> drive = law_.drive_error * angle + law_.drive_rate * rate;
    if (law_.drive_prediction > 0.0) {
      const std::complex<double> forced = (law_.predictor_1_s - law_.kd_1_s) * rate - law_.kp_1_s2 * angle;
      const std::complex<double> predicted =
          tick_s_ * Times(forced, Inverse(s + tick_s_ * law_.predictor_1_s));
      drive += law_.drive_prediction * (rate - predicted);
    }
    u += tick_s_ * Times(drive, share * Inverse(mean) + (1.0 - share) * Inverse(departure));
  }
  for (const DigitalSection& f : law_.filters) {
    // By powers of s = z - 1.
    const std::complex<double> above = Times(s, f.b0 * s + (2.0 * f.b0 + f.b1)) + (f.b0 + f.b1 + f.b2);
    const std::complex<double> below = Times(s, s + (2.0 + f.a1)) + (1.0 + f.a1 + f.a2);
    u = Times(u, Times(above, Inverse(below)));
  }
  return Times(u, UnitCircle(-frequency_rad_s * tick_s_ * delay_ticks_)) / law_.effectiveness_1_s2;
}

double SampledLoop::SpectralRadius(double gain_factor) const {
  // States: plant, commands on their way (latest first), mean of the consequents, departure of the central
  // one from it (without spread the two are one), two a section of the filters, the prediction of the rate.
  const int first_command = 4;
  const int first_rule = first_command + delay_ticks_;
  const int rule_states = !law_.adapts() ? 0 : law_.spread_1_s > 0.0 ? 2 : 1;
  const int first_filter = first_rule + rule_states;
  const int prediction = first_filter + 2 * static_cast<int>(law_.filters.size());
  const bool predicts = rule_states > 0 && law_.drive_prediction > 0.0;
  const int size = prediction + (predicts ? 1 : 0);
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(size, size);
  m.topLeftCorner<4, 4>() = ad_;
  // The command as a row over the states; e = -attitude.
  Eigen::RowVectorXd command = Eigen::RowVectorXd::Zero(size);
  command[0] = -law_.kp_1_s2;
  command[1] = -law_.kd_1_s;
  const double share = rule_states == 2 ? 1.0 / law_.rules : 1.0;
  for (int i = 0; i < rule_states; ++i) {
    const int rule = first_rule + i;
    const double part = tick_s_ * (i == 0 ? share : 1.0 - share);
    command[rule] = 1.0;
    m(rule, 0) = -part * law_.drive_error;
    m(rule, 1) = -part * law_.drive_rate;
    m(rule, rule) = 1.0 - tick_s_ * (law_.leakage_1_s + (i == 0 ? 0.0 : law_.spread_1_s));
    if (!predicts) continue;
    m(rule, 1) -= part * law_.drive_prediction;
    m(rule, prediction) = -part * law_.drive_prediction;
  }
  if (predicts) {
    m(prediction, 0) = tick_s_ * law_.kp_1_s2;
    m(prediction, 1) = -tick_s_ * (law_.predictor_1_s - law_.kd_1_s);
    m(prediction, prediction) = 1.0 - tick_s_ * law_.predictor_1_s;
  }
  int memory = first_filter;
  for (const DigitalSection& f : law_.filters) {
    const Eigen::RowVectorXd input = command;
    command *= f.b0;
    command[memory] += 1.0;
    m.row(memory) = f.b1 * input - f.a1 * command;
    m(memory, memory + 1) += 1.0;
    m.row(memory + 1) = f.b2 * input - f.a2 * command;
    memory += 2;
  }
  command *= gain_factor / law_.effectiveness_1_s2;
  if (delay_ticks_ == 0) {
    m.topRows<4>() += bd_ * command;
  } else {
    m.row(first_command) = command;
    for (int i = 1; i < delay_ticks_; ++i) m(first_command + i, first_command + i - 1) = 1.0;
    m.block<4, 1>(0, first_rule - 1) = bd_;
  }
  const Eigen::VectorXcd values = Eigen::EigenSolver<Eigen::MatrixXd>(m, false).eigenvalues();
  double largest = 0.0;
  for (Eigen::Index i = 0; i < values.size(); ++i) largest = std::max(largest, Modulus(values[i]));
  return largest;
}

// The frequency between two at which the gain crosses 1, or the response the real axis.
double SampledLoop::Refine(double low, double high, bool of_gain) const {
  const auto value = [&](double w) {
    const std::complex<double> l = Response(w);
    return of_gain ? std::norm(l) - 1.0 : l.imag();
  };
  const bool low_negative = value(low) < 0.0;
  for (int i = 0; i < kRefinements; ++i) {
    const double middle = 0.5 * (low + high);
    ((value(middle) < 0.0) == low_negative ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

LoopMargins SampledLoop::Margins() const {
  LoopMargins margins;
  margins.stable = SpectralRadius(1.0) < 1.0;
  if (!margins.stable) return margins;
  margins.gain_up_db = margins.gain_down_db = margins.delay_s = kInfinity;
  margins.phase_deg = 180.0;

  const auto critical = [&](std::complex<double> l) {
    if (l.real() >= 0.0) return;
    const double db = -Decibel(-l.real());
    if (db > 0.0)
      margins.gain_up_db = std::min(margins.gain_up_db, db);
    else
      margins.gain_down_db = std::min(margins.gain_down_db, -db);
  };
  const double nyquist = kPi / tick_s_;
  critical(Response(nyquist));
  // An aerodynamically unstable body without integral action diverges without oscillation: at z = 1. With
  // the integrator of an adapting law, or of a body that the air leaves alone, L is infinite there.
  const Eigen::Matrix4d at_rest = Eigen::Matrix4d::Identity() - ad_;
  if (!law_.adapts() && std::fabs(at_rest.determinant()) > 0.0) {
    const std::complex<double> l = Response(0.0);
    if (std::isfinite(l.real())) critical(l.real());
  }

  const double ratio = Pow(nyquist / kLowest_rad_s, 1.0 / kFrequencies);
  double w = kLowest_rad_s;
  std::complex<double> l = Response(w);
  for (int i = 1; i <= kFrequencies; ++i) {
    const double next_w = i == kFrequencies ? nyquist : w * ratio;
    const std::complex<double> next = Response(next_w);
    if ((l.imag() < 0.0) != (next.imag() < 0.0) && i < kFrequencies)
      critical(Response(Refine(w, next_w, false)).real());
    if ((std::norm(l) < 1.0) != (std::norm(next) < 1.0)) {
      const double crossover = Refine(w, next_w, true);
      const std::complex<double> at = Response(crossover);
      // Angle from -1, counter-clockwise, to L, in [0, 2 pi): what a delay may turn.
      double lead = Atan2(at.imag(), at.real()) + kPi;
      if (lead >= kTwoPi) lead -= kTwoPi;
      margins.delay_s = std::min(margins.delay_s, lead / crossover);
      margins.phase_deg = std::min(margins.phase_deg, kDegPerRad * std::min(lead, kTwoPi - lead));
      margins.crossover_rad_s = std::max(margins.crossover_rad_s, crossover);
    }
    w = next_w;
    l = next;
  }
  return margins;
}

}  // namespace dispersa
