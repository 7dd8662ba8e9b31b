// Stages with clusters of engines: forces of up to 33 nozzles by hand, nine as one, roll, an engine that is
// too weak, one that is stuck, groups, verniers, and the state of them in the judges' flights.
#include "core/flight/flight.h"
#include "core/flight/metrics.h"
#include "core/margins/flight_margins.h"
#include "core/math/constants.h"
#include "core/random/draws.h"
#include "tests/flown_ticks.h"
#include "tests/test.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::flight_clusters_test {

constexpr double kDeg = kRadPerDeg;
constexpr double kSpace_m = 2e6;  // above the atmosphere's end
constexpr double kThrust_n = 200e3, kPivot_m = 19.5;

Nozzle Centre() { return {"centre", 0.0, 0.0, 0.0, {90.0 * kDeg, 180.0 * kDeg}, 0.0}; }
Nozzle RingOf(int count, double radius_m) {
  Nozzle ring = {"outer", 0.0, 0.0, 0.0, {90.0 * kDeg, 180.0 * kDeg}, 0.0};
  ring.ring = {count, radius_m, 0.0, false};
  return ring;
}
// Eight round one.
std::vector<Nozzle> Octaweb() { return {Centre(), RingOf(8, 0.5)}; }
std::vector<Nozzle> ThirtyThree() { return {RingOf(3, 0.15), RingOf(10, 0.35), RingOf(20, 0.55)}; }
std::vector<Nozzle> Named(std::vector<Nozzle> nozzles) {
  for (std::size_t i = 0; i < nozzles.size(); ++i) nozzles[i].name += std::string(1, char('a' + i));
  return nozzles;
}

FlightDefinition Definition(const std::vector<Nozzle>& nozzles) {
  FlightDefinition definition = HighDefinition();
  definition.vehicle.stages[0].gimbal.nozzles = nozzles;
  EXPECT_TRUE(NozzleProblems(definition.vehicle.stages[0].gimbal, "gimbal").empty());
  return definition;
}

using Angles = std::array<double, kMostDrives>;

// At rest above the air, burning for 10 s, the drives at these angles.
LauncherInstant InstantAt(const FlightModel& model, const FlightInputs& inputs, const Angles& angles) {
  RigidBodyState state;
  state.p_EoC_I = {Wgs84().equatorial_radius_m + kSpace_m, 0.0, 0.0};
  std::array<double, kLauncherSize> y{};
  WriteState(state, y.data());
  for (int drive = 0; drive < kMostDrives; ++drive)
    y[static_cast<std::size_t>(AngleOf(drive))] = angles[static_cast<std::size_t>(drive)];
  LauncherPhase phase;
  phase.burning = true;
  return LauncherModel(model.PlantFor(inputs)).Evaluate(phase, 10.0, y.data());
}

// Each engine pushes at its place along its own turned axis: sums of forces and moments by vector algebra.
TEST(Clusters, AddForcesAndMomentsOfEveryEngine) {
  for (const std::vector<Nozzle>& listed : {Octaweb(), Named(ThirtyThree())}) {
    const FlightModel model(Definition(listed));
    const std::vector<Nozzle> nozzles = NozzlesOf(model.definition().vehicle.stages[0].gimbal);
    Stream draws(7, nozzles.size(), "angles");
    Angles angles{};
    for (int k = 0; k < static_cast<int>(nozzles.size()); ++k)
      for (const int hinge : {0, 1})
        angles[static_cast<std::size_t>(DriveOf(k, hinge))] = 5.0 * kDeg * (2.0 * draws.Uniform() - 1.0);
    FlightInputs inputs;
    inputs.stages[0].nozzles[2].line.misalignment_rad.y = 0.004;
    inputs.further[1].nozzle.line.misalignment_rad.magnitude = 0.01;  // the sixth
    inputs.further[1].nozzle.line.misalignment_rad.clock_rad = 0.7;
    inputs.further[3].nozzle.line.offset_m.y = 0.02;  // the eighth
    inputs.further[4].nozzle.thrust_factor = 0.95;    // the ninth
    const LauncherInstant now = InstantAt(model, inputs, angles);
    Vector3 force = Vector3::Zero(), moment = Vector3::Zero();
    double shares = 0.0;
    for (std::size_t k = 0; k < nozzles.size(); ++k) {
      const double a = angles[static_cast<std::size_t>(DriveOf(static_cast<int>(k), 0))],
                   b = angles[static_cast<std::size_t>(DriveOf(static_cast<int>(k), 1))];
      // The first hinge towards +z, the second towards -y.
      Vector3 each = kThrust_n / static_cast<double>(nozzles.size()) *
                     Vector3(std::cos(a) * std::cos(b), -std::sin(b), std::sin(a) * std::cos(b));
      if (k == 2) each = Eigen::AngleAxisd(0.004, Vector3::UnitZ()) * each;
      if (k == 5) each = Eigen::AngleAxisd(0.01, Vector3(0.0, -std::sin(0.7), std::cos(0.7))) * each;
      if (k == 8) each *= 0.95;
      Vector3 place(now.cg_station_m - kPivot_m, nozzles[k].y_m, nozzles[k].z_m);
      if (k == 7) place.y() += 0.02;
      force += each;
      moment += place.cross(each);
      shares += nozzles[k].thrust_share;
    }
    EXPECT_NEAR(shares, 1.0, 1e-14);
    EXPECT_NEAR((now.loads.force_n - force).norm(), 0.0, 1e-7) << nozzles.size();
    EXPECT_NEAR((now.loads.moment_n_m - moment).norm(), 0.0, 1e-6) << nozzles.size();
    EXPECT_GT(std::fabs(moment.x()), 10.0);
  }
}

