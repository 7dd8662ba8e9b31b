// Aerodynamic force and moment on a body, in body axes about its CG.
#pragma once

#include <vector>

#include "core/math/linear.h"
#include "core/math/table.h"
#include "core/vehicle/vehicle.h"

namespace dispersa {

/// A coefficient over Mach number and total incidence. Without a table it is 0.
struct Coefficient {
  double factor = 1.0;
  Table2D table = {};

  bool empty() const { return table.z.empty(); }
};

/// Coefficients of a body, as a rule one that is symmetric about its x axis. They may be given in body axes,
/// in wind axes, or in both, which add:
///
///   F = -q S (ca x + cn n) - q S cd v + q S cl l
///
/// x points forward, v along the velocity through the air, n along the cross-flow. l is normal to v in the
/// plane of incidence. Moments are about the centre of gravity. The normal force acts at xcp. cm (at the
/// moment reference) turns the nose up in the plane of incidence. clp, cmq and cnr damp p b / (2 V), q c / (2
/// V) and r b / (2 V). The grid is the range of validity. Outside it the end value holds.
///
/// A body with two planes of symmetry (aero_table.h) has coefficients in body axes alone, with n = (0, n_y,
/// n_z): those above are of the pitch plane, and
///
///   F = -q S ((ca n_z² + ca_yaw n_y²) x + cn_yaw n_y y + cn n_z z)
///
/// cn_yaw acts at its own xcp. Each is a function of the total incidence. The factors are the pitch plane's.
template <class T>
struct BodyNumbers {
  T area_m2 = T(0.0);
  T length_m = T(0.0);                    ///< c: of cm and cmq
  T span_m = T(0.0);                      ///< b: of clp and cnr
  T moment_reference_station_m = T(0.0);  ///< with cm, cd, cl
  T twist_rad_m = T(0.0);                 ///< by which canted fins turn the body on each metre of its way:
                                          ///< clp damps the roll rate less this times V
  T minimum_airspeed_m_s = T(0.0);        ///< floor of V in the damping terms
};
struct BodyAerodynamics : BodyNumbers<double> {
  Coefficient ca, cn, cd, cl, cm;
  Coefficient xcp_station_m;                      ///< with cn
  Coefficient ca_yaw, cn_yaw, xcp_yaw_station_m;  ///< without tables: the body is symmetric about its axis
  Coefficient clp, cmq, cnr;                      ///< over Mach, one incidence

  bool has_yaw_plane() const { return !cn_yaw.empty(); }
};

struct ForceAndMoment {
  Vector3 force_n = Vector3::Zero();
  Vector3 moment_n_m = Vector3::Zero();
};

struct AeroGrid;

/// Force and moment in body axes. v_AB_B is the velocity through the air, m/s. w_AB_B is the angular velocity
/// relative to the air, rad/s. cg_station_m counts aft from the reference point of the stations. `grid` is
/// BuildAeroGrid(body). One lane of body_flow.h. At rest there is no force.
ForceAndMoment AerodynamicForce(const BodyAerodynamics& body, const AeroGrid& grid, const Vector3& v_AB_B,
                                const Vector3& w_AB_B, double density_kg_m3, double speed_of_sound_m_s,
                                double cg_station_m);

/// The vehicle file's table of one stack as coefficients.
BodyAerodynamics FromTable(const AeroTable& table);

/// Angle between the body axis and the velocity through the air, [0, pi] rad; 0 at rest.
double TotalIncidence(const Vector3& v_AB_B);

}  // namespace dispersa
