// Loads that boosters put on the first stage's sections, of W vehicles side by side (core/math/lanes.h).
//
// The boosters together are a free body that moves with the vehicle. Their attachment passes on what is left
// of their forces, the air's among them, when their own masses are accelerated. So a section at or behind the
// attachment carries this push; a section ahead of it feels nothing. Frames and signs as in launcher_body.h.
#pragma once

#include "core/dynamics/apart_boosters.h"
#include "core/dynamics/body_sections.h"
#include "core/math/lane_vector.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// Place of the body's centre of gravity C, and its motion in body axes. Gravitation is left out.
template <class T>
struct MotionAbout {
  T cg_station_m, cg_y_m, cg_z_m;
  Vector<T> acceleration_m_s2, w, dw;
};

/// The acceleration of the axis' point beside C: what `moved` has as lateral acceleration where C is off the
/// axis.
template <class T>
DISPERSA_INLINE Vector<T> BesideCg(const MotionAbout<T>& moved) {
  const Vector<T> beside{T(0.0), -moved.cg_y_m, -moved.cg_z_m};
  return moved.acceleration_m_s2 + Cross(moved.dw, beside) + Cross(moved.w, Cross(moved.w, beside));
}

/// A force at C and a moment about it.
template <class T>
struct Push {
  Vector<T> force_n, moment_n_m;
};

/// The flow on the stage and on its boosters. What it does to the stage is that without boosters, if the
/// vehicle's tables know it. The rest acts on the boosters. Else all acts on the stage.
template <class T>
struct FlowBeside {
  NormalForce<T> stage;
  SideForce<T> stage_side;
  Push<T> boosters;  ///< without drag, which acts along the axis
};
/// `side`: of the yaw plane (null: as the pitch plane).
template <class T>
DISPERSA_INLINE FlowBeside<T> FlowOf(const ApartBoosters<T>& a, const MotionAbout<T>& about, T mach,
                                     T incidence_rad, T qbar_pa, const NormalForce<T>& air,
                                     const SideForce<T>* side) {
  const SideForce<T> whole_side = side ? *side : SideForce<T>{air.normal_n, air.slope_n, air.xcp_station_m};
  FlowBeside<T> o{air, whole_side, {Zero<T>(), Zero<T>()}};
  if (!a.knows_core_air) return o;
  const T qs = qbar_pa * a.core_air.area_m2;
  const Coefficients<T> c = CoefficientsAt(a.core_air, mach, incidence_rad);
  const auto to = [&a](T & value, T of_stage) __attribute__((always_inline)) {
    value = Select(a.attached, of_stage, value);
  };
  to(o.stage.normal_n, qs * c.cn);
  to(o.stage.slope_n, qs * c.cn_slope_1_rad);
  to(o.stage.xcp_station_m, c.xcp_station_m);
  to(o.stage_side.normal_n, o.stage.normal_n);
  to(o.stage_side.slope_n, o.stage.slope_n);
  to(o.stage_side.xcp_station_m, o.stage.xcp_station_m);
  if (a.core_air.has_yaw_plane) {
    const YawPlane<T> yaw = YawPlaneAt(a.core_air, mach, incidence_rad);
    to(o.stage_side.normal_n, qs * yaw.cn);
    to(o.stage_side.slope_n, qs * yaw.cn_slope_1_rad);
    to(o.stage_side.xcp_station_m, yaw.xcp_station_m);
  }
  const auto moment = [&about](T normal_n, T station_m) __attribute__((always_inline)) {
    return normal_n * (about.cg_station_m - station_m);
  };
  const T y_n_m = moment(whole_side.normal_n, whole_side.xcp_station_m) -
                  moment(o.stage_side.normal_n, o.stage_side.xcp_station_m);
  const T z_n_m = moment(air.normal_n, air.xcp_station_m) - moment(o.stage.normal_n, o.stage.xcp_station_m);
  o.boosters = {{T(0.0), -((whole_side.normal_n - o.stage_side.normal_n) * air.across_y),
                 -((air.normal_n - o.stage.normal_n) * air.across_z)},
                {T(0.0), z_n_m * air.across_z, -(y_n_m * air.across_y)}};
  return o;
}