FlightInputs Disturbed() {
  FlightInputs inputs;
  for (StageInputs& stage : inputs.stages) stage.thrust.misalignment_rad.magnitude = 0.2 * kDeg;
  for (StageInputs& stage : inputs.stages) stage.thrust.misalignment_rad.clock_rad = 0.6;
  inputs.stages[0].cg_offset_m.magnitude = 0.01;
  return inputs;
}

double Apart(const std::vector<TickSample>& a, const std::vector<TickSample>& b, double until_s = 1e9) {
  EXPECT_EQ(a.size(), b.size());
  double apart = 0.0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()) && a[i].time_s < until_s; ++i)
    apart = std::max(apart, (a[i].state.w_IB_B - b[i].state.w_IB_B).norm());
  return apart;
}

// Nine that turn alike are one engine with the sum of their thrusts: they share a group, and roll is left to
// the thrusters.
TEST(Clusters, NineEnginesThatTurnAlikeFlyAsOne) {
  std::vector<Nozzle> nine = Octaweb();
  for (Nozzle& entry : nine) entry.group = "all";
  FlightResult cluster, single;
  const auto many = TicksOf(Definition(nine), Disturbed(), &cluster);
  const auto one = TicksOf(Definition({Centre()}), Disturbed(), &single);
  ASSERT_EQ(cluster.outcome, Outcome::kCompleted) << cluster.reason;
  EXPECT_LT(Apart(many, one), 1e-9);
  double turned = 0.0;
  for (const TickSample& s : many) {
    if (!s.burning || s.stack != 0) continue;
    for (int k = 1; k < 9; ++k)
      for (const int hinge : {0, 1})
        ASSERT_EQ(s.nozzle_rad[static_cast<std::size_t>(DriveOf(k, hinge))],
                  s.nozzle_rad[static_cast<std::size_t>(DriveOf(0, hinge))]);
    turned = std::max(turned, std::fabs(s.nozzle_rad[0]));
  }
  EXPECT_GT(turned, 0.1 * kDeg);
  for (std::size_t i = 0; i < single.metrics.size(); ++i) {
    // A mean over all drives of the flight has another weight for each stage.
    if (std::isnan(single.metrics[i]) || MetricNames()[i] == "deflection_rms_deg") continue;
    EXPECT_NEAR(cluster.metrics[i], single.metrics[i], 1e-6 * std::max(1.0, std::fabs(single.metrics[i])))
        << MetricNames()[i];
  }
}

// Masses of nozzles: nine alike react as one of nine times the mass.
TEST(Clusters, MassesOfNineNozzlesReactAsNineTimesTheMass) {
  const auto angular = [](std::vector<Nozzle> nozzles, double times) {
    for (Nozzle& entry : nozzles) entry.group = "all";
    FlightDefinition definition = Definition(nozzles);
    Gimbal& gimbal = definition.vehicle.stages[0].gimbal;
    gimbal.nozzle_mass_kg = 20.0 * times;
    gimbal.nozzle_cg_m = 0.4;
    gimbal.nozzle_inertia_kg_m2 = 5.0 * times;
    const FlightModel model(definition);
    std::array<double, kLauncherSize> y{}, dydt{};
    RigidBodyState state;
    state.p_EoC_I = {Wgs84().equatorial_radius_m + kSpace_m, 0.0, 0.0};
    WriteState(state, y.data());
    LauncherPhase phase;
    phase.burning = true;
    for (int k = 0; k < static_cast<int>(NozzlesOf(gimbal).size()); ++k) {
      phase.command_rad[static_cast<std::size_t>(DriveOf(k, 0))] = 0.03;
      phase.command_rad[static_cast<std::size_t>(DriveOf(k, 1))] = -0.01;
    }
    LauncherModel(model.PlantFor({})).Derivative(phase, 10.0, y.data(), dydt.data());
    return ReadState(dydt.data()).w_IB_B;
  };
  const Vector3 nine = angular(Octaweb(), 1.0), one = angular({Centre()}, 9.0);
  EXPECT_NEAR((nine - one).norm(), 0.0, 1e-12 * one.norm());
  EXPECT_GT(one.norm(), 1e-3);
}

