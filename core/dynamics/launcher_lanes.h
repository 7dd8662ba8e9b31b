// From the description of one flight (launcher.h) to a lane of the model (launcher_body.h).
#pragma once

#include "core/dynamics/actuators.h"
#include "core/dynamics/launcher_body.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

template <class T>
DISPERSA_INLINE void SetBody(BodyInFlow<T>& b, int lane, const BodyAerodynamics& body, const AeroGrid& grid) {
  SetLane<BodyNumbers>(b, lane, body);
  b.grid[lane] = &grid;
  b.rows.mach.Forget(lane);
  Lane(b.mach_top, lane) = grid.mach.top;
  Lane(b.mach_scale, lane) = grid.mach.scale;
  Lane(b.incidence_top, lane) = grid.incidence.top;
  Lane(b.incidence_scale, lane) = grid.incidence.scale;
  Lane(b.ca_factor, lane) = body.ca.factor;
  Lane(b.cn_factor, lane) = body.cn.factor;
  Lane(b.xcp_factor, lane) = body.xcp_station_m.factor;
  b.has_wind_axes = b.has_yaw_plane = false;
  for (const AeroGrid* const of : b.grid) {
    b.has_wind_axes |= of && of->wind_axes.data() != nullptr;
    b.has_yaw_plane |= of && of->yaw_plane.data() != nullptr;
  }
  b.has_airspeed_floor = IsAnywhere(b.minimum_airspeed_m_s);
  b.has_twist = IsAnywhere(b.twist_rad_m);
  b.has_more = b.has_wind_axes || b.has_yaw_plane;
  // Rows that other lanes have kept may lack what counts from now on.
  for (int i = 0; b.has_more && i < kWidth<T>; ++i) b.rows.mach.Forget(i);
}

/// The aerodynamics of a lane's stack in another state (null: those of the whole stack, motor burning).
template <class T>
DISPERSA_INLINE void SetShape(BodyInFlow<T>& b, int lane, const LauncherStack& stack,
                              const AeroVariant* variant) {
  SetBody(b, lane, stack.aerodynamics, variant != nullptr ? *variant->grid.get() : *stack.aero_grid.get());
  if (variant == nullptr) return;
  Lane(b.area_m2, lane) = variant->body.area_m2;
  Lane(b.length_m, lane) = variant->body.length_m;
  Lane(b.span_m, lane) = variant->body.span_m;
}

/// The air of the first stack without its boosters.
template <class T>
DISPERSA_INLINE void SetCoreAir(ApartBoosters<T>& a, int lane, const LauncherStack& first) {
  const AeroVariant* const alone = first.AeroAfter(kBoostersGone, true);
  a.knows_core_air = alone != nullptr;
  if (a.knows_core_air) SetShape(a.core_air, lane, first, alone);
}

DISPERSA_INLINE NozzleDepartureOf<double> DepartureOf(const NozzleDeparture& nozzle) {
  NozzleDepartureOf<double> departs{MatrixAt(nozzle.tilt.data()), nozzle.offset_y_m, nozzle.offset_z_m};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) {
      double& turn = departs.extra.row[row][column];
      turn = nozzle.thrust_factor * turn - (row == column ? 1.0 : 0.0);
    }
  return departs;
}

DISPERSA_INLINE ListedNozzle<double> ListedOf(const NozzleLayout& layout, int nozzle) {
  const int first = DriveOf(nozzle, 0), second = DriveOf(nozzle, 1);
  return {layout.share[nozzle],    layout.y_m[nozzle],       layout.z_m[nozzle],      layout.towards_y[first],
          layout.towards_z[first], layout.towards_y[second], layout.towards_z[second]};
}

