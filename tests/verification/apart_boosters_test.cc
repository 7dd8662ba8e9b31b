// Boosters that are bodies of their own: masses, forces and moments by hand, the equation of rotation with
// all of it, sets that are not symmetric, burns that differ, nozzles that turn, and momentum at separation.
#include "tests/apart_boosters.h"
#include "core/flight/flight.h"
#include "core/flight/flight_sums.h"
#include "core/flight/nozzle_allocation.h"
#include "core/flight/ripple.h"
#include "core/margins/linear_axis.h"
#include "core/math/constants.h"
#include "core/trajectory/ascent.h"
#include "core/vehicle/mass.h"
#include "tests/flown_ticks.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::apart_boosters_test {
namespace {

constexpr double kDeg = kRadPerDeg;
constexpr double kThrust_n = 20e3, kBurn_s = 20.0, kDry_kg = 100.0, kPropellant_kg = 500.0, kRadius_m = 0.9,
                 kNozzle_m = 19.2, kCore_n = 200e3, kPivot_m = 19.5;

// The sample vehicle, which flies in almost no air, with boosters at these angles.
FlightDefinition Boosted(const std::vector<double>& angles_deg) {
  FlightDefinition definition = HighDefinition();
  Boosters& b = definition.vehicle.boosters;
  b = {static_cast<int>(angles_deg.size()),
       kDry_kg,
       kPropellant_kg,
       kRadius_m,
       0.5,
       14.0,
       19.0,
       kNozzle_m,
       {},
       {15.0, 18.0, 0.48, 0.2},
       0.5};
  b.motor.thrust_n = kThrust_n;
  b.motor.burning_time_s = kBurn_s;
  for (const double angle_deg : angles_deg) b.angles_rad.push_back(angle_deg * kDeg);
  definition.vehicle.stages[0].liftoff_mass_kg += b.LiftOffMass();
  definition.vehicle.jet_damping = true;
  EXPECT_TRUE(Problems(definition.vehicle).empty());
  return definition;
}
FlightDefinition Gimballed(const std::vector<double>& angles_deg, bool alone = false) {
  FlightDefinition definition = Boosted(angles_deg);
  Boosters& b = definition.vehicle.boosters;
  b.gimbal.limit_rad = 5.0 * kDeg;
  b.gimbal.rate_limit_rad_s = 20.0 * kDeg;
  b.gimbal.bandwidth_rad_s = 30.0;
  b.towards_rad = {90.0 * kDeg, 180.0 * kDeg};
  b.steer_alone = alone;
  EXPECT_TRUE(Problems(definition.vehicle).empty());
  return definition;
}

LauncherPhase Boosting(std::size_t count) {
  LauncherPhase phase;
  phase.burning = true;
  phase.boosters_burning = (1u << count) - 1u;
  return phase;
}

// The bare vehicle and its boosters as tubes at their places, by Huygens and Steiner, at a time of the burn.
Bodies ByHand(const FlightDefinition& definition, const LauncherPlant& plant, double since_s) {
  Vehicle core = definition.vehicle;
  core.stages[0].liftoff_mass_kg -= core.boosters.LiftOffMass();
  core.boosters = {};
  const MassProperties own = BuildStackMasses(core)[0].At(plant.stacks[0].burn.Propellant(since_s));
  std::vector<Part> parts = {{own.mass_kg, own.axial_inertia_kg_m2, own.transverse_inertia_kg_m2,
                              Vector3(own.cg_station_m, 0.0, 0.0)}};
  for (const EachBooster& one : plant.boosters->each) {
    const double kg = one.burn.Propellant(since_s), outer2 = 0.24 * 0.24,
                 inner2 = outer2 - kg / kPropellant_kg * (outer2 - 0.01), shell2 = 0.25 * 0.25;
    parts.push_back(
        {kDry_kg, kDry_kg * shell2, kDry_kg * (0.5 * shell2 + 25.0 / 12.0), Vector3(16.5, one.y_m, one.z_m)});
    parts.push_back({kg, 0.5 * kg * (outer2 + inner2), kg * (0.25 * (outer2 + inner2) + 9.0 / 12.0),
                     Vector3(16.5, one.y_m, one.z_m)});
  }
  return SumOf(parts);
}

TEST(ApartBoosters, MassesAreThoseOfTubesAtTheirPlaces) {
  for (const auto& angles : {std::vector<double>{30.0}, {0.0, 70.0, 200.0}, {10.0, 190.0}}) {
    const FlightDefinition definition = Boosted(angles);
    FlightInputs inputs;
    inputs.further[0].nozzle.flow_factor = inputs.further[0].nozzle.thrust_factor = 1.2;
    const LauncherPlant plant = FlightModel(definition).PlantFor(inputs);
    std::array<double, kLauncherSize> y{};
    RigidBodyState s;
    s.p_EoC_I = {Wgs84().equatorial_radius_m + 2e6, 0.0, 0.0};
    WriteState(s, y.data());
    for (const double since_s : {0.0, 7.0, 15.0}) {
      const Bodies all = ByHand(definition, plant, since_s);
      const LauncherInstant now = LauncherModel(plant).Evaluate(Boosting(angles.size()), since_s, y.data());
      EXPECT_NEAR(now.loads.mass_kg, all.mass_kg, 1e-9 * all.mass_kg);
      EXPECT_NEAR(now.cg_station_m, all.cg.x(), 1e-10 * all.cg.x());
      EXPECT_NEAR((now.loads.inertia_kg_m2 - all.inertia).norm(), 0.0, 1e-9 * all.inertia.norm()) << since_s;
    }
    EXPECT_GT(std::fabs(ByHand(definition, plant, 0.0).inertia(1, 2)), 1.0);
  }
}

// Forces about C by vector algebra; and I dw/dt + w x I w + dI/dt w + what the flows carry off = M, where
// dI/dt is the difference of two tensors.
TEST(ApartBoosters, ForcesAndTheEquationOfRotation) {
  const std::vector<double> angles = {20.0, 130.0, 250.0};
  FlightDefinition definition = Gimballed(angles);
  definition.vehicle.boosters.cant_rad = 8.0 * kDeg;
  FlightInputs inputs;
  inputs.further[1].nozzle.thrust_factor = inputs.further[1].nozzle.flow_factor = 1.1;
  inputs.further[2].nozzle.line.misalignment_rad.y = 0.01;
  const FlightModel model(definition);
  const LauncherPlant plant = model.PlantFor(inputs);
  const LauncherModel equations(plant);
  std::array<double, kLauncherSize> y{}, dydt{};
  RigidBodyState s;
  s.p_EoC_I = {Wgs84().equatorial_radius_m + 2e6, 0.0, 0.0};
  const Vector3 w(0.03, -0.05, 0.04);
  s.w_IB_B = w;
  WriteState(s, y.data());
  const double a[3] = {0.03, -0.02, 0.05}, b[3] = {0.01, 0.04, -0.03};
  for (int k = 0; k < 3; ++k)
    for (const int hinge : {0, 1})
      y[static_cast<std::size_t>(AngleOf(DriveOf(kNozzles + k, hinge)))] = hinge == 0 ? a[k] : b[k];
  const double since_s = 6.0, h_s = 1e-3;
  const LauncherPhase phase = Boosting(3);
  const Bodies all = ByHand(definition, plant, since_s);
  Vector3 force(kCore_n, 0.0, 0.0);
  Vector3 moment = Vector3(all.cg.x() - kPivot_m, -all.cg.y(), -all.cg.z()).cross(force);
  const double core_kg_s = plant.stacks[0].burn.full_flow_kg_s, lever = all.cg.x() - kPivot_m;
  Vector3 carried = core_kg_s * Vector3(0.16 * w.x(), lever * lever * w.y(), lever * lever * w.z());
  for (int k = 0; k < 3; ++k) {
    const double at = angles[static_cast<std::size_t>(k)] * kDeg, factor = k == 1 ? 1.1 : 1.0;
    const Vector3 out(0.0, std::cos(at), std::sin(at));
    // About the axis that turns x towards the vehicle's axis.
    Matrix3 turn = Eigen::AngleAxisd(8.0 * kDeg, Vector3::UnitX().cross(-out)).toRotationMatrix();
    if (k == 2) turn = Eigen::AngleAxisd(0.01, Vector3::UnitZ()) * turn;
    const Vector3 push =
        factor * kThrust_n * turn *
        Vector3(std::cos(a[k]) * std::cos(b[k]), -std::sin(b[k]), std::sin(a[k]) * std::cos(b[k]));
    const Vector3 arm(all.cg.x() - kNozzle_m, kRadius_m * out.y() - all.cg.y(),
                      kRadius_m * out.z() - all.cg.z());
    force += push;
    moment += arm.cross(push);
    carried += factor * kPropellant_kg / kBurn_s * arm.cross(w.cross(arm));
  }
  const LauncherInstant now = equations.Evaluate(phase, since_s, y.data());
  Vector3 felt = now.loads.force_n;
  // Coriolis's force on the flow across the axis.
  felt.y() = force.y();
  felt.z() = force.z();
  EXPECT_NEAR((felt - force).norm(), 0.0, 1e-6);
  const Matrix3 rate =
      (ByHand(definition, plant, since_s + h_s).inertia - ByHand(definition, plant, since_s - h_s).inertia) /
      (2.0 * h_s);
  equations.Derivative(phase, since_s, y.data(), dydt.data());
  const Vector3 expected = all.inertia.inverse() * (moment - w.cross(all.inertia * w) - rate * w - carried);
  const Vector3 is = ReadState(dydt.data()).w_IB_B;
  // The stage's own flow counts as if C, which is 6 mm beside it, were on the axis.
  EXPECT_NEAR((is - expected).norm(), 0.0, 1e-4 * expected.norm());
  EXPECT_GT((all.inertia.inverse() * carried).norm(), 1e-3 * expected.norm()) << "the flows count";
}

// Without a moment, so that nothing hides what little spin the grains' own propellant takes along. About the
// axis and across it; all of the equation of rotation above, for centres on the axis.
TEST(ApartBoosters, GrainsLoseTheSpinOfWhatBurns) {
  const FlightDefinition definition = Boosted({0.0, 120.0, 240.0});
  const LauncherPlant plant = FlightModel(definition).PlantFor({});
  const double since_s = 6.0, h_s = 1e-3;
  const Bodies all = ByHand(definition, plant, since_s);
  const Matrix3 rate =
      (ByHand(definition, plant, since_s + h_s).inertia - ByHand(definition, plant, since_s - h_s).inertia) /
      (2.0 * h_s);
  const double core_kg_s = plant.stacks[0].burn.full_flow_kg_s, lever = all.cg.x() - kPivot_m;
  for (const Vector3& w : {Vector3(0.3, 0.0, 0.0), Vector3(0.0, 0.05, 0.0), Vector3(0.0, 0.0, -0.05)}) {
    std::array<double, kLauncherSize> y{}, dydt{};
    RigidBodyState s;
    s.p_EoC_I = {Wgs84().equatorial_radius_m + 2e6, 0.0, 0.0};
    s.w_IB_B = w;
    WriteState(s, y.data());
    Vector3 carried = core_kg_s * Vector3(0.16 * w.x(), lever * lever * w.y(), lever * lever * w.z());
    for (const double at : {0.0, 120.0 * kDeg, 240.0 * kDeg}) {
      const Vector3 arm(all.cg.x() - kNozzle_m, kRadius_m * std::cos(at), kRadius_m * std::sin(at));
      carried += kPropellant_kg / kBurn_s * arm.cross(w.cross(arm));
    }
    LauncherModel(plant).Derivative(Boosting(3), since_s, y.data(), dydt.data());
    const Vector3 expected = -all.inertia.inverse() * (rate * w + carried);
    EXPECT_NEAR((ReadState(dydt.data()).w_IB_B - expected).norm(), 0.0, 1e-5 * expected.norm())
        << w.transpose();
  }
}

// Factors of all drives and of the stage's, which steers together with them.
TEST(ApartBoosters, DrivesHaveTheBandwidthOfTheirStage) {
  FlightInputs inputs;
  inputs.actuator_bandwidth_factor = 1.1;
  inputs.stages[0].actuator_bandwidth_factor = 0.9;
  inputs.stages[1].actuator_bandwidth_factor = 0.5;
  const LauncherPlant plant = FlightModel(Gimballed({0.0, 180.0})).PlantFor(inputs);
  EXPECT_NEAR(plant.boosters->gimbal.bandwidth_rad_s, 30.0 * 1.1 * 0.9, 1e-12);
  EXPECT_NEAR(plant.stacks[0].gimbal.bandwidth_rad_s, 25.0 * 1.1 * 0.9, 1e-12);
  EXPECT_NEAR(plant.stacks[1].gimbal.bandwidth_rad_s, 25.0 * 1.1 * 0.5, 1e-12);
}

// At a booster's burnout a command about an axis goes to other nozzles: what an axis feels jumps, and no
// nozzle swings.
TEST(ApartBoosters, RippleBeginsAnewAtEachBurnout) {
  FlightDefinition definition = Gimballed({0.0, 180.0}, true);
  FlightInputs inputs;
  inputs.stages[0].thrust.misalignment_rad.y = 0.5 * kDeg;
  const FlightModel model(definition);
  FlightResult result;
  const auto ticks = TicksOf(definition, inputs, &result);
  ASSERT_EQ(result.outcome, Outcome::kCompleted) << result.reason;
  RippleMeter anew(definition.autopilot.tick_s), through(definition.autopilot.tick_s);
  unsigned burning = ticks.front().boosters_burning;
  int burnouts = 0;
  for (const TickSample& s : ticks) {
    if (s.boosters_burning != burning) {
      anew.Interrupt();
      burning = s.boosters_burning;
      ++burnouts;
    }
    if (!s.burning || s.since_ignition_s < lanes::kSettled_s ||
        (s.time_s >= definition.kick_start_s && s.time_s <= definition.kick_end_s)) {
      anew.Interrupt();
      through.Interrupt();
      continue;
    }
    const NozzleLayout& layout = model.nominal_plant().LayoutOf(s.stack, s.boosting);
    double felt[3] = {};
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t i = 0; i < static_cast<std::size_t>(layout.banks()) * kDrives; ++i)
        felt[axis] += layout.felt[axis][i] * s.nozzle_rad[i];
    anew.Add(felt[kRoll], felt[kPitch], felt[kYaw]);
    through.Add(felt[kRoll], felt[kPitch], felt[kYaw]);
  }
  EXPECT_GE(burnouts, 1);
  EXPECT_GT(through.worst_rad(), 1.05 * anew.worst_rad());
  EXPECT_NEAR(MetricOf(result, "deflection_ripple_deg"), anew.worst_rad() * kDegPerRad,
              1e-9 + 1e-3 * (through.worst_rad() - anew.worst_rad()) * kDegPerRad);
}