// The judges integrate the same equations by other means.
TEST(Clusters, JudgesFlyTheSameFlight) {
  for (const auto& nozzles : {Octaweb(), Named(ThirtyThree())}) {
    FlightInputs inputs = Disturbed();
    inputs.further[1].nozzle.thrust_factor = 0.97;
    const auto engine = TicksOf(Definition(nozzles), inputs);
    const auto judge = TicksOf(Definition(nozzles), inputs, nullptr, {.scheme = Scheme::kRungeKutta4});
    EXPECT_LT(Apart(engine, judge, 40.0), 1e-6);
    EXPECT_GT(engine.size(), 4000u);
  }
}

// dT beside the axis by r turns the vehicle by dT r, which the mean deflection d of all trims: the thrusts'
// sum times L sin d. The one that is weak moves with the others.
TEST(Clusters, AWeakEngineIsTrimmedByTheAngleOfItsMoment) {
  FlightInputs inputs;
  inputs.further[0].nozzle.thrust_factor = 0.95;  // the fifth nozzle, number 4 of the ring: at 135 deg
  const FlightDefinition definition = Definition(Octaweb());
  const auto ticks = TicksOf(definition, inputs);
  const LauncherPlant plant = FlightModel(definition).PlantFor(inputs);
  const double each_n = kThrust_n / 9.0, lost_n = 0.05 * each_n, half = 0.5 * std::sqrt(0.5);
  int seen = 0;
  for (const TickSample& s : ticks) {
    if (s.stack != 0 || !s.burning || s.since_ignition_s < 20.0 || s.since_ignition_s > 35.0) continue;
    const double cg_m =
        plant.stacks[0].mass.At(plant.stacks[0].burn.Propellant(s.since_ignition_s)).cg_station_m;
    const double lever_m = kPivot_m - cg_m;
    // Lost at y = -h, z = +h: the couple of what is left about y is -h dT, about z -h dT.
    double about_y = -half * lost_n, about_z = -half * lost_n;
    const double trim_rad = half * lost_n / ((kThrust_n - lost_n) * lever_m);
    double pitch = 0.0, yaw = 0.0;
    for (int k = 0; k < 9; ++k) {
      const double force_n = k == 4 ? each_n - lost_n : each_n;
      const double a = s.nozzle_rad[static_cast<std::size_t>(DriveOf(k, 0))],
                   b = s.nozzle_rad[static_cast<std::size_t>(DriveOf(k, 1))];
      about_y += lever_m * force_n * std::sin(a) * std::cos(b);
      about_z += lever_m * force_n * std::sin(b);
      pitch += a / 9.0;
      yaw += b / 9.0;
    }
    // The attitude program turns by 0.1 deg/s: accelerations are small. Roll commands add no mean angle.
    EXPECT_NEAR(pitch, trim_rad, 0.03 * trim_rad) << s.since_ignition_s;
    EXPECT_NEAR(yaw, trim_rad, 0.03 * trim_rad) << s.since_ignition_s;
    EXPECT_NEAR(about_y, 0.0, 0.03 * half * lost_n);
    EXPECT_NEAR(about_z, 0.0, 0.03 * half * lost_n);
    ++seen;
  }
  EXPECT_GT(seen, 1000);
}

// Engines of a liquid stage whose flow follows their thrust: the stage's flow is the sum.
TEST(Clusters, FlowOfTheStageIsTheSumOfItsEngines) {
  const FlightDefinition definition = Definition(Octaweb());
  const FlightModel model(definition);
  FlightInputs inputs;
  inputs.stages[0].nozzles[0].flow_factor = 0.97;
  inputs.further[2].nozzle.flow_factor = 1.06;
  const MotorBurn nominal = model.nominal_plant().stacks[0].burn,
                  burn = model.PlantFor(inputs).stacks[0].burn;
  EXPECT_NEAR(burn.full_flow_kg_s, nominal.full_flow_kg_s * (1.0 + (-0.03 + 0.06) / 9.0), 1e-11);
  EXPECT_EQ(burn.vacuum_thrust_n, nominal.vacuum_thrust_n);
}

