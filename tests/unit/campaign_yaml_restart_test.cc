// Restarts and cut-off at a velocity in vehicle files, with the full text for each mistake.
#include "core/campaign_yaml/load.h"
#include "core/pages/vehicle_drawing.h"
#include "core/vehicle/beam_masses.h"
#include "core/vehicle/mass.h"
#include "core/vehicle/propulsion.h"
#include "tests/test.h"
#include "tests/unit/input_files.h"

namespace dispersa::campaign_yaml_restart_test {
namespace {

constexpr char kGallery[] = DISPERSA_CAMPAIGNS "/gallery/vega/";

// Vega, whose upper stage burns twice.
class Vega {
 public:
  Vega() { files_.Write("vehicle.yaml", TextOfFile(std::string(kGallery) + "vehicle.yaml")); }
  void Edit(const std::string& from, const std::string& to) const { files_.Edit("vehicle.yaml", from, to); }
  Vehicle Load() const { return LoadVehicle(files_.Path("vehicle.yaml")); }
  std::string Problems() const { return files_.Texts(CheckFile(files_.Path("vehicle.yaml")).errors); }
  // The same with a beam, in a file that is based on it.
  void Bend() const { files_.Write("bending.yaml", TextOfFile(DISPERSA_TEST_DATA "/vega_that_bends.yaml")); }
  void EditBeam(const std::string& from, const std::string& to) const {
    files_.Edit("bending.yaml", from, to);
  }
  Vehicle LoadBending() const { return LoadVehicle(files_.Path("bending.yaml")); }
  std::string BeamProblems() const { return files_.Texts(CheckFile(files_.Path("bending.yaml")).errors); }

