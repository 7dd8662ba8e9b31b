// The first stack of a vehicle that bends, burning in space, where neither air nor gravity bends anything.
#pragma once

#include <array>

#include "core/dynamics/launcher.h"
#include "core/flight/flight_model.h"
#include "core/modes/mode_table.h"

namespace dispersa {

struct BendingInSpace {
  BendingInSpace(const Vehicle& v, double since_ignition_s)
      : vehicle(v), plant(BuildNominalPlant(v)), time_s(since_ignition_s) {
    AddBending(v, 0.01, plant);
    plant.jet_damping = false;
    phase.burning = true;
    RigidBodyState s;
    s.p_EoC_I = Vector3(plant.environment.earth.equatorial_radius_m + 2e6, 0.0, 0.0);
    WriteState(s, y.data());
  }
  std::array<double, kLauncherSize> Rates() const {
    std::array<double, kLauncherSize> dydt{};
    LauncherModel(plant).Derivative(phase, time_s, y.data(), dydt.data());
    return dydt;
  }
  double propellant_kg() const { return plant.stacks[0].burn.Propellant(time_s); }
  const ModeTable& table() const { return *plant.stacks[0].bending; }
  double At(int mode, int column) const { return table().At(0, mode, column, propellant_kg()); }

  Vehicle vehicle;
  LauncherPlant plant;
  LauncherPhase phase;
  double time_s;
  std::array<double, kLauncherSize> y{};
};

}  // namespace dispersa
