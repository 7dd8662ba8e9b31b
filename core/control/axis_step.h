// One axis of the autopilot of W flights side by side (core/math/lanes.h), one tick: from the attitude error
// and its rate to an angular acceleration. Signs as in axis_controller.h.
#pragma once

#include "core/control/axis_controller.h"
#include "core/math/lanes.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// StageLaw of each lane's stage. P_n carries the flight's factors.
template <class T>
struct AxisStage {
  T kp_1_s2, kd_1_s;
  T p11, p12, p22;
  T pn_error, pn_rate;
  T gamma;
  T ki_1_s3;
  T filters[kFilterSections][5];  ///< DigitalSection's coefficients
};
template <class T>
DISPERSA_INLINE void SetLane(AxisStage<T>& s, int lane, const StageLaw& law, double pn_error_factor,
                             double pn_rate_factor) {
  SetLaneValues<T>(s, lane, law);
  Lane(s.pn_error, lane) *= pn_error_factor;
  Lane(s.pn_rate, lane) *= pn_rate_factor;
}

/// The law in a stage at a time since its ignition: the same source for a flight's ticks and its margins.
DISPERSA_INLINE StageLaw LawAtTime(const AxisLaw& law, int stage, double since_ignition_s) {
  const std::vector<LawPiece>& pieces = law.pieces.data()[stage];
  const LawPiece* piece = pieces.data();
  const LawPiece* const end = piece + pieces.size();
  if (piece == end) return law.stages.data()[stage];
  while (piece + 1 != end && since_ignition_s >= piece[1].from_s) ++piece;
  constexpr unsigned kNumbers = sizeof(StageLaw) / sizeof(double);
  double at[kNumbers], rate[kNumbers];
  __builtin_memcpy(at, &piece->at, sizeof at);
  __builtin_memcpy(rate, &piece->rate, sizeof rate);
  const double since = since_ignition_s - piece->from_s;
  for (unsigned i = 0; i < kNumbers; ++i) at[i] = Fma(since, rate[i], at[i]);
  StageLaw now;
  __builtin_memcpy(static_cast<void*>(&now), at, sizeof now);
  return now;
}

/// All memory of one axis: plain values, AxisState lane by lane.
template <class T>
struct AxisMemory {
  T departure_rad_s2[kFuzzyRules];  ///< of the consequents from their start
  T fired;                          ///< as bits: rule i has fired
  T previous_v;
  T saturation;  ///< -1, 0, 1: the last deflection command was limited in this sense of u
  T integral_rad_s2;
  T total_gain, model_started;  ///< augmentation
  T model_error_rad, model_rate_rad_s, model_integral_rad_s2, high_pass, low_pass;
  T filters[kFilterSections][2];
};
template <class T>
DISPERSA_INLINE void SetLane(AxisMemory<T>& m, int lane, const AxisState& s) {
  SetLaneValues<T>(m, lane, s);
}
template <class T>
DISPERSA_INLINE void ReadLane(const AxisMemory<T>& m, int lane, AxisState& s) {
  ReadLaneValues<T>(m, lane, s);
}

/// AxisTelemetry lane by lane.
template <class T>
struct AxisOutput {
  T command_rad_s2;
  T v, v_rate_sign;
  T departure_norm2;  ///< squared adaptation norm
  T frozen;
};

template <class T>
DISPERSA_INLINE void SetLane(AxisOutput<T>& o, int lane, const AxisOutput<double>& from) {
  SetLaneValues<T>(o, lane, from);
}
template <class T>
DISPERSA_INLINE AxisTelemetry TelemetryOf(const AxisConfig& config, const AxisOutput<T>& o,
                                          const AxisMemory<T>& m, int lane) {
  AxisTelemetry t;
  const double bound = config.adaptation.projection_bound_rad_s2;
  for (int i = 0; i < kFuzzyRules; ++i)
    t.projected |= bound > 0.0 && Abs(Lane(m.departure_rad_s2[i], lane)) >= bound;
  t.command_rad_s2 = Lane(o.command_rad_s2, lane);
  t.adaptation_norm = Sqrt(Lane(o.departure_norm2, lane));
  t.v = Lane(o.v, lane);
  t.v_rate_sign = Lane(o.v_rate_sign, lane);
  t.total_gain = Lane(m.total_gain, lane);
  t.rules_fired = static_cast<std::uint32_t>(ToBits(Lane(m.fired, lane)));
  t.frozen = Lane(o.frozen, lane) > 0.0;
  return t;
}

/// The value that replaces another one in the lanes that act; `kAll`: every lane does.
template <bool kAll, class T>
DISPERSA_INLINE T Kept(MaskOf<T> acting, T anew, T old) {
  if constexpr (kAll) return anew;
  return Select(acting, anew, old);
}