 private:
  InputFiles files_;
};
constexpr char kFirstCutOff[] = "cut_off: {at: inertial_velocity, velocity_m_s: 8030}";
constexpr char kAgain[] = "    cut_off: {at: inertial_velocity, velocity_m_s: 7136}\n";

TEST(RestartFile, IsTheStageBeforeWithCommandsOfItsOwn) {
  const Vehicle vehicle = Vega().Load();
  ASSERT_EQ(vehicle.stages.size(), 5u);
  const Stage &first = vehicle.stages[3], &again = vehicle.stages[4];
  EXPECT_TRUE(again.restarts && !first.restarts);
  EXPECT_EQ(again.name, "avum again");
  EXPECT_EQ(first.motor.cut_off, CutOff::kAtVelocity);
  EXPECT_EQ(first.motor.cut_off_velocity_m_s, 8030.0);
  EXPECT_EQ(again.motor.cut_off_velocity_m_s, 7136.0);
  EXPECT_EQ(again.ignition, IgnitionTrigger::kTimer);
  EXPECT_EQ(again.tanks.size(), first.tanks.size());
  // Masses stay attached until they are due, in any of the burns.
  EXPECT_TRUE(first.jettisoned.empty());
  EXPECT_EQ(again.jettisoned.size(), 1u);
  EXPECT_EQ(LastBurn(vehicle, 3), 4);
  EXPECT_EQ(DryMass(vehicle, 3), DryMass(vehicle, 4));
}

TEST(RestartFile, IsDrawnOnce) {
  const std::string drawing = VehicleDrawing(Vega().Load());
  EXPECT_NE(drawing.find(">avum<"), std::string::npos);
  EXPECT_EQ(drawing.find("avum again"), std::string::npos);
  EXPECT_EQ(drawing.find(">0 m"), std::string::npos);
}

TEST(RestartFile, BendsAsItsStageDoes) {
  const Vega file;
  file.Bend();
  const Vehicle vehicle = file.LoadBending();
  ASSERT_EQ(vehicle.structure_beam->stages.size(), 5u);
  EXPECT_EQ(vehicle.structure_beam->stages[4].lumped_masses.size(), 3u);
  // The fairing's entry of the last stage stands for both burns; the beam carries it until it leaves.
  for (const int stage : {0, 3}) {
    double mass_kg = 0.0;
    for (const unsigned gone : {0u, 1u}) {
      const double before_kg = mass_kg;
      mass_kg = 0.0;
      const BeamMasses masses = BuildBeamMasses(vehicle, stage, 0.0, gone);
      for (const SpreadMass& m : masses.spread)
        mass_kg += m.MassPerLength(0.5 * (m.top_station_m + m.bottom_station_m)) *
                   (m.bottom_station_m - m.top_station_m);
      for (const FixedMass& m : masses.fixed) mass_kg += m.mass_kg;
      if (gone == 0u) continue;
      EXPECT_NEAR(before_kg - mass_kg, 540.0, 1e-9) << stage;
    }
  }
}

TEST(RestartFile, WhatIsJettisonedLiesOnTheBeam) {
  const Vega file;
  file.Bend();
  file.EditBeam("        - {element: fairing, station_m: 7.9}\n", "");
  EXPECT_EQ(
      file.BeamProblems(),
      "bending.yaml:30:9: structure_beam.stages[3].sections: 'fairing' of the stage's jettisoned bodies "
      "lies outside of the beam, which reaches from station 7.300000 m to 9.600000 m, allowed: sections "
      "along the whole element, or the element among lumped_masses\n");
}

TEST(RestartFile, KnowsWhatATimedBurnLeaves) {
  const Vega file;
  file.Edit(kFirstCutOff, "cut_off: {at: time, after_s: 170.9}");
  const Vehicle vehicle = file.Load();
  const Stage &first = vehicle.stages[3], &again = vehicle.stages[4];
  const double burnt_kg = 2450.0 / (315.5 * 9.80665) * 170.9;
  EXPECT_NEAR(first.propellant_mass_kg - again.propellant_mass_kg, burnt_kg, 1e-6);
  EXPECT_NEAR(first.liftoff_mass_kg - again.liftoff_mass_kg, burnt_kg, 1e-6);
  // The same body with emptier tanks.
  const std::vector<StackMass> stacks = BuildStackMasses(vehicle);
  const double left_kg = again.propellant_mass_kg;
  EXPECT_EQ(stacks[3].At(left_kg).mass_kg, stacks[4].At(left_kg).mass_kg);
  EXPECT_EQ(stacks[3].At(left_kg).cg_station_m, stacks[4].At(left_kg).cg_station_m);
  EXPECT_NEAR(stacks[4].At(left_kg).mass_kg, again.liftoff_mass_kg, 1e-9);
  EXPECT_EQ(file.Problems(), "");
}

// Six stages and no more.
TEST(RestartFile, MayFollowARestart) {
  const std::string once_more = "  - {name: once more, restarts: true, ignition: {trigger: timer}}\n";
  const Vega file;
  file.Edit("\n# Axial: (assumed", "\n" + once_more + "\n# Axial: (assumed");
  const std::string nozzle = "  - {mass_kg: 16, cg_aft_of_pivot_m: 0.25, inertia_about_hinge_kg_m2: 1.6}\n";
  file.Edit(nozzle + nozzle, nozzle + nozzle + nozzle);
  const Vehicle vehicle = file.Load();
  ASSERT_EQ(vehicle.stages.size(), 6u);
  EXPECT_EQ(LastBurn(vehicle, 3), 5);
  EXPECT_EQ(vehicle.stages[5].motor.cut_off, CutOff::kAtDepletion);
  EXPECT_EQ(vehicle.stages[5].jettisoned.size(), 1u);
  file.Edit(once_more, once_more + once_more);
  EXPECT_NE(file.Problems().find("stages: the list has 7, allowed: a list of 1 to 6"), std::string::npos)
      << file.Problems();
}

TEST(RestartFile, OfAnEngineThatIsEmptyIsRefused) {
  const Vega file;
  file.Edit(kFirstCutOff, "cut_off: {at: depletion}");
  const std::string said = file.Problems();
  EXPECT_NE(
      said.find("stages[4].restarts: has nothing to burn: the burn before leaves 17.000000 kg, the residual, "
                "allowed: a cut_off of the burn before that leaves propellant"),
      std::string::npos)
      << said;
}

TEST(RestartFile, NeedsALiquidStageBefore) {
  const InputFiles files;
  files.Edit("vehicle.yaml", "stages:\n", "stages:\n  - {name: none, restarts: true}\n");
  const std::string said = files.Texts(CheckFile(files.Path("vehicle.yaml")).errors);
  EXPECT_NE(
      said.find(
          "stages[0].restarts: there is no stage before, allowed: restarts: true after a stage with motor: "
          "{liquid: {...}}"),
      std::string::npos)
      << said;
}

TEST(RestartFile, SaysNothingTwice) {
  const Vega file;
  file.Edit(kAgain, std::string(kAgain) + "    propellant_mass_kg: 300\n");
  const std::string said = file.Problems();
  EXPECT_NE(said.find("stages[4].propellant_mass_kg"), std::string::npos) << said;
}

TEST(CutOffFile, AtAVelocityNeedsOneAndAUnit) {
  for (const auto& [text, expected] :
       {std::pair{"cut_off: {at: inertial_velocity}", "stages[3].motor.liquid.cut_off"},
        {"cut_off: {at: inertial_velocity, velocity_m_s: -1}", "stages[3].motor.liquid.cut_off.velocity_m_s"},
        {"cut_off: {at: velocity, velocity_m_s: 8000}", "stages[3].motor.liquid.cut_off.at"}}) {
    const Vega file;
    file.Edit(kFirstCutOff, text);
    const std::string said = file.Problems();
    EXPECT_NE(said.find(expected), std::string::npos) << text << ": " << said;
  }
}

// A campaign of the gallery, with edits: what guidance refuses.
std::string GuidanceProblems(const std::string& launcher, const char* edited, const std::string& from,
                             const std::string& to) {
  const InputFiles files;
  for (const char* name : {"vehicle.yaml", "reference.yaml", "autopilot.yaml", "campaign.yaml"})
    files.Write(name, TextOfFile(DISPERSA_CAMPAIGNS "/gallery/" + launcher + "/" + name));
  files.Edit(edited, from, to);
  return files.Texts(CheckFile(files.Path("campaign.yaml")).errors);
}

TEST(GuidedRestart, NeedsALastBurnThatIsCutOff) {
  EXPECT_EQ(
      GuidanceProblems("vega", "vehicle.yaml", kAgain, ""),
      "campaign.yaml:7:18: guidance.mode: the last burn of 'vega' uses up what the burns before leave: its "
      "energy is not known before they end, allowed: open_loop, or cut_off: {at: inertial_velocity}, "
      "{at: target} or {at: time} of the last burn\n");
  EXPECT_EQ(GuidanceProblems("vega", "campaign.yaml", "mode: closed_loop",
                             "mode: closed_loop, last_burn: as_planned"),
            "");
}

TEST(GuidedCutOff, IsPlannedInTheBurnItselfIfNoCoastPrecedesIt) {
  EXPECT_EQ(
      GuidanceProblems("electron", "campaign.yaml", "mode: closed_loop",
                       "mode: closed_loop, last_burn: as_planned"),
      "campaign.yaml:7:42: guidance.last_burn: no coast precedes the last burn of 'electron', so nothing "
      "can be planned before its ignition, allowed: steered\n");
  EXPECT_EQ(
      GuidanceProblems("electron", "vehicle.yaml",
                       "        cut_off: {at: inertial_velocity, velocity_m_s: 7898.27}", "       "),
      "campaign.yaml:7:18: guidance.mode: the last burn of 'electron' follows the one before at once and "
      "ends by itself: guidance can change neither its beginning nor its end, allowed: open_loop, or a "
      "last stage with ignition: {trigger: timer} or with a liquid engine that has cut_off: {at: "
      "inertial_velocity}, {at: target} or {at: time}\n");
}

TEST(GuidedBurns, AreThoseThatThereAre) {
  EXPECT_EQ(GuidanceProblems("vega", "campaign.yaml", "mode: closed_loop", "mode: closed_loop, burns: 5"),
            "");
  EXPECT_EQ(GuidanceProblems("vega", "campaign.yaml", "mode: closed_loop", "mode: closed_loop, burns: 6"),
            "campaign.yaml:7:38: guidance.burns: 'vega' has 5 burns, allowed: up to 5\n");
  // With timers guidance has what it needs.
  EXPECT_EQ(GuidanceProblems("vega", "vehicle.yaml", kAgain, "    cut_off: {at: time, after_s: 100}\n"), "");
}

// A place along the orbit needs a coast, or a burn before, that guidance can change.
TEST(GuidedPlace, IsOutOfReachOfASingleBurn) {
  const std::string said = "with a true anomaly (at the perigee: 0) it is a place along the orbit";
  for (const bool is_anywhere : {false, true}) {
    const InputFiles files;
    for (const char* name : {"vehicle.yaml", "reference.yaml", "autopilot.yaml", "campaign.yaml"})
      files.Write(name, TextOfFile(DISPERSA_CAMPAIGNS "/gallery/electron/" + std::string(name)));
    files.Edit("reference.yaml", "apogee_altitude_km: 600}",
               std::string("apogee_altitude_km: 600, argument_of_perigee_deg: 180") +
                   (is_anywhere ? ", entered_at: anywhere}" : "}"));
    files.Edit("reference.yaml", "flight_path_angle_per_deg: 10}",
               "flight_path_angle_per_deg: 10, argument_of_perigee_per_deg: 1}");
    const FileCheck checked = CheckFile(files.Path("campaign.yaml"));
    ASSERT_EQ(files.Texts(checked.errors), "");
    EXPECT_EQ(files.Texts(checked.warnings).find(said) == std::string::npos, is_anywhere)
        << files.Texts(checked.warnings);
  }
}

}  // namespace
}  // namespace dispersa::campaign_yaml_restart_test
