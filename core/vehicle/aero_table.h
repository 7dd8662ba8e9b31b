// Aerodynamic coefficients of a stack, as tables give them.
#pragma once

#include <string>
#include <vector>

namespace dispersa {

class Fields;

/// Standard deviations that a table states of itself, one for each row of (mach, incidence). Empty: none.
struct AeroUncertainty {
  std::vector<double> ca, cn;  ///< as parts of the coefficient
  std::vector<double> xcp_m;
  std::vector<double> damping;  ///< of cmq and clp, as parts; shape (mach)

  bool empty() const { return ca.empty() && cn.empty() && xcp_m.empty() && damping.empty(); }
};

struct AeroConfiguration;

/// Aerodynamic coefficients of one stack (the stages still attached) over Mach number and total incidence, in
/// body axes: F = -q S (CA x + CN n), n the direction of the cross-flow. Outside the grid the end value
/// holds.
///
/// A body with two planes of symmetry (with boosters at its sides, for one) has a table of the pitch plane
/// xz, and one of the yaw plane xy whose incidence is the sideslip. With n = (0, n_y, n_z), i the total
/// incidence and Mach number M:
///
///   F = -q S ((CA_z(M, i) n_z² + CA_y(M, i) n_y²) x + CN_y(M, i) n_y y + CN_z(M, i) n_z z)
///
/// CN_y = -C_Y and CN_z act at centres of pressure of their own. In both planes this is the table. Between
/// them it is the lowest order that the mirror symmetries leave: F_y is odd in the cross-velocity along y and
/// even in the one along z, F_z the reverse, F_x even in both (C. G. Maple, J. L. Synge, "Aerodynamic
/// symmetry of projectiles", Quarterly of Applied Mathematics 6, 1949). It is exact where the forces are
/// linear in the cross-velocities, at small incidence. The roll moment, odd in both, is 0 in the planes and
/// is neglected between them.
struct AeroTable {
  double reference_area_m2 = 0.0;
  double reference_length_m = 0.0;  ///< the diameter
  std::vector<double> mach;
  std::vector<double> incidence_rad;  ///< >= 0
  std::vector<double> ca;             ///< shape (mach, incidence), row by row, power on
  std::vector<double> cn;
  std::vector<double> xcp_station_m;  ///< where the normal force acts
  std::vector<double> cmq_per_rad;    ///< shape (mach): pitch and yaw damping, on q d / (2 V), about the CG
  std::vector<double> clp_per_rad;    ///< shape (mach): roll damping on p d / (2 V)
  // cmq and clp may be empty: then those built up from the profile hold (aerodynamics_build_up.h).
  std::vector<double> ca_power_off = {};  ///< shape (mach, incidence), with the motor out (empty: as ca)
  AeroUncertainty uncertainty = {};
  bool is_by_moment = false;  ///< its file gives cm in place of the centre of pressure
  /// None of a body of revolution. Else one, of the yaw plane: cn is -C_Y, cmq damps yaw, clp does not count.
  std::vector<AeroTable> yaw_plane;
  std::vector<AeroConfiguration> lighter;  ///< the same stack after bodies have left

  std::size_t RowOf(std::size_t at_mach, std::size_t at_incidence) const {
    return at_mach * incidence_rad.size() + at_incidence;
  }
};

/// A stack's table after these bodies have left: names of jettisoned bodies, or kBoostersName.
struct AeroConfiguration {
  std::vector<std::string> without;
  AeroTable table;
};
inline constexpr const char* kBoostersName = "boosters";

/// Reads the forms that a file may have, and derives the one above:
///
/// - The place of the normal force: xcp_station_*, or cm about moment_reference_station_*, nose up on q S d.
///   Then xcp = reference - d cm / cn in each row. Where cn is 0 (at incidence 0, for one) the neighbouring
///   row's holds: a moment without a force is refused.
/// - Angles of attack and sideslip with the side force, body axes: u, v, w = V (cos a cos b, sin b, sin a cos
///   b), cn towards -z, cy towards y, cln turns the nose to the right. The rows of b = 0 are the pitch plane.
///   With the place of the side force (xcp_side_station_m, or cln) the rows of a = 0 are the yaw plane, else
///   the body is one of revolution. Other rows are compared with the body's force: beyond kSideslipTolerance
///   they are refused.
/// - Incidence from 0, or signed. A signed table is folded: ca is even, cn and cm are odd. Rows that differ
///   from their mirror images by more than kFoldTolerance are refused.
/// - Power off: ca_power_off, or base_area_*, to whose base drag (drag.h) ca is then increased.
/// - Uncertainties: columns, or one number for all rows; of one or of three standard deviations.
void Describe(Fields& fields, AeroTable& table);

/// Part of the greatest coefficient of a Mach number by which mirrored rows may differ.
inline constexpr double kFoldTolerance = 0.02;

/// Part of the greatest coefficient of a Mach number by which a row with both angles may differ from what the
/// rows of the planes say: the model, and an error of interpolation. Moments: of the greatest force times the
/// reference length.
inline constexpr double kSideslipTolerance = 0.05;

/// Draws of a flight, in standard deviations of the tables' uncertainties. The same for all tables.
struct AeroSigmas {
  double ca = 0.0, cn = 0.0, xcp = 0.0, damping = 0.0;

  bool is_nominal() const { return ca == 0.0 && cn == 0.0 && xcp == 0.0 && damping == 0.0; }
};
/// The table, and its lighter ones, so many standard deviations away.
AeroTable Drawn(const AeroTable& table, const AeroSigmas& sigmas);
/// Whether the table or a lighter one states an uncertainty.
bool IsUncertain(const AeroTable& table);

}  // namespace dispersa
