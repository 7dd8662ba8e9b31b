// The nozzles' actuators of W flights side by side (core/math/lanes.h): second order with a limited rate.
// Between two commands they depend on nothing else, so they are propagated by themselves, exactly where no
// limit acts.
#pragma once

#include "core/dynamics/launcher_body.h"
#include "core/math/lanes.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// Of each lane's stack.
template <class T>
struct Drives {
  T limit_rad, rate_limit_rad_s;
  T bandwidth2_1_s2;    ///< w²
  T twice_damping_1_s;  ///< 2 zeta w
  T moves[kNozzles];    ///< 1, or 0 of a nozzle that is stuck
};

template <class T>
struct DriveState {
  T angle_rad[kNozzles], rate_rad_s[kNozzles];
};

/// Transition of (angle - command, rate) over a time, of a drive below its rate limit.
template <class T>
struct Transition {
  T aa, ar, ra, rr;
};
/// exp(A t) of A = [0 1; -w² -2 zeta w] in closed form, for any damping ratio.
DISPERSA_INLINE Transition<double> TransitionOver(double bandwidth2, double twice_damping, double t) {
  const double sigma = 0.5 * twice_damping;
  const double square = bandwidth2 - sigma * sigma;  // of the damped frequency; negative when overdamped
  const double e = ::dispersa::Exp(-sigma * t);
  double cosine = 1.0, sine = t;  // of the damped frequency, the sine over the frequency
  if (square > 1e-9 * bandwidth2) {
    const double w = Sqrt(square);
    const SinCos both = ::dispersa::SineCosine(w * t);
    cosine = both.cos;
    sine = both.sin / w;
  } else if (square < -1e-9 * bandwidth2) {
    const double w = Sqrt(-square);
    const double up = ::dispersa::Exp(w * t), down = ::dispersa::Exp(-w * t);
    cosine = 0.5 * (up + down);
    sine = 0.5 * (up - down) / w;
  }
  return {e * (cosine + sigma * sine), e * sine, -(bandwidth2 * e * sine), e * (cosine - sigma * sine)};
}

/// Derivative of one drive: d(angle)/dt = rate within the limit, at which it cannot accelerate further
/// outwards.
template <class T>
DISPERSA_INLINE void DriveRates(const Drives<T>& d, int i, T command_rad, T angle_rad, T rate_rad_s,
                                T& dangle, T& drate) {
  T acceleration = Fma(d.bandwidth2_1_s2, command_rad - angle_rad, -(d.twice_damping_1_s * rate_rad_s));
  const auto at_limit = ((rate_rad_s >= d.rate_limit_rad_s) & (acceleration > T(0.0))) |
                        ((rate_rad_s <= -d.rate_limit_rad_s) & (acceleration < T(0.0)));
  acceleration = Select(at_limit, T(0.0), acceleration);
  dangle = d.moves[i] * Clamp(rate_rad_s, -d.rate_limit_rad_s, d.rate_limit_rad_s);
  drate = d.moves[i] * acceleration;
}

/// Accelerations of the deflections, into the nozzles that the equations of motion see.
template <class T>
DISPERSA_INLINE void SetAccelerations(const Drives<T>& d, const T* command_rad, const DriveState<T>& s,
                                      Nozzles<T>& nozzles) {
  for (int i = 0; i < kNozzles; ++i) {
    T rate;
    const T command = Clamp(command_rad[i], -d.limit_rad, d.limit_rad);
    DriveRates(d, i, command, s.angle_rad[i], s.rate_rad_s[i], rate, nozzles.acceleration_rad_s2[i]);
  }
}

/// Steps of the classical Runge-Kutta method that one propagation takes where a rate limit acts.
inline constexpr int kLimitedSteps = 4;

/// After a time that `over` belongs to. A lane in which any drive reaches its rate limit at either end is
/// integrated numerically. Commands are limited in angle here; the mechanical stop is at the same angle and
/// takes the rate.
template <class T>
DISPERSA_INLINE DriveState<T> Propagate(const Drives<T>& d, const T* command_rad, const Transition<T>& over,
                                        T time_s, const DriveState<T>& from) {
  DriveState<T> to;
  T fastest(0.0), farthest(0.0);
  T command[kNozzles];
  for (int i = 0; i < kNozzles; ++i) {
    command[i] = Clamp(command_rad[i], -d.limit_rad, d.limit_rad);
    const T x = from.angle_rad[i] - command[i], r = from.rate_rad_s[i];
    const auto moves = d.moves[i] > T(0.0);
    to.angle_rad[i] = Select(moves, Fma(over.aa, x, Fma(over.ar, r, command[i])), from.angle_rad[i]);
    to.rate_rad_s[i] = Select(moves, Fma(over.ra, x, over.rr * r), r);
    fastest = Max(fastest, Max(Abs(r), Abs(to.rate_rad_s[i])));
    farthest = Max(farthest, Abs(to.angle_rad[i]));
  }
  const auto limited = fastest >= d.rate_limit_rad_s;
  if (Any(limited)) {
    const T h = time_s * T(1.0 / kLimitedSteps), half = T(0.5) * h, sixth = h * T(1.0 / 6.0);
    for (int i = 0; i < kNozzles; ++i) {
      T angle = from.angle_rad[i], rate = from.rate_rad_s[i];
      for (int step = 0; step < kLimitedSteps; ++step) {
        T a1, a2, a3, a4, r1, r2, r3, r4;
        DriveRates(d, i, command[i], angle, rate, a1, r1);
        DriveRates(d, i, command[i], Fma(half, a1, angle), Fma(half, r1, rate), a2, r2);
        DriveRates(d, i, command[i], Fma(half, a2, angle), Fma(half, r2, rate), a3, r3);
        DriveRates(d, i, command[i], Fma(h, a3, angle), Fma(h, r3, rate), a4, r4);
        angle = Fma(sixth, (a1 + a4) + T(2.0) * (a2 + a3), angle);
        rate =
            Clamp(Fma(sixth, (r1 + r4) + T(2.0) * (r2 + r3), rate), -d.rate_limit_rad_s, d.rate_limit_rad_s);
      }
      to.angle_rad[i] = Select(limited, angle, to.angle_rad[i]);
      to.rate_rad_s[i] = Select(limited, rate, to.rate_rad_s[i]);
    }
  }
  // The mechanical stop. Between two commands within the limit only an overshoot reaches it.
  if (!Any(limited | (farthest > d.limit_rad))) return to;
  for (int i = 0; i < kNozzles; ++i) {
    const auto beyond = (Abs(to.angle_rad[i]) > d.limit_rad) & (d.moves[i] > T(0.0));
    to.angle_rad[i] = Select(beyond, Clamp(to.angle_rad[i], -d.limit_rad, d.limit_rad), to.angle_rad[i]);
    to.rate_rad_s[i] = Select(beyond, T(0.0), to.rate_rad_s[i]);
  }
  return to;
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
