#include "core/dynamics/launcher.h"

#include <algorithm>
#include <bit>
#include <optional>

#include "core/dynamics/jettison.h"
#include "core/dynamics/launcher_lanes.h"
#include "core/math/lane_eigen.h"

namespace dispersa {

// What the lanes point to, and a lane for each stack.
struct LauncherModel::Prepared {
  explicit Prepared(const LauncherPlant& of)
      : plant(of),
        weather(PrepareWeather(plant.environment.wind, plant.environment.density, plant.environment.air,
                               plant.environment.turbulence.get())) {
    for (LauncherStack& stack : plant.stacks)
      if (!stack.aero_grid)
        stack.aero_grid = std::make_shared<const AeroGrid>(BuildAeroGrid(stack.aerodynamics));
    stacks.resize(plant.stacks.size());
    apart.resize(plant.boosters ? stacks.size() : 0);
    sides.resize(plant.has_side_masses() ? stacks.size() : 0);
    for (std::size_t i = 0; i < stacks.size(); ++i) {
      if (!apart.empty()) stacks[i].apart = &apart[i];
      if (!sides.empty()) stacks[i].sides = &sides[i];
      lanes::SetPlant(stacks[i], 0, plant, static_cast<int>(i));
      lanes::SetWeather(stacks[i].weather, 0, weather);
    }
  }

  LauncherPlant plant;
  FlightWeather weather;
  std::vector<lanes::FlyingPlant<double>> stacks;
  std::vector<lanes::ApartBoosters<double>> apart;
  std::vector<lanes::SideMasses<double>> sides;
};

const AeroVariant* LauncherStack::AeroAfter(unsigned jettisoned, bool burning) const {
  if (!aero_variants) return nullptr;
  const AeroVariant* best = nullptr;
  const auto rank = [](const AeroVariant* variant) {
    return variant == nullptr ? 0 : 2 * std::popcount(variant->without) + (variant->power_off ? 1 : 0);
  };
  for (const AeroVariant& variant : *aero_variants)
    if ((variant.without & ~jettisoned) == 0 && !(variant.power_off && burning) &&
        rank(&variant) > rank(best))
      best = &variant;
  return best;
}

namespace {

// An instant of one lane.
struct OneLane {
  OneLane(const LauncherPlant& from, const lanes::FlyingPlant<double>& stack, const LauncherPhase& now,
          double time_s, const double* y)
      : earth(from.environment.earth),
        lighter(Without(from, stack, now, apart, sides)),
        plant(lighter ? *lighter : stack),
        phase{now.burning,          now.burnt,
              now.boosting(),       now.ignition_s,
              now.expelled_mass_kg, ToLanes(now.control_torque_n_m)},
        motion{{y[0], y[1], y[2]}, {y[3], y[4], y[5]}, {y[6], y[7], y[8], y[9]}, {y[10], y[11], y[12]}},
        around(lanes::SurroundingsAt(earth, plant.weather, motion.p)),
        masses(lanes::MassesAt(plant, phase, time_s)) {
    const Gimbal& gimbal = from.stacks[static_cast<std::size_t>(now.stack)].gimbal;
    for (int bank = 0; bank < plant.banks; ++bank) {
      const bool is_boosters =
          now.stack == 0 && from.boosters_steer() && bank >= from.stacks[0].layout.banks();
      lanes::SetActuators(drives[bank], 0, is_boosters ? from.boosters->gimbal : gimbal,
                          now.stuck_nozzle - bank * kNozzles);
      for (int hinge = 0; hinge < (plant.nozzles_listed ? 2 : 1); ++hinge) {
        const int first = DriveOf(bank * kNozzles, hinge);
        lanes::Nozzles<double>& of = hinge == 0 ? nozzles[bank].first : nozzles[bank].second;
        of = lanes::NozzlesAt(y + AngleOf(first));
        lanes::DriveState<double> state;
        std::copy_n(y + AngleOf(first), kNozzles, state.angle_rad);
        std::copy_n(y + RateOf(first), kNozzles, state.rate_rad_s);
        lanes::SetAccelerations(drives[bank], now.command_rad.data() + first, state, of);
      }
    }
    if (from.bending_modes() == 0) return;
    lanes::SetModes(bending, 0, from, now.stack);
    if (now.jettisoned != 0)
      lanes::SetTable(bending, 0,
                      from.stacks[static_cast<std::size_t>(now.stack)].BendingWithout(now.jettisoned));
    lanes::ShapesAt(bending, masses.propellant_kg);
    for (int plane = 0; plane < kPlanes; ++plane) {
      std::copy_n(y + kModalState + plane * kModes, kModes, bending_state.q_m[plane]);
      std::copy_n(y + kModalRate + plane * kModes, kModes, bending_state.rate_m_s[plane]);
    }
  }

