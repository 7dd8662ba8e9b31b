#include "core/dynamics/jettison.h"

#include <algorithm>

#include "core/math/functions.h"
#include "core/vehicle/burning_stack.h"
#include "core/vehicle/heat_flux.h"

namespace dispersa {

namespace {

// A stack with its masses, and the sum of its masses times their places across the axis.
struct Balance {
  const LauncherStack& stack;
  MassProperties mass;
  Vector3 lateral_kg_m;
};

// From the centre of gravity of one stack to that of another, in the body.
Vector3 CgStep(const LauncherPlant& plant, const Balance& from, const Balance& to) {
  const double ahead_m =
      from.mass.cg_station_m * from.stack.cg_factor - to.mass.cg_station_m * to.stack.cg_factor;
  const Vector3 aside = to.lateral_kg_m / to.mass.mass_kg - from.lateral_kg_m / from.mass.mass_kg;
  return Vector3(ahead_m * plant.cg_factor, aside.y(), aside.z());
}

// Sums of mass times place across the axis of boosters that leave: their shells, which are bodies of their
// own, with what their tanks have left. All have burnt out.
Vector3 LateralOf(const LauncherPlant& plant, int stack, unsigned leaving) {
  Vector3 sum = Vector3::Zero();
  if (stack > 0 || (leaving & kBoostersGone) == 0 || !plant.boosters) return sum;
  for (const EachBooster& one : plant.boosters->each)
    sum += (one.dry_kg + one.burn.left_kg) * Vector3(0.0, one.y_m, one.z_m);
  return sum;
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
  lanes::BurningStack<double> own;
  lanes::SetStack(own, 0, mass);
  MassProperties m = lanes::MassesAt(own, propellant_kg);
  const BoosterSet& set = *plant.boosters;
  lanes::BesideStage<double> beside;
  if (set.propellant.drains) {
    // Each with its own burn and tanks: they keep different masses.
    BoosterPropellant of_one = set.propellant;
    for (const EachBooster& one : set.each) {
      of_one.tanks = one.tanks;
      lanes::SetBeside(beside, 0, one.burn, of_one);
      lanes::AddBeside(beside, one.burn.Propellant(since_ignition_s), 0.0, 0.0, m);
    }
  } else {
    lanes::SetBeside(beside, 0, set.burn, set.propellant);
    lanes::AddBeside(beside, set.burn.Propellant(since_ignition_s), 0.0, 0.0, m);
  }
  return m;
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
        return sight.altitude_m >= kFreeMolecularAltitude_m &&
               HeatFlux(sight.density_kg_m3, sight.ground_speed_m_s) <= jettison.threshold;
    }
    return false;
  };
  unsigned due = 0;
  for (std::size_t i = 0; i < plant.jettisons.size(); ++i)
    if (!(jettisoned >> i & 1u) && plant.jettisoned_masses[i].stage >= stack && is_due(plant.jettisons[i]))
      due |= 1u << i;
  return due;
}

Vector3 LateralMoment(const LauncherStack& stack, double propellant_kg) {
  const SideSums sides = stack.mass.SidesAt(propellant_kg);
  return Vector3(0.0, stack.lateral_moment_y_kg_m + sides[kSideY],
                 stack.lateral_moment_z_kg_m + sides[kSideZ]);
}

RigidBodyState AfterJettison(const LauncherPlant& plant, int stack, unsigned before, unsigned after,
                             double propellant_kg, double since_ignition_s, const RigidBodyState& state) {
  // Lateral moments stay with what is left, whose mass has changed.
  const LauncherStack& same = StackOf(plant, stack);
  const Vector3 lateral_kg_m = LateralMoment(same, propellant_kg);
  const Balance whole{same, MassesOn(plant, stack, before, propellant_kg, since_ignition_s),
                      lateral_kg_m + LateralOf(plant, stack, after & ~before)};
  const Balance left{same, MassesOn(plant, stack, after, propellant_kg, since_ignition_s), lateral_kg_m};
  return AtPoint(state, CgStep(plant, whole, left));
}