/// Grades of the five triangular sets over a position in units of their centres' spacing, 0 at the first
/// centre: Memberships of fuzzy.h. They sum to 1, so the regressor of (22) is the product of two.
template <class T>
DISPERSA_INLINE void Grades(T position, T* grade) {
  for (int i = 0; i < kFuzzySets; ++i)
    grade[i] = Max(T(1.0) - Abs(position - T(static_cast<double>(i))), T(0.0));
}

/// The paper's law (20)-(32), adaptive or frozen, with the guards of Adaptation.
///
/// The consequents are their start, which makes the rule surface the plane kp e + kd de/dt between the outer
/// centres, plus a departure; so the output is the plane's and the departures' by the regressor.
///
/// A steady disturbance excites the central rule alone. Learnt there alone it bends the rule surface: the
/// slope towards the neighbours, which is the loop's gain, changes and can turn negative. `spread` draws each
/// departure to the mean of all, so that what lasts becomes a common offset, which leaves the slopes alone.
/// As leakage does, it adds a negative semi-definite term to dV/dt, but none against a common offset.
template <bool kAll, class T>
DISPERSA_INLINE T StepFuzzy(const AxisConfig& config, double tick_s, const AxisStage<T>& stage,
                            MaskOf<T> acting, T error, T rate, bool is_reported, AxisMemory<T>& memory,
                            AxisOutput<T>& out) {
  const FuzzyRules& rules = config.rules;
  const double last = kFuzzySets - 1.0;
  const T at_error = Clamp(Fma(error, T(2.0 / rules.error_range_rad), T(0.5 * last)), T(0.0), T(last));
  const T at_rate = Clamp(Fma(rate, T(2.0 / rules.rate_range_rad_s), T(0.5 * last)), T(0.0), T(last));
  T by_error[kFuzzySets], by_rate[kFuzzySets];
  Grades(at_error, by_error);
  Grades(at_rate, by_rate);
  // Rule i * 5 + j has fired where set i of the error and set j of the rate have.
  T rows(0.0), columns(0.0);
  for (int i = 0; i < kFuzzySets; ++i) {
    rows = OrBits(rows, Select(by_error[i] > T(0.0), T(OfBits(std::uint64_t{0x1f} << (5 * i))), T(0.0)));
    columns = OrBits(columns, Select(by_rate[i] > T(0.0), T(OfBits(std::uint64_t{0x108421} << i)), T(0.0)));
  }
  memory.fired = Kept<kAll>(acting, OrBits(memory.fired, AndBits(rows, columns)), memory.fired);

  const T centre(0.5 * last);
  T u = Fma(stage.kp_1_s2 * T(0.5 * rules.error_range_rad), at_error - centre,
            stage.kd_1_s * T(0.5 * rules.rate_range_rad_s) * (at_rate - centre));
  if (config.law == ControlLaw::kAdaptiveFuzzy) {
    const Adaptation& guards = config.adaptation;
    T drive = Fma(stage.pn_error, error, stage.pn_rate * rate);  // e' P_n
    if (guards.composite > 0.0) {
      const T predicted = Select(memory.model_started > T(0.0), memory.model_rate_rad_s, rate);
      const T missed = rate - predicted;
      drive = Fma(T(guards.composite) * stage.pn_rate, missed, drive);
      // What the rules have learnt is taken to cancel the disturbance: the error dynamics remain.
      const T change = Fma(T(guards.predictor_1_s), missed, -u);
      memory.model_rate_rad_s =
          Kept<kAll>(acting, Fma(T(tick_s), change, predicted), memory.model_rate_rad_s);
      memory.model_started = Kept<kAll>(acting, T(1.0), memory.model_started);
    }
    auto is_frozen = Abs(drive) < T(guards.dead_zone_rad) * Abs(stage.pn_error);
    if (guards.freeze_when_saturated) is_frozen = is_frozen | (memory.saturation * drive > T(0.0));
    // Where nothing adapts the coefficients leave every departure as it is.
    const auto adapts = acting & (stage.gamma > T(0.0));
    T rated = T(tick_s) * stage.gamma * drive;
    if (guards.normalized) {
      T norm2_error(0.0), norm2_rate(0.0);
      Each<kFuzzySets>([&](int i) __attribute__((always_inline)) {
        norm2_error = Fma(by_error[i], by_error[i], norm2_error);
        norm2_rate = Fma(by_rate[i], by_rate[i], norm2_rate);
      });
      rated = rated / (norm2_error * norm2_rate);
    }
    const T step = Select(adapts & !is_frozen, rated, T(0.0));
    T sum(0.0);
    Each<kFuzzyRules>([&](int i) __attribute__((always_inline)) { sum = sum + memory.departure_rad_s2[i]; });
    const T keep = Select(adapts, T(1.0 - tick_s * guards.leakage_1_s - tick_s * guards.spread_1_s), T(1.0));
    const T pull = Select(adapts, T(tick_s * guards.spread_1_s / kFuzzyRules) * sum, T(0.0));
    const T bound(guards.projection_bound_rad_s2 > 0.0 ? guards.projection_bound_rad_s2 : 1e300);
    T learnt(0.0);
    Each<kFuzzySets>([&](int i) __attribute__((always_inline)) {
      T row(0.0);
      const T push = step * by_error[i];
      Each<kFuzzySets>([&](int j) __attribute__((always_inline)) {
        T& departure = memory.departure_rad_s2[kFuzzySets * i + j];
        row = Fma(by_rate[j], departure, row);
        departure = Clamp(Fma(push, by_rate[j], Fma(keep, departure, pull)), -bound, bound);
      });
      learnt = Fma(by_error[i], row, learnt);
    });
    if (is_reported) {
      T norm2(0.0);
      Each<kFuzzyRules>([&](int i) __attribute__((always_inline)) {
        norm2 = Fma(memory.departure_rad_s2[i], memory.departure_rad_s2[i], norm2);
      });
      out.departure_norm2 = norm2;
      out.frozen = Select(adapts & is_frozen, T(1.0), T(0.0));
    }
    // The command uses the consequents before the step.
    u = u + learnt;
  }
  // Beyond the outer sets the rule surface is flat; the supervisory term restores the linear law there while
  // V exceeds its bound.
  if (config.adaptation.supervisory_bound > 0.0) {
    const T error_beyond = error - Clamp(error, T(-rules.error_range_rad), T(rules.error_range_rad));
    const T rate_beyond = rate - Clamp(rate, T(-rules.rate_range_rad_s), T(rules.rate_range_rad_s));
    const T restored = Fma(stage.kp_1_s2, error_beyond, Fma(stage.kd_1_s, rate_beyond, u));
    u = Select(out.v > T(config.adaptation.supervisory_bound), restored, u);
  }
  return u;
}

