// A guidance mission like that of the shipped launcher, with round numbers, and what guidance knows in a
// burn.
#pragma once

#include "core/guidance/predictor.h"
#include "core/math/constants.h"

namespace dispersa {

/// Last stage of 910 kg with 2.3 km/s; the launch site on the equator, L's x 60 degrees north of east.
inline GuidanceMission PlainMission() {
  GuidanceMission mission;
  const double east = 0.5, north = 0.8660254037844386;
  mission.R_IL.col(0) = Vector3(0.0, east, north);
  mission.R_IL.col(1) = Vector3(0.0, north, -east);
  mission.R_IL.col(2) = Vector3(-1.0, 0.0, 0.0);
  const auto stage = [](double thrust_n, double burn_s, double propellant_kg, double mass_kg) {
    GuidedStage s;
    s.burn.vacuum_thrust_n = thrust_n;
    s.burn.full_flow_kg_s = propellant_kg / burn_s;
    s.burn.propellant_mass_kg = propellant_kg;
    s.burn.duration_s = burn_s;
    s.ignition_mass_kg = mass_kg;
    return s;
  };
  mission.below = stage(94e3, 46.9, 1720.0, 2870.0);
  mission.last = stage(30e3, 46.9, 540.0, 910.0);
  mission.last_ignition_s = 330.0;
  mission.velocity_reserve_m_s = 60.0;
  mission.program.step_s = 10.0;
  // From the launch site's horizon the local one falls by an orbit's turn, 0.065 deg/s.
  for (int i = 0; i < 60; ++i) mission.program.at.push_back({-0.065 * kRadPerDeg * 10.0 * i, 0.0});
  return mission;
}

/// What guidance knows during the last burn, from its ignition and the mass expelled since.
inline Knowledge KnowledgeInLastBurn(const GuidanceMission& mission, double ignition_s, double expelled_kg) {
  Knowledge known;
  known.phase = GuidancePhase::kLastBurns;
  known.burn_ignition_s = ignition_s;
  known.last = mission.last;
  known.last.ignition_mass_kg -= expelled_kg;
  return known;
}

/// In the coast, 300 s before the last ignition.
inline NavigatedState CoastState() {
  const Matrix3 R_IL = PlainMission().R_IL;
  return {30.0, R_IL * Vector3(1.0e6, 0.0, -6.61e6), R_IL * Vector3(4.92e3, 0.0, -0.55e3)};
}

/// The same with what its nominal plan reaches from there as its target.
inline GuidanceMission ReachableMission() {
  GuidanceMission mission = PlainMission();
  const PlanPrior prior = BuildPrior(mission);
  Knowledge known;
  known.last = mission.last;
  mission.target = Predict(mission, prior, known, CoastState(), prior.nominal).at;
  return mission;
}

}  // namespace dispersa
