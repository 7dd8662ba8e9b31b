// The nozzles' actuators of W flights side by side (core/math/lanes.h): second order with a limited rate.
// Between two commands they depend on nothing else. So they are propagated by themselves, exactly where no
// limit acts.
//
// A vehicle file may give them three properties of real drives. A resolution: the command reaches the servo
// in steps. A dead zone: within it the servo does not feel its distance from the command. Coulomb friction:
// it holds a drive at rest until the servo pulls harder, and opposes a sliding drive by as much:
//
//   angle'' = w² zone(command - angle) - 2 zeta w angle' - w² friction sign(angle')
//
// zone(e) is e moved towards 0 by the dead zone. Friction has the unit of the angle. These drives are
// integrated in small steps, which end where a drive comes to rest.
#pragma once

#include "core/dynamics/launcher_body.h"
#include "core/math/lanes.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// A gimbal's drives, prepared.
template <class T>
struct DriveNumbers {
  T limit_rad, rate_limit_rad_s;
  T bandwidth2_1_s2;    ///< w²
  T twice_damping_1_s;  ///< 2 zeta w
  T moves[kNozzles];    ///< 1, or 0 of a nozzle that is stuck
  T dead_zone_rad;
  T friction_1_s2;  ///< w² friction: the deceleration by it, rad/s²
  T resolution_rad;
  // Number and share of the steps of one numerical propagation of a lane (StepsOver).
  T limited_steps, limited_part, rough_steps, rough_part;
  T fast_limit2_rad2_s2;  ///< of a drive that may reach its rate limit between the ends: the limit squared
};
/// The actuators of each lane's stack.
template <class T>
struct Actuators : DriveNumbers<T> {
  bool is_rough, is_coarse;  ///< whether any lane has a dead zone or friction, whether any has a resolution
  bool is_fast;              ///< any lane has drives that may reach their rate limit between the ends
  int most_limited_steps, most_rough_steps;  ///< of any lane
};

/// Steps of one numerical propagation: at least `least`, and none longer than half a radian of the drive's
/// own motion. At that length the classical Runge-Kutta method errs by 3e-4 of the motion in a step.
inline constexpr double kLongestStep_rad = 0.5;
inline int StepsOver(double bandwidth_rad_s, double time_s, int least) {
  const double steps = bandwidth_rad_s * time_s / kLongestStep_rad;
  const int whole = static_cast<int>(steps);
  const int enough = whole < steps ? whole + 1 : whole;
  return enough > least ? enough : least;
}
inline constexpr double kNeverReached_rad2_s2 = 1e300;
/// In a longer propagation (radians of its own motion) a drive's rate has its peak between the ends.
inline constexpr double kFastDrive_rad = 1.0;

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

/// The command that a servo follows: the nearest step of its resolution (the even one of two), within the
/// limit.
template <class T>
DISPERSA_INLINE T Followed(const Actuators<T>& d, T command_rad) {
  if (d.is_coarse) {
    const T stepped = Nearest(command_rad / d.resolution_rad) * d.resolution_rad;
    command_rad = Select(d.resolution_rad > T(0.0), stepped, command_rad);
  }
  return Clamp(command_rad, -d.limit_rad, d.limit_rad);
}

/// Acceleration that the servo asks for, rad/s².
template <class T>
DISPERSA_INLINE T Pull(const Actuators<T>& d, T command_rad, T angle_rad) {
  const T distance = command_rad - angle_rad;
  if (!d.is_rough) return d.bandwidth2_1_s2 * distance;
  return d.bandwidth2_1_s2 * (distance - Clamp(distance, -d.dead_zone_rad, d.dead_zone_rad));
}

/// The direction in which a drive slides. A moving drive: that of its rate. A drive at rest: that of a pull
/// above its friction, else 0 (held).
template <class T>
DISPERSA_INLINE T SlidesIn(const Actuators<T>& d, T command_rad, T angle_rad, T rate_rad_s) {
  const T one(1.0), none(0.0);
  const T pull = Pull(d, command_rad, angle_rad);
  const T loose = Select(Abs(pull) > d.friction_1_s2, pull, none);
  const T felt = Select(Abs(rate_rad_s) > none, rate_rad_s, loose);
  return Select(felt > none, one, Select(felt < none, -one, none));
}

