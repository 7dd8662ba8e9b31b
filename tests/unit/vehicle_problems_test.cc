// Contradictions within a vehicle that a file cannot have; for the others see
// tests/data/messages/vehicle.txt.
#include "core/vehicle/vehicle.h"
#include "tests/test.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::vehicle_problems_test {
namespace {

std::vector<std::string> Texts(const Vehicle& vehicle) {
  std::vector<std::string> texts;
  for (const StructProblem& p : Problems(vehicle))
    texts.push_back(p.path + ": " + p.message + " | " + p.allowed);
  return texts;
}

TEST(VehicleProblems, OfTheSampleAreNone) { EXPECT_EQ(Texts(SampleVehicle()), std::vector<std::string>{}); }

TEST(VehicleProblems, WithoutStructureThereIsNoInertia) {
  Vehicle v = SampleVehicle();
  v.stages[1].structure.clear();
  EXPECT_EQ(Texts(v), std::vector<std::string>{"stages[1].structure: has fractions that sum to 0.000000 | "
                                               "fractions that sum to 1"});
}

TEST(VehicleProblems, SomethingTurnsInRoll) {
  Vehicle v = SampleVehicle();
  v.stages.resize(1);
  v.aerodynamics.resize(1);
  v.reaction_control = {};
  v.stages[0].gimbal.nozzles = {{"main", 0.0, 0.0, 1.0, {0.5 * kPi, kPi}, 0.0}};
  EXPECT_EQ(Texts(v), std::vector<std::string>{"stages[0].gimbal.nozzles: cannot turn the vehicle in roll, "
                                               "and there is no reaction control that could "
                                               "| reaction_control, or nozzles that command roll"});
}

TEST(VehicleProblems, LimitsOfSectionsNeedSections) {
  Vehicle v = SampleVehicle();
  v.limits.bending_moment_n_m = 1e5;
  EXPECT_EQ(
      Texts(v),
      std::vector<std::string>{
          "limits.bending_moment_n_m: has no sections to hold for: the vehicle has no profile | a limit of a "
          "vehicle with a profile"});
}

}  // namespace
}  // namespace dispersa::vehicle_problems_test