  // Masses off the axis have values of the instant: `apart` is that of boosters, `sides` that of tables.
  static std::optional<lanes::FlyingPlant<double>> Without(const LauncherPlant& from,
                                                           const lanes::FlyingPlant<double>& stack,
                                                           const LauncherPhase& now,
                                                           lanes::ApartBoosters<double>& apart,
                                                           lanes::SideMasses<double>& sides) {
    const LauncherStack& of = from.stacks[static_cast<std::size_t>(now.stack)];
    if (now.jettisoned == 0 && stack.apart == nullptr && stack.sides == nullptr && !of.aero_variants)
      return std::nullopt;
    lanes::FlyingPlant<double> lighter = stack;
    if (stack.sides != nullptr) {
      sides = *stack.sides;
      lighter.sides = &sides;
    }
    if (now.jettisoned != 0) lanes::SetStack(lighter.stack, 0, MassOf(from, now.stack, now.jettisoned));
    lanes::SetShape(lighter.aero, 0, of, of.AeroAfter(now.jettisoned, now.burning));
    if (stack.apart != nullptr) {
      apart = *stack.apart;
      lighter.apart = &apart;
      if (now.jettisoned & kBoostersGone) lanes::SetLane(apart.attached, 0, false);
      for (int k = 0; k < apart.count; ++k)
        lanes::SetLane(apart.each[k].burning, 0, (now.boosters_burning >> k & 1u) != 0);
    }
    return lighter;
  }
  lanes::LoadsOf<double> Loads() const {
    return WithBody([this](const auto& turned, const auto& body) {
      return lanes::LoadsAt(earth.rotation_rate_rad_s, plant, phase, phase.burning, around, masses, turned,
                            motion, body);
    });
  }
  lanes::Rates<double> Rates() const {
    return WithBody([this](const auto& turned, const auto& body) {
      return lanes::RatesOf<double>(earth.rotation_rate_rad_s, plant, phase, phase.burning, around, masses,
                                    turned, motion, body, nullptr);
    });
  }

  const Earth& earth;
  lanes::ApartBoosters<double> apart;                 ///< unset unless there are such boosters
  lanes::SideMasses<double> sides;                    ///< unset unless there are masses off the axis
  std::optional<lanes::FlyingPlant<double>> lighter;  ///< the stack without bodies that have left
  const lanes::FlyingPlant<double>& plant;
  lanes::BurnPhase<double> phase;
  lanes::RigidMotion<double> motion;
  lanes::Surroundings<double> around;
  lanes::TimedMasses<double> masses;
  lanes::BankNozzles<double> nozzles[kBanks];  ///< of the plant's banks
  lanes::Actuators<double> drives[kBanks]{};
  // Unset in a vehicle that does not bend.
  lanes::StackBending<double> bending;
  lanes::BendingState<double> bending_state;
  mutable lanes::ModalForce<double> modal;  ///< of the last evaluation

