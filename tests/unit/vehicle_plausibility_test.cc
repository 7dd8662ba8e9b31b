// Consequences of a vehicle's numbers, compared with physics and known launchers: every check, with the full
// text.
#include "core/vehicle/plausibility.h"

#include "core/campaign_yaml/load.h"
#include "core/math/constants.h"
#include "core/vehicle/mass.h"
#include "core/vehicle/vehicle_figures.h"
#include "tests/test.h"
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

// Pressure by thrust but at one time; the tail, below half of the thrust, is far off.
void SetPressure(Vehicle& v, double megapascals, double part) {
  ThrustCurve curve{{0.0, 50.0, 99.0, 100.0}, {200e3, 200e3, 101e3, 90e3}};
  for (const double thrust_n : curve.thrust_n)
    curve.pressure_pa.push_back(megapascals * 1e6 * thrust_n / 200e3);
  curve.pressure_pa[2] /= part;
  curve.pressure_pa[3] *= 0.01;
  SetThrustCurve(curve, v.stages[0].motor);
}

void SetFins(Vehicle& v, double leading_m, double chord_m) {
  v.stages[0].fins = {FinSet{}, FinSet{}};
  for (FinSet& fins : v.stages[0].fins) {
    fins.leading_edge_station_m = 18.0;
    fins.root_chord_m = 1.0;
  }
  v.stages[0].fins[1].leading_edge_station_m = leading_m;
  v.stages[0].fins[1].root_chord_m = chord_m;
}

void Push(Stage& stage, double factor) {
  stage.motor.thrust_n *= factor;
  stage.motor.burning_time_s /= factor;
}

void SetJettison(Vehicle& v, JettisonTrigger trigger, double threshold) {
  Jettison first, second;
  first.mass_kg = second.mass_kg = 10.0;
  first.trigger = JettisonTrigger::kAtTime;
  first.threshold = 200.0;
  second.trigger = trigger;
  second.threshold = threshold;
  v.stages[1].jettisoned = {first, second};
}

void SetGrainDensity(Vehicle& v, double x) {
  Grain& g = v.stages[1].grain;
  g.top_station_m =
      g.bottom_station_m - (g.bottom_station_m - g.top_station_m) * PropellantDensity(v.stages[1]) / x;
}

using Setters = std::map<std::string, std::function<void(Vehicle&, double)>>;

