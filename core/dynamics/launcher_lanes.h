// From the description of one flight (launcher.h) to a lane of the model (launcher_body.h).
#pragma once

#include "core/dynamics/actuators.h"
#include "core/dynamics/launcher_body.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// `from` must outlive the flight.
template <class T>
DISPERSA_INLINE void SetLane(FlightWeatherLanes<T>& w, int lane, const FlightWeather& from) {
  Lane(w.density_factor, lane) = from.density_factor;
  Lane(w.jet_speed_m_s, lane) = from.jet_speed_m_s;
  Lane(w.jet_altitude_m, lane) = from.jet_altitude_m;
  Lane(w.jet_inverse_width, lane) = from.jet_inverse_width;
  Lane(w.jet_north, lane) = from.jet_north;
  Lane(w.jet_east, lane) = from.jet_east;
  Lane(w.gust_speed_m_s, lane) = from.gust_speed_m_s;
  Lane(w.gust_start_m, lane) = from.gust_start_m;
  Lane(w.gust_inverse_length, lane) = from.gust_inverse_length;
  Lane(w.gust_north, lane) = from.gust_north;
  Lane(w.gust_east, lane) = from.gust_east;
  w.profile[lane] = from.profile.is_calm() ? nullptr : &from.profile;
  w.air_rows.range.Forget(lane);
  w.profile_rows.range.Forget(lane);
  w.has_profiles = w.has_updrafts = false;
  for (int i = 0; i < kWidth<T>; ++i) {
    w.has_profiles |= w.profile[i] != nullptr;
    w.has_updrafts |= w.profile[i] != nullptr && w.profile[i]->has_updraft;
  }
}

template <class T>
DISPERSA_INLINE void SetLane(BodyAerodynamicsLanes<T>& b, int lane, const BodyAerodynamics& body,
                             const AeroGrid& grid) {
  b.grid[lane] = &grid;
  b.rows.mach.Forget(lane);
  Lane(b.mach_top, lane) = grid.mach.top;
  Lane(b.mach_scale, lane) = grid.mach.scale;
  Lane(b.incidence_top, lane) = grid.incidence.top;
  Lane(b.incidence_scale, lane) = grid.incidence.scale;
  Lane(b.area_m2, lane) = body.area_m2;
  Lane(b.length_m, lane) = body.length_m;
  Lane(b.span_m, lane) = body.span_m;
  Lane(b.ca_factor, lane) = body.ca.factor;
  Lane(b.cn_factor, lane) = body.cn.factor;
  Lane(b.xcp_factor, lane) = body.xcp_station_m.factor;
  Lane(b.moment_reference_station_m, lane) = body.moment_reference_station_m;
  Lane(b.minimum_airspeed_m_s, lane) = body.minimum_airspeed_m_s;
  Lane(b.twist_rad_m, lane) = body.twist_rad_m;
  b.has_wind_axes = b.has_yaw_plane = b.has_airspeed_floor = b.has_twist = false;
  for (int i = 0; i < kWidth<T>; ++i) {
    b.has_wind_axes |= b.grid[i] && b.grid[i]->wind_axes.data() != nullptr;
    b.has_yaw_plane |= b.grid[i] && b.grid[i]->yaw_plane.data() != nullptr;
    b.has_airspeed_floor |= Lane(b.minimum_airspeed_m_s, i) > 0.0;
    b.has_twist |= Lane(b.twist_rad_m, i) != 0.0;
  }
  b.has_more = b.has_wind_axes || b.has_yaw_plane;
  // Rows that other lanes have kept may lack what counts from now on.
  for (int i = 0; b.has_more && i < kWidth<T>; ++i) b.rows.mach.Forget(i);
}

/// The aerodynamics of a lane's stack in another state (null: those of the whole stack, motor burning).
template <class T>
DISPERSA_INLINE void SetShape(BodyAerodynamicsLanes<T>& b, int lane, const LauncherStack& stack,
                              const AeroVariant* variant) {
  SetLane(b, lane, stack.aerodynamics, variant != nullptr ? *variant->grid.get() : *stack.aero_grid.get());
  if (variant == nullptr) return;
  Lane(b.area_m2, lane) = variant->body.area_m2;
  Lane(b.length_m, lane) = variant->body.length_m;
  Lane(b.span_m, lane) = variant->body.span_m;
}

