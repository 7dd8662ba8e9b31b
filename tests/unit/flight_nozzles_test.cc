// Flights with a list of nozzles: forces by hand, a list equal to the cross, roll by the reaction control
// under thrust, stuck and misaligned nozzles.
#include "core/flight/flight.h"
#include "core/flight/metrics.h"
#include "core/margins/flight_margins.h"
#include "core/math/constants.h"
#include "tests/flown_ticks.h"
#include "tests/test.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::flight_nozzles_test {
namespace {

constexpr double kDeg = kRadPerDeg;
constexpr double kSpace_m = 2e6;  // above the atmosphere's end

std::vector<Nozzle> OneNozzle() { return {{"main", 0.0, 0.0, 1.0, {90.0 * kDeg, 180.0 * kDeg}, 0.0}}; }
std::vector<Nozzle> CrossAsList(double radius_m) {
  return {{"right", radius_m, 0.0, 0.25, {90.0 * kDeg}, 0.0},
          {"left", -radius_m, 0.0, 0.25, {90.0 * kDeg}, 0.0},
          {"bottom", 0.0, radius_m, 0.25, {180.0 * kDeg}, 0.0},
          {"top", 0.0, -radius_m, 0.25, {180.0 * kDeg}, 0.0}};
}
// `count` on a circle, each turning about the vehicle's axis.
std::vector<Nozzle> Ring(int count, double radius_m) {
  std::vector<Nozzle> nozzles;
  for (int k = 0; k < count; ++k) {
    const double at = kTwoPi * k / count;
    nozzles.push_back({std::to_string(k),
                       radius_m * std::cos(at),
                       radius_m * std::sin(at),
                       1.0 / count,
                       {at + 90.0 * kDeg},
                       0.0});
  }
  return nozzles;
}
std::vector<Nozzle> Three(double radius_m) { return Ring(3, radius_m); }

FlightDefinition Definition(const std::vector<Nozzle>& nozzles) {
  FlightDefinition definition = HighDefinition();
  definition.vehicle.stages[0].gimbal.nozzles = nozzles;
  return definition;
}

// At rest above the air, burning for 10 s, the drives at these angles.
LauncherInstant InstantAt(const FlightModel& model, const FlightInputs& inputs,
                          const std::vector<double>& angles) {
  RigidBodyState state;
  state.p_EoC_I = {Wgs84().equatorial_radius_m + kSpace_m, 0.0, 0.0};
  std::array<double, kLauncherSize> y{};
  WriteState(state, y.data());
  for (std::size_t drive = 0; drive < angles.size(); ++drive)
    y[static_cast<std::size_t>(AngleOf(static_cast<int>(drive)))] = angles[drive];
  LauncherPhase phase;
  phase.burning = true;
  return LauncherModel(model.PlantFor(inputs)).Evaluate(phase, 10.0, y.data());
}

// 200 kN through one nozzle at the pivots of station 19.5, turned by a in pitch and b in yaw: the thrust is
// (cos a cos b, -sin b, sin a cos b), and its moment the lever's cross product with it.
TEST(ListedNozzles, OneNozzleTurnsItsWholeThrustInTwoPlanes) {
  const FlightModel model(Definition(OneNozzle()));
  const double a = 3.0 * kDeg, b = -2.0 * kDeg;
  const LauncherInstant now = InstantAt(model, {}, {a, 0, 0, 0, b, 0, 0, 0});
  const Vector3 force = 200e3 * Vector3(std::cos(a) * std::cos(b), -std::sin(b), std::sin(a) * std::cos(b));
  const double lever = 19.5 - now.cg_station_m;
  EXPECT_NEAR((now.loads.force_n - force).norm(), 0.0, 1e-8);
  EXPECT_NEAR(now.loads.moment_n_m.x(), 0.0, 1e-9);
  EXPECT_NEAR(now.loads.moment_n_m.y(), lever * 200e3 * std::sin(a) * std::cos(b), 1e-7);
  EXPECT_NEAR(now.loads.moment_n_m.z(), lever * 200e3 * std::sin(b), 1e-7);
  EXPECT_GT(now.loads.moment_n_m.y(), 1e4);
}

// Each nozzle beside the axis turns the vehicle about all three axes.
TEST(ListedNozzles, ThreeNozzlesAddTheirMoments) {
  const FlightModel model(Definition(Three(0.4)));
  const std::vector<double> angles = {2.0 * kDeg, -1.0 * kDeg, 0.5 * kDeg};
  FlightInputs inputs;
  inputs.stages[0].nozzles[1].line.misalignment_rad.magnitude = 0.01;
  inputs.stages[0].nozzles[1].line.misalignment_rad.clock_rad = 0.7;
  inputs.stages[0].nozzles[2].line.offset_m.magnitude = 0.02;
  inputs.stages[0].nozzles[2].line.offset_m.clock_rad = 2.5;
  inputs.stages[0].nozzles[0].thrust_factor = 1.03;
  const LauncherInstant now = InstantAt(model, inputs, angles);
  Vector3 force = Vector3::Zero(), moment = Vector3::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    const double at = 120.0 * kDeg * static_cast<double>(k), d = angles[k];
    Vector3 each =
        200e3 / 3.0 * Vector3(std::cos(d), -std::sin(d) * std::sin(at), std::sin(d) * std::cos(at));
    if (k == 0) each *= 1.03;
    if (k == 1)  // by 0.01 towards clock 0.7
      each = Eigen::AngleAxisd(0.01, Vector3(0.0, -std::sin(0.7), std::cos(0.7))) * each;
    Vector3 place(now.cg_station_m - 19.5, 0.4 * std::cos(at), 0.4 * std::sin(at));
    if (k == 2) place += Vector3(0.0, 0.02 * std::cos(2.5), 0.02 * std::sin(2.5));
    force += each;
    moment += place.cross(each);
  }
  EXPECT_NEAR((now.loads.force_n - force).norm(), 0.0, 1e-7);
  EXPECT_NEAR((now.loads.moment_n_m - moment).norm(), 0.0, 1e-6);
  EXPECT_GT(std::fabs(moment.x()), 100.0);
}

