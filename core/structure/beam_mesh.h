// The finite-element mesh of a stack's beam, as fine as its modes need.
#pragma once

#include <vector>

#include "core/structure/beam_elements.h"

namespace dispersa {

struct BeamMesh {
  std::vector<double> stations;  ///< of the nodes, from the nose aft
  std::vector<BeamElement> elements;
  double difference = 0.0;  ///< by which the modes of elements twice as long differ, as RefinedMesh() says
};

/// Every end of a section and of a spread mass, and every station of a fixed mass is a node. Further nodes
/// between them keep elements no longer than the beam's length over `elements`.
std::vector<double> MeshStations(const std::vector<BeamSection>& sections, const BeamMasses& masses,
                                 int elements);

/// Modes of elements twice as long differ by at most this. Errors fall with the square of the length or
/// faster, so a third of it is left: 0.1 %.
inline constexpr double kMeshDifference = 3e-3;
/// No mesh gets more elements than so many.
inline constexpr std::size_t kMostElements = 400;

/// The coarsest mesh of at least `elements` elements whose first `modes` modes differ by at most
/// kMeshDifference from those of elements twice as long; else the finest below kMostElements. A difference is
/// that of a frequency, or of a deflection or slope of unit generalised mass at a node, over the mode's
/// largest. Each of `masses` is looked at: the beam's own are not.
BeamMesh RefinedMesh(const Beam& beam, BeamPlane plane, const std::vector<BeamMasses>& masses, int elements,
                     int modes);

}  // namespace dispersa
