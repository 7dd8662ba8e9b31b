#include "core/flight/guided_flight.h"

#include "core/guidance/air.h"
#include "core/guidance/closed_loop.h"

namespace dispersa {

GuidedFlight::GuidedFlight(const FlightModel& model, const FlightInputs& in)
    : model_(model),
      position_error_I_(model.frame().R_IL * Vector3(in.sensors.navigation_position_error_m[0],
                                                     in.sensors.navigation_position_error_m[1],
                                                     in.sensors.navigation_position_error_m[2])),
      velocity_error_I_(model.frame().R_IL * Vector3(in.sensors.navigation_velocity_error_m_s[0],
                                                     in.sensors.navigation_velocity_error_m_s[1],
                                                     in.sensors.navigation_velocity_error_m_s[2])),
      accelerometer_factor_(in.sensors.accelerometer_scale_factor),
      guidance_(std::make_unique<ClosedLoopGuidance>(*model.guidance_mission())) {}

GuidedFlight::~GuidedFlight() = default;

double GuidedFlight::ignition_s() const { return guidance_->ignition_s(); }

bool GuidedFlight::cuts_off() const { return guidance_->cuts_off(); }

double GuidedFlight::CutOffIn(double time_s, double ignition_s, const Vector3& v_IC_I,
                              const Vector3& acceleration_m_s2_I, double growing_m_s2,
                              double specific_force_m_s2) const {
  const Vector3 seen = v_IC_I + velocity_error_I_;
  const double speed_m_s = seen.norm();
  return guidance_->CutOffIn(time_s, ignition_s, speed_m_s,
                             seen.dot(acceleration_m_s2_I) / speed_m_s + growing_m_s2,
                             accelerometer_factor_ * specific_force_m_s2);
}

void GuidedFlight::Inject(double altitude_m, const Vector3& p_EoC_I, const Vector3& v_IC_I) {
  guidance_->BurnOut(altitude_m + position_error_I_.dot(p_EoC_I) / p_EoC_I.norm(),
                     p_EoC_I + position_error_I_, v_IC_I + velocity_error_I_);
}

const GuidanceOutcome& GuidedFlight::outcome() const { return guidance_->outcome(); }

bool GuidedFlight::See(const LaneSight& sight) {
  const double tick_s = model_.definition().autopilot.tick_s;
  const int last = static_cast<int>(model_.nominal_plant().stacks.size()) - 1;
  GuidanceSight seen;
  const GuidanceMission& mission = *model_.guidance_mission();
  const bool is_below = sight.stack == last - 1 && mission.steers_below, is_last = sight.stack == last;
  const int earlier = sight.stack - (last - 1 - static_cast<int>(mission.earlier.size()));
  const bool is_earlier = !is_below && !is_last && earlier >= 0 && !mission.earlier.empty();
  seen.state = {sight.time_s, Vector3(sight.p_EoC_I) + position_error_I_,
                Vector3(sight.v_IC_I) + velocity_error_I_};
  const bool waits = sight.stack == 0 && (is_below || is_earlier) && !SteersFirstStage(sight, seen.state);
  if (waits || (!(is_below && sight.burning) && !is_last && !(is_earlier && sight.burning))) {
    guidance_->Wait();
    next_tick_ += 1.0 / tick_s;
    return false;
  }
  seen.phase = is_earlier      ? GuidancePhase::kEarlierBurns
               : is_below      ? GuidancePhase::kBelowBurns
               : sight.burning ? GuidancePhase::kLastBurns
                               : GuidancePhase::kCoast;
  if (is_earlier) seen.earlier = static_cast<std::size_t>(earlier);
  seen.jettisoned = sight.jettisoned;
  seen.burn_ignition_s = sight.ignition_s;
  seen.specific_force_m_s2 = accelerometer_factor_ * sight.specific_force_m_s2;
  seen.expelled_kg = sight.expelled_kg;
  seen.attitude_error_rad = sight.measured_angle_rad;
  seen.rate_error_rad_s = sight.measured_rate_rad_s;
  const bool moves = guidance_->See(seen);
  steers_ = guidance_->steers();
  next_tick_ = guidance_->next_call_s() / tick_s;
  return moves;
}

bool GuidedFlight::SteersFirstStage(const LaneSight& sight, const NavigatedState& state) {
  if (!first_stage_ready_s_) {
    // On the pad the pressure is low, too.
    const bool is_thin = DynamicPressure(*model_.guidance_mission(), state) <= kThinAir_pa;
    first_stage_met_air_ = first_stage_met_air_ || !is_thin;
    if (model_.nominal_plant().boosters && (sight.jettisoned & kBoostersGone) == 0u) return false;
    if (!is_thin || !first_stage_met_air_) return false;
    first_stage_ready_s_ = sight.time_s;
  }
  return sight.time_s >= *first_stage_ready_s_ + kTakeOver_s;
}

const double* GuidedFlight::RowAt(double tick) {
  const double time_s = tick * model_.definition().autopilot.tick_s;
  guidance_->Command(time_s);
  const ReferenceAttitude at = ReferenceAt(time_s);
  const Quaternion q_IR = model_.frame().q_IL * at.q_LR;
  const double values[ReferenceRows::kRowSize] = {q_IR.w,        q_IR.x,        q_IR.y,        q_IR.z,
                                                  at.w_LR_R.x(), at.w_LR_R.y(), at.w_LR_R.z(), 0.0};
  for (int i = 0; i < ReferenceRows::kRowSize; ++i) row_[i] = values[i];
  const Vector3 turn = guidance_->command().Acceleration();
  const AutopilotConfig& autopilot = model_.definition().autopilot;
  const AxisConfig* const axes[kAxes] = {&autopilot.roll, &autopilot.pitch, &autopilot.yaw};
  for (int axis = 0; axis < kAxes; ++axis)
    feed_forward_row_[axis] = axes[axis]->feed_forward ? turn[axis] : 0.0;
  return row_;
}

ReferenceAttitude GuidedFlight::ReferenceAt(double time_s) const {
  ReferenceAttitude at;
  at.angles = guidance_->command().AnglesAt(time_s);
  at.q_LR = FromPitchYawRoll(at.angles);
  at.w_LR_R = guidance_->command().RateAt(time_s);
  return at;
}

}  // namespace dispersa