TEST(ListedNozzles, MassesOfNozzlesReactAsTheCrossDoes) {
  const auto angular = [](const std::vector<Nozzle>& nozzles) {
    FlightDefinition definition = Definition(nozzles);
    Gimbal& gimbal = definition.vehicle.stages[0].gimbal;
    gimbal.nozzle_mass_kg = 200.0;
    gimbal.nozzle_cg_m = 0.4;
    gimbal.nozzle_inertia_kg_m2 = 50.0;
    const FlightModel model(definition);
    std::array<double, kLauncherSize> y{}, dydt{};
    RigidBodyState state;
    state.p_EoC_I = {Wgs84().equatorial_radius_m + kSpace_m, 0.0, 0.0};
    WriteState(state, y.data());
    LauncherPhase phase;
    phase.burning = true;
    phase.command_rad = {0.03, 0.01, -0.02, 0.015};
    LauncherModel(model.PlantFor({})).Derivative(phase, 10.0, y.data(), dydt.data());
    return ReadState(dydt.data()).w_IB_B;
  };
  const Vector3 cross = angular({}), list = angular(CrossAsList(0.4));
  EXPECT_NEAR((cross - list).norm(), 0.0, 1e-12 * cross.norm());
  EXPECT_GT(cross.norm(), 1e-3);
}

FlightInputs Disturbed() {
  FlightInputs inputs;
  for (StageInputs& stage : inputs.stages) stage.thrust.misalignment_rad.magnitude = 0.2 * kDeg;
  for (StageInputs& stage : inputs.stages) stage.thrust.misalignment_rad.clock_rad = 0.6;
  inputs.stages[0].nozzles[0].line.misalignment_rad.magnitude = 0.3 * kDeg;
  inputs.stages[0].nozzles[0].line.misalignment_rad.clock_rad = 1.4;
  inputs.stages[0].cg_offset_m.magnitude = 0.01;
  return inputs;
}

