#include "core/control/axis_controller.h"

#include <cstring>

#include "core/control/axis_step.h"
#include "core/control/law_schedule.h"
#include "core/control/lyapunov.h"

namespace dispersa {

namespace {

// All but the filters.
StageLaw LawOf(const AxisConfig& config, const AxisGains& gains, double gamma, double ki_1_s3) {
  // V is logged for every law; where no Q is configured the identity serves.
  const Matrix2 q = InfoOf(config.law).rules && IsPositiveDefinite(config.adaptation.q)
                        ? config.adaptation.q
                        : Matrix2(Matrix2::Identity());
  const Matrix2 p = SolveLyapunov(gains, q);
  const Vector2 p_n = config.adaptation.p_n ? *config.adaptation.p_n : Vector2(p.col(1));
  return {gains.kp_1_s2, gains.kd_1_s, p(0, 0), p(0, 1), p(1, 1), p_n.x(), p_n.y(), gamma, ki_1_s3, {}};
}

StageLaw RateBetween(const LawPiece& a, const LawPiece& b) {
  constexpr std::size_t kNumbers = sizeof(StageLaw) / sizeof(double);
  double from[kNumbers], to[kNumbers];
  std::memcpy(from, &a.at, sizeof a.at);
  std::memcpy(to, &b.at, sizeof b.at);
  for (std::size_t i = 0; i < kNumbers; ++i) to[i] = (to[i] - from[i]) / (b.from_s - a.from_s);
  StageLaw rate;
  std::memcpy(static_cast<void*>(&rate), to, sizeof rate);
  return rate;
}

// The pieces of a stage (0-based) with a known law at ignition.
std::vector<LawPiece> PiecesOf(const AxisConfig& config, int stage, const StageLaw& at_ignition,
                               double tick_s) {
  StageLaw nothing{};
  for (DigitalSection& section : nothing.filters) section.b0 = 0.0;
  std::vector<LawPiece> pieces = {{0.0, at_ignition, nothing}};
  const std::vector<std::size_t> filters = FiltersOfStage(config, stage + 1);
  for (const ScheduleEntry& entry : config.schedule) {
    if (entry.stage != stage + 1) continue;
    LawPiece piece{
        entry.at_s,
        LawOf(config, entry.gains, at_ignition.gamma, InfoOf(config.law).integral ? entry.ki_1_s3 : 0.0),
        nothing};
    for (std::size_t k = 0; k < filters.size(); ++k)
      piece.at.filters[filters[k]] = Discretise(entry.filters[k], tick_s);
    pieces.back().rate = RateBetween(pieces.back(), piece);
    pieces.push_back(piece);
  }
  if (pieces.size() == 1) pieces.clear();
  return pieces;
}

}  // namespace

AxisLaw BuildAxisLaw(const AxisConfig& config, double tick_s) {
  AxisLaw law;
  law.config = config;
  const LawInfo& info = InfoOf(config.law);
  for (std::size_t i = 0; i < config.gains.size(); ++i) {
    StageLaw of_stage = LawOf(config, config.gains[i], info.adaptation ? config.adaptation.gamma[i] : 0.0,
                              info.integral ? config.integral.ki_1_s3[i] : 0.0);
    const int stage = static_cast<int>(i);
    for (const std::size_t k : FiltersOfStage(config, stage + 1))
      of_stage.filters[k] = Discretise(config.filters[k], tick_s);
    law.stages.push_back(of_stage);
    law.pieces.push_back(PiecesOf(config, stage, of_stage, tick_s));
  }
  return law;
}

StageLaw LawAt(const AxisLaw& law, int stage, double since_ignition_s) {
  return lanes::LawAtTime(law, stage, since_ignition_s);
}

void ResetAxis(AxisState& state) {
  const std::uint64_t fired = state.rules_fired;
  state = AxisState{};
  state.rules_fired = fired;
}

double StepAxis(const AxisLaw& law, int stage, double error_rad, double rate_rad_s, double pn_error_factor,
                double pn_rate_factor, double tick_s, AxisState& state, AxisTelemetry& telemetry,
                double since_ignition_s) {
  const StageLaw of_stage =
      LawAt(law, stage, since_ignition_s).WithPnFactors(pn_error_factor, pn_rate_factor);
  AxisMemory<double> memory;
  lanes::SetLaneValues<double>(memory, 0, state);
  lanes::AxisOutput<double> out;
  lanes::StepAxis<true>(law.config, tick_s, of_stage, true, error_rad, rate_rad_s,
                        static_cast<const double*>(nullptr), true, memory, out);
  lanes::ReadLaneValues<double>(memory, 0, state);
  telemetry = lanes::TelemetryOf(law.config, out, memory, 0);
  return out.command_rad_s2;
}

}  // namespace dispersa