/// Returns whether it departs at all.
template <class T>
DISPERSA_INLINE bool SetLane(NozzleDepartureLanes<T>& n, int lane, const NozzleDeparture& nozzle) {
  bool departs = false;
  const double* turn = nozzle.tilt.data();  // column by column
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) {
      const double extra = nozzle.thrust_factor * turn[3 * column + row] - (row == column ? 1.0 : 0.0);
      Lane(n.extra.row[row][column], lane) = extra;
      departs |= extra != 0.0;
    }
  Lane(n.offset_y_m, lane) = nozzle.offset_y_m;
  Lane(n.offset_z_m, lane) = nozzle.offset_z_m;
  return departs || nozzle.offset_y_m != 0.0 || nozzle.offset_z_m != 0.0;
}

template <class T>
DISPERSA_INLINE void SetLane(ListedNozzle<T>& n, int lane, const NozzleLayout& layout, int nozzle) {
  const int first = DriveOf(nozzle, 0), second = DriveOf(nozzle, 1);
  Lane(n.share, lane) = layout.share[nozzle];
  Lane(n.y_m, lane) = layout.y_m[nozzle];
  Lane(n.z_m, lane) = layout.z_m[nozzle];
  Lane(n.first_y, lane) = layout.towards_y[first];
  Lane(n.first_z, lane) = layout.towards_z[first];
  Lane(n.second_y, lane) = layout.towards_y[second];
  Lane(n.second_z, lane) = layout.towards_z[second];
}

