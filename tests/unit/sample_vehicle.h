// A made-up two-stage launcher with round numbers. Its masses, burns and effectiveness are known by hand.
#pragma once

#include <cmath>

#include "core/control/autopilot_config.h"
#include "core/flight/flight_model.h"
#include "core/math/constants.h"
#include "core/vehicle/vehicle.h"

namespace dispersa {

/// Coefficients that do not depend on Mach number; CN grows linearly with incidence.
inline AeroTable SampleTable() {
  AeroTable table;
  table.reference_area_m2 = 1.0;
  table.reference_length_m = 1.0;
  table.mach = {0.0, 10.0};
  table.incidence_rad = {0.0, 1.0};
  table.ca = {0.3, 0.3, 0.3, 0.3};
  table.cn = {0.0, 3.0, 0.0, 3.0};
  table.xcp_station_m = {4.0, 4.0, 4.0, 4.0};
  table.cmq_per_rad = {0.0, 0.0};
  table.clp_per_rad = {0.0, 0.0};
  return table;
}

/// Stage 1: 6 t dry and propellant 4 t in 40 s; stage 2: 3 t with 1 t in 20 s, after a coast to a timer.
inline Vehicle SampleVehicle() {
  Vehicle vehicle;
  vehicle.name = "sample";
  vehicle.jet_damping = false;
  Stage first;
  first.name = "first";
  first.liftoff_mass_kg = 13000.0;
  first.propellant_mass_kg = 4000.0;
  first.diameter_m = 1.2;
  first.bottom_station_m = 20.0;
  first.motor = {.thrust_n = 200e3, .burning_time_s = 40.0, .thrust_curve = {}};
  first.grain = {12.0, 18.0, 1.2, 0.4};
  first.structure = {{"case", 0.75, 11.0, 19.0, 1.2, 1.1}, {"nozzle", 0.25, 19.0, 20.0, 0.8, 0.0}};
  first.gimbal = {.pivot_station_m = 19.5,
                  .radius_m = 0.4,
                  .limit_rad = 6.0 * kRadPerDeg,
                  .rate_limit_rad_s = 30.0 * kRadPerDeg,
                  .bandwidth_rad_s = 25.0};
  first.separation_delay_s = 0.5;
  Stage second = first;
  second.name = "second";
  second.liftoff_mass_kg = 3000.0;
  second.propellant_mass_kg = 1000.0;
  second.diameter_m = 1.0;
  second.bottom_station_m = 11.0;
  second.motor = {.thrust_n = 50e3, .burning_time_s = 20.0, .thrust_curve = {}};
  second.grain = {6.0, 9.0, 0.9, 0.3};
  second.structure = {{"all", 1.0, 1.0, 10.5, 1.0, 0.9}};
  second.gimbal.pivot_station_m = 10.0;
  second.gimbal.radius_m = 0.3;
  second.ignition = IgnitionTrigger::kTimer;
  vehicle.stages = {first, second};
  vehicle.aerodynamics = {SampleTable(), SampleTable()};
  vehicle.reaction_control = {10.0, 1.0, 0.4, 70.0, 0.05};
  return vehicle;
}

inline AxisConfig SampleAxis(ControlLaw law) {
  AxisConfig axis;
  axis.law = law;
  axis.gains = {{16.0, 7.0}, {25.0, 9.0}};
  axis.rules = {5.0 * kRadPerDeg, 1.5 * kRadPerDeg};
  axis.adaptation.gamma = {500.0, 1000.0};
  axis.adaptation.q << 1.0, 0.0, 0.0, 0.02;
  axis.integral.ki_1_s3 = {8.0, 12.0};
  return axis;
}

inline AutopilotConfig SampleAutopilot() {
  AutopilotConfig autopilot;
  autopilot.name = "sample";
  autopilot.pitch = SampleAxis(ControlLaw::kAdaptiveFuzzy);
  autopilot.yaw = SampleAxis(ControlLaw::kPd);
  autopilot.roll = SampleAxis(ControlLaw::kPd);
  autopilot.reaction_control = {.deadband_rad = 0.1 * kRadPerDeg, .rate_gain_s = 0.5, .hysteresis = 0.5};
  return autopilot;
}

/// Straight up, from the equator.
inline FlightDefinition SampleDefinition() {
  FlightDefinition definition;
  definition.vehicle = SampleVehicle();
  definition.autopilot = SampleAutopilot();
  definition.program.launch_azimuth_rad = 0.5 * kPi;
  definition.program.knots = {{.time_s = 0.0, .pitch = 0.5 * kPi}, {.time_s = 200.0, .pitch = 0.5 * kPi}};
  definition.last_ignition_s = 60.0;
  return definition;
}

/// Launched from where there is next to no air.
inline FlightDefinition HighDefinition() {
  FlightDefinition definition = SampleDefinition();
  definition.vehicle.site.altitude_m = 300e3;
  return definition;
}

}  // namespace dispersa
