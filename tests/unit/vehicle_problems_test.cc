// Every contradiction within a vehicle, with the full text for the user.
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "core/vehicle/vehicle.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::vehicle_problems_test {
namespace {

std::vector<std::string> Texts(const Vehicle& vehicle) {
  std::vector<std::string> texts;
  for (const StructProblem& p : Problems(vehicle))
    texts.push_back(p.path + ": " + p.message + " | " + p.allowed);
  return texts;
}

struct Mistake {
  const char* name;
  std::function<void(Vehicle&)> make;
  std::vector<std::string> texts;
};

// Readable test names instead of bytes.
void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }

class VehicleProblems : public testing::TestWithParam<Mistake> {};

TEST_P(VehicleProblems, AreNamedInFull) {
  Vehicle vehicle = SampleVehicle();
  GetParam().make(vehicle);
  EXPECT_EQ(Texts(vehicle), GetParam().texts);
}

INSTANTIATE_TEST_SUITE_P(
    Each, VehicleProblems,
    testing::Values(
        Mistake{"None", [](Vehicle&) {}, {}},
        Mistake{
            "PropellantMoreThanTheStageWeighs",
            [](Vehicle& v) {
              v.stages[1].propellant_mass_kg = 3100.0;
              v.stages[1].grain = {2.0, 9.0, 0.9, 0.3};
            },
            {"stages[1].propellant_mass_kg: leaves the stage no dry mass: lift-off mass less what is "
             "above it and its propellant is -100.000000 kg | less propellant than the stage's own mass"}},
        Mistake{"UpperStageHeavierThanTheOneBelow",
                [](Vehicle& v) { v.stages[1].liftoff_mass_kg = 13000.0; },
                {"stages[0].propellant_mass_kg: leaves the stage no dry mass: lift-off mass less what is "
                 "above it and its propellant is -4000.000000 kg | less propellant than the stage's own mass",
                 "stages[1].liftoff_mass_kg: is not below that of the stage underneath: lift-off mass counts "
                 "everything above, and stages are listed in the order of flight | less than 13000.000000"}},
        Mistake{"StagesInTheWrongOrder",
                [](Vehicle& v) {
                  std::swap(v.stages[0], v.stages[1]);
                  v.stages[0].ignition = IgnitionTrigger::kLiftOff;
                  v.stages[1].ignition = IgnitionTrigger::kTimer;
                },
                {"stages[0].propellant_mass_kg: leaves the stage no dry mass: lift-off mass less what is "
                 "above it and its propellant is -11000.000000 kg | less propellant than the stage's own "
                 "mass",
                 "stages[1].liftoff_mass_kg: is not below that of the stage underneath: lift-off mass counts "
                 "everything above, and stages are listed in the order of flight | less than 3000.000000",
                 "stages[0].bottom_station_m: is not aft of the next stage's | stations that decrease in the "
                 "order of flight"}},
        Mistake{"CentreOfGravityBehindTheNozzle",
                [](Vehicle& v) { v.stages[1].gimbal.pivot_station_m = 5.0; },
                {"stages[1].gimbal.pivot_station_m: is not aft of the centre of gravity, which reaches "
                 "station 6.333333 m | a station aft of the centre of gravity"}},
        Mistake{
            "DriveThatNeverMoves",
            [](Vehicle& v) {
              v.stages[0].gimbal.dead_zone_rad = v.stages[0].gimbal.limit_rad;
              v.stages[1].gimbal.friction_rad = 1.0;
              v.stages[1].gimbal.resolution_rad = 1.0;
            },
            {"stages[0].gimbal.dead_zone_deg: leaves the nozzle no travel | 0 to below the gimbal's limit",
             "stages[1].gimbal.friction_deg: leaves the nozzle no travel | 0 to below the gimbal's limit",
             "stages[1].gimbal.resolution_deg: leaves the nozzle no travel | 0 to below the gimbal's limit"}},
        Mistake{"GrainTooSmallForItsPropellant",
                [](Vehicle& v) {
                  v.stages[1].grain = {8.5, 9.0, 0.9, 0.3};
                },
                {"stages[1].grain: implies a propellant density of 3536.776513 kg/m3 | a volume that gives "
                 "less than 2100 kg/m3"}},
        Mistake{"GrainUpsideDown",
                [](Vehicle& v) {
                  v.stages[1].grain = {9.0, 6.0, 0.9, 0.3};
                },
                {"stages[1].grain.bottom_station_m: is not aft of top_station_m | a station larger than "
                 "top_station_m",
                 "stages[1].grain: implies a propellant density of -589.462752 kg/m3 | a volume that gives "
                 "less than 2100 kg/m3"}},
        Mistake{"BoreWiderThanTheGrain",
                [](Vehicle& v) { v.stages[1].grain.inner_diameter_m = 1.0; },
                {"stages[1].grain.inner_diameter_m: is not smaller than outer_diameter_m | less than "
                 "outer_diameter_m",
                 "stages[1].grain: implies a propellant density of -2233.753587 kg/m3 | a volume that gives "
                 "less than 2100 kg/m3"}},
        Mistake{"GrainOutOfTheStack",
                [](Vehicle& v) {
                  v.stages[1].grain = {8.5, 11.5, 0.9, 0.3};
                },
                {"stages[1].grain.bottom_station_m: lies aft of the stage's bottom_station_m | at most "
                 "bottom_station_m of the stage"}},
        Mistake{"FractionsDoNotSumTo1",
                [](Vehicle& v) { v.stages[0].structure[0].fraction = 0.7; },
                {"stages[0].structure: has fractions that sum to 0.950000 | fractions that sum to 1"}},
        Mistake{"NoStructureThatIsNoInertia",
                [](Vehicle& v) { v.stages[1].structure.clear(); },
                {"stages[1].structure: has fractions that sum to 0.000000 | fractions that sum to 1"}},
        Mistake{"ElementWithoutWall",
                [](Vehicle& v) {
                  v.stages[1].structure[0].inner_diameter_m = v.stages[1].structure[0].outer_diameter_m;
                },
                {"stages[1].structure[0].inner_diameter_m: is not smaller than outer_diameter_m | less than "
                 "outer_diameter_m"}},
        Mistake{
            "RampsLongerThanTheBurn",
            [](Vehicle& v) {
              v.stages[0].motor.ignition_rise_s = 40.0;
              v.stages[0].motor.tail_off_s = 40.0;
            },
            {"stages[0].motor.tail_off_s: leaves no time at full thrust | ramps that are together shorter "
             "than twice burning_time_s"}},
        Mistake{"FirstStageOnATimer",
                [](Vehicle& v) { v.stages[0].ignition = IgnitionTrigger::kTimer; },
                {"stages[0].ignition.trigger: the first stage does not ignite at lift-off | lift_off"}},
        Mistake{
            "NozzlesOfWhichOneTurnsNothingInYaw",
            [](Vehicle& v) {
              v.stages[1].gimbal.nozzles = {{"main", 0.0, 0.0, 1.0, {0.5 * kPi}, 0.0}};
            },
            {"stages[1].gimbal.nozzles: do not turn the vehicle in yaw | hinges by which pitch and yaw are "
             "commanded, as turns_towards_deg: [90, 180] of one nozzle"}},
        Mistake{"NothingThatTurnsInRoll",
                [](Vehicle& v) {
                  v.stages.resize(1);
                  v.aerodynamics.resize(1);
                  v.reaction_control = {};
                  v.stages[0].gimbal.nozzles = {{"main", 0.0, 0.0, 1.0, {0.5 * kPi, kPi}, 0.0}};
                },
                {"stages[0].gimbal.nozzles: cannot turn the vehicle in roll, and there is no reaction "
                 "control that "
                 "could | reaction_control, or nozzles that command roll"}},
        Mistake{"SecondStageAtLiftOff",
                [](Vehicle& v) { v.stages[1].ignition = IgnitionTrigger::kLiftOff; },
                {"stages[1].ignition.trigger: only the first stage ignites at lift-off | burnout_detection "
                 "or timer"}},
        Mistake{"ProfileThatEndsElsewhere",
                [](Vehicle& v) {
                  v.aerodynamics.clear();
                  v.profile = {{ProfileShape::kCone, 2.0, 1.0}, {ProfileShape::kCylinder, 17.0, 1.0}};
                },
                {"profile: is 19.000000 m long in all | sections that end at the first stage's "
                 "bottom_station_m, 20.000000 m"}},
        Mistake{
            "LimitOfSectionsThatTheVehicleHasNot",
            [](Vehicle& v) { v.limits.bending_moment_n_m = 1e5; },
            {"limits.bending_moment_n_m: has no sections to hold for: the vehicle has no profile | a limit "
             "of a vehicle with a profile"}},
        Mistake{"OneTableForTwoStacks",
                [](Vehicle& v) { v.aerodynamics.pop_back(); },
                {"aerodynamics.tables: has 1 tables | one table for each of the 2 stacks"}}),
    [](const testing::TestParamInfo<Mistake>& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace dispersa::vehicle_problems_test
