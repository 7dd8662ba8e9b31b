#include "core/flight/metrics_recorder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/math/constants.h"
#include "core/math/functions.h"

namespace dispersa {

namespace {

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();
// Start-up transients of a stage are no limit cycle.
constexpr double kSettled_s = 5.0;
// Incidence means nothing where there is no air to feel it.
constexpr double kIncidenceFloor_pa = 1000.0;
// The residual set of pitch, in which V may rise: V up to that of this error at rest.
constexpr double kResidualError_rad = 0.05 * kRadPerDeg;

}  // namespace

void ErrorStatistics::Add(double value, double time_s) {
  squares += value * value;
  ++count;
  if (count == 1 || std::fabs(value) > peak) {
    peak = std::fabs(value);
    peak_time_s = time_s;
  }
}

double ErrorStatistics::Rms() const {
  return count > 0 ? Sqrt(squares / static_cast<double>(count)) : kUndefined;
}

double ErrorStatistics::Peak() const { return count > 0 ? peak : kUndefined; }

void LimitCycleMeter::Configure(double tick_s) {
  window_.assign(static_cast<std::size_t>(std::lround(1.0 / tick_s)), 0.0);
  // Ten windows a second overlap by nine tenths: no oscillation hides between them.
  stride_ = std::max<std::size_t>(1, window_.size() / 10);
}

void LimitCycleMeter::Add(double value) {
  const std::size_t n = window_.size();
  window_[next_] = value;
  next_ = (next_ + 1) % n;
  if (filled_ < n) ++filled_;
  if (++since_evaluation_ < stride_ || filled_ < n) return;
  since_evaluation_ = 0;
  // Least-squares line over sample numbers centred at 0.
  const double centre = 0.5 * static_cast<double>(n - 1);
  double sum = 0.0, moment = 0.0, weight = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = static_cast<double>(i) - centre;
    const double y = window_[(next_ + i) % n];
    sum += y;
    moment += x * y;
    weight += x * x;
  }
  const double mean = sum / static_cast<double>(n);
  const double slope = moment / weight;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t i = 0; i < n; ++i) {
    const double left = window_[(next_ + i) % n] - mean - slope * (static_cast<double>(i) - centre);
    low = std::min(low, left);
    high = std::max(high, left);
  }
  worst_ = std::max(worst_, high - low);
}

MetricsRecorder::MetricsRecorder(const FlightModel& model, const FlightInputs& inputs)
    : model_(model), tick_s_(model.definition().autopilot.tick_s) {
  for (LimitCycleMeter& meter : limit_cycle_) meter.Configure(tick_s_);
  if (inputs.gust_speed_m_s != 0.0) {
    gust_bottom_m_ = inputs.gust_altitude_m;
    gust_top_m_ = inputs.gust_altitude_m + inputs.gust_length_m;
  }
}

void MetricsRecorder::AddLoads(const LauncherInstant& now) {
  const double q = now.air.qbar_pa;
  const double incidence = TotalIncidence(now.v_AB_B);
  q_max_ = std::max(q_max_, q);
  if (q >= kIncidenceFloor_pa) {
    alpha_max_ = std::max(alpha_max_, incidence);
    q_alpha_max_ = std::max(q_alpha_max_, q * incidence);
  }
  const Vector3 specific = now.loads.force_n / (now.loads.mass_kg * kStandardGravity);
  axial_max_ = std::max(axial_max_, std::fabs(specific.x()));
  lateral_max_ =
      std::max(lateral_max_, Sqrt(specific.y() * specific.y() + specific.z() * specific.z()));

  const StructuralLimits& limits = model_.definition().vehicle.limits;
  const auto exceeded = [](double value, double limit) { return limit > 0.0 && value > limit; };
  structural_exceeded_ = exceeded(q_alpha_max_, limits.q_alpha_pa_rad) ||
                         exceeded(axial_max_, limits.axial_load_g) ||
                         exceeded(lateral_max_, limits.lateral_load_g);
}