// The flight computer gives a command to the drives of its own time: what is on its way when boosters burn
// out still turns theirs, in every bank.
TEST(ApartBoosters, DelayedCommandsAreOfTheDrivesThatGotThem) {
  FlightDefinition definition = Gimballed({0.0, 180.0}, true);
  const int delay = definition.vehicle.stages[0].gimbal.delay_ticks = 3;
  FlightInputs inputs;
  inputs.stages[0].thrust.misalignment_rad.y = 0.5 * kDeg;
  for (const double part : {0.0, 0.5}) {  // a command within the tick: that of the tick before stands at it
    inputs.loop_delay_s = part * definition.autopilot.tick_s;
    const FlightModel model(definition);
    FlightResult result;
    const auto ticks = TicksOf(definition, inputs, &result);
    ASSERT_EQ(result.outcome, Outcome::kCompleted) << result.reason;
    const std::size_t late = static_cast<std::size_t>(delay) + (part > 0.0 ? 1 : 0);
    int on_the_way = 0;
    for (std::size_t now = late; now < ticks.size() && ticks[now].stack == 0 && ticks[now].burning; ++now) {
      const TickSample& given = ticks[now - late];
      const NozzleLayout& layout = model.nominal_plant().LayoutOf(0, given.boosting);
      for (const int bank : {0, 1}) {
        const lanes::BankAllocation<double> allocation = lanes::AllocationOf(layout, bank);
        double command_rad[kDrives];
        lanes::Allocate(allocation, given.gimbal.roll_rad, given.gimbal.pitch_rad, given.gimbal.yaw_rad,
                        command_rad);
        for (std::size_t i = 0; i < kDrives; ++i)
          ASSERT_NEAR(ticks[now].command_rad[static_cast<std::size_t>(bank) * kDrives + i], command_rad[i],
                      1e-15)
              << ticks[now].time_s << " bank " << bank << " drive " << i;
      }
      if (given.boosting && !ticks[now].boosting) ++on_the_way;
    }
    EXPECT_EQ(on_the_way, static_cast<int>(late));
  }
}