// Of each stage by its own engines: those beyond four count on through the vehicle.
TEST(Clusters, FlowOfAnUpperStageIsThatOfItsOwnEngines) {
  FlightDefinition definition = Definition(Octaweb());
  definition.vehicle.stages[1].gimbal.nozzles = Octaweb();
  const FlightModel model(definition);
  FlightInputs inputs;
  inputs.further[2].nozzle.flow_factor = 1.06;      // the seventh of the first stage
  inputs.further[5 + 4].nozzle.flow_factor = 0.91;  // the ninth of the second
  const LauncherPlant& nominal = model.nominal_plant();
  const LauncherPlant plant = model.PlantFor(inputs);
  for (const auto& [stage, factor] : {std::pair<std::size_t, double>{0, 1.06}, {1, 0.91}})
    EXPECT_NEAR(plant.stacks[stage].burn.full_flow_kg_s,
                nominal.stacks[stage].burn.full_flow_kg_s * (1.0 + (factor - 1.0) / 9.0), 1e-11);
}

// Moment of roll: all of the ring turned by d along it, T r sin d with the ring's thrust. At the command's
// limit that is what the layout promises.
TEST(Clusters, RollByTheRing) {
  const FlightModel model(Definition(Octaweb()));
  const NozzleLayout& layout = model.nominal_plant().stacks[0].layout;
  Angles angles{};
  const double command = 0.5 * kDeg;
  for (int drive = 0; drive < layout.banks() * kDrives; ++drive)
    angles[static_cast<std::size_t>(drive)] = command * layout.allocation[drive][0];
  const LauncherInstant now = InstantAt(model, {}, angles);
  EXPECT_NEAR(now.loads.moment_n_m.x(), kThrust_n * layout.roll_arm_m * command, 2e-4 * kThrust_n * command);
  EXPECT_NEAR(layout.roll_arm_m, 8.0 / 9.0 * 0.5, 1e-12);
  EXPECT_NEAR(now.loads.moment_n_m.y(), 0.0, 1.0);
  EXPECT_NEAR(now.loads.moment_n_m.z(), 0.0, 1.0);
}

TEST(Clusters, AStuckEngineStandsAndTheOthersTakeItsPart) {
  FlightInputs inputs;
  inputs.stuck_nozzle = 8.0;
  inputs.stuck_nozzle_stage = 1.0;
  inputs.stuck_nozzle_rad = 3.0 * kDeg;
  FlightResult result;
  double others = 0.0;
  for (const TickSample& s : TicksOf(Definition(Octaweb()), inputs, &result)) {
    if (!s.burning || s.stack != 0) continue;
    EXPECT_EQ(s.nozzle_rad[static_cast<std::size_t>(DriveOf(7, 0))], 3.0 * kDeg) << s.time_s;
    EXPECT_EQ(s.nozzle_rad[static_cast<std::size_t>(DriveOf(7, 1))], 0.0);
    others = std::max(others, std::fabs(s.nozzle_rad[static_cast<std::size_t>(DriveOf(8, 0))]));
  }
  EXPECT_EQ(result.outcome, Outcome::kCompleted) << result.reason;
  EXPECT_GT(others, 0.3 * kDeg);
}

// Four fixed engines carry the thrust; four verniers of one per cent each turn the vehicle by up to 30 deg.
TEST(Clusters, VerniersSteerBesideFixedEngines) {
  Nozzle fixed = RingOf(4, 0.3), verniers = RingOf(4, 0.6);
  fixed.towards_rad = {};
  verniers.name = "vernier";
  verniers.thrust_share = 0.01;
  verniers.towards_rad = {90.0 * kDeg};  // along the ring
  verniers.ring.turned = true;
  FlightDefinition definition = Definition({fixed, verniers});
  Gimbal& gimbal = definition.vehicle.stages[0].gimbal;
  gimbal.limit_rad = 30.0 * kDeg;
  gimbal.rate_limit_rad_s = 90.0 * kDeg;
  const NozzleLayout layout = BuildNozzleLayout(gimbal);
  // Of four the two that turn in the plane, at their limit; and all four in roll.
  EXPECT_NEAR(layout.pitch_share, 0.02, 1e-12);
  EXPECT_NEAR(layout.roll_arm_m, 0.04 * 0.6, 1e-12);
  EXPECT_NEAR(layout.share[0], 0.24, 1e-12);
  FlightInputs inputs;
  inputs.stages[0].thrust.misalignment_rad.magnitude = 0.02 * kDeg;
  FlightResult result;
  double turned = 0.0;
  for (const TickSample& s : TicksOf(definition, inputs, &result)) {
    if (!s.burning || s.stack != 0) continue;
    for (int k = 0; k < 4; ++k) ASSERT_EQ(s.nozzle_rad[static_cast<std::size_t>(DriveOf(k, 0))], 0.0);
    for (int k = 4; k < 8; ++k)
      turned = std::max(turned, std::fabs(s.nozzle_rad[static_cast<std::size_t>(DriveOf(k, 0))]));
  }
  EXPECT_EQ(result.outcome, Outcome::kCompleted) << result.reason;
  EXPECT_GT(turned, 0.9 * kDeg);  // 50 times the misalignment
}

}  // namespace dispersa::flight_clusters_test
