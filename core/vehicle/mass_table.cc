#include "core/vehicle/mass_table.h"

#include <algorithm>
#include <numeric>

#include "core/input/fields.h"
#include "core/math/assertion.h"
#include "core/math/functions.h"
#include "core/vehicle/propulsion.h"

namespace dispersa {

namespace {

double ValueAt(const std::vector<double>& column, std::size_t row) {
  return column.empty() ? 0.0 : column[row];
}

// Of a row: about body y and z.
double PitchInertia(const MassTable& table, std::size_t row) { return table.transverse_inertia_kg_m2[row]; }
double YawInertia(const MassTable& table, std::size_t row) {
  return table.yaw_inertia_kg_m2.empty() ? PitchInertia(table, row) : table.yaw_inertia_kg_m2[row];
}

// The stem of the column to blame where a moment of inertia is more than both others together, as that of no
// body is; null: none is. An axial one that is too large is told as a transverse one that is too small.
const char* BadMoment(const MassTable& table, std::size_t row) {
  const double x = table.axial_inertia_kg_m2[row], y = PitchInertia(table, row), z = YawInertia(table, row);
  if (!(x <= y + z) || !(y <= x + z)) return "transverse_inertia";
  return z <= x + y ? nullptr : "yaw_inertia_kg_m2";
}

// The stem of the product by which a row's tensor is not positive definite (Sylvester), the first in the
// order of the columns; null: it is.
const char* BadProduct(const MassTable& table, std::size_t row) {
  const double x = table.axial_inertia_kg_m2[row], y = PitchInertia(table, row), z = YawInertia(table, row);
  const double xy = ValueAt(table.product_xy_kg_m2, row), xz = ValueAt(table.product_xz_kg_m2, row),
               yz = ValueAt(table.product_yz_kg_m2, row);
  if (!(x * y > xy * xy)) return "product_xy_kg_m2";
  if (!(x * z > xz * xz)) return "product_xz_kg_m2";
  if (!(y * z > yz * yz)) return "product_yz_kg_m2";
  if (x * (y * z - yz * yz) - xy * (xy * z + xz * yz) - xz * (xz * y + xy * yz) > 0.0) return nullptr;
  return xy != 0.0 ? "product_xy_kg_m2" : "product_xz_kg_m2";
}

}  // namespace

void Describe(Fields& fields, MassTable& table) {
  constexpr std::size_t kMost = 2000;
  fields.OptionalQuantities("propellant_left", kMass, kNonNegative, 2, kMost, table.propellant_kg,
                            "increasing or decreasing; or time");
  fields.OptionalQuantities("time", kTime, kNonNegative, 2, kMost, table.time_s,
                            "since ignition, of the nominal burn; increasing");
  fields.OptionalQuantities("mass", kMass, kPositive, 2, kMost, table.mass_kg,
                            "with its propellant; checked");
  fields.Quantities("cg_station", kLength, kNonNegative, 2, kMost, table.cg_station_m,
                    "centre of gravity of the stage alone");
  fields.Quantities("axial_inertia", kInertia, kPositive, 2, kMost, table.axial_inertia_kg_m2,
                    "about the axis");
  fields.Quantities("transverse_inertia", kInertia, kPositive, 2, kMost, table.transverse_inertia_kg_m2,
                    "about its centre, body y (and z)");
  fields.OptionalQuantities("yaw_inertia", kInertia, kPositive, 2, kMost, table.yaw_inertia_kg_m2,
                            "about body z");
  fields.OptionalQuantities("cg_y", kLength, kAnyNumber, 2, kMost, table.cg_y_m, "towards body y");
  fields.OptionalQuantities("cg_z", kLength, kAnyNumber, 2, kMost, table.cg_z_m, "towards body z");
  fields.OptionalQuantities("product_xy", kInertia, kAnyNumber, 2, kMost, table.product_xy_kg_m2,
                            "of x y dm");
  fields.OptionalQuantities("product_xz", kInertia, kAnyNumber, 2, kMost, table.product_xz_kg_m2,
                            "of x z dm");
  fields.OptionalQuantities("product_yz", kInertia, kAnyNumber, 2, kMost, table.product_yz_kg_m2,
                            "of y z dm");
  fields.Check([&fields, &table] {
    const std::size_t count = table.cg_station_m.size();
    std::vector<const std::vector<double>*> optional = {&table.propellant_kg, &table.time_s, &table.mass_kg};
    for (const auto* column : table.Sides()) optional.push_back(column);
    bool are_even =
        table.axial_inertia_kg_m2.size() == count && table.transverse_inertia_kg_m2.size() == count;
    for (const auto* column : optional) are_even &= column->empty() || column->size() == count;
    if (!are_even)
      return fields.Refuse("", "the columns have different lengths", "one value a row in each column");
    if (table.propellant_kg.empty() == table.time_s.empty())
      return fields.Refuse("",
                           table.time_s.empty() ? "missing column 'propellant_left_kg' or 'time_s'"
                                                : "'propellant_left' and 'time' are both given",
                           "propellant_left_*, or time_*");
    if (!table.time_s.empty() && !CheckIncreasing(fields, "time", table.time_s)) return;
    if (!table.propellant_kg.empty()) {
      const std::vector<double>& left = table.propellant_kg;
      const bool rises = left.back() > left.front();
      for (std::size_t i = 1; i < count; ++i)
        if (!(rises ? left[i] > left[i - 1] : left[i] < left[i - 1]))
          return fields.Refuse("propellant_left[" + std::to_string(i) + "]",
                               "does not continue from the one before",
                               "values that all increase, or all decrease");
    }
    for (std::size_t i = 0; i < count; ++i)
      if (const char* moment = BadMoment(table, i))
        return fields.Refuse(moment + ("[" + std::to_string(i) + "]"),
                             "is that of no body: one moment of inertia is more than both others together",
                             "moments of which none is more than the others' sum");
    for (std::size_t i = 0; i < count; ++i)
      if (const char* product = BadProduct(table, i))
        return fields.Refuse(product + ("[" + std::to_string(i) + "]"),
                             "is that of no body, with the other products and the inertias",
                             "products of which the tensor has positive moments about every axis");
  });
}

void PutOverPropellant(const MotorBurn& burn, MassTable& table) {
  for (double time_s : table.time_s) table.propellant_kg.push_back(burn.Propellant(time_s));
  table.time_s.clear();
  std::vector<std::size_t> order(table.propellant_kg.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return table.propellant_kg[a] < table.propellant_kg[b];
  });
  // Rows after burnout have the same propellant, to rounding: the first of them in time is kept.
  const double same_kg = order.empty() ? 0.0 : 1e-9 * table.propellant_kg[order.back()];
  const auto is_same = [&](std::size_t a, std::size_t b) {
    return table.propellant_kg[b] - table.propellant_kg[a] <= same_kg;
  };
  order.erase(std::unique(order.begin(), order.end(), is_same), order.end());
  std::vector<std::vector<double>*> columns = {&table.mass_kg, &table.cg_station_m,
                                               &table.axial_inertia_kg_m2, &table.transverse_inertia_kg_m2,
                                               &table.propellant_kg};
  for (auto* column : table.Sides()) columns.push_back(column);
  for (auto* column : columns) {
    if (column->empty()) continue;
    std::vector<double> sorted;
    for (std::size_t i : order) sorted.push_back((*column)[i]);
    *column = std::move(sorted);
  }
}

