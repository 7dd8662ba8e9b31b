#include <algorithm>

#include "core/vehicle/vehicle.h"

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

// Only a stage with a liquid engine can burn again.
void CheckRestarts(Fields& fields, const std::vector<Stage>& stages) {
  bool is_liquid = false;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    if (!stages[i].restarts)
      is_liquid = stages[i].is_liquid();
    else if (!is_liquid)
      fields.Refuse("stages[" + std::to_string(i) + "].restarts",
                    i == 0 ? "there is no stage before" : "the stage before has no liquid engine",
                    "restarts: true after a stage with motor: {liquid: {...}}");
  }
}

// What turns of one nozzle: an entry a stage in a list of the vehicle's, or none.
void DescribeTurningNozzles(Fields& fields, std::vector<Stage>& stages) {
  std::vector<Gimbal> turning;
  fields.List("nozzles", 0, kMaxStages, turning,
              "turning part of one nozzle, one entry per stage. Default: nozzles without inertia",
              [](Fields& nozzle, Gimbal& gimbal) { DescribeTurningNozzle(nozzle, gimbal); });
  if (turning.empty()) return;
  if (turning.size() != stages.size()) {
    fields.Refuse("nozzles",
                  "the list has " + std::to_string(turning.size()) + ", the vehicle " +
                      std::to_string(stages.size()) + " stages",
                  "one entry a stage, or none");
    return;
  }
  for (std::size_t i = 0; i < stages.size(); ++i) {
    stages[i].gimbal.nozzle_mass_kg = turning[i].nozzle_mass_kg;
    stages[i].gimbal.nozzle_cg_m = turning[i].nozzle_cg_m;
    stages[i].gimbal.nozzle_inertia_kg_m2 = turning[i].nozzle_inertia_kg_m2;
  }
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

void Describe(Fields& fields, Vehicle& vehicle) {
  DescribePlainKeys(fields, vehicle);
  fields.List("stages", 1, kMaxStages, vehicle.stages, "in the order of flight");
  CheckRestarts(fields, vehicle.stages);
  bool has_boosters = vehicle.boosters.count > 0;
  fields.OptionalMap("boosters", has_boosters,
                     "solid motors beside the first stage, ignited with it, in its lift-off mass; computed "
                     "aerodynamics leave them out",
                     [&](Fields& boosters) { Describe(boosters, vehicle.boosters); });
  fields.List("profile", 1, SIZE_MAX, vehicle.profile, "outer mould line, from the nose aft");
  bool has_tables = !vehicle.aerodynamics.empty();
  fields.OptionalMap("aerodynamics", has_tables, "replaces coefficients computed from the profile",
                     [&](Fields& aerodynamics) {
                       aerodynamics.List("tables", 1, kMaxStages, vehicle.aerodynamics, "one per stack");
                     });
  // A single stage has no coast.
  bool has_thrusters = vehicle.reaction_control.thrust_n > 0.0;
  fields.OptionalMap("reaction_control", has_thrusters,
                     "cold-gas thrusters of the last stage; a single stage with nozzles for roll needs none",
                     [&](Fields& control) { Describe(control, vehicle.reaction_control); });
  if (!has_thrusters && vehicle.stages.size() > 1)
    fields.Refuse("", "missing key 'reaction_control'", "a map");
  bool has_limits = true;
  fields.OptionalMap("limits", has_limits, "of the structure; if any is given, they become a requirement",
                     [&](Fields& limits) { Describe(limits, vehicle.limits); });
  DescribeTurningNozzles(fields, vehicle.stages);
  bool has_sensors = true;
  fields.OptionalMap("sensors", has_sensors, "of attitude and rates; a flexible vehicle needs them",
                     [&](Fields& sensors) { Describe(sensors, vehicle.sensors); });
  bool bends = vehicle.structure_beam.has_value();
  fields.OptionalMap("structure_beam", bends, "elastic beam; default: a rigid vehicle", [&](Fields& beam) {
    const auto bodies = std::count_if(vehicle.stages.begin(), vehicle.stages.end(),
                                      [](const Stage& stage) { return !stage.restarts; });
    Describe(beam, vehicle.structure_beam.emplace(), vehicle.stages.size(), static_cast<std::size_t>(bodies));
  });
  if (!has_sensors && bends && vehicle.structure_beam->flown_modes > 0)
    fields.Refuse("", "missing key 'sensors'",
                  "where the sensors of a vehicle that bends are: sensors: {inertial_unit: {station_m: x}}");
}

}  // namespace dispersa
