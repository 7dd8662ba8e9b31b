// Consequences of a vehicle's numbers, compared with physics and known launchers: every check, with the full
// text.
#include "core/vehicle/plausibility.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "core/campaign_yaml/load.h"
#include "core/math/constants.h"
#include "core/vehicle/mass.h"
#include "core/vehicle/vehicle_figures.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::vehicle_plausibility_test {
namespace {

/// The sample's two stages with the propellant that solid motors of their size hold, about which nothing is
/// unusual.
Vehicle UsualVehicle() {
  Vehicle vehicle = SampleVehicle();
  vehicle.stages[0].propellant_mass_kg = 9200.0;  // 6.03 m3 of grain: 1525 kg/m3
  vehicle.stages[0].motor.burning_time_s = 100.0;
  vehicle.stages[1].propellant_mass_kg = 2600.0;  // 1.70 m3: 1533 kg/m3
  vehicle.stages[1].motor.burning_time_s = 120.0;
  vehicle.profile = {{ProfileShape::kCone, 2.0, 1.2}, {ProfileShape::kCylinder, 18.0, 1.2}};
  return vehicle;
}

std::vector<std::string> Texts(const Vehicle& vehicle) {
  std::vector<std::string> texts;
  for (const PlausibilityFinding& f : Plausibility(vehicle))
    texts.push_back((f.impossible ? "impossible " : "unusual ") + f.path + " " + f.message + " | " +
                    f.allowed);
  return texts;
}

TEST(VehicleFigures, AreThoseOfTheRocketEquation) {
  Vehicle vehicle = UsualVehicle();
  vehicle.stages[0].motor.nozzle_exit_area_m2 = 0.2;
  vehicle.hold_down_s = 1.0;  // burns 92 kg
  const std::vector<StageFigures> figures = FiguresOf(vehicle);
  ASSERT_EQ(figures.size(), 2u);
  EXPECT_DOUBLE_EQ(figures[0].own_mass_kg, 10000.0);
  EXPECT_DOUBLE_EQ(figures[0].dry_mass_kg, 800.0);
  EXPECT_DOUBLE_EQ(figures[0].structural_fraction, 0.08);
  EXPECT_DOUBLE_EQ(figures[0].flow_kg_s, 92.0);
  EXPECT_DOUBLE_EQ(figures[0].specific_impulse_s, 200e3 / (92.0 * 9.80665));
  EXPECT_NEAR(figures[0].ideal_delta_v_m_s, 200e3 / 92.0 * std::log(13000.0 / 3800.0), 1e-9);
  EXPECT_NEAR(figures[0].thrust_to_weight, (200e3 - 0.2 * 101325.0) / ((13000.0 - 92.0) * 9.80665), 1e-12);
  EXPECT_DOUBLE_EQ(figures[0].burnout_load_g, 200e3 / (3800.0 * 9.80665));
  EXPECT_DOUBLE_EQ(figures[1].thrust_to_weight, 50e3 / (3000.0 * 9.80665));
}

// The same impulse with a hump late in the burn: what lifts off is the thrust of the first second.
TEST(VehicleFigures, OfAThrustCurveAreThoseOfItsTimes) {
  Vehicle vehicle = UsualVehicle();
  vehicle.hold_down_s = 0.5;
  SetThrustCurve({{0.0, 0.2, 2.0, 60.0, 100.0, 106.0}, {0.0, 180e3, 170e3, 240e3, 120e3, 0.0}},
                 vehicle.stages[0].motor);
  const MotorBurn burn = BuildBurn(vehicle.stages[0], 1.0, 1.0);
  const double impulse_n_s = 18e3 + 315e3 + 11890e3 + 7200e3 + 360e3;
  const std::vector<StageFigures> figures = FiguresOf(vehicle);
  EXPECT_EQ(figures[0].burning_time_s, 106.0);
  EXPECT_DOUBLE_EQ(figures[0].flow_kg_s, 9200.0 / 106.0);
  EXPECT_NEAR(figures[0].specific_impulse_s, impulse_n_s / 9200.0 / 9.80665, 1e-9);
  const double released_n = 180e3 - 10e3 * 0.3 / 1.8;  // falls from 0.2 s on
  EXPECT_NEAR(figures[0].thrust_to_weight, released_n / ((3800.0 + burn.Propellant(0.5)) * 9.80665), 1e-9);
  EXPECT_NEAR(
      figures[0].burnout_load_g,
      std::max(240e3 / (3800.0 + burn.Propellant(60.0)), 120e3 / (3800.0 + burn.Propellant(100.0))) / 9.80665,
      1e-9);
}

TEST(VehiclePlausibility, NamesTheCurveInPlaceOfTheThrust) {
  Vehicle vehicle = UsualVehicle();
  SetThrustCurve({{0.0, 50.0, 100.0}, {100e3, 300e3, 0.0}}, vehicle.stages[0].motor);
  const std::vector<std::string> texts = Texts(vehicle);
  ASSERT_EQ(texts.size(), 1u);
  EXPECT_EQ(texts[0].rfind(
                "impossible stages[0].motor.thrust_curve implies a thrust to weight at lift-off of 0.8", 0),
            0u)
      << texts[0];
}

TEST(VehicleFigures, PressureOfTheSiteIsTheStandards) {
  EXPECT_EQ(SitePressure(0.0), 101325.0);
  EXPECT_NEAR(SitePressure(5000.0), 54048.0, 60.0);  // its table, at that geometric altitude
  EXPECT_NEAR(SitePressure(11000.0), 22700.0, 80.0);
}

TEST(VehiclePlausibility, AUsualVehicleIsNoNews) {
  EXPECT_EQ(Texts(UsualVehicle()), std::vector<std::string>{});
}

// A textbook's vehicle is warned about and not refused: the finding stays, with the usual span.
TEST(VehiclePlausibility, WhatCannotBeIsUnusualOfAMadeUpVehicle) {
  Vehicle vehicle = UsualVehicle();
  vehicle.reaction_control.specific_impulse_s = 7000.0;
  vehicle.made_up = true;
  EXPECT_EQ(Texts(vehicle),
            std::vector<std::string>{
                "unusual reaction_control.specific_impulse_s is 7000 s | 30 to 340 s (cold gas 40 to "
                "75 s, hydrazine 220 to 240 s, two propellants to 330 s)"});
  vehicle.made_up = false;
  EXPECT_EQ(Texts(vehicle),
            std::vector<std::string>{
                "impossible reaction_control.specific_impulse_s is 7000 s, which cannot be | up to "
                "1000 s (cold gas 40 to 75 s, hydrazine 220 to 240 s, two propellants to 330 s)"});
}

// What a restarted engine's last burn has is checked too, at the place where the file has it.
TEST(VehiclePlausibility, OfARestartIsThatOfItsBody) {
  Vehicle vehicle = LoadVehicle(DISPERSA_CAMPAIGNS "/gallery/falcon9/vehicle.yaml");
  EXPECT_EQ(Texts(vehicle), std::vector<std::string>{});
  ASSERT_TRUE(vehicle.stages[2].restarts);
  vehicle.stages[2].jettisoned[0].threshold = 10.0;
  vehicle.stages[2].motor.cut_off = CutOff::kAtVelocity;
  vehicle.stages[2].motor.cut_off_velocity_m_s = 78e3;
  const std::vector<std::string> texts = Texts(vehicle);
  ASSERT_EQ(texts.size(), 2u);
  EXPECT_EQ(texts[0].find("unusual stages[1].jettisoned[0].at.time_s comes 10 s after lift-off"), 0u)
      << texts[0];
  EXPECT_EQ(texts[1].find("impossible stages[2].cut_off.velocity_m_s is, as an inertial speed, 78000 m/s"),
            0u)
      << texts[1];
}

TEST(VehiclePlausibility, BoostersHaveAGimbalAndAMotorToo) {
  Vehicle vehicle = LoadVehicle(DISPERSA_CAMPAIGNS "/gallery/ariane5/vehicle.yaml");
  EXPECT_EQ(Texts(vehicle), std::vector<std::string>{});
  vehicle.boosters.gimbal.bandwidth_rad_s = 0.3;
  ThrustCurve& curve = vehicle.boosters.motor.thrust_curve;
  curve.pressure_pa.assign(curve.time_s.size(), 6e6);
  const std::vector<std::string> texts = Texts(vehicle);
  ASSERT_EQ(texts.size(), 2u);
  EXPECT_EQ(texts[0].find("unusual boosters.motor.thrust_curve.table.chamber_pressure makes thrust over "
                          "pressure change"),
            0u)
      << texts[0];
  EXPECT_EQ(texts[1].find("impossible boosters.gimbal.bandwidth_rad_s is 0.3 rad/s"), 0u) << texts[1];
}

struct Slip {
  const char* name;
  std::function<void(Vehicle&)> make;
  std::vector<std::string> texts;
};
void PrintTo(const Slip& slip, std::ostream* out) { *out << slip.name; }

class VehicleSlips : public testing::TestWithParam<Slip> {};

TEST_P(VehicleSlips, AreNamedInFull) {
  Vehicle vehicle = UsualVehicle();
  GetParam().make(vehicle);
  EXPECT_EQ(Texts(vehicle), GetParam().texts);
}

const std::string kImpulse =
    "200 to 410 s of solid and liquid rockets: Sutton and Biblarz, Rocket Propulsion Elements, 7th ed., "
    "table 2-1; "
    "465 s of hydrogen stages in vacuum; combustion never gave more than 550 s, reactors 900 s)";
const std::string kLiftOff =
    "Saturn V 1.2, solid launchers 1.6 to 2.5, sounding rockets to 12; below 1 it never leaves the pad)";

INSTANTIATE_TEST_SUITE_P(
    Each, VehicleSlips,
    testing::Values(
        Slip{"NewtonsForKilonewtons",
             [](Vehicle& v) { v.stages[1].motor.thrust_n = 50.0; },
             {"unusual stages[1].propellant_mass_kg implies with thrust and burning time a specific impulse "
              "of 0.2353 s "
              "| 180 to 470 s (" +
                  kImpulse,
              "unusual stages[1].motor.thrust_n implies a thrust to weight at ignition of 0.0017 | 0.05 to "
              "12 (small "
              "liquid upper stages from 0.08, solid ones to 8)",
              "unusual stages[1].motor.thrust_n implies towards burnout a load of 0.01275 g | 0.05 to 20 g "
              "(user's manuals of "
              "solid launchers state up to 13 g)"}},
        Slip{"BurningTimeTenfold",
             [](Vehicle& v) { v.stages[0].motor.burning_time_s = 1000.0; },
             {"impossible stages[0].propellant_mass_kg implies with thrust and burning time a specific "
              "impulse of 2217 s, "
              "which cannot be | up to 1000 s (" +
                  kImpulse,
              "unusual stages imply together an ideal change of velocity, without losses, of 31388 m/s | 500 "
              "to 14000 "
              "m/s (low orbits ask 9 to 10 km/s with losses, sounding rockets 1 to 4 km/s)"}},
        Slip{"ThrustBelowWeight",
             [](Vehicle& v) {
               v.stages[0].motor.thrust_n = 120e3;
               v.stages[0].motor.burning_time_s = 160.0;
             },
             {"impossible stages[0].motor.thrust_n implies a thrust to weight at lift-off of 0.9413, which "
              "cannot be | 1 "
              "or more (" +
              kLiftOff}},
        Slip{"NozzleThatTheAirHoldsDown",
             [](Vehicle& v) { v.stages[0].motor.nozzle_exit_area_m2 = 0.8; },
             {"impossible stages[0].motor.thrust_n implies a thrust to weight at lift-off of 0.933, which "
              "cannot be | 1 or "
              "more (" +
              kLiftOff}},
        Slip{"ThrustOfOneNozzleTakenForAllFour",
             [](Vehicle& v) {
               v.stages[1].motor.thrust_n *= 4.0;
               v.stages[1].motor.burning_time_s /= 4.0;
             },
             {"unusual stages[1].motor.thrust_n implies towards burnout a load of 50.99 g | 0.05 to 20 g "
              "(user's "
              "manuals of "
              "solid launchers state up to 13 g)"}},
        Slip{"HeavyStage",
             [](Vehicle& v) {
               v.stages[0].liftoff_mass_kg = 20000.0;
               v.stages[0].motor.thrust_n = 260e3;
             },
             {"unusual stages[0].liftoff_mass_kg implies a dry mass of the stage, as part of its own, of "
              "0.4588 | 0.03 to "
              "0.35 (0.05 of large liquid stages, 0.07 to 0.15 of solid ones, more only of the smallest)"}},
        Slip{"NoPayload",
             [](Vehicle& v) {
               v.stages[1].liftoff_mass_kg = 2700.0;
               v.stages[0].liftoff_mass_kg = 12700.0;
               v.stages[1].motor.thrust_n = 15e3;
               v.stages[1].motor.burning_time_s = 400.0;
             },
             {"unusual stages[1].liftoff_mass_kg implies a dry mass of the last stage with payload, as part "
              "of its own, "
              "of 0.03704 | 0.05 to 0.95 (0.2 to 0.8 of upper stages with what they carry)"}},
        Slip{
            "LightGrain",
            [](Vehicle& v) { v.stages[0].grain.top_station_m = 11.0; },
            {"unusual stages[0].grain implies a propellant density of 1307 kg/m3 | 1500 to 1950 kg/m3 (solid "
             "propellants: Sutton and Biblarz, table 12-1)"}},
        Slip{"GrainOutsideTheStage",
             [](Vehicle& v) {
               v.stages[1].grain.outer_diameter_m = 1.05;
               v.stages[1].grain.inner_diameter_m = 0.65;
             },
             {"impossible stages[1].grain.outer_diameter_m is, as part of the stage's diameter_m, 1.05, "
              "which cannot be | "
              "up to 1 (the propellant is inside)"}},
        Slip{"StageOutsideTheProfile",
             [](Vehicle& v) { v.stages[0].diameter_m = 1.3; },
             {"unusual stages[0].diameter_m is, as part of the profile's largest diameter about the first "
              "stage's propellant, 1.083 | 0.7 to 1.02 (1 where the case is the skin; no fairing is about a "
              "first stage)"}},
        Slip{"NozzleWiderThanTheBase",
             [](Vehicle& v) { v.stages[1].motor.nozzle_exit_area_m2 = 1.0; },
             {"unusual stages[1].motor.nozzle_exit_area_m2 is, as part of the stage's cross-section, 1.273 | "
              "0.02 to 1 "
              "(the nozzles end inside the base, or inside the interstage below)"}},
        Slip{"AnotherPublishedFlow",
             [](Vehicle& v) { v.stages[0].motor.published_mass_flow_kg_s = 46.0; },
             {"unusual stages[0].motor.published_mass_flow_kg_s is the flow that propellant and burning time "
              "give times "
              "0.5 | 0.8 to 1.25 (near 1: what a source prints as mean flow)"}},
        Slip{"RadiansForDegrees",
             [](Vehicle& v) { v.stages[0].gimbal.limit_rad = 6.0; },
             {"impossible stages[0].gimbal.limit_rad lets a nozzle turn by 343.8 deg, which cannot be | up "
              "to 89 deg (the "
              "Space Shuttle's boosters 8 deg, its main engines 10.5 deg)"}},
        Slip{"HingesOutsideTheBase",
             [](Vehicle& v) { v.stages[1].gimbal.radius_m = 0.6; },
             {"unusual stages[1].gimbal.radius_m is, as part of half the stage's diameter_m, 1.2 | up to 1 "
              "(the hinges are "
              "inside the base)"}},
        Slip{"NozzleWithoutExtent",
             [](Vehicle& v) {
               for (Stage& stage : v.stages) {
                 stage.gimbal.nozzle_mass_kg = 20.0;
                 stage.gimbal.nozzle_cg_m = 0.5;
                 stage.gimbal.nozzle_inertia_kg_m2 = 8.0;
               }
               v.stages[1].gimbal.nozzle_inertia_kg_m2 = 4.0;
             },
             {"impossible nozzles[1].inertia_about_hinge_kg_m2 is the nozzle's mass at its centre of "
              "gravity, about the "
              "hinge, times 0.8, which cannot be | 1 or more (the parallel axis theorem: above 1 by the "
              "nozzle's own "
              "extent)"}},
        Slip{"SensorsBehindTheVehicle",
             [](Vehicle& v) {
               v.sensors.inertial_unit_station_m = 25.0;
               v.sensors.rate_gyros = {{.name = "gyro", .station_m = 30.0}};
             },
             {"impossible sensors.rate_gyros[0].station_m lies, as part of the vehicle's length, 1.5, which "
              "cannot be | up "
              "to 1 (inside the body)",
              "impossible sensors.inertial_unit.station_m lies, as part of the vehicle's length, 1.25, which "
              "cannot be | "
              "up to 1 (inside the body)"}},
        Slip{"StoutVehicle",
             [](Vehicle& v) {
               v.profile = {{ProfileShape::kCone, 2.0, 6.0}, {ProfileShape::kCylinder, 18.0, 6.0}};
             },
             {"unusual stages[0].diameter_m is, as part of the profile's largest diameter about the first "
              "stage's propellant, 0.2 | 0.7 to 1.02 (1 where the case is the skin; no fairing is about a "
              "first stage)",
              "unusual stages[1].diameter_m is, as part of the profile's largest diameter about this stage's "
              "propellant, "
              "0.1667 | 0.4 to 1.02 (1 where the case is the skin, less inside a wider fairing)",
              "unusual profile implies a length, in diameters, of 3.333 | 4 to 30 (Vega 10, Saturn V 11, "
              "Falcon 9 19, "
              "Scout 20)"}},
        Slip{"GasThatCannotBe",
             [](Vehicle& v) { v.reaction_control.specific_impulse_s = 7000.0; },
             {"impossible reaction_control.specific_impulse_s is 7000 s, which cannot be | up to 1000 s "
              "(cold gas 40 to 75 "
              "s, hydrazine 220 to 240 s, two propellants to 330 s)"}},
        Slip{"ThrustFromTheAir",
             [](Vehicle& v) {
               v.aerodynamics[0].ca = {-0.3, -0.3, -0.3, -0.3};
             },
             {"impossible aerodynamics.tables[0].table.ca is at least -0.3, which cannot be | 0 or more (the "
              "air "
              "resists; skin friction alone gives 0.05 to 0.1)",
              "impossible aerodynamics.tables[0].table.ca is at most, at the smallest incidence, -0.3, which "
              "cannot "
              "be | up to 20 (0.2 to 1.2 of launchers, about 1.5 of a blunt face)"}},
        Slip{"AThousandfoldDrag",
             [](Vehicle& v) {
               v.aerodynamics[1].ca = {300.0, 300.0, 300.0, 300.0};
             },
             {"impossible aerodynamics.tables[1].table.ca is at most, at the smallest incidence, 300, which "
              "cannot "
              "be | up to 20 (0.2 to 1.2 of launchers, about 1.5 of a blunt face)"}},
        Slip{"LiftWithoutIncidence",
             [](Vehicle& v) {
               v.aerodynamics[0].cn = {0.2, 3.0, 0.2, 3.0};
             },
             {"impossible aerodynamics.tables[0].table.cn is at an incidence of 0 0.2, which cannot be | "
              "-0.05 to "
              "0.05 (a body of revolution has no normal force there: incidence is the total angle between "
              "axis and "
              "flow)"}},
        Slip{"RadiansUnderDegrees",
             [](Vehicle& v) {
               v.aerodynamics[0].incidence_rad = {0.0, 0.5 * kRadPerDeg};
               v.aerodynamics[0].cn = {0.0, 1.5, 0.0, 1.5};
             },
             {"unusual aerodynamics.tables[0].table.incidence_deg ends at 0.5 deg | 5 to 180 deg (dispersed "
              "flights "
              "meet 5 to 10 deg; a range to 3.14 may be in radians)",
              "unusual aerodynamics.tables[0].table.cn rises from an incidence of 0 by at most 171.9 a "
              "radian | up to "
              "40 a radian (2 to 4 of bodies, to 30 of finned rockets on their cross-section; 57 times as "
              "much has "
              "radians under degrees)"}},
        Slip{"TransonicTableAlone",
             [](Vehicle& v) {
               v.aerodynamics[0].mach = {0.95, 1.1};
             },
             {"unusual aerodynamics.tables[0].table.mach begin at 0.95 | up to 0.9 (a launcher is at rest "
              "before it "
              "flies; below the first one its values hold)",
              "unusual aerodynamics.tables[0].table.mach end at 1.1 | 2 to 50 (a first stage burns out at "
              "Mach 4 "
              "to 10, an orbit is at 25; above the last one its values hold)"}},
        Slip{"UpperTableOfAnotherUnit",
             [](Vehicle& v) {
               v.aerodynamics[1].mach = {0.0, 500.0};
             },
             {"unusual aerodynamics.tables[1].table.mach end at 500 | 2 to 50 (a first stage burns out at "
              "Mach "
              "4 to 10, an orbit is at 25; above the last one its values hold)"}},
        Slip{"NozzlesFarOutside",
             [](Vehicle& v) {
               v.stages[0].gimbal.nozzles = {{"centre"}, {"ring"}};
               v.stages[0].gimbal.nozzles[1].ring = {8, 1300.0};
             },
             {"unusual stages[0].gimbal.nozzles are, as part of half the stage's diameter_m, off the axis by "
              "up "
              "to 2167 | up to 1.5 (engines stand in the base, verniers beside it)"}},
        Slip{"PressureKilometresAft",
             [](Vehicle& v) {
               v.aerodynamics[0].xcp_station_m = {4.0, 4.0, 2600.0, 4.0};
             },
             {"impossible aerodynamics.tables[0].table.xcp_station_m lies, as part of the stack's length, at "
              "most "
              "130, which cannot be | -1 to 2 (the air presses on the body)"}},
        Slip{"PressureKilometresAftInYaw",
             [](Vehicle& v) {
               AeroTable yaw = v.aerodynamics[0];
               yaw.xcp_station_m = {4.0, 4.0, 2600.0, 4.0};
               v.aerodynamics[0].yaw_plane = {yaw};
             },
             {"impossible aerodynamics.tables[0].table.xcp_side_station_m lies, as part of the stack's "
              "length, "
              "at most "
              "130, which cannot be | -1 to 2 (the air presses on the body)"}},
        Slip{"DampingThatDrives",
             [](Vehicle& v) {
               v.aerodynamics[0].cmq_per_rad = {-40.0, 40.0};
             },
             {"impossible aerodynamics.tables[0].table.cmq_per_rad is at most 40, which cannot be | up to 0 "
              "(the air "
              "takes from a turning body; above 0 it drives it)"}},
        Slip{
            "SlowActuator",
            [](Vehicle& v) { v.stages[0].gimbal.bandwidth_rad_s = 0.3; },
            {"impossible stages[0].gimbal.bandwidth_rad_s is 0.3 rad/s, which cannot be | 1 to 2000 rad/s "
             "(actuators of nozzles have 2 to 20 Hz; slower ones hold no launcher that the air turns over)"}},
        Slip{"LatitudeAndLongitudeSwapped",
             [](Vehicle& v) { v.site.latitude_rad = -80.6 * kRadPerDeg; },
             {"unusual site.latitude_rad is -80.6 deg | -45 to 79.5 deg (launch sites lie between 39.3 deg "
              "south (Mahia) and 78.9 deg north (Ny-Alesund); latitude and longitude may have changed "
              "places)"}},
        Slip{"PressureLimitOfABreeze",
             [](Vehicle& v) { v.limits.q_max_pa = 40.0; },
             {"unusual limits.q_max_pa is 40 Pa | 5000 to 300000 Pa (launchers meet 20,000 to 90,000 Pa)"}},
        Slip{
            "FairingThatLeavesInTheAir",
            [](Vehicle& v) {
              Jettison fairing;
              fairing.name = "fairing";
              fairing.mass_kg = 10.0;
              fairing.trigger = JettisonTrigger::kAtTime;
              fairing.threshold = 10.0;
              v.stages[0].jettisoned = {fairing};
            },
            {"unusual stages[0].jettisoned[0].at.time_s comes 10 s after lift-off | 90 to 1000 s after "
             "lift-off "
             "(fairings leave 150 to 300 s after lift-off, above 100 km; sooner the payload meets the air)"}},
        Slip{"KilonewtonsOfReactionControl",
             [](Vehicle& v) { v.reaction_control.thrust_n = 20e3; },
             {"unusual reaction_control.thrust_n turns the last stage in pitch and yaw by 369 deg/s2 | "
              "0.01 to 60 "
              "deg/s2 (a rate of 1 deg/s should take neither minutes nor less than a cycle to stop)"}}),
    [](const auto& bad) { return std::string(bad.param.name); });

// A row of a table of checks: what sets its value, a value just inside and one just outside, and the text of
// that one up to its source. Nothing else of the vehicle is said.
struct Edge {
  const char* name;
  void (*set)(Vehicle&, double);
  double inside, outside;
  std::string text;
};
void PrintTo(const Edge& edge, std::ostream* out) { *out << edge.name; }

class VehicleEdges : public testing::TestWithParam<Edge> {};

TEST_P(VehicleEdges, AreWhereTheTableSays) {
  Vehicle vehicle = UsualVehicle();
  GetParam().set(vehicle, GetParam().inside);
  EXPECT_EQ(Texts(vehicle), std::vector<std::string>{});
  GetParam().set(vehicle, GetParam().outside);
  const std::vector<std::string> texts = Texts(vehicle);
  ASSERT_EQ(texts.size(), 1u) << testing::PrintToString(texts);
  EXPECT_EQ(texts[0].substr(0, GetParam().text.size()), GetParam().text);
  EXPECT_EQ(texts[0].substr(GetParam().text.size(), 2), " (");
}

const std::string kTable = "aerodynamics.tables[0].table.";

// One of two Mach numbers alone is changed: the least is told from the greatest.
void SetAxial(Vehicle& v, double x) { v.aerodynamics[0].ca = {0.3, 0.3, x, 0.3}; }
void SetPowerOff(Vehicle& v, double x) { v.aerodynamics[0].ca_power_off = {0.3, 0.3, 0.3 + x, 0.3}; }
void SetSlope(Vehicle& v, double x) { v.aerodynamics[0].cn = {0.0, 3.0, 0.0, x}; }
void SetPlace(Vehicle& v, double x) { v.aerodynamics[0].xcp_station_m = {4.0, 4.0, 20.0 * x, 4.0}; }
void SetPitchDamping(Vehicle& v, double x) { v.aerodynamics[0].cmq_per_rad = {-1.0, x}; }
void SetRollDamping(Vehicle& v, double x) { v.aerodynamics[0].clp_per_rad = {-1.0, x}; }
// Pressure by thrust but at one time; the tail, below half of the thrust, is far off.
void SetPressure(Vehicle& v, double megapascals, double part) {
  ThrustCurve curve{{0.0, 50.0, 99.0, 100.0}, {200e3, 200e3, 101e3, 90e3}};
  for (const double thrust_n : curve.thrust_n)
    curve.pressure_pa.push_back(megapascals * 1e6 * thrust_n / 200e3);
  curve.pressure_pa[2] /= part;
  curve.pressure_pa[3] *= 0.01;
  SetThrustCurve(curve, v.stages[0].motor);
}
void SetGreatestPressure(Vehicle& v, double x) { SetPressure(v, x, 1.0); }
void SetPressureSpread(Vehicle& v, double x) { SetPressure(v, 6.0, x); }
void SetLatitude(Vehicle& v, double x) { v.site.latitude_rad = x * kRadPerDeg; }
void SetParachute(Vehicle& v, double x) {
  v.descent.parachute_area_m2 = 10.0;
  v.descent.ground_altitude_m = 1400.0;
  v.descent.parachute_altitude_m = 1400.0 + x;
}
void SetPivot(Vehicle& v, double x) { v.stages[1].gimbal.pivot_station_m = 11.0 * x; }
void SetFins(Vehicle& v, double leading_m, double chord_m) {
  v.stages[0].fins = {FinSet{}, FinSet{}};
  for (FinSet& fins : v.stages[0].fins) {
    fins.leading_edge_station_m = 18.0;
    fins.root_chord_m = 1.0;
  }
  v.stages[0].fins[1].leading_edge_station_m = leading_m;
  v.stages[0].fins[1].root_chord_m = chord_m;
}
void SetFinsEnd(Vehicle& v, double x) { SetFins(v, 19.0, 20.0 * x - 19.0); }
void SetFinsAbove(Vehicle& v, double x) { SetFins(v, 11.0 + x, 1.0); }
void SetFinsBegin(Vehicle& v, double x) { SetFins(v, 20.0 * x, 0.1); }
void SetProfile(Vehicle& v, double x) {
  v.profile = {{ProfileShape::kCone, 2.0, 1.2 / x}, {ProfileShape::kCylinder, 18.0, 1.2 / x}};
}
void SetMargin(Vehicle& v, double x) {
  v.stages.resize(1);
  v.aerodynamics.resize(1);
  Stage& stage = v.stages[0];
  stage.gimbal = FixedNozzle(19.5);
  stage.motor.thrust_n = 500e3;
  stage.motor.burning_time_s = 40.0;
  const StackMass stack = BuildStackMasses(v)[0];
  const double cg_m = stack.At(stack.propellant_mass_kg).cg_station_m;
  v.aerodynamics[0].reference_length_m = 1.2;
  v.aerodynamics[0].xcp_station_m.assign(4, cg_m + 1.2 * x);
}

// Values that one number alone sets.
void SetReferenceArea(Vehicle& v, double x) { v.aerodynamics[0].reference_area_m2 = 0.25 * kPi * 1.44 * x; }
void SetReferenceLength(Vehicle& v, double x) { v.aerodynamics[0].reference_length_m = 1.2 * x; }
void SetFirstMach(Vehicle& v, double x) { v.aerodynamics[0].mach = {x, 10.0}; }
void SetLastMach(Vehicle& v, double x) { v.aerodynamics[1].mach = {0.0, x}; }
void SetLastIncidence(Vehicle& v, double x) {
  v.aerodynamics[0].incidence_rad = {0.0, x * kRadPerDeg};
  v.aerodynamics[0].cn = {0.0, 3.0 * x * kRadPerDeg, 0.0, 3.0 * x * kRadPerDeg};
}
void SetAxialUncertainty(Vehicle& v, double x) { v.aerodynamics[0].uncertainty.ca = {0.1, x}; }
void SetNormalUncertainty(Vehicle& v, double x) { v.aerodynamics[0].uncertainty.cn = {x, 0.1}; }
void SetPlaceUncertainty(Vehicle& v, double x) { v.aerodynamics[0].uncertainty.xcp_m = {0.1, 20.0 * x}; }
void SetForceAtZero(Vehicle& v, double x) { v.aerodynamics[0].cn = {0.0, 3.0, x, 3.0}; }
void SetGimbalLimit(Vehicle& v, double x) { v.stages[1].gimbal.limit_rad = x * kRadPerDeg; }
void SetBandwidth(Vehicle& v, double x) { v.stages[1].gimbal.bandwidth_rad_s = x; }
void SetRateLimit(Vehicle& v, double x) { v.stages[1].gimbal.rate_limit_rad_s = x * kRadPerDeg; }
void SetHinges(Vehicle& v, double x) { v.stages[1].gimbal.radius_m = 0.5 * x; }
void SetPublishedFlow(Vehicle& v, double x) { v.stages[0].motor.published_mass_flow_kg_s = 92.0 * x; }
void SetExitArea(Vehicle& v, double x) { v.stages[1].motor.nozzle_exit_area_m2 = 0.25 * kPi * x; }
void SetJettison(Vehicle& v, JettisonTrigger trigger, double threshold) {
  Jettison first, second;
  first.mass_kg = second.mass_kg = 10.0;
  first.trigger = JettisonTrigger::kAtTime;
  first.threshold = 200.0;
  second.trigger = trigger;
  second.threshold = threshold;
  v.stages[1].jettisoned = {first, second};
}
void SetJettisonTime(Vehicle& v, double x) { SetJettison(v, JettisonTrigger::kAtTime, x); }
void SetJettisonAltitude(Vehicle& v, double x) { SetJettison(v, JettisonTrigger::kAtAltitude, 1e3 * x); }
void SetJettisonFlux(Vehicle& v, double x) { SetJettison(v, JettisonTrigger::kAtHeatFlux, x); }
void SetPressureLimit(Vehicle& v, double x) { v.limits.q_max_pa = x; }
void SetProductLimit(Vehicle& v, double x) { v.limits.q_alpha_pa_rad = x; }
void SetAxialLimit(Vehicle& v, double x) { v.limits.axial_load_g = x; }
void SetThrusterImpulse(Vehicle& v, double x) { v.reaction_control.specific_impulse_s = x; }
void SetGyro(Vehicle& v, double x) {
  v.sensors.rate_gyros = {{.name = "one", .station_m = 1.0}, {.name = "other", .station_m = 20.0 * x}};
}
void SetInertialUnit(Vehicle& v, double x) { v.sensors.inertial_unit_station_m = 20.0 * x; }

INSTANTIATE_TEST_SUITE_P(
    Each, VehicleEdges,
    testing::Values(
        Edge{"LeastReferenceArea", SetReferenceArea, 0.301, 0.299,
             "unusual aerodynamics.tables[0].reference_area_m2 is the cross-section of the stack's lowest "
             "stage times 0.299 | 0.3 to 4"},
        Edge{"GreatestReferenceArea", SetReferenceArea, 3.99, 4.01,
             "unusual aerodynamics.tables[0].reference_area_m2 is the cross-section of the stack's lowest "
             "stage times 4.01 | 0.3 to 4"},
        Edge{"GreatestReferenceLength", SetReferenceLength, 1.99, 2.01,
             "unusual aerodynamics.tables[0].reference_length_m is the diameter of the stack's lowest stage "
             "times 2.01 | 0.5 to 2"},
        Edge{"FirstMach", SetFirstMach, 0.9, 0.91, "unusual " + kTable + "mach begin at 0.91 | up to 0.9"},
        Edge{"LastMach", SetLastMach, 2.0, 1.99,
             "unusual aerodynamics.tables[1].table.mach end at 1.99 | 2 to 50"},
        Edge{"LastIncidence", SetLastIncidence, 5.01, 4.99,
             "unusual " + kTable + "incidence_deg ends at 4.99 deg | 5 to 180 deg"},
        Edge{"AxialUncertainty", SetAxialUncertainty, 0.5, 0.51,
             "unusual " + kTable + "ca_uncertainty is, as one standard deviation, at most 0.51 | up to 0.5"},
        Edge{"NormalUncertainty", SetNormalUncertainty, 0.5, 0.51,
             "unusual " + kTable + "cn_uncertainty is, as one standard deviation, at most 0.51 | up to 0.5"},
        Edge{"PlaceUncertainty", SetPlaceUncertainty, 0.099, 0.101,
             "unusual " + kTable +
                 "xcp_uncertainty_m is, as one standard deviation and part of the stack's length, at most "
                 "0.101 | up to 0.1"},
        Edge{"ForceAtZero", SetForceAtZero, 0.001, 0.0011,
             "unusual " + kTable + "cn is at an incidence of 0 0.0011 | -0.001 to 0.001"},
        Edge{"NegativeForceAtZero", SetForceAtZero, -0.001, -0.0011,
             "unusual " + kTable + "cn is at an incidence of 0 -0.0011 | -0.001 to 0.001"},
        Edge{"GimbalLimit", SetGimbalLimit, 14.9, 15.1,
             "unusual stages[1].gimbal.limit_rad lets a nozzle turn by 15.1 deg | 1 to 15 deg"},
        Edge{"Bandwidth", SetBandwidth, 6.0, 5.9,
             "unusual stages[1].gimbal.bandwidth_rad_s is 5.9 rad/s | 6 to 250 rad/s"},
        Edge{"RateLimit", SetRateLimit, 119.0, 121.0,
             "unusual stages[1].gimbal.rate_limit_rad_s lets a nozzle turn at 121 deg/s | 2 to 120 deg/s"},
        Edge{"Hinges", SetHinges, 0.99, 1.01,
             "unusual stages[1].gimbal.radius_m is, as part of half the stage's diameter_m, 1.01 | up to 1"},
        Edge{"PublishedFlow", SetPublishedFlow, 1.24, 1.26,
             "unusual stages[0].motor.published_mass_flow_kg_s is the flow that propellant and burning time "
             "give times 1.26 | 0.8 to 1.25"},
        Edge{"ExitArea", SetExitArea, 0.021, 0.019,
             "unusual stages[1].motor.nozzle_exit_area_m2 is, as part of the stage's cross-section, 0.019 | "
             "0.02 to 1"},
        Edge{"JettisonTime", SetJettisonTime, 90.0, 89.0,
             "unusual stages[1].jettisoned[1].at.time_s comes 89 s after lift-off | 90 to 1000 s after "
             "lift-off"},
        Edge{"JettisonAltitude", SetJettisonAltitude, 200.0, 201.0,
             "unusual stages[1].jettisoned[1].at.altitude_m comes at 201 km | 60 to 200 km"},
        Edge{"JettisonFlux", SetJettisonFlux, 10.0, 9.0,
             "unusual stages[1].jettisoned[1].at.heat_flux_w_m2 waits for a free-molecular heating of 9 W/m2 "
             "| "
             "10 to 10000 W/m2"},
        Edge{"PressureLimit", SetPressureLimit, 5000.0, 4999.0,
             "unusual limits.q_max_pa is 4999 Pa | 5000 to 300000 Pa"},
        Edge{"ProductLimit", SetProductLimit, 200.0, 199.0,
             "unusual limits.q_alpha_pa_rad is 199 Pa rad | 200 to 30000 Pa rad"},
        Edge{"AxialLimit", SetAxialLimit, 50.0, 51.0, "unusual limits.axial_load_g is 51 g | 2 to 50 g"},
        Edge{"ThrusterImpulse", SetThrusterImpulse, 340.0, 341.0,
             "unusual reaction_control.specific_impulse_s is 341 s | 30 to 340 s"},
        Edge{"Gyro", SetGyro, 1.0, 1.01,
             "impossible sensors.rate_gyros[1].station_m lies, as part of the vehicle's length, 1.01, which "
             "cannot be | up to 1"},
        Edge{"InertialUnit", SetInertialUnit, 1.0, 1.01,
             "impossible sensors.inertial_unit.station_m lies, as part of the vehicle's length, 1.01, which "
             "cannot be | up to 1"},
        Edge{"LeastAxial", SetAxial, 0.02, 0.0199,
             "unusual " + kTable + "ca is at least 0.0199 | 0.02 or more"},
        Edge{"GreatestAxial", SetAxial, 2.0, 2.001,
             "unusual " + kTable + "ca is at most, at the smallest incidence, 2.001 | up to 2"},
        Edge{"LeastPowerOff", SetPowerOff, -0.0099, -0.0101,
             "unusual " + kTable +
                 "ca_power_off exceeds ca, at the smallest incidence, by at least -0.0101 | -0.01 to 0.5"},
        Edge{"GreatestPowerOff", SetPowerOff, 0.499, 0.501,
             "unusual " + kTable +
                 "ca_power_off exceeds ca, at the smallest incidence, by at most 0.501 | -0.01 to 0.5"},
        Edge{"LeastSlope", SetSlope, 0.5, 0.499,
             "unusual " + kTable +
                 "cn rises from an incidence of 0 by at least 0.499 a radian | 0.5 a radian or more"},
        Edge{"GreatestSlope", SetSlope, 40.0, 40.1,
             "unusual " + kTable +
                 "cn rises from an incidence of 0 by at most 40.1 a radian | up to 40 a radian"},
        Edge{"ForemostPressure", SetPlace, 0.0, -0.01,
             "unusual " + kTable +
                 "xcp_station_m lies, as part of the stack's length, at least -0.01 | up to 1"},
        Edge{"AftmostPressure", SetPlace, 1.0, 1.01,
             "unusual " + kTable +
                 "xcp_station_m lies, as part of the stack's length, at most 1.01 | up to 1"},
        Edge{"GreatestPitchDamping", SetPitchDamping, 0.0, 0.001,
             "impossible " + kTable + "cmq_per_rad is at most 0.001, which cannot be | up to 0"},
        Edge{"LeastPitchDamping", SetPitchDamping, -10000.0, -10001.0,
             "unusual " + kTable + "cmq_per_rad is at least -10001 | -10000 or more"},
        Edge{"GreatestRollDamping", SetRollDamping, 0.0, 0.001,
             "impossible " + kTable + "clp_per_rad is at most 0.001, which cannot be | up to 0"},
        Edge{"GreatestChamberPressure", SetGreatestPressure, 29.9, 30.1,
             "unusual stages[0].motor.thrust_curve.table.chamber_pressure is at most 30.1 MPa | 0.2 to 30 "
             "MPa"},
        Edge{"LeastChamberPressure", SetGreatestPressure, 0.201, 0.199,
             "unusual stages[0].motor.thrust_curve.table.chamber_pressure is at most 0.199 MPa | 0.2 to 30 "
             "MPa"},
        Edge{"PressureOfTheStrongPart", SetPressureSpread, 1.39, 1.41,
             "unusual stages[0].motor.thrust_curve.table.chamber_pressure makes thrust over pressure change, "
             "in the burn's strong part, by a factor of 1.41 | 1 to 1.4"},
        Edge{"NorthernmostSite", SetLatitude, 78.9, 80.2,
             "unusual site.latitude_rad is 80.2 deg | -45 to 79.5 deg"},
        Edge{"SouthernmostSite", SetLatitude, -39.3, -45.1,
             "unusual site.latitude_rad is -45.1 deg | -45 to 79.5 deg"},
        Edge{"ParachuteNearTheGround", SetParachute, 50.0, 49.0,
             "unusual descent.parachute.deployment_altitude_m is above the ground of the impact area by 49 m "
             "| "
             "50 m or more"},
        Edge{
            "ParachuteBelowTheGround", SetParachute, 300.0, -1.0,
            "impossible descent.parachute.deployment_altitude_m is above the ground of the impact area by -1 "
            "m, which cannot be | 0 m or more"},
        Edge{"NozzleBehindTheStage", SetPivot, 1.049, 1.051,
             "unusual stages[1].gimbal.pivot_station_m is, as part of the stage's bottom_station_m, 1.051 | "
             "up "
             "to 1.05"},
        Edge{"FinsThatEndBehindTheStage", SetFinsEnd, 1.019, 1.021,
             "unusual stages[0].fins[1].root_chord_m ends the root, as part of the stage's bottom_station_m, "
             "at 1.021 | up to 1.02"},
        Edge{"FinsOnTheStageAbove", SetFinsAbove, 0.0, -0.5,
             "unusual stages[0].fins[1].leading_edge_station_m begins the root, behind the bottom_station_m "
             "of "
             "the stage above, by -0.5 m | 0 m or more"},
        Edge{"FirstStageInAWiderProfile", SetProfile, 0.71, 0.69,
             "unusual stages[0].diameter_m is, as part of the profile's largest diameter about the first "
             "stage's propellant, 0.69 | 0.7 to 1.02"},
        Edge{
            "UnstableWithoutControl", SetMargin, 0.01, -0.01,
            "unusual stages[0].fins put the centre of pressure of the uncontrolled vehicle behind its centre "
            "of gravity, at lift-off, by -0.01 diameters | 0 diameters or more"}),
    [](const auto& edge) { return std::string(edge.param.name); });

// Figures that follow from several values: the setters move one and leave the others.
void SetImpulse(Vehicle& v, double x) {
  v.stages[0].motor.burning_time_s *= x / FiguresOf(v)[0].specific_impulse_s;
}
void Push(Stage& stage, double factor) {
  stage.motor.thrust_n *= factor;
  stage.motor.burning_time_s /= factor;
}
void SetLiftOff(Vehicle& v, double x) { Push(v.stages[0], x / FiguresOf(v)[0].thrust_to_weight); }
void SetIgnition(Vehicle& v, double x) { Push(v.stages[1], x / FiguresOf(v)[1].thrust_to_weight); }
void SetBurnoutLoad(Vehicle& v, double x) { Push(v.stages[1], x / FiguresOf(v)[1].burnout_load_g); }
void SetDryPart(Vehicle& v, double x) {
  v.stages[0].liftoff_mass_kg = v.stages[1].liftoff_mass_kg + v.stages[0].propellant_mass_kg / (1.0 - x);
}
void SetLastDryPart(Vehicle& v, double x) {
  v.stages[1].motor.thrust_n = 15e3;
  v.stages[1].motor.burning_time_s = 400.0;
  v.stages[1].liftoff_mass_kg = v.stages[1].propellant_mass_kg / (1.0 - x);
}
void SetGrainDensity(Vehicle& v, double x) {
  Grain& g = v.stages[1].grain;
  g.top_station_m =
      g.bottom_station_m - (g.bottom_station_m - g.top_station_m) * PropellantDensity(v.stages[1]) / x;
}
void SetGrainDiameter(Vehicle& v, double x) {
  v.stages[1].grain.outer_diameter_m = x * v.stages[1].diameter_m;
  v.stages[1].grain.inner_diameter_m = 0.0;
  SetGrainDensity(v, 1700.0);
}
void SetUpperDiameter(Vehicle& v, double x) { v.stages[1].diameter_m = 1.2 * x; }
void SetOffAxis(Vehicle& v, double x) {
  v.stages[0].gimbal.nozzles = {{"centre"}, {"ring"}};
  v.stages[0].gimbal.nozzles[1].ring = {8, 0.6 * x};
}
void SetNozzleInertia(Vehicle& v, double x) {
  for (Stage& stage : v.stages) {
    stage.gimbal.nozzle_mass_kg = 20.0;
    stage.gimbal.nozzle_cg_m = 0.5;
    stage.gimbal.nozzle_inertia_kg_m2 = 8.0;
  }
  v.stages[1].gimbal.nozzle_inertia_kg_m2 = 20.0 * 0.25 * x;
}
void SetDeltaV(Vehicle& v, double x) {
  double sum_m_s = 0.0;
  for (const StageFigures& one : FiguresOf(v)) sum_m_s += one.ideal_delta_v_m_s;
  for (Stage& stage : v.stages) stage.motor.burning_time_s *= x / sum_m_s;
}
void SetTurning(Vehicle& v, double x) {
  const StackMass stack = BuildStackMasses(v).back();
  v.reaction_control.thrust_n = x * kRadPerDeg * stack.At(stack.propellant_mass_kg).transverse_inertia_kg_m2 /
                                (2.0 * v.reaction_control.pitch_yaw_arm_m);
}
// Of two lighter tables the second, and of its two Mach numbers one.
void SetLighterAxial(Vehicle& v, double x) {
  AeroTable lighter = v.aerodynamics[0];
  v.aerodynamics[0].lighter.assign(2, {});
  for (auto& one : v.aerodynamics[0].lighter) one.table = lighter;
  v.aerodynamics[0].lighter[1].table.ca = {0.3, 0.3, x, 0.3};
}
void SetYawDamping(Vehicle& v, double x) {
  AeroTable yaw = v.aerodynamics[1];
  yaw.cmq_per_rad = {-1.0, x};
  v.aerodynamics[1].yaw_plane = {yaw};
}

INSTANTIATE_TEST_SUITE_P(
    Rows, VehicleEdges,
    testing::Values(
        Edge{"LeastImpulse", SetImpulse, 180.1, 179.9,
             "unusual stages[0].propellant_mass_kg implies with thrust and burning time a specific impulse "
             "of 179.9 s | 180 to 470 s"},
        Edge{"GreatestImpulse", SetImpulse, 469.9, 470.1,
             "unusual stages[0].propellant_mass_kg implies with thrust and burning time a specific impulse "
             "of 470.1 s | 180 to 470 s"},
        Edge{"LeastLiftOff", SetLiftOff, 1.151, 1.149,
             "unusual stages[0].motor.thrust_n implies a thrust to weight at lift-off of 1.149 | 1.15 to "
             "12"},
        Edge{"LeastIgnition", SetIgnition, 0.0501, 0.0499,
             "unusual stages[1].motor.thrust_n implies a thrust to weight at ignition of 0.0499 | 0.05 to "
             "12"},
        Edge{"GreatestBurnoutLoad", SetBurnoutLoad, 19.9, 20.1,
             "unusual stages[1].motor.thrust_n implies towards burnout a load of 20.1 g | 0.05 to 20 g"},
        Edge{"LeastDryPart", SetDryPart, 0.0301, 0.0299,
             "unusual stages[0].liftoff_mass_kg implies a dry mass of the stage, as part of its own, of "
             "0.0299 | 0.03 to 0.35"},
        Edge{"GreatestDryPart", SetDryPart, 0.349, 0.351,
             "unusual stages[0].liftoff_mass_kg implies a dry mass of the stage, as part of its own, of "
             "0.351 | 0.03 to 0.35"},
        Edge{"LeastDryPartOfTheLast", SetLastDryPart, 0.0501, 0.0499,
             "unusual stages[1].liftoff_mass_kg implies a dry mass of the last stage with payload, as part "
             "of its own, of 0.0499 | 0.05 to 0.95"},
        Edge{"LightestGrain", SetGrainDensity, 1501.0, 1499.0,
             "unusual stages[1].grain implies a propellant density of 1499 kg/m3 | 1500 to 1950 kg/m3"},
        Edge{"DensestGrain", SetGrainDensity, 1949.0, 1951.0,
             "unusual stages[1].grain implies a propellant density of 1951 kg/m3 | 1500 to 1950 kg/m3"},
        Edge{"ThinnestGrain", SetGrainDiameter, 0.501, 0.499,
             "unusual stages[1].grain.outer_diameter_m is, as part of the stage's diameter_m, 0.499 | 0.5 to "
             "1"},
        Edge{"UpperStageInItsProfile", SetUpperDiameter, 1.019, 1.021,
             "unusual stages[1].diameter_m is, as part of the profile's largest diameter about this stage's "
             "propellant, 1.021 | 0.4 to 1.02"},
        Edge{"FirstStageInAThinnerProfile", SetProfile, 1.019, 1.021,
             "unusual stages[0].diameter_m is, as part of the profile's largest diameter about the first "
             "stage's propellant, 1.021 | 0.7 to 1.02"},
        Edge{"NozzlesOffTheAxis", SetOffAxis, 1.49, 1.51,
             "unusual stages[0].gimbal.nozzles are, as part of half the stage's diameter_m, off the axis by "
             "up to 1.51 | up to 1.5"},
        Edge{"GreatestNozzleInertia", SetNozzleInertia, 9.9, 10.1,
             "unusual nozzles[1].inertia_about_hinge_kg_m2 is the nozzle's mass at its centre of gravity, "
             "about the hinge, times 10.1 | 1 to 10"},
        Edge{"LeastNozzleInertia", SetNozzleInertia, 1.01, 0.99,
             "impossible nozzles[1].inertia_about_hinge_kg_m2 is the nozzle's mass at its centre of "
             "gravity, about the hinge, times 0.99, which cannot be | 1 or more"},
        Edge{"GreatestDeltaV", SetDeltaV, 13990.0, 14010.0,
             "unusual stages imply together an ideal change of velocity, without losses, of 14010 m/s | 500 "
             "to 14000 m/s"},
        Edge{"SlowestTurning", SetTurning, 0.0101, 0.0099,
             "unusual reaction_control.thrust_n turns the last stage in pitch and yaw by 0.0099 deg/s2 | "
             "0.01 to 60 deg/s2"},
        Edge{"FastestTurning", SetTurning, 59.9, 60.1,
             "unusual reaction_control.thrust_n turns the last stage in pitch and yaw by 60.1 deg/s2 | 0.01 "
             "to 60 deg/s2"},
        Edge{"OfTheSecondLighterTable", SetLighterAxial, 2.0, 2.001,
             "unusual aerodynamics.tables[0].lighter[1].table.ca is at most, at the smallest incidence, "
             "2.001 | up to 2"},
        Edge{"GreatestYawDamping", SetYawDamping, 0.0, 0.001,
             "impossible aerodynamics.tables[1].table.cnr_per_rad is at most 0.001, which cannot be | up to "
             "0"},
        Edge{"LeastReferenceLength", SetReferenceLength, 0.501, 0.499,
             "unusual aerodynamics.tables[0].reference_length_m is the diameter of the stack's lowest stage "
             "times 0.499 | 0.5 to 2"},
        Edge{"GreatestLastMach", SetLastMach, 50.0, 50.1,
             "unusual aerodynamics.tables[1].table.mach end at 50.1 | 2 to 50"},
        Edge{"LeastGimbalLimit", SetGimbalLimit, 1.01, 0.99,
             "unusual stages[1].gimbal.limit_rad lets a nozzle turn by 0.99 deg | 1 to 15 deg"},
        Edge{"GreatestBandwidth", SetBandwidth, 250.0, 251.0,
             "unusual stages[1].gimbal.bandwidth_rad_s is 251 rad/s | 6 to 250 rad/s"},
        Edge{"LeastRateLimit", SetRateLimit, 2.01, 1.99,
             "unusual stages[1].gimbal.rate_limit_rad_s lets a nozzle turn at 1.99 deg/s | 2 to 120 deg/s"},
        Edge{"LeastPublishedFlow", SetPublishedFlow, 0.81, 0.79,
             "unusual stages[0].motor.published_mass_flow_kg_s is the flow that propellant and burning time "
             "give times 0.79 | 0.8 to 1.25"},
        Edge{"GreatestExitArea", SetExitArea, 0.99, 1.01,
             "unusual stages[1].motor.nozzle_exit_area_m2 is, as part of the stage's cross-section, 1.01 | "
             "0.02 to 1"},
        Edge{"LatestJettison", SetJettisonTime, 1000.0, 1001.0,
             "unusual stages[1].jettisoned[1].at.time_s comes 1001 s after lift-off | 90 to 1000 s after "
             "lift-off"},
        Edge{"LowestJettison", SetJettisonAltitude, 60.0, 59.0,
             "unusual stages[1].jettisoned[1].at.altitude_m comes at 59 km | 60 to 200 km"},
        Edge{"GreatestJettisonFlux", SetJettisonFlux, 9999.0, 10010.0,
             "unusual stages[1].jettisoned[1].at.heat_flux_w_m2 waits for a free-molecular heating of 10010 "
             "W/m2 | 10 to 10000 W/m2"},
        Edge{"GreatestPressureLimit", SetPressureLimit, 300e3, 301e3,
             "unusual limits.q_max_pa is 301000 Pa | 5000 to 300000 Pa"},
        Edge{"GreatestProductLimit", SetProductLimit, 30e3, 30100.0,
             "unusual limits.q_alpha_pa_rad is 30100 Pa rad | 200 to 30000 Pa rad"},
        Edge{"LeastAxialLimit", SetAxialLimit, 2.0, 1.99,
             "unusual limits.axial_load_g is 1.99 g | 2 to 50 g"},
        Edge{"LeastThrusterImpulse", SetThrusterImpulse, 30.0, 29.9,
             "unusual reaction_control.specific_impulse_s is 29.9 s | 30 to 340 s"}),
    [](const auto& edge) { return std::string(edge.param.name); });

// Rows of liquid stages and of boosters, on launchers of the gallery.
struct GalleryEdge {
  const char* name;
  const char* vehicle;
  void (*set)(Vehicle&, double);
  double inside, outside;
  std::string text;
};
void PrintTo(const GalleryEdge& edge, std::ostream* out) { *out << edge.name; }

class GalleryEdges : public testing::TestWithParam<GalleryEdge> {};

TEST_P(GalleryEdges, AreWhereTheTableSays) {
  const Vehicle usual =
      LoadVehicle(std::string(DISPERSA_CAMPAIGNS "/gallery/") + GetParam().vehicle + "/vehicle.yaml");
  Vehicle inside = usual, outside = usual;
  GetParam().set(inside, GetParam().inside);
  EXPECT_EQ(Texts(inside), std::vector<std::string>{});
  GetParam().set(outside, GetParam().outside);
  const std::vector<std::string> texts = Texts(outside);
  ASSERT_EQ(texts.size(), 1u) << testing::PrintToString(texts);
  EXPECT_EQ(texts[0].substr(0, GetParam().text.size() + 2), GetParam().text + " (");
}

void SetResidual(Vehicle& v, double x) {
  v.stages[0].motor.residual_mass_kg = x * v.stages[0].propellant_mass_kg;
}
void SetTankFill(Vehicle& v, double x) {
  Tank& tank = v.stages[0].tanks[1];
  tank.propellant_mass_kg = x * tank.density_kg_m3 * tank.Volume();
}
void SetTankDensity(Vehicle& v, double x) {
  Tank& tank = v.stages[0].tanks[1];
  tank.propellant_mass_kg *= x / tank.density_kg_m3;
  tank.density_kg_m3 = x;
}
void SetCutOffVelocity(Vehicle& v, double x) {
  v.stages[2].motor.cut_off = CutOff::kAtVelocity;
  v.stages[2].motor.cut_off_velocity_m_s = x;
}
void SetBoostersBottom(Vehicle& v, double x) {
  Boosters& b = v.boosters;
  const double part = b.nozzle_station_m / b.bottom_station_m;
  b.bottom_station_m = x * v.stages[0].bottom_station_m;
  b.nozzle_station_m = part * b.bottom_station_m;
}
void SetBoostersNozzle(Vehicle& v, double x) {
  v.boosters.nozzle_station_m = x * v.boosters.bottom_station_m;
}

INSTANTIATE_TEST_SUITE_P(
    Rows, GalleryEdges,
    testing::Values(
        GalleryEdge{"Residual", "falcon9", SetResidual, 0.0499, 0.0501,
                    "unusual stages[0].motor.liquid.residual_mass_kg is, as part of the propellant, 0.0501 | "
                    "up to 0.05"},
        GalleryEdge{"FullestTank", "falcon9", SetTankFill, 0.989, 0.991,
                    "unusual stages[0].tanks[1].propellant_mass_kg fills of the tank 0.991 | 0.5 to 0.99"},
        GalleryEdge{"EmptiestTank", "falcon9", SetTankFill, 0.501, 0.499,
                    "unusual stages[0].tanks[1].propellant_mass_kg fills of the tank 0.499 | 0.5 to 0.99"},
        GalleryEdge{"LightestLiquid", "falcon9", SetTankDensity, 60.1, 59.9,
                    "unusual stages[0].tanks[1].density_kg_m3 is 59.9 kg/m3 | 60 to 1700 kg/m3"},
        GalleryEdge{"DensestLiquid", "falcon9", SetTankDensity, 1699.0, 1701.0,
                    "unusual stages[0].tanks[1].density_kg_m3 is 1701 kg/m3 | 60 to 1700 kg/m3"},
        GalleryEdge{"SlowestCutOff", "falcon9", SetCutOffVelocity, 1500.0, 1499.0,
                    "unusual stages[2].cut_off.velocity_m_s is, as an inertial speed, 1499 m/s | 1500 to "
                    "12500 m/s"},
        GalleryEdge{"FastestCutOff", "falcon9", SetCutOffVelocity, 12500.0, 12510.0,
                    "unusual stages[2].cut_off.velocity_m_s is, as an inertial speed, 12510 m/s | 1500 to "
                    "12500 m/s"},
        GalleryEdge{"BoostersAhead", "ariane5", SetBoostersBottom, 0.401, 0.399,
                    "unusual boosters.bottom_station_m is, as part of the first stage's, 0.399 | 0.4 to "
                    "1.15"},
        GalleryEdge{"BoostersBehind", "ariane5", SetBoostersBottom, 1.149, 1.151,
                    "unusual boosters.bottom_station_m is, as part of the first stage's, 1.151 | 0.4 to "
                    "1.15"},
        GalleryEdge{"BoostersNozzleAhead", "ariane5", SetBoostersNozzle, 0.501, 0.499,
                    "unusual boosters.nozzle_station_m is, as part of the boosters' bottom_station_m, 0.499 "
                    "| 0.5 to 1.05"},
        GalleryEdge{"BoostersNozzleBehind", "ariane5", SetBoostersNozzle, 1.049, 1.051,
                    "unusual boosters.nozzle_station_m is, as part of the boosters' bottom_station_m, 1.051 "
                    "| 0.5 to 1.05"}),
    [](const auto& edge) { return std::string(edge.param.name); });

TEST(VehiclePlausibility, FinsBehindTheBodyCannotBe) {
  Vehicle vehicle = UsualVehicle();
  SetFinsBegin(vehicle, 1.01);
  const std::vector<std::string> texts = Texts(vehicle);
  ASSERT_EQ(texts.size(), 1u) << testing::PrintToString(texts);
  EXPECT_EQ(texts[0],
            "impossible stages[0].fins[1].leading_edge_station_m begins the root, as part of the stage's "
            "bottom_station_m, at 1.01, which cannot be | up to 1 (the fins are on the body)");
}

// Two tanks of different volumes: both count.
TEST(VehiclePlausibility, TanksTakeTheirStageTogether) {
  Vehicle vehicle = LoadVehicle(DISPERSA_CAMPAIGNS "/gallery/falcon9/vehicle.yaml");
  Stage& stage = vehicle.stages[0];
  ASSERT_EQ(stage.tanks.size(), 2u);
  const double room_m3 = 0.25 * kPi * stage.diameter_m * stage.diameter_m *
                         (stage.bottom_station_m - vehicle.stages[1].bottom_station_m);
  // The second tank takes what is left but `spare`; its density keeps it filled.
  const auto texts_of = [&](double part) {
    Tank& tank = stage.tanks[1];
    const double wanted_m3 = part * room_m3 - stage.tanks[0].Volume();
    const double fill = tank.propellant_mass_kg / tank.density_kg_m3 / tank.Volume();
    tank.diameter_m *= std::sqrt(wanted_m3 / tank.Volume());
    tank.density_kg_m3 = tank.propellant_mass_kg / (fill * tank.Volume());
    std::vector<std::string> found;
    for (const std::string& text : Texts(vehicle))
      if (text.find("stages[0].tanks take together") != std::string::npos) found.push_back(text);
    return found;
  };
  EXPECT_TRUE(texts_of(0.949).empty());
  EXPECT_EQ(
      texts_of(0.951),
      std::vector<std::string>{
          "unusual stages[0].tanks take together, as part of the stage's diameter_m from its bottom to "
          "the next stage's (of the last: to their top), 0.951 | 0.05 to 0.95 (the tanks are inside the "
          "stage; of Vega's upper stage they take 0.09)"});
}

}  // namespace
}  // namespace dispersa::vehicle_plausibility_test
