// One flight under closed-loop guidance: the link between its lane and core/guidance/.
//
// The lane gives true values. This class adds the errors of navigation and accelerometers, so guidance sees
// measured values only. It runs about once a second as ordinary code of one flight. It gives the lane its own
// rows of reference attitude, instead of those that all flights share.
#pragma once

#include <memory>
#include <optional>

#include "core/flight/attitude_program.h"
#include "core/flight/flight_inputs.h"
#include "core/flight/flight_model.h"
#include "core/guidance/outcome.h"

namespace dispersa {

class ClosedLoopGuidance;
struct NavigatedState;

/// A lane at a tick, as it is.
struct LaneSight {
  double time_s = 0.0;
  double p_EoC_I[3] = {};
  double v_IC_I[3] = {};
  int stack = 0;
  bool burning = false;
  unsigned jettisoned = 0;  ///< bits of LauncherPhase::jettisoned
  double ignition_s = 0.0;
  double expelled_kg = 0.0;
  double specific_force_m_s2 = 0.0;
  // By the gyros, in pitch and yaw: thrust does not turn with roll.
  double measured_angle_rad = 0.0;
  double measured_rate_rad_s = 0.0;
};

class GuidedFlight {
 public:
  GuidedFlight(const FlightModel& model, const FlightInputs& inputs);
  ~GuidedFlight();

  /// The tick from which on it wants to see the lane again.
  double next_tick() const { return next_tick_; }
  /// True when the last stage's ignition is to be at ignition_s() from now on.
  bool See(const LaneSight& sight);
  double ignition_s() const;
  /// Whether guidance decides when the present burn ends.
  bool cuts_off() const;
  /// Then: the time from now until it is to end, s. The arguments are true values. The speed's growth is that
  /// of the acceleration, and `growing_m_s2` beyond it.
  double CutOffIn(double time_s, double ignition_s, const Vector3& v_IC_I, const Vector3& acceleration_m_s2_I,
                  double growing_m_s2, double specific_force_m_s2) const;

  /// Whether the lane's reference is its own.
  bool steers() const { return steers_; }
  /// The lane's row of ReferenceRows at a tick, and then of FeedForwardRows. Ticks do not fall.
  const double* RowAt(double tick);
  const double* feed_forward_row() const { return feed_forward_row_; }
  /// For times near the last tick. Does not change the state.
  ReferenceAttitude ReferenceAt(double time_s) const;

  /// The injection. The arguments are true values.
  void Inject(double altitude_m, const Vector3& p_EoC_I, const Vector3& v_IC_I);
  const GuidanceOutcome& outcome() const;

 private:
  /// Whether guidance may steer the stage that lifts off: above the air that matters, and some seconds after
  /// its boosters have left.
  bool SteersFirstStage(const LaneSight& sight, const NavigatedState& state);

  const FlightModel& model_;
  const Vector3 position_error_I_, velocity_error_I_;
  const double accelerometer_factor_;
  const std::unique_ptr<ClosedLoopGuidance> guidance_;
  double next_tick_ = 0.0;
  bool steers_ = false;
  bool first_stage_met_air_ = false;           ///< its dynamic pressure has been above kThinAir_pa
  std::optional<double> first_stage_ready_s_;  ///< when both came true
  alignas(64) double row_[ReferenceRows::kRowSize] = {};
  alignas(64) double feed_forward_row_[FeedForwardRows::kRowSize] = {};
};

}  // namespace dispersa
