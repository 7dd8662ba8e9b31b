// Aerodynamic force and moment on W bodies side by side (core/math/lanes.h): the one source of
// AerodynamicForce.
#pragma once

#include "core/dynamics/aero_grid.h"
#include "core/math/lane_vector.h"
#include "core/math/row_memory.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// The cell of its grid in which each lane is. A lane whose range of Mach number contains nothing is in none.
template <class T>
struct AeroRows {
  RowRange<T> mach, incidence;
  T body_axes[AeroGrid::kRowSize];
  T wind_axes[AeroGrid::kRowSize], yaw_plane[AeroGrid::kRowSize];  ///< unset if no lane has such
};

/// The body of each lane: its grid, sizes, and the factors on its coefficients.
template <class T>
struct BodyInFlow : BodyNumbers<T> {
  const AeroGrid* grid[kWidth<T>];
  T mach_top, mach_scale, incidence_top, incidence_scale;  ///< AeroGrid::Axis
  bool has_wind_axes;                                      ///< any lane's grid has coefficients in wind axes
  bool has_yaw_plane;                                      ///< any lane's body has two planes of symmetry
  bool has_more;                                           ///< either; never both
  bool has_airspeed_floor;                                 ///< minimum_airspeed_m_s counts
  bool has_twist;                                          ///< twist_rad_m counts
  T ca_factor, cn_factor, xcp_factor;
  mutable AeroRows<T> rows;
};

template <class T>
struct Coefficients {
  T ca, cn, xcp_station_m, cmq, clp, cd, cl, cm, cnr;
  T cn_slope_1_rad;  ///< of cn over the incidence
};

/// The cell that contains x, and its range.
template <class T>
DISPERSA_INLINE int CellAt(const AeroGrid::Axis& axis, int bucket, double x, int lane, RowRange<T>& range) {
  const double* edges = axis.edges.data();
  int cell = axis.bucket.data()[bucket];
  while (x >= edges[cell]) ++cell;
  while (cell > 0 && x < edges[cell - 1]) --cell;  // rounding had put it into the next bucket
  range.Set(lane, cell > 0 ? edges[cell - 1] : 0.0, edges[cell]);
  return cell;
}

/// Finds the cells of the lanes that `found` does not name.
template <class T>
DISPERSA_OUT_OF_LINE void FindCells(const BodyInFlow<T>& body, T mach, T incidence, MaskOf<T> found) {
  int at_mach[kWidth<T>], at_incidence[kWidth<T>];
  Truncate(mach * body.mach_scale, at_mach);
  Truncate(incidence * body.incidence_scale, at_incidence);
  const unsigned known = Bits(found);
  for (int lane = 0; lane < kWidth<T>; ++lane) {
    if (known >> lane & 1u) continue;
    const AeroGrid& grid = *body.grid[lane];
    const int in_mach = CellAt(grid.mach, at_mach[lane], Lane(mach, lane), lane, body.rows.mach);
    const int in_incidence =
        CellAt(grid.incidence, at_incidence[lane], Lane(incidence, lane), lane, body.rows.incidence);
    const int offset = AeroGrid::kRowSize * (in_mach * grid.incidence.cells + in_incidence);
    for (int i = 0; i < AeroGrid::kRowSize; ++i)
      Lane(body.rows.body_axes[i], lane) = grid.body_axes.data()[offset + i];
    if (!body.has_more) continue;
    const bool has_wind_axes = !grid.wind_axes.empty();
    // Both planes of a body that is symmetric about its axis are the same.
    const AlignedRows& yaw_plane = grid.yaw_plane.empty() ? grid.body_axes : grid.yaw_plane;
    for (int i = 0; i < AeroGrid::kRowSize; ++i) {
      Lane(body.rows.wind_axes[i], lane) = has_wind_axes ? grid.wind_axes.data()[offset + i] : 0.0;
      Lane(body.rows.yaw_plane[i], lane) = yaw_plane.data()[offset + i];
    }
  }
}

template <class T>
DISPERSA_INLINE T BilinearAt(const T* c, T mach, T incidence) {
  return Fma(mach, Fma(incidence, c[3], c[2]), Fma(incidence, c[1], c[0]));
}

