// The guidance of one flight. From the last burn but one on it receives the navigated state from time to
// time, plans, and commands an attitude at every tick.
#pragma once

#include "core/guidance/attitude_command.h"
#include "core/guidance/corrector.h"
#include "core/guidance/engine_estimate.h"
#include "core/guidance/motor_estimate.h"
#include "core/guidance/outcome.h"

namespace dispersa {

/// Measured values for a call of guidance. None is a true value.
struct GuidanceSight {
  NavigatedState state;
  GuidancePhase phase = GuidancePhase::kCoast;
  std::size_t earlier = 0;           ///< which of the mission's earlier burns
  unsigned jettisoned = 0;           ///< bodies that have left, as bits
  double burn_ignition_s = 0.0;      ///< of the motor that burns
  double specific_force_m_s2 = 0.0;  ///< by the accelerometers, its magnitude
  double expelled_kg = 0.0;          ///< by the reaction control, from its valves' times
  double attitude_error_rad = 0.0;   ///< measured, to the command, in pitch and yaw
  double rate_error_rad_s = 0.0;
};

class ClosedLoopGuidance {
 public:
  explicit ClosedLoopGuidance(const GuidanceMission& mission);

  /// When it wants to see again, s since lift-off.
  double next_call_s() const { return next_call_s_; }
  /// Plans. True when the last stage's ignition is to be at ignition_s() from now on.
  bool See(const GuidanceSight& sight);
  /// In place of it in a coast before the last burn but one.
  void Wait();
  double ignition_s() const { return plan_.ignition_s(); }

  /// Whether it decides when the present burn ends. If not, the vehicle's own cut-off stands.
  bool cuts_off() const { return cut_off_.has_value(); }
  /// Time from now until the present burn, of this ignition, is to end, s. `growth_m_s2` is that of the
  /// speed. All are measured. Far off, it is only a time after the next tick.
  double CutOffIn(double time_s, double ignition_s, double speed_m_s, double growth_m_s2,
                  double specific_force_m_s2) const;

  /// Whether the attitude is its own and no longer the reference's.
  bool steers() const { return steers_; }
  /// Moves the command on to a tick. Times do not fall.
  void Command(double time_s);
  const AttitudeCommand& command() const { return command_; }
  const Plan& plan() const { return plan_; }
  /// The injection, measured.
  void BurnOut(double altitude_m, const Vector3& p_EoC_I, const Vector3& v_IC_I);
  const GuidanceOutcome& outcome() const { return outcome_; }

 private:
  void SeeEarlierBurn(const GuidanceSight& sight);
  void BeginEarlierBurn(std::size_t index);
  /// A stage as it begins to burn, if it is another burn of the engine that burnt before.
  std::optional<GuidedStage> LeftFor(const GuidedStage& stage, const BurnStart& start) const;
  void SeeBelowBurn(const GuidanceSight& sight);
  bool SeeCoast(const GuidanceSight& sight);
  void SeeLastBurn(const GuidanceSight& sight);
  void MeasureThrust(const GuidanceSight& sight);
  void TakeOver(double time_s);
  /// Bounds of the cut-offs, and of an ignition after one, as the estimates have them.
  void BoundCutOffs(const Knowledge& known, double time_s, CorrectorTask& task);
  /// Bounds of a burn's departures from the reference's attitude, in the air that is left.
  void BoundIncidence(const NavigatedState& state, PlanUnknown pitch, PlanUnknown yaw, CorrectorTask& task);
  void SteerToCutOff(const Knowledge& known, const NavigatedState& state);
  void SetCutOff(const Correction& found);
  void SetPeriod(double since_s, double left_s);
  CorrectorTask Task(std::initializer_list<PlanUnknown> free, const Plan& prior, int iterations) const;

  const GuidanceMission& mission_;
  PlanPrior prior_;
  Plan plan_;
  bool met_all_ = false;             ///< the last plan that had to meet altitude and plane too did so
  std::optional<Plan> before_near_;  ///< the plan with which the coast's last seconds began
  Plan at_ignition_;                 ///< what the last burn's plans depart from as little as they can
  AttitudeCommand command_;
  bool steers_ = false;
  GuidancePhase phase_ = GuidancePhase::kBelowBurns;
  double next_call_s_ = 0.0;
  MotorEstimate below_, last_;
  std::optional<EngineEstimate> below_engine_, last_engine_;  ///< in their place, of engines
  std::optional<std::size_t> earlier_;                        ///< the earlier burn that burns, or did last
  std::optional<MotorEstimate> earlier_motor_;
  std::optional<EngineEstimate> earlier_engine_;
  bool waits_ = false;        ///< in a coast between burns
  unsigned jettisoned_ = 0u;  ///< as last seen
  /// The planned end of a burn: reaching this speed, about at this time. Of a burn with a timer: its
  /// duration.
  struct CutOffPlan {
    double speed_m_s = 0.0, time_s = 0.0;
    std::optional<double> duration_s = {};
    std::optional<double> ignition_s = {};  ///< of the burn, if it is an earlier one
  };
  std::optional<CutOffPlan> cut_off_;  ///< of the present burn
  Vector3 thrust_offset_rad_I_ = Vector3::Zero();
  NavigatedState previous_;  ///< of the burn's last call, and where thrust was to point then
  Vector3 previous_direction_L_ = Vector3::Zero();
  bool has_previous_ = false;
  GuidanceOutcome outcome_;
};

}  // namespace dispersa