RigidBodyState AfterSeparation(const LauncherPlant& plant, int below, unsigned jettisoned,
                               const RigidBodyState& state, std::optional<double> left_kg) {
  const auto balance = [&](int index, double propellant_kg) {
    const LauncherStack& stack = StackOf(plant, index);
    return Balance{stack, MassOf(plant, index, jettisoned).At(propellant_kg),
                   LateralMoment(stack, propellant_kg)};
  };
  return AtPoint(state, CgStep(plant, balance(below, left_kg.value_or(StackOf(plant, below).burn.left_kg)),
                               balance(below + 1, StackOf(plant, below + 1).burn.propellant_mass_kg)));
}

namespace {

// How bending moves and turns what is left, in the body: by the coordinates and by the rates of the modes.
class MeanMotion {
 public:
  void Add(int plane, double shift, double turn_1_m, double q_m, double q_m_s) {
    // Plane y moves along y and turns about -z, plane z along z and about y.
    const int along = plane == 0 ? 1 : 2, about = plane == 0 ? 2 : 1;
    const double turn = plane == 0 ? -turn_1_m : turn_1_m;
    moved_[along] += shift * q_m;
    speed_[along] += shift * q_m_s;
    turned_[about] += turn * q_m;
    rate_[about] += turn * q_m_s;
  }
  void Give(RigidBodyState& body) const {
    body.p_EoC_I += Rotate(body.q_IB, moved_);
    body.v_IC_I += Rotate(body.q_IB, speed_);
    body.q_IB = Normalized(body.q_IB * FromRotationVector(turned_));
    body.w_IB_B += rate_;
  }

 private:
  Vector3 moved_ = Vector3::Zero(), speed_ = Vector3::Zero(), turned_ = Vector3::Zero(),
          rate_ = Vector3::Zero();
};

}  // namespace

void TakeAlong(const LauncherStack& below, unsigned jettisoned, const double* modal, RigidBodyState& above) {
  const ModeTable* const table = below.BendingWithout(jettisoned);
  if (table == nullptr) return;
  MeanMotion mean;
  for (int plane = 0; plane < kPlanes; ++plane)
    for (int mode = 0; mode < table->modes; ++mode) {
      const auto at = [&](int column) {
        return table->At(table->planes == 1 ? 0 : plane, mode, column, below.burn.left_kg);
      };
      mean.Add(plane, at(ModeTable::kUpperShift), at(ModeTable::kUpperTurn), modal[plane * kModes + mode],
               modal[(kPlanes + plane) * kModes + mode]);
    }
  mean.Give(above);
}

void LetGoBent(const LauncherStack& stack, unsigned before, unsigned after, double propellant_kg,
               double* modal, RigidBodyState& left) {
  if (!stack.modes || stack.bending->modes == 0) return;
  const ModalPassage passage = stack.modes->Passage(before, after, propellant_kg);
  const int modes = stack.bending->modes;
  MeanMotion mean;
  double flown[2 * kPlanes * kModes];
  std::copy(modal, modal + 2 * kPlanes * kModes, flown);
  for (int plane = 0; plane < kPlanes; ++plane) {
    const std::size_t p = static_cast<std::size_t>(plane);
    for (int mode = 0; mode < modes; ++mode) {
      const std::size_t k = static_cast<std::size_t>(mode);
      const double* const coordinates = flown + plane * kModes;
      const double* const rates = coordinates + kPlanes * kModes;
      mean.Add(plane, passage.shift[p][k], passage.turn_1_m[p][k], coordinates[mode], rates[mode]);
      double q_m = 0.0, q_m_s = 0.0;
      for (int old = 0; old < modes; ++old) {
        q_m += passage.onto[p][k][static_cast<std::size_t>(old)] * coordinates[old];
        q_m_s += passage.onto[p][k][static_cast<std::size_t>(old)] * rates[old];
      }
      modal[plane * kModes + mode] = q_m;
      modal[(kPlanes + plane) * kModes + mode] = q_m_s;
    }
  }
  mean.Give(left);
}

}  // namespace dispersa
