// Natural modes of a beam that nothing holds.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/structure/beam_elements.h"

namespace dispersa {

/// Mass properties of the beam as its mass matrix has them.
struct BeamMassProperties {
  double mass_kg = 0.0;
  double cg_station_m = 0.0;
  double transverse_inertia_kg_m2 = 0.0;  ///< about the centre of gravity
};
BeamMassProperties PropertiesOf(const Eigen::MatrixXd& mass, const std::vector<double>& stations);

struct FreeFreeModes {
  Eigen::VectorXd frequency_rad_s;  ///< rising
  Eigen::MatrixXd shape;            ///< a column a mode, with shape' mass shape = 1
};

/// The `count` lowest elastic modes of K x = omega² M x, or fewer if the mesh has no more.
///
/// Solving with K and M themselves would be too inexact. In a fine mesh, omega² of the highest mode is ten
/// decades above that of the first. Rounding of K would disturb the lowest modes by as much. But a beam is
/// statically determinate. The rotations of the elements' ends relative to their chords and the elements'
/// bows, e, give every displacement from one end on: x = C e. The energy is e' D e / 2 with D in blocks of
/// three. Let D = L L', and let P take the rigid motion (in M's sense) from x. Then the modes are x = P C
/// L'^-1 y with (P C L'^-1)' M (P C L'^-1) y = y / omega². This is an ordinary symmetric problem. Its
/// greatest values are the lowest modes, each right to rounding times (omega_k / omega_1)². M may be
/// singular. The two rigid modes are left out: they are exact, at frequency zero.
FreeFreeModes SolveFreeFree(const std::vector<double>& stations, const std::vector<BeamElement>& elements,
                            const Eigen::MatrixXd& mass, int count);

}  // namespace dispersa