/// Coefficients with their factors. Outside the grid the end value holds.
template <class T>
DISPERSA_INLINE Coefficients<T> CoefficientsAt(const BodyInFlow<T>& body, T mach, T incidence_rad) {
  const T m = Clamp(mach, T(0.0), body.mach_top), i = Clamp(incidence_rad, T(0.0), body.incidence_top);
  const auto found = body.rows.mach.Contains(m) & body.rows.incidence.Contains(i);
  if (!All(found)) FindCells(body, m, i, found);
  const T* c = body.rows.body_axes;
  Coefficients<T> o;
  o.ca = body.ca_factor * BilinearAt(c, m, i);
  o.cn = body.cn_factor * BilinearAt(c + 4, m, i);
  o.cn_slope_1_rad = body.cn_factor * Fma(m, c[7], c[5]);
  o.xcp_station_m = body.xcp_factor * BilinearAt(c + 8, m, i);
  o.cmq = Fma(m, c[13], c[12]);
  o.clp = Fma(m, c[15], c[14]);
  o.cd = o.cl = o.cm = T(0.0);
  o.cnr = o.cmq;
  if (body.has_wind_axes) {
    c = body.rows.wind_axes;
    o.cd = BilinearAt(c, m, i);
    o.cl = BilinearAt(c + 4, m, i);
    o.cm = BilinearAt(c + 8, m, i);
    o.cnr = o.cmq + Fma(m, c[13], c[12]);
  }
  return o;
}

/// Angle between the body axis and the flow, [0, pi] rad, from the cross-flow and the flow along the axis.
/// Below an eighth it uses the series of the arctangent (remainder 4e-18), else SLEEF's function.
template <class T>
DISPERSA_INLINE T IncidenceOf(T across, T along) {
  const auto is_small = across < T(0.125) * along;
  const T t = across / Select(is_small, along, T(1.0));
  const T q = t * t;
  T angle = Fma(t * q,
                Horner(q, -1.0 / 3, 1.0 / 5, -1.0 / 7, 1.0 / 9, -1.0 / 11, 1.0 / 13, -1.0 / 15, 1.0 / 17), t);
  if (!All(is_small)) angle = Select(is_small, angle, Atan2(across, along));
  return angle;
}

/// Lateral force and its place on the body.
template <class T>
struct NormalForce {
  T normal_n, slope_n;  ///< the slope is by the incidence in rad
  T xcp_station_m;
  T across_y, across_z;  ///< unit vector of the flow across the axis
  T airspeed_m_s;
};

/// Of a body with two planes of symmetry, NormalForce is of the pitch plane, and this of the yaw plane. Each
/// is to be multiplied by its component of the direction across.
template <class T>
struct SideForce {
  T normal_n, slope_n, xcp_station_m;
};

template <class T>
struct FlowForce {
  Vector<T> force_n, moment_n_m;
  T qbar_pa, mach, incidence_rad;
  NormalForce<T> normal;
  SideForce<T> side;  ///< unset if no lane's body has two planes
};

/// The yaw plane of bodies with two planes of symmetry, in the cells that CoefficientsAt has found.
template <class T>
struct YawPlane {
  T ca, cn, cn_slope_1_rad, xcp_station_m, cnr;
};
template <class T>
DISPERSA_INLINE YawPlane<T> YawPlaneAt(const BodyInFlow<T>& body, T mach, T incidence_rad) {
  const T m = Clamp(mach, T(0.0), body.mach_top), i = Clamp(incidence_rad, T(0.0), body.incidence_top);
  const T* c = body.rows.yaw_plane;
  return {body.ca_factor * BilinearAt(c, m, i), body.cn_factor * BilinearAt(c + 4, m, i),
          body.cn_factor * Fma(m, c[7], c[5]), body.xcp_factor * BilinearAt(c + 8, m, i),
          Fma(m, c[13], c[12])};
}

