// Mass properties of a stage as CAD gives them, over the propellant that is left.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/math/aligned_rows.h"

namespace dispersa {

class Fields;
struct MotorBurn;

/// The stage alone: its dry mass and its propellant, without boosters, jettisoned bodies and stages above.
/// Inertias are about its centre of gravity. Replaces the tubes of structure, grain and tanks in flight. Its
/// dry and propellant masses are the stage's own keys.
/// Axes of the body: x forward, y right, z down. Stations count aft.
struct MassTable {
  std::vector<double> time_s;         ///< since ignition (empty: the rows are over propellant)
  std::vector<double> propellant_kg;  ///< left
  std::vector<double> mass_kg;        ///< of the stage, checked (empty: not given)
  std::vector<double> cg_station_m;
  std::vector<double> axial_inertia_kg_m2;
  std::vector<double> transverse_inertia_kg_m2;  ///< about y, and about z without a column of it
  std::vector<double> yaw_inertia_kg_m2;         ///< about z (empty: as about y)
  /// Of the centre of gravity off the axis, towards body y and z (empty: on it).
  std::vector<double> cg_y_m, cg_z_m;
  /// Integrals of x y, x z and y z over the mass about the centre of gravity (empty: 0). The tensor's
  /// elements off the diagonal are their negatives.
  std::vector<double> product_xy_kg_m2, product_xz_kg_m2, product_yz_kg_m2;

  /// Columns that need not be there.
  std::array<std::vector<double>*, 6> Sides() {
    return {&yaw_inertia_kg_m2, &cg_y_m, &cg_z_m, &product_xy_kg_m2, &product_xz_kg_m2, &product_yz_kg_m2};
  }
  /// Whether any of them is.
  bool has_sides() const {
    return !yaw_inertia_kg_m2.empty() || !cg_y_m.empty() || !cg_z_m.empty() || !product_xy_kg_m2.empty() ||
           !product_xz_kg_m2.empty() || !product_yz_kg_m2.empty();
  }
  bool empty() const { return cg_station_m.empty(); }
};
void Describe(Fields& fields, MassTable& table);

/// Replaces the times by the propellant that the burn leaves at them, and sorts the rows by it.
void PutOverPropellant(const MotorBurn& burn, MassTable& table);

/// Sums over masses off the axis: of mass times place across the axis, of mass times station times place, of
/// half of m (z² - y²), of m y z, and of m (y² + z²). Products of inertia and what I_y and I_z differ by are
/// among them.
enum SideSum { kSideY, kSideZ, kSideStationY, kSideStationZ, kSideAboutY, kSideYz, kSideSquare, kSideSums };
using SideSums = std::array<double, kSideSums>;

/// Sums of the stage over its propellant m: the first and the second (transverse) moment about station 0,
/// and the axial inertia. They are linear between the rows and beyond them. So mass, centre of gravity and
/// inertias meet the table at its rows, and the derivatives by m, which the equations of the flow need, are
/// those of the same functions. The error between rows falls with the square of their distance.
struct MassRows {
  /// m at the row, then of each sum its value less that without propellant, and its slope.
  static constexpr int kRowSize = 8;
  AlignedRows rows;
  std::vector<double> begin_kg;  ///< of each piece
  // Without propellant:
  double first_moment_kg_m = 0.0, second_moment_kg_m2 = 0.0, axial_inertia_kg_m2 = 0.0;

  struct Sums {
    double first_moment_kg_m, second_moment_kg_m2, axial_inertia_kg_m2;
  };
  /// Of the propellant: to be added to those without.
  Sums OfPropellant(double propellant_kg) const;

  /// The same of the masses off the axis: m at the row, then value and slope of each sum (empty: none is).
  static constexpr int kSideRowSize = 16;
  AlignedRows side_rows;
  SideSums sides{};  ///< without propellant
  SideSums SidesOfPropellant(double propellant_kg) const;

  /// The piece that a mass of propellant falls into.
  std::size_t PieceAt(double propellant_kg) const;
};
/// Precondition: two rows or more, over propellant.
MassRows BuildMassRows(const MassTable& table, double dry_kg);

/// What a stage with a table is in a flight: the rows, and how its dry mass differs from theirs.
struct StageMassTable {
  std::shared_ptr<const MassRows> rows;  ///< null: the stage has none
  double dry_factor = 1.0;
  double added_kg = 0.0;  ///< of an element of the structure
  std::size_t element = 0;
};

}  // namespace dispersa