// A burn rate of f: thrust and flow times f, time over f, the same impulse. Which one burns a history says;
// they leave together, after the last.
TEST(ApartBoosters, BurnRatesMoveThrustAndBurnoutAtConstantImpulse) {
  const FlightDefinition definition = Boosted({0.0, 180.0});
  FlightInputs inputs;
  inputs.further[0].nozzle.thrust_factor = inputs.further[0].nozzle.flow_factor = 1.05;
  const LauncherPlant plant = FlightModel(definition).PlantFor(inputs);
  const MotorBurn &fast = plant.boosters->each[0].burn, &slow = plant.boosters->each[1].burn;
  EXPECT_NEAR(fast.vacuum_thrust_n, 1.05 * kThrust_n, 1e-9);
  EXPECT_NEAR(fast.duration_s, kBurn_s / 1.05, 1e-12);
  EXPECT_NEAR(fast.vacuum_thrust_n * fast.duration_s, slow.vacuum_thrust_n * slow.duration_s, 1e-6);
  FlightResult result;
  const auto ticks = TicksOf(definition, inputs, &result);
  ASSERT_EQ(result.outcome, Outcome::kCompleted) << result.reason;
  int trimmed = 0;
  double alone_moment = 0.0;
  for (const TickSample& s : ticks) {
    if (s.stack != 0 || !s.burning) continue;
    const unsigned expected = (s.time_s < kBurn_s / 1.05 ? 1u : 0u) | (s.time_s < kBurn_s ? 2u : 0u);
    if (std::fabs(s.time_s - kBurn_s) > 0.005) {
      EXPECT_EQ(s.boosters_burning, expected) << s.time_s;
    }
    EXPECT_EQ((s.jettisoned & kBoostersGone) != 0, s.time_s > kBurn_s + 0.495) << s.time_s;
    const Bodies all = ByHand(definition, plant, s.since_ignition_s);
    if (s.time_s > 10.0 && s.time_s < 18.0) {
      // Trimmed: of the cross's nozzles bottom and top turn in yaw, half of the thrust.
      const double boost = kRadius_m * 0.05 * kThrust_n - all.cg.y() * (2.05 * kThrust_n);
      const double lever_m = kPivot_m - all.cg.x();
      double core = -all.cg.y() * kCore_n;
      for (const std::size_t k : {2u, 3u}) core -= lever_m * 0.25 * kCore_n * std::sin(s.nozzle_rad[k]);
      EXPECT_NEAR(boost + core, 0.0, 0.04 * std::fabs(boost)) << s.time_s;
      ++trimmed;
    }
    if (s.time_s > kBurn_s / 1.05 + 0.1 && s.time_s < kBurn_s - 0.1)
      alone_moment = std::max(alone_moment, std::fabs(s.error.angle_rad.z()));
  }
  EXPECT_GT(trimmed, 500);
  EXPECT_GT(alone_moment, 0.01 * kDeg) << "the moment of the one that burns on shows";
}

