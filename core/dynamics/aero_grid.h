// A body's aerodynamic coefficients on one grid of Mach number and total incidence, ready to be looked up.
#pragma once

#include <cstdint>
#include <vector>

#include "core/dynamics/aerodynamics.h"
#include "core/math/aligned_rows.h"

namespace dispersa {

/// All tables of a BodyAerodynamics at factor 1 on the union of their breakpoints. Each is still the same
/// bilinear function, to rounding. A cell's row holds, for each coefficient, c0 + c1 i + (c2 + c3 i) m over
/// Mach number m and incidence i (rad). Damping is c0 + c1 m.
struct AeroGrid {
  static constexpr int kRowSize = 16;

  /// One axis of the grid: cells between edges, found by equal buckets no wider than a cell.
  struct Axis {
    std::vector<double> edges;  ///< inner lower edges of the cells from the second on, then an upper bound
    std::vector<std::uint16_t> bucket;  ///< first cell of each bucket
    double scale = 0.0;                 ///< buckets a unit
    double top = 0.0;                   ///< the argument is held from 0 to here
    int cells = 0;
  };

  Axis mach, incidence;
  AlignedRows body_axes;  ///< cell by cell, incidence fastest: ca (4), cn (4), xcp (4), cmq (2), clp (2)
  AlignedRows wind_axes;  ///< in the same form: cd (4), cl (4), cm (4), cnr less cmq (2), unused (2); empty
                          ///< without wind-axis tables
  AlignedRows yaw_plane;  ///< of a body with two planes of symmetry, in the same form: ca (4), cn (4), xcp
                          ///< (4), cnr (2), unused (2); else empty
};

AeroGrid BuildAeroGrid(const BodyAerodynamics& body);

}  // namespace dispersa
