#include "core/margins/loop_table.h"

#include <algorithm>
#include <cmath>

#include "core/math/constants.h"
#include "core/math/functions.h"
#include "core/math/matrices.h"

namespace dispersa {

namespace {

// Slower than any pole whose arc has to be counted whole.
constexpr double kSlowest_rad_s = 1e-4;
// A modulus this near 1 is 1: an angle that nothing restores.
constexpr double kOnCircle = 1e-8;
constexpr double kUnstable = -2.0;
constexpr int kBetween = 4;  // parts of a straight line between two frequencies

double Angle(std::complex<double> z) { return Atan2(z.imag(), z.real()); }

}  // namespace

LoopTable::LoopTable(const AxisPlant& plant, double tick_s, int delay_ticks)
    : tick_s_(tick_s),
      bends_above_rad_s_(plant.lowest_mode_rad_s > 0.0 ? kBelowModes * plant.lowest_mode_rad_s : HUGE_VAL) {
  const Eigen::VectorXcd poles = Eigenvalues(MatrixExponential(plant.a * tick_s));
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

double LoopTable::Surplus(const LinearLaw& law, const std::vector<double>& weights,
                          const LoopGates& gates) const {
  // The loop then has an integrator, at z = 1.
  const bool integrates = law.adapts() && law.leakage_1_s == 0.0;
  double least = HUGE_VAL;
  const auto take = [&](double value, double gate) { least = std::min(least, (value - gate) / gate); };
  const auto by_phase = [&](std::complex<double> l) {
    return (kDegPerRad * std::fabs(Angle(-l)) - gates.phase_deg) / gates.phase_deg;
  };
  // Most bending responses are so small that they cannot be the least: no logarithm for them.
  double least_known = least, worth_looking = 0.0;
  const auto may_be_least = [&](double size) {
    if (least != least_known) {
      least_known = least;
      worth_looking = Pow(10.0, -0.1 * gates.gain_db * (1.0 + least));
    }
    return size > worth_looking;
  };
  const auto take_bending = [&](std::complex<double> l, double size) {
    if (!may_be_least(size)) return;
    const double by_gain = (-10.0 * Log10(size) - gates.gain_db) / gates.gain_db;
    least = std::min(least, std::max(by_gain, by_phase(l)));
  };
  // Number of upward crossings of the negative axis by 1 + L, minus the downward ones.
  int turns = 0;
  std::complex<double> before = 0.0, first = 0.0;
  for (std::size_t i = 0; i < s_.size(); ++i) {
    std::complex<double> rate = 0.0;
    for (std::size_t k = 0; k < weights.size(); ++k)
      if (weights[k] != 0.0) rate += weights[k] * rates_[i][k];
    const std::complex<double> l = ResponseOf(law, s_[i], angle_[i], rate, tick_s_) / law.effectiveness_1_s2;
    const double w = frequency_rad_s_[i], size = std::norm(l);
    if (w >= bends_above_rad_s_) {
      take_bending(l, size);
      // The least is at an edge of where the response is not attenuated, between the frequencies of the
      // table.
      if (i > 0 && frequency_rad_s_[i - 1] >= bends_above_rad_s_)
        for (int part = 1; part < kBetween; ++part) {
          const std::complex<double> at = before + (l - before) * (static_cast<double>(part) / kBetween);
          take_bending(at, std::norm(at));
        }
    }
    if (i == 0) {
      first = l;
      // Without an integrator an unstable body diverges at rest.
      if (!integrates && l.real() < 0.0) take(std::fabs(10.0 * Log10(size)), gates.gain_db);
    } else {
      if ((l.imag() < 0.0) != (before.imag() < 0.0)) {
        const double share = before.imag() / (before.imag() - l.imag());
        const double real = before.real() + share * (l.real() - before.real());
        if (real < 0.0) take(std::fabs(20.0 * Log10(-real)), gates.gain_db);
        if (real < -1.0) turns += l.imag() < 0.0 ? 1 : -1;
      }
      if ((size < 1.0) != (std::norm(before) < 1.0)) {
        if (w < bends_above_rad_s_) least = std::min(least, by_phase(l));
        // A delay turns a mode's crossover as any other, and sooner.
        const double lead = Angle(-l) < 0.0 ? Angle(-l) + kTwoPi : Angle(-l);
        if (gates.delay_s > 0.0) take(lead / w, gates.delay_s);
      }
    }
    before = l;
  }
  const double turned = Angle(1.0 + before) - Angle(1.0 + first) + kTwoPi * turns;
  const double missing = std::fabs(turned / kPi - half_turns_ - (integrates ? 0.5 : 0.0));
  return missing < 0.5 ? least : kUnstable - missing;
}

}  // namespace dispersa