// The list goes another way through the arithmetic and arrives at the same flight.
TEST(ListedNozzles, ACrossAsAListFliesAsTheCross) {
  FlightResult cross, list;
  const auto ticks = TicksOf(HighDefinition(), Disturbed(), &cross);
  const auto again = TicksOf(Definition(CrossAsList(0.4)), Disturbed(), &list);
  ASSERT_EQ(cross.outcome, Outcome::kCompleted);
  ASSERT_EQ(list.outcome, Outcome::kCompleted);
  ASSERT_EQ(ticks.size(), again.size());
  double apart = 0.0, turned = 0.0;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    apart = std::max(apart, (ticks[i].state.w_IB_B - again[i].state.w_IB_B).norm());
    for (std::size_t k = 0; k < kNozzles; ++k) turned = std::max(turned, std::fabs(ticks[i].nozzle_rad[k]));
  }
  EXPECT_LT(apart, 1e-10);
  EXPECT_GT(turned, 0.1 * kDeg);
  for (std::size_t i = 0; i < cross.metrics.size(); ++i) {
    if (std::isnan(cross.metrics[i])) continue;
    EXPECT_NEAR(list.metrics[i], cross.metrics[i], 1e-6 * std::max(1.0, std::fabs(cross.metrics[i])))
        << MetricNames()[i];
  }
}

// The judges integrate the same equations by other means.
TEST(ListedNozzles, JudgesFlyTheSameFlight) {
  for (const auto& nozzles : {OneNozzle(), Three(0.4)}) {
    const auto engine = TicksOf(Definition(nozzles), Disturbed());
    const auto judge = TicksOf(Definition(nozzles), Disturbed(), nullptr, {.scheme = Scheme::kRungeKutta4});
    ASSERT_EQ(engine.size(), judge.size());
    double apart = 0.0;
    for (std::size_t i = 0; i < engine.size() && engine[i].time_s < 40.0; ++i)
      apart = std::max(apart, (engine[i].state.w_IB_B - judge[i].state.w_IB_B).norm());
    EXPECT_LT(apart, 1e-6);
    EXPECT_GT(engine.size(), 4000u);
  }
}

// A nozzle in two planes between two that are fixed, a metre beside the axis.
std::vector<Nozzle> OneBetweenFixed() {
  return {{"main", 0.0, 0.0, 0.5, {90.0 * kDeg, 180.0 * kDeg}, 0.0},
          {"right", 1.0, 0.0, 0.25, {}, 0.0},
          {"left", -1.0, 0.0, 0.25, {}, 0.0}};
}
// The right one's 50 kN 8e-5 rad towards z: 4 N m of roll, half of what the couple of two thrusters of 10 N,
// 0.4 m from the axis, can do. (One nozzle on the axis that trims pitch and yaw turns no vehicle in roll: its
// thrust passes the CG.)
FlightInputs Rolled() {
  FlightInputs inputs;
  inputs.stages[0].nozzles[1].line.misalignment_rad.magnitude = 8e-5;
  inputs.stages[0].nozzles[1].line.misalignment_rad.clock_rad = 0.5 * kPi;
  return inputs;
}

