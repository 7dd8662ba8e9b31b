#include "core/vehicle/aero_table.h"

#include <algorithm>

#include "core/input/fields.h"
#include "core/math/constants.h"

namespace dispersa {
namespace {

// The columns of a table, one row a grid point.
struct AeroRows {
  std::vector<double> mach, incidence_rad, ca, cn, xcp_station_m, cmq_per_rad, clp_per_rad;
};

void Describe(Fields& fields, AeroRows& rows) {
  fields.Numbers("mach", kNonNegative, 4, SIZE_MAX, rows.mach,
                 "increasing; equal in the block of rows of one Mach number");
  fields.Quantities("incidence", kAngle, Between(0.0, kHalfTurn), 4, SIZE_MAX, rows.incidence_rad,
                    "increasing, the same for each Mach number");
  fields.Numbers("ca", kAnyNumber, 4, SIZE_MAX, rows.ca, "axial force coefficient, motor burning");
  fields.Numbers("cn", kAnyNumber, 4, SIZE_MAX, rows.cn, "normal force");
  fields.Quantities("xcp_station", kLength, kAnyNumber, 4, SIZE_MAX, rows.xcp_station_m,
                    "where the normal force acts");
  fields.Numbers(
      "cmq_per_rad", kAnyNumber, 4, SIZE_MAX, rows.cmq_per_rad,
      "pitch and yaw damping about the centre of gravity, on q d / (2 V); one value per Mach number");
  fields.Numbers("clp_per_rad", kAnyNumber, 4, SIZE_MAX, rows.clp_per_rad,
                 "roll damping, on p d / (2 V); one value per Mach number");
}

// The rows, mach by mach with the same incidences each, to the grid.
void FillGrid(Fields& fields, const AeroRows& rows, AeroTable& table) {
  const std::size_t count = rows.mach.size();
  for (const auto* column :
       {&rows.incidence_rad, &rows.ca, &rows.cn, &rows.xcp_station_m, &rows.cmq_per_rad, &rows.clp_per_rad}) {
    if (column->size() == count) continue;
    fields.Refuse("", "the columns have different lengths", "one value a row in each column");
    return;
  }
  const std::size_t incidences =
      static_cast<std::size_t>(std::find_if(rows.mach.begin(), rows.mach.end(),
                                            [&](double value) { return value != rows.mach.front(); }) -
                               rows.mach.begin());
  table.incidence_rad.assign(rows.incidence_rad.begin(),
                             rows.incidence_rad.begin() + static_cast<std::ptrdiff_t>(incidences));
  for (std::size_t row = 0; row < count; ++row) {
    const std::string index = "[" + std::to_string(row) + "]";
    const std::size_t column = row % incidences;
    const bool starts_mach = column == 0;
    const bool mach_fits = starts_mach ? (row == 0 || rows.mach[row] > rows.mach[row - 1])
                                       : rows.mach[row] == rows.mach[row - 1];
    const bool incidence_fits = rows.incidence_rad[row] == table.incidence_rad[column] &&
                                (starts_mach || rows.incidence_rad[row] > rows.incidence_rad[row - 1]);
    const bool last_is_partial = row + 1 == count && column + 1 != incidences;
    if (!mach_fits || !incidence_fits || last_is_partial || incidences < 2 || incidences == count) {
      fields.Refuse("mach" + index, "the row does not continue the grid",
                    "a full grid: rows of increasing mach, each mach with the same increasing incidences, "
                    "two or more of "
                    "both");
      return;
    }
    if (!starts_mach && (rows.cmq_per_rad[row] != rows.cmq_per_rad[row - 1] ||
                         rows.clp_per_rad[row] != rows.clp_per_rad[row - 1])) {
      fields.Refuse("cmq_per_rad" + index, "the rate damping changes with incidence",
                    "the same cmq_per_rad and clp_per_rad in all rows of a mach number");
      return;
    }
    if (!starts_mach) continue;
    table.mach.push_back(rows.mach[row]);
    table.cmq_per_rad.push_back(rows.cmq_per_rad[row]);
    table.clp_per_rad.push_back(rows.clp_per_rad[row]);
  }
  table.ca = rows.ca;
  table.cn = rows.cn;
  table.xcp_station_m = rows.xcp_station_m;
}

}  // namespace

void Describe(Fields& fields, AeroTable& table) {
  fields.Quantity("reference_area", kArea, kPositive, table.reference_area_m2, "of the coefficients");
  fields.Quantity("reference_length", kLength, kPositive, table.reference_length_m,
                  "of the damping terms: the diameter");
  AeroRows rows;
  fields.Table("table", "a CSV file", "a CSV file: a full grid, Mach by Mach", [&](Fields& columns) {
    Describe(columns, rows);
    columns.Check([&] { FillGrid(columns, rows, table); });
  });
}

}  // namespace dispersa
