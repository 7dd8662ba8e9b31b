#include "core/vehicle/vehicle.h"

#include <algorithm>
#include <cmath>

#include "core/math/table.h"
#include "core/vehicle/mass.h"
#include "core/vehicle/mould_line.h"

namespace dispersa {

namespace {

class Checker {
 public:
  void Require(bool ok, const std::string& path, const std::string& message, const std::string& allowed) {
    if (!ok) problems_.push_back({path, message, allowed});
  }
  void Positive(double value, const std::string& path) {
    Require(value > 0.0, path, "is not positive", "a number above 0");
  }
  void NotNegative(double value, const std::string& path) {
    Require(value >= 0.0, path, "is negative", "0 or more");
  }
  std::vector<VehicleProblem> Take() { return std::move(problems_); }

 private:
  std::vector<VehicleProblem> problems_;
};

void CheckTube(const std::string& path, double top, double bottom, double outer, double inner,
               double stack_bottom, Checker& check) {
  check.Require(bottom > top, path + ".bottom_station_m", "is not aft of top_station_m",
                "a station larger than top_station_m");
  check.Positive(outer, path + ".outer_diameter_m");
  check.NotNegative(inner, path + ".inner_diameter_m");
  check.Require(inner < outer, path + ".inner_diameter_m", "is not smaller than outer_diameter_m",
                "less than outer_diameter_m");
  check.NotNegative(top, path + ".top_station_m");
  check.Require(bottom <= stack_bottom, path + ".bottom_station_m",
                "lies aft of the stage's bottom_station_m", "at most bottom_station_m of the stage");
}

void CheckStage(const Vehicle& vehicle, std::size_t i, Checker& check) {
  const Stage& stage = vehicle.stages[i];
  const std::string path = "stages[" + std::to_string(i) + "]";
  check.Positive(stage.liftoff_mass_kg, path + ".liftoff_mass_kg");
  check.Positive(stage.propellant_mass_kg, path + ".propellant_mass_kg");
  check.Positive(stage.diameter_m, path + ".diameter_m");
  check.Positive(stage.motor.thrust_n, path + ".motor.thrust_n");
  check.Positive(stage.motor.burning_time_s, path + ".motor.burning_time_s");
  check.NotNegative(stage.motor.ignition_rise_s, path + ".motor.ignition_rise_s");
  check.NotNegative(stage.motor.tail_off_s, path + ".motor.tail_off_s");
  check.NotNegative(stage.motor.nozzle_exit_area_m2, path + ".motor.nozzle_exit_area_m2");
  check.Require(0.5 * (stage.motor.ignition_rise_s + stage.motor.tail_off_s) < stage.motor.burning_time_s,
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

  const Grain& g = stage.grain;
  CheckTube(path + ".grain", g.top_station_m, g.bottom_station_m, g.outer_diameter_m, g.inner_diameter_m,
            stage.bottom_station_m, check);
  const double density = PropellantDensity(stage);
  check.Require(density > 0.0 && density < 2100.0, path + ".grain",
                "implies a propellant density of " + std::to_string(density) + " kg/m3",
                "a volume that gives less than 2100 kg/m3");

  double fractions = 0.0;
  for (std::size_t k = 0; k < stage.structure.size(); ++k) {
    const MassElement& e = stage.structure[k];
    const std::string element = path + ".structure[" + std::to_string(k) + "]";
    check.Positive(e.fraction, element + ".fraction");
    CheckTube(element, e.top_station_m, e.bottom_station_m, e.outer_diameter_m, e.inner_diameter_m,
              stage.bottom_station_m, check);
    fractions += e.fraction;
  }
  // Fractions are written with a few digits.
  check.Require(std::fabs(fractions - 1.0) < 1e-6, path + ".structure",
                "has fractions that sum to " + std::to_string(fractions), "fractions that sum to 1");

  const Gimbal& gimbal = stage.gimbal;
  check.Positive(gimbal.limit_rad, path + ".gimbal.limit_deg");
  check.Positive(gimbal.rate_limit_rad_s, path + ".gimbal.rate_limit_deg_s");
  check.Positive(gimbal.bandwidth_rad_s, path + ".gimbal.bandwidth_rad_s");
  check.Positive(gimbal.damping_ratio, path + ".gimbal.damping_ratio");
  if (gimbal.nozzles.empty()) check.Positive(gimbal.radius_m, path + ".gimbal.radius_m");
  for (const VehicleProblem& problem : NozzleProblems(gimbal, path + ".gimbal"))
    check.Require(false, problem.path, problem.message, problem.allowed);
  check.Require(gimbal.delay_ticks >= 0 && gimbal.delay_ticks <= 50, path + ".gimbal.delay_ticks",
                "is out of range", "0 to 50");
  const auto below_limit = [&](double angle_rad, const char* key) {
    check.Require(angle_rad == 0.0 || (angle_rad > 0.0 && angle_rad < gimbal.limit_rad),
                  path + ".gimbal." + key, "leaves the nozzle no travel", "0 to below the gimbal's limit");
  };
  below_limit(gimbal.dead_zone_rad, "dead_zone_deg");
  below_limit(gimbal.friction_rad, "friction_deg");
  below_limit(gimbal.resolution_rad, "resolution_deg");
  if (dry > 0.0 && fractions > 0.0 && density > 0.0) {
    const StackMass stack = BuildStackMasses(vehicle)[i];
    const double aftmost =
        std::max(stack.At(stack.propellant_mass_kg).cg_station_m, stack.At(0.0).cg_station_m);
    check.Require(aftmost < gimbal.pivot_station_m, path + ".gimbal.pivot_station_m",
                  "is not aft of the centre of gravity, which reaches station " + std::to_string(aftmost) +
                      " m",
                  "a station aft of the centre of gravity");
  }
  const bool first = i == 0;
  check.Require(
      first == (stage.ignition == IgnitionTrigger::kLiftOff), path + ".ignition.trigger",
      first ? "the first stage does not ignite at lift-off" : "only the first stage ignites at lift-off",
      first ? "lift_off" : "burnout_detection or timer");
  check.NotNegative(stage.ignition_delay_s, path + ".ignition.delay_s");
  check.NotNegative(stage.separation_delay_s, path + ".separation_delay_s");
}

void CheckTables(const Vehicle& vehicle, Checker& check) {
  if (vehicle.aerodynamics.empty()) return;
  check.Require(vehicle.aerodynamics.size() == vehicle.stages.size(), "aerodynamics.tables",
                "has " + std::to_string(vehicle.aerodynamics.size()) + " tables",
                "one table for each of the " + std::to_string(vehicle.stages.size()) + " stacks");
  for (std::size_t i = 0; i < vehicle.aerodynamics.size(); ++i) {
    const AeroTable& t = vehicle.aerodynamics[i];
    const std::string path = "aerodynamics.tables[" + std::to_string(i) + "]";
    check.Require(t.mach.size() >= 2 && IsStrictlyIncreasing(t.mach), path + ".mach",
                  "is not strictly increasing", "at least two strictly increasing numbers");
    check.Require(t.incidence_rad.size() >= 2 && IsStrictlyIncreasing(t.incidence_rad),
                  path + ".incidence_deg", "is not strictly increasing",
                  "at least two strictly increasing numbers");
    check.Positive(t.reference_area_m2, path + ".reference_area_m2");
    check.Positive(t.reference_length_m, path + ".reference_length_m");
  }
}

}  // namespace

std::vector<VehicleProblem> Problems(const Vehicle& vehicle) {
  Checker check;
  const std::size_t count = vehicle.stages.size();
  check.Require(count >= 1 && count <= static_cast<std::size_t>(kMaxStages), "stages",
                "has " + std::to_string(count) + " entries", "1 to " + std::to_string(kMaxStages) + " stages");
  if (count < 1 || count > static_cast<std::size_t>(kMaxStages)) return check.Take();
  for (std::size_t i = 0; i < count; ++i) CheckStage(vehicle, i, check);
  for (std::size_t i = 0; i + 1 < count; ++i)
    check.Require(vehicle.stages[i].bottom_station_m > vehicle.stages[i + 1].bottom_station_m,
                  "stages[" + std::to_string(i) + "].bottom_station_m",
                  "is not aft of the next stage's", "stations that decrease in the order of flight");
  double length = 0.0;
  for (const ProfileSection& section : vehicle.profile) length += section.length_m;
  if (vehicle.aerodynamics.empty())
    // Lengths are written to the millimetre.
    check.Require(std::fabs(length - vehicle.stages[0].bottom_station_m) < 1e-3, "profile",
                  "is " + std::to_string(length) + " m long in all",
                  "sections that end at the first stage's bottom_station_m, " +
                      std::to_string(vehicle.stages[0].bottom_station_m) + " m");
  for (const VehicleProblem& problem : ProfileProblems(vehicle.profile))
    check.Require(false, problem.path, problem.message, problem.allowed);
  CheckTables(vehicle, check);
  const ReactionControl& rcs = vehicle.reaction_control;
  if (count > 1) {
    check.Positive(rcs.thrust_n, "reaction_control.thrust_n");
    check.Positive(rcs.pitch_yaw_arm_m, "reaction_control.pitch_yaw_arm_m");
    check.Positive(rcs.roll_arm_m, "reaction_control.roll_arm_m");
    check.Positive(rcs.specific_impulse_s, "reaction_control.specific_impulse_s");
    check.Positive(rcs.minimum_on_time_s, "reaction_control.minimum_on_time_s");
  }
  std::vector<VehicleProblem> problems = check.Take();
  for (std::size_t i = 0; problems.empty() && i < count; ++i)
    if (!(rcs.thrust_n > 0.0) && !BuildNozzleLayout(vehicle.stages[i].gimbal).rolls)
      problems.push_back({"stages[" + std::to_string(i) + "].gimbal.nozzles",
                          "cannot turn the vehicle in roll, and there is no reaction control that could",
                          "reaction_control, or nozzles that command roll"});
  if (problems.empty() && vehicle.structure_beam) problems = BeamProblems(vehicle);
  return problems;
}

}  // namespace dispersa