// What sets the number of a row of tests/data/plausibility.txt.
Setters AllSetters() {
  Setters set;
  // One of two Mach numbers alone is changed: the least is told from the greatest.
  set["Axial"] = [](Vehicle& v, double x) { v.aerodynamics[0].ca = {0.3, 0.3, x, 0.3}; };
  set["PowerOff"] = [](Vehicle& v, double x) { v.aerodynamics[0].ca_power_off = {0.3, 0.3, 0.3 + x, 0.3}; };
  set["Slope"] = [](Vehicle& v, double x) { v.aerodynamics[0].cn = {0.0, 3.0, 0.0, x}; };
  set["Place"] = [](Vehicle& v, double x) { v.aerodynamics[0].xcp_station_m = {4.0, 4.0, 20.0 * x, 4.0}; };
  set["PitchDamping"] = [](Vehicle& v, double x) { v.aerodynamics[0].cmq_per_rad = {-1.0, x}; };
  set["RollDamping"] = [](Vehicle& v, double x) { v.aerodynamics[0].clp_per_rad = {-1.0, x}; };
  set["GreatestPressure"] = [](Vehicle& v, double x) { SetPressure(v, x, 1.0); };
  set["PressureSpread"] = [](Vehicle& v, double x) { SetPressure(v, 6.0, x); };
  set["Latitude"] = [](Vehicle& v, double x) { v.site.latitude_rad = x * kRadPerDeg; };
  set["Parachute"] = [](Vehicle& v, double x) {
    v.descent.parachute_area_m2 = 10.0;
    v.descent.ground_altitude_m = 1400.0;
    v.descent.parachute_altitude_m = 1400.0 + x;
  };
  set["Pivot"] = [](Vehicle& v, double x) { v.stages[1].gimbal.pivot_station_m = 11.0 * x; };
  set["FinsBegin"] = [](Vehicle& v, double x) { SetFins(v, 20.0 * x, 0.1); };
  set["FinsEnd"] = [](Vehicle& v, double x) { SetFins(v, 19.0, 20.0 * x - 19.0); };
  set["FinsAbove"] = [](Vehicle& v, double x) { SetFins(v, 11.0 + x, 1.0); };
  set["Profile"] = [](Vehicle& v, double x) {
    v.profile = {{ProfileShape::kCone, 2.0, 1.2 / x}, {ProfileShape::kCylinder, 18.0, 1.2 / x}};
  };
  set["Margin"] = [](Vehicle& v, double x) {
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
  };
  set["ReferenceArea"] = [](Vehicle& v, double x) {
    v.aerodynamics[0].reference_area_m2 = 0.25 * kPi * 1.44 * x;
  };
  set["ReferenceLength"] = [](Vehicle& v, double x) { v.aerodynamics[0].reference_length_m = 1.2 * x; };
  set["FirstMach"] = [](Vehicle& v, double x) { v.aerodynamics[0].mach = {x, 10.0}; };
  set["LastMach"] = [](Vehicle& v, double x) { v.aerodynamics[1].mach = {0.0, x}; };
  set["LastIncidence"] = [](Vehicle& v, double x) {
    v.aerodynamics[0].incidence_rad = {0.0, x * kRadPerDeg};
    v.aerodynamics[0].cn = {0.0, 3.0 * x * kRadPerDeg, 0.0, 3.0 * x * kRadPerDeg};
  };
  set["AxialUncertainty"] = [](Vehicle& v, double x) { v.aerodynamics[0].uncertainty.ca = {0.1, x}; };
  set["NormalUncertainty"] = [](Vehicle& v, double x) { v.aerodynamics[0].uncertainty.cn = {x, 0.1}; };
  set["PlaceUncertainty"] = [](Vehicle& v, double x) {
    v.aerodynamics[0].uncertainty.xcp_m = {0.1, 20.0 * x};
  };
  set["ForceAtZero"] = [](Vehicle& v, double x) { v.aerodynamics[0].cn = {0.0, 3.0, x, 3.0}; };
  set["GimbalLimit"] = [](Vehicle& v, double x) { v.stages[1].gimbal.limit_rad = x * kRadPerDeg; };
  set["Bandwidth"] = [](Vehicle& v, double x) { v.stages[1].gimbal.bandwidth_rad_s = x; };
  set["RateLimit"] = [](Vehicle& v, double x) { v.stages[1].gimbal.rate_limit_rad_s = x * kRadPerDeg; };
  set["Hinges"] = [](Vehicle& v, double x) { v.stages[1].gimbal.radius_m = 0.5 * x; };
  set["PublishedFlow"] = [](Vehicle& v, double x) { v.stages[0].motor.published_mass_flow_kg_s = 92.0 * x; };
  set["ExitArea"] = [](Vehicle& v, double x) { v.stages[1].motor.nozzle_exit_area_m2 = 0.25 * kPi * x; };
  set["JettisonTime"] = [](Vehicle& v, double x) { SetJettison(v, JettisonTrigger::kAtTime, x); };
  set["JettisonAltitude"] = [](Vehicle& v, double x) {
    SetJettison(v, JettisonTrigger::kAtAltitude, 1e3 * x);
  };
  set["JettisonFlux"] = [](Vehicle& v, double x) { SetJettison(v, JettisonTrigger::kAtHeatFlux, x); };
  set["PressureLimit"] = [](Vehicle& v, double x) { v.limits.q_max_pa = x; };
  set["ProductLimit"] = [](Vehicle& v, double x) { v.limits.q_alpha_pa_rad = x; };
  set["AxialLimit"] = [](Vehicle& v, double x) { v.limits.axial_load_g = x; };
  set["ThrusterImpulse"] = [](Vehicle& v, double x) { v.reaction_control.specific_impulse_s = x; };
  set["Gyro"] = [](Vehicle& v, double x) {
    v.sensors.rate_gyros = {{.name = "one", .station_m = 1.0}, {.name = "other", .station_m = 20.0 * x}};
  };
  set["InertialUnit"] = [](Vehicle& v, double x) { v.sensors.inertial_unit_station_m = 20.0 * x; };
  // Figures that follow from several values: one is moved, the others stay.
  set["Impulse"] = [](Vehicle& v, double x) {
    v.stages[0].motor.burning_time_s *= x / FiguresOf(v)[0].specific_impulse_s;
  };
  set["LiftOff"] = [](Vehicle& v, double x) { Push(v.stages[0], x / FiguresOf(v)[0].thrust_to_weight); };
  set["Ignition"] = [](Vehicle& v, double x) { Push(v.stages[1], x / FiguresOf(v)[1].thrust_to_weight); };
  set["BurnoutLoad"] = [](Vehicle& v, double x) { Push(v.stages[1], x / FiguresOf(v)[1].burnout_load_g); };
  set["DryPart"] = [](Vehicle& v, double x) {
    v.stages[0].liftoff_mass_kg = v.stages[1].liftoff_mass_kg + v.stages[0].propellant_mass_kg / (1.0 - x);
  };
  set["LastDryPart"] = [](Vehicle& v, double x) {
    v.stages[1].motor.thrust_n = 15e3;
    v.stages[1].motor.burning_time_s = 400.0;
    v.stages[1].liftoff_mass_kg = v.stages[1].propellant_mass_kg / (1.0 - x);
  };
  set["GrainDensity"] = SetGrainDensity;
  set["GrainDiameter"] = [](Vehicle& v, double x) {
    v.stages[1].grain.outer_diameter_m = x * v.stages[1].diameter_m;
    v.stages[1].grain.inner_diameter_m = 0.0;
    SetGrainDensity(v, 1700.0);
  };
  set["UpperDiameter"] = [](Vehicle& v, double x) { v.stages[1].diameter_m = 1.2 * x; };
  set["OffAxis"] = [](Vehicle& v, double x) {
    v.stages[0].gimbal.nozzles = {{"centre"}, {"ring"}};
    v.stages[0].gimbal.nozzles[1].ring = {8, 0.6 * x};
  };
  set["NozzleInertia"] = [](Vehicle& v, double x) {
    for (Stage& stage : v.stages) {
      stage.gimbal.nozzle_mass_kg = 20.0;
      stage.gimbal.nozzle_cg_m = 0.5;
      stage.gimbal.nozzle_inertia_kg_m2 = 8.0;
    }
    v.stages[1].gimbal.nozzle_inertia_kg_m2 = 20.0 * 0.25 * x;
  };
  set["DeltaV"] = [](Vehicle& v, double x) {
    double sum_m_s = 0.0;
    for (const StageFigures& one : FiguresOf(v)) sum_m_s += one.ideal_delta_v_m_s;
    for (Stage& stage : v.stages) stage.motor.burning_time_s *= x / sum_m_s;
  };
  set["Turning"] = [](Vehicle& v, double x) {
    const StackMass stack = BuildStackMasses(v).back();
    v.reaction_control.thrust_n = x * kRadPerDeg *
                                  stack.At(stack.propellant_mass_kg).transverse_inertia_kg_m2 /
                                  (2.0 * v.reaction_control.pitch_yaw_arm_m);
  };
  // Of two lighter tables the second, and of its two Mach numbers one.
  set["LighterAxial"] = [](Vehicle& v, double x) {
    AeroTable lighter = v.aerodynamics[0];
    v.aerodynamics[0].lighter.assign(2, {});
    for (auto& one : v.aerodynamics[0].lighter) one.table = lighter;
    v.aerodynamics[0].lighter[1].table.ca = {0.3, 0.3, x, 0.3};
  };
  set["YawDamping"] = [](Vehicle& v, double x) {
    AeroTable yaw = v.aerodynamics[1];
    yaw.cmq_per_rad = {-1.0, x};
    v.aerodynamics[1].yaw_plane = {yaw};
  };
  set["Residual"] = [](Vehicle& v, double x) {
    v.stages[0].motor.residual_mass_kg = x * v.stages[0].propellant_mass_kg;
  };
  set["TankFill"] = [](Vehicle& v, double x) {
    Tank& tank = v.stages[0].tanks[1];
    tank.propellant_mass_kg = x * tank.density_kg_m3 * tank.Volume();
  };
  set["TankDensity"] = [](Vehicle& v, double x) {
    Tank& tank = v.stages[0].tanks[1];
    tank.propellant_mass_kg *= x / tank.density_kg_m3;
    tank.density_kg_m3 = x;
  };
  set["CutOffVelocity"] = [](Vehicle& v, double x) {
    v.stages[2].motor.cut_off = CutOff::kAtVelocity;
    v.stages[2].motor.cut_off_velocity_m_s = x;
  };
  set["BoostersBottom"] = [](Vehicle& v, double x) {
    Boosters& b = v.boosters;
    const double part = b.nozzle_station_m / b.bottom_station_m;
    b.bottom_station_m = x * v.stages[0].bottom_station_m;
    b.nozzle_station_m = part * b.bottom_station_m;
  };
  set["BoostersNozzle"] = [](Vehicle& v, double x) {
    v.boosters.nozzle_station_m = x * v.boosters.bottom_station_m;
  };
  // Slips of the pen.
  set["NewtonsForKilonewtons"] = [](Vehicle& v, double) { v.stages[1].motor.thrust_n = 50.0; };
  set["BurningTimeTenfold"] = [](Vehicle& v, double) { v.stages[0].motor.burning_time_s = 1000.0; };
  set["ThrustBelowWeight"] = [](Vehicle& v, double) {
    v.stages[0].motor.thrust_n = 120e3;
    v.stages[0].motor.burning_time_s = 160.0;
  };
  set["NozzleThatTheAirHoldsDown"] = [](Vehicle& v, double) { v.stages[0].motor.nozzle_exit_area_m2 = 0.8; };
  set["GrainOutsideTheStage"] = [](Vehicle& v, double) {
    v.stages[1].grain.outer_diameter_m = 1.05;
    v.stages[1].grain.inner_diameter_m = 0.65;
  };
  set["RadiansForDegrees"] = [](Vehicle& v, double) { v.stages[0].gimbal.limit_rad = 6.0; };
  set["StoutVehicle"] = [](Vehicle& v, double) {
    v.profile = {{ProfileShape::kCone, 2.0, 6.0}, {ProfileShape::kCylinder, 18.0, 6.0}};
  };
  set["ThrustFromTheAir"] = [](Vehicle& v, double) { v.aerodynamics[0].ca = {-0.3, -0.3, -0.3, -0.3}; };
  set["AThousandfoldDrag"] = [](Vehicle& v, double) { v.aerodynamics[1].ca = {300.0, 300.0, 300.0, 300.0}; };
  set["RadiansUnderDegrees"] = [](Vehicle& v, double) {
    v.aerodynamics[0].incidence_rad = {0.0, 0.5 * kRadPerDeg};
    v.aerodynamics[0].cn = {0.0, 1.5, 0.0, 1.5};
  };
  set["TransonicTableAlone"] = [](Vehicle& v, double) { v.aerodynamics[0].mach = {0.95, 1.1}; };
  set["PressureKilometresAftInYaw"] = [](Vehicle& v, double) {
    AeroTable yaw = v.aerodynamics[0];
    yaw.xcp_station_m = {4.0, 4.0, 2600.0, 4.0};
    v.aerodynamics[0].yaw_plane = {yaw};
  };
  return set;
}