namespace {

// With x = -station the integral of x y about the centre is the sum of m (station_cg - station) y.
SideSums SidesAt(const MassTable& table, double dry_kg, std::size_t row) {
  const double mass_kg = dry_kg + table.propellant_kg[row], station_m = table.cg_station_m[row];
  const double y_m = ValueAt(table.cg_y_m, row), z_m = ValueAt(table.cg_z_m, row);
  SideSums sums;
  sums[kSideY] = mass_kg * y_m;
  sums[kSideZ] = mass_kg * z_m;
  sums[kSideStationY] = mass_kg * station_m * y_m - ValueAt(table.product_xy_kg_m2, row);
  sums[kSideStationZ] = mass_kg * station_m * z_m - ValueAt(table.product_xz_kg_m2, row);
  sums[kSideAboutY] =
      0.5 * mass_kg * (Square(z_m) - Square(y_m)) + 0.5 * (PitchInertia(table, row) - YawInertia(table, row));
  sums[kSideYz] = mass_kg * y_m * z_m + ValueAt(table.product_yz_kg_m2, row);
  sums[kSideSquare] = mass_kg * (Square(y_m) + Square(z_m));
  return sums;
}

void AddSides(const MassTable& table, double dry_kg, MassRows& built) {
  for (std::size_t i = 0; i + 1 < table.propellant_kg.size(); ++i) {
    const SideSums low = SidesAt(table, dry_kg, i), high = SidesAt(table, dry_kg, i + 1);
    const double from_kg = table.propellant_kg[i], width_kg = table.propellant_kg[i + 1] - from_kg;
    built.side_rows.push_back(from_kg);
    for (std::size_t k = 0; k < kSideSums; ++k) {
      const double slope = (high[k] - low[k]) / width_kg;
      if (i == 0) built.sides[k] = low[k] - slope * from_kg;
      built.side_rows.insert(built.side_rows.end(), {low[k] - built.sides[k], slope});
    }
    built.side_rows.push_back(0.0);
  }
}

}  // namespace

