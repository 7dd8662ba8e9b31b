#include "core/vehicle/mass_table.h"

#include <algorithm>
#include <numeric>

#include "core/input/fields.h"
#include "core/math/functions.h"
#include "core/vehicle/propulsion.h"

namespace dispersa {

void Describe(Fields& fields, MassTable& table) {
  constexpr std::size_t kMost = 2000;
  fields.OptionalQuantities("propellant_left", kMass, kNonNegative, 2, kMost, table.propellant_kg,
                            "of the stage, increasing or decreasing; or time");
  fields.OptionalQuantities("time", kTime, kNonNegative, 2, kMost, table.time_s,
                            "since ignition, of the nominal burn; increasing");
  fields.OptionalQuantities("mass", kMass, kPositive, 2, kMost, table.mass_kg,
                            "of the stage with its propellant; checked");
  fields.Quantities("cg_station", kLength, kNonNegative, 2, kMost, table.cg_station_m,
                    "centre of gravity of the stage alone");
  fields.Quantities("axial_inertia", kInertia, kPositive, 2, kMost, table.axial_inertia_kg_m2,
                    "about the axis");
  fields.Quantities("transverse_inertia", kInertia, kPositive, 2, kMost, table.transverse_inertia_kg_m2,
                    "across the axis, about the centre of gravity");
  fields.Check([&fields, &table] {
    const std::size_t count = table.cg_station_m.size();
    for (const auto* column : {&table.propellant_kg, &table.time_s, &table.mass_kg,
                               &table.axial_inertia_kg_m2, &table.transverse_inertia_kg_m2}) {
      const bool may_miss = column != &table.axial_inertia_kg_m2 && column != &table.transverse_inertia_kg_m2;
      if (column->size() == count || (may_miss && column->empty())) continue;
      return fields.Refuse("", "the columns have different lengths", "one value a row in each column");
    }
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
      if (!(table.transverse_inertia_kg_m2[i] >= 0.5 * table.axial_inertia_kg_m2[i]))
        return fields.Refuse("transverse_inertia[" + std::to_string(i) + "]",
                             "is that of no body: it is below half the axial inertia",
                             "half the axial inertia or more");
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
  for (auto* column : {&table.mass_kg, &table.cg_station_m, &table.axial_inertia_kg_m2,
                       &table.transverse_inertia_kg_m2, &table.propellant_kg}) {
    if (column->empty()) continue;
    std::vector<double> sorted;
    for (std::size_t i : order) sorted.push_back((*column)[i]);
    *column = std::move(sorted);
  }
}

MassRows BuildMassRows(const MassTable& table, double dry_kg) {
  const std::size_t count = table.propellant_kg.size();
  const auto sums_at = [&](std::size_t i) {
    const double mass_kg = dry_kg + table.propellant_kg[i], cg_m = table.cg_station_m[i];
    return MassRows::Sums{mass_kg * cg_m, table.transverse_inertia_kg_m2[i] + mass_kg * Square(cg_m),
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
  return built;
}

MassRows::Sums MassRows::OfPropellant(double propellant_kg) const {
  std::size_t piece = 0;
  while (piece + 1 < begin_kg.size() && propellant_kg >= begin_kg[piece + 1]) ++piece;
  const double* row = rows.data() + static_cast<std::size_t>(kRowSize) * piece;
  const double from = propellant_kg - row[0];
  return {row[1] + from * row[2], row[3] + from * row[4], row[5] + from * row[6]};
}

}  // namespace dispersa
