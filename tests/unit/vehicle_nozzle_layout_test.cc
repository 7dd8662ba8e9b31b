// Lists of nozzles: the effect of commands, against geometry by hand and closed forms of the pseudo-inverse.
#include "core/vehicle/nozzle_layout.h"

#include "core/math/constants.h"
#include "core/math/linear.h"
#include "core/vehicle/vehicle.h"
#include "tests/test.h"

namespace dispersa::vehicle_nozzle_layout_test {
namespace {

constexpr double kDeg = kRadPerDeg;

Gimbal With(std::vector<Nozzle> nozzles) {
  Gimbal gimbal;
  gimbal.pivot_station_m = 20.0;
  gimbal.limit_rad = 6.0 * kDeg;
  gimbal.nozzles = std::move(nozzles);
  return gimbal;
}

// `count` nozzles on a circle, the first at `from` (from body y towards z), each turning about the axis of
// the vehicle.
Gimbal Ring(int count, double from_rad, double radius_m) {
  std::vector<Nozzle> nozzles;
  for (int k = 0; k < count; ++k) {
    const double at = from_rad + kTwoPi * k / count;
    nozzles.push_back({"n" + std::to_string(k),
                       radius_m * std::cos(at),
                       radius_m * std::sin(at),
                       1.0 / count,
                       {at + 0.5 * kPi},
                       0.0});
  }
  return With(nozzles);
}

Gimbal One() { return With({{"main", 0.0, 0.0, 1.0, {90.0 * kDeg, 180.0 * kDeg}, 0.0}}); }
Gimbal Two() {
  return With({{"right", 0.8, 0.0, 0.5, {90.0 * kDeg, 180.0 * kDeg}, 0.0},
               {"left", -0.8, 0.0, 0.5, {90.0 * kDeg, 180.0 * kDeg}, 0.0}});
}

// The exact moment about a point `lever` ahead of the pivots, of 1 N, each nozzle turned as a Cardan joint
// turns it: first about the second hinge, then the whole about the first.
Vector3 MomentOf(const NozzleLayout& layout, const double* deflection_rad, double lever_m) {
  Vector3 moment = Vector3::Zero();
  for (int k = 0; k < layout.nozzles; ++k) {
    const auto turn = [&](int drive) {
      // The hinge's axis turns x towards the direction that names it.
      const Vector3 towards(0.0, layout.towards_y[drive], layout.towards_z[drive]);
      if (towards.norm() == 0.0) return Matrix3(Matrix3::Identity());
      return Matrix3(
          Eigen::AngleAxisd(deflection_rad[drive], Vector3::UnitX().cross(towards)).toRotationMatrix());
    };
    const Vector3 force = layout.share[k] * (turn(k) * turn(k + kNozzles) * Vector3::UnitX());
    moment += Vector3(-lever_m, layout.y_m[k], layout.z_m[k]).cross(force);
  }
  return moment;
}

// A command of each axis gives the moment that the layout promises about it, and none about the others; and
// what the drives' angles are felt as is the command.
void ExpectCommandsGiveTheirMoments(const Gimbal& gimbal) {
  const NozzleLayout layout = BuildNozzleLayout(gimbal);
  constexpr double kSmall_rad = 1e-5, kLever_m = 7.0;
  for (int axis = layout.rolls ? 0 : 1; axis < 3; ++axis) {
    double deflection[kDrives];
    for (int drive = 0; drive < kDrives; ++drive)
      deflection[drive] = kSmall_rad * layout.allocation[drive][axis];
    Vector3 expected = Vector3::Zero();
    expected[axis] = kSmall_rad * (axis == 0 ? layout.roll_arm_m : layout.pitch_share * kLever_m);
    // The rest is of second order: of nozzles beside the axis that turn unlike.
    EXPECT_NEAR((MomentOf(layout, deflection, kLever_m) - expected).norm(), 0.0,
                2.0 * kSmall_rad * kSmall_rad)
        << axis;
    for (int felt = 0; felt < 3; ++felt) {
      double command = 0.0;
      for (int drive = 0; drive < kDrives; ++drive) command += layout.felt[felt][drive] * deflection[drive];
      EXPECT_NEAR(command, felt == axis ? kSmall_rad : 0.0, 1e-11 * kSmall_rad + 1e-16) << axis << felt;
    }
  }
}

TEST(NozzleLayout, CommandsGiveTheirMomentsAndNoOthers) {
  for (const Gimbal& gimbal :
       {One(), Two(), Ring(3, 0.0, 0.5), Ring(3, 0.4, 0.5), Ring(4, 45.0 * kDeg, 0.5), Ring(4, 0.0, 0.5)})
    ExpectCommandsGiveTheirMoments(gimbal);
  Gimbal cross;
  cross.limit_rad = 6.0 * kDeg;
  cross.radius_m = 0.4;
  ExpectCommandsGiveTheirMoments(cross);
  // A strong nozzle in the middle beside two weak ones, and a fixed one among them.
  ExpectCommandsGiveTheirMoments(With({{"main", 0.0, 0.0, 0.6, {0.3, 0.3 + 90.0 * kDeg}, 4.0 * kDeg},
                                       {"a", 1.0, 0.5, 0.15, {1.0}, 0.0},
                                       {"b", -1.0, -0.5, 0.15, {1.0}, 2.0 * kDeg},
                                       {"fixed", 0.0, 0.0, 0.1, {}, 0.0}}));
}

TEST(NozzleLayout, TheCrossIsTheListItStandsFor) {
  Gimbal gimbal;
  gimbal.limit_rad = 6.0 * kDeg;
  gimbal.radius_m = 0.4;
  const NozzleLayout layout = BuildNozzleLayout(gimbal);
  // Right, left: pitch and roll; bottom, top: yaw and roll. To the bit: margins are of these numbers.
  const double expected[kDrives][3] = {{1, 1, 0}, {-1, 1, 0}, {1, 0, 1}, {-1, 0, 1}};
  for (int drive = 0; drive < kDrives; ++drive)
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_EQ(layout.allocation[drive][axis], expected[drive][axis]) << drive << axis;
  EXPECT_DOUBLE_EQ(layout.pitch_share, 0.5);
  EXPECT_DOUBLE_EQ(layout.roll_arm_m, 0.4);
  EXPECT_DOUBLE_EQ(layout.flow_radius_m, 0.4);
  EXPECT_TRUE(layout.rolls);
}

TEST(NozzleLayout, OneNozzleInTwoPlanesHasAllOfPitchAndYawAndNoRoll) {
  const NozzleLayout layout = BuildNozzleLayout(One());
  EXPECT_FALSE(layout.rolls);
  EXPECT_EQ(layout.roll_arm_m, 0.0);
  EXPECT_EQ(layout.pitch_share, 1.0);
  EXPECT_EQ(layout.flow_radius_m, 0.0);
  for (int drive = 0; drive < kDrives; ++drive) {
    EXPECT_EQ(layout.allocation[drive][0], 0.0);
    EXPECT_EQ(layout.allocation[drive][1], drive == 0 ? 1.0 : 0.0);
    EXPECT_EQ(layout.allocation[drive][2], drive == kNozzles ? 1.0 : 0.0);
    EXPECT_EQ(layout.there[drive], drive % kNozzles == 0 ? 1.0 : 0.0);
  }
}

TEST(NozzleLayout, TwoNozzlesTurnTogetherInPitchAndYawAndApartInRoll) {
  const NozzleLayout layout = BuildNozzleLayout(Two());
  EXPECT_TRUE(layout.rolls);
  EXPECT_DOUBLE_EQ(layout.pitch_share, 1.0);
  EXPECT_DOUBLE_EQ(layout.roll_arm_m, 0.8);
  for (int k = 0; k < 2; ++k) {
    EXPECT_EQ(layout.allocation[k][0], k == 0 ? 1.0 : -1.0);
    EXPECT_EQ(layout.allocation[k][1], 1.0);
    EXPECT_EQ(layout.allocation[k + kNozzles][2], 1.0);
  }
}

// n nozzles that turn about the vehicle's axis have G G' = diag(r²/n, 1/(2n), 1/(2n)), so that the
// pseudo-inverse is (1/r, 2 cos, 2 sin) of each nozzle's place; scaled, the nozzle that turns most in pitch
// or yaw turns by 1.
TEST(NozzleLayout, ARingHasTheClosedFormOfItsPseudoInverse) {
  struct Case {
    int count;
    double from_rad, most;
  };
  for (const Case& c : {Case{3, 0.0, 1.0}, Case{4, 45.0 * kDeg, std::sqrt(0.5)}, Case{4, 0.0, 1.0}}) {
    const NozzleLayout layout = BuildNozzleLayout(Ring(c.count, c.from_rad, 0.5));
    for (int k = 0; k < c.count; ++k) {
      const double at = c.from_rad + kTwoPi * k / c.count;
      EXPECT_NEAR(layout.allocation[k][0], 1.0, 1e-12);
      EXPECT_NEAR(layout.allocation[k][1], std::cos(at) / c.most, 1e-12) << c.count << k;
      EXPECT_NEAR(layout.allocation[k][2], std::sin(at) / c.most, 1e-12) << c.count << k;
    }
    EXPECT_NEAR(layout.pitch_share, 0.5 / c.most, 1e-12);
    EXPECT_NEAR(layout.roll_arm_m, 0.5, 1e-12);
  }
}

// One of two nozzles may turn half as far. If only their sum is given, (d1/2)² + d2² is least at d1 = 4 d2.
TEST(NozzleLayout, WeighsDeflectionsByTheirLimits) {
  Gimbal gimbal = Two();
  gimbal.nozzles[1].limit_rad = 3.0 * kDeg;
  const NozzleLayout layout = BuildNozzleLayout(gimbal);
  EXPECT_EQ(layout.limit_rad[0], 6.0 * kDeg);
  EXPECT_EQ(layout.limit_rad[1], 3.0 * kDeg);
  // Pitch and roll share the first hinges: with both free, pitch alone wants them equal, or it would turn in
  // roll.
  EXPECT_NEAR(layout.allocation[0][1], layout.allocation[1][1], 1e-12);
  // Yaw is not tied to roll.
  EXPECT_NEAR(layout.allocation[kNozzles][2], 4.0 * layout.allocation[1 + kNozzles][2], 1e-11);
  // Of pitch the narrow nozzle is at its 3 deg when 6 are commanded.
  EXPECT_NEAR(layout.allocation[1][1], 0.5, 1e-12);
  EXPECT_NEAR(layout.pitch_share, 0.5, 1e-12);
}

// To the pseudo-inverse a group is as weak as its weakest nozzle, which may stand anywhere in it. By hand: a
// group of half the thrust with half the limit, and a nozzle with the other half, have the effects 0.5 and
// the weights 0.25 and 1, so 0.4 and 1.6 of a command each; the nozzle reaches its limit first.
TEST(NozzleLayout, AGroupIsAsWeakAsItsWeakestNozzle) {
  const std::vector<double> both = {90.0 * kDeg, 180.0 * kDeg};
  for (const std::size_t weak : {0u, 1u}) {
    std::vector<Nozzle> nozzles = {{"a", 0.0, 0.0, 0.25, both, 6.0 * kDeg},
                                   {"b", 0.0, 0.0, 0.25, both, 6.0 * kDeg},
                                   {"c", 0.0, 0.0, 0.5, both, 6.0 * kDeg}};
    nozzles[weak].limit_rad = 3.0 * kDeg;
    nozzles[0].group = nozzles[1].group = "pair";
    const NozzleLayout layout = BuildNozzleLayout(With(nozzles));
    for (const int axis : {1, 2}) {
      const int hinge = axis - 1;
      EXPECT_NEAR(layout.allocation[DriveOf(0, hinge)][axis], 0.25, 1e-12) << weak << axis;
      EXPECT_NEAR(layout.allocation[DriveOf(1, hinge)][axis], 0.25, 1e-12) << weak << axis;
      EXPECT_NEAR(layout.allocation[DriveOf(2, hinge)][axis], 1.0, 1e-12) << weak << axis;
    }
    EXPECT_NEAR(layout.pitch_share, 0.625, 1e-12) << weak;
  }
}

// A booster turns the vehicle by its own lever. By hand: beside a nozzle with effect 1, two of half its
// thrust have the effect 0.5 times the ratio of levers, e, and get as much of a command as they effect.
TEST(NozzleLayout, ABoosterTurnsByItsOwnLever) {
  for (const double booster_lever_m : {4.0, 12.0}) {
    Boosters boosters;
    boosters.count = 2;
    boosters.angles_rad = {0.0, kPi};
    boosters.radius_m = 2.0;
    boosters.towards_rad = {90.0 * kDeg, 180.0 * kDeg};
    boosters.gimbal.limit_rad = 6.0 * kDeg;
    const double effect = 0.5 * booster_lever_m / 8.0;
    const NozzleLayout layout = BuildBoostLayout(One(), boosters, {0.5, 8.0, booster_lever_m});
    const double scale = (1.0 + 2.0 * effect * effect) / std::max(1.0, effect);
    EXPECT_NEAR(layout.pitch_share, scale, 1e-12) << booster_lever_m;
    EXPECT_NEAR(layout.allocation[DriveOf(0, 0)][1], 1.0 / std::max(1.0, effect), 1e-12) << booster_lever_m;
    for (const int k : {kNozzles, kNozzles + 1})
      EXPECT_NEAR(layout.allocation[DriveOf(k, 0)][1], effect / std::max(1.0, effect), 1e-12)
          << booster_lever_m << k;
  }
}

// The flow leaves at its nozzles, each with its share: the radius of gyration of unlike ones.
TEST(NozzleLayout, TheFlowsRadiusCountsEachNozzleByItsShare) {
  const Gimbal gimbal = With({{"main", 0.0, 0.0, 0.8, {90.0 * kDeg, 180.0 * kDeg}, 0.0},
                              {"right", 2.0, 1.0, 0.1, {90.0 * kDeg}, 0.0},
                              {"left", -2.0, -1.0, 0.1, {90.0 * kDeg}, 0.0}});
  EXPECT_DOUBLE_EQ(BuildNozzleLayout(gimbal).flow_radius_m, 1.0);  // 0.2 of 5 m²
}

}  // namespace
}  // namespace dispersa::vehicle_nozzle_layout_test
