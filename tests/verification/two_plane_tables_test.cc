// Aerodynamic tables of bodies with two planes of symmetry: against the tables themselves, closed forms,
// CVODE, and bodies that are turned about their axis by a right angle.
#include "core/dynamics/aero_grid.h"
#include "core/dynamics/aerodynamics.h"
#include "core/flight/flight.h"
#include "core/flight/tick_sample.h"
#include "core/input/number_text.h"
#include "core/margins/flight_margins.h"
#include "core/margins/linear_axis.h"
#include "core/random/draws.h"
#include "core/vehicle/aerodynamics_build_up.h"
#include "tests/flown_history.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"
#include "tests/unit/input_files.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::two_plane_tables_test {
namespace {

// A table with a yaw plane: the normal force `by` times the pitch plane's, farther aft by `aft_m`, more drag
// at incidence and more damping.
AeroTable WithYawPlane(const AeroTable& pitch, double by, double aft_m) {
  AeroTable table = pitch, yaw = pitch;
  yaw.lighter.clear();
  for (double& cn : yaw.cn) cn *= by;
  for (double& xcp_m : yaw.xcp_station_m) xcp_m += aft_m;
  for (double& cmq : yaw.cmq_per_rad) cmq *= 1.5;
  for (std::vector<double>* ca : {&yaw.ca, &yaw.ca_power_off})
    for (std::size_t row = 0; row < ca->size(); ++row)
      (*ca)[row] += 0.2 * yaw.incidence_rad[row % yaw.incidence_rad.size()];
  table.yaw_plane = {yaw};
  return table;
}
// The planes change places: the body turned about its axis by a right angle.
AeroTable Turned(const AeroTable& table) {
  AeroTable turned = table.yaw_plane.at(0), yaw = table;
  yaw.yaw_plane.clear();
  turned.yaw_plane = {yaw};
  return turned;
}
std::vector<AeroTable> Turned(std::vector<AeroTable> tables) {
  for (AeroTable& table : tables) table = Turned(table);
  return tables;
}

// SLV-4, whose first stack has things at its sides.
FlightDefinition SidedSlv4() {
  FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS);
  std::vector<AeroTable> tables = BuildAerodynamics(definition.vehicle);
  tables[0] = WithYawPlane(tables[0], 1.4, 1.2);
  definition.vehicle.aerodynamics = tables;
  return definition;
}

// ---- forces ----

