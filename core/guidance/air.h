// The air as guidance knows it: the standard's, or the campaign's measured one, at rest over the rotating
// Earth.
#pragma once

#include "core/guidance/predictor.h"

namespace dispersa {

/// Dynamic pressure, Pa.
double DynamicPressure(const GuidanceMission& mission, const NavigatedState& state);

/// From this dynamic pressure on (Pa) a stage that lifted off may be guided. Predictions have no air: at 1
/// kPa its force is 1 % of the thrust of a large core. Ten degrees of incidence are 0.17 kPa rad, a tenth of
/// what launchers bear.
inline constexpr double kThinAir_pa = 1e3;
/// A departure from the reference's attitude, times dynamic pressure, is at most this: thrusters of some tens
/// of newtons hold it in the coast after a burn.
inline constexpr double kMostIncidence_pa_rad = 5.0;

/// Whether the air's force on a burning stage, with a drag coefficient of 1, is more than an accelerometer's
/// reading may be wrong by (1e-4 of the thrust). Then no thrust is estimated from it: a drag that fades would
/// be taken for a flow.
bool FeelsAir(const GuidanceMission& mission, const GuidedStage& stage, const NavigatedState& state);

/// How far a flight is beyond the criterion of a body that waits: 0 or more where the body is due. In m of
/// altitude, or the logarithm of the criterion's heat flux over the flight's. Both are almost straight over a
/// few seconds.
double BeyondCriterion(const GuidanceMission& mission, const MassDrop& drop, const NavigatedState& state);

}  // namespace dispersa