/// Derivative of one drive: d(angle)/dt = rate within the limit. At the limit the drive cannot accelerate
/// further outwards. `slides` is the direction that friction opposes (SlidesIn). It does not change between
/// two rests.
template <class T>
DISPERSA_INLINE void DriveRates(const Actuators<T>& d, int i, T command_rad, T angle_rad, T rate_rad_s,
                                T slides, T& dangle, T& drate) {
  T acceleration = Fma(d.bandwidth2_1_s2, command_rad - angle_rad, -(d.twice_damping_1_s * rate_rad_s));
  if (d.is_rough) {
    const auto rough = (d.dead_zone_rad > T(0.0)) | (d.friction_1_s2 > T(0.0));
    const T against = Fma(d.twice_damping_1_s, rate_rad_s, d.friction_1_s2 * slides);
    acceleration = Select(rough, Pull(d, command_rad, angle_rad) - against, acceleration);
    const auto held = (d.friction_1_s2 > T(0.0)) & !(Abs(slides) > T(0.0));
    acceleration = Select(held, T(0.0), acceleration);
  }
  const auto at_limit = ((rate_rad_s >= d.rate_limit_rad_s) & (acceleration > T(0.0))) |
                        ((rate_rad_s <= -d.rate_limit_rad_s) & (acceleration < T(0.0)));
  acceleration = Select(at_limit, T(0.0), acceleration);
  dangle = d.moves[i] * Clamp(rate_rad_s, -d.rate_limit_rad_s, d.rate_limit_rad_s);
  drate = d.moves[i] * acceleration;
}
/// The step of a drive without friction.
template <class T>
DISPERSA_INLINE void DriveRates(const Actuators<T>& d, int i, T command_rad, T angle_rad, T rate_rad_s,
                                T& dangle, T& drate) {
  DriveRates(d, i, command_rad, angle_rad, rate_rad_s, T(0.0), dangle, drate);
}

/// One step of the classical Runge-Kutta method, of a drive that slides one way.
template <class T>
DISPERSA_INLINE void StepDrive(const Actuators<T>& d, int i, T command_rad, T slides, T h_s, T& angle_rad,
                               T& rate_rad_s) {
  const T half = T(0.5) * h_s, sixth = h_s * T(1.0 / 6.0);
  const T angle = angle_rad, rate = rate_rad_s;
  T a1, a2, a3, a4, r1, r2, r3, r4;
  DriveRates(d, i, command_rad, angle, rate, slides, a1, r1);
  DriveRates(d, i, command_rad, Fma(half, a1, angle), Fma(half, r1, rate), slides, a2, r2);
  DriveRates(d, i, command_rad, Fma(half, a2, angle), Fma(half, r2, rate), slides, a3, r3);
  DriveRates(d, i, command_rad, Fma(h_s, a3, angle), Fma(h_s, r3, rate), slides, a4, r4);
  angle_rad = Fma(sixth, (a1 + a4) + T(2.0) * (a2 + a3), angle);
  rate_rad_s =
      Clamp(Fma(sixth, (r1 + r4) + T(2.0) * (r2 + r3), rate), -d.rate_limit_rad_s, d.rate_limit_rad_s);
}

/// Least number of steps in one propagation of a drive with a dead zone or friction: 0.6 ms each in half a
/// tick of 10 ms. A step that meets the edge of the zone, or a rest within it, errs by the cube of its
/// length.
inline constexpr int kRoughSteps = 8;
/// Steps of the classical Runge-Kutta method that one propagation takes at least where a rate limit acts.
inline constexpr int kLimitedSteps = 4;

/// Replaces the lanes whose drives have a dead zone or friction by their numerical propagation.
template <class T>
void PropagateRough(const Actuators<T>& d, const T* command_rad, T time_s, const DriveState<T>& from,
                    DriveState<T>& to) {
  const T none(0.0), half(0.5), h = time_s * d.rough_part;
  const auto rough = (d.dead_zone_rad > none) | (d.friction_1_s2 > none);
  for (int i = 0; i < kNozzles; ++i) {
    const auto moves = rough & (d.moves[i] > none);
    T angle = from.angle_rad[i], rate = from.rate_rad_s[i];
    for (int step = 0; step < d.most_rough_steps; ++step) {
      const T slides = SlidesIn(d, command_rad[i], angle, rate);
      const T start = angle, speed = rate;
      const auto takes = T(static_cast<double>(step)) < d.rough_steps;
      StepDrive(d, i, command_rad[i], slides, h, angle, rate);
      // It came to rest on the way, and is held or slides back from there.
      const auto rests = (d.friction_1_s2 > none) & (slides * rate < none);
      const T slowing = speed / (speed - rate) * h, rest = h - slowing;
      const T stop = Fma(half * slowing, speed, start);
      const T pull = Pull(d, command_rad[i], stop);
      const T back = pull - Clamp(pull, -d.friction_1_s2, d.friction_1_s2);
      angle = Select(rests, Fma(half * back * rest, rest, stop), angle);
      rate = Select(rests, back * rest, rate);
      const auto beyond = Abs(angle) > d.limit_rad;
      angle = Clamp(angle, -d.limit_rad, d.limit_rad);
      rate = Select(beyond, none, rate);
      angle = Select(takes, angle, start);
      rate = Select(takes, rate, speed);
    }
    to.angle_rad[i] = Select(moves, angle, to.angle_rad[i]);
    to.rate_rad_s[i] = Select(moves, rate, to.rate_rad_s[i]);
  }
}