// One booster alone: its thrust beside the axis, and a centre of gravity that it pulls over, are trimmed.
TEST(ApartBoosters, AnOddOneIsTrimmed) {
  const FlightDefinition definition = Boosted({90.0});
  FlightResult result;
  const auto ticks = TicksOf(definition, {}, &result);
  ASSERT_EQ(result.outcome, Outcome::kCompleted) << result.reason;
  const LauncherPlant plant = FlightModel(definition).PlantFor({});
  int seen = 0;
  for (const TickSample& s : ticks) {
    if (s.stack != 0 || s.time_s < 8.0 || s.time_s > 18.0) continue;
    const Bodies all = ByHand(definition, plant, s.since_ignition_s);
    const double lever_m = kPivot_m - all.cg.x();
    // About y: z F.
    double moment = (kRadius_m - all.cg.z()) * kThrust_n - all.cg.z() * kCore_n;
    const double boost = moment;
    for (const std::size_t k : {0u, 1u}) moment += lever_m * 0.25 * kCore_n * std::sin(s.nozzle_rad[k]);
    EXPECT_NEAR(moment, 0.0, 0.04 * boost);
    EXPECT_GT(std::fabs(s.nozzle_rad[0]), 0.5 * kDeg);
    ++seen;
  }
  EXPECT_GT(seen, 500);
}

