#include "core/vehicle/aero_table.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "core/input/fields.h"
#include "core/math/functions.h"
#include "core/math/table.h"
#include "core/vehicle/drag.h"

namespace dispersa {
namespace {

// The columns of a table, one row a grid point. Those that may be missing are empty then.
struct AeroRows {
  std::vector<double> mach, incidence_rad, alpha_rad, beta_rad, ca, cn, cy, xcp_station_m, cm, cmq_per_rad,
      clp_per_rad, ca_power_off;
  std::vector<double> ca_uncertainty, cn_uncertainty, xcp_uncertainty_m;
  std::vector<double> xcp_side_station_m, cln, cnr_per_rad;
  std::vector<std::size_t> file_row;  // of a row, where some were taken out
  bool of_yaw_plane = false;
  bool has_own_damping = false;  // of the yaw plane

  bool has_yaw_plane() const { return !xcp_side_station_m.empty() || !cln.empty(); }
  std::string Index(std::size_t row) const {
    return "[" + std::to_string(file_row.empty() ? row : file_row[row]) + "]";
  }
  const char* angle() const { return of_yaw_plane ? "beta" : alpha_rad.empty() ? "incidence" : "alpha"; }
  // Columns that have another name in the yaw plane.
  const char* normal() const { return of_yaw_plane ? "cy" : "cn"; }
  const char* place() const { return of_yaw_plane ? "xcp_side_station_m" : "xcp_station"; }
  const char* moment() const { return of_yaw_plane ? "cln" : "cm"; }
};

// A table's rows, and those of its planes.
struct AeroFile {
  AeroRows all, pitch, yaw;
};

// The uncertainties of all rows.
struct SameUncertainty {
  std::optional<double> ca, cn, xcp_m, damping;
};

constexpr const char* kOfCoefficient = "standard deviation, or three (uncertainty_is)";

void Describe(Fields& fields, AeroRows& rows) {
  fields.Numbers("mach", kNonNegative, 4, SIZE_MAX, rows.mach,
                 "increasing; equal in the block of rows of one Mach number");
  fields.OptionalQuantities("incidence", kAngle, Between(-kHalfTurn, kHalfTurn), 4, SIZE_MAX,
                            rows.incidence_rad,
                            "increasing, the same for each Mach number; a signed table is folded");
  fields.OptionalQuantities("alpha", kAngle, Between(-kHalfTurn, kHalfTurn), 4, SIZE_MAX, rows.alpha_rad,
                            "angle of attack, with beta and cy, in place of incidence");
  fields.OptionalQuantities("beta", kAngle, Between(-kQuarterTurn, kQuarterTurn), 4, SIZE_MAX, rows.beta_rad,
                            "sideslip; rows of 0 are needed");
  fields.OptionalNumbers("cy", kAnyNumber, 4, SIZE_MAX, rows.cy, "side force, to the right");
  fields.OptionalQuantities("xcp_side_station", kLength, kAnyNumber, 4, SIZE_MAX, rows.xcp_side_station_m,
                            "where cy acts");
  fields.OptionalNumbers("cln", kAnyNumber, 4, SIZE_MAX, rows.cln, "yawing moment, nose right");
  fields.OptionalNumbers("cnr_per_rad", kAnyNumber, 4, SIZE_MAX, rows.cnr_per_rad,
                         "yaw damping; default: cmq_per_rad");
  fields.Numbers("ca", kAnyNumber, 4, SIZE_MAX, rows.ca, "axial force coefficient, motor burning");
  fields.Numbers("cn", kAnyNumber, 4, SIZE_MAX, rows.cn, "normal force");
  fields.OptionalQuantities("xcp_station", kLength, kAnyNumber, 4, SIZE_MAX, rows.xcp_station_m,
                            "where the normal force acts; or cm in its place");
  fields.OptionalNumbers("cm", kAnyNumber, 4, SIZE_MAX, rows.cm,
                         "pitching moment, nose up, about moment_reference_station_*");
  fields.OptionalNumbers("cmq_per_rad", kAnyNumber, 4, SIZE_MAX, rows.cmq_per_rad,
                         "pitch and yaw damping about the centre of gravity, on q d / (2 V), by Mach number; "
                         "default: from the profile");
  fields.OptionalNumbers("clp_per_rad", kAnyNumber, 4, SIZE_MAX, rows.clp_per_rad,
                         "roll damping, on p d / (2 V), by Mach number; default: from the profile");
  fields.OptionalNumbers("ca_power_off", kAnyNumber, 4, SIZE_MAX, rows.ca_power_off,
                         "axial force, motor out; default: ca");
  fields.OptionalQuantities("ca_uncertainty", kShare, kNonNegative, 4, SIZE_MAX, rows.ca_uncertainty,
                            kOfCoefficient);
  fields.OptionalQuantities("cn_uncertainty", kShare, kNonNegative, 4, SIZE_MAX, rows.cn_uncertainty,
                            kOfCoefficient);
  fields.OptionalQuantities("xcp_uncertainty", kLength, kNonNegative, 4, SIZE_MAX, rows.xcp_uncertainty_m,
                            kOfCoefficient);
}

// Which rows of a table over alpha and beta make a table over the incidence.
enum class AeroPlane { kPitch, kYaw };

bool AnglesGoTogether(Fields& fields, const AeroRows& all) {
  if (all.alpha_rad.empty() && all.beta_rad.empty() && all.cy.empty() && !all.has_yaw_plane()) {
    if (!all.cnr_per_rad.empty()) {
      fields.Refuse("cnr_per_rad", "is not that of a body of revolution",
                    "cmq_per_rad, or beside it cy with xcp_side_station_m or cln");
      return false;
    }
    if (!all.incidence_rad.empty()) return true;
    fields.Refuse("", "missing column 'incidence_deg', or 'alpha_deg' with 'beta_deg' and 'cy'",
                  "total incidence, or angles of attack and of sideslip with the side force");
    return false;
  }
  if (!all.incidence_rad.empty() || all.alpha_rad.empty() || all.beta_rad.empty() || all.cy.empty()) {
    fields.Refuse("", "the angles do not go together", "incidence_*; or alpha_* with beta_* and cy");
    return false;
  }
  if (all.has_yaw_plane()) {
    if (all.xcp_station_m.empty() == all.xcp_side_station_m.empty() && all.cm.empty() == all.cln.empty())
      return true;
    fields.Refuse("", "the places of cn and cy do not go together",
                  "xcp_station_* with xcp_side_station_m, or cm with cln");
    return false;
  }
  if (all.cnr_per_rad.empty()) return true;
  fields.Refuse("cnr_per_rad", "is not that of a body of revolution",
                "cmq_per_rad, or beside it cy with xcp_side_station_m or cln");
  return false;
}

// Alpha and beta with cn and cy in body axes in place of the incidence: the rows without sideslip make the
// table of the pitch plane, those without an angle of attack the one of the yaw plane. There -cy is the
// normal force.
bool TakePlane(Fields& fields, const AeroRows& all, AeroPlane plane, AeroRows& rows) {
  if (all.alpha_rad.empty()) {
    rows = all;
    return true;
  }
  const std::size_t count = all.mach.size();
  const bool of_yaw = plane == AeroPlane::kYaw;
  rows = {};
  rows.of_yaw_plane = of_yaw;
  rows.alpha_rad = all.alpha_rad;  // says which columns the file has
  const std::vector<double>& across = of_yaw ? all.alpha_rad : all.beta_rad;
  struct Column {
    const std::vector<double>& from;
    std::vector<double>& to;
    double sign;
  };
  rows.has_own_damping = of_yaw && !all.cnr_per_rad.empty();
  const Column columns[] = {{all.mach, rows.mach, 1.0},
                            {of_yaw ? all.beta_rad : all.alpha_rad, rows.incidence_rad, 1.0},
                            {all.ca, rows.ca, 1.0},
                            {of_yaw ? all.cy : all.cn, rows.cn, of_yaw ? -1.0 : 1.0},
                            {of_yaw ? all.xcp_side_station_m : all.xcp_station_m, rows.xcp_station_m, 1.0},
                            {of_yaw ? all.cln : all.cm, rows.cm, of_yaw ? -1.0 : 1.0},
                            {rows.has_own_damping ? all.cnr_per_rad : all.cmq_per_rad, rows.cmq_per_rad, 1.0},
                            {all.clp_per_rad, rows.clp_per_rad, 1.0},
                            {all.ca_power_off, rows.ca_power_off, 1.0},
                            {all.ca_uncertainty, rows.ca_uncertainty, 1.0},
                            {all.cn_uncertainty, rows.cn_uncertainty, 1.0},
                            {all.xcp_uncertainty_m, rows.xcp_uncertainty_m, 1.0}};
  for (const Column& column : columns) {
    if (column.from.empty()) continue;
    if (column.from.size() != count || all.beta_rad.size() != count || all.alpha_rad.size() != count ||
        all.cy.size() != count) {
      fields.Refuse("", "the columns have different lengths", "one value a row in each column");
      return false;
    }
    for (std::size_t row = 0; row < count; ++row)
      if (across[row] == 0.0) column.to.push_back(column.sign * column.from[row]);
  }
  for (std::size_t row = 0; row < count; ++row)
    if (across[row] == 0.0) rows.file_row.push_back(row);
  if (rows.mach.size() >= 4) return true;
  if (of_yaw)
    fields.Refuse("alpha", "has fewer than four rows without an angle of attack",
                  "alpha of 0 beside the others: the yaw plane");
  else
    fields.Refuse("beta", "has fewer than four rows without sideslip", "beta of 0 beside the others");
  return false;
}

// A coefficient of a plane, and the greatest of its Mach number.
struct PlaneTable {
  Table2D ca, cn, xcp_station_m;
  const std::vector<double>& incidence_rad;

