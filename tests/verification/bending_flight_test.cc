// Bending in flight against solutions that share nothing with it: statics of the finite elements, free
// ringing, CVODE, the rigid limit, the nozzle's reaction by hand.
#include <Eigen/Dense>

#include "core/campaign_yaml/load.h"
#include "core/dynamics/aero_grid.h"
#include "core/dynamics/integrator.h"
#include "core/dynamics/jettison.h"
#include "core/flight/flight_model.h"
#include "core/flight/simpson_step.h"
#include "core/margins/flight_margins.h"
#include "core/margins/linear_axis.h"
#include "core/structure/beam_elements.h"
#include "core/structure/beam_mesh.h"
#include "core/structure/mass_points.h"
#include "tests/bending_in_space.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa::bending_flight_test {
namespace {

constexpr double kTick_s = 0.01;

Vehicle Flexible(int modes = 3) {
  Vehicle vehicle = LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4_flexible.yaml");
  vehicle.structure_beam->modes = vehicle.structure_beam->flown_modes = modes;
  return vehicle;
}

// 20 s after ignition.
struct InSpace : BendingInSpace {
  explicit InSpace(const Vehicle& v) : BendingInSpace(v, 20.0) {}
};

// What a lateral force and a couple at the pivot bend the beam of finite elements by: its deflection and
// slope at a station against those of the motion as a rigid body. Beyond the beam's end it goes on straight.
StationShape ElasticShape(const Vehicle& vehicle, double propellant_kg, double force_n, double couple_n_m,
                          double at_station_m) {
  Beam beam;
  beam.timoshenko = vehicle.structure_beam->timoshenko;
  for (const BeamStage& stage : vehicle.structure_beam->stages)
    beam.sections.insert(beam.sections.end(), stage.sections.begin(), stage.sections.end());
  beam.masses = BuildBeamMasses(vehicle, 0, propellant_kg);
  std::vector<double> stations = MeshStations(beam.sections, beam.masses, 120);
  const std::vector<BeamElement> elements = BuildElements(beam, BeamPlane::kZ, stations);
  const Eigen::MatrixXd mass = MassMatrix(beam, stations, elements), stiffness = StiffnessMatrix(elements);
  const Eigen::MatrixXd rigid = RigidShapes(stations, 0.0);
  // The pivot lies 0.1 m behind the beam's end: a couple goes with the force.
  const Eigen::Index end = mass.rows() - kNodeRows;
  Eigen::VectorXd force = Eigen::VectorXd::Zero(mass.rows());
  force[end] = force_n;
  force[end + 1] = couple_n_m + force_n * (vehicle.stages[0].gimbal.pivot_station_m - stations.back());
  const Eigen::Matrix2d of_rigid = rigid.transpose() * mass * rigid;
  const Eigen::VectorXd relieved =
      force - mass * rigid * (of_rigid.inverse() * (rigid.transpose() * force)).eval();
  // Held at one end; then what of it is rigid in the sense of the masses is taken out.
  const Eigen::Index free = mass.rows() - 2;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(mass.rows());
  x.tail(free) = stiffness.bottomRightCorner(free, free).ldlt().solve(relieved.tail(free));
  x -= rigid * (of_rigid.inverse() * (rigid.transpose() * (mass * x))).eval();
  const Eigen::Index row = kNodeRows * static_cast<Eigen::Index>(NearestNode(stations, at_station_m));
  const double behind_m = std::max(at_station_m - stations.back(), 0.0);
  return {x[row] + behind_m * x[row + 1], x[row + 1]};
}

// The modes that do not fly answer at once: a steady load at the pivot moves and turns it as it does the
// beam, however few modes fly.
TEST(BendingFlight, ALoadAtThePivotTurnsItAsTheBeamHoweverFewModesFly) {
  for (const int modes : {1, 3, 5}) {
    const InSpace flight(Flexible(modes));
    const double pivot_m = flight.plant.stacks[0].gimbal.pivot_station_m;
    const StationShape by_force = ElasticShape(flight.vehicle, flight.propellant_kg(), 1.0, 0.0, pivot_m),
                       by_couple = ElasticShape(flight.vehicle, flight.propellant_kg(), 0.0, 1.0, pivot_m);
    ASSERT_NEAR(by_couple.deflection / by_force.slope_1_m, 1.0, 1e-6);
    double found[3], of_modes[3] = {};
    for (int i = 0; i < 3; ++i)
      found[i] = flight.At(0, static_cast<ModeTable::Column>(ModeTable::kResidual + i));
    for (int mode = 0; mode < modes; ++mode) {
      const double deflection = flight.At(mode, ModeTable::kPivotDeflection),
                   slope = flight.At(mode, ModeTable::kPivotSlope),
                   softness = flight.At(mode, ModeTable::kInverseMass) /
                              std::pow(flight.At(mode, ModeTable::kFrequency), 2);
      of_modes[0] += softness * deflection * deflection;
      of_modes[1] += softness * deflection * slope;
      of_modes[2] += softness * slope * slope;
    }
    const double exact[3] = {by_force.deflection, by_force.slope_1_m, by_couple.slope_1_m};
    for (int i = 0; i < 3; ++i) {
      // Both are linear between two levels of propellant: their squares are not.
      EXPECT_NEAR((found[i] + of_modes[i]) / exact[i], 1.0, 2e-3) << modes << " modes, " << i;
      if (modes == 1) {
        EXPECT_LT(of_modes[i], 0.9 * exact[i]) << i;
      }
    }
  }
}

// The thrust acts along the axis that the load has turned, and where it has moved it.
TEST(BendingFlight, ResidualFlexibilityTurnsAndMovesTheThrust) {
  const InSpace flight(Flexible());
  const double thrust = flight.plant.stacks[0].burn.vacuum_thrust_n;
  const MassProperties mass = flight.plant.stacks[0].mass.At(flight.propellant_kg());
  const double lever = flight.plant.stacks[0].gimbal.pivot_station_m - mass.cg_station_m;
  const double angle = 0.02;
  for (const int plane : {0, 1}) {
    InSpace tilted = flight;
    for (const std::size_t pair : {0u, 1u}) {
      const std::size_t nozzle = pair + (plane == 1 ? 0u : 2u);
      tilted.y[kNozzleAngle + nozzle] = tilted.phase.command_rad[nozzle] = angle;
    }
    InSpace stiff = tilted;
    ModeTable without = tilted.table();
    for (std::size_t row = 0; row < without.rows.size(); row += ModeTable::kRowSize)
      for (std::size_t i = 0; i < 3; ++i) without.rows[row + ModeTable::kResidual + i] = 0.0;
    stiff.plant.stacks[0].bending = std::make_shared<const ModeTable>(std::move(without));
    const auto rates = tilted.Rates(), before = stiff.Rates();
    const std::size_t across = plane == 1 ? 5 : 4, about = plane == 1 ? 11 : 12;
    const double side = 0.5 * thrust * std::sin(angle) * (plane == 1 ? 1.0 : -1.0);
    const double along = 0.5 * thrust * (1.0 + std::cos(angle));
    const double moved = side * flight.At(0, static_cast<ModeTable::Column>(ModeTable::kResidual)),
                 turned = side * flight.At(0, static_cast<ModeTable::Column>(ModeTable::kResidual + 1));
    const double turned_n = -along * turned;
    EXPECT_GT(std::fabs(turned_n), 1e-3 * std::fabs(side));
    EXPECT_NEAR((rates[across] - before[across]) / (turned_n / mass.mass_kg), 1.0, 1e-3) << plane;
    const double moment = (lever * turned_n + moved * along) * (plane == 1 ? 1.0 : -1.0);
    EXPECT_NEAR((rates[about] - before[about]) / (moment / mass.transverse_inertia_kg_m2), 1.0, 1e-3)
        << plane;
  }
}

TEST(BendingFlight, ASteadyForceBendsTheBodyAsItBendsTheBeam) {
  double last = 1.0;
  for (const int modes : {1, 3, 5}) {
    InSpace flight(Flexible(modes));
    ASSERT_EQ(flight.table().modes, modes);
    // So small a thrust that neither its own turning nor compression counts.
    flight.plant.stacks[0].burn.vacuum_thrust_n = 1e3;
    const double angle_rad = 0.05, force_n = 0.5 * 1e3 * std::sin(angle_rad);
    const double exact = ElasticShape(flight.vehicle, flight.propellant_kg(), force_n, 0.0, 1.65).slope_1_m;
    const auto centred = flight.y;
    for (const int plane : {0, 1}) {
      // Right and left turn the force to +z, bottom and top to -y.
      flight.y = centred;
      flight.phase.command_rad.fill(0.0);
      for (const std::size_t pair : {0u, 1u}) {
        const std::size_t nozzle = pair + (plane == 1 ? 0u : 2u);
        flight.y[kNozzleAngle + nozzle] = flight.phase.command_rad[nozzle] = angle_rad;
      }
      const auto rates = flight.Rates();
      double slope = 0.0;
      for (int mode = 0; mode < modes; ++mode) {
        const double w = flight.At(mode, ModeTable::kFrequency);
        slope += flight.At(mode, ModeTable::kUnitSlope) *
                 rates[static_cast<std::size_t>(kModalRate + plane * kModes + mode)] / (w * w);
      }
      const double expected = plane == 1 ? exact : -exact;
      const double error = std::fabs(slope / expected - 1.0);
      // Of a sum of infinitely many.
      EXPECT_LT(error, 0.5 * last) << "plane " << (plane == 0 ? 'y' : 'z') << ", " << modes << " modes";
      if (plane == 1) last = error;
    }
  }
  EXPECT_LT(last, 0.03);
}

// One lane of the engine's step.
std::unique_ptr<lanes::StepState<double>> StepOf(const InSpace& flight, double tick_s) {
  static const FlightWeather calm;
  auto step = std::make_unique<lanes::StepState<double>>();
  step->Configure(flight.plant, tick_s);
  step->StartFlight(0, calm, flight.y.data());
  step->SetStack(0, flight.plant, 0);
  if (flight.phase.burning) step->Ignite(0, flight.phase.ignition_s, false);
  step->CommandLane(0, 0, flight.phase.command_rad.data());
  return step;
}

TEST(BendingFlight, FreeModesRingAndLeaveTheBodyAlone) {
  for (const double damping_ratio : {0.0, 0.01}) {
    InSpace flight(Flexible());
    flight.phase.burning = false;
    flight.plant.bending.damping_factor = damping_ratio / flight.vehicle.structure_beam->damping_ratio;
    flight.y[12] = 0.02;
    InSpace rigid = flight;
    for (int plane = 0; plane < kPlanes; ++plane)
      for (int mode = 0; mode < 3; ++mode)
        flight.y[static_cast<std::size_t>(kModalState + plane * kModes + mode)] =
            0.01 * (1 + plane) / (1 + mode);
    const auto step = StepOf(flight, kTick_s), without = StepOf(rigid, kTick_s);
    const int ticks = 500;
    for (int i = 0; i < ticks; ++i) {
      ASSERT_TRUE(step->Step(true, true, i * kTick_s, (i + 1) * kTick_s));
      ASSERT_TRUE(without->Step(true, true, i * kTick_s, (i + 1) * kTick_s));
    }
    double y[kLauncherSize], alone[kLauncherSize];
    step->ReadLane(0, y);
    without->ReadLane(0, alone);
    for (int i = 0; i < kRigidBodySize; ++i) EXPECT_EQ(y[i], alone[i]) << i;
    const double t = ticks * kTick_s, full = flight.plant.stacks[0].burn.propellant_mass_kg;
    for (int plane = 0; plane < kPlanes; ++plane)
      for (int mode = 0; mode < 3; ++mode) {
        const int at = plane * kModes + mode;
        const double q0 = flight.y[static_cast<std::size_t>(kModalState + at)];
        const double w = flight.table().At(0, mode, ModeTable::kFrequency, full);
        const double d = w * std::sqrt(1.0 - damping_ratio * damping_ratio), s = damping_ratio * w;
        const double e = std::exp(-s * t) * q0;
        EXPECT_NEAR(y[kModalState + at], e * (std::cos(d * t) + s / d * std::sin(d * t)), 1e-11);
        EXPECT_NEAR(y[kModalRate + at], -e * w * w / d * std::sin(d * t), 1e-9);
        if (damping_ratio > 0.0) continue;
        const double energy =
            y[kModalRate + at] * y[kModalRate + at] + w * w * y[kModalState + at] * y[kModalState + at];
        EXPECT_NEAR(energy, w * w * q0 * q0, 1e-11 * w * w * q0 * q0);
      }
  }
}

struct Judge {
  LauncherModel equations;
  LauncherPhase phase;
  static void Rhs(double t, const double* y, double* dydt, void* context) {
    const auto* self = static_cast<const Judge*>(context);
    self->equations.Derivative(self->phase, t, y, dydt);
  }
};

// Full thrust in the air, nozzles on their way to a command, everything bent: a second of it, with order 4.
TEST(BendingFlight, TheStepConvergesToCvode) {
  Vehicle vehicle = Flexible();
  for (Stage& stage : vehicle.stages) {
    stage.gimbal.nozzle_mass_kg = 40.0;
    stage.gimbal.nozzle_cg_m = 0.3;
    stage.gimbal.nozzle_inertia_kg_m2 = 8.0;
  }
  InSpace flight(vehicle);
  // Coefficients without kinks, which would hide the order.
  BodyAerodynamics& body = flight.plant.stacks[0].aerodynamics;
  for (Coefficient* c : {&body.ca, &body.cn, &body.xcp_station_m}) {
    c->table = {{0.0, 20.0}, {0.0, kPi}, {}};
    c->table.z = c == &body.cn ? std::vector<double>{0.0, 9.0, 0.0, 9.0}
                               : std::vector<double>(4, c == &body.ca ? 0.4 : 6.0);
  }
  flight.plant.stacks[0].aero_grid = std::make_shared<const AeroGrid>(BuildAeroGrid(body));
  RigidBodyState s;
  s.p_EoC_I = FromGeodetic(flight.plant.environment.earth, {0.4, 1.1, 8000.0});
  s.q_IB = FromRotationVector(Vector3(0.3, -1.2, 0.4));
  const Vector3 earth_rate_I(0.0, 0.0, flight.plant.environment.earth.rotation_rate_rad_s);
  s.v_IC_I = earth_rate_I.cross(s.p_EoC_I) + Rotate(s.q_IB, Vector3(500.0, 6.0, -15.0));
  s.w_IB_B = Vector3(0.02, 0.02, -0.03);
  WriteState(s, flight.y.data());
  for (int mode = 0; mode < 3; ++mode) {
    flight.y[static_cast<std::size_t>(kModalState + mode)] = 0.01;
    flight.y[static_cast<std::size_t>(kModalRate + kModes + mode)] = 0.1;
  }
  for (int i = 0; i < kNozzles; ++i) flight.phase.command_rad[static_cast<std::size_t>(i)] = 0.01 - 0.004 * i;

  Judge judge{LauncherModel(flight.plant), flight.phase};
  std::array<double, kLauncherSize> exact = flight.y, tolerances;
  tolerances.fill(1e-14);
  Integrator cvode(Scheme::kCvode, kBentLauncherSize, &Judge::Rhs, &judge, tolerances.data());
  // Its tolerance is of the change within a call.
  for (int i = 0; i < 100; ++i)
    ASSERT_TRUE(cvode.Advance(20.0 + 0.01 * i, 20.0 + 0.01 * (i + 1), 1, exact.data()));

  double last[3] = {};
  for (const int steps : {50, 100, 200, 400}) {
    const auto step = StepOf(flight, 1.0 / steps);
    for (int k = 0; k < steps; ++k)
      ASSERT_TRUE(step->Step(true, true, 20.0 + static_cast<double>(k) / steps, 20.0 + (k + 1.0) / steps));
    double y[kLauncherSize];
    step->ReadLane(0, y);
    const RigidBodyState at = ReadState(y), truth = ReadState(exact.data());
    double error[3] = {(at.w_IB_B - truth.w_IB_B).norm(), 0.0, 0.0};
    for (int i = kModalState; i < kModalRate; ++i)
      error[1] = std::max(error[1], std::fabs(y[i] - exact[static_cast<std::size_t>(i)]));
    for (int i = kModalRate; i < kBentLauncherSize; ++i)
      error[2] = std::max(error[2], std::fabs(y[i] - exact[static_cast<std::size_t>(i)]));
    for (int i = 0; i < 3; ++i) {
      if (last[i] > 0.0) {
        EXPECT_LT(error[i], 0.1 * last[i]) << i << ", " << steps << " steps";
      }
      last[i] = error[i];
    }
    if (steps != 100) continue;
    // As shipped: of 0.04 rad/s, 0.01 m and 0.3 m/s. The last is mode 3's, whose air swings through an eighth
    // of a period in a step and is taken as a parabola: in proportion to what the flow does by the
    // modes, 2.6e-6 without it, 1.34e-5 with half of it, 2.80e-5 with all.
    EXPECT_LT(error[0], 2e-8);
    EXPECT_LT(error[1], 1e-6);
    EXPECT_LT(error[2], 2.9e-5);
  }
}

TEST(BendingFlight, TurningNozzlesPushTheirPivotsAndTurnTheBody) {
  Vehicle vehicle = Flexible();
  Gimbal& gimbal = vehicle.stages[0].gimbal;
  gimbal.nozzle_mass_kg = 40.0;
  gimbal.nozzle_cg_m = 0.3;
  gimbal.nozzle_inertia_kg_m2 = 8.0;
  InSpace flight(vehicle);
  flight.plant.stacks[0].burn.vacuum_thrust_n = 0.0;  // the reaction alone
  // Centred, at rest, all commanded alike: pitch and yaw at once.
  flight.phase.command_rad.fill(0.01);
  const auto moved = flight.Rates();
  flight.phase.command_rad.fill(0.0);
  const auto still = flight.Rates();
  const double acceleration = 0.01 * gimbal.bandwidth_rad_s * gimbal.bandwidth_rad_s;
  const MassProperties mass = flight.plant.stacks[0].mass.At(flight.propellant_kg());
  const double force = 2.0 * 40.0 * 0.3 * acceleration;
  const double lever = gimbal.pivot_station_m - mass.cg_station_m;
  const double turn = (force * lever + 2.0 * 8.0 * acceleration) / mass.transverse_inertia_kg_m2;
  EXPECT_NEAR(moved[5] - still[5], force / mass.mass_kg, 1e-9);
  EXPECT_NEAR(moved[4] - still[4], -force / mass.mass_kg, 1e-9);
  EXPECT_NEAR(moved[11] - still[11], turn, 1e-9);
  EXPECT_NEAR(moved[12] - still[12], turn, 1e-9);
  for (int mode = 0; mode < 3; ++mode) {
    const double drive = flight.At(mode, ModeTable::kInverseMass) *
                         (force * flight.At(mode, ModeTable::kPivotDeflection) +
                          16.0 * acceleration * flight.At(mode, ModeTable::kPivotSlope));
    const std::size_t z = static_cast<std::size_t>(kModalRate + kModes + mode), y = z - kModes;
    EXPECT_NEAR(moved[z] - still[z], drive, 1e-9);
    EXPECT_NEAR(moved[y] - still[y], -drive, 1e-9);
  }
}

TEST(BendingFlight, ABentBodyTurnsAndMovesItsThrustAndIsCompressedByIt) {
  InSpace flight(Flexible());
  const auto straight = flight.Rates();
  const double thrust = flight.plant.stacks[0].burn.vacuum_thrust_n, q = 0.02;
  const MassProperties mass = flight.plant.stacks[0].mass.At(flight.propellant_kg());
  const double lever = flight.plant.stacks[0].gimbal.pivot_station_m - mass.cg_station_m;
  for (int mode = 0; mode < 3; ++mode) {
    const double turn = flight.At(mode, ModeTable::kPivotSlope) * q;
    const double moved = flight.At(mode, ModeTable::kPivotDeflection) * q;
    // Plane z: turned nose up by +turn about y; plane y: by -turn about z.
    for (int plane = 0; plane < kPlanes; ++plane) {
      InSpace bent = flight;
      bent.y[static_cast<std::size_t>(kModalState + plane * kModes + mode)] = q;
      const auto rates = bent.Rates();
      const double side = -thrust * turn;  // along the plane's axis
      EXPECT_NEAR(rates[plane == 1 ? 5 : 4] - straight[plane == 1 ? 5 : 4], side / mass.mass_kg, 1e-9);
      const double moment = lever * side + moved * thrust;  // about y; about z the other way
      const double about = (plane == 1 ? 1.0 : -1.0) * moment / mass.transverse_inertia_kg_m2;
      EXPECT_NEAR(rates[plane == 1 ? 11 : 12] - straight[plane == 1 ? 11 : 12], about, 1e-9);
      const double w = flight.At(mode, ModeTable::kFrequency);
      for (int other = 0; other < 3; ++other) {
        const double drive =
            flight.At(other, ModeTable::kInverseMass) *
            (side * flight.At(other, ModeTable::kPivotDeflection) +
             thrust * q * flight.At(other, static_cast<ModeTable::Column>(ModeTable::kShortening + mode)));
        const std::size_t at = static_cast<std::size_t>(kModalRate + plane * kModes + other);
        EXPECT_NEAR(rates[at], drive - (other == mode ? w * w * q : 0.0), 1e-8);
      }
    }
  }
}

// By how much, as a logarithm, a stage's loop lets a disturbance grow while it is unstable with so many
// further ticks of delay: the linearised growth over its burn.
double GrowthWithDelay(const FlightModel& model, const std::vector<MarginInstant>& instants, int stage,
                       int ticks) {
  const LauncherPlant& plant = model.nominal_plant();
  const double tick_s = model.autopilot().config.tick_s;
  double growth = 0.0, before_s = -1.0;
  for (const MarginInstant& instant : instants) {
    const TickSample& s = instant.sample;
    if (s.stack != stage) continue;
    const SampledLoop loop(LineariseAxis(plant, s, kPitch, model.sensors()),
                           LineariseLaw(model.autopilot(), stage, s.since_ignition_s, kPitch, true), tick_s,
                           plant.stacks[static_cast<std::size_t>(stage)].gimbal.delay_ticks + ticks);
    if (before_s >= 0.0)
      growth += std::max(0.0, std::log(loop.SpectralRadius(1.0)) / tick_s) * (s.time_s - before_s);
    before_s = s.time_s;
  }
  return growth;
}

// What is computed of the linearised loop, with modes, gyros, filters and the nozzles' masses, is lost in
// flight where it says so. A mode beyond its delay margin grows slowly, or for a few seconds only: a flight
// holds such a delay as long as nothing grows much, and no longer.
TEST(BendingFlight, MarginsMeasuredInFlightAreTheComputedOnes) {
  constexpr double kNoticed = 3.0;  // twentyfold
  for (const char* autopilot : {"flexible", "flexible_unscheduled"}) {
    FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS, autopilot);
    definition.vehicle = LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4_flexible.yaml");
    const FlightModel model(definition);
    const std::vector<ComputedMargins> computed = ComputeDispersedMargins(model, {}).margins;
    const std::vector<MarginInstant> instants = MarginInstants(model);
    for (const MeasuredMargins& m : MeasureMargins(model)) {
      double up_db = 1e9, delay_s = 1e9;
      for (const ComputedMargins& c : computed) {
        if (c.stage != m.stage) continue;
        up_db = std::min(up_db, c.adapting.gain_up_db);
        delay_s = std::min(delay_s, c.adapting.delay_s);
      }
      int noticed_ticks = 1;
      while (noticed_ticks < 25 && GrowthWithDelay(model, instants, m.stage, noticed_ticks) < kNoticed)
        ++noticed_ticks;
      const double noticed_s = noticed_ticks * definition.autopilot.tick_s;
      // Lost counts an oscillation of 0.2 deg, which excitation reaches before the loop is unstable: 1 dB
      // below its margin a loop amplifies ninefold, 1 / (1 - 10^(-1/20)).
      EXPECT_GT(m.gain_up_db, up_db - 1.0) << autopilot << ", " << m.stage;
      EXPECT_LT(m.gain_up_db, up_db + 0.5) << m.stage;
      EXPECT_GT(m.delay_s, 0.85 * delay_s) << m.stage;
      EXPECT_LE(m.delay_s, noticed_s) << m.stage;
    }
  }
}