// What the autopilot takes for the effectiveness is the derivative of the equations of motion: with all
// drives, and where the stage's own nozzles stay centred. After the burnout it is the stage's.
TEST(ApartBoosters, EffectivenessIsTheDerivativeOfTheMotion) {
  for (const bool alone : {false, true}) {
    const FlightModel model(Gimballed({0.0, 90.0, 180.0, 270.0}, alone));
    FlightResult result;
    const auto ticks = TicksOf(model.definition(), {}, &result);
    ASSERT_EQ(result.outcome, Outcome::kCompleted) << result.reason;
    int seen = 0;
    for (const TickSample& s : ticks) {
      if (s.stack != 0 || !s.burning || std::fabs(std::remainder(s.time_s - 5.0, 10.0)) > 0.001) continue;
      const StageControl& control = model.autopilot().stages[0];
      for (const Axis axis : {kRoll, kPitch, kYaw}) {
        const AxisPlant linear = LineariseAxis(model.nominal_plant(), s, axis, model.sensors());
        const double table = (axis == kRoll ? control.roll_effectiveness_1_s2
                                            : control.pitch_effectiveness_1_s2)(s.since_ignition_s);
        EXPECT_NEAR(linear.a(1, 2), table, 5e-3 * table) << alone << " " << axis << " " << s.time_s;
        // The slower drives stand for all: 25 rad/s of the stage, 30 of the boosters.
        EXPECT_NEAR(-linear.a(3, 2), alone && s.boosting ? 900.0 : 625.0, 1e-9);
      }
      ++seen;
    }
    EXPECT_GE(seen, 4);
    bool core_turns = false, boosters_turn = false;
    for (const TickSample& s : ticks) {
      if (s.stack != 0 || !s.boosting) continue;
      core_turns |= s.nozzle_rad[0] != 0.0;
      boosters_turn |= s.nozzle_rad[kDrives] != 0.0;
    }
    EXPECT_EQ(core_turns, !alone);
    EXPECT_TRUE(boosters_turn);
  }
}