  explicit PlaneTable(const AeroTable& of)
      : ca{of.mach, of.incidence_rad, of.ca},
        cn{of.mach, of.incidence_rad, of.cn},
        xcp_station_m{of.mach, of.incidence_rad, of.xcp_station_m},
        incidence_rad(of.incidence_rad) {}
  double Greatest(const Table2D& of, double mach) const {
    double greatest = 0.0;
    for (double at : incidence_rad) greatest = std::max(greatest, std::fabs(of(mach, at)));
    return greatest;
  }
};

// Rows with both angles against the tables of the planes: with u, v, w the direction of flight in body axes,
// cn is towards -z and cy towards y. `prefix`: of the columns' path. `reference_m`: of cm and cln.
void CheckSideslip(Fields& fields, const std::string& prefix, const AeroRows& all, double reference_m,
                   const AeroTable& table) {
  const bool is_round = table.yaw_plane.empty();
  const PlaneTable pitch(table), yaw(is_round ? table : table.yaw_plane.front());
  for (std::size_t row = 0; row < all.beta_rad.size(); ++row) {
    if (all.beta_rad[row] == 0.0 || (!is_round && all.alpha_rad[row] == 0.0)) continue;
    const SinCos a = SineCosine(all.alpha_rad[row]), b = SineCosine(all.beta_rad[row]);
    const double u = a.cos * b.cos, v = b.sin, w = a.sin * b.cos;
    const double across = Sqrt(v * v + w * w), incidence = Atan2(across, u);
    // Beyond the rows of a plane there is nothing to compare with.
    const bool in_pitch = incidence <= pitch.incidence_rad.back(),
               in_yaw = incidence <= yaw.incidence_rad.back();
    const double mach = all.mach[row], n_y = v / across, n_z = w / across;
    const double axial = pitch.ca(mach, incidence) * n_z * n_z + yaw.ca(mach, incidence) * n_y * n_y;
    const double greatest_ca = std::max(pitch.Greatest(pitch.ca, mach), yaw.Greatest(yaw.ca, mach));
    const double greatest_cn = pitch.Greatest(pitch.cn, mach), greatest_cy = yaw.Greatest(yaw.cn, mach);
    const auto differs = [](double given, double expected, double greatest) {
      return std::fabs(given - expected) > kSideslipTolerance * greatest;
    };
    // By the force of the row itself: its error has been looked at.
    const auto displaced = [&](const std::vector<double>& places_m, const std::vector<double>& moments,
                               double normal, const PlaneTable& plane, double greatest) {
      if (is_round) return false;
      const double expected_m = plane.xcp_station_m(mach, incidence);
      const double sign = &plane == &yaw ? -1.0 : 1.0;  // cln and cy have opposite signs to cm and cn
      const double moment_m = places_m.empty() ? sign * moments[row] * table.reference_length_m
                                               : normal * (reference_m - places_m[row]);
      return differs(moment_m, normal * (reference_m - expected_m), greatest * table.reference_length_m);
    };
    const double normal = all.cn[row], side = all.cy[row];
    // The first column that differs.
    const char* column = in_pitch && in_yaw && differs(all.ca[row], axial, greatest_ca)              ? "ca"
                         : in_pitch && differs(normal, pitch.cn(mach, incidence) * n_z, greatest_cn) ? "cn"
                         : in_yaw && differs(side, -yaw.cn(mach, incidence) * n_y, greatest_cy)      ? "cy"
                         : in_pitch && displaced(all.xcp_station_m, all.cm, normal, pitch, greatest_cn)
                             ? (all.cm.empty() ? "xcp_station" : "cm")
                         : in_yaw && displaced(all.xcp_side_station_m, all.cln, -side, yaw, greatest_cy)
                             ? (all.cln.empty() ? "xcp_side_station_m" : "cln")
                             : nullptr;
    if (column == nullptr) continue;
    const std::string path = prefix + column + "[" + std::to_string(row) + "]";
    if (is_round)
      return fields.Refuse(path, "is not that of the same total incidence without sideslip",
                           "a body of revolution: within 5 % of the greatest of the Mach number; or "
                           "xcp_side_station_m or cln, of a body with two planes of symmetry");
    return fields.Refuse(path, "is not what the rows of the pitch plane and of the yaw plane give together",
                         "a body with two planes of symmetry: within 5 % of the greatest of the Mach number; "
                         "or rows of the planes alone");
  }
}

// The rows, mach by mach with the same incidences each, to the grid.
bool FillGrid(Fields& fields, const AeroRows& rows, AeroTable& table) {
  const std::size_t count = rows.mach.size();
  for (const auto* column : {&rows.incidence_rad, &rows.ca, &rows.cn, &rows.xcp_station_m, &rows.cm,
                             &rows.cmq_per_rad, &rows.clp_per_rad, &rows.ca_power_off, &rows.ca_uncertainty,
                             &rows.cn_uncertainty, &rows.xcp_uncertainty_m}) {
    const bool is_needed = column == &rows.incidence_rad || column == &rows.ca || column == &rows.cn;
    if (column->size() == count || (column->empty() && !is_needed)) continue;
    fields.Refuse("", "the columns have different lengths", "one value a row in each column");
    return false;
  }
  if (rows.xcp_station_m.empty() == rows.cm.empty()) {
    fields.Refuse(
        "",
        rows.cm.empty() ? "missing column 'xcp_station_m' or 'cm'" : "'xcp_station' and 'cm' are both given",
        "the centre of pressure, or cm about the table's moment_reference_station_*");
    return false;
  }
  const std::size_t incidences =
      static_cast<std::size_t>(std::find_if(rows.mach.begin(), rows.mach.end(),
                                            [&](double value) { return value != rows.mach.front(); }) -
                               rows.mach.begin());
  table.incidence_rad.assign(rows.incidence_rad.begin(),
                             rows.incidence_rad.begin() + static_cast<std::ptrdiff_t>(incidences));
  const auto changes = [](const std::vector<double>& column, std::size_t row) {
    return !column.empty() && column[row] != column[row - 1];
  };
  for (std::size_t row = 0; row < count; ++row) {
    const std::string index = rows.Index(row);
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
      return false;
    }
    if (!starts_mach && (changes(rows.cmq_per_rad, row) || changes(rows.clp_per_rad, row))) {
      fields.Refuse((changes(rows.clp_per_rad, row) ? "clp_per_rad"
                     : rows.has_own_damping         ? "cnr_per_rad"
                                                    : "cmq_per_rad") +
                        index,
                    "the rate damping changes with incidence",
                    "the same cmq_per_rad and clp_per_rad in all rows of a mach number");
      return false;
    }
    if (!starts_mach) continue;
    table.mach.push_back(rows.mach[row]);
    if (!rows.cmq_per_rad.empty()) table.cmq_per_rad.push_back(rows.cmq_per_rad[row]);
    if (!rows.clp_per_rad.empty()) table.clp_per_rad.push_back(rows.clp_per_rad[row]);
  }
  table.ca = rows.ca;
  table.cn = rows.cn;
  table.xcp_station_m = rows.xcp_station_m;
  table.ca_power_off = rows.ca_power_off;
  table.uncertainty.ca = rows.ca_uncertainty;
  table.uncertainty.cn = rows.cn_uncertainty;
  table.uncertainty.xcp_m = rows.xcp_uncertainty_m;
  return true;
}

double GreatestAt(const AeroTable& table, const std::vector<double>& values, std::size_t mach) {
  double greatest = 0.0;
  for (std::size_t i = 0; i < table.incidence_rad.size(); ++i)
    greatest = std::max(greatest, std::fabs(values[table.RowOf(mach, i)]));
  return greatest;
}

// Folds a signed table to incidences from 0 on.
bool Fold(Fields& fields, AeroRows& rows, AeroTable& table) {
  const std::vector<double> all = table.incidence_rad;
  const std::size_t count = all.size();
  const std::size_t first =
      static_cast<std::size_t>(std::lower_bound(all.begin(), all.end(), 0.0) - all.begin());
  if (first == 0) return true;
  // The row of an incidence's mirror image, or none.
  const auto mirror = [&](std::size_t i) -> std::optional<std::size_t> {
    const auto found = std::find(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(first), -all[i]);
    if (found == all.begin() + static_cast<std::ptrdiff_t>(first)) return std::nullopt;
    return static_cast<std::size_t>(found - all.begin());
  };
  for (std::size_t i = 0; i < first; ++i) {
    if (std::find(all.begin(), all.end(), -all[i]) != all.end()) continue;
    fields.Refuse(rows.angle() + rows.Index(i), "has no row of the opposite incidence",
                  "for each incidence below 0 the same above, or incidences from 0 on");
    return false;
  }
  const AeroTable whole = table;
  struct Column {
    std::vector<double>* values;
    double sign;
    const char* name;
  };
  // Where the force acts is even where it is given itself.
  Column columns[] = {{&table.ca, 1.0, "ca"},
                      {&table.cn, -1.0, rows.normal()},
                      {&table.xcp_station_m, 1.0, rows.place()},
                      {&rows.cm, -1.0, rows.moment()},
                      {&table.ca_power_off, 1.0, "ca_power_off"},
                      {&table.uncertainty.ca, 1.0, "ca_uncertainty"},
                      {&table.uncertainty.cn, 1.0, "cn_uncertainty"},
                      {&table.uncertainty.xcp_m, 1.0, "xcp_uncertainty"}};
  for (const Column& column : columns) {
    const std::vector<double> values = *column.values;
    if (values.empty()) continue;
    column.values->clear();
    for (std::size_t m = 0; m < table.mach.size(); ++m) {
      const double allowed = kFoldTolerance * GreatestAt(whole, values, m);
      for (std::size_t i = first; i < count; ++i) {
        const double own = values[m * count + i];
        const std::optional<std::size_t> other = mirror(i);
        const double mirrored = other ? column.sign * values[m * count + *other] : own;
        if (std::fabs(own - mirrored) > allowed) {
          fields.Refuse(column.name + rows.Index(m * count + i), "is not that of the opposite incidence",
                        "a vehicle whose coefficients mirror within 2 % of the greatest of the Mach number");
          return false;
        }
        column.values->push_back(0.5 * (own + mirrored));
      }
    }
  }
  table.incidence_rad.assign(all.begin() + static_cast<std::ptrdiff_t>(first), all.end());
  std::vector<std::size_t> file_row;
  for (std::size_t m = 0; m < table.mach.size(); ++m)
    for (std::size_t i = first; i < count; ++i)
      file_row.push_back(rows.file_row.empty() ? m * count + i : rows.file_row[m * count + i]);
  rows.file_row = file_row;
  if (table.incidence_rad.size() >= 2) return true;
  fields.Refuse(rows.angle(), "has fewer than two from 0 on", "two or more incidences from 0 on");
  return false;
}

// The centre of pressure of a table by moments.
void PlaceForce(Fields& fields, const AeroRows& rows, double reference_m, AeroTable& table) {
  const std::vector<double>& cm = rows.cm;
  constexpr double kNoForce = 1e-6, kNoMoment = 1e-3;
  const std::size_t incidences = table.incidence_rad.size();
  table.xcp_station_m.assign(cm.size(), 0.0);
  for (std::size_t m = 0; m < table.mach.size(); ++m) {
    const double least_cn = kNoForce * GreatestAt(table, table.cn, m);
    const double least_cm = kNoMoment * GreatestAt(table, cm, m);
    const auto has_force = [&](std::size_t i) {
      return std::fabs(table.cn[table.RowOf(m, i)]) > least_cn && table.incidence_rad[i] != 0.0;
    };
    std::optional<double> nearest;
    for (std::size_t i = 0; i < incidences && !nearest; ++i) {
      const std::size_t row = table.RowOf(m, i);
      if (has_force(i)) nearest = reference_m - table.reference_length_m * cm[row] / table.cn[row];
    }
    for (std::size_t i = 0; i < incidences; ++i) {
      const std::size_t row = table.RowOf(m, i);
      if (has_force(i)) {
        nearest = reference_m - table.reference_length_m * cm[row] / table.cn[row];
      } else if (std::fabs(cm[row]) > least_cm) {
        fields.Refuse(std::string("table.") + rows.moment() + rows.Index(row),
                      "is a moment without a normal force",
                      "0 where " + std::string(rows.normal()) +
                          " is 0 (at an incidence of 0 a body of revolution has neither)");
        return;
      }
      table.xcp_station_m[row] = nearest.value_or(reference_m);
    }
  }
}

void Spread(const std::optional<double>& same, std::size_t count, std::vector<double>& values) {
  if (same && values.empty()) values.assign(count, *same);
}

// In standard deviations. `is_of_three`: they are given as three.
void SetUncertainty(const SameUncertainty& same, bool is_of_three, AeroTable& table) {
  AeroUncertainty& uncertainty = table.uncertainty;
  Spread(same.ca, table.ca.size(), uncertainty.ca);
  Spread(same.cn, table.ca.size(), uncertainty.cn);
  Spread(same.xcp_m, table.ca.size(), uncertainty.xcp_m);
  Spread(same.damping, table.mach.size(), uncertainty.damping);
  if (!is_of_three) return;
  for (auto* values : {&uncertainty.ca, &uncertainty.cn, &uncertainty.xcp_m, &uncertainty.damping})
    for (double& value : *values) value /= 3.0;
}

void AddBaseDrag(double base_area_m2, AeroTable& table) {
  for (std::size_t m = 0; m < table.mach.size(); ++m)
    for (std::size_t i = 0; i < table.incidence_rad.size(); ++i)
      table.ca_power_off.push_back(table.ca[table.RowOf(m, i)] +
                                   BaseDrag(table.mach[m]) * base_area_m2 / table.reference_area_m2);
}

// What is not in the columns of one table.
void DescribeOne(Fields& fields, AeroTable& table) {
  fields.Quantity("reference_area", kArea, kPositive, table.reference_area_m2, "of the coefficients");
  fields.Quantity("reference_length", kLength, kPositive, table.reference_length_m,
                  "of the damping terms and of cm: the diameter");
  std::optional<double> reference_m, base_area_m2;
  fields.OptionalQuantity("moment_reference_station", kLength, kAnyNumber, reference_m, "of cm");
  fields.OptionalQuantity("base_area", kArea, kPositive, base_area_m2,
                          "adds its base drag to ca with the motor out");
  SameUncertainty same;
  fields.OptionalQuantity("ca_uncertainty", kShare, kNonNegative, same.ca, "of ca in all rows");
  fields.OptionalQuantity("cn_uncertainty", kShare, kNonNegative, same.cn, "of cn");
  fields.OptionalQuantity("xcp_uncertainty", kLength, kNonNegative, same.xcp_m, "of the centre of pressure");
  fields.OptionalQuantity("damping_uncertainty", kShare, kNonNegative, same.damping, "of cmq and clp");
  // The word is needed where there is an uncertainty.
  std::size_t is_of = 0;
  fields.Choice<std::size_t>("uncertainty_is", {{"none", 0}, {"sigma", 1}, {"three_sigma", 2}}, is_of,
                             "the uncertainties are one standard deviation, or three", 0);
  const auto rows = std::make_shared<AeroFile>();  // a Check outlives this function
  fields.Table("table", "a CSV file", "a CSV file: a full grid, Mach by Mach", [&](Fields& columns) {
    Describe(columns, rows->all);
    columns.Check([&] {
      if (!AnglesGoTogether(columns, rows->all)) return;
      const auto read = [&](AeroPlane plane, AeroRows& of, AeroTable& to) {
        return TakePlane(columns, rows->all, plane, of) && FillGrid(columns, of, to) && Fold(columns, of, to);
      };
      if (!read(AeroPlane::kPitch, rows->pitch, table)) return;
      if (rows->all.has_yaw_plane() && !read(AeroPlane::kYaw, rows->yaw, table.yaw_plane.emplace_back()))
        return;
      // Of moments about a reference the place is still to come.
      if (table.yaw_plane.empty() || rows->all.cm.empty()) CheckSideslip(columns, "", rows->all, 0.0, table);
    });
  });
  fields.Check([&fields, &table, rows, reference_m, base_area_m2, same, is_of] {
    const AeroUncertainty& own = table.uncertainty;
    if ((same.ca && !own.ca.empty()) || (same.cn && !own.cn.empty()) || (same.xcp_m && !own.xcp_m.empty()))
      fields.Refuse("table", "has the column of an uncertainty that is also given for all rows",
                    "one of the two");
    SetUncertainty(same, is_of == 2, table);
    for (AeroTable& yaw : table.yaw_plane) SetUncertainty(same, is_of == 2, yaw);
    if (own.empty() != (is_of == 0))
      fields.Refuse(is_of == 0 ? "" : "uncertainty_is",
                    is_of == 0 ? "missing key 'uncertainty_is'" : "there is no uncertainty",
                    is_of == 0 ? "sigma, or three_sigma" : "none, or an uncertainty of the table");
    table.is_by_moment = !rows->all.cm.empty();
    if (table.is_by_moment != reference_m.has_value())
      fields.Refuse(
          table.is_by_moment ? "" : "moment_reference_station",
          table.is_by_moment ? "missing key 'moment_reference_station_m'" : "the table has no column cm",
          table.is_by_moment ? "the station about which the table's cm is" : "a table with cm");
    if (table.is_by_moment) PlaceForce(fields, rows->pitch, reference_m.value_or(0.0), table);
    for (AeroTable& yaw : table.yaw_plane) {
      yaw.reference_area_m2 = table.reference_area_m2;
      yaw.reference_length_m = table.reference_length_m;
      yaw.is_by_moment = table.is_by_moment;
      if (!yaw.is_by_moment) continue;
      PlaceForce(fields, rows->yaw, reference_m.value_or(0.0), yaw);
      CheckSideslip(fields, "table.", rows->all, reference_m.value_or(0.0), table);
    }
    if (!base_area_m2) return;
    if (!table.ca_power_off.empty())
      return fields.Refuse("base_area", "is given beside the table's ca_power_off", "one of the two");
    AddBaseDrag(*base_area_m2, table);
    for (AeroTable& yaw : table.yaw_plane) AddBaseDrag(*base_area_m2, yaw);
  });
}

}  // namespace