MassRows BuildMassRows(const MassTable& table, double dry_kg) {
  const std::size_t count = table.propellant_kg.size();
  DISPERSA_ASSERT(count >= 2, count);
  const auto sums_at = [&](std::size_t i) {
    const double mass_kg = dry_kg + table.propellant_kg[i], cg_m = table.cg_station_m[i];
    const double transverse_kg_m2 = 0.5 * (PitchInertia(table, i) + YawInertia(table, i));
    return MassRows::Sums{mass_kg * cg_m, transverse_kg_m2 + mass_kg * Square(cg_m),
                          table.axial_inertia_kg_m2[i]};
  };
  MassRows built;
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const MassRows::Sums low = sums_at(i), high = sums_at(i + 1);
    const double from_kg = table.propellant_kg[i], width_kg = table.propellant_kg[i + 1] - from_kg;
    const double first = (high.first_moment_kg_m - low.first_moment_kg_m) / width_kg;
    const double second = (high.second_moment_kg_m2 - low.second_moment_kg_m2) / width_kg;
    const double axial = (high.axial_inertia_kg_m2 - low.axial_inertia_kg_m2) / width_kg;
    if (i == 0) {
      built.first_moment_kg_m = low.first_moment_kg_m - first * from_kg;
      built.second_moment_kg_m2 = low.second_moment_kg_m2 - second * from_kg;
      built.axial_inertia_kg_m2 = low.axial_inertia_kg_m2 - axial * from_kg;
    }
    built.begin_kg.push_back(from_kg);
    built.rows.insert(built.rows.end(), {from_kg, low.first_moment_kg_m - built.first_moment_kg_m, first,
                                         low.second_moment_kg_m2 - built.second_moment_kg_m2, second,
                                         low.axial_inertia_kg_m2 - built.axial_inertia_kg_m2, axial, 0.0});
  }
  if (table.has_sides()) AddSides(table, dry_kg, built);
  return built;
}

std::size_t MassRows::PieceAt(double propellant_kg) const {
  std::size_t piece = 0;
  while (piece + 1 < begin_kg.size() && propellant_kg >= begin_kg[piece + 1]) ++piece;
  return piece;
}

SideSums MassRows::SidesOfPropellant(double propellant_kg) const {
  SideSums sums{};
  if (side_rows.empty()) return sums;
  const double* row = side_rows.data() + static_cast<std::size_t>(kSideRowSize) * PieceAt(propellant_kg);
  for (std::size_t k = 0; k < kSideSums; ++k)
    sums[k] = row[1 + 2 * k] + (propellant_kg - row[0]) * row[2 + 2 * k];
  return sums;
}

MassRows::Sums MassRows::OfPropellant(double propellant_kg) const {
  const double* row = rows.data() + static_cast<std::size_t>(kRowSize) * PieceAt(propellant_kg);
  const double from = propellant_kg - row[0];
  return {row[1] + from * row[2], row[3] + from * row[4], row[5] + from * row[6]};
}

}  // namespace dispersa
