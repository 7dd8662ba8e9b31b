#include "core/control/axis_controller.h"

#include "core/control/axis_step.h"
#include "core/control/lyapunov.h"

namespace dispersa {

AxisLaw BuildAxisLaw(const AxisConfig& config, double tick_s) {
  AxisLaw law;
  law.config = config;
  const LawInfo& info = InfoOf(config.law);
  for (std::size_t i = 0; i < config.gains.size(); ++i) {
    const AxisGains& gains = config.gains[i];
    // V is logged for every law; where no Q is configured the identity serves.
    const Matrix2 q = info.rules && IsPositiveDefinite(config.adaptation.q) ? config.adaptation.q
                                                                            : Matrix2(Matrix2::Identity());
    const Matrix2 p = SolveLyapunov(gains, q);
    const Vector2 p_n = config.adaptation.p_n ? *config.adaptation.p_n : Vector2(p.col(1));
    StageLaw of_stage{gains.kp_1_s2,
                      gains.kd_1_s,
                      p(0, 0),
                      p(0, 1),
                      p(1, 1),
                      p_n.x(),
                      p_n.y(),
                      info.adaptation ? config.adaptation.gamma[i] : 0.0,
                      info.integral ? config.integral.ki_1_s3[i] : 0.0,
                      {}};
    for (std::size_t k = 0; k < config.filters.size(); ++k) {
      const FilterSection& section = config.filters[k];
      if (section.stage == 0 || section.stage == static_cast<int>(i) + 1)
        of_stage.filters[k] = Discretise(section, tick_s);
    }
    law.stages.push_back(of_stage);
  }
  return law;
}

void ResetAxis(AxisState& state) {
  const std::uint64_t fired = state.rules_fired;
  state = AxisState{};
  state.rules_fired = fired;
}

double StepAxis(const AxisLaw& law, int stage, double error_rad, double rate_rad_s, double pn_error_factor,
                double pn_rate_factor, double tick_s, AxisState& state, AxisTelemetry& telemetry) {
  lanes::AxisStage<double> of_stage;
  lanes::SetLane(of_stage, 0, law.stages[static_cast<std::size_t>(stage)], pn_error_factor, pn_rate_factor);
  lanes::AxisMemory<double> memory;
  lanes::SetLane(memory, 0, state);
  lanes::AxisOutput<double> out;
  lanes::StepAxis<true>(law.config, tick_s, of_stage, true, error_rad, rate_rad_s, true, memory, out);
  lanes::ReadLane(memory, 0, state);
  telemetry = lanes::TelemetryOf(law.config, out, memory, 0);
  return out.command_rad_s2;
}

}  // namespace dispersa
