// A burn of the first stack alone in empty space, with the engine's own step.
#pragma once

#include "core/flight/flight_model.h"
#include "core/flight/simpson_step.h"
#include "tests/test.h"

namespace dispersa {

/// To be built once for all burns of a vehicle: its aerodynamics take longer than a burn.
inline LauncherPlant PlantInEmptySpace(const Vehicle& vehicle) {
  LauncherPlant plant = BuildNominalPlant(vehicle);
  plant.environment.earth = SphericalEarth(6371000.0, false);
  plant.environment.earth.mu_m3_s2 = 0.0;
  return plant;
}

/// Velocity gained from rest along the axis by the burn of `stage`, which is the first of the plant's
/// vehicle, m/s, in steps of `step_s`. Steps also end on the corners of the burn if `stops_at_corners`.
inline double SpeedGained(LauncherPlant plant, const Stage& stage, double thrust_factor, double flow_factor,
                          double step_s, bool stops_at_corners = true) {
  plant.stacks[0].burn = BuildBurn(stage, thrust_factor, flow_factor);
  const MotorBurn& burn = plant.stacks[0].burn;
  std::vector<double> stops_s;
  if (stops_at_corners) stops_s = burn.Kinks(0.0);
  for (int i = 1; i * step_s < burn.duration_s; ++i) stops_s.push_back(i * step_s);
  stops_s.push_back(burn.duration_s);
  std::sort(stops_s.begin(), stops_s.end());

  const FlightWeather calm;
  auto step = std::make_unique<lanes::StepState<double>>();
  step->Configure(plant, step_s);
  double y[kLauncherSize] = {};
  RigidBodyState state;
  state.p_EoC_I = Vector3(6371000.0 + 2000e3, 0.0, 0.0);  // above the atmosphere
  WriteState(state, y);
  step->StartFlight(0, calm, y);
  step->SetStack(0, plant, 0);
  step->Ignite(0, 0.0, false);
  double from_s = 0.0;
  for (const double to_s : stops_s) {
    if (!(to_s > from_s)) continue;
    step->PassKink(0);
    step->EvaluateStart(from_s);
    EXPECT_TRUE(step->Step(true, true, from_s, to_s));
    from_s = to_s;
  }
  step->ReadLane(0, y);
  return ReadState(y).v_IC_I.norm();
}

}  // namespace dispersa
