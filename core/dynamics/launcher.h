// The launch vehicle as a dynamic system between two events of a flight.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "core/dynamics/aerodynamics.h"
#include "core/dynamics/rigid_body.h"
#include "core/modes/flown_modes.h"
#include "core/vehicle/mass.h"
#include "core/vehicle/nozzle_layout.h"
#include "core/vehicle/propulsion.h"

namespace dispersa {

/// Names of the cross's nozzles. The first nozzles of a list take the same places in their order.
inline constexpr const char* kNozzleNames[kNozzles] = {"right", "left", "bottom", "top"};
/// State: rigid body, then the angle and the rate of each nozzle (right, left, bottom, top), about its first
/// hinge.
inline constexpr int kNozzleAngle = kRigidBodySize;
inline constexpr int kNozzleRate = kNozzleAngle + kNozzles;
inline constexpr int kRigidLauncherSize = kNozzleRate + kNozzles;
/// Then, if the vehicle bends, the modal coordinates by plane and mode, and their rates.
inline constexpr int kModalState = kRigidLauncherSize;
inline constexpr int kModalRate = kModalState + kPlanes * kModes;
inline constexpr int kBentLauncherSize = kModalRate + kPlanes * kModes;
/// Then, if the vehicle has a list of nozzles, the angles and rates about the second hinges.
inline constexpr int kSecondAngle = kBentLauncherSize;
inline constexpr int kSecondRate = kSecondAngle + kNozzles;
inline constexpr int kListedLauncherSize = kSecondRate + kNozzles;
/// Then, bank by bank of further nozzles, the angles and then the rates of the bank's drives.
inline constexpr int kLauncherSize = kListedLauncherSize + (kBanks - 1) * 2 * kDrives;
/// Place of a drive in the state (nozzle_layout.h).
constexpr int AngleOf(int drive) {
  if (drive >= kDrives) return kListedLauncherSize + (drive / kDrives - 1) * 2 * kDrives + drive % kDrives;
  return drive < kNozzles ? kNozzleAngle + drive : kSecondAngle + drive - kNozzles;
}
constexpr int RateOf(int drive) {
  if (drive >= kDrives) return AngleOf(drive) + kDrives;
  return drive < kNozzles ? kNozzleRate + drive : kSecondRate + drive - kNozzles;
}

struct AeroGrid;

/// Differences of one nozzle from the nominal one.
struct NozzleDeparture {
  Matrix3 tilt = Matrix3::Identity();  ///< turns its thrust
  double thrust_factor = 1.0;          ///< of its share
  double offset_y_m = 0.0, offset_z_m = 0.0;
};

/// The aerodynamics of a stack in another state: without bodies that have left, or with the motor out.
struct AeroVariant {
  unsigned without = 0;  ///< bits of LauncherPhase::jettisoned
  bool power_off = false;
  BodyAerodynamics body;  ///< its factors do not count: those of the stack hold
  std::shared_ptr<const AeroGrid> grid;
};

/// One stack as one flight flies it: nominal data with the flight's factors applied.
struct LauncherStack {
  StackMass mass;
  std::shared_ptr<const MassRows> mass_rows;  ///< to which `mass` points (null: to none)
  BodyAerodynamics aerodynamics;
  std::shared_ptr<const AeroGrid>
      aero_grid;  ///< grid of the aerodynamics without factors, made if it is missing
  std::shared_ptr<const std::vector<AeroVariant>> aero_variants;  ///< null: it has none
  MotorBurn burn;
  Gimbal gimbal;
  NozzleLayout layout;
  Matrix3 thrust_tilt = Matrix3::Identity();  ///< turns the nozzles' thrust by the misalignment
  double thrust_offset_y_m = 0.0;
  double thrust_offset_z_m = 0.0;
  std::array<NozzleDeparture, kMostNozzles> nozzles;
  /// Mass times lateral offset of everything but the burning propellant, whose own centre is on the axis.
  double lateral_moment_y_kg_m = 0.0;
  double lateral_moment_z_kg_m = 0.0;
  // In addition to the plant's factors.
  double cg_factor = 1.0;
  double inertia_factor = 1.0;
  /// Integrals of x y, x z and y z over the mass about C in body axes. They are constant over the burn, since
  /// propellant lies about the axis. The inertia's off-diagonal elements are their negatives.
  double product_xy_kg_m2 = 0.0, product_xz_kg_m2 = 0.0, product_yz_kg_m2 = 0.0;
  std::shared_ptr<const LoadTable> loads;
  std::shared_ptr<const FlownModes> modes;   ///< null: it is rigid
  std::shared_ptr<const ModeTable> bending;  ///< of them with all it carries at lift-off