 private:
  template <class Function>
  auto WithBody(const Function& function) const
      -> decltype(function(nozzles[0].first, lanes::StraightBody{})) {
    const lanes::ListedNozzles<double> listed{nozzles};
    const lanes::Nozzles<double>& cross = nozzles[0].first;
    const lanes::BentBody<double> bent{&bending, &bending_state, &modal};
    if (bending.modes > 0) return plant.nozzles_listed ? function(listed, bent) : function(cross, bent);
    return plant.nozzles_listed ? function(listed, lanes::StraightBody{})
                                : function(cross, lanes::StraightBody{});
  }
};

}  // namespace

LauncherModel::LauncherModel(const LauncherPlant& plant) : prepared_(std::make_unique<Prepared>(plant)) {}
LauncherModel::~LauncherModel() = default;

const LauncherPlant& LauncherModel::plant() const { return prepared_->plant; }

LauncherInstant LauncherModel::Evaluate(const LauncherPhase& phase, double time_s, const double* y) const {
  const OneLane one(prepared_->plant, prepared_->stacks[static_cast<std::size_t>(phase.stack)], phase, time_s,
                    y);
  const lanes::RigidMotion<double>& s = one.motion;
  const lanes::TimedMasses<double>& masses = one.masses;
  const lanes::LoadsOf<double> loads = one.Loads();
  LauncherInstant now;
  now.air.place = ToGeodetic(one.earth, Vector3(y[0], y[1], y[2]));
  now.air.v_AP_I = ToEigen(loads.v_air);
  now.air.airspeed_m_s = now.air.v_AP_I.norm();
  now.air.density_kg_m3 = one.around.density_kg_m3;
  now.air.pressure_pa = one.around.pressure_pa;
  now.air.mach = loads.flow.mach;
  now.air.qbar_pa = loads.flow.qbar_pa;
  now.v_AB_B = ToEigen(loads.v_AB_B);
  now.cg_station_m = masses.cg_station_m;
  now.thrust_n = loads.thrust_n;
  now.flow_kg_s = loads.flow_kg_s;
  now.loads.mass_kg = masses.mass_kg;
  now.loads.force_n = ToEigen(loads.force_n);
  now.loads.inertia_kg_m2 =
      Vector3(masses.axial_kg_m2, masses.transverse_kg_m2, masses.transverse_kg_m2).asDiagonal();
  Matrix3& inertia = now.loads.inertia_kg_m2;
  inertia(0, 1) = inertia(1, 0) = -one.plant.product_xy_kg_m2;
  inertia(0, 2) = inertia(2, 0) = -one.plant.product_xz_kg_m2;
  inertia(1, 2) = inertia(2, 1) = -one.plant.product_yz_kg_m2;
  if (one.plant.apart || one.plant.sides) {
    const lanes::Tensor<double> i = lanes::TensorOffAxis(one.plant, masses);
    inertia << i.xx, -i.xy, -i.xz, -i.xy, i.yy, -i.yz, -i.xz, -i.yz, i.zz;
  }
  now.loads.inertia_rate_kg_m2_s =
      -loads.flow_kg_s *
      Matrix3(Vector3(masses.axial_per_kg_m2, masses.transverse_per_kg_m2, masses.transverse_per_kg_m2)
                  .asDiagonal());
  now.loads.moment_n_m =
      ToEigen(loads.moment_n_m) -
      Vector3(loads.jet_axial * s.w.x, loads.jet_transverse * s.w.y, loads.jet_transverse * s.w.z);
  return now;
}

void LauncherModel::Derivative(const LauncherPhase& phase, double time_s, const double* y,
                               double* dydt) const {
  const std::size_t stack = static_cast<std::size_t>(phase.stack);
  const OneLane one(prepared_->plant, prepared_->stacks[stack], phase, time_s, y);
  const lanes::RigidMotion<double>& s = one.motion;
  const lanes::Rates<double> rates = one.Rates();
  const Quaternion dq = dispersa::Derivative({s.q.w, s.q.x, s.q.y, s.q.z}, ToEigen(s.w));
  Vector3 dp = ToEigen(s.v);
  if (prepared_->plant.flow_coriolis) dp += ToEigen(lanes::CgVelocityOf(one.masses, s.q));
  WriteState({dp, ToEigen(rates.dv), dq, ToEigen(rates.dw)}, dydt);
  const int most_drives = prepared_->plant.nozzle_banks() * kDrives;
  if (most_drives > kDrives) std::fill(dydt + kListedLauncherSize, dydt + prepared_->plant.state_size(), 0.0);
  for (int i = 0; i < (one.plant.nozzles_listed ? most_drives : kNozzles); ++i) {
    const int bank = i / kDrives;
    if (bank >= one.plant.banks) break;
    const std::size_t drive = static_cast<std::size_t>(i);
    const lanes::Actuators<double>& drives = one.drives[bank];
    const double command = lanes::Followed(drives, phase.command_rad[drive]);
    lanes::DriveRates(drives, i % kNozzles, command, y[AngleOf(i)], y[RateOf(i)], phase.slides[drive],
                      dydt[AngleOf(i)], dydt[RateOf(i)]);
  }
  if (prepared_->plant.state_size() == kRigidLauncherSize) return;
  for (int plane = 0; plane < kPlanes; ++plane)
    for (int mode = 0; mode < kModes; ++mode) {
      const int at = plane * kModes + mode;
      const bool flies = mode < one.bending.modes;
      dydt[kModalState + at] = flies ? y[kModalRate + at] : 0.0;
      dydt[kModalRate + at] = 0.0;
      if (!flies) continue;
      const lanes::ModeNow<double>& m = one.bending.At(plane, mode);
      dydt[kModalRate + at] = one.modal.drive_m_s2[plane][mode] - m.damping_1_s * y[kModalRate + at] -
                              m.stiffness_1_s2 * y[kModalState + at];
    }
}

int LauncherPlant::bending_modes() const {
  int most = 0;
  for (const LauncherStack& stack : stacks)
    if (stack.bending) most = std::max(most, stack.bending->modes);
  return most;
}

int LauncherPlant::bending_planes() const {
  int most = 1;
  for (const LauncherStack& stack : stacks)
    if (stack.bending) most = std::max(most, stack.bending->planes);
  return most;
}

bool LauncherPlant::nozzles_have_mass() const {
  return std::any_of(stacks.begin(), stacks.end(),
                     [](const LauncherStack& s) { return s.gimbal.nozzle_inertia_kg_m2 > 0.0; });
}

bool LauncherPlant::has_side_masses() const {
  return std::any_of(stacks.begin(), stacks.end(), [](const LauncherStack& s) { return s.mass.HasSides(); });
}

bool LauncherPlant::boosters_steer() const { return boosters && boosters->gimbal.limit_rad > 0.0; }

const NozzleLayout& LauncherPlant::LayoutOf(int stack, bool boosting) const {
  if (stack == 0 && boosting && boosters_steer()) return boosters->layout;
  return stacks[static_cast<std::size_t>(stack)].layout;
}

int LauncherPlant::nozzle_banks() const {
  int most = 1;
  for (const LauncherStack& stack : stacks) most = std::max(most, stack.layout.banks());
  return boosters_steer() ? std::max(most, boosters->layout.banks()) : most;
}

bool LauncherPlant::nozzles_are_listed() const {
  return boosters_steer() || std::any_of(stacks.begin(), stacks.end(),
                                         [](const LauncherStack& s) { return !s.gimbal.nozzles.empty(); });
}

}  // namespace dispersa
