// Predicts the injection of a plan: a point mass under gravitation (central and J2) and the thrust of known
// motors, through the rest of a burn, the coasts and the burns after it.
#pragma once

#include <optional>

#include "core/guidance/plan.h"

namespace dispersa {

/// As the navigation has it.
struct NavigatedState {
  double time_s = 0.0;
  Vector3 p_EoC_I = Vector3::Zero();
  Vector3 v_IC_I = Vector3::Zero();
  double dive_m = 0.0;  ///< predicted: how far it has fallen below GuidanceMission::air_below_m
};

enum class GuidancePhase {
  kEarlierBurns,  ///< a burn before the last two
  kBelowBurns,
  kCoast,  ///< before the last burn
  kLastBurns,
};

/// The values at the time of the prediction.
struct Knowledge {
  GuidancePhase phase = GuidancePhase::kCoast;
  double burn_ignition_s = 0.0;  ///< of the motor that burns
  std::size_t earlier = 0;       ///< which of the earlier burns it is
  double expelled_kg = 0.0;      ///< by the reaction control, while an earlier burn
  GuidedStage below;             ///< as estimated, while it burns, or the earlier one that burns
  GuidedStage last;  ///< nominal until it burns, then as estimated, minus the propellant expelled by the
                     ///< reaction control. While the same engine burns before: its masses do not count
  /// Small rotation from where thrust shall point to where it does, as measured.
  Vector3 thrust_offset_rad_I = Vector3::Zero();
  /// The present command of a burning motor's attitude, which approaches the plan's at a limited rate.
  std::optional<Direction> commanded;
};

struct Injection {
  Arrival at;
  double time_s = 0.0;
  double radius_m = 0.0;  ///< from the Earth's centre
  double dive_m = 0.0;    ///< how far the way there has fallen below GuidanceMission::air_below_m
  Vector3 p_EoC_I = Vector3::Zero(), v_IC_I = Vector3::Zero();
  /// Of the first burn, where it ends: inertial speed and time.
  double burn_end_speed_m_s = 0.0, burn_end_s = 0.0;
};

/// Largest steps of the classical Runge-Kutta method. Steps end at a thrust's kinks.
struct PredictorSteps {
  double burn_s = 2.5;
  double coast_s = 40.0;
  double engine_s = 6.0;  ///< in an engine's burn
};

/// A predicted way up to the last burn. Plans that differ in their last burn alone share it, and plans that
/// also differ in its ignition share the burns before it.
struct WayToLastBurn {
  Plan plan;
  NavigatedState after_burns, at_ignition;
  std::optional<GuidedStage> restarted;               ///< the last burn's stage, if an engine burns again
  double burn_end_speed_m_s = 0.0, burn_end_s = 0.0;  ///< Injection's
};

Injection Predict(const GuidanceMission& mission, const PlanPrior& prior, const Knowledge& known,
                  const NavigatedState& from, const Plan& plan, const PredictorSteps& steps = {});
/// The same. `known_way`: one of the same knowledge, state and steps, or null; what it shares with the plan
/// is not predicted again, with the same bits. `way`: where to put the plan's, or null.
Injection Predict(const GuidanceMission& mission, const PlanPrior& prior, const Knowledge& known,
                  const NavigatedState& from, const Plan& plan, const PredictorSteps& steps,
                  const WayToLastBurn* known_way, WayToLastBurn* way);

/// Of a state: how it would be judged as an injection.
Arrival ArrivalOf(const Earth& earth, double time_s, const Vector3& p_EoC_I, const Vector3& v_IC_I);

}  // namespace dispersa