TEST(TwoPlanes, HaveTheForceAndMomentOfTheirTables) {
  AeroTable table = BuildAerodynamics(LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml"))[0];
  table = WithYawPlane(table, 1.4, 1.2);
  table.yaw_plane[0].mach.back() += 1.0;  // grids of their own
  for (double& at : table.yaw_plane[0].incidence_rad) at *= 0.9;
  const AeroTable& yaw = table.yaw_plane[0];
  BodyAerodynamics body = FromTable(table);
  body.ca.factor = 1.1;
  body.cn.factor = 0.9;
  body.xcp_station_m.factor = 1.02;
  const AeroGrid grid = BuildAeroGrid(body);
  const auto over = [](const AeroTable& of, const std::vector<double>& z) {
    return Table2D{of.mach, of.incidence_rad, z};
  };
  const auto over_mach = [](const AeroTable& of, const std::vector<double>& values, double mach) {
    return Table1D{of.mach, values}(mach);
  };
  constexpr double kDensity = 0.7, kSound = 310.0, kCg_m = 14.0;
  const double area = table.reference_area_m2, length = table.reference_length_m;
  Stream draws(11, 0, "flow");
  for (int k = 0; k < 5000; ++k) {
    const double i = 1.5 * draws.Uniform() * draws.Uniform(), turn = kTwoPi * draws.Uniform(),
                 speed = 3000.0 * draws.Uniform() + 1.0;
    const Vector3 v(speed * std::cos(i), speed * std::sin(i) * std::sin(turn),
                    speed * std::sin(i) * std::cos(turn));
    const Vector3 w(0.3 * draws.Normal(), 0.1 * draws.Normal(), 0.1 * draws.Normal());
    const double mach = speed / kSound, qs = 0.5 * kDensity * speed * speed * area;
    const double along_y = std::sin(turn), along_z = std::cos(turn);
    const double ca = 1.1 * (over(table, table.ca)(mach, i) * along_z * along_z +
                             over(yaw, yaw.ca)(mach, i) * along_y * along_y);
    const Vector3 force(-qs * ca, -qs * 0.9 * over(yaw, yaw.cn)(mach, i) * along_y,
                        -qs * 0.9 * over(table, table.cn)(mach, i) * along_z);
    const double place_y = kCg_m - 1.02 * over(yaw, yaw.xcp_station_m)(mach, i),
                 place_z = kCg_m - 1.02 * over(table, table.xcp_station_m)(mach, i);
    const double damping = qs * length * length / (2.0 * speed);
    const Vector3 moment(damping * over_mach(table, table.clp_per_rad, mach) * w.x(),
                         damping * over_mach(table, table.cmq_per_rad, mach) * w.y() - place_z * force.z(),
                         damping * over_mach(yaw, yaw.cmq_per_rad, mach) * w.z() + place_y * force.y());
    const ForceAndMoment found = AerodynamicForce(body, grid, v, w, kDensity, kSound, kCg_m);
    // Rounding of angles and of rows of powers, over forces of 10 q S on arms of 20 m.
    ASSERT_LT((found.force_n - force).norm(), 1e-11 * qs) << k;
    ASSERT_LT((found.moment_n_m - moment).norm(), 1e-10 * qs) << k;
  }
}

TEST(TwoPlanes, TurnedByARightAngleTurnTheirForce) {
  const AeroTable table =
      WithYawPlane(BuildAerodynamics(LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml"))[0], 1.4, 1.2);
  const BodyAerodynamics body = FromTable(table), other = FromTable(Turned(table));
  const AeroGrid grid = BuildAeroGrid(body), other_grid = BuildAeroGrid(other);
  const auto turned = [](const Vector3& of) { return Vector3(of.x(), -of.z(), of.y()); };
  for (const Vector3& v :
       {Vector3(700.0, 20.0, -55.0), Vector3(300.0, 0.0, 9.0), Vector3(500.0, -30.0, 0.0)}) {
    const Vector3 w(0.1, -0.02, 0.05);
    const ForceAndMoment a = AerodynamicForce(body, grid, v, w, 0.7, 310.0, 14.0),
                         b = AerodynamicForce(other, other_grid, turned(v), turned(w), 0.7, 310.0, 14.0);
    EXPECT_LT((turned(a.force_n) - b.force_n).norm(), 1e-13 * a.force_n.norm());
    EXPECT_LT((turned(a.moment_n_m) - b.moment_n_m).norm(), 1e-13 * a.moment_n_m.norm());
    EXPECT_GT(a.force_n.tail<2>().norm(), 1.0);
  }
}

// ---- flights ----

constexpr double kBeforeCoast_s = 160.0;  // thrusters fire by thresholds

// A table over alpha and beta, rows of the planes alone, as a file has it.
std::string CsvOf(const AeroTable& table) {
  std::string text =
      "mach,alpha_rad,beta_rad,ca,cn,cy,xcp_station_m,xcp_side_station_m,cmq_per_rad,clp_per_rad\n";
  for (std::size_t m = 0; m < table.mach.size(); ++m) {
    const auto add = [&](double alpha, double beta, std::size_t i) {
      const std::size_t row = table.RowOf(m, i);
      for (const double value : {table.mach[m], alpha, beta, table.ca[row], beta == 0.0 ? table.cn[row] : 0.0,
                                 beta == 0.0 ? 0.0 : -table.cn[row], table.xcp_station_m[row],
                                 table.xcp_station_m[row], table.cmq_per_rad[m], table.clp_per_rad[m]})
        text += FormatNumber(value) + ",";
      text.back() = '\n';
    };
    for (std::size_t i = 0; i < table.incidence_rad.size(); ++i) add(table.incidence_rad[i], 0.0, i);
    for (std::size_t i = 1; i < table.incidence_rad.size() && table.incidence_rad[i] < 0.5 * kPi; ++i)
      add(0.0, table.incidence_rad[i], i);
  }
  return text;
}

TEST(TwoPlaneFlight, OfABodyOfRevolutionIsThatOfItsTableOverTheIncidence) {
  FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS), plain = definition;
  const std::vector<AeroTable> tables = BuildAerodynamics(definition.vehicle);
  const InputFiles files;
  std::string text = TextOfFile(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml") + "\naerodynamics:\n  tables:\n";
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const std::string name = "aero" + std::to_string(i) + ".csv";
    files.Write(name, CsvOf(tables[i]));
    text += "    - {reference_area_m2: " + FormatNumber(tables[i].reference_area_m2) +
            ", reference_length_m: " + FormatNumber(tables[i].reference_length_m) + ", table: " + name +
            "}\n";
  }
  files.Write("vehicle.yaml", text);
  definition.vehicle = LoadVehicle(files.Path("vehicle.yaml"));
  ASSERT_EQ(definition.vehicle.aerodynamics[0].yaw_plane.size(), 1u);
  const Flown sided = FlyWith(FlightModel(definition), Table3Inputs(), Scheme::kSimpson, 1),
              round = FlyWith(FlightModel(plain), Table3Inputs(), Scheme::kSimpson, 1);
  ASSERT_EQ(sided.result.outcome, Outcome::kCompleted) << sided.result.reason;
  EXPECT_EQ(sided.result.digest.Hex(), round.result.digest.Hex());
}

// CVODE on the equations of one lane, whose force HaveTheForceAndMomentOfTheirTables verifies.
TEST(TwoPlaneFlight, IsThatOfCvode) {
  const FlightModel model(SidedSlv4());
  const Flown engine = FlyUntil(model, Table3Inputs(), Scheme::kSimpson, kBeforeCoast_s),
              exact = FlyUntil(model, Table3Inputs(), Scheme::kCvode, kBeforeCoast_s);
  for (const char* column : {"pitch_error_deg", "yaw_error_deg", "alpha_deg", "beta_deg"})
    EXPECT_LT(Apart(engine, exact, column, kBeforeCoast_s), 1e-4) << column;  // as flight_convergence_test
  const Flown round = FlyUntil(FlightModel(Slv4Definition(DISPERSA_CAMPAIGNS)), Table3Inputs(),
                               Scheme::kSimpson, kBeforeCoast_s);
  EXPECT_GT(Apart(engine, round, "beta_deg", kBeforeCoast_s), 0.05);
}

// The uncertainty that a table states is drawn in both planes.
TEST(TwoPlaneFlight, DrawsBothPlanesTogether) {
  FlightDefinition stated = SidedSlv4();
  const FlightDefinition plain = stated;
  for (AeroTable& table : stated.vehicle.aerodynamics) {
    table.uncertainty.cn.assign(table.cn.size(), 0.04);
    for (AeroTable& yaw : table.yaw_plane) yaw.uncertainty.cn.assign(yaw.cn.size(), 0.04);
  }
  FlightInputs drawn = Table3Inputs(), factor = Table3Inputs();
  drawn.table_cn_sigmas = 2.0;
  factor.lift_factor *= 1.08;
  const Flown a = FlyUntil(FlightModel(stated), drawn, Scheme::kSimpson, kBeforeCoast_s),
              b = FlyUntil(FlightModel(plain), factor, Scheme::kSimpson, kBeforeCoast_s),
              nominal = FlyUntil(FlightModel(plain), Table3Inputs(), Scheme::kSimpson, kBeforeCoast_s);
  for (const char* column : {"pitch_error_deg", "yaw_error_deg"}) {
    EXPECT_LT(Apart(a, b, column, kBeforeCoast_s), 1e-9) << column;
    EXPECT_GT(Apart(a, nominal, column, kBeforeCoast_s), 1e-4) << column;
  }
}

// The sample without control, stable in the air, on a rail.
FlightDefinition FreeDefinition(double azimuth_rad, double elevation_rad) {
  FlightDefinition definition = SampleDefinition();
  Vehicle& vehicle = definition.vehicle;
  for (Stage& stage : vehicle.stages) stage.gimbal = FixedNozzle(stage.gimbal.pivot_station_m);
  vehicle.aerodynamics[0].xcp_station_m = {16.0, 16.0, 16.0, 16.0};
  vehicle.aerodynamics[1].xcp_station_m = {9.0, 9.0, 9.0, 9.0};
  for (AeroTable& table : vehicle.aerodynamics) table = WithYawPlane(table, 2.0, 0.5);
  vehicle.stages[1].ignition = IgnitionTrigger::kBurnoutDetection;
  vehicle.stages[1].ignition_delay_s = 40.0;
  vehicle.flow_coriolis = false;
  vehicle.reaction_control = {};
  vehicle.rail = Rail{0.0, 0.0, azimuth_rad, elevation_rad};
  definition.program.launch_azimuth_rad = azimuth_rad;
  definition.program.knots = {{.time_s = 0.0, .pitch = elevation_rad},
                              {.time_s = 1.0, .pitch = elevation_rad}};
  definition.last_ignition_s = 0.0;
  definition.course = {FlightEnd::kInjection, false, kFreeStep_s};
  definition.autopilot = {};
  definition.autopilot.tick_s = kFreeStep_s;
  for (AxisConfig* axis :
       {&definition.autopilot.pitch, &definition.autopilot.yaw, &definition.autopilot.roll})
    axis->gains.assign(2, {});
  return definition;
}
// Of one stack, up to its burnout or its ignition. The flight goes no farther.
std::vector<TickSample> SamplesOf(int stack, const FlightDefinition& definition, const FlightInputs& inputs) {
  struct Over {};
  std::vector<TickSample> samples;
  FlightOptions options;
  options.observe = [&](const TickSample& sample) {
    if (sample.stack > stack || (sample.stack == stack && stack > 0 && sample.burning)) throw Over();
    if (sample.stack == stack) samples.push_back(sample);
  };
  try {
    ADD_FAILURE() << "ended before: " << Fly(FlightModel(definition), inputs, options).reason;
  } catch (const Over&) {
  }
  return samples;
}

// The largest error of a swing's duration in one of the planes, against omega² = q S CN_alpha (x_cp - x_cg) /
// I.
double WorstSwing(bool in_yaw, int swings) {
  FlightDefinition definition = FreeDefinition(0.5 * kPi, 60.0 * kRadPerDeg);
  definition.vehicle.stages[0].motor.thrust_n = 1.5e6;
  definition.vehicle.stages[0].motor.burning_time_s = 8.0;
  const AeroTable& table = definition.vehicle.aerodynamics[1];
  const AeroTable& plane = in_yaw ? table.yaw_plane[0] : table;
  const double slope = plane.cn[1] / plane.incidence_rad[1], xcp_m = plane.xcp_station_m[0];
  FlightInputs inputs;
  (in_yaw ? inputs.stages[0].tip_off_yaw_rad_s : inputs.stages[0].tip_off_pitch_rad_s) = 0.05;
  double phase = 0.0, before = 0.0, before_s = 0.0, last_phase = 0.0, worst = 0.0;
  int crossings = 0;
  for (const TickSample& s : SamplesOf(1, definition, inputs)) {
    const double omega = std::sqrt(s.instant.air.qbar_pa * table.reference_area_m2 * slope *
                                   (xcp_m - s.instant.cg_station_m) / s.instant.loads.inertia_kg_m2(1, 1));
    const double across = in_yaw ? s.instant.v_AB_B.y() : s.instant.v_AB_B.z();
    const double angle = std::atan2(across, s.instant.v_AB_B.x());
    if (before_s > 0.0) {
      const double dphase = omega * (s.time_s - before_s);
      if (before * angle < 0.0) {
        const double at = phase + dphase * before / (before - angle);
        if (crossings > 0) worst = std::max(worst, std::fabs((at - last_phase) / kPi - 1.0));
        last_phase = at;
        ++crossings;
      }
      phase += dphase;
    }
    before = angle;
    before_s = s.time_s;
    if (crossings == swings) break;
  }
  EXPECT_EQ(crossings, swings);
  return worst;
}
TEST(TwoPlaneFlight, SwingsInEachPlaneAtItsOwnFrequency) {
  // As in free_flight_test: the path turns and the air gets thinner within a swing.
  EXPECT_LT(WorstSwing(false, 12), 0.05);
  EXPECT_LT(WorstSwing(true, 12), 0.05);
}

// A vertical rail: the azimuth turns the body about its axis, and nothing else. With the planes exchanged it
// is the same vehicle in the same wind, but for the roll angle.
TEST(TwoPlaneFlight, TurnedByARightAngleFliesTheSameWay) {
  FlightInputs inputs;
  inputs.air.wind_max_speed_m_s = 8.0;
  inputs.air.wind_azimuth_rad = 300.0 * kRadPerDeg;
  FlightDefinition straight = FreeDefinition(0.5 * kPi, 0.5 * kPi), turned = FreeDefinition(kPi, 0.5 * kPi),
                   other = turned;
  turned.vehicle.aerodynamics = Turned(turned.vehicle.aerodynamics);
  const std::vector<TickSample> a = SamplesOf(0, straight, inputs), b = SamplesOf(0, turned, inputs),
                                c = SamplesOf(0, other, inputs);
  ASSERT_EQ(a.size(), b.size());
  double apart_m = 0.0, apart_deg = 0.0, other_deg = 0.0, bent_deg = 0.0;
  const auto axis = [](const TickSample& s) { return Rotate(s.state.q_IB, Vector3(1.0, 0.0, 0.0)); };
  for (std::size_t k = 0; k < std::min(a.size(), c.size()); ++k) {
    apart_m = std::max(apart_m, (a[k].state.p_EoC_I - b[k].state.p_EoC_I).norm());
    apart_deg = std::max(apart_deg, (axis(a[k]) - axis(b[k])).norm() * kDegPerRad);
    other_deg = std::max(other_deg, (axis(a[k]) - axis(c[k])).norm() * kDegPerRad);
    bent_deg = std::max(bent_deg, (axis(a[k]) - axis(a[0])).norm() * kDegPerRad);
  }
  EXPECT_GT(bent_deg, 0.1);
  // Rounding of 6e6 m, and of sines of the azimuth.
  EXPECT_LT(apart_m, 1e-6);
  EXPECT_LT(apart_deg, 1e-8);
  // The other vehicle, whose planes lie the other way in the wind.
  EXPECT_GT(other_deg, 1e-3);
}

// With boosters two planes, without them a body of revolution.
TEST(TwoPlaneConfigurations, LeaveWithTheBoosters) {
  FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS);
  Vehicle& vehicle = definition.vehicle;
  vehicle.stages[0].jettisoned = {{"pods", 40.0, 14.0, 15.0, 1.2, 1.0, JettisonTrigger::kAtTime, 20.0}};
  const AeroTable round = BuildAerodynamics(vehicle)[0];
  vehicle.aerodynamics = BuildAerodynamics(vehicle);
  vehicle.aerodynamics[0] = WithYawPlane(round, 1.4, 1.2);
  vehicle.aerodynamics[0].lighter = {{{"pods"}, round}};
  const LauncherModel model(BuildNominalPlant(vehicle));
  const auto across = [&](unsigned jettisoned, double y_m_s, double z_m_s) -> Vector3 {
    LauncherPhase phase;
    phase.jettisoned = jettisoned;
    double y[kLauncherSize] = {};
    RigidBodyState state;
    state.p_EoC_I = Vector3(6378137.0 + 8000.0, 0.0, 0.0);
    state.v_IC_I = Vector3(600.0, 465.7 + y_m_s, z_m_s);
    WriteState(state, y);
    return model.Evaluate(phase, 10.0, y).loads.force_n;
  };
  const double with_y = across(0u, 30.0, 0.0).y(), with_z = across(0u, 0.0, 30.0).z();
  const double without_y = across(1u, 30.0, 0.0).y(), without_z = across(1u, 0.0, 30.0).z();
  // The Earth turns under the first two by other speeds than along z.
  EXPECT_NEAR(with_y / without_y, 1.4, 1e-9);
  EXPECT_NEAR(with_z / without_z, 1.0, 1e-9);
  EXPECT_NEAR(without_y / without_z, 1.0, 0.05);
}

// ---- margins ----

// The static moment in the linearised axes: M_alpha = q S CN_alpha (x_cg - x_cp) / I of each plane.
TEST(TwoPlaneMargins, HaveTheStaticMomentOfTheirPlane) {
  FlightDefinition definition = SidedSlv4();
  // Linear in the incidence, so that the slope does not depend on that of the instant.
  for (AeroTable& table : definition.vehicle.aerodynamics) {
    const auto make_linear = [](AeroTable& plane, double slope, double xcp_m) {
      plane.ca.assign(plane.ca.size(), 0.3);
      for (std::size_t row = 0; row < plane.cn.size(); ++row)
        plane.cn[row] = slope * plane.incidence_rad[row % plane.incidence_rad.size()];
      plane.xcp_station_m.assign(plane.cn.size(), xcp_m);
    };
    make_linear(table, 3.0, 6.0);
    for (AeroTable& yaw : table.yaw_plane) make_linear(yaw, 4.5, 9.0);
  }
  const FlightModel model(definition);
  bool seen = false;
  for (const MarginInstant& instant : MarginInstants(model)) {
    if (instant.place != "max q") continue;
    seen = true;
    const TickSample& s = instant.sample;
    const double per_slope = s.instant.air.qbar_pa * definition.vehicle.aerodynamics[0].reference_area_m2 /
                             s.instant.loads.inertia_kg_m2(1, 1);
    const auto moment = [&](Axis axis) {
      return LineariseAxis(model.nominal_plant(), s, axis, model.sensors()).a(1, 0);
    };
    const double cg_m = s.instant.cg_station_m;
    // The flow stays while the body turns: the force along the axis has no moment.
    EXPECT_NEAR(moment(kPitch) / (per_slope * 3.0 * (cg_m - 6.0)), 1.0, 1e-3);
    EXPECT_NEAR(moment(kYaw) / (per_slope * 4.5 * (cg_m - 9.0)), 1.0, 1e-3);
  }
  EXPECT_TRUE(seen);
  LoopMargins pitch, yaw;
  for (const ComputedMargins& margins : ComputeMargins(model))
    if (margins.place == "max q" && margins.axis == kPitch)
      pitch = margins.adapting;
    else if (margins.place == "max q" && margins.axis == kYaw)
      yaw = margins.adapting;
  EXPECT_GT(std::fabs(pitch.gain_down_db - yaw.gain_down_db), 0.05);
}

}  // namespace
}  // namespace dispersa::two_plane_tables_test