// Nothing is said of the vehicle but what the table says.
TEST(VehiclePlausibility, SaysWhatTheTableSays) {
  std::ifstream file(DISPERSA_TEST_DATA "/plausibility.txt");
  Vehicle usual = UsualVehicle();
  std::string line, row;
  std::vector<std::string> expected;
  const Setters setters = AllSetters();
  std::set<std::string> left;
  for (const auto& [name, set] : setters) left.insert(name);
  const auto judge = [&] {
    if (row.empty()) return;
    std::istringstream words(row);
    std::string name;
    double value = 0.0;
    words >> name >> value;
    ASSERT_TRUE(setters.contains(name)) << row;
    left.erase(name);
    Vehicle vehicle = usual;
    setters.at(name)(vehicle, value);
    EXPECT_EQ(Texts(vehicle), expected) << row;
    expected.clear();
  };
  while (std::getline(file, line)) {
    if (line[0] == '#') continue;
    if (line[0] == '=') {
      expected.push_back(line.substr(2));
      continue;
    }
    judge();
    row = line;
    if (line.starts_with("vehicle ")) {
      usual = LoadVehicle(DISPERSA_CAMPAIGNS "/gallery/" + line.substr(8) + "/vehicle.yaml");
      row.clear();
    }
  }
  judge();
  EXPECT_EQ(left, std::set<std::string>{});
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
