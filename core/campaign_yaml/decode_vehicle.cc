#include <algorithm>
#include <cmath>

#include "core/campaign_yaml/decode.h"
#include "core/campaign_yaml/describe_file.h"
#include "core/input/base_file.h"
#include "core/input/number_text.h"
#include "core/input/struct_problems.h"
#include "core/vehicle/cut_off.h"
#include "core/vehicle/mass.h"
#include "core/vehicle/plausibility.h"
#include "core/vehicle/propulsion.h"

namespace dispersa {
namespace {

using ProblemList = std::vector<InputProblem>;

// What a motor's description leaves open: its curve decides thrust and time, an engine's specific impulse the
// time.
void CompleteMotor(double propellant_kg, Motor& motor) {
  if (!motor.thrust_curve.empty()) SetThrustCurve(std::move(motor.thrust_curve), motor);
  if (motor.specific_impulse_s > 0.0)
    motor.burning_time_s = propellant_kg * motor.specific_impulse_s * kStandardGravity / motor.thrust_n;
}

// Another burn of the stage before: its body, and what its engine is commanded now. `before` gives up what it
// would jettison, which stays on until the last burn has ended.
Stage BurnAgain(const Stage& commands, Stage& before) {
  Stage stage = before;
  before.jettisoned.clear();
  stage.restarts = true;
  stage.name = commands.name;
  stage.motor.throttle = commands.motor.throttle;
  stage.motor.cut_off = commands.motor.cut_off;
  stage.motor.cut_off_s = commands.motor.cut_off_s;
  stage.motor.cut_off_velocity_m_s = commands.motor.cut_off_velocity_m_s;
  stage.ignition = commands.ignition;
  stage.ignition_delay_s = commands.ignition_delay_s;
  stage.separation_delay_s = commands.separation_delay_s;
  // What the burn before leaves; of a cut-off by velocity a flight tells, and until then all stands for it.
  const Motor& first = before.motor;
  if (EndsAtSpeed(first) || !(first.thrust_n > 0.0 && first.burning_time_s > 0.0)) return stage;
  const double left = BuildBurn(before, 1.0, 1.0).left_kg / before.propellant_mass_kg;
  stage.liftoff_mass_kg -= (1.0 - left) * before.propellant_mass_kg;
  stage.propellant_mass_kg *= left;
  stage.motor.burning_time_s *= left;
  for (Tank& tank : stage.tanks) tank.propellant_mass_kg *= left;
  return stage;
}

// A restart bends as its stage does: the file has an entry for each stage but restarts.
void CompleteBeam(const std::vector<Stage>& stages, std::vector<BeamStage>& beam) {
  if (beam.empty()) return;  // a table of modes
  for (std::size_t i = 1; i < stages.size(); ++i)
    if (stages[i].restarts) beam.insert(beam.begin() + static_cast<std::ptrdiff_t>(i), beam[i - 1]);
}

// Tables of masses over propellant, and their sums. A restart has those of its stage.
void CompleteMassTables(Vehicle& vehicle) {
  for (std::size_t i = 0; i < vehicle.stages.size(); ++i) {
    Stage& stage = vehicle.stages[i];
    if (stage.restarts) {
      if (i > 0) stage.flown_mass = vehicle.stages[i - 1].flown_mass;
      continue;
    }
    if (stage.mass_table.empty() || !(stage.motor.thrust_n > 0.0 && stage.motor.burning_time_s > 0.0))
      continue;
    PutOverPropellant(BuildBurn(stage, 1.0, 1.0), stage.mass_table);
    const double dry_kg = DryMass(vehicle, static_cast<int>(i));
    if (stage.mass_table.propellant_kg.size() < 2 || !(dry_kg > 0.0)) continue;  // a problem of the vehicle
    stage.flown_mass.rows = std::make_shared<const MassRows>(BuildMassRows(stage.mass_table, dry_kg));
  }
}

// What follows from the fields of a file, once all are read.
void Complete(Vehicle& vehicle) {
  for (std::size_t i = 0; i < vehicle.stages.size(); ++i) {
    Stage& stage = vehicle.stages[i];
    if (stage.restarts)
      stage = BurnAgain(stage, vehicle.stages[i - 1]);
    else
      CompleteMotor(stage.propellant_mass_kg, stage.motor);
  }
  if (vehicle.structure_beam) CompleteBeam(vehicle.stages, vehicle.structure_beam->stages);
  CompleteMotor(vehicle.boosters.propellant_mass_kg, vehicle.boosters.motor);
  // They have left before the first stage burns again.
  for (std::size_t i = 1; i < vehicle.stages.size() && vehicle.stages[i].restarts; ++i)
    vehicle.stages[i].liftoff_mass_kg -= vehicle.boosters.LiftOffMass();
  CompleteMassTables(vehicle);
}

// The masses that a motor's file states beside its curve, against those of the stage or booster that has it.
void CheckHeader(const std::string& motor, double propellant_kg, double whole_kg, const InputNode& node,
                 const std::string& path, ProblemList& problems) {
  const auto check = [&](const char* key, const auto& fits, const std::string& what, const char* allowed) {
    const std::string wanted = motor + ".thrust_curve.table." + key;
    std::string found;
    const InputNode& at = FindField(node, wanted, &found);
    if (!found.ends_with(key) || fits(*ParseNumber(at.text))) return;
    AddProblem(problems, at, path.empty() ? found : path + "." + found,
               "the motor's header states " + at.text + what, allowed);
  };
  check(
      "published_propellant_mass_kg",
      [&](double stated_kg) {
        return std::fabs(stated_kg - propellant_kg) <= kFlowSumTolerance * propellant_kg;
      },
      " kg of propellant, but propellant_mass_kg is " + FormatRounded(propellant_kg),
      "the same mass in both, within 1 %");
  check(
      "published_motor_mass_kg", [&](double stated_kg) { return stated_kg <= whole_kg; },
      " kg for the whole motor, which is a part of " + FormatRounded(whole_kg) + " kg",
      "a motor that is no heavier than the whole");
}
void CheckHeaders(const Vehicle& vehicle, const InputNode& node, const std::string& path,
                  ProblemList& problems) {
  for (std::size_t i = 0; i < vehicle.stages.size(); ++i)
    if (const Stage& stage = vehicle.stages[i]; !stage.restarts)
      CheckHeader("stages[" + std::to_string(i) + "].motor", stage.propellant_mass_kg, stage.liftoff_mass_kg,
                  node, path, problems);
  const Boosters& boosters = vehicle.boosters;
  CheckHeader("boosters.motor", boosters.propellant_mass_kg,
              boosters.propellant_mass_kg + boosters.dry_mass_kg, node, path, problems);
}

void CheckPlausibility(const Vehicle& vehicle, const InputNode& node, const std::string& path,
                       ProblemList& problems, ProblemList* warnings) {
  std::vector<PlausibilityFinding> impossible, unusual;
  for (PlausibilityFinding& finding : Plausibility(vehicle))
    (finding.impossible ? impossible : unusual).push_back(std::move(finding));
  AddStructProblems(impossible, node, path, problems);
  if (warnings == nullptr) return;
  const std::size_t before = warnings->size();
  AddStructProblems(unusual, node, path, *warnings);
  for (std::size_t i = before; i < warnings->size(); ++i) (*warnings)[i].unusual = true;
}

// A file could not be read, which a value names.
bool HasUnread(const InputNode& node) {
  return node.file == nullptr || std::any_of(node.items.begin(), node.items.end(), HasUnread) ||
         std::any_of(node.members.begin(), node.members.end(),
                     [](const InputMember& member) { return HasUnread(member.value); });
}

// All that its relations are about was read; nothing but a flight needs the tables of its aerodynamics.
bool HasRelations(const InputNode& vehicle) {
  return vehicle.file != nullptr &&
         std::none_of(vehicle.members.begin(), vehicle.members.end(), [](const InputMember& member) {
           return member.key != "aerodynamics" && HasUnread(member.value);
         });
}

}  // namespace

Vehicle DecodeVehicle(InputNode& node, const std::string& path, std::vector<InputProblem>& problems,
                      FileSource* files, std::vector<InputProblem>* warnings) {
  const std::size_t before = problems.size(), files_before = files == nullptr ? 0 : files->problems();
  Vehicle vehicle;
  if (node.file == nullptr) return vehicle;  // already reported
  WriteOut(node, VehicleBase(), path, problems, files);
  ReadFields(node, path, problems, files, [&](Fields& fields) { DescribeVehicleFile(fields, vehicle); });
  const std::size_t of_files = files == nullptr ? 0 : files->problems() - files_before;
  if (problems.size() > before + of_files || !HasRelations(node)) return vehicle;
  Complete(vehicle);
  AddStructProblems(Problems(vehicle), node, path, problems);
  CheckHeaders(vehicle, node, path, problems);
  if (problems.size() == before) CheckPlausibility(vehicle, node, path, problems, warnings);
  return vehicle;
}

}  // namespace dispersa
