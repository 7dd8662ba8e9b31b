// The shipped vehicle on its shipped reference, for tests that fly it.
#pragma once

#include <string>

#include "core/campaign_yaml/load.h"
#include "core/flight/flight.h"
#include "core/math/constants.h"

namespace dispersa {

/// `campaigns` is the folder of the shipped campaigns.
inline FlightDefinition Slv4Definition(const std::string& campaigns,
                                       const std::string& autopilot = "adaptive_fuzzy",
                                       const std::string& reference_name = "slv4_500km") {
  const Reference reference = LoadReference(campaigns + "/references/" + reference_name + ".yaml");
  FlightDefinition definition;
  definition.vehicle = LoadVehicle(campaigns + "/vehicles/slv4.yaml");
  definition.autopilot = LoadAutopilot(campaigns + "/autopilots/" + autopilot + ".yaml");
  definition.program = reference.attitude;
  definition.last_ignition_s = reference.last_ignition_s;
  definition.kick_start_s = reference.program.t1_s;
  definition.kick_end_s = reference.program.t2_s;
  definition.target = {reference.problem.target_altitude_m, reference.problem.target_velocity_m_s,
                       reference.problem.target_flight_path_angle_rad, reference.orbit.inclination_rad};
  definition.velocity_reserve_m_s = reference.problem.velocity_reserve_m_s;
  return definition;
}

/// Everything of the paper's Table 3 at once, each at its full size.
inline FlightInputs Table3Inputs() {
  FlightInputs inputs;
  for (StageInputs& stage : inputs.stages) stage.thrust.misalignment_rad.magnitude = 0.25 * kRadPerDeg;
  const double clock_rad[] = {0.5, 2.1, 3.7, 5.3};
  for (std::size_t i = 0; i < 4; ++i) inputs.stages[i].thrust.misalignment_rad.clock_rad = clock_rad[i];
  inputs.air.wind_max_speed_m_s = 60.96;
  inputs.air.wind_azimuth_rad = 280.0 * kRadPerDeg;
  inputs.drag_factor = 1.067;
  for (std::size_t stage = 0; stage < 4; ++stage)
    inputs.stages[stage].thrust_factor = stage % 2 == 0 ? 1.02 : 0.98;
  return inputs;
}

/// A metric by its name.
inline double MetricOf(const FlightResult& flight, const std::string& name) {
  for (std::size_t i = 0; i < flight.metrics.size(); ++i)
    if (MetricNames()[i] == name) return flight.metrics[i];
  throw std::out_of_range("no metric " + name);
}

}  // namespace dispersa