/// Proportional, derivative and integral of the error. The command uses the integral before the step, as the
/// rules' does what they have learnt.
template <bool kAll, class T>
DISPERSA_INLINE T StepPid(const IntegralAction& integral, double tick_s, const AxisStage<T>& stage,
                          MaskOf<T> acting, T error, T rate, AxisMemory<T>& memory) {
  const T before = memory.integral_rad_s2;
  const T bound(integral.bound_rad_s2 > 0.0 ? integral.bound_rad_s2 : 1e300);
  const T after = Clamp(Fma(T(tick_s) * stage.ki_1_s3, error, before), -bound, bound);
  const auto held = memory.saturation * error > T(0.0);
  memory.integral_rad_s2 = Kept<kAll>(acting, Select(held, before, after), before);
  return Fma(stage.kp_1_s2, error, Fma(stage.kd_1_s, rate, before));
}

/// Adaptive augmenting control, with k_T = k_0 + k_a the total gain, k_0 its floor, e_r the departure from
/// the reference model and y_s the low-passed square of the high-passed command:
///   dk_a/dt = (k_max - k_a) / k_max a e_r² - alpha k_a y_s - beta (k_T - 1).
/// The reference model is the error dynamics the gains are chosen for, started at the stage's first error: in
/// error coordinates the attitude command does not appear. Of PID, command and model have their integrals.
template <bool kAll, class T>
DISPERSA_INLINE T StepAugmented(const AxisConfig& config, double tick_s, const AxisStage<T>& stage,
                                MaskOf<T> acting, T error, T rate, AxisMemory<T>& memory) {
  const AdaptiveAugmentation& a = config.augmentation;
  const T dt(tick_s);
  const auto has_model = memory.model_started > T(0.0);
  const T model_error = Select(has_model, memory.model_error_rad, error);
  const T model_rate = Select(has_model, memory.model_rate_rad_s, rate);
  const T departure = error - model_error;
  T command = Fma(stage.kp_1_s2, error, stage.kd_1_s * rate);
  T of_model = Fma(stage.kp_1_s2, model_error, stage.kd_1_s * model_rate);
  if (config.law == ControlLaw::kPidAac) {
    command = StepPid<kAll>(config.integral, tick_s, stage, acting, error, rate, memory);
    of_model = of_model + memory.model_integral_rad_s2;
    memory.model_integral_rad_s2 =
        Kept<kAll>(acting, Fma(dt * stage.ki_1_s3, model_error, memory.model_integral_rad_s2),
                   memory.model_integral_rad_s2);
  }
  command = memory.total_gain * command;

  const T next_rate = model_rate - dt * of_model;
  const T next_error = Fma(dt, next_rate, model_error);
  const T high_pass = Fma(T(tick_s * a.high_pass_rad_s), command - memory.high_pass, memory.high_pass);
  const T fast = command - high_pass;
  const T low_pass = Fma(T(tick_s * a.low_pass_rad_s), Fma(fast, fast, -memory.low_pass), memory.low_pass);

  const double k_max = a.maximum_total_gain - a.minimum_total_gain;
  const T k_a = memory.total_gain - T(a.minimum_total_gain);
  const T gain_rate =
      (T(k_max) - k_a) * T(k_max > 0.0 ? a.adaptive_gain_1_s / k_max : 0.0) * departure * departure -
      T(a.spectral_gain_1_s) * k_a * low_pass - T(a.leakage_1_s) * (memory.total_gain - T(1.0));
  const T total_gain =
      Clamp(Fma(dt, gain_rate, memory.total_gain), T(a.minimum_total_gain), T(a.maximum_total_gain));
  memory.model_started = Kept<kAll>(acting, T(1.0), memory.model_started);
  memory.model_error_rad = Kept<kAll>(acting, next_error, memory.model_error_rad);
  memory.model_rate_rad_s = Kept<kAll>(acting, next_rate, memory.model_rate_rad_s);
  memory.high_pass = Kept<kAll>(acting, high_pass, memory.high_pass);
  memory.low_pass = Kept<kAll>(acting, low_pass, memory.low_pass);
  memory.total_gain = Kept<kAll>(acting, total_gain, memory.total_gain);
  return command;
}