/// v: velocity through the air (m/s), w: angular velocity (rad/s) that the damping derivatives see, both in
/// body axes. At rest there is neither force nor moment.
template <class T>
DISPERSA_INLINE FlowForce<T> ForceOfFlow(const BodyInFlow<T>& body, Vector<T> v, Vector<T> w, T density_kg_m3,
                                         T inverse_sound_s_m, T cg_station_m) {
  FlowForce<T> o;
  const T across2 = Fma(v.y, v.y, v.z * v.z);
  const T across = Sqrt(across2);
  const T v2 = Fma(v.x, v.x, across2);
  const T airspeed = Sqrt(v2);
  o.mach = airspeed * inverse_sound_s_m;
  o.qbar_pa = T(0.5) * density_kg_m3 * v2;
  o.incidence_rad = IncidenceOf(across, v.x);
  const Coefficients<T> c = CoefficientsAt(body, o.mach, o.incidence_rad);
  const T qs = o.qbar_pa * body.area_m2;
  // Unit cross-flow. At zero incidence any direction will do: the coefficients are 0.
  const T inverse_across = T(1.0) / Max(across, T(1e-30));
  const T ny = v.y * inverse_across, nz = v.z * inverse_across;
  const T normal = qs * c.cn;
  const T turning = normal * (cg_station_m - c.xcp_station_m);
  o.normal = {normal, qs * c.cn_slope_1_rad, c.xcp_station_m, ny, nz, airspeed};
  o.force_n = {-(qs * c.ca), -(normal * ny), -(normal * nz)};
  // q S d² / (2 V) = rho V S d² / 4. In the divisor 2 V, a V below the floor is replaced by the floor.
  T damped_airspeed = airspeed;
  if (body.has_airspeed_floor) {
    const auto is_slow = airspeed < body.minimum_airspeed_m_s;
    damped_airspeed = Select(is_slow, v2 / Select(is_slow, body.minimum_airspeed_m_s, T(1.0)), airspeed);
  }
  const T damping = T(0.25) * density_kg_m3 * damped_airspeed * body.area_m2;
  const T about_x = damping * body.span_m * body.span_m * c.clp;
  const T about_y = damping * body.length_m * body.length_m * c.cmq;
  const T about_z = damping * body.span_m * body.span_m * c.cnr;
  const T roll_rate = body.has_twist ? Fma(-body.twist_rad_m, airspeed, w.x) : w.x;
  o.moment_n_m = {about_x * roll_rate, Fma(about_y, w.y, turning * nz), Fma(about_z, w.z, -(turning * ny))};
  if (!body.has_more) return o;
  if (body.has_yaw_plane) {
    const YawPlane<T> yaw = YawPlaneAt(body, o.mach, o.incidence_rad);
    const T side = qs * yaw.cn;
    const T side_turning = side * (cg_station_m - yaw.xcp_station_m);
    const T about_z_yaw = damping * body.span_m * body.span_m * yaw.cnr;
    o.side = {side, qs * yaw.cn_slope_1_rad, yaw.xcp_station_m};
    o.force_n.x = -(qs * Fma(ny * ny, yaw.ca - c.ca, c.ca));
    o.force_n.y = -(side * ny);
    o.moment_n_m.z = Fma(about_z_yaw, w.z, -(side_turning * ny));
  }
  if (body.has_wind_axes) {
    const T inverse_airspeed = T(1.0) / Max(airspeed, T(1e-30));
    const T cosine = v.x * inverse_airspeed, sine = across * inverse_airspeed;
    const T drag = qs * c.cd, lift = qs * c.cl, pitching = qs * body.length_m * c.cm;
    // Lift is normal to v, towards the side from which the nose meets the flow.
    const Vector<T> force{Fma(lift, sine, -(drag * cosine)), -(Fma(lift, cosine, drag * sine) * ny),
                          -(Fma(lift, cosine, drag * sine) * nz)};
    const T arm = cg_station_m - body.moment_reference_station_m;
    o.force_n = o.force_n + force;
    o.moment_n_m = o.moment_n_m +
                   Vector<T>{T(0.0), Fma(pitching, nz, -(arm * force.z)), Fma(-pitching, ny, arm * force.y)};
  }
  return o;
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