// As stiffness grows the flight becomes the rigid one, in proportion to the compliance.
TEST(BendingFlight, AStiffBodyIsARigidOne) {
  FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS, "flexible");
  // One mode, and ticks of half, whose steps resolve 125 Hz; the fourth stage is rigid.
  definition.vehicle = Flexible(1);
  definition.autopilot.tick_s *= 0.5;
  for (Stage& stage : definition.vehicle.stages) stage.gimbal.delay_ticks *= 2;
  FlightInputs inputs = Table3Inputs();
  FlightDefinition rigid = definition;
  rigid.vehicle.structure_beam->flown_modes = 0;
  const FlightResult exact = Fly(FlightModel(rigid), inputs);
  ASSERT_EQ(exact.outcome, Outcome::kCompleted);
  const FlightModel model(definition);
  double last[3] = {};
  for (const double factor : {1.0, 2.0, 4.0}) {
    inputs.bending_frequency_factor.fill(factor);
    const FlightResult stiff = Fly(model, inputs);
    ASSERT_EQ(stiff.outcome, Outcome::kCompleted);
    const char* names[] = {"pitch_error_rms_stage1_deg", "pitch_error_rms_stage2_deg", "alpha_max_deg"};
    for (int i = 0; i < 3; ++i) {
      const double error = std::fabs(MetricOf(stiff, names[i]) / MetricOf(exact, names[i]) - 1.0);
      // Compliance falls to a quarter.
      if (last[i] > 0.0) {
        EXPECT_LT(error, 0.4 * last[i]) << names[i] << ", frequencies times " << factor;
      }
      last[i] = error;
    }
  }
}