// In the boosters' tail-off too: the stage's own thrust stays, however little theirs is. Where they alone
// turn the vehicle, the autopilot counts a fifth of their greatest thrust at least, or it would divide by
// nothing.
TEST(ApartBoosters, EffectivenessFollowsTheirTailOffToItsEnd) {
  for (const bool alone : {false, true}) {
    FlightDefinition definition = Gimballed({0.0, 90.0, 180.0, 270.0}, alone);
    Motor& motor = definition.vehicle.boosters.motor;
    motor.thrust_curve = {{0.0, 8.0, 14.0, 19.0}, {kThrust_n, kThrust_n, 0.03 * kThrust_n, 0.03 * kThrust_n}};
    motor.thrust_n = motor.thrust_curve.Greatest();
    motor.burning_time_s = motor.thrust_curve.Impulse() / motor.thrust_n;
    ASSERT_TRUE(Problems(definition.vehicle).empty());
    const FlightModel model(definition);
    FlightResult result;
    const auto ticks = TicksOf(model.definition(), {}, &result);
    ASSERT_EQ(result.outcome, Outcome::kCompleted) << result.reason;
    int seen = 0;
    for (const TickSample& s : ticks) {
      if (s.stack != 0 || !s.boosting || s.time_s < 15.0 || s.time_s > 18.5) continue;
      const AxisPlant linear = LineariseAxis(model.nominal_plant(), s, kYaw, model.sensors());
      const double table = model.autopilot().stages[0].pitch_effectiveness_1_s2(s.since_ignition_s);
      if (alone)
        EXPECT_NEAR(linear.a(1, 2), 0.03 / kLeastThrustFraction * table, 1e-2 * linear.a(1, 2)) << s.time_s;
      else
        EXPECT_NEAR(linear.a(1, 2), table, 5e-3 * table) << s.time_s;
      ++seen;
    }
    EXPECT_GT(seen, 300);
  }
}