/// Sums over the boosters' masses about C: mass times place, and the tensor of inertia.
template <class T>
struct BoosterMasses {
  T kg;
  Vector<T> first_kg_m;
  Tensor<T> inertia;
};
/// Adds a body of revolution parallel to the axis. Squares of its radii of gyration along and across its own
/// axis.
template <class T>
DISPERSA_INLINE void AddTo(BoosterMasses<T>& sum, T kg, const Vector<T>& place, T axial_m2, T across_m2) {
  sum.kg = sum.kg + kg;
  sum.first_kg_m = sum.first_kg_m + kg * place;
  const T xx = place.x * place.x, yy = place.y * place.y, zz = place.z * place.z;
  sum.inertia.xx = Fma(kg, axial_m2 + yy + zz, sum.inertia.xx);
  sum.inertia.yy = Fma(kg, across_m2 + xx + zz, sum.inertia.yy);
  sum.inertia.zz = Fma(kg, across_m2 + xx + yy, sum.inertia.zz);
  sum.inertia.xy = Fma(kg, place.x * place.y, sum.inertia.xy);
  sum.inertia.xz = Fma(kg, place.x * place.z, sum.inertia.xz);
  sum.inertia.yz = Fma(kg, place.y * place.z, sum.inertia.yz);
}
template <class T>
DISPERSA_INLINE BoosterMasses<T> MassesOf(const ApartBoosters<T>& a, const MotionAbout<T>& about) {
  const T none(0.0);
  BoosterMasses<T> sum{none, Zero<T>(), {none, none, none, none, none, none}};
  for (int k = 0; k < a.count; ++k) {
    const ApartBooster<T>& b = a.each[k];
    Vector<T> place{about.cg_station_m - a.dry_station_m, b.y_m - about.cg_y_m, b.z_m - about.cg_z_m};
    AddTo(sum, b.dry_kg, place, a.dry_axial_m2, a.dry_across_m2);
    T axial_m2 = none, station_m = a.grain_station_m, across_m2 = a.length2_m2;
    if (a.drains) {
      const BoosterLiquids<T> liquids = LiquidsOf(b.tanks, b.any_mixes, b.kg);
      station_m = liquids.station_m;
      across_m2 = liquids.gyration2_m2;
    } else {
      axial_m2 = Fma(T(-0.5) * b.kg, a.inner_per_kg_m2, a.outer2_m2);
      across_m2 = Fma(T(0.5), axial_m2, across_m2);
    }
    place.x = about.cg_station_m - station_m;
    AddTo(sum, b.kg, place, axial_m2, across_m2);
  }
  return sum;
}

/// `acting`: the boosters' forces, with the moment by which their flows turn the body.
template <class T>
DISPERSA_INLINE Push<T> PushOf(const ApartBoosters<T>& a, const MotionAbout<T>& moved,
                               const Push<T>& acting) {
  const BoosterMasses<T> masses = MassesOf(a, moved);
  const Vector<T>&c = masses.first_kg_m, &w = moved.w, &dw = moved.dw;
  const Tensor<T>& j = masses.inertia;
  const Vector<T> force = masses.kg * moved.acceleration_m_s2 + Cross(dw, c) + Cross(w, Cross(w, c));
  const Vector<T> moment = j * dw + Cross(w, j * w) + Cross(c, moved.acceleration_m_s2);
  return {acting.force_n - force, acting.moment_n_m - moment};
}

/// What the push adds to the moments of the sections at and behind the attachment, of lanes that carry
/// boosters. A section carries what accelerates the masses ahead of it, minus the forces there.
template <class T>
struct PushLoads {
  const ApartBoosters<T>& boosters;
  const Sections<T>& body;
  const MotionAbout<T>& moved;
  Push<T> push;

  DISPERSA_INLINE void AddAt(int station, T& y_n_m, T& z_n_m) const {
    const T none(0.0), station_m = body.station_m.data()[station];
    const Vector<T>& f = push.force_n;
    const auto carries = boosters.attached & (station_m >= boosters.attachment_station_m);
    const T ahead_m = station_m - moved.cg_station_m;
    const T about_z = push.moment_n_m.z + Fma(ahead_m, f.y, -(moved.cg_y_m * f.x));
    const T about_y = push.moment_n_m.y + Fma(-ahead_m, f.z, moved.cg_z_m * f.x);
    y_n_m = y_n_m - Select(carries, about_z, none);
    z_n_m = z_n_m + Select(carries, about_y, none);
  }
};

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
