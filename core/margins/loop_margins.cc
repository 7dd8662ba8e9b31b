#include "core/margins/loop_margins.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/constants.h"
#include "core/math/functions.h"
#include "core/math/matrices.h"

namespace dispersa {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// The slowest frequency that counts: loops of a launcher live above 0.1 rad/s and burns last a minute.
constexpr double kLowest_rad_s = 0.01;
// Neighbours of the frequency grid lie 2 % apart; crossings are then refined.
constexpr int kFrequencies = 500;
constexpr int kRefinements = 50;
// Attenuations by 6 and 3 dB, squared.
constexpr double k6db2 = 0.251188643150958, k3db2 = 0.501187233627272;

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

SampledLoop::SampledLoop(const AxisPlant& plant, const LinearLaw& law, double tick_s, int delay_ticks)
    : plant_(plant), law_(law), tick_s_(tick_s), delay_ticks_(delay_ticks) {
  // Zero-order hold: exp([a b; 0 0] T) = [ad bd; 0 1].
  const Eigen::Index n = plant.a.rows();
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(n + 1, n + 1);
  m.topLeftCorner(n, n) = plant.a * tick_s;
  m.topRightCorner(n, 1) = plant.b * tick_s;
  const Eigen::MatrixXd held = MatrixExponential(m);
  ad_ = held.topLeftCorner(n, n);
  bd_ = held.topRightCorner(n, 1);

  const RateSensor& first = plant.rates.front();
  is_rigid_ = n == 4 && plant.rates.size() == 1 && first.weight == 1.0 && first.delay_ticks == 0.0 &&
              first.section.b0 == 1.0 && first.section.b1 == 0.0 && first.section.b2 == 0.0;
  if (!is_rigid_) {
    const auto [form, turn] = HessenbergOf(ad_ - Eigen::MatrixXd::Identity(n, n));
    hessenberg_ = form;
    driven_ = turn.transpose() * bd_;
    attitude_row_ = plant.attitude * turn;
    for (const RateSensor& sensor : plant.rates) rate_rows_.push_back(sensor.rate * turn);
    return;
  }
  // Faddeev and Le Verrier: with D = ad - I, adj(s I - D) = sum of adjoint_k s^k, by falling powers.
  const Eigen::Matrix4d d = Eigen::Matrix4d(ad_) - Eigen::Matrix4d::Identity();
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

SampledLoop::Measured SampledLoop::Rigid(std::complex<double> s) const {
  const auto at = [&](const auto& polynomial) {
    std::complex<double> sum = 0.0;
    for (auto k = polynomial.rbegin(); k != polynomial.rend(); ++k) sum = Times(sum, s) + *k;
    return sum;
  };
  const std::complex<double> inverse = Inverse(at(denominator_));
  return {Times(at(angle_), inverse), Times(at(rate_), inverse)};
}

namespace {

// A section at z = 1 + s, by powers of s.
std::complex<double> SectionAt(const DigitalSection& f, std::complex<double> s) {
  const std::complex<double> above = Times(s, f.b0 * s + (2.0 * f.b0 + f.b1)) + (f.b0 + f.b1 + f.b2);
  const std::complex<double> below = Times(s, s + (2.0 + f.a1)) + (1.0 + f.a1 + f.a2);
  return Times(above, Inverse(below));
}

}  // namespace

// (s I - H) x = driven by Gaussian elimination with exchanges of neighbouring rows; then the sensors.
SampledLoop::Sensed SampledLoop::BentSensed(std::complex<double> s, double angle_rad) const {
  const Eigen::Index n = hessenberg_.rows();
  Eigen::MatrixXcd m = -hessenberg_.cast<std::complex<double>>();
  m.diagonal().array() += s;
  Eigen::VectorXcd x = driven_.cast<std::complex<double>>();
  for (Eigen::Index k = 0; k + 1 < n; ++k) {
    if (std::norm(m(k + 1, k)) > std::norm(m(k, k))) {
      for (Eigen::Index j = k; j < n; ++j) std::swap(m(k, j), m(k + 1, j));
      std::swap(x[k], x[k + 1]);
    }
    const std::complex<double> factor = Times(m(k + 1, k), Inverse(m(k, k)));
    for (Eigen::Index j = k + 1; j < n; ++j) m(k + 1, j) -= Times(factor, m(k, j));
    x[k + 1] -= Times(factor, x[k]);
  }
  for (Eigen::Index k = n - 1; k >= 0; --k) {
    for (Eigen::Index j = k + 1; j < n; ++j) x[k] -= Times(m(k, j), x[j]);
    x[k] = Times(x[k], Inverse(m(k, k)));
  }
  const auto row = [&](const Eigen::RowVectorXd& r) {
    std::complex<double> sum = 0.0;
    for (Eigen::Index i = 0; i < n; ++i) sum += r[i] * x[i];
    return sum;
  };
  Sensed sensed{row(attitude_row_), {}};
  for (std::size_t i = 0; i < rate_rows_.size(); ++i) {
    const RateSensor& sensor = plant_.rates[i];
    std::complex<double> rate = Times(row(rate_rows_[i]), SectionAt(sensor.section, s));
    if (sensor.delay_ticks > 0.0) rate = Times(rate, UnitCircle(-angle_rad * sensor.delay_ticks));
    sensed.rates.push_back(rate);
  }
  return sensed;
}

SampledLoop::Measured SampledLoop::Bent(std::complex<double> s, double angle_rad) const {
  const Sensed sensed = BentSensed(s, angle_rad);
  Measured measured{sensed.angle, 0.0};
  for (std::size_t i = 0; i < sensed.rates.size(); ++i)
    measured.rate += plant_.rates[i].weight * sensed.rates[i];
  return measured;
}

std::complex<double> ResponseOf(const LinearLaw& law, std::complex<double> s, std::complex<double> angle,
                                std::complex<double> rate, double tick_s) {
  std::complex<double> u = law.kp_1_s2 * angle + law.kd_1_s * rate;
  if (law.adapts()) {
    const double share = 1.0 / law.rules;
    const std::complex<double> mean = s + tick_s * law.leakage_1_s;
    const std::complex<double> departure = mean + tick_s * law.spread_1_s;
    std::complex<double> drive = law.drive_error * angle + law.drive_rate * rate;
    if (law.drive_prediction > 0.0) {
      const std::complex<double> forced = (law.predictor_1_s - law.kd_1_s) * rate - law.kp_1_s2 * angle;
      const std::complex<double> predicted = tick_s * Times(forced, Inverse(s + tick_s * law.predictor_1_s));
      drive += law.drive_prediction * (rate - predicted);
    }
    u += tick_s * Times(drive, share * Inverse(mean) + (1.0 - share) * Inverse(departure));
  }
  for (const DigitalSection& f : law.filters) u = Times(u, SectionAt(f, s));
  return u;
}

namespace {

// z - 1, which keeps its digits near z = 1, where rigid body and integrators have their poles.
std::complex<double> FromOne(double angle_rad) {
  const SinCos half = SineCosine(0.5 * angle_rad);
  return {-2.0 * half.sin * half.sin, 2.0 * half.sin * half.cos};
}

}  // namespace

SampledLoop::Sensed SampledLoop::SensedAt(double frequency_rad_s) const {
  const std::complex<double> s = FromOne(frequency_rad_s * tick_s_);
  Sensed sensed;
  if (is_rigid_) {
    const Measured measured = Rigid(s);
    sensed = {measured.angle, {measured.rate}};
  } else {
    sensed = BentSensed(s, frequency_rad_s * tick_s_);
  }
  const std::complex<double> late = UnitCircle(-frequency_rad_s * tick_s_ * delay_ticks_);
  sensed.angle = Times(sensed.angle, late);
  for (std::complex<double>& rate : sensed.rates) rate = Times(rate, late);
  return sensed;
}

std::complex<double> SampledLoop::Response(double frequency_rad_s) const {
  const std::complex<double> s = FromOne(frequency_rad_s * tick_s_);
  const Measured measured = is_rigid_ ? Rigid(s) : Bent(s, frequency_rad_s * tick_s_);
  const std::complex<double> u = ResponseOf(law_, s, measured.angle, measured.rate, tick_s_);
  return Times(u, UnitCircle(-frequency_rad_s * tick_s_ * delay_ticks_)) / law_.effectiveness_1_s2;
}

double SampledLoop::SpectralRadius(double gain_factor) const {
  // States in their order. First the plant, the commands on their way (latest first), and the mean of the
  // consequents. Then the difference of the central consequent from the mean (without spread the two are
  // one). Then two states for each section of the filters, and the prediction of the rate. Last, for each
  // gyro, two states of its section and its outputs of the last ticks.
  const int plant_states = static_cast<int>(ad_.rows());
  const int first_command = plant_states;
  const int first_rule = first_command + delay_ticks_;
  const int rule_states = !law_.adapts() ? 0 : law_.spread_1_s > 0.0 ? 2 : 1;
  const int first_filter = first_rule + rule_states;
  const int prediction = first_filter + 2 * static_cast<int>(law_.filters.size());
  const bool predicts = rule_states > 0 && law_.drive_prediction > 0.0;
  int size = prediction + (predicts ? 1 : 0);
  const int first_gyro = size;
  if (!is_rigid_)
    for (const RateSensor& sensor : plant_.rates) size += 2 + static_cast<int>(std::ceil(sensor.delay_ticks));
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(size, size);
  m.topLeftCorner(plant_states, plant_states) = ad_;
  // The measured angle and rate, as rows over the states.
  Eigen::RowVectorXd angle = Eigen::RowVectorXd::Zero(size), rate = angle;
  if (is_rigid_) {
    angle[0] = rate[1] = 1.0;
  } else {
    angle.head(plant_states) = plant_.attitude;
    int gyro = first_gyro;
    for (const RateSensor& sensor : plant_.rates) {
      const DigitalSection& f = sensor.section;
      Eigen::RowVectorXd input = Eigen::RowVectorXd::Zero(size);
      input.head(plant_states) = sensor.rate;
      Eigen::RowVectorXd output = f.b0 * input;
      output[gyro] += 1.0;
      m.row(gyro) = f.b1 * input - f.a1 * output;
      m(gyro, gyro + 1) += 1.0;
      m.row(gyro + 1) = f.b2 * input - f.a2 * output;
      gyro += 2;
      for (int tick = static_cast<int>(std::ceil(sensor.delay_ticks)); tick > 0; --tick) {
        m.row(gyro) = output;
        output.setZero();
        output[gyro++] = 1.0;
      }
      rate += sensor.weight * output;
    }
  }
  // The command as a row over the states; e = -attitude.
  Eigen::RowVectorXd command = -law_.kp_1_s2 * angle - law_.kd_1_s * rate;
  const double share = rule_states == 2 ? 1.0 / law_.rules : 1.0;
  for (int i = 0; i < rule_states; ++i) {
    const int rule = first_rule + i;
    const double part = tick_s_ * (i == 0 ? share : 1.0 - share);
    command[rule] = 1.0;
    m.row(rule) = -part * law_.drive_error * angle - part * law_.drive_rate * rate;
    m(rule, rule) += 1.0 - tick_s_ * (law_.leakage_1_s + (i == 0 ? 0.0 : law_.spread_1_s));
    if (!predicts) continue;
    m.row(rule) -= part * law_.drive_prediction * rate;
    m(rule, prediction) = -part * law_.drive_prediction;
  }
  if (predicts) {
    m.row(prediction) = tick_s_ * law_.kp_1_s2 * angle - tick_s_ * (law_.predictor_1_s - law_.kd_1_s) * rate;
    m(prediction, prediction) += 1.0 - tick_s_ * law_.predictor_1_s;
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
    m.topRows(plant_states) += bd_ * command;
  } else {
    m.row(first_command) = command;
    for (int i = 1; i < delay_ticks_; ++i) m(first_command + i, first_command + i - 1) = 1.0;
    m.block(0, first_rule - 1, plant_states, 1) = bd_;
  }
  const Eigen::VectorXcd values = Eigenvalues(m);
  double largest = 0.0;
  for (Eigen::Index i = 0; i < values.size(); ++i) largest = std::max(largest, Modulus(values[i]));
  return largest;
}

// The frequency between two at which a value of the response changes its sign.
template <typename Value>
double SampledLoop::Refine(double low, double high, const Value& of_response) const {
  const auto value = [&](double w) { return of_response(Response(w)); };
  const bool low_negative = value(low) < 0.0;
  for (int i = 0; i < kRefinements; ++i) {
    const double middle = 0.5 * (low + high);
    ((value(middle) < 0.0) == low_negative ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// The frequency between two at which the response's modulus, squared, crosses a level.
double SampledLoop::CrossingOf(double level2, double low, double high) const {
  return Refine(low, high, [&](std::complex<double> l) { return std::norm(l) - level2; });
}

// Neighbours 2 % apart from the slowest to half the sampling; near a mode as many within its width.
std::vector<double> SampledLoop::Frequencies() const {
  const double nyquist = kPi / tick_s_;
  const double ratio = Pow(nyquist / kLowest_rad_s, 1.0 / kFrequencies);
  std::vector<double> all;
  double w = kLowest_rad_s;
  for (int i = 0; i < kFrequencies; ++i, w *= ratio) all.push_back(w);
  all.push_back(nyquist);
  if (plant_.lowest_mode_rad_s == 0.0) return all;
  const Eigen::VectorXcd modes = Eigenvalues(plant_.a);
  all.push_back(kBelowModes * plant_.lowest_mode_rad_s);
  constexpr int kNear = 40;
  for (Eigen::Index i = 0; i < modes.size(); ++i) {
    const double frequency = modes[i].imag(), width = std::fabs(modes[i].real());
    if (frequency <= 0.0) continue;
    // By the angle that a resonance turns through: atan of the distance in widths.
    for (int k = -kNear + 1; k < kNear; ++k) {
      const SinCos angle = SineCosine(0.5 * kPi * k / kNear);
      const double near = frequency + std::max(width, 1e-4 * frequency) * angle.sin / angle.cos;
      if (near > kLowest_rad_s && near < nyquist) all.push_back(near);
    }
  }
  std::sort(all.begin(), all.end());
  return all;
}

LoopMargins SampledLoop::Margins() const {
  LoopMargins margins;
  margins.stable = SpectralRadius(1.0) < (plant_.drifts ? Exp(kLowest_rad_s * tick_s_) : 1.0);
  if (!margins.stable && is_rigid_) return margins;
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
  const Eigen::MatrixXd at_rest = Eigen::MatrixXd::Identity(ad_.rows(), ad_.cols()) - ad_;
  if (!law_.adapts() && std::fabs(DeterminantOf(at_rest)) > 0.0) {
    const std::complex<double> l = Response(0.0);
    if (std::isfinite(l.real())) critical(l.real());
  }

  const double bends_above_rad_s =
      plant_.lowest_mode_rad_s > 0.0 ? kBelowModes * plant_.lowest_mode_rad_s : kInfinity;
  const struct {
    double level2;
    double& phase_deg;
  } not_attenuated[] = {{k6db2, margins.bending_phase_6db_deg}, {k3db2, margins.bending_phase_3db_deg}};
  const auto from_critical = [](std::complex<double> at) {
    return kDegPerRad * std::fabs(Atan2(-at.imag(), -at.real()));
  };
  // Between two neighbours the phase is least at an edge of the range without attenuation, or at a turning
  // point, which neighbours this close resolve. It is 0 where the response crosses the axis within that
  // range.
  const auto bend = [&](double w, std::complex<double> before, double next_w, std::complex<double> at) {
    margins.bending_peak_db = std::max(margins.bending_peak_db, 0.5 * Decibel(std::norm(at)));
    for (const auto& [level2, phase_deg] : not_attenuated) {
      const bool was = std::norm(before) >= level2, is = std::norm(at) >= level2;
      if (is) phase_deg = std::min(phase_deg, from_critical(at));
      if (w >= bends_above_rad_s && was != is)
        phase_deg = std::min(phase_deg, from_critical(Response(CrossingOf(level2, w, next_w))));
    }
  };
  const std::vector<double> grid = Frequencies();
  std::complex<double> l = Response(grid.front());
  for (std::size_t i = 1; i < grid.size(); ++i) {
    const double w = grid[i - 1], next_w = grid[i];
    const std::complex<double> next = Response(next_w);
    if (next_w >= bends_above_rad_s) bend(w, l, next_w, next);
    if ((l.imag() < 0.0) != (next.imag() < 0.0) && i + 1 < grid.size()) {
      const double real =
          Response(Refine(w, next_w, [](std::complex<double> at) { return at.imag(); })).real();
      critical(real);
      for (const auto& [level2, phase_deg] : not_attenuated)
        if (w >= bends_above_rad_s && real <= -Sqrt(level2)) phase_deg = 0.0;
    }
    if ((std::norm(l) < 1.0) != (std::norm(next) < 1.0)) {
      const double crossover = CrossingOf(1.0, w, next_w);
      const std::complex<double> at = Response(crossover);
      // Angle from -1, counter-clockwise, to L, in [0, 2 pi): what a delay may turn.
      double lead = Atan2(at.imag(), at.real()) + kPi;
      if (lead >= kTwoPi) lead -= kTwoPi;
      margins.delay_s = std::min(margins.delay_s, lead / crossover);
      // A mode's phase has a gate of its own; a delay turns it as it turns the rest, and sooner.
      if (w < bends_above_rad_s) {
        margins.phase_deg = std::min(margins.phase_deg, kDegPerRad * std::min(lead, kTwoPi - lead));
        margins.crossover_rad_s = std::max(margins.crossover_rad_s, crossover);
      }
    }
    l = next;
  }
  if (margins.stable) return margins;
  LoopMargins lost;
  lost.bending_peak_db = margins.bending_peak_db;
  lost.bending_phase_6db_deg = lost.bending_phase_3db_deg = 0.0;
  return lost;
}

}  // namespace dispersa