// The judges integrate the same equations by other means.
TEST(ApartBoosters, JudgesFlyTheSameFlight) {
  FlightDefinition definition = Gimballed({15.0, 195.0});
  definition.vehicle.boosters.cant_rad = 6.0 * kDeg;
  FlightInputs inputs;
  inputs.further[1].nozzle.thrust_factor = inputs.further[1].nozzle.flow_factor = 1.03;
  inputs.further[0].nozzle.line.misalignment_rad.z = 0.004;
  const auto engine = TicksOf(definition, inputs),
             judge = TicksOf(definition, inputs, nullptr, {.scheme = Scheme::kRungeKutta4});
  ASSERT_EQ(engine.size(), judge.size());
  double apart = 0.0;
  for (std::size_t i = 0; i < engine.size() && engine[i].time_s < 40.0; ++i)
    apart = std::max(apart, (engine[i].state.w_IB_B - judge[i].state.w_IB_B).norm());
  EXPECT_LT(apart, 2e-6);
  EXPECT_GT(engine.size(), 4000u);
}

// At rest against the body: mass, momentum and centre of all parts are kept, of a set beside the axis too.
TEST(ApartBoosters, SeparationKeepsMomentum) {
  const FlightDefinition definition = Boosted({30.0, 100.0});
  const LauncherPlant plant = FlightModel(definition).PlantFor({});
  const double since_s = 21.0;
  std::vector<Bodies> leaving;
  for (const EachBooster& one : plant.boosters->each)
    leaving.push_back({kDry_kg, Vector3(16.5, one.y_m, one.z_m), Matrix3::Zero()});
  EXPECT_GT(ExpectSeparationKeepsMomentum(plant, since_s, ByHand(definition, plant, since_s), leaving), 1e-2);
}

// The optimiser's point mass takes the thrust along the axis.
TEST(ApartBoosters, CantedFlyInThreeAndSixDegreesOfFreedom) {
  FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS);
  definition.vehicle = LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml");
  Boosters& b = definition.vehicle.boosters;
  b = {2, 150.0, 900.0, 0.97, 0.62, 21.0, 26.5, 26.4, {}, {22.0, 24.05, 0.6, 0.2}, 0.5};
  b.motor.thrust_n = 80e3;
  b.motor.burning_time_s = 30.0;
  b.angles_rad = {90.0 * kDeg, 270.0 * kDeg};
  b.cant_rad = 12.0 * kDeg;
  definition.vehicle.stages[0].liftoff_mass_kg += b.LiftOffMass();
  AscentOptions options;
  options.record = true;
  const FlightProgram program = LoadReference(DISPERSA_CAMPAIGNS "/references/slv4_500km.yaml").program;
  const AscentResult ascent = FlyAscent(BuildAscentModel(definition.vehicle, 0.01), program, options);
  ASSERT_TRUE(ascent.completed);
  definition.program = ascent.attitude;
  definition.last_ignition_s = ascent.last_ignition_s;
  double thrust_n = 0.0;
  FlightOptions watching;
  watching.observe = [&](const TickSample& s) {
    if (s.time_s == 0.0) thrust_n = s.instant.loads.force_n.x();
  };
  const FlightResult flown = Fly(FlightModel(definition), {}, watching);
  ASSERT_EQ(flown.outcome, Outcome::kCompleted) << flown.reason;
  EXPECT_NEAR(thrust_n, 593e3 + 2.0 * 80e3 * std::cos(12.0 * kDeg), 1.0);
  EXPECT_NEAR(MetricOf(flown, "injection_velocity_m_s"), ascent.orbit.velocity_m_s, 2.0);
  EXPECT_NEAR(MetricOf(flown, "injection_altitude_km"), 1e-3 * ascent.orbit.altitude_m, 2.0);
}

}  // namespace
}  // namespace dispersa::apart_boosters_test
