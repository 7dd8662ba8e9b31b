#include "core/flight/limit_cycle.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/math/constants.h"
#include "core/math/functions.h"
#include "core/math/lanes.h"

namespace dispersa {
namespace {

// Rate of the highest octave's samples, as near as whole ticks come.
constexpr double kSampleTime_s = 0.01;
constexpr int kShortest = 10, kLongest = 20;  // periods, samples
constexpr int kSegments = 12;
// A period counts if the samples resemble themselves at least this much, and if its fundamental holds at
// least this share of their energy. Without the second test segments may agree on an alias of a faster tone.
constexpr double kSimilar = 0.4;
constexpr double kShareOfPower = 0.25;
constexpr int kHarmonics = 4;
constexpr int kAngles = 64;

struct Phasor {
  double re = 0.0, im = 0.0;
};
Phasor operator+(Phasor a, Phasor b) { return {a.re + b.re, a.im + b.im}; }
Phasor operator*(Phasor a, Phasor b) { return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re}; }
Phasor Conjugate(Phasor a) { return {a.re, -a.im}; }
double Norm2(Phasor a) { return a.re * a.re + a.im * a.im; }
double Angle(Phasor a) { return Atan2(a.im, a.re); }
Phasor Turned(double angle_rad) {
  const SinCos s = SineCosine(angle_rad);
  return {s.cos, s.sin};
}

// Sum of values[i] exp(-i omega (first + i)).
Phasor Demodulated(const double* values, int first, int count, double omega) {
  Phasor turn = Turned(-omega * first);
  const Phasor step = Turned(-omega);
  Phasor sum;
  for (int i = 0; i < count; ++i) {
    sum.re += values[first + i] * turn.re;
    sum.im += values[first + i] * turn.im;
    turn = turn * step;
  }
  return sum;
}

// Shortest period, in samples, after which the values resemble themselves best; 0 if there is none.
double PeriodOf(const double* values, int count, double energy) {
  double likeness[kLongest + 2];
  for (int lag = kShortest - 1; lag <= kLongest + 1; ++lag) {
    double sum = 0.0;
    for (int i = lag; i < count; ++i) sum += values[i] * values[i - lag];
    likeness[lag] = sum / (energy * (count - lag) / count);
  }
  for (int lag = kShortest; lag <= kLongest; ++lag) {
    const double before = likeness[lag - 1], here = likeness[lag], after = likeness[lag + 1];
    if (!(here >= kSimilar && here >= before && here >= after)) continue;
    // The peak of the parabola through the three.
    const double curvature = before - 2.0 * here + after;
    return curvature < 0.0 ? lag + 0.5 * (before - after) / curvature : lag;
  }
  return 0.0;
}

// Gain of a mean over `length` for an oscillation. Both arguments have the same unit of time.
double GainOfMean(double omega, double length) {
  const double half = 0.5 * omega * length;
  return half > 1e-6 ? SineCosine(half).sin / half : 1.0;
}

// Peak to peak of the fundamental and its harmonics together, as far as the samples hold them.
double PeakToPeak(const double* samples, int count, double omega) {
  Phasor harmonic[kHarmonics];
  double mean = 0.0;
  for (int i = 0; i < count; ++i) mean += samples[i] / count;
  int harmonics = 0;
  // Above four fifths of half the sampling rate the samples' own filter leaves too little.
  for (; harmonics < kHarmonics && (harmonics + 1) * omega <= 0.8 * kPi; ++harmonics) {
    const double w = (harmonics + 1) * omega;
    // Weighted by 1 - cos, which lets trends through less than a thousandth.
    Phasor turn{1.0, 0.0}, sum;
    const Phasor step = Turned(-w);
    Phasor bell{1.0, 0.0};
    const Phasor bell_step = Turned(kTwoPi / count);
    for (int i = 0; i < count; ++i) {
      const double weighted = (1.0 - bell.re) * (samples[i] - mean);
      sum.re += weighted * turn.re;
      sum.im += weighted * turn.im;
      turn = turn * step;
      bell = bell * bell_step;
    }
    const double scale = 2.0 / (count * GainOfMean(w, 1.0));
    harmonic[harmonics] = {scale * sum.re, scale * sum.im};
  }
  double low = 0.0, high = 0.0;
  for (int k = 0; k < kAngles; ++k) {
    const Phasor first = Turned(kTwoPi * k / kAngles);
    Phasor turn = first;
    double value = 0.0;
    for (int h = 0; h < harmonics; ++h) {
      value += (harmonic[h] * turn).re;
      turn = turn * first;
    }
    low = std::min(low, value);
    high = std::max(high, value);
  }
  return high - low;
}

}  // namespace

LimitCycleMeter::LimitCycleMeter(double tick_s)
    : ticks_(std::max(1, static_cast<int>(std::lround(kSampleTime_s / tick_s)))) {}

void LimitCycleMeter::Interrupt() {
  if (idle_) return;
  idle_ = true;
  summed_ = 0;
  for (Octave& octave : octave_) octave.at = octave.hops = 0;
}

