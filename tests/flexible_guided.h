// SLV-4 with different bending in its two planes, closed-loop guidance, and blended rate gyros in two stages.
#pragma once

#include "core/campaign_yaml/load.h"
#include "tests/slv4_flight.h"

namespace dispersa {

/// Gyros do not round: a flight by another integrator would be one of other roundings.
inline FlightDefinition FlexibleGuidedDefinition() {
  FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS, "flexible", "slv4_500km_reserve");
  definition.vehicle = LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4_flexible.yaml");
  definition.guidance.closed_loop = true;
  StructureBeam& beam = *definition.vehicle.structure_beam;
  // Coarse: a flight whose masses are dispersed has modes of its own, which take ten times as long as flying
  // them.
  beam.elements = 12;
  beam.propellant_levels = 5;
  beam.modes = beam.flown_modes = 2;
  // Stiffer in plane z, as a cable duct makes it.
  for (BeamStage& stage : beam.stages)
    for (BeamSection& section : stage.sections) section.z_to_y_stiffness = 1.1;
  for (RateGyro& gyro : definition.vehicle.sensors.rate_gyros) gyro.quantum_rad_s = 0.0;
  return definition;
}

/// Wind and a gust from aside, misalignments, lighter masses above, and modes that are not the nominal ones.
inline FlightInputs FlexibleGuidedInputs() {
  FlightInputs inputs = Table3Inputs();
  inputs.air.gust_speed_m_s = 9.0;
  inputs.air.gust_altitude_m = 9000.0;
  inputs.air.gust_length_m = 400.0;
  inputs.air.gust_azimuth_rad = 40.0 * kRadPerDeg;
  inputs.stages[1].dry_mass_factor = 0.99;
  inputs.bending_frequency_factor[0] = 0.97;
  inputs.bending_slope_factor = 1.05;
  return inputs;
}

}  // namespace dispersa
