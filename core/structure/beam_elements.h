// Finite elements of a free beam: nodes, shape functions, stiffness and mass.
//
// A node has two degrees of freedom: deflection w and rotation of the cross-section theta. Both are real
// functions of the station s, and theta = dw/ds without shear. Between two nodes w is the cubic that they
// give, and theta the parabola that belongs to it. This is the exact static shape of a uniform element, in
// the theory of Euler and Bernoulli (shear ratio 0: Hermite's cubics) and in Timoshenko's (Z. Friedman and J.
// B. Kosmatka, Computers & Structures 47, 1993). The elements are conforming, so frequencies converge from
// above: with the fourth power of the element's length without shear, with the second power with shear, since
// an element's shear strain is constant.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/vehicle/beam_masses.h"
#include "core/vehicle/structure_beam.h"

namespace dispersa {

/// Shares of the four end values at a place: w_top, theta_top, w_bottom, theta_bottom.
struct BeamShape {
  std::array<double, 4> deflection;
  std::array<double, 4> rotation;
};
/// `fraction` of the element from its top. The shear ratio is 12 EI / (kappa G A h²).
BeamShape ShapeAt(double fraction, double length_m, double shear_ratio);

/// A beam to be solved: stiffness by sections, which may overlap and then add.
struct Beam {
  std::vector<BeamSection> sections;
  BeamMasses masses;
  bool timoshenko = false;
  bool rotary_inertia = true;
};

/// Stations of the nodes: every end of a section and of a spread mass, and every station of a fixed mass.
/// Further nodes between them keep elements no longer than the beam's length over `elements`.
std::vector<double> MeshStations(const std::vector<BeamSection>& sections, const BeamMasses& masses,
                                 int elements);

/// The node that is nearest to a station.
std::size_t NearestNode(const std::vector<double>& stations, double station_m);

/// Elastic energy of an element is e' flexural_stiffness e / 2, e the rotations of its two ends relative to
/// the chord.
struct BeamElement {
  double length_m = 0.0;
  double shear_ratio = 0.0;
  Eigen::Matrix2d flexural_stiffness_n_m;
};
std::vector<BeamElement> BuildElements(const Beam& beam, BeamPlane plane,
                                       const std::vector<double>& stations);

/// Consistent masses, of two rows a node. A mass model's masses are integrated exactly (Gauss, 5 points).
Eigen::MatrixXd MassMatrix(const Beam& beam, const std::vector<double>& stations,
                           const std::vector<BeamElement>& elements);

/// The whole stiffness matrix, of two rows a node. For checks: FreeFreeModes does without it.
Eigen::MatrixXd StiffnessMatrix(const std::vector<BeamElement>& elements);

/// The mass matrix times shapes. It couples a node with its neighbours alone, so this takes a tenth of a
/// product of full matrices.
Eigen::MatrixXd MassTimes(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& shapes);

/// Columns: the unit displacement, and the unit rotation about `station_m`.
Eigen::MatrixXd RigidShapes(const std::vector<double>& stations, double station_m);

}  // namespace dispersa
