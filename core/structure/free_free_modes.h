// Natural modes of a beam that nothing holds.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/structure/beam_elements.h"

namespace dispersa {

/// What the beam weighs, as its mass matrix has it.
struct BeamMassProperties {
  double mass_kg = 0.0;
  double cg_station_m = 0.0;
  double transverse_inertia_kg_m2 = 0.0;  ///< about the centre of gravity
};
BeamMassProperties MassPropertiesOf(const Eigen::MatrixXd& mass, const std::vector<double>& stations);

struct FreeFreeModes {
  Eigen::VectorXd frequency_rad_s;  ///< rising
  Eigen::MatrixXd shape;            ///< a column a mode, two rows a node; shape' mass shape = 1
};

/// The `count` lowest elastic modes of K x = omega² M x; fewer if the mesh has no more.
///
/// K and M themselves would lose what matters: between the first mode and the highest of a fine mesh lie ten
/// decades of omega², which rounding of K puts upon the lowest. A beam is statically determinate, though: the
/// rotations e of the elements' ends relative to their chords give every displacement from one end on, x = C
/// e, and the energy is e' D e / 2 with D in blocks of two. With D = L L' and P, which takes the rigid motion
/// (in M's sense) from x, the modes are x = P C L'^-1 y with (P C L'^-1)' M (P C L'^-1) y = y / omega²: an
/// ordinary symmetric problem whose greatest values are the lowest modes, each right to rounding times
/// (omega_k / omega_1)². M may be singular. The two rigid modes are not among them: they are exact, at
/// frequency zero.
FreeFreeModes SolveFreeFree(const std::vector<double>& stations, const std::vector<BeamElement>& elements,
                            const Eigen::MatrixXd& mass, int count);

}  // namespace dispersa
