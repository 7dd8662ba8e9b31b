#include "core/dynamics/jettison.h"

#include "core/math/functions.h"
#include "core/vehicle/burning_stack.h"

namespace dispersa {

namespace {

// From the centre of gravity of one stack to that of another, in the body: lateral moments stay with what is
// left, whose mass has changed.
Vector3 CgStep(const LauncherPlant& plant, const LauncherStack& from_stack, const MassProperties& from,
               const LauncherStack& to_stack, const MassProperties& to) {
  const auto aside = [&](double LauncherStack::*moment) {
    return to_stack.*moment / to.mass_kg - from_stack.*moment / from.mass_kg;
  };
  const double ahead_m = from.cg_station_m * from_stack.cg_factor - to.cg_station_m * to_stack.cg_factor;
  return Vector3(ahead_m * plant.cg_factor, aside(&LauncherStack::lateral_moment_y_kg_m),
                 aside(&LauncherStack::lateral_moment_z_kg_m));
}

const LauncherStack& StackOf(const LauncherPlant& plant, int stack) {
  return plant.stacks[static_cast<std::size_t>(stack)];
}

}  // namespace

StackMass MassOf(const LauncherPlant& plant, int stack, unsigned jettisoned) {
  const StackMass& whole = StackOf(plant, stack).mass;
  if (jettisoned == 0) return whole;
  StackMass left = Without(whole, stack, plant.jettisoned_masses, jettisoned);
  if (stack == 0 && (jettisoned & kBoostersGone) != 0) left = Without(left, 0, {plant.boosters->empty}, 1u);
  return left;
}

MassProperties MassesOn(const LauncherPlant& plant, int stack, unsigned jettisoned, double propellant_kg,
                        double since_ignition_s) {
  const StackMass mass = MassOf(plant, stack, jettisoned);
  if (stack > 0 || !plant.boosters || (jettisoned & kBoostersGone) != 0) return mass.At(propellant_kg);
  lanes::StackMassLanes<double> own;
  lanes::SetLane(own, 0, mass);
  lanes::MassPropertiesLanes<double> m = lanes::MassesAt(own, propellant_kg);
  lanes::BesideStage<double> beside;
  lanes::SetLane(beside, 0, plant.boosters->burn, plant.boosters->grains);
  lanes::AddBeside(beside, plant.boosters->burn.Propellant(since_ignition_s), 0.0, 0.0, m);
  return {m.mass_kg,          m.cg_station_m,    m.axial_kg_m2,
          m.transverse_kg_m2, m.axial_per_kg_m2, m.transverse_per_kg_m2};
}

double HeatFlux(const JettisonSight& sight) {
  return 0.5 * sight.density_kg_m3 * sight.ground_speed_m_s * Square(sight.ground_speed_m_s);
}

unsigned DueJettisons(const LauncherPlant& plant, int stack, unsigned jettisoned,
                      const JettisonSight& sight) {
  const auto is_due = [&](const Jettison& jettison) {
    switch (jettison.trigger) {
      case JettisonTrigger::kAtTime:
        return sight.time_s >= jettison.threshold;
      case JettisonTrigger::kAtAltitude:
        return sight.altitude_m >= jettison.threshold;
      case JettisonTrigger::kAtHeatFlux:
        return sight.altitude_m >= kFreeMolecularAltitude_m && HeatFlux(sight) <= jettison.threshold;
    }
    return false;
  };
  unsigned due = 0;
  for (std::size_t i = 0; i < plant.jettisons.size(); ++i)
    if (!(jettisoned >> i & 1u) && plant.jettisoned_masses[i].stage >= stack && is_due(plant.jettisons[i]))
      due |= 1u << i;
  return due;
}

RigidBodyState AfterJettison(const LauncherPlant& plant, int stack, unsigned before, unsigned after,
                             double propellant_kg, double since_ignition_s, const RigidBodyState& state) {
  const LauncherStack& same = StackOf(plant, stack);
  const MassProperties whole = MassesOn(plant, stack, before, propellant_kg, since_ignition_s);
  return AtPoint(state, CgStep(plant, same, whole, same,
                               MassesOn(plant, stack, after, propellant_kg, since_ignition_s)));
}

RigidBodyState AfterSeparation(const LauncherPlant& plant, int below, unsigned jettisoned,
                               const RigidBodyState& state, std::optional<double> left_kg) {
  const LauncherStack &burnt = StackOf(plant, below), &above = StackOf(plant, below + 1);
  return AtPoint(
      state, CgStep(plant, burnt, MassOf(plant, below, jettisoned).At(left_kg.value_or(burnt.burn.left_kg)),
                    above, MassOf(plant, below + 1, jettisoned).At(above.burn.propellant_mass_kg)));
}

void TakeAlong(const LauncherStack& below, const double* modal, RigidBodyState& above) {
  if (!below.bending) return;
  const BendingTable& table = *below.bending;
  Vector3 moved = Vector3::Zero(), speed = Vector3::Zero(), turned = Vector3::Zero(), rate = Vector3::Zero();
  for (int plane = 0; plane < kPlanes; ++plane)
    for (int mode = 0; mode < table.modes; ++mode) {
      const auto at = [&](int column) {
        return table.At(table.planes == 1 ? 0 : plane, mode, column, below.burn.left_kg);
      };
      const double shift = at(BendingTable::kUpperShift), turn = at(BendingTable::kUpperTurn);
      const double q_m = modal[plane * kModes + mode], q_m_s = modal[(kPlanes + plane) * kModes + mode];
      // Plane y moves along y and turns about -z, plane z along z and about y.
      const int along = plane == 0 ? 1 : 2, about = plane == 0 ? 2 : 1;
      moved[along] += shift * q_m;
      speed[along] += shift * q_m_s;
      turned[about] += (plane == 0 ? -turn : turn) * q_m;
      rate[about] += (plane == 0 ? -turn : turn) * q_m_s;
    }
  above.p_EoC_I += Rotate(above.q_IB, moved);
  above.v_IC_I += Rotate(above.q_IB, speed);
  above.q_IB = Normalized(above.q_IB * FromRotationVector(turned));
  above.w_IB_B += rate;
}

}  // namespace dispersa