/// Accelerations of the deflections, into the nozzles that the equations of motion see.
template <class T>
DISPERSA_INLINE void SetAccelerations(const Actuators<T>& d, const T* command_rad, const DriveState<T>& s,
                                      Nozzles<T>& nozzles) {
  for (int i = 0; i < kNozzles; ++i) {
    T rate;
    const T command = Followed(d, command_rad[i]);
    const T slides = SlidesIn(d, command, s.angle_rad[i], s.rate_rad_s[i]);
    DriveRates(d, i, command, s.angle_rad[i], s.rate_rad_s[i], slides, rate, nozzles.acceleration_rad_s2[i]);
  }
}

/// The drives after the time of `over`. A lane is integrated numerically if any drive is at its rate limit at
/// either end, or could reach it in between. The bound for that is rate² + w² distance², which does not grow.
/// The command's angle is limited here. The mechanical stop is at the same angle and takes the rate.
template <class T>
DISPERSA_INLINE DriveState<T> Propagate(const Actuators<T>& d, const T* command_rad,
                                        const Transition<T>& over, T time_s, const DriveState<T>& from) {
  DriveState<T> to;
  T fastest(0.0), farthest(0.0), energy(0.0);
  T command[kNozzles];
  for (int i = 0; i < kNozzles; ++i) {
    command[i] = Followed(d, command_rad[i]);
    const T x = from.angle_rad[i] - command[i], r = from.rate_rad_s[i];
    const auto moves = d.moves[i] > T(0.0);
    to.angle_rad[i] = Select(moves, Fma(over.aa, x, Fma(over.ar, r, command[i])), from.angle_rad[i]);
    to.rate_rad_s[i] = Select(moves, Fma(over.ra, x, over.rr * r), r);
    fastest = Max(fastest, Max(Abs(r), Abs(to.rate_rad_s[i])));
    farthest = Max(farthest, Abs(to.angle_rad[i]));
    if (d.is_fast) energy = Max(energy, Fma(d.bandwidth2_1_s2 * x, x, r * r));
  }
  auto limited = fastest >= d.rate_limit_rad_s;
  if (d.is_fast) limited = limited | (energy >= d.fast_limit2_rad2_s2);
  if (Any(limited)) {
    const T h = time_s * d.limited_part;
    for (int i = 0; i < kNozzles; ++i) {
      T angle = from.angle_rad[i], rate = from.rate_rad_s[i];
      for (int step = 0; step < d.most_limited_steps; ++step) {
        T next_angle = angle, next_rate = rate;
        StepDrive(d, i, command[i], T(0.0), h, next_angle, next_rate);
        const auto takes = T(static_cast<double>(step)) < d.limited_steps;
        angle = Select(takes, next_angle, angle);
        rate = Select(takes, next_rate, rate);
      }
      to.angle_rad[i] = Select(limited, angle, to.angle_rad[i]);
      to.rate_rad_s[i] = Select(limited, rate, to.rate_rad_s[i]);
    }
  }
  // The mechanical stop. Between two commands within the limit only an overshoot reaches it.
  const bool stops = Any(limited | (farthest > d.limit_rad));
  for (int i = 0; stops && i < kNozzles; ++i) {
    const auto beyond = (Abs(to.angle_rad[i]) > d.limit_rad) & (d.moves[i] > T(0.0));
    to.angle_rad[i] = Select(beyond, Clamp(to.angle_rad[i], -d.limit_rad, d.limit_rad), to.angle_rad[i]);
    to.rate_rad_s[i] = Select(beyond, T(0.0), to.rate_rad_s[i]);
  }
  if (d.is_rough) PropagateRough(d, command, time_s, from, to);
  return to;
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
