#include "core/vehicle/vehicle.h"

#include <algorithm>
#include <cmath>

#include "core/math/constants.h"
#include "core/math/functions.h"
#include "core/vehicle/aerodynamics_build_up.h"
#include "core/vehicle/cut_off.h"
#include "core/vehicle/mass.h"
#include "core/vehicle/mould_line.h"
#include "core/vehicle/propulsion.h"

namespace dispersa {

namespace {

class Checker {
 public:
  void Require(bool ok, const std::string& path, const std::string& message, const std::string& allowed) {
    if (!ok) problems_.push_back({path, message, allowed});
  }
  std::vector<StructProblem> Take() { return std::move(problems_); }

 private:
  std::vector<StructProblem> problems_;
};

void CheckTube(const std::string& path, double top, double bottom, double outer, double inner,
               double stack_bottom, Checker& check, const std::string& part = "stage") {
  check.Require(bottom > top, path + ".bottom_station_m", "is not aft of top_station_m",
                "a station larger than top_station_m");
  check.Require(inner < outer, path + ".inner_diameter_m", "is not smaller than outer_diameter_m",
                "less than outer_diameter_m");
  check.Require(bottom <= stack_bottom, path + ".bottom_station_m",
                "lies aft of the " + part + "'s bottom_station_m", "at most bottom_station_m of the " + part);
}

// Engine and tanks of a liquid stage or booster. Body is a Stage or Boosters.
template <class Body>
void CheckLiquid(const Body& body, const std::string& path, Checker& check,
                 const std::string& part = "stage") {
  check.Require(body.motor.residual_mass_kg < body.propellant_mass_kg,
                path + ".motor.liquid.residual_mass_kg", "leaves nothing to burn",
                "0 to below propellant_mass_kg");
  double sum_kg = 0.0;
  for (std::size_t k = 0; k < body.tanks.size(); ++k) {
    const Tank& tank = body.tanks[k];
    const std::string at = path + ".tanks[" + std::to_string(k) + "]";
    check.Require(tank.bottom_station_m > tank.top_station_m, at + ".bottom_station_m",
                  "is not aft of top_station_m", "a station larger than top_station_m");
    check.Require(tank.bottom_station_m <= body.bottom_station_m, at + ".bottom_station_m",
                  "lies aft of the " + part + "'s bottom_station_m",
                  "at most bottom_station_m of the " + part);
    sum_kg += tank.propellant_mass_kg;
    if (!(tank.bottom_station_m > tank.top_station_m)) continue;
    const double volume_m3 = tank.propellant_mass_kg / tank.density_kg_m3;
    check.Require(
        volume_m3 <= tank.Volume(), at + ".propellant_mass_kg",
        "takes " + std::to_string(volume_m3) + " m3, the tank has " + std::to_string(tank.Volume()),
        "at most what the tank holds, " + std::to_string(tank.Volume() * tank.density_kg_m3) + " kg");
  }
  // Masses are written with a few digits.
  check.Require(
      std::fabs(sum_kg - body.propellant_mass_kg) <= 1e-6 * body.propellant_mass_kg,
      path + ".propellant_mass_kg",
      "is " + std::to_string(body.propellant_mass_kg) + ", the tanks hold " + std::to_string(sum_kg),
      "the sum of the tanks' propellant_mass_kg");
}

// Mass flows of a thrust curve.
void CheckFlows(const ThrustCurve& curve, double propellant_kg, const std::string& path, Checker& check) {
  if (curve.flow_kg_s.empty()) return;
  const double flown_kg = curve.Flown();
  check.Require(std::fabs(flown_kg - propellant_kg) <= kFlowSumTolerance * propellant_kg,
                path + ".thrust_curve.table.mass_flow_kg_s",
                "flows " + std::to_string(flown_kg) + " kg in all, but propellant_mass_kg is " +
                    std::to_string(propellant_kg),
                "flows that sum up to the propellant within 1 %");
}

void CheckIgnition(const Stage& stage, bool first, const std::string& path, Checker& check) {
  check.Require(
      first == (stage.ignition == IgnitionTrigger::kLiftOff), path + ".ignition.trigger",
      first ? "the first stage does not ignite at lift-off" : "only the first stage ignites at lift-off",
      first ? "lift_off" : "burnout_detection or timer");
}

// Of a stage that has one, over propellant.
void CheckMassTable(const Stage& stage, double dry_kg, const std::string& path, Checker& check) {
  const MassTable& table = stage.mass_table;
  if (table.empty() || !(dry_kg > 0.0)) return;
  const std::string at = path + ".mass_table";
  const std::vector<double>& left = table.propellant_kg;
  constexpr double kCovered = 0.02;
  const double all_kg = stage.propellant_mass_kg, spare_kg = kCovered * all_kg;
  if (left.size() < 2 || left.back() < all_kg - spare_kg ||
      left.front() > stage.motor.residual_mass_kg + spare_kg) {
    check.Require(
        false, at,
        "covers " + std::to_string(left.front()) + " to " + std::to_string(left.back()) + " kg of propellant",
        "rows from " + std::to_string(all_kg) + " kg at ignition to burnout, within 2 %");
    return;
  }
  constexpr double kMassPart = 0.005;
  for (std::size_t i = 0; i < left.size(); ++i) {
    const double own_kg = dry_kg + left[i];
    if (!table.mass_kg.empty() && std::fabs(table.mass_kg[i] - own_kg) > kMassPart * own_kg) {
      check.Require(false, at + ".mass_kg",
                    "is " + std::to_string(table.mass_kg[i]) + " with " + std::to_string(left[i]) +
                        " kg of propellant, but dry mass and propellant are " + std::to_string(own_kg),
                    "the stage alone, within 0.5 %: without stages above, boosters and jettisoned bodies");
      return;
    }
    if (table.cg_station_m[i] >= stage.bottom_station_m) {
      check.Require(false, at + ".cg_station_m",
                    "is " + std::to_string(table.cg_station_m[i]) + ", aft of the stage",
                    "less than bottom_station_m of the stage");
      return;
    }
    for (const auto& [key, column] : {std::pair{".cg_y_m", &table.cg_y_m}, {".cg_z_m", &table.cg_z_m}}) {
      if (column->empty() || std::fabs((*column)[i]) < 0.5 * stage.diameter_m) continue;
      check.Require(false, at + key, "is " + std::to_string((*column)[i]) + ", beside the stage",
                    "less than half of diameter_m of the stage");
      return;
    }
  }
}

void CheckStage(const Vehicle& vehicle, std::size_t i, Checker& check) {
  const Stage& stage = vehicle.stages[i];
  const std::string path = "stages[" + std::to_string(i) + "]";
  if (stage.restarts) {  // the body has been checked
    CheckIgnition(stage, i == 0, path, check);
    return;
  }
  CheckFlows(stage.motor.thrust_curve, stage.propellant_mass_kg, path + ".motor", check);
  check.Require(!stage.motor.thrust_curve.empty() ||
                    0.5 * (stage.motor.ignition_rise_s + stage.motor.tail_off_s) < stage.motor.burning_time_s,
                path + ".motor.tail_off_s", "leaves no time at full thrust",
                "ramps that are together shorter than twice burning_time_s");
  if (i > 0)
    check.Require(stage.liftoff_mass_kg < vehicle.stages[i - 1].liftoff_mass_kg, path + ".liftoff_mass_kg",
                  "is not below that of the stage underneath: lift-off mass counts everything above, and "
                  "stages are listed in the order of flight",
                  "less than " + std::to_string(vehicle.stages[i - 1].liftoff_mass_kg));
  const double dry = DryMass(vehicle, static_cast<int>(i));
  check.Require(dry > 0.0, path + ".propellant_mass_kg",
                "leaves the stage no dry mass: lift-off mass less what is above it and its propellant is " +
                    std::to_string(dry) + " kg",
                "less propellant than the stage's own mass");

  CheckMassTable(stage, dry, path, check);

  double density = 0.0;
  if (stage.is_liquid()) {
    CheckLiquid(stage, path, check);
    density = stage.tanks[0].density_kg_m3;
  } else {
    const Grain& g = stage.grain;
    CheckTube(path + ".grain", g.top_station_m, g.bottom_station_m, g.outer_diameter_m, g.inner_diameter_m,
              stage.bottom_station_m, check);
    density = PropellantDensity(stage);
    check.Require(density > 0.0 && density < 2100.0, path + ".grain",
                  "implies a propellant density of " + std::to_string(density) + " kg/m3",
                  "a volume that gives less than 2100 kg/m3");
  }

  double fractions = 0.0;
  for (std::size_t k = 0; k < stage.structure.size(); ++k) {
    const MassElement& e = stage.structure[k];
    const std::string element = path + ".structure[" + std::to_string(k) + "]";
    CheckTube(element, e.top_station_m, e.bottom_station_m, e.outer_diameter_m, e.inner_diameter_m,
              stage.bottom_station_m, check);
    fractions += e.fraction;
  }
  for (std::size_t k = 0; k < stage.jettisoned.size(); ++k) {
    const Jettison& jettison = stage.jettisoned[k];
    const std::string element = path + ".jettisoned[" + std::to_string(k) + "]";
    CheckTube(element, jettison.top_station_m, jettison.bottom_station_m, jettison.outer_diameter_m,
              jettison.inner_diameter_m, stage.bottom_station_m, check);
  }
  // Fractions are written with a few digits.
  check.Require(std::fabs(fractions - 1.0) < 1e-6, path + ".structure",
                "has fractions that sum to " + std::to_string(fractions), "fractions that sum to 1");

  const Gimbal& gimbal = stage.gimbal;
  for (const StructProblem& problem : NozzleProblems(gimbal, path + ".gimbal"))
    check.Require(false, problem.path, problem.message, problem.allowed);
  const auto below_limit = [&](double angle_rad, const char* key) {
    check.Require(gimbal.fixed || angle_rad < gimbal.limit_rad, path + ".gimbal." + key,
                  "leaves the nozzle no travel", "0 to below the gimbal's limit");
  };
  below_limit(gimbal.dead_zone_rad, "dead_zone_deg");
  below_limit(gimbal.friction_rad, "friction_deg");
  below_limit(gimbal.resolution_rad, "resolution_deg");
  if (dry > 0.0 && fractions > 0.0 && density > 0.0) {
    const StackMass stack = BuildStackMasses(vehicle)[i];
    // As tanks drain, it may be farthest aft in between.
    constexpr int kParts = 16;
    double aftmost = 0.0;
    for (int part = 0; part <= kParts; ++part)
      aftmost = std::max(aftmost, stack.At(stack.propellant_mass_kg * part / kParts).cg_station_m);
    check.Require(
        aftmost < gimbal.pivot_station_m,
        path + (gimbal.fixed ? ".nozzle_station_m" : ".gimbal.pivot_station_m"),
        "is not aft of the centre of gravity, which reaches station " + std::to_string(aftmost) + " m",
        "a station aft of the centre of gravity");
  }
  CheckIgnition(stage, i == 0, path, check);
}

void CheckNozzles(const Vehicle& vehicle, Checker& check) {
  int further = vehicle.boosters.count;
  for (const Stage& stage : vehicle.stages)
    further += std::max(0, static_cast<int>(NozzlesOf(stage.gimbal).size()) - kNozzles);
  check.Require(further <= kFurtherNozzles, "stages",
                "have " + std::to_string(further) + " nozzles beyond four in each",
                "up to " + std::to_string(kFurtherNozzles) + " of these in all");
}

void CheckTables(const Vehicle& vehicle, Checker& check) {
  check.Require(vehicle.aerodynamics.empty() || vehicle.aerodynamics.size() == vehicle.stages.size(),
                "aerodynamics.tables", "has " + std::to_string(vehicle.aerodynamics.size()) + " tables",
                "one table for each of the " + std::to_string(vehicle.stages.size()) + " stacks");
  for (std::size_t i = 0; i < vehicle.aerodynamics.size() && i < vehicle.stages.size(); ++i) {
    std::vector<std::string> carried;
    for (std::size_t k = i; k < vehicle.stages.size(); ++k)
      for (const Jettison& jettison : vehicle.stages[k].jettisoned) carried.push_back(jettison.name);
    if (i == 0 && vehicle.boosters.count > 0) carried.emplace_back(kBoostersName);
    std::string names;
    for (const std::string& name : carried) names += (names.empty() ? "" : ", ") + name;
    const std::vector<AeroConfiguration>& lighter = vehicle.aerodynamics[i].lighter;
    for (std::size_t k = 0; k < lighter.size(); ++k)
      for (const std::string& name : lighter[k].without)
        check.Require(
            std::find(carried.begin(), carried.end(), name) != carried.end(),
            "aerodynamics.tables[" + std::to_string(i) + "].lighter[" + std::to_string(k) + "].without",
            "names '" + name + "', which this stack does not jettison",
            names.empty() ? "no lighter tables: the stack jettisons nothing" : "of " + names);
  }
}

void CheckPlaces(const Vehicle& vehicle, Checker& check) {
  const Boosters& b = vehicle.boosters;
  const double least_rad = 2.0 * Asin(std::min(1.0, 0.5 * b.diameter_m / b.radius_m));
  for (std::size_t k = 0; k < b.angles_rad.size(); ++k)
    for (std::size_t other = 0; other < k; ++other) {
      const double apart_rad = std::fabs(std::remainder(b.angles_rad[k] - b.angles_rad[other], kTwoPi));
      check.Require(
          apart_rad > least_rad - 1e-9,
          b.are_spread ? "boosters.count" : "boosters.angles_deg[" + std::to_string(k) + "]",
          "puts the booster into another one, " + std::to_string(apart_rad * kDegPerRad) + " deg beside it",
          "angles at least " + std::to_string(least_rad * kDegPerRad) + " deg apart");
    }
  if (!b.turn_nozzles()) return;
  if (b.towards_rad.size() > 1)
    check.Require(std::fabs(Cos(b.towards_rad[1] - b.towards_rad[0])) < 1e-9,
                  "boosters.gimbal.turns_towards_deg", "has hinges that are not at right angles",
                  "one direction, or two that are 90 deg apart");
  const int banks = BuildNozzleLayout(vehicle.stages[0].gimbal).banks() + (b.count + kNozzles - 1) / kNozzles;
  check.Require(banks <= kBanks, "boosters.gimbal", "turns more nozzles than a stage may have beside its own",
                "boosters with fixed nozzles, or fewer engines in the stage");
}

void CheckBoosters(const Vehicle& vehicle, Checker& check) {
  const Boosters& b = vehicle.boosters;
  if (b.count == 0) return;
  const Stage& core = vehicle.stages[0];
  check.Require(2.0 * b.radius_m >= core.diameter_m, "boosters.radius_m",
                "puts their axes inside the stage that they stand beside",
                "at least half its diameter_m, " + std::to_string(0.5 * core.diameter_m));
  check.Require(b.attachment_station_m <= core.bottom_station_m, "boosters.attachment_station_m",
                "lies aft of the stage that carries them",
                "at most its bottom_station_m, " + std::to_string(core.bottom_station_m));
  check.Require(b.bottom_station_m > b.top_station_m, "boosters.bottom_station_m",
                "is not aft of top_station_m", "a station larger than top_station_m");
  if (b.is_liquid()) {
    CheckLiquid(b, "boosters", check, "booster");
    for (std::size_t k = 0; k < b.tanks.size(); ++k)
      check.Require(b.tanks[k].diameter_m <= b.diameter_m,
                    "boosters.tanks[" + std::to_string(k) + "].diameter_m", "is larger than the booster",
                    "at most diameter_m");
    // Their empty tanks, not the speed, say when they are of no more use.
    check.Require(!EndsInFlight(b.motor), "boosters.motor.liquid.cut_off.at",
                  "is a speed of the vehicle, but the boosters leave by a clock after their burnout",
                  "depletion or time");
    if (EndsInFlight(b.motor)) return;
  } else {
    CheckTube("boosters.grain", b.grain.top_station_m, b.grain.bottom_station_m, b.grain.outer_diameter_m,
              b.grain.inner_diameter_m, b.bottom_station_m, check, "booster");
  }
  check.Require(0.5 * (b.motor.ignition_rise_s + b.motor.tail_off_s) < b.motor.burning_time_s,
                "boosters.motor.tail_off_s", "leaves no time at full thrust",
                "ramps that are together shorter than twice burning_time_s");
  check.Require(b.grain.outer_diameter_m <= b.diameter_m, "boosters.grain.outer_diameter_m",
                "is larger than the booster", "at most diameter_m");
  CheckPlaces(vehicle, check);
  CheckFlows(b.motor.thrust_curve, b.propellant_mass_kg, "boosters.motor", check);
  const double beside_s = BuildBoosterBurn(b, 1.0, 1.0).duration_s + b.separation_delay_s;
  const double core_s = BuildBurn(core, 1.0, 1.0).duration_s;
  check.Require(beside_s < core_s, "boosters.motor",
                "burns, and the boosters leave, after " + std::to_string(beside_s) + " s, the stage burns " +
                    std::to_string(core_s) + " s",
                "boosters that leave while their stage burns");
}

void CheckRestarts(const Vehicle& vehicle, Checker& check) {
  for (std::size_t i = 0; i < vehicle.stages.size(); ++i) {
    if (!vehicle.stages[i].restarts) continue;
    const std::string path = "stages[" + std::to_string(i) + "].restarts";
    if (i == 0) continue;  // said at its ignition
    const Stage& before = vehicle.stages[i - 1];
    if (EndsAtSpeed(before.motor)) continue;  // what it leaves a flight tells
    const double left_kg = BuildBurn(before, 1.0, 1.0).left_kg;
    check.Require(
        left_kg > before.motor.residual_mass_kg, path,
        "has nothing to burn: the burn before leaves " + std::to_string(left_kg) + " kg, the residual",
        "a cut_off of the burn before that leaves propellant");
  }
}

void CheckAims(const Vehicle& vehicle, Checker& check) {
  for (std::size_t i = 0; i + 1 < vehicle.stages.size(); ++i)
    check.Require(vehicle.stages[i].motor.cut_off != CutOff::kAtTarget,
                  "stages[" + std::to_string(i) +
                      (vehicle.stages[i].restarts ? "].cut_off.at" : "].motor.liquid.cut_off.at"),
                  "is target, but another burn follows: this one does not end in the target orbit",
                  "inertial_velocity, time or depletion; target is of the last burn");
}

void CheckJettisons(const Vehicle& vehicle, Checker& check) {
  int count = 0;
  for (std::size_t i = 0; i < vehicle.stages.size(); ++i) {
    const std::string path = "stages[" + std::to_string(i) + "].jettisoned";
    const std::size_t here = vehicle.stages[i].jettisoned.size();
    count += static_cast<int>(here);
    check.Require(count <= kMaxJettisons, path, "makes " + std::to_string(count) + " in all",
                  "up to " + std::to_string(kMaxJettisons) + " of a vehicle");
  }
}

}  // namespace

int LastBurn(const Vehicle& vehicle, int stage) {
  std::size_t last = static_cast<std::size_t>(stage);
  while (last + 1 < vehicle.stages.size() && vehicle.stages[last + 1].restarts) ++last;
  return static_cast<int>(last);
}

bool HasSectionLoads(const Vehicle& vehicle) {
  const Boosters& boosters = vehicle.boosters;
  return !vehicle.profile.empty() && (boosters.count == 0 || boosters.attachment_station_m > 0.0);
}

bool CutsOffInFlight(const Vehicle& vehicle) {
  return std::any_of(vehicle.stages.begin(), vehicle.stages.end(),
                     [](const Stage& stage) { return EndsInFlight(stage.motor); });
}

std::vector<StructProblem> Problems(const Vehicle& vehicle) {
  Checker check;
  const std::size_t count = vehicle.stages.size();
  for (std::size_t i = 0; i < count; ++i) CheckStage(vehicle, i, check);
  for (std::size_t i = 0; i + 1 < count; ++i)
    check.Require(vehicle.stages[i + 1].restarts ||
                      vehicle.stages[i].bottom_station_m > vehicle.stages[i + 1].bottom_station_m,
                  "stages[" + std::to_string(i) + "].bottom_station_m", "is not aft of the next stage's",
                  "stations that decrease in the order of flight");
  double length = 0.0;
  for (const ProfileSection& section : vehicle.profile) length += section.length_m;
  if (NeedsProfile(vehicle))
    // Lengths are written to the millimetre.
    check.Require(std::fabs(length - vehicle.stages[0].bottom_station_m) < 1e-3, "profile",
                  "is " + std::to_string(length) + " m long in all",
                  "sections that end at the first stage's bottom_station_m, " +
                      std::to_string(vehicle.stages[0].bottom_station_m) + " m");
  for (const StructProblem& problem : ProfileProblems(vehicle.profile))
    check.Require(false, problem.path, problem.message, problem.allowed);
  CheckNozzles(vehicle, check);
  CheckTables(vehicle, check);
  CheckRestarts(vehicle, check);
  CheckAims(vehicle, check);
  CheckJettisons(vehicle, check);
  CheckBoosters(vehicle, check);
  check.Require(!(vehicle.limits.bending_moment_n_m > 0.0) || HasSectionLoads(vehicle),
                "limits.bending_moment_n_m",
                vehicle.profile.empty() ? "has no sections to hold for: the vehicle has no profile"
                                        : "needs the station at which the first stage carries its boosters",
                vehicle.profile.empty() ? "a limit of a vehicle with a profile"
                                        : "a limit of a vehicle with boosters.attachment_station_m");
  const ReactionControl& rcs = vehicle.reaction_control;
  std::vector<StructProblem> problems = check.Take();
  for (std::size_t i = 0; problems.empty() && i < count; ++i)
    if (!(rcs.thrust_n > 0.0) && !BuildNozzleLayout(vehicle.stages[i].gimbal).rolls)
      problems.push_back({"stages[" + std::to_string(i) + "].gimbal.nozzles",
                          "cannot turn the vehicle in roll, and there is no reaction control that could",
                          "reaction_control, or nozzles that command roll"});
  if (problems.empty() && vehicle.structure_beam) problems = BeamProblems(vehicle);
  return problems;
}

double Tank::Volume() const { return 0.25 * kPi * Square(diameter_m) * (bottom_station_m - top_station_m); }

double Stage::PropellantTop() const {
  if (!is_liquid()) return grain.top_station_m;
  double top_m = tanks[0].top_station_m;
  for (const Tank& tank : tanks) top_m = std::min(top_m, tank.top_station_m);
  return top_m;
}

double Stage::PropellantBottom() const {
  if (!is_liquid()) return grain.bottom_station_m;
  double bottom_m = tanks[0].bottom_station_m;
  for (const Tank& tank : tanks) bottom_m = std::max(bottom_m, tank.bottom_station_m);
  return bottom_m;
}

void SetThrustCurve(ThrustCurve curve, Motor& motor) {
  motor.thrust_n = curve.Greatest();
  motor.burning_time_s = curve.FullFlowTime();
  motor.thrust_curve = std::move(curve);
}

}  // namespace dispersa