/// Which banks have drives, of stages or of boosters. The vehicle has `most`, of which the first counts
/// always.
template <class T>
DISPERSA_INLINE void MarkDriven(FlyingPlant<T>& p, int most) {
  p.banks = 1;
  for (int i = 0; i < most; ++i) {
    NozzleBank<T>& bank = p.bank[i];
    bank.driven = bank.there;
    if (p.apart && p.apart->turn_nozzles && i >= p.apart->first_bank &&
        i < p.apart->first_bank + (p.apart->count + kNozzles - 1) / kNozzles)
      bank.driven = bank.driven | p.apart->attached;
    if (Any(bank.driven)) p.banks = i + 1;
  }
}
/// Returns whether a nozzle of the first bank departs.
template <class T>
DISPERSA_INLINE bool SetBanks(FlyingPlant<T>& p, int lane, const LauncherStack& s, int most) {
  bool departs = false;
  for (int i = 0; i < most; ++i) {
    NozzleBank<T>& bank = p.bank[i];
    SetLane(bank.there, lane, i == 0 || i < s.layout.banks());
    for (int k = 0; k < kNozzles; ++k) {
      const int nozzle = i * kNozzles + k;
      if (p.nozzles_listed) SetLane(bank.listed[k], lane, ListedOf(s.layout, nozzle));
      const NozzleDepartureOf<double> one = DepartureOf(s.nozzles.data()[nozzle]);
      SetLane(bank.departs[k], lane, one);
      for (unsigned value = 0; i == 0 && value < kValues<double, NozzleDepartureOf<double>>; ++value)
        departs |= ValueAt<double>(one, value) != 0.0;
    }
  }
  MarkDriven(p, most);
  return departs;
}

DISPERSA_INLINE StackNumbers<double> NumbersOf(const LauncherPlant& plant, const LauncherStack& s) {
  StackNumbers<double> o;
  o.cg_factor = plant.cg_factor * s.cg_factor;
  o.inertia_factor = plant.inertia_factor * s.inertia_factor;
  o.product_xy_kg_m2 = s.product_xy_kg_m2 * o.inertia_factor;
  o.product_xz_kg_m2 = s.product_xz_kg_m2 * o.inertia_factor;
  o.product_yz_kg_m2 = s.product_yz_kg_m2 * o.inertia_factor;
  o.pivot_station_m = s.gimbal.pivot_station_m;
  o.nozzle_radius_m = s.gimbal.nozzles.empty() ? s.gimbal.radius_m : s.layout.flow_radius_m;
  o.nozzle_moment_kg_m = s.gimbal.nozzle_mass_kg * s.gimbal.nozzle_cg_m;
  o.nozzle_inertia_kg_m2 = s.gimbal.nozzle_inertia_kg_m2;
  o.thrust_tilt = MatrixAt(s.thrust_tilt.data());
  o.thrust_offset_y_m = s.thrust_offset_y_m;
  o.thrust_offset_z_m = s.thrust_offset_z_m;
  o.nozzles_thrust = 1.0;
  for (int i = 0; i < s.layout.nozzles; ++i)
    o.nozzles_thrust += s.layout.share[i] * (s.nozzles.data()[i].thrust_factor - 1.0);
  o.lateral_moment_y_kg_m = s.lateral_moment_y_kg_m;
  o.lateral_moment_z_kg_m = s.lateral_moment_z_kg_m;
  return o;
}

