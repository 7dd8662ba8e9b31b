// Finite elements of a free beam: nodes, shape functions, stiffness and mass.
//
// A node has two degrees of freedom: deflection w and rotation of the cross-section theta. Both are real
// functions of the station s, and theta = dw/ds without shear. Between two nodes w is the cubic that they
// give, and theta the parabola that belongs to it. This is the exact static shape of a uniform element, in
// the theory of Euler and Bernoulli (shear ratio 0: Hermite's cubics) and in Timoshenko's (Z. Friedman and J.
// B. Kosmatka, Computers & Structures 47, 1993). Such an element has one shear strain. An element's own
// inertia changes the shear along it, so each element has a third kind of shape: its bow, the shape that an
// even load gives it between clamped ends. With it frequencies converge with the fourth power of the
// element's length or better, without it only with the second where the beam shears. Rotary inertia leaves a
// small error of the second power. Of a uniform beam they converge from above.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/vehicle/beam_masses.h"
#include "core/vehicle/structure_beam.h"

namespace dispersa {

/// The rows of a node in shapes and masses: its deflection, its rotation, and the bow of the element behind
/// it (none behind the last).
inline constexpr int kNodeRows = 3;
/// The rows of an element: those of its upper node, and the deflection and the rotation of its lower one.
inline constexpr int kElementRows = 5;

/// Shares of an element's rows at a place: w_top, theta_top, bow, w_bottom, theta_bottom.
struct BeamShape {
  std::array<double, kElementRows> deflection;
  std::array<double, kElementRows> rotation;
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

/// The node that is nearest to a station.
std::size_t NearestNode(const std::vector<double>& stations, double station_m);

/// Elastic energy of an element is e' flexural_stiffness e / 2, e the rotations of its two ends relative to
/// the chord, and its bow.
struct BeamElement {
  double length_m = 0.0;
  double shear_ratio = 0.0;
  Eigen::Matrix3d flexural_stiffness;
};
std::vector<BeamElement> BuildElements(const Beam& beam, BeamPlane plane,
                                       const std::vector<double>& stations);

/// Consistent masses, of three rows a node. A mass model's masses are integrated exactly (Gauss, 5 points).
Eigen::MatrixXd MassMatrix(const Beam& beam, const std::vector<double>& stations,
                           const std::vector<BeamElement>& elements);

/// The whole stiffness matrix, of three rows a node. For checks: FreeFreeModes does without it.
Eigen::MatrixXd StiffnessMatrix(const std::vector<BeamElement>& elements);

/// The mass matrix times shapes. It couples a node with its neighbours alone, so this takes a tenth of a
/// product of full matrices.
Eigen::MatrixXd MassTimes(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& shapes);

/// Columns: the unit displacement, and the unit rotation about `station_m`.
Eigen::MatrixXd RigidShapes(const std::vector<double>& stations, double station_m);

}  // namespace dispersa
