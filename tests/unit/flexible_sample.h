// The made-up launcher of sample_vehicle.h with a beam.
#pragma once

#include "tests/unit/sample_vehicle.h"

namespace dispersa {

inline BeamSection SampleSection(const std::string& name, double top_m, double bottom_m,
                                 double bending_n_m2) {
  BeamSection section;
  section.name = name;
  section.top_station_m = top_m;
  section.bottom_station_m = bottom_m;
  section.bending_stiffness_n_m2 = {bending_n_m2, bending_n_m2};
  return section;
}

/// Two uniform sections; the first stage's nozzle is a body at the end of its case.
inline Vehicle FlexibleSample() {
  Vehicle vehicle = SampleVehicle();
  StructureBeam beam;
  BeamStage first, second;
  first.sections = {SampleSection("case", 10.5, 19.0, 5e8)};
  LumpedMass nozzle;
  nozzle.name = nozzle.element = "nozzle";
  nozzle.station_m = 19.0;
  first.lumped_masses = {nozzle};
  second.sections = {SampleSection("all", 1.0, 10.5, 1e8)};
  beam.stages = {first, second};
  beam.sensors = {{"gyro", 2.0}, {"aft gyro", 18.0}};
  vehicle.structure_beam = beam;
  return vehicle;
}

}  // namespace dispersa
