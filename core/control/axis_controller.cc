#include "core/control/axis_controller.h"

#include <cmath>

#include "core/control/lyapunov.h"
#include "core/math/functions.h"

namespace dispersa {

namespace {

// The product-sum of consequents and regressor: (26).
double RuleOutput(const std::array<double, kFuzzyRules>& consequents,
                  const std::array<double, kFuzzyRules>& zeta) {
  double u = 0.0;
  for (std::size_t i = 0; i < kFuzzyRules; ++i) u += consequents[i] * zeta[i];
  return u;
}

// Adaptation law (32) with its guards.
//
// A steady disturbance excites the central rule alone. Learnt there alone it bends the rule surface: the
// slope towards the neighbours, which is the loop's gain, changes and can turn negative. `spread` draws each
// departure to the mean of all, so that what lasts becomes a common offset, which leaves the slopes alone. As
// leakage does, it adds a negative semi-definite term to dV/dt, but none against a common offset.
void Adapt(const AxisLaw::PerStageLaw& law, const Adaptation& guards, const Vector2& p_n,
           const std::array<double, kFuzzyRules>& zeta, double error, double rate, int saturation,
           double tick_s, AxisState& state, AxisTelemetry& telemetry) {
  const double drive = p_n.x() * error + p_n.y() * rate;  // e' P_n
  const bool in_dead_zone = std::fabs(drive) < guards.dead_zone_rad * std::fabs(p_n.x());
  const bool into_limit = guards.freeze_when_saturated && saturation * drive > 0.0;
  telemetry.frozen = in_dead_zone || into_limit;
  const double step = telemetry.frozen ? 0.0 : tick_s * law.gamma * drive;
  const double leak = tick_s * guards.leakage_1_s;
  const double bound = guards.projection_bound_rad_s2;
  const double spread = tick_s * guards.spread_1_s;
  double mean = 0.0;
  for (std::size_t i = 0; i < kFuzzyRules; ++i) mean += state.consequents[i] - law.consequents[i];
  mean /= kFuzzyRules;
  for (std::size_t i = 0; i < kFuzzyRules; ++i) {
    double from_start = state.consequents[i] - law.consequents[i];
    from_start += step * zeta[i] - leak * from_start - spread * (from_start - mean);
    if (bound > 0.0 && std::fabs(from_start) > bound) {
      from_start = Clamp(from_start, -bound, bound);
      telemetry.projected = true;
    }
    state.consequents[i] = law.consequents[i] + from_start;
  }
}

// Beyond the outer sets the rule surface is flat; the supervisory term restores the linear law there while
// V exceeds its bound.
double Supervisory(const AxisLaw& law, const AxisGains& gains, double error, double rate, double v) {
  const double bound = law.config.adaptation.supervisory_bound;
  if (bound <= 0.0 || v <= bound) return 0.0;
  const FuzzyRules& rules = law.config.rules;
  const double error_beyond = error - Clamp(error, -rules.error_range_rad, rules.error_range_rad);
  const double rate_beyond = rate - Clamp(rate, -rules.rate_range_rad_s, rules.rate_range_rad_s);
  return gains.kp_1_s2 * error_beyond + gains.kd_1_s * rate_beyond;
}

// Adaptive augmenting control, with k_T = k_0 + k_a the total gain, k_0 its floor, e_r the departure from
// the reference model and y_s the low-passed square of the high-passed command:
//   dk_a/dt = (k_max - k_a) / k_max a e_r² - alpha k_a y_s - beta (k_T - 1).
// The reference model is the error dynamics the gains are chosen for, started at the stage's first error: in
// error coordinates the attitude command does not appear. Returns the command.
double Augment(const AdaptiveAugmentation& a, const AxisGains& gains, double error, double rate,
               double tick_s, AxisState& s) {
  if (!s.model_started) {
    s.model_started = true;
    s.model_error_rad = error;
    s.model_rate_rad_s = rate;
  }
  const double departure = error - s.model_error_rad;
  const double command = s.total_gain * (gains.kp_1_s2 * error + gains.kd_1_s * rate);

  s.model_rate_rad_s -=
      tick_s * (gains.kp_1_s2 * s.model_error_rad + gains.kd_1_s * s.model_rate_rad_s);
  s.model_error_rad += tick_s * s.model_rate_rad_s;
  s.high_pass += tick_s * a.high_pass_rad_s * (command - s.high_pass);
  const double fast = command - s.high_pass;
  s.low_pass += tick_s * a.low_pass_rad_s * (fast * fast - s.low_pass);

  const double k_max = a.maximum_total_gain - a.minimum_total_gain;
  const double k_a = s.total_gain - a.minimum_total_gain;
  const double gain_rate = (k_max - k_a) / k_max * a.adaptive_gain_1_s * departure * departure -
                           a.spectral_gain_1_s * k_a * s.low_pass - a.leakage_1_s * (s.total_gain - 1.0);
  s.total_gain = Clamp(s.total_gain + tick_s * gain_rate, a.minimum_total_gain, a.maximum_total_gain);
  return command;
}

}  // namespace

AxisLaw BuildAxisLaw(const AxisConfig& config) {
  AxisLaw law;
  law.config = config;
  for (std::size_t i = 0; i < config.gains.size(); ++i) {
    AxisLaw::PerStageLaw stage;
    stage.gains = config.gains[i];
    const bool fuzzy =
        config.law == ControlLaw::kAdaptiveFuzzy || config.law == ControlLaw::kFrozenFuzzy;
    // V is logged for every law; where no Q is configured the identity serves.
    const Matrix2 q = fuzzy && IsPositiveDefinite(config.adaptation.q) ? config.adaptation.q
                                                                       : Matrix2(Matrix2::Identity());
    stage.p = SolveLyapunov(stage.gains, q);
    stage.p_n = config.adaptation.p_n ? *config.adaptation.p_n : Vector2(stage.p.col(1));
    if (config.law == ControlLaw::kAdaptiveFuzzy) stage.gamma = config.adaptation.gamma[i];
    if (fuzzy) stage.consequents = PlaneConsequents(config.rules, stage.gains);
    law.stages.push_back(stage);
  }
  return law;
}

void ResetAxis(const AxisLaw& law, int stage, AxisState& state) {
  const std::uint32_t fired = state.rules_fired;
  state = AxisState{};
  state.rules_fired = fired;
  state.consequents = law.stages[static_cast<std::size_t>(stage)].consequents;
}

double StepAxis(const AxisLaw& law, int stage, double error, double rate, int saturation,
                const Vector2& pn_factor, double tick_s, AxisState& state, AxisTelemetry& telemetry) {
  const AxisLaw::PerStageLaw& s = law.stages[static_cast<std::size_t>(stage)];
  telemetry = AxisTelemetry{};
  telemetry.v = 0.5 * (s.p(0, 0) * error * error + 2.0 * s.p(0, 1) * error * rate +
                       s.p(1, 1) * rate * rate);
  telemetry.v_rate_sign = telemetry.v > state.previous_v ? 1.0 : (telemetry.v < state.previous_v ? -1.0 : 0.0);
  state.previous_v = telemetry.v;

  double u = 0.0;
  switch (law.config.law) {
    case ControlLaw::kAdaptiveFuzzy:
    case ControlLaw::kFrozenFuzzy: {
      const auto zeta = Regressor(law.config.rules, error, rate);
      for (std::size_t i = 0; i < kFuzzyRules; ++i)
        if (zeta[i] > 0.0) state.rules_fired |= 1u << i;
      u = RuleOutput(state.consequents, zeta) + Supervisory(law, s.gains, error, rate, telemetry.v);
      if (law.config.law == ControlLaw::kAdaptiveFuzzy && s.gamma > 0.0)
        Adapt(s, law.config.adaptation, s.p_n.cwiseProduct(pn_factor), zeta, error, rate, saturation,
              tick_s, state, telemetry);
      double squares = 0.0;
      for (std::size_t i = 0; i < kFuzzyRules; ++i)
        squares += Square(state.consequents[i] - s.consequents[i]);
      telemetry.adaptation_norm = Sqrt(squares);
      break;
    }
    case ControlLaw::kPd:
      u = s.gains.kp_1_s2 * error + s.gains.kd_1_s * rate;
      break;
    case ControlLaw::kPdAac:
      u = Augment(law.config.augmentation, s.gains, error, rate, tick_s, state);
      break;
  }
  telemetry.command_rad_s2 = u;
  return u;
}

}  // namespace dispersa