TEST(ListedNozzles, TheReactionControlHoldsTheRollThatOneNozzleCannot) {
  FlightDefinition definition = Definition(OneBetweenFixed());
  const FlightInputs inputs = Rolled();
  FlightResult held;
  const auto ticks = TicksOf(definition, inputs, &held);
  ASSERT_EQ(held.outcome, Outcome::kCompleted) << held.reason;
  double roll = 0.0, roll_commanded = 0.0, worst_pitch = 0.0;
  int fired = 0;
  for (const TickSample& s : ticks) {
    if (!s.burning || s.stack != 0) continue;
    roll = std::max(roll, std::fabs(s.error.angle_rad.x()));
    worst_pitch = std::max(worst_pitch, std::fabs(s.error.angle_rad.y()));
    for (std::size_t drive : {1u, 2u, 3u, 5u, 6u, 7u})
      roll_commanded = std::max(roll_commanded, std::fabs(s.nozzle_rad[drive]));
    EXPECT_EQ(s.thrusters[kPitch], 0);
    EXPECT_EQ(s.thrusters[kYaw], 0);
    fired += s.thrusters[kRoll] != 0;
  }
  EXPECT_GT(fired, 10);
  EXPECT_EQ(roll_commanded, 0.0);
  EXPECT_LT(worst_pitch, 1.0 * kDeg);
  // The deadband is 0.1 deg; a couple against a steady moment hardly overshoots it.
  EXPECT_GT(roll, 0.09 * kDeg);
  EXPECT_LT(roll, 0.3 * kDeg);
  EXPECT_GT(ticks.back().expelled_mass_kg, 0.0);

  // Without its couple the vehicle rolls away.
  definition.vehicle.reaction_control.roll_arm_m = 1e-6;
  double free = 0.0;
  for (const TickSample& s : TicksOf(definition, inputs))
    if (s.burning && s.stack == 0) free = std::max(free, std::fabs(s.error.angle_rad.x()));
  EXPECT_GT(free, 10.0 * roll);
}

// 2 F arm / Ixx from one tick to the next while a couple fires, beside the steady moment.
TEST(ListedNozzles, ACoupleTurnsTheBurningVehicleByItsMoment) {
  const FlightDefinition definition = Definition(OneBetweenFixed());
  const auto ticks = TicksOf(definition, Rolled());
  const LauncherPlant plant = FlightModel(definition).PlantFor({});
  int compared = 0;
  for (std::size_t i = 2; i + 1 < ticks.size() && ticks[i + 1].burning; ++i) {
    const int before = ticks[i - 1].thrusters[kRoll], now = ticks[i].thrusters[kRoll];
    if (before == now || ticks[i].since_ignition_s < 1.0) continue;
    const double rate = definition.autopilot.tick_s;
    const auto acceleration = [&](std::size_t at) {
      return (ticks[at + 1].state.w_IB_B.x() - ticks[at].state.w_IB_B.x()) / rate;
    };
    const double inertia = plant.stacks[0]
                               .mass.At(plant.stacks[0].burn.Propellant(ticks[i].since_ignition_s))
                               .axial_inertia_kg_m2;
    EXPECT_NEAR(acceleration(i) - acceleration(i - 1), (now - before) * 2.0 * 10.0 * 0.4 / inertia, 3e-5);
    EXPECT_GT(8.0 / inertia, 1e-3);
    ++compared;
  }
  EXPECT_GT(compared, 3);
}

// Of four that each turn in one plane three suffice for three axes.
TEST(ListedNozzles, AStuckNozzleOfFourStandsAndTheOthersTakeItsPart) {
  FlightInputs inputs;
  inputs.stuck_nozzle = 2.0;
  inputs.stuck_nozzle_stage = 1.0;
  inputs.stuck_nozzle_rad = 0.3 * kDeg;
  double others = 0.0;
  FlightResult result;
  for (const TickSample& s : TicksOf(Definition(Ring(4, 0.4)), inputs, &result)) {
    if (!s.burning || s.stack != 0) continue;
    EXPECT_EQ(s.nozzle_rad[1], 0.3 * kDeg) << s.time_s;
    others = std::max({others, std::fabs(s.nozzle_rad[0]), std::fabs(s.nozzle_rad[2])});
  }
  EXPECT_EQ(result.outcome, Outcome::kCompleted);
  EXPECT_GT(others, 0.05 * kDeg);
}

