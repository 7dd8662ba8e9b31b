#include <algorithm>

#include "core/vehicle/vehicle.h"

namespace dispersa {
namespace {

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

// Limits, sensors, beam, nozzles and descent: what changes a flight, and not the trajectory of a point mass.
void DescribeBesideTrajectory(Fields& fields, Vehicle& vehicle) {
  bool has_limits = true;
  fields.OptionalMap("limits", has_limits, "of the structure; if any is given, they become a requirement",
                     [&](Fields& limits) { Describe(limits, vehicle.limits); });
  bool has_loss = true;
  fields.OptionalMap("loss_of_control", has_loss, "of a controlled stage",
                     [&](Fields& loss) { Describe(loss, vehicle.loss_of_control); });
  bool has_descent = true;
  fields.OptionalMap("descent", has_descent, "of the last stage, where a flight ends at impact",
                     [&](Fields& descent) { Describe(descent, vehicle.descent); });
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

}  // namespace

void Describe(Fields& fields, Vehicle& vehicle) {
  DescribePlainKeys(fields, vehicle);
  fields.List("stages", 1, kMaxStages, vehicle.stages, "in the order of flight");
  CheckRestarts(fields, vehicle.stages);
  bool has_boosters = vehicle.boosters.count > 0;
  fields.OptionalMap(
      "boosters", has_boosters,
      "beside the first stage, in its lift-off mass; each with its own motor and propellant; computed "
      "aerodynamics leave them out",
      [&](Fields& boosters) { Describe(boosters, vehicle.boosters); });
  fields.List("profile", 1, SIZE_MAX, vehicle.profile, "outer mould line, from the nose aft");
  bool has_tables = !vehicle.aerodynamics.empty();
  fields.OptionalMap("aerodynamics", has_tables, "replaces coefficients computed from the profile",
                     [&](Fields& aerodynamics) {
                       aerodynamics.List("tables", 1, kMaxStages, vehicle.aerodynamics, "one per stack");
                     });
  // A single stage has no coast, and where nothing is controlled no coast is.
  const bool is_controlled = std::any_of(vehicle.stages.begin(), vehicle.stages.end(),
                                         [](const Stage& stage) { return stage.is_controlled(); });
  bool has_thrusters = vehicle.reaction_control.thrust_n > 0.0;
  fields.OptionalMap("reaction_control", has_thrusters,
                     "cold-gas thrusters of the last stage; a single stage with nozzles for roll needs none",
                     [&](Fields& control) { Describe(control, vehicle.reaction_control); });
  if (!has_thrusters && is_controlled && vehicle.stages.size() > 1)
    fields.Refuse("", "missing key 'reaction_control'", "a map");
  bool has_rail = vehicle.rail.has_value();
  fields.OptionalMap("rail", has_rail, "launcher rail",
                     [&](Fields& rail) { Describe(rail, vehicle.rail.emplace()); });
  if (!has_rail) vehicle.rail.reset();
  fields.Deciding(Decides::kFlightOnly, [&] { DescribeBesideTrajectory(fields, vehicle); });
}

}  // namespace dispersa
