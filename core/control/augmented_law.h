// Proportional and derivative control, and PID, under adaptive augmenting control.
#pragma once

#include "core/control/law.h"
#include "core/control/linear_laws.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// Adaptive augmenting control with the total gain k_T = k_0 + k_a. k_0 is its floor, e_r the difference from
/// the reference model, y_s the low-passed square of the high-passed command:
///
///   dk_a/dt = (k_max - k_a) / k_max a e_r² - alpha k_a y_s - beta (k_T - 1)
///
/// The reference model is the error dynamics for which the gains are chosen, started at the stage's first
/// error. In error coordinates the attitude command does not appear. For PID, command and model have their
/// integrals.
struct AugmentedLaw {
  static void StartStage(const AxisConfig&, int, AxisState& memory) { ResetAxis(memory); }

  template <bool kAll, class T>
  DISPERSA_INLINE static void Step(const LawInput<T>& in, AxisOutput<T>& out, AxisMemory<T>& memory) {
    const T error = in.error_rad, rate = in.rate_rad_s;
    const AdaptiveAugmentation& a = in.config.augmentation;
    const T dt(in.tick_s);
    const auto has_model = memory.model_started > T(0.0);
    const T model_error = Select(has_model, memory.model_error_rad, error);
    const T model_rate = Select(has_model, memory.model_rate_rad_s, rate);
    const T departure = error - model_error;
    T command = Fma(in.stage.kp_1_s2, error, in.stage.kd_1_s * rate);
    T of_model = Fma(in.stage.kp_1_s2, model_error, in.stage.kd_1_s * model_rate);
    if (in.config.law == ControlLaw::kPidAac) {
      PidLaw::Step<kAll>(in, out, memory);
      command = out.command_rad_s2;
      of_model = of_model + memory.model_integral_rad_s2;
      memory.model_integral_rad_s2 =
          Kept<kAll>(in.acting, Fma(dt * in.stage.ki_1_s3, model_error, memory.model_integral_rad_s2),
                     memory.model_integral_rad_s2);
    }
    command = memory.total_gain * command;

    const T next_rate = model_rate - dt * of_model;
    const T next_error = Fma(dt, next_rate, model_error);
    const T high_pass = Fma(T(in.tick_s * a.high_pass_rad_s), command - memory.high_pass, memory.high_pass);
    const T fast = command - high_pass;
    const T low_pass =
        Fma(T(in.tick_s * a.low_pass_rad_s), Fma(fast, fast, -memory.low_pass), memory.low_pass);

    const double k_max = a.maximum_total_gain - a.minimum_total_gain;
    const T k_a = memory.total_gain - T(a.minimum_total_gain);
    const T gain_rate =
        (T(k_max) - k_a) * T(k_max > 0.0 ? a.adaptive_gain_1_s / k_max : 0.0) * departure * departure -
        T(a.spectral_gain_1_s) * k_a * low_pass - T(a.leakage_1_s) * (memory.total_gain - T(1.0));
    const T total_gain =
        Clamp(Fma(dt, gain_rate, memory.total_gain), T(a.minimum_total_gain), T(a.maximum_total_gain));
    memory.model_started = Kept<kAll>(in.acting, T(1.0), memory.model_started);
    memory.model_error_rad = Kept<kAll>(in.acting, next_error, memory.model_error_rad);
    memory.model_rate_rad_s = Kept<kAll>(in.acting, next_rate, memory.model_rate_rad_s);
    memory.high_pass = Kept<kAll>(in.acting, high_pass, memory.high_pass);
    memory.low_pass = Kept<kAll>(in.acting, low_pass, memory.low_pass);
    memory.total_gain = Kept<kAll>(in.acting, total_gain, memory.total_gain);
    out.command_rad_s2 = command;
  }
};

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
