#include "core/structure/free_free_modes.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/math/matrices.h"

namespace dispersa {

namespace {

// C L'^-1: displacements of the nodes, the first one held, for unit energies of the elements.
Eigen::MatrixXd DisplacementsByEnergy(const std::vector<BeamElement>& elements) {
  const Eigen::Index count = static_cast<Eigen::Index>(elements.size());
  Eigen::MatrixXd displacement = Eigen::MatrixXd::Zero(kNodeRows * (count + 1), 3 * count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const BeamElement& element = elements[static_cast<std::size_t>(i)];
    const double h = element.length_m;
    const Eigen::Index top = kNodeRows * i, bottom = top + kNodeRows;
    // The elements before turn the whole element.
    displacement.row(bottom) = displacement.row(top) + h * displacement.row(top + 1);
    displacement.row(bottom + 1) = displacement.row(top + 1);
    // Its own ends: the chord turns by theta_top - e_top.
    const Eigen::Matrix3d upper = element.flexural_stiffness.llt().matrixU();
    const Eigen::Matrix3d own = upper.triangularView<Eigen::Upper>().solve(Eigen::Matrix3d::Identity());
    displacement.block<1, 3>(bottom, 3 * i) -= h * own.row(0);
    displacement.block<1, 3>(bottom + 1, 3 * i) += own.row(1) - own.row(0);
    displacement.block<1, 3>(top + 2, 3 * i) = own.row(2);
  }
  return displacement;
}

}  // namespace

BeamMassProperties PropertiesOf(const Eigen::MatrixXd& mass, const std::vector<double>& stations) {
  // About the middle first, so that nothing cancels.
  const double middle = 0.5 * (stations.front() + stations.back());
  const Eigen::MatrixXd rigid = RigidShapes(stations, middle);
  const Eigen::Matrix2d moments = rigid.transpose() * MassTimes(mass, rigid);
  const double arm = moments(0, 1) / moments(0, 0);
  return {moments(0, 0), middle + arm, moments(1, 1) - moments(0, 0) * arm * arm};
}

namespace {

// The modes for shapes of unit energy. Takes the rigid motion, in the sense of the masses, from them.
FreeFreeModes ModesAmong(Eigen::MatrixXd shape, const std::vector<double>& stations,
                         const Eigen::MatrixXd& mass, int count) {
  const BeamMassProperties whole = PropertiesOf(mass, stations);
  const Eigen::MatrixXd rigid = RigidShapes(stations, whole.cg_station_m);
  Eigen::MatrixXd momenta = MassTimes(mass, rigid).transpose() * shape;
  momenta.row(0) /= whole.mass_kg;
  momenta.row(1) /= whole.transverse_inertia_kg_m2;
  shape -= rigid * momenta;
  const auto [values, vectors] = EigenOfSymmetric(shape.transpose() * MassTimes(mass, shape));
  // Values at rounding of the greatest are no modes: what has no mass does not vibrate.
  const double least = 1e-12 * values[values.size() - 1];
  Eigen::Index found = 0;
  while (found < count && found < values.size() && values[values.size() - 1 - found] > least) ++found;
  FreeFreeModes modes{Eigen::VectorXd(found), Eigen::MatrixXd(shape.rows(), found)};
  for (Eigen::Index i = 0; i < found; ++i) {
    const Eigen::Index column = values.size() - 1 - i;
    modes.frequency_rad_s[i] = 1.0 / std::sqrt(values[column]);
    modes.shape.col(i) = shape * vectors.col(column) * modes.frequency_rad_s[i];
  }
  return modes;
}

}  // namespace

FreeFreeModes SolveFreeFree(const std::vector<double>& stations, const std::vector<BeamElement>& elements,
                            const Eigen::MatrixXd& mass, int count) {
  return ModesAmong(DisplacementsByEnergy(elements), stations, mass, count);
}

}  // namespace dispersa