/// `count` sections in series, transposed direct form II: two values of memory each.
template <bool kAll, class T>
DISPERSA_INLINE T Filter(int count, const T (*sections)[5], MaskOf<T> acting, T x, T (*memory)[2]) {
  for (int i = 0; i < count; ++i) {
    const T* c = sections[i];  // b0, b1, b2, a1, a2
    T* m = memory[i];
    const T y = Fma(c[0], x, m[0]);
    const T first = Fma(c[1], x, Fma(-c[3], y, m[1]));
    const T second = Fma(c[2], x, -c[4] * y);
    m[0] = Kept<kAll>(acting, first, m[0]);
    m[1] = Kept<kAll>(acting, second, m[1]);
    x = y;
  }
  return x;
}

/// One tick of the lanes that act; the others' memory stays as it is. `foreign_rad_s2`: the command of a law
/// that is not ours, else null. `is_reported`: what the law has learnt is read afterwards.
template <bool kAll, class T>
DISPERSA_INLINE void StepAxis(const AxisConfig& config, double tick_s, const AxisStage<T>& stage,
                              MaskOf<T> acting, T error, T rate, const T* foreign_rad_s2, bool is_reported,
                              AxisMemory<T>& memory, AxisOutput<T>& out) {
  out.command_rad_s2 = out.departure_norm2 = out.frozen = T(0.0);
  out.v =
      T(0.5) * Fma(stage.p11 * error, error, Fma(T(2.0) * stage.p12 * error, rate, stage.p22 * rate * rate));
  out.v_rate_sign =
      Select(out.v > memory.previous_v, T(1.0), Select(out.v < memory.previous_v, T(-1.0), T(0.0)));
  memory.previous_v = Kept<kAll>(acting, out.v, memory.previous_v);
  switch (config.law) {
    case ControlLaw::kAdaptiveFuzzy:
    case ControlLaw::kFrozenFuzzy:
      out.command_rad_s2 =
          StepFuzzy<kAll>(config, tick_s, stage, acting, error, rate, is_reported, memory, out);
      break;
    case ControlLaw::kPd:
      out.command_rad_s2 = Fma(stage.kp_1_s2, error, stage.kd_1_s * rate);
      break;
    case ControlLaw::kPid:
      out.command_rad_s2 = StepPid<kAll>(config.integral, tick_s, stage, acting, error, rate, memory);
      break;
    case ControlLaw::kPdAac:
    case ControlLaw::kPidAac:
      out.command_rad_s2 = StepAugmented<kAll>(config, tick_s, stage, acting, error, rate, memory);
      break;
    case ControlLaw::kPlugin:
      out.command_rad_s2 = *foreign_rad_s2;
      break;
  }
  const int sections = static_cast<int>(config.filters.size());
  out.command_rad_s2 = Filter<kAll>(sections, stage.filters, acting, out.command_rad_s2, memory.filters);
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