void LimitCycleMeter::Add(double roll_rad, double pitch_rad, double yaw_rad) {
  idle_ = false;
  Octave& highest = octave_[0];
  double* sample = highest.sample[2 * kLag + highest.at];
  if (summed_ == 0) {
    sample[0] = roll_rad;
    sample[1] = pitch_rad;
    sample[2] = yaw_rad;
  } else {
    sample[0] += roll_rad;
    sample[1] += pitch_rad;
    sample[2] += yaw_rad;
  }
  if (ticks_ > 1) {
    if (++summed_ < ticks_) return;
    summed_ = 0;
    for (int c = 0; c < kChannels; ++c) sample[c] /= ticks_;
  }
  if (++highest.at % kHop == 0) EndHop(0);
}

// Ends a hop of an octave: its energies, the windows that end with it, and the samples of the octave below,
// each the mean of two. All channels are processed at once and never mixed.
void LimitCycleMeter::EndHop(int octave) {
  using Channels = lanes::Pack<kWidth>;
  const auto load = [](const double* sample) { return Channels(_mm256_loadu_pd(sample)); };
  const auto store = [](double* sample, Channels value) { _mm256_storeu_pd(sample, value.v); };
  Octave& o = octave_[octave];
  const int hop = o.at / kHop - 1, first = 2 * kLag + hop * kHop;
  if (hop == 0) std::memcpy(o.sample, o.sample + kWindow, sizeof(o.sample[0]) * 2 * kLag);
  Channels energy(0.0);
  for (int i = o.hops == 0 ? first + 2 * kLag : first; i < first + kHop; ++i) {
    const Channels difference =
        load(o.sample[i - kLag]) - Channels(0.5) * (load(o.sample[i]) + load(o.sample[i - 2 * kLag]));
    energy = energy + difference * difference;
  }
  store(o.energy[hop], energy);
  if (o.at == kWindow) o.at = 0;
  o.hops = std::min(o.hops + 1, kHops);
  if (o.hops == kHops)
    for (int channel = 0; channel < kChannels; ++channel) Evaluate(o, channel);
  if (octave + 1 == kOctaves) return;
  Octave& below = octave_[octave + 1];
  double(*to)[kWidth] = below.sample + 2 * kLag + below.at;
  for (int i = first; i < first + kHop; i += 2, ++to)
    store(*to, Channels(0.5) * (load(o.sample[i]) + load(o.sample[i + 1])));
  below.at += kHop / 2;
  if (below.at % kHop == 0) EndHop(octave + 1);
}

void LimitCycleMeter::Evaluate(const Octave& octave, int channel) {
  worst_ = std::max(worst_, 0.0);
  // The second difference passes an octave's fundamental with a gain of 1 to 2. So its energy bounds the
  // amplitude a: at most a² / 2 a sample. An oscillation swings at most twice as far as its fundamental.
  double energy = 0.0;
  for (const auto& hop : octave.energy) energy += hop[channel];
  const double least = std::max(worst_, kFloor_rad);
  if (32.0 * energy <= least * least * (kWindow - 2 * kLag)) return;

  double samples[kWindow];
  for (int i = 0, from = octave.at; i < kWindow; ++i, from = from + 1 == kWindow ? 0 : from + 1)
    samples[i] = octave.sample[2 * kLag + from][channel];
  constexpr int kCount = kWindow - 2 * kLag;
  double differences[kCount];
  int crossings = 0;
  double square_sum = 0.0;
  for (int i = 0; i < kCount; ++i) {
    differences[i] = samples[i + kLag] - 0.5 * (samples[i] + samples[i + 2 * kLag]);
    square_sum += Square(differences[i]);
    crossings += i > 0 && (differences[i] < 0.0) != (differences[i - 1] < 0.0);
  }
  // The longest period of an octave crosses zero 23 times.
  if (crossings < 20) return;
  const double period = PeriodOf(differences, kCount, square_sum);
  if (!(period > 0.0)) return;

  double omega = kTwoPi / period;  // rad a sample
  constexpr int kSegment = kCount / kSegments;
  Phasor segment[kSegments];
  double energies = 0.0;
  for (int s = 0; s < kSegments; ++s) {
    segment[s] = Demodulated(differences, s * kSegment, kSegment, omega);
    energies += Norm2(segment[s]);
  }
  if (!(energies > 0.0)) return;
  // The frequency at which the segments agree: from one to the next, then from half to half.
  const auto turn_all = [&](double slope) {
    for (int s = 0; s < kSegments; ++s) segment[s] = segment[s] * Turned(-slope * kSegment * s);
    omega += slope;
  };
  const auto sum_of = [&](int from, int to) {
    Phasor sum;
    for (int s = from; s < to; ++s) sum = sum + segment[s];
    return sum;
  };
  Phasor advance;
  for (int s = 1; s < kSegments; ++s) advance = advance + segment[s] * Conjugate(segment[s - 1]);
  turn_all(Angle(advance) / kSegment);
  constexpr int kHalf = kSegments / 2, kThird = kSegments / 3;
  turn_all(Angle(sum_of(kHalf, kSegments) * Conjugate(sum_of(0, kHalf))) / (kHalf * kSegment));
  const double whole = Norm2(sum_of(0, kSegments));
  if (whole < kCoherence * kSegments * energies) return;
  if (whole < 0.5 * kShareOfPower * kSegments * kSegment * square_sum) return;
  if (Norm2(sum_of(kSegments - kThird, kSegments)) < Square(kLasting) * Norm2(sum_of(0, kThird))) return;
  worst_ = std::max(worst_, PeakToPeak(samples, kWindow, omega));
}

}  // namespace dispersa