// A stage that leaves a ringing stack leaves the one above with the momentum and the angular momentum that
// its own masses had. Those from the moments of a section behind them all, at two places: sums of m (s - x) w
// and of m g² theta.
TEST(BendingFlight, ASeparationLeavesTheUpperStackItsMomentum) {
  const Vehicle vehicle = Flexible();
  const InSpace space(vehicle);
  const LauncherStack &below = space.plant.stacks[0], &above = space.plant.stacks[1];
  const std::vector<StackModes> stacks = BuildBendingModes(vehicle);
  const StackModes& stack = stacks[0];
  const BendingLevel& burnt = stack.levels[0].back();
  ASSERT_EQ(burnt.propellant_kg, 0.0);
  const std::vector<MassPoint> points =
      MassPointsOf(BuildBeamMasses(vehicle, 1, vehicle.stages[1].propellant_mass_kg), stack.station_m[0]);
  const MassProperties mass = above.mass.At(vehicle.stages[1].propellant_mass_kg);
  for (int plane = 0; plane < kPlanes; ++plane)
    for (int mode = 0; mode < 3; ++mode) {
      const auto shape = [&](double s) {
        return ShapeOf(stack, BeamPlane::kY, burnt.modes[static_cast<std::size_t>(mode)], s);
      };
      const double near_m = 25.0, far_m = 26.0;  // behind all of it
      const double near = InertiaMoment(points, near_m, AtStations(shape)),
                   far = InertiaMoment(points, far_m, AtStations(shape));
      const double momentum = (far - near) / (far_m - near_m);
      const double angular = near_m * momentum - near - mass.cg_station_m * momentum;
      double modal[2 * kPlanes * kModes] = {};
      const double q_m = 0.003, rate_m_s = -0.2;
      modal[plane * kModes + mode] = q_m;
      modal[(kPlanes + plane) * kModes + mode] = rate_m_s;
      RigidBodyState state;
      state.q_IB = FromRotationVector(Vector3(0.3, -0.7, 1.1));
      state.w_IB_B = Vector3(0.01, 0.02, -0.03);
      const RigidBodyState before = state;
      TakeAlong(below, 0, modal, state);
      const Vector3 along = plane == 0 ? Vector3::UnitY() : Vector3::UnitZ(),
                    about = plane == 0 ? Vector3(-Vector3::UnitZ()) : Vector3(Vector3::UnitY());
      const double move = momentum / mass.mass_kg, turn = angular / mass.transverse_inertia_kg_m2;
      EXPECT_GT(std::fabs(move), 5e-4);
      EXPECT_GT(std::fabs(turn), 5e-4);
      const auto expect = [&](const Vector3& found, const Vector3& wanted, const char* what) {
        EXPECT_LT((found - wanted).norm(), 2e-3 * wanted.norm())
            << what << ", plane " << plane << ", mode " << mode;
      };
      expect(state.p_EoC_I, Rotate(before.q_IB, Vector3(move * q_m * along)), "place");
      expect(state.v_IC_I, Rotate(before.q_IB, Vector3(move * rate_m_s * along)), "speed");
      expect(RotationVector(Inverse(before.q_IB) * state.q_IB), turn * q_m * about, "turn");
      expect(state.w_IB_B - before.w_IB_B, turn * rate_m_s * about, "rate");
    }
}

// In a flight: the upper stack begins with what the ringing stage 1 leaves it. The modes swing on by a tenth
// of their period within a tick, hence the factor.
TEST(BendingFlight, TheUpperStackFliesOnWithTheModesMomentum) {
  FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS, "flexible");
  definition.vehicle = Flexible();
  const FlightModel model(definition);
  std::optional<TickSample> before, after;
  FlightOptions options;
  options.observe = [&](const TickSample& s) {
    if (s.stack == 0) before = s;
    if (s.stack == 1 && !after) after = s;
  };
  FlightInputs inputs = Table3Inputs();
  Fly(model, inputs, options);
  ASSERT_TRUE(before && after);
  const LauncherPlant plant = model.PlantFor(inputs);
  RigidBodyState left;
  left.q_IB = {};
  TakeAlong(plant.stacks[0], 0, before->bending.data(), left);
  const Vector3 jump = after->state.w_IB_B - before->state.w_IB_B;
  EXPECT_GT(left.w_IB_B.norm(), 1e-6);
  EXPECT_LT((jump - left.w_IB_B).norm(), 0.5 * left.w_IB_B.norm())
      << jump.transpose() << " for " << left.w_IB_B.transpose();
}

}  // namespace
}  // namespace dispersa::bending_flight_test
