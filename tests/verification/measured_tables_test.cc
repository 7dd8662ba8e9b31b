// Tables that teams bring: a measured atmosphere, aerodynamics in other forms and configurations, and mass
// properties. A table sampled from the model that it replaces flies as the model does, but for an error that
// falls with the square of the table's step.
#include "core/dynamics/air_data.h"
#include "core/environment/surroundings.h"
#include "core/input/number_text.h"
#include "core/vehicle/aerodynamics_build_up.h"
#include "tests/flown_history.h"
#include "tests/slv4_flight.h"
#include "tests/tabulated_masses.h"
#include "tests/test.h"
#include "tests/unit/input_files.h"

namespace dispersa::measured_tables_test {
namespace {

Flown FlyOne(const FlightDefinition& definition, const FlightInputs& inputs = {}) {
  Flown flown;
  flown.history.step_s = 0.5;
  FlightOptions options;
  options.history = &flown.history;
  flown.result = Fly(FlightModel(definition), inputs, options);
  EXPECT_EQ(flown.result.outcome, Outcome::kCompleted) << flown.result.reason;
  return flown;
}

// Up to a time before the coast, where thrusters fire by thresholds.
double Apart(const Flown& a, const Flown& b, const char* column) { return Apart(a, b, column, 160.0); }

FlightDefinition Slv4() { return Slv4Definition(DISPERSA_CAMPAIGNS); }

// The first stage's disturbed flight, whose error is to fall with the square of a step.
void ExpectSecondOrder(const std::function<FlightDefinition(int)>& coarser, const char* column, double most,
                       double least_ratio = 3.0) {
  const Flown exact = FlyOne(Slv4(), Table3Inputs());
  const double coarse = Apart(FlyOne(coarser(1), Table3Inputs()), exact, column);
  const double fine = Apart(FlyOne(coarser(2), Table3Inputs()), exact, column);
  testing::Test::RecordProperty(column, FormatRounded(coarse) + " " + FormatRounded(fine));
  EXPECT_LT(coarse, most) << column;
  EXPECT_GT(coarse, 0.0) << column;
  EXPECT_GT(coarse / fine, least_ratio) << column << ": " << coarse << ", " << fine;
}

// ---- atmosphere ----

WeatherTable SampledStandard(double step_m, double top_m) {
  WeatherTable table;
  for (double z = 0.0; z <= top_m; z += step_m) {
    const AirState air = StandardAtmosphere1976(z);
    table.altitude_m.push_back(z);
    table.north_m_s.push_back(0.0);
    table.east_m_s.push_back(0.0);
    table.pressure_pa.push_back(air.pressure_pa);
    table.density_kg_m3.push_back(air.density_kg_m3);
  }
  return table;
}

TEST(MeasuredAir, IsExponentialBetweenItsLevelsAndTheStandardsAboveTheFade) {
  WeatherTable table = SampledStandard(1000.0, 20e3);
  for (double& density : table.density_kg_m3) density *= 1.1;
  for (double& pressure : table.pressure_pa) pressure *= 1.05;
  table.altitude_m[3] = 2987.0;  // no regular grid
  const AirTable air = MeasuredAir(table);
  for (double z = 0.0; z < 20e3; z += 31.7) {
    const std::size_t low =
        static_cast<std::size_t>(std::upper_bound(table.altitude_m.begin(), table.altitude_m.end(), z) -
                                 table.altitude_m.begin()) -
        1;
    const double part = (z - table.altitude_m[low]) / (table.altitude_m[low + 1] - table.altitude_m[low]);
    const auto between = [&](const std::vector<double>& values) {
      return values[low] * std::pow(values[low + 1] / values[low], part);
    };
    const lanes::AirPressure<double> at = lanes::AirAt(air, z);
    EXPECT_NEAR(at.pressure_pa / between(table.pressure_pa), 1.0, 1e-11) << z;
    EXPECT_NEAR(at.pressure_pa / at.energy_j_kg / between(table.density_kg_m3), 1.0, 1e-11) << z;
  }
  for (const double z : {-4000.0, 21e3, 24e3, 29e3}) {
    const AirState standard = StandardAtmosphere1976(z);
    const lanes::AirPressure<double> at = lanes::AirAt(air, z);
    const double kept = z < 0.0 ? 1.0 : 1.0 - (z - 20e3) / kWindFade_m;
    EXPECT_NEAR(at.pressure_pa / standard.pressure_pa, 1.0 + 0.05 * kept, 1e-11) << z;
    EXPECT_NEAR(at.energy_j_kg / (standard.pressure_pa / standard.density_kg_m3),
                1.0 + (1.05 / 1.1 - 1.0) * kept, 1e-11)
        << z;
  }
  for (const double z : {30e3, 47e3, 86e3, 300e3, 2e6}) {
    const lanes::AirPressure<double> own = lanes::AirAt(air, z), standard = lanes::AirAt(StandardAir(), z);
    EXPECT_NEAR(own.pressure_pa, standard.pressure_pa, 1e-11 * standard.pressure_pa) << z;
    EXPECT_NEAR(own.energy_j_kg, standard.energy_j_kg, 1e-11 * standard.energy_j_kg) << z;
  }
}

// Two columns give the third by the gas law.
TEST(MeasuredAir, OfAnyTwoColumnsIsTheSame) {
  const WeatherTable whole = SampledStandard(2000.0, 30e3);
  WeatherTable by_density = whole, by_pressure = whole;
  for (std::size_t i = 0; i < whole.altitude_m.size(); ++i) {
    const double temperature_k = whole.pressure_pa[i] / whole.density_kg_m3[i] / (8314.32 / 28.9644);
    by_density.temperature_k.push_back(temperature_k);
    by_pressure.temperature_k.push_back(temperature_k);
  }
  by_density.pressure_pa.clear();
  by_pressure.density_kg_m3.clear();
  for (const WeatherTable& other : {by_density, by_pressure})
    for (std::size_t i = 0; i < whole.altitude_m.size(); ++i) {
      EXPECT_NEAR(AirOfLevel(other, i).pressure_pa, whole.pressure_pa[i], 1e-14 * whole.pressure_pa[i]);
      EXPECT_NEAR(AirOfLevel(other, i).density_kg_m3, whole.density_kg_m3[i], 1e-14 * whole.density_kg_m3[i]);
    }
}

TEST(MeasuredAir, SampledFromTheStandardFliesAsTheStandard) {
  const auto sampled = [](int finer) {
    FlightDefinition definition = Slv4();
    definition.wind_table = SampledStandard(2000.0 / finer, 60e3);
    return definition;
  };
  // The tropopause lies between two altitudes.
  ExpectSecondOrder(sampled, "qbar_pa", 2000.0);
  ExpectSecondOrder(sampled, "inertial_velocity_m_s", 1.0);
}

// 1.1 times the air to where there is none, and a density dispersion of 1.1; both evaluations of the flow.
TEST(MeasuredAir, GoesWithADispersionOfDensity) {
  FlightDefinition thick = Slv4();
  thick.wind_table = SampledStandard(250.0, 250e3);
  FlightDefinition plain = thick;
  for (double& density : thick.wind_table->density_kg_m3) density *= 1.1;
  for (double& pressure : thick.wind_table->pressure_pa) pressure *= 1.1;
  FlightInputs dense;
  dense.air.density_factor = 1.1;
  EXPECT_LT(Apart(FlyOne(thick), FlyOne(plain, dense), "inertial_velocity_m_s"), 1e-6);
  EXPECT_GT(Apart(FlyOne(thick), FlyOne(plain), "inertial_velocity_m_s"), 1.0);

  Environment environment;
  environment.air = std::make_shared<const AirTable>(MeasuredAir(*thick.wind_table));
  const Vector3 p(6378137.0 + 9000.0, 0.0, 0.0);
  const AirData data = ComputeAirData(environment, p, Vector3(300.0, 465.1 + 400.0, 10.0));
  const AirState standard = StandardAtmosphere1976(data.place.altitude_m);
  EXPECT_NEAR(data.density_kg_m3, 1.1 * standard.density_kg_m3, 1e-5);
  EXPECT_NEAR(data.speed_of_sound_m_s, standard.speed_of_sound_m_s, 1e-3);
}

// ---- aerodynamics ----

// A table file in one of the forms.
struct Form {
  double reference_m = NAN;  // of cm (NaN: the centre of pressure)
  bool is_signed = false;
  bool has_damping = true;
};
std::string CsvOf(const AeroTable& table, const Form& form) {
  const bool by_moment = !std::isnan(form.reference_m);
  std::string text = std::string("mach,incidence_rad,ca,cn,") + (by_moment ? "cm" : "xcp_station_m") +
                     (form.has_damping ? ",cmq_per_rad,clp_per_rad\n" : "\n");
  for (std::size_t m = 0; m < table.mach.size(); ++m) {
    const auto add = [&](std::size_t i, double sign) {
      const std::size_t row = table.RowOf(m, i);
      const double cm =
          table.cn[row] * (form.reference_m - table.xcp_station_m[row]) / table.reference_length_m;
      for (const double value : {table.mach[m], sign * table.incidence_rad[i], table.ca[row],
                                 sign * table.cn[row], by_moment ? sign * cm : table.xcp_station_m[row]})
        text += FormatNumber(value) + ",";
      text.pop_back();
      if (form.has_damping)
        text += "," + FormatNumber(table.cmq_per_rad[m]) + "," + FormatNumber(table.clp_per_rad[m]);
      text += "\n";
    };
    if (form.is_signed)
      for (std::size_t i = table.incidence_rad.size(); i-- > 1;) add(i, -1.0);
    for (std::size_t i = 0; i < table.incidence_rad.size(); ++i) add(i, 1.0);
  }
  return text;
}

// SLV-4 with its computed aerodynamics in files of a form.
FlightDefinition InForm(const Form& form) {
  FlightDefinition definition = Slv4();
  const std::vector<AeroTable> tables = BuildAerodynamics(definition.vehicle);
  const InputFiles files;
  std::string text = TextOfFile(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml") + "\naerodynamics:\n  tables:\n";
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const std::string name = "aero" + std::to_string(i) + ".csv";
    files.Write(name, CsvOf(tables[i], form));
    text +=
        "    - {reference_area_m2: " + FormatNumber(tables[i].reference_area_m2) +
        ", reference_length_m: " + FormatNumber(tables[i].reference_length_m) +
        (std::isnan(form.reference_m) ? ""
                                      : ", moment_reference_station_m: " + FormatNumber(form.reference_m)) +
        ", table: " + name + "}\n";
  }
  files.Write("vehicle.yaml", text);
  definition.vehicle = LoadVehicle(files.Path("vehicle.yaml"));
  return definition;
}

TEST(AeroForms, OfTheComputedTablesFlyAsTheyDo) {
  const FlightInputs inputs = Table3Inputs();
  const Flown computed = FlyOne(Slv4(), inputs);
  const Flown plain = FlyOne(InForm({}), inputs);
  EXPECT_EQ(plain.result.digest.Hex(), computed.result.digest.Hex());  // to the bit
  // Dampings that are missing are those computed.
  EXPECT_EQ(FlyOne(InForm({NAN, false, false}), inputs).result.digest.Hex(), computed.result.digest.Hex());
  EXPECT_EQ(FlyOne(InForm({NAN, true, true}), inputs).result.digest.Hex(), computed.result.digest.Hex());
  // About any reference, to the rounding of cn (x - xcp).
  const Flown about_nose = FlyOne(InForm({0.0, false, true}), inputs);
  for (const double reference_m : {11.0, 26.0}) {
    const Flown other = FlyOne(InForm({reference_m, reference_m > 20.0, true}), inputs);
    EXPECT_LT(Apart(other, about_nose, "pitch_error_deg"), 1e-9) << reference_m;
    EXPECT_LT(Apart(other, about_nose, "inertial_velocity_m_s"), 1e-8) << reference_m;
  }
  // A moment says nothing of the place of no force: at an incidence of 0 it is that of the next row.
  EXPECT_LT(Apart(about_nose, plain, "pitch_error_deg"), 0.005);
}

// Twice as many Mach numbers and incidences quarter the error.
TEST(AeroForms, SampledFromAFinerTableFlyAsItDoes) {
  const Vehicle vehicle = Slv4().vehicle;
  const std::vector<AeroTable> built = BuildAerodynamics(vehicle);
  const auto sampled = [&](double mach_step, double incidence_step_deg) {
    std::vector<AeroTable> tables;
    for (const AeroTable& from : built) {
      // A smooth function instead of the build-up's kinks, whose places decide an order.
      AeroTable table;
      table.reference_area_m2 = from.reference_area_m2;
      table.reference_length_m = from.reference_length_m;
      for (double i = 0.0; i <= 30.001; i += incidence_step_deg)
        table.incidence_rad.push_back(i * kRadPerDeg);
      for (double m = 0.0; m <= 12.001; m += mach_step) {
        table.mach.push_back(m);
        table.cmq_per_rad.push_back(-200.0);
        table.clp_per_rad.push_back(-0.2);
        for (const double i : table.incidence_rad) {
          table.ca.push_back(0.25 + 0.2 * std::exp(-(m - 1.2) * (m - 1.2)) + 0.1 * i * i);
          table.cn.push_back((2.5 + 0.5 * std::sin(m)) * std::sin(2.0 * i) / 2.0);
          table.xcp_station_m.push_back(from.xcp_station_m[from.RowOf(0, 1)] + 0.3 * std::cos(m) + i);
        }
      }
      tables.push_back(table);
    }
    FlightDefinition definition = Slv4();
    definition.vehicle.aerodynamics = tables;
    return definition;
  };
  const FlightInputs inputs = Table3Inputs();
  const Flown exact = FlyOne(sampled(0.025, 0.25), inputs);
  const Flown coarse = FlyOne(sampled(0.4, 4.0), inputs), fine = FlyOne(sampled(0.2, 2.0), inputs);
  for (const char* column : {"inertial_velocity_m_s", "pitch_error_deg"}) {
    const double ratio = Apart(coarse, exact, column) / Apart(fine, exact, column);
    EXPECT_GT(ratio, 3.0) << column;
    EXPECT_LT(ratio, 5.5) << column;
  }
}

// The uncertainty of a table, drawn, is the factor that it is.
TEST(AeroUncertainty, OfAllRowsIsAFactor) {
  FlightDefinition stated = Slv4(), plain = Slv4();
  plain.vehicle.aerodynamics = BuildAerodynamics(plain.vehicle);
  stated.vehicle.aerodynamics = plain.vehicle.aerodynamics;
  for (AeroTable& table : stated.vehicle.aerodynamics) {
    table.uncertainty.ca.assign(table.ca.size(), 0.05);
    table.uncertainty.cn.assign(table.cn.size(), 0.04);
  }
  FlightInputs drawn = Table3Inputs(), factors = Table3Inputs();
  drawn.table_ca_sigmas = 2.0;
  drawn.table_cn_sigmas = -1.0;
  factors.drag_factor *= 1.1;
  factors.lift_factor *= 0.96;
  const Flown a = FlyOne(stated, drawn), b = FlyOne(plain, factors);
  EXPECT_LT(Apart(a, b, "pitch_error_deg"), 1e-9);
  EXPECT_LT(Apart(a, b, "inertial_velocity_m_s"), 1e-8);
  EXPECT_GT(Apart(a, FlyOne(plain, Table3Inputs()), "inertial_velocity_m_s"), 1.0);
  // The centre of pressure moves by lengths.
  FlightDefinition moved = plain;
  for (AeroTable& table : stated.vehicle.aerodynamics) table.uncertainty.xcp_m.assign(table.cn.size(), 0.3);
  for (AeroTable& table : moved.vehicle.aerodynamics)
    for (double& xcp_m : table.xcp_station_m) xcp_m += 0.45;
  FlightInputs by_lengths = Table3Inputs();
  by_lengths.table_xcp_sigmas = 1.5;
  EXPECT_LT(Apart(FlyOne(stated, by_lengths), FlyOne(moved, Table3Inputs()), "pitch_error_deg"), 1e-9);
}

// The force of each state of the stack: whole and lighter, with power and without.
TEST(AeroConfigurations, AreThoseOfTheBodiesThatAreLeft) {
  FlightDefinition definition = Slv4();
  Vehicle& vehicle = definition.vehicle;
  vehicle.stages[3].jettisoned = {{"tower", 15.0, 0.1, 0.5, 0.2, 0.1, JettisonTrigger::kAtTime, 25.0},
                                  {"fairing", 50.0, 0.2, 2.5, 1.0, 0.97, JettisonTrigger::kAtTime, 35.0}};
  vehicle.aerodynamics = BuildAerodynamics(vehicle);
  const auto with_ca = [&](double ca, double off) {
    AeroTable table = vehicle.aerodynamics[0];
    table.ca.assign(table.ca.size(), ca);
    if (off > 0.0) table.ca_power_off.assign(table.ca.size(), off);
    return table;
  };
  AeroTable whole = with_ca(0.1, 0.2);
  whole.lighter = {{{"tower", "fairing"}, with_ca(0.5, 0.6)}, {{"tower"}, with_ca(0.3, 0.0)}};
  vehicle.aerodynamics[0] = whole;
  EXPECT_TRUE(Problems(vehicle).empty());
  const LauncherModel model(BuildNominalPlant(vehicle));
  const auto axial = [&](unsigned jettisoned, bool burning) {
    LauncherPhase phase;
    phase.burning = burning;
    phase.jettisoned = jettisoned;
    double y[kLauncherSize] = {};
    RigidBodyState state;
    state.p_EoC_I = Vector3(6378137.0 + 8000.0, 0.0, 0.0);
    state.v_IC_I = Vector3(600.0, 465.7, 0.0);
    WriteState(state, y);
    const LauncherInstant now = model.Evaluate(phase, 10.0, y);
    const double thrust_n = burning ? now.thrust_n : 0.0;
    return (thrust_n - now.loads.force_n.x()) / (now.air.qbar_pa * whole.reference_area_m2);
  };
  EXPECT_NEAR(axial(0u, true), 0.1, 1e-12);
  EXPECT_NEAR(axial(0u, false), 0.2, 1e-12);
  EXPECT_NEAR(axial(1u, true), 0.3, 1e-12);
  EXPECT_NEAR(axial(1u, false), 0.3, 1e-12);  // it has no power-off column
  EXPECT_NEAR(axial(2u, true), 0.1, 1e-12);   // no table without the fairing alone
  EXPECT_NEAR(axial(3u, true), 0.5, 1e-12);
  EXPECT_NEAR(axial(3u, false), 0.6, 1e-12);
}

// A flight takes the tables as its bodies leave: equal ones change no bit, others do from then on.
TEST(AeroConfigurations, ChangeInFlight) {
  FlightDefinition definition = Slv4();
  Vehicle& vehicle = definition.vehicle;
  vehicle.stages[0].jettisoned = {{"skirt", 40.0, 14.0, 15.0, 1.2, 1.0, JettisonTrigger::kAtTime, 20.0}};
  definition.jettison_s = {20.0};
  vehicle.aerodynamics = BuildAerodynamics(vehicle);
  const Flown plain = FlyOne(definition);
  FlightDefinition same = definition, other = definition, off = definition;
  AeroTable lighter = vehicle.aerodynamics[0];
  same.vehicle.aerodynamics[0].lighter = {{{"skirt"}, lighter}};
  same.vehicle.aerodynamics[0].ca_power_off = lighter.ca;
  EXPECT_EQ(FlyOne(same).result.digest.Hex(), plain.result.digest.Hex());
  for (double& ca : lighter.ca) ca *= 1.5;
  other.vehicle.aerodynamics[0].lighter = {{{"skirt"}, lighter}};
  const Flown changed = FlyOne(other);
  EXPECT_EQ(Apart(changed, plain, "inertial_velocity_m_s", 20.0), 0.0);
  EXPECT_GT(Apart(changed, plain, "inertial_velocity_m_s", 40.0), 1.0);
  // Between burnout and separation the first stack has more drag.
  off.vehicle.aerodynamics[0].ca_power_off = lighter.ca;
  const double burnout_s = vehicle.stages[0].motor.burning_time_s;
  const Flown coasted = FlyOne(off);
  EXPECT_EQ(Apart(coasted, plain, "inertial_velocity_m_s", burnout_s - 1.0), 0.0);
  EXPECT_GT(Apart(coasted, plain, "inertial_velocity_m_s"), 0.0);
}

// ---- masses ----

FlightDefinition Tabulated(int rows) {
  FlightDefinition definition = Slv4();
  for (std::size_t stage = 0; stage < definition.vehicle.stages.size(); ++stage)
    TabulateMasses(definition.vehicle, stage, rows);
  return definition;
}

TEST(MassTables, SampledFromTheTubesFlyAsTheyDo) {
  const auto tabulated = [](int finer) { return Tabulated(8 * finer + 1); };
  ExpectSecondOrder(tabulated, "pitch_error_deg", 0.01);
  // Masses do not come from the table.
  const Flown exact = FlyOne(Slv4(), Table3Inputs()), table = FlyOne(Tabulated(9), Table3Inputs());
  EXPECT_LT(Apart(exact, table, "mass_kg"), 1e-9);
}

// Sums are linear in the propellant of a grain: these rows are exact, and so are their derivatives, but for
// the bore's.
TEST(MassTables, MeetTheTubesAtTheirRows) {
  const FlightDefinition plain = Slv4(), table = Tabulated(5);
  const std::vector<StackMass> tubes = BuildStackMasses(plain.vehicle),
                               rows = BuildStackMasses(table.vehicle);
  for (std::size_t stack = 0; stack < tubes.size(); ++stack)
    for (int i = 0; i <= 4; ++i) {
      const double left_kg = tubes[stack].propellant_mass_kg * i / 4.0;
      const MassProperties a = tubes[stack].At(left_kg), b = rows[stack].At(left_kg);
      EXPECT_NEAR(b.mass_kg, a.mass_kg, 1e-9);
      EXPECT_NEAR(b.cg_station_m, a.cg_station_m, 1e-12 * a.cg_station_m);
      EXPECT_NEAR(b.axial_inertia_kg_m2, a.axial_inertia_kg_m2, 1e-11 * a.axial_inertia_kg_m2);
      EXPECT_NEAR(b.transverse_inertia_kg_m2, a.transverse_inertia_kg_m2, 1e-11 * a.transverse_inertia_kg_m2);
      // The slope of a piece is the mean of its ends'.
      const double step_kg = tubes[stack].propellant_mass_kg / 4.0;
      const double difference = (rows[stack].At(left_kg + 0.5 * step_kg).axial_inertia_kg_m2 -
                                 rows[stack].At(left_kg).axial_inertia_kg_m2) /
                                (0.5 * step_kg);
      if (i == 4) continue;
      EXPECT_NEAR(rows[stack].At(left_kg).axial_inertia_per_kg, difference, 1e-9 * std::fabs(difference));
    }
}

// The flow's terms are the derivatives of the masses: d(transverse inertia)/dm about the moving centre.
TEST(MassTables, GiveTheFlowItsDerivatives) {
  const FlightDefinition definition = Tabulated(6);  // stacks point to its tables
  for (const StackMass& mass : BuildStackMasses(definition.vehicle))
    for (const double part : {0.11, 0.33, 0.52, 0.77, 0.93}) {
      const double m = part * mass.propellant_mass_kg, h = 1e-3 * mass.propellant_mass_kg;
      const MassProperties at = mass.At(m), above = mass.At(m + h), below = mass.At(m - h);
      const double slope = (above.transverse_inertia_kg_m2 - below.transverse_inertia_kg_m2) / (2.0 * h);
      // Of central differences: the inertia is a quotient of polynomials in m.
      EXPECT_NEAR(at.transverse_inertia_per_kg, slope, 1e-5 * std::fabs(slope));
      EXPECT_NEAR(at.axial_inertia_per_kg,
                  (above.axial_inertia_kg_m2 - below.axial_inertia_kg_m2) / (2.0 * h),
                  1e-9 * at.axial_inertia_kg_m2 / m);
    }
}

// Dispersed masses and a heavier payload are those of the tubes.
TEST(MassTables, AreDispersedAsTubesAre) {
  FlightInputs inputs;
  for (StageInputs& stage : inputs.stages) stage.dry_mass_factor = 1.03;
  inputs.stages[1].dry_mass_factor = 0.95;
  inputs.stages[0].propellant_factor = 0.99;
  inputs.stages[2].propellant_factor = 1.005;
  inputs.payload_mass_kg = 12.0;
  inputs.payload_element = 1.0;
  const LauncherPlant tubes = FlightModel(Slv4()).PlantFor(inputs);
  const LauncherPlant table = FlightModel(Tabulated(201)).PlantFor(inputs);
  for (std::size_t i = 0; i < tubes.stacks.size(); ++i)
    for (const double part : {0.0, 0.31, 0.77, 1.0}) {
      const double left_kg = part * tubes.stacks[i].mass.propellant_mass_kg;
      const MassProperties a = tubes.stacks[i].mass.At(left_kg), b = table.stacks[i].mass.At(left_kg);
      EXPECT_NEAR(b.mass_kg, a.mass_kg, 1e-9 * a.mass_kg);
      EXPECT_NEAR(b.cg_station_m, a.cg_station_m, 1e-4 * a.cg_station_m);
      EXPECT_NEAR(b.axial_inertia_kg_m2, a.axial_inertia_kg_m2, 1e-4 * a.axial_inertia_kg_m2);
      EXPECT_NEAR(b.transverse_inertia_kg_m2, a.transverse_inertia_kg_m2, 1e-4 * a.transverse_inertia_kg_m2);
    }
}

}  // namespace
}  // namespace dispersa::measured_tables_test
