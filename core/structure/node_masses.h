// The masses of a beam at the nodes of its mesh, for products with shapes four at a time.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/math/lanes.h"
#include "core/structure/beam_elements.h"

namespace dispersa {

/// Four shapes side by side.
using FourShapes = lanes::Pack<4>;

/// The four values of each, one after the other.
inline double* Values(FourShapes* shapes) { return reinterpret_cast<double*>(shapes); }
inline const double* Values(const FourShapes* shapes) { return reinterpret_cast<const double*>(shapes); }

/// Shapes in fours: the values of the first four at all rows (kNodeRows a node), then those of the next four.
class ShapeColumns {
 public:
  /// Values are undefined until they are set.
  ShapeColumns(std::size_t row_count, std::size_t four_count)
      : rows(row_count),
        fours(four_count),
        values_(std::make_unique_for_overwrite<FourShapes[]>(row_count * four_count)) {}

  const FourShapes* Four(std::size_t k) const { return values_.get() + k * rows; }
  FourShapes* Four(std::size_t k) { return values_.get() + k * rows; }

  std::size_t rows = 0, fours = 0;

 private:
  std::unique_ptr<FourShapes[]> values_;
};

/// The mass matrix of MassMatrix() (beam_elements.h) by its blocks: a node has mass of its own and is coupled
/// with the next.
struct NodeMasses {
  /// By node: ww, w theta, theta theta, and with the bow b behind it w b, theta b, bb.
  std::vector<std::array<double, 6>> at;
  /// By element, of its upper node's values with its lower node's: ww, w theta, theta w, theta theta, b w, b
  /// theta.
  std::vector<std::array<double, 6>> to_next;

  /// The matrix times shapes.
  ShapeColumns Times(const ShapeColumns& shapes) const;
  /// The matrix times the motion of the nodes by `deflection` and `rotation`, without bows.
  std::vector<double> Times(const std::vector<double>& deflection, double rotation) const;
};

/// Makes the masses of one mesh. What an element has of a uniform tube is known beforehand but for two
/// factors: the tube's mass per length, and that times the square of its radius of gyration.
class NodeMassMaker {
 public:
  NodeMassMaker(std::vector<double> stations, std::vector<BeamElement> elements, bool rotary_inertia);

  NodeMasses Of(const BeamMasses& masses) const;
  const std::vector<double>& stations() const { return stations_; }
  const std::vector<BeamElement>& elements() const { return elements_; }

 private:
  /// Upper triangle of an element's matrix, row by row.
  using Triangle = std::array<double, 15>;
  static void Add(double factor, const Triangle& part, std::size_t element, NodeMasses& masses);

  std::vector<double> stations_;
  std::vector<BeamElement> elements_;
  bool rotary_inertia_;
  std::vector<Triangle> by_deflection_, by_rotation_;  ///< of 1 kg/m, of 1 kg m
};

}  // namespace dispersa
