// Flies a scenario with the engine of the launchers: same equations, environment, aerodynamics, integrator.
#pragma once

#include <string>
#include <vector>

#include "core/dynamics/integrator.h"
#include "core/flight/digest.h"
#include "core/flight/metrics.h"
#include "core/flight/scenario.h"

namespace dispersa {

/// Everything about one instant.
struct ScenarioSample {
  double time_s = 0.0;
  std::size_t stage = 0;
  RigidBodyState state;
  AirData air;
  Vector3 v_AB_B = Vector3::Zero();  ///< velocity through the air
  ForceAndMoment aerodynamic;        ///< body axes, about the CG
  BodyLoads loads;                   ///< everything that acts
  double thrust_n = 0.0;
};

struct ScenarioFlight {
  Outcome outcome = Outcome::kCompleted;  ///< or kNumericalFailure
  double end_time_s = 0.0;
  std::string reason;
  std::vector<ScenarioSample> samples;  ///< at 0, every output step, and the end
  Digest digest;                        ///< of the samples' times and states
};

/// Flies a scenario for which Problems() is empty. An integration step ends at each event (ignition, burnout,
/// separation, row of the mass table), so no step crosses a kink in time. A separation moves the state to the
/// centre of gravity of the remaining stack. The ground does not stop the flight.
ScenarioFlight FlyScenario(const Scenario& scenario, Scheme scheme = Scheme::kRungeKutta4);

/// One value a name of KinematicColumnNames(), sample by sample.
std::vector<double> HistoryRows(const Scenario& scenario, const std::vector<ScenarioSample>& samples);

/// State at time 0, where inertial and Earth-fixed axes coincide.
RigidBodyState InitialState(const Scenario& scenario);

}  // namespace dispersa
