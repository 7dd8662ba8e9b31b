// One axis of the autopilot: from the attitude error and its rate to an angular acceleration.
//
// Signs: e = reference - true about the body axis, u > 0 accelerates the body in the positive sense, so the
// plant is e'' = -u + disturbance and b = 1 > 0 as (18) and (32) need; the paper's (14) has the opposite
// sign, u = -delta.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/control/autopilot_config.h"
#include "core/control/fuzzy.h"
#include "core/math/linear.h"

namespace dispersa {

/// The law of one axis prepared for flight; shared by all flights.
struct AxisLaw {
  struct PerStageLaw {
    AxisGains gains;
    Matrix2 p = Matrix2::Zero();      ///< of the Lyapunov equation
    Vector2 p_n = Vector2::Zero();    ///< its last column, or the configured one
    double gamma = 0.0;
    std::array<double, kFuzzyRules> consequents{};  ///< at the start
  };
  AxisConfig config;
  std::vector<PerStageLaw> stages;
};
AxisLaw BuildAxisLaw(const AxisConfig& config);

/// All memory of one axis: plain data, made afresh for each flight.
struct AxisState {
  std::array<double, kFuzzyRules> consequents{};
  double total_gain = 1.0;          ///< adaptive augmentation
  bool model_started = false;       ///< its reference model
  double model_error_rad = 0.0;
  double model_rate_rad_s = 0.0;
  double high_pass = 0.0;           ///< its spectral damper
  double low_pass = 0.0;
  double previous_v = 0.0;
  std::uint32_t rules_fired = 0;    ///< bit i: rule i has fired
};

struct AxisTelemetry {
  double command_rad_s2 = 0.0;      ///< u
  double adaptation_norm = 0.0;     ///< of the consequents less their start
  double v = 0.0;                   ///< 1/2 e'Pe
  double v_rate_sign = 0.0;         ///< -1, 0, 1: of the change of v since the last tick
  bool projected = false;
  bool frozen = false;              ///< adaptation held by saturation or dead zone
};

/// Starts a stage's rules and augmentation: at lift-off, and at ignitions if so configured.
void ResetAxis(const AxisLaw& law, int stage, AxisState& state);

/// One tick. `saturation`: -1 or 1 when the last deflection command was limited in the sense of negative or
/// positive u, else 0. `pn_factor` scales P_n (the study of Fig. 5); 1 in flight.
double StepAxis(const AxisLaw& law, int stage, double error_rad, double rate_rad_s, int saturation,
                const Vector2& pn_factor, double tick_s, AxisState& state, AxisTelemetry& telemetry);

}  // namespace dispersa