  /// The variant that fits best after these bodies have left (bits of LauncherPhase::jettisoned): the one
  /// without the most of them and with none that is still there. Null: that of `aerodynamics`.
  const AeroVariant* AeroAfter(unsigned jettisoned, bool burning) const;
  /// Without what has been jettisoned (bits of LauncherPhase::jettisoned). Null: it is rigid.
  const ModeTable* BendingWithout(unsigned jettisoned) const {
    return jettisoned == 0 || !modes ? bending.get() : modes->Without(jettisoned).get();
  }
};

/// A booster, a body of its own.
struct EachBooster {
  MotorBurn burn;
  double dry_kg = 0.0;
  DrainingMass tanks;  ///< of liquid propellant, by its mass
  double y_m = 0.0, z_m = 0.0;
  /// Its thrust undeflected, canted and misaligned; and where each hinge turns it.
  Vector3 along = Vector3::UnitX(), first = Vector3::Zero(), second = Vector3::Zero();
};
inline constexpr unsigned kAllBoosters = (1u << kMaxBoosters) - 1u;
/// The boosters of the first stage.
struct BoosterSet {
  MotorBurn burn;  ///< of all together
  BoosterPropellant propellant;
  JettisonedMass empty;  ///< of all together
  double nozzle_station_m = 0.0;
  double attachment_station_m = 0.0;  ///< of the stage, which carries them there
  double radius_m = 0.0;
  double separation_delay_s = 0.0;
  std::vector<EachBooster> each = {};
  Gimbal gimbal = {};        ///< of each (a limit of 0: their nozzles are fixed)
  NozzleLayout layout = {};  ///< of the stage's nozzles and theirs, while any of them burns
};
/// A vehicle of one flight.
struct LauncherPlant {
  Environment environment;
  std::vector<LauncherStack> stacks;
  std::vector<Jettison> jettisons;  ///< of all stages
  std::vector<JettisonedMass> jettisoned_masses;
  std::shared_ptr<const BoosterSet> boosters;  ///< null: none
  double cg_factor = 1.0;
  double inertia_factor = 1.0;
  bool jet_damping = true;
  bool flow_coriolis = true;
  BendingFactors bending;

  // The largest over all stacks, so that the computation does not depend on the flight's progress.
  int bending_modes() const;   ///< in one plane (0: the vehicle is rigid)
  int bending_planes() const;  ///< that differ
  bool nozzles_have_mass() const;
  bool nozzles_are_listed()
      const;  ///< Whether any stage has a list of nozzles. Then a cross is treated as a list too.
  int nozzle_banks() const;  ///< 1 unless a stage has more than four nozzles, or boosters that turn theirs
  bool has_side_masses() const;  ///< tables of stages with masses off the axis
  bool boosters_steer() const;   ///< with nozzles that turn
  /// Of a stack's nozzles, while its boosters burn or not.
  const NozzleLayout& LayoutOf(int stack, bool boosting) const;
  /// Doubles of a state that count: a rigid vehicle's state ends with its nozzles.
  int state_size() const {
    if (nozzles_are_listed()) return kListedLauncherSize + (nozzle_banks() - 1) * 2 * kDrives;
    return bending_modes() > 0 ? kBentLauncherSize : kRigidLauncherSize;
  }
};

/// Values that stay constant between two events.
struct LauncherPhase {
  int stack = 0;
  unsigned jettisoned = 0;  ///< bit i: of the plant's jettisons
  bool burning = false;
  bool burnt = false;             ///< the stack's propellant is used up
  unsigned boosters_burning = 0;  ///< bit i: of the boosters
  bool boosting() const { return boosters_burning != 0; }
  double ignition_s = 0.0;                        ///< of the stack's motor, when burning
  double expelled_mass_kg = 0.0;                  ///< by the reaction control so far
  Vector3 control_torque_n_m = Vector3::Zero();   ///< of the reaction control
  std::array<double, kMostDrives> command_rad{};  ///< to the actuators
  int stuck_nozzle = -1;                          ///< index of a nozzle that does not move, or -1
  std::array<double, kMostDrives>
      slides{};  ///< sense in which friction's drives slide, 0: held (actuators.h)
};

/// Everything of one instant that forces, metrics and histories need.
struct LauncherInstant {
  AirData air;
  Vector3 v_AB_B = Vector3::Zero();  ///< velocity through the air
  BodyLoads loads;
  double cg_station_m = 0.0;
  double thrust_n = 0.0;
  double flow_kg_s = 0.0;
};

/// `state` after the burnt lowest stage of stack `below` has left: it follows the centre of gravity, which
/// jumps forward to that of the stack above, full. `jettisoned`: as in LauncherPhase; `left_kg`: propellant
/// that the burnt stage leaves with, unless the plant's burn says so.
RigidBodyState AfterSeparation(const LauncherPlant& plant, int below, unsigned jettisoned,
                               const RigidBodyState& state, std::optional<double> left_kg = {});

/// The equations of motion of one flight, prepared once for many instants: one lane of launcher_body.h and
/// actuators.h, whose step flights take. For the judges among the integrators, histories, linearisation and
/// tests.
class LauncherModel {
 public:
  explicit LauncherModel(const LauncherPlant& plant);
  ~LauncherModel();
  LauncherModel(const LauncherModel&) = delete;
  LauncherModel& operator=(const LauncherModel&) = delete;

  const LauncherPlant& plant() const;

  LauncherInstant Evaluate(const LauncherPhase& phase, double time_s, const double* y) const;

  /// Right-hand side of the flight. Each nozzle of a cross carries a quarter of the thrust and deflects it in
  /// its hinge plane. Each nozzle of a list carries its share and deflects it about its hinges. Positive
  /// pitch, yaw and roll deflections give positive moments about body y, z and x. Actuators are second order
  /// with a limited rate: d(angle)/dt = rate within the limit. The command's angle is limited.
  void Derivative(const LauncherPhase& phase, double time_s, const double* y, double* dydt) const;

 private:
  struct Prepared;
  std::unique_ptr<const Prepared> prepared_;
};

}  // namespace dispersa
