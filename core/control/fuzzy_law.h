// The paper's direct adaptive fuzzy law and its rules held.
#pragma once

#include "core/control/fuzzy.h"
#include "core/control/law.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// Grades of the five triangular sets over a position in units of their centres' spacing, 0 at the first
/// centre: Memberships of fuzzy.h. They sum to 1, so the regressor of (22) is the product of two.
template <class T>
DISPERSA_INLINE void Grades(T position, T* grade) {
  for (int i = 0; i < kFuzzySets; ++i)
    grade[i] = Max(T(1.0) - Abs(position - T(static_cast<double>(i))), T(0.0));
}

/// The paper's law (20)-(32), adaptive or frozen, with the guards of Adaptation.
///
/// A consequent is its start plus a departure. The starts make the rule surface the plane kp e + kd de/dt
/// between the outer centres. So the output is the plane's plus the regressor times the departures.
///
/// A steady disturbance excites the central rule alone. Learnt there alone it bends the rule surface. The
/// slope towards the neighbours is the loop's gain: it changes and can turn negative. `spread` draws each
/// departure to the mean of all. A lasting disturbance so becomes a common offset, which does not change the
/// slopes. Like leakage, it adds a negative semi-definite term to dV/dt, but none against a common offset.
struct FuzzyLaw {
  static void StartStage(const AxisConfig& config, int stage, AxisState& memory) {
    // The departures learnt in the stage before are carried over.
    if (stage == 0 || config.adaptation.reset_at_ignition) ResetAxis(memory);
  }

  template <bool kAll, class T>
  DISPERSA_INLINE static void Step(const LawInput<T>& in, AxisOutput<T>& out, AxisMemory<T>& memory) {
    const T error = in.error_rad, rate = in.rate_rad_s;
    const FuzzyRules& rules = in.config.rules;
    const double last = kFuzzySets - 1.0;
    const T at_error = Clamp(Fma(error, T(2.0 / rules.error_range_rad), T(0.5 * last)), T(0.0), T(last));
    const T at_rate = Clamp(Fma(rate, T(2.0 / rules.rate_range_rad_s), T(0.5 * last)), T(0.0), T(last));
    T by_error[kFuzzySets], by_rate[kFuzzySets];
    Grades(at_error, by_error);
    Grades(at_rate, by_rate);
    if (in.is_reported) {
      // Rule i * 5 + j has fired where set i of the error and set j of the rate have.
      T rows(0.0), columns(0.0);
      for (int i = 0; i < kFuzzySets; ++i) {
        rows = OrBits(rows, Select(by_error[i] > T(0.0), T(OfBits(std::uint64_t{0x1f} << (5 * i))), T(0.0)));
        columns =
            OrBits(columns, Select(by_rate[i] > T(0.0), T(OfBits(std::uint64_t{0x108421} << i)), T(0.0)));
      }
      memory.rules_fired =
          Kept<kAll>(in.acting, OrBits(memory.rules_fired, AndBits(rows, columns)), memory.rules_fired);
    }

    const T centre(0.5 * last);
    T u = Fma(in.stage.kp_1_s2 * T(0.5 * rules.error_range_rad), at_error - centre,
              in.stage.kd_1_s * T(0.5 * rules.rate_range_rad_s) * (at_rate - centre));
    if (in.config.law == ControlLaw::kAdaptiveFuzzy) {
      const Adaptation& guards = in.config.adaptation;
      T drive = Fma(in.stage.pn_error, error, in.stage.pn_rate * rate);  // e' P_n
      if (guards.composite > 0.0) {
        const T predicted = Select(memory.model_started > T(0.0), memory.model_rate_rad_s, rate);
        const T missed = rate - predicted;
        drive = Fma(T(guards.composite) * in.stage.pn_rate, missed, drive);
        // The learnt departures are assumed to cancel the disturbance: the error dynamics remain.
        const T change = Fma(T(guards.predictor_1_s), missed, -u);
        memory.model_rate_rad_s =
            Kept<kAll>(in.acting, Fma(T(in.tick_s), change, predicted), memory.model_rate_rad_s);
        memory.model_started = Kept<kAll>(in.acting, T(1.0), memory.model_started);
      }
      auto is_frozen = Abs(drive) < T(guards.dead_zone_rad) * Abs(in.stage.pn_error);
      if (guards.freeze_when_saturated) is_frozen = is_frozen | (memory.saturation * drive > T(0.0));
      // Without adaptation these coefficients leave every consequent as it is.
      const auto adapts = in.acting & (in.stage.gamma > T(0.0));
      T rated = T(in.tick_s) * in.stage.gamma * drive;
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
      Each<kFuzzyRules>([&](int i)
                            __attribute__((always_inline)) { sum = sum + memory.departure_rad_s2[i]; });
      const T keep =
          Select(adapts, T(1.0 - in.tick_s * guards.leakage_1_s - in.tick_s * guards.spread_1_s), T(1.0));
      const T pull = Select(adapts, T(in.tick_s * guards.spread_1_s / kFuzzyRules) * sum, T(0.0));
      const T bound(guards.projection_bound_rad_s2 > 0.0 ? guards.projection_bound_rad_s2 : 1e300);
      T learnt(0.0), norm2(0.0);
      Each<kFuzzySets>([&](int i) __attribute__((always_inline)) {
        T row(0.0);
        const T push = step * by_error[i];
        Each<kFuzzySets>([&](int j) __attribute__((always_inline)) {
          T& departure = memory.departure_rad_s2[kFuzzySets * i + j];
          row = Fma(by_rate[j], departure, row);
          departure = Clamp(Fma(push, by_rate[j], Fma(keep, departure, pull)), -bound, bound);
          norm2 = Fma(departure, departure, norm2);
        });
        learnt = Fma(by_error[i], row, learnt);
      });
      if (in.is_reported) {
        out.departure_norm2 = norm2;
        out.frozen = Select(adapts & is_frozen, T(1.0), T(0.0));
      }
      // The command uses the consequents before the step.
      u = u + learnt;
    }
    // Beyond the outer sets the rule surface is flat. There the supervisory term restores the linear law
    // while V exceeds its bound.
    if (in.config.adaptation.supervisory_bound > 0.0) {
      const T error_beyond = error - Clamp(error, T(-rules.error_range_rad), T(rules.error_range_rad));
      const T rate_beyond = rate - Clamp(rate, T(-rules.rate_range_rad_s), T(rules.rate_range_rad_s));
      const T restored = Fma(in.stage.kp_1_s2, error_beyond, Fma(in.stage.kd_1_s, rate_beyond, u));
      u = Select(out.v > T(in.config.adaptation.supervisory_bound), restored, u);
    }
    out.command_rad_s2 = u;
  }
};

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