void MetricsRecorder::AddTick(const TickSample& s) {
  // In the coast loads are evaluated for the history's rows alone, which must not change a metric.
  if (s.has_instant && !s.coasting) AddLoads(s.instant);
  // Errors are reported as true - reference.
  const double pitch = -s.error.angle_rad.y();
  if (s.coasting) pitch_coast_.Add(pitch, s.time_s);
  if (!s.burning) {
    has_previous_nozzles_ = false;
    for (LimitCycleMeter& meter : limit_cycle_) meter.Interrupt();
    return;
  }
  pitch_.Add(pitch, s.time_s);
  pitch_stage_[static_cast<std::size_t>(s.stack)].Add(pitch, s.time_s);
  yaw_.Add(-s.error.angle_rad.z(), s.time_s);
  roll_.Add(-s.error.angle_rad.x(), s.time_s);
  itae_ += tick_s_ * s.time_s * std::fabs(pitch);

  ++powered_ticks_;
  bool saturated = false;
  double travel = 0.0;
  for (std::size_t i = 0; i < kNozzles; ++i) {
    deflection_.Add(s.nozzle_rad[i], s.time_s);
    deflection_rate_peak_ = std::max(deflection_rate_peak_, std::fabs(s.nozzle_rate_rad_s[i]));
    saturated |= std::fabs(s.command_rad[i]) >= s.limit_rad;
    if (has_previous_nozzles_) travel += std::fabs(s.nozzle_rad[i] - previous_nozzles_[i]);
  }
  if (saturated) ++saturated_ticks_;
  travel_ += travel / kNozzles;
  previous_nozzles_ = s.nozzle_rad;
  has_previous_nozzles_ = true;

  const FlightDefinition& definition = model_.definition();
  const bool kick = s.time_s >= definition.kick_start_s && s.time_s <= definition.kick_end_s;
  const double altitude = s.instant.air.place.altitude_m;
  const bool gust = gust_top_m_ > gust_bottom_m_ && altitude >= gust_bottom_m_ && altitude <= gust_top_m_;
  const double channels[kAxes] = {
      0.25 * (s.nozzle_rad[0] - s.nozzle_rad[1] + s.nozzle_rad[2] - s.nozzle_rad[3]),
      0.5 * (s.nozzle_rad[0] + s.nozzle_rad[1]), 0.5 * (s.nozzle_rad[2] + s.nozzle_rad[3])};
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    if (kick || gust || s.since_ignition_s < kSettled_s)
      limit_cycle_[axis].Interrupt();
    else
      limit_cycle_[axis].Add(channels[axis]);
  }

  const AxisTelemetry& telemetry = s.gimbal.telemetry[kPitch];
  const auto& laws = model_.autopilot().laws[kPitch].stages;
  const double p11 = laws[static_cast<std::size_t>(s.stack)].p(0, 0);
  if (telemetry.v > 0.5 * p11 * Square(kResidualError_rad)) {
    ++v_outside_ticks_;
    if (telemetry.v_rate_sign < 0.0) ++v_falling_ticks_;
  }
  adaptation_norm_peak_ = std::max(adaptation_norm_peak_, telemetry.adaptation_norm);
  rules_fired_ = s.axes[kPitch].rules_fired;
}

void MetricsRecorder::AddHandover(const AttitudeError& error) {
  handed_over_ = true;
  handover_angle_ = error.angle_rad.norm();
  handover_rate_ = error.rate_rad_s.norm();
}

void MetricsRecorder::AddInjection(const Earth& earth, const RigidBodyState& state, double altitude_m) {
  injection_ = {true, altitude_m, ElementsOf(earth, state.p_EoC_I, state.v_IC_I)};
}

std::vector<double> MetricsRecorder::Finish() const {
  std::vector<double> m;
  const auto statistics = [&](const ErrorStatistics& e) {
    m.push_back(e.Rms() * kDegPerRad);
    m.push_back(e.Peak() * kDegPerRad);
    m.push_back(e.count > 0 ? e.peak_time_s : kUndefined);
  };
  statistics(pitch_);
  for (const ErrorStatistics& stage : pitch_stage_) statistics(stage);
  statistics(pitch_coast_);
  m.push_back(itae_ * kDegPerRad);
  for (const ErrorStatistics* e : {&yaw_, &roll_}) {
    m.push_back(e->Rms() * kDegPerRad);
    m.push_back(e->Peak() * kDegPerRad);
  }
  m.push_back(deflection_.Peak() * kDegPerRad);
  m.push_back(deflection_.Rms() * kDegPerRad);
  m.push_back(deflection_rate_peak_ * kDegPerRad);
  m.push_back(powered_ticks_ > 0
                  ? static_cast<double>(saturated_ticks_) / static_cast<double>(powered_ticks_)
                  : kUndefined);
  m.push_back(travel_ * kDegPerRad);
  double cycle = -1.0;
  for (const LimitCycleMeter& meter : limit_cycle_) cycle = std::max(cycle, meter.Worst());
  m.push_back(cycle >= 0.0 ? cycle * kDegPerRad : kUndefined);
  m.insert(m.end(), {q_max_, q_alpha_max_, alpha_max_ * kDegPerRad, axial_max_, lateral_max_,
                     structural_exceeded_ ? 1.0 : 0.0});
  m.push_back(handed_over_ ? handover_angle_ * kDegPerRad : kUndefined);
  m.push_back(handed_over_ ? handover_rate_ * kDegPerRad : kUndefined);
  m.push_back(expelled_mass_kg_);

  const InjectionTarget& target = model_.definition().target;
  const OrbitElements& e = injection_.elements;
  const std::vector<double> injection = {
      injection_.altitude_m * 1e-3,
      e.speed_m_s,
      e.flight_path_angle_rad * kDegPerRad,
      e.apogee_altitude_m * 1e-3,
      e.perigee_altitude_m * 1e-3,
      e.inclination_rad * kDegPerRad,
      (injection_.altitude_m - target.altitude_m) * 1e-3,
      e.speed_m_s - target.velocity_m_s,
      (e.flight_path_angle_rad - target.flight_path_angle_rad) * kDegPerRad};
  for (double value : injection)
    m.push_back(injection_.reached && std::isfinite(value) ? value : kUndefined);

  m.push_back(powered_ticks_ > 0
                  ? static_cast<double>(v_outside_ticks_) / static_cast<double>(powered_ticks_)
                  : kUndefined);
  m.push_back(v_outside_ticks_ > 0
                  ? static_cast<double>(v_falling_ticks_) / static_cast<double>(v_outside_ticks_)
                  : kUndefined);
  m.push_back(adaptation_norm_peak_ * kDegPerRad);
  m.push_back(std::popcount(rules_fired_));
  return m;
}

}  // namespace dispersa