/// Which banks have drives, of stages or of boosters. The vehicle has `most`, of which the first counts
/// always.
template <class T>
DISPERSA_INLINE void MarkDriven(LauncherPlantLanes<T>& p, int most) {
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
DISPERSA_INLINE bool SetBanks(LauncherPlantLanes<T>& p, int lane, const LauncherStack& s, int most) {
  bool departs = false;
  for (int i = 0; i < most; ++i) {
    NozzleBank<T>& bank = p.bank[i];
    SetLane(bank.there, lane, i == 0 || i < s.layout.banks());
    for (int k = 0; k < kNozzles; ++k) {
      const int nozzle = i * kNozzles + k;
      if (p.nozzles_listed) SetLane(bank.listed[k], lane, s.layout, nozzle);
      const bool one_departs = SetLane(bank.departs[k], lane, s.nozzles.data()[nozzle]);
      departs |= i == 0 && one_departs;
    }
  }
  MarkDriven(p, most);
  return departs;
}

/// The plant of a lane on its stack with nothing jettisoned. `p.apart` points to values of its own where the
/// plant has boosters, and `p.sides` where it has masses off the axis. Its weather is set separately, once a
/// flight.
template <class T>
DISPERSA_INLINE void SetLane(LauncherPlantLanes<T>& p, int lane, const LauncherPlant& plant, int stack) {
  const LauncherStack& s = plant.stacks.data()[stack];
  SetLane(p.stack, lane, s.mass);
  SetLane(p.burn, lane, s.burn);
  SetLane(p.aero, lane, s.aerodynamics, *s.aero_grid.get());
  Lane(p.cg_factor, lane) = plant.cg_factor * s.cg_factor;
  const double inertia_factor = plant.inertia_factor * s.inertia_factor;
  Lane(p.inertia_factor, lane) = inertia_factor;
  Lane(p.product_xy_kg_m2, lane) = s.product_xy_kg_m2 * inertia_factor;
  Lane(p.product_xz_kg_m2, lane) = s.product_xz_kg_m2 * inertia_factor;
  Lane(p.product_yz_kg_m2, lane) = s.product_yz_kg_m2 * inertia_factor;
  SetLane(p.has_products, lane,
          s.product_xy_kg_m2 != 0.0 || s.product_xz_kg_m2 != 0.0 || s.product_yz_kg_m2 != 0.0);
  p.any_products = Any(p.has_products);
  Lane(p.pivot_station_m, lane) = s.gimbal.pivot_station_m;
  Lane(p.nozzle_radius_m, lane) = s.gimbal.nozzles.empty() ? s.gimbal.radius_m : s.layout.flow_radius_m;
  Lane(p.nozzle_moment_kg_m, lane) = s.gimbal.nozzle_mass_kg * s.gimbal.nozzle_cg_m;
  Lane(p.nozzle_inertia_kg_m2, lane) = s.gimbal.nozzle_inertia_kg_m2;
  SetLane(p.sections, lane, s.loads.get());
  p.nozzles_have_mass = plant.nozzles_have_mass();
  p.jet_damping = plant.jet_damping;
  p.flow_coriolis = plant.flow_coriolis;
  const double* tilt = s.thrust_tilt.data();  // column by column
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      Lane(p.thrust_tilt.row[row][column], lane) = tilt[3 * column + row];
  Lane(p.thrust_offset_y_m, lane) = s.thrust_offset_y_m;
  Lane(p.thrust_offset_z_m, lane) = s.thrust_offset_z_m;
  double nozzles_thrust = 1.0;
  for (int i = 0; i < s.layout.nozzles; ++i)
    nozzles_thrust += s.layout.share[i] * (s.nozzles.data()[i].thrust_factor - 1.0);
  Lane(p.nozzles_thrust, lane) = nozzles_thrust;
  p.nozzles_listed = plant.nozzles_are_listed();
  if (p.apart) {
    p.apart->first_bank = plant.stacks.data()[0].layout.banks();
    SetLane(*p.apart, lane, *plant.boosters.get(), stack == 0);
  }
  if (p.sides) SetLane(p.sides->masses, lane, s.mass);  // what is jettisoned is on the axis
  SetLane(p.departs, lane, SetBanks(p, lane, s, plant.nozzle_banks()));
  p.any_departs = Any(p.departs);
  Lane(p.lateral_moment_y_kg_m, lane) = s.lateral_moment_y_kg_m;
  Lane(p.lateral_moment_z_kg_m, lane) = s.lateral_moment_z_kg_m;
}

/// The bending of a lane on its stack. ShapesAt sets the values that depend on propellant.
template <class T>
DISPERSA_INLINE void SetLane(BendingTableLanes<T>& b, int lane, const LauncherPlant& plant, int stack) {
  SetTable(b, lane, plant.stacks.data()[stack].bending.get());
  for (int mode = 0; mode < kModes; ++mode)
    Lane(b.frequency_factor[mode], lane) = plant.bending.frequency.data()[mode];
  Lane(b.damping_ratio, lane) = plant.bending.damping_ratio;
  Lane(b.slope_factor, lane) = plant.bending.slope;
  b.modes = plant.bending_modes();
  b.planes = plant.bending_planes();
}

/// For first and second hinges. `stuck`: index in its bank of a nozzle that does not move, or another number.
/// `longest_s`: longest time that Propagate will get.
template <class T>
DISPERSA_INLINE void SetLane(GimbalLanes<T>& d, int lane, const Gimbal& gimbal, int stuck,
                             double longest_s = 0.0) {
  const double w = gimbal.bandwidth_rad_s;
  Lane(d.limit_rad, lane) = gimbal.limit_rad;
  Lane(d.rate_limit_rad_s, lane) = gimbal.rate_limit_rad_s;
  Lane(d.bandwidth2_1_s2, lane) = w * w;
  Lane(d.twice_damping_1_s, lane) = 2.0 * gimbal.damping_ratio * w;
  for (int i = 0; i < kNozzles; ++i) Lane(d.moves[i], lane) = i == stuck ? 0.0 : 1.0;
  Lane(d.dead_zone_rad, lane) = gimbal.dead_zone_rad;
  Lane(d.friction_1_s2, lane) = w * w * gimbal.friction_rad;
  Lane(d.resolution_rad, lane) = gimbal.resolution_rad;
  const int limited = StepsOver(w, longest_s, kLimitedSteps), rough = StepsOver(w, longest_s, kRoughSteps);
  Lane(d.limited_steps, lane) = limited;
  Lane(d.limited_part, lane) = 1.0 / limited;
  Lane(d.rough_steps, lane) = rough;
  Lane(d.rough_part, lane) = 1.0 / rough;
  Lane(d.fast_limit2_rad2_s2, lane) = w * longest_s > kFastDrive_rad
                                          ? gimbal.rate_limit_rad_s * gimbal.rate_limit_rad_s
                                          : kNeverReached_rad2_s2;
  d.is_rough = d.is_coarse = d.is_fast = false;
  d.most_limited_steps = d.most_rough_steps = 0;
  for (int i = 0; i < kWidth<T>; ++i) {
    d.is_rough |= Lane(d.dead_zone_rad, i) > 0.0 || Lane(d.friction_1_s2, i) > 0.0;
    d.is_coarse |= Lane(d.resolution_rad, i) > 0.0;
    d.is_fast |= Lane(d.fast_limit2_rad2_s2, i) < kNeverReached_rad2_s2;
    const int limited_steps = static_cast<int>(Lane(d.limited_steps, i));
    const int rough_steps = static_cast<int>(Lane(d.rough_steps, i));
    if (limited_steps > d.most_limited_steps) d.most_limited_steps = limited_steps;
    if (rough_steps > d.most_rough_steps) d.most_rough_steps = rough_steps;
  }
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
