#include "core/control/loop_table.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/math/constants.h"
#include "core/math/functions.h"

namespace dispersa {

namespace {

// As LoopMargins' own: above this of the lowest mode's frequency a response is the bending's.
constexpr double kBelowModes = 0.7;
// Slower than any pole whose arc has to be counted whole.
constexpr double kSlowest_rad_s = 1e-4;
// A modulus this near 1 is 1: an angle that nothing restores.
constexpr double kOnCircle = 1e-8;
constexpr double kUnstable = -2.0;

double Angle(std::complex<double> z) { return Atan2(z.imag(), z.real()); }

}  // namespace

LoopTable::LoopTable(const AxisPlant& plant, double tick_s, int delay_ticks)
    : tick_s_(tick_s),
      bends_above_rad_s_(plant.lowest_mode_rad_s > 0.0 ? kBelowModes * plant.lowest_mode_rad_s : HUGE_VAL) {
  const Eigen::VectorXcd poles =
      Eigen::EigenSolver<Eigen::MatrixXd>(MatrixExponential(plant.a * tick_s), false).eigenvalues();
  for (Eigen::Index i = 0; i < poles.size(); ++i) {
    const double modulus = Sqrt(std::norm(poles[i]));
    half_turns_ += modulus > 1.0 + kOnCircle ? 1.0 : modulus > 1.0 - kOnCircle ? 0.5 : 0.0;
  }
  const SampledLoop loop(plant, {}, tick_s, delay_ticks);
  frequency_rad_s_ = loop.Frequencies();
  for (double w = 0.8 * frequency_rad_s_.front(); w > kSlowest_rad_s; w *= 0.8)
    frequency_rad_s_.insert(frequency_rad_s_.begin(), w);
  for (const double w : frequency_rad_s_) {
    const SinCos half = SineCosine(0.5 * w * tick_s);
    s_.emplace_back(-2.0 * half.sin * half.sin, 2.0 * half.sin * half.cos);
    SampledLoop::Sensed sensed = loop.SensedAt(w);
    angle_.push_back(sensed.angle);
    rates_.push_back(std::move(sensed.rates));
  }
}

double LoopTable::Surplus(const LinearLaw& law, const std::vector<double>& weights, const LoopGates& gates) const {
  // Of one integrator, at z = 1.
  const bool integrates = law.adapts() && law.leakage_1_s == 0.0;
  double least = HUGE_VAL, turned = 0.0;
  const auto take = [&](double value, double gate) { least = std::min(least, (value - gate) / gate); };
  std::complex<double> before = 0.0;
  for (std::size_t i = 0; i < s_.size(); ++i) {
    std::complex<double> rate = 0.0;
    for (std::size_t k = 0; k < weights.size(); ++k) rate += weights[k] * rates_[i][k];
    const std::complex<double> l = ResponseOf(law, s_[i], angle_[i], rate, tick_s_) / law.effectiveness_1_s2;
    const double w = frequency_rad_s_[i], size = std::norm(l);
    const double from_critical = Angle(-l);
    if (w >= bends_above_rad_s_) {
      const double attenuated = (-10.0 * Log10(size) - gates.gain_db) / gates.gain_db;
      const double turned_away = (kDegPerRad * std::fabs(from_critical) - gates.phase_deg) / gates.phase_deg;
      least = std::min(least, std::max(attenuated, turned_away));
    }
    if (i == 0) {
      // Without an integrator an unstable body diverges at rest.
      if (!integrates && l.real() < 0.0) take(std::fabs(10.0 * Log10(size)), gates.gain_db);
    } else {
      const std::complex<double> step = (1.0 + l) * std::conj(1.0 + before);
      turned += Angle(step);
      if ((l.imag() < 0.0) != (before.imag() < 0.0)) {
        const double share = before.imag() / (before.imag() - l.imag());
        const double real = before.real() + share * (l.real() - before.real());
        if (real < 0.0) take(std::fabs(20.0 * Log10(-real)), gates.gain_db);
      }
      if (w < bends_above_rad_s_ && (size < 1.0) != (std::norm(before) < 1.0)) {
        take(kDegPerRad * std::fabs(from_critical), gates.phase_deg);
        const double lead = from_critical < 0.0 ? from_critical + kTwoPi : from_critical;
        if (gates.delay_s > 0.0) take(lead / w, gates.delay_s);
      }
    }
    before = l;
  }
  const double missing = std::fabs(turned / kPi - half_turns_ - (integrates ? 0.5 : 0.0));
  return missing < 0.5 ? least : kUnstable - missing;
}

}  // namespace dispersa