// A nozzle stuck about both hinges of its Cardan joint: none of its drives moves.
TEST(ListedNozzles, AStuckNozzleOfTwoPlanesStandsInBoth) {
  std::vector<Nozzle> two = {{"right", 0.5, 0.0, 0.5, {90.0 * kDeg, 180.0 * kDeg}, 0.0},
                             {"left", -0.5, 0.0, 0.5, {90.0 * kDeg, 180.0 * kDeg}, 0.0}};
  FlightInputs inputs = Disturbed();
  inputs.stuck_nozzle = 1.0;
  inputs.stuck_nozzle_stage = 1.0;
  inputs.stuck_nozzle_rad = 0.2 * kDeg;
  bool moves = false;
  for (const TickSample& s : TicksOf(Definition(two), inputs)) {
    if (!s.burning || s.stack != 0) continue;
    EXPECT_EQ(s.nozzle_rad[0], 0.2 * kDeg);
    EXPECT_EQ(s.nozzle_rad[4], 0.0);
    moves |= std::fabs(s.nozzle_rad[1]) > 0.05 * kDeg && std::fabs(s.nozzle_rad[5]) > 0.05 * kDeg;
  }
  EXPECT_TRUE(moves);
}

// The cone of a nozzle in two planes: commanded beyond it in both, its deflection is the limit and keeps the
// direction.
TEST(ListedNozzles, TheLimitIsOfTheWholeDeflection) {
  FlightDefinition definition = Definition(OneNozzle());
  definition.vehicle.stages[0].gimbal.nozzles[0].limit_rad = 1.0 * kDeg;
  FlightInputs inputs;
  inputs.stages[0].thrust.misalignment_rad.magnitude = 2.0 * kDeg;  // more than the nozzle can trim
  inputs.stages[0].thrust.misalignment_rad.clock_rad = 0.25 * kPi;
  double widest = 0.0, first = 0.0, second = 0.0;
  FlightResult result;
  for (const TickSample& s : TicksOf(definition, inputs, &result)) {
    if (!s.burning || s.stack != 0) continue;
    widest = std::max(widest, std::hypot(s.command_rad[0], s.command_rad[4]));
    first = std::max(first, std::fabs(s.command_rad[0]));
    second = std::max(second, std::fabs(s.command_rad[4]));
  }
  EXPECT_EQ(result.outcome, Outcome::kLostControl);
  EXPECT_NEAR(widest, 1.0 * kDeg, 1e-12);
  EXPECT_GT(first, 0.5 * kDeg);
  EXPECT_GT(second, 0.5 * kDeg);
  EXPECT_GT(result.metrics[MetricColumn("deflection_saturated_fraction")], 0.1);
}

// The law divides by what the layout gives, so margins do not depend on it; roll that thrusters hold has
// none.
TEST(ListedNozzles, MarginsAreOfTheLayout) {
  const auto margins = [](const FlightDefinition& definition) {
    return ComputeMargins(FlightModel(definition), 1000.0);
  };
  const auto cross = margins(HighDefinition()), one = margins(Definition(OneNozzle())),
             ring = margins(Definition(Three(0.4)));
  std::size_t seen = 0;
  for (const ComputedMargins& m : cross) {
    if (m.stage != 0) continue;
    const auto same = [&](const ComputedMargins& other) {
      return other.place == m.place && other.axis == m.axis && other.time_s == m.time_s;
    };
    const auto of_ring = std::find_if(ring.begin(), ring.end(), same);
    ASSERT_NE(of_ring, ring.end());
    EXPECT_NEAR(of_ring->frozen.gain_up_db, m.frozen.gain_up_db, 0.05);
    EXPECT_NEAR(of_ring->frozen.phase_deg, m.frozen.phase_deg, 0.5);
    const auto of_one = std::find_if(one.begin(), one.end(), same);
    EXPECT_EQ(of_one == one.end(), m.axis == kRoll);
    if (of_one != one.end()) {
      EXPECT_NEAR(of_one->frozen.gain_up_db, m.frozen.gain_up_db, 0.05);
    }
    ++seen;
  }
  EXPECT_GE(seen, 6u);
}

}  // namespace
}  // namespace dispersa::flight_nozzles_test