void Describe(Fields& fields, AeroTable& table) {
  DescribeOne(fields, table);
  fields.List("lighter", 0, 16, table.lighter, "tables of the stack after bodies have left",
              [](Fields& lighter, AeroConfiguration& configuration) {
                lighter.Texts("without", 1, 9, configuration.without,
                              "names of the bodies that have left, or boosters");
                DescribeOne(lighter, configuration.table);
              });
}

AeroTable Drawn(const AeroTable& table, const AeroSigmas& sigmas) {
  AeroTable drawn = table;
  const AeroUncertainty& uncertainty = table.uncertainty;
  const auto scale = [](const std::vector<double>& parts, double by, std::vector<double>& values) {
    for (std::size_t i = 0; i < values.size() && i < parts.size(); ++i) values[i] *= 1.0 + by * parts[i];
  };
  scale(uncertainty.ca, sigmas.ca, drawn.ca);
  scale(uncertainty.ca, sigmas.ca, drawn.ca_power_off);
  scale(uncertainty.cn, sigmas.cn, drawn.cn);
  scale(uncertainty.damping, sigmas.damping, drawn.cmq_per_rad);
  scale(uncertainty.damping, sigmas.damping, drawn.clp_per_rad);
  for (std::size_t i = 0; i < uncertainty.xcp_m.size(); ++i)
    drawn.xcp_station_m[i] += sigmas.xcp * uncertainty.xcp_m[i];
  for (AeroTable& yaw : drawn.yaw_plane) yaw = Drawn(yaw, sigmas);
  for (AeroConfiguration& lighter : drawn.lighter) lighter.table = Drawn(lighter.table, sigmas);
  return drawn;
}

bool IsUncertain(const AeroTable& table) {
  return !table.uncertainty.empty() ||
         std::any_of(table.lighter.begin(), table.lighter.end(),
                     [](const AeroConfiguration& lighter) { return !lighter.table.uncertainty.empty(); });
}

}  // namespace dispersa