/// The plant of a lane on its stack with nothing jettisoned. `p.apart` points to values of its own where the
/// plant has boosters, and `p.sides` where it has masses off the axis. Its weather is set separately, once a
/// flight.
template <class T>
DISPERSA_INLINE void SetPlant(FlyingPlant<T>& p, int lane, const LauncherPlant& plant, int stack) {
  const LauncherStack& s = plant.stacks.data()[stack];
  const StackNumbers<double> numbers = NumbersOf(plant, s);
  SetLane<StackNumbers>(p, lane, numbers);
  SetStack(p.stack, lane, s.mass);
  SetBurn(p.burn, lane, s.burn);
  SetBody(p.aero, lane, s.aerodynamics, *s.aero_grid.get());
  SetSections(p.sections, lane, s.loads.get());
  SetLane(
      p.has_products, lane,
      numbers.product_xy_kg_m2 != 0.0 || numbers.product_xz_kg_m2 != 0.0 || numbers.product_yz_kg_m2 != 0.0);
  p.any_products = Any(p.has_products);
  p.nozzles_have_mass = plant.nozzles_have_mass();
  p.jet_damping = plant.jet_damping;
  p.flow_coriolis = plant.flow_coriolis;
  p.nozzles_listed = plant.nozzles_are_listed();
  if (p.apart) {
    p.apart->first_bank = plant.stacks.data()[0].layout.banks();
    SetBoosters(*p.apart, lane, *plant.boosters.get(), stack == 0);
    SetCoreAir(*p.apart, lane, plant.stacks.data()[0]);
  }
  if (p.sides) SetSides(*p.sides, lane, s.mass);  // what is jettisoned is on the axis
  SetLane(p.departs, lane, SetBanks(p, lane, s, plant.nozzle_banks()));
  p.any_departs = Any(p.departs);
}

/// The bending of a lane on its stack. ShapesAt sets the values that depend on propellant.
template <class T>
DISPERSA_INLINE void SetModes(StackBending<T>& b, int lane, const LauncherPlant& plant, int stack) {
  SetTable(b, lane, plant.stacks.data()[stack].bending.get());
  SetLane<BendingFactorsOf>(b, lane, plant.bending);
  b.modes = plant.bending_modes();
  b.planes = plant.bending_planes();
}

/// For first and second hinges. `stuck`: index in its bank of a nozzle that does not move, or another number.
/// `longest_s`: longest time that Propagate will get.
DISPERSA_INLINE DriveNumbers<double> DrivesOf(const Gimbal& gimbal, int stuck, double longest_s) {
  const double w = gimbal.bandwidth_rad_s;
  DriveNumbers<double> d;
  d.limit_rad = gimbal.limit_rad;
  d.rate_limit_rad_s = gimbal.rate_limit_rad_s;
  d.bandwidth2_1_s2 = w * w;
  d.twice_damping_1_s = 2.0 * gimbal.damping_ratio * w;
  for (int i = 0; i < kNozzles; ++i) d.moves[i] = i == stuck ? 0.0 : 1.0;
  d.dead_zone_rad = gimbal.dead_zone_rad;
  d.friction_1_s2 = w * w * gimbal.friction_rad;
  d.resolution_rad = gimbal.resolution_rad;
  d.limited_steps = StepsOver(w, longest_s, kLimitedSteps);
  d.limited_part = 1.0 / d.limited_steps;
  d.rough_steps = StepsOver(w, longest_s, kRoughSteps);
  d.rough_part = 1.0 / d.rough_steps;
  d.fast_limit2_rad2_s2 = w * longest_s > kFastDrive_rad ? gimbal.rate_limit_rad_s * gimbal.rate_limit_rad_s
                                                         : kNeverReached_rad2_s2;
  return d;
}
template <class T>
DISPERSA_INLINE void SetActuators(Actuators<T>& d, int lane, const Gimbal& gimbal, int stuck,
                                  double longest_s = 0.0) {
  SetLane<DriveNumbers>(d, lane, DrivesOf(gimbal, stuck, longest_s));
  d.is_rough = IsAnywhere(d.dead_zone_rad) || IsAnywhere(d.friction_1_s2);
  d.is_coarse = IsAnywhere(d.resolution_rad);
  d.is_fast = Any(d.fast_limit2_rad2_s2 < T(kNeverReached_rad2_s2));
  d.most_limited_steps = d.most_rough_steps = 0;
  for (int i = 0; i < kWidth<T>; ++i) {
    const int limited = static_cast<int>(Lane(d.limited_steps, i));
    const int rough = static_cast<int>(Lane(d.rough_steps, i));
    if (limited > d.most_limited_steps) d.most_limited_steps = limited;
    if (rough > d.most_rough_steps) d.most_rough_steps = rough;
  }
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
