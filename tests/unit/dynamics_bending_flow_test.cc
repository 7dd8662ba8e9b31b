// The flow on a flexible body, and the loads in its sections. Compared with rigid motions that modes can
// represent, virtual work, and the balance of masses on a line.
#include "tests/test.h"
#include "tests/unit/made_up_bending.h"

namespace dispersa::dynamics_bending_flow_test {
namespace {

using lanes::BendingState;
using lanes::FlowForce;
using lanes::ModalForce;
using lanes::NormalForce;
using lanes::Sections;
using lanes::StackBending;

constexpr const lanes::SideForce<double>* kRound = nullptr;  // both planes have the same air
constexpr double kCg_m = 11.0, kXcp_m = 8.0, kSpeed_m_s = 400.0, kSlope_n = 6e5;

// The body's incidence: the flow across it over the flow along it, along y and along z.
struct Incidence {
  double y, z;
};

// A normal force in proportion to the incidence, at the centre of pressure, with its moment about C.
FlowForce<double> LinearAir(Incidence at) {
  const double size = std::hypot(at.y, at.z);
  FlowForce<double> flow{};
  flow.normal = {
      kSlope_n * size, kSlope_n, kXcp_m, size > 0.0 ? at.y / size : 0.0, size > 0.0 ? at.z / size : 0.0,
      kSpeed_m_s};
  flow.force_n = {-1e4, -kSlope_n * at.y, -kSlope_n * at.z};
  // The arm of the force is (cg - xcp) along x.
  flow.moment_n_m = {0.0, (kXcp_m - kCg_m) * flow.force_n.z, -(kXcp_m - kCg_m) * flow.force_n.y};
  return flow;
}

Sections<double> BodySections() {
  static const LoadTable loads = MadeUpLoads();
  Sections<double> body{};
  lanes::SetSections(body, 0, &loads);
  return body;
}

// About z and about -y, at each load station.
struct SectionMoments {
  double y_n_m[kLoadStations], z_n_m[kLoadStations];
};
SectionMoments MomentsOf(const Sections<double>& body, const lanes::BendingLoads<double>& bending) {
  SectionMoments o{};
  for (int i = 0; i < body.stations; ++i) bending.AddAt(i, o.y_n_m[i], o.z_n_m[i]);
  return o;
}

// Modes that are no bending: the body moved aside, and turned about its centre of gravity.
std::vector<std::vector<MadeUpMode>> RigidMotions() {
  const MadeUpMode aside{{1.0, 0.0, 0.0, 0.0}}, turned{{-kCg_m, 1.0, 0.0, 0.0}};
  return {{aside, turned}};
}

constexpr double kSmall_n = 1e-8;  // rounding of forces of 1e5 N on arms of 20 m

// A body that moves aside meets the flow at its speed over the airspeed; one that is turned, at its turn.
TEST(BendingFlow, OfARigidMotionIsTheFlowOfTheMovedBody) {
  const ModeTable table = MadeUpTable(RigidMotions());
  const StackBending<double> bending = BendingOf(table, 0.0);
  BendingState<double> s{};
  s.rate_m_s[0][0] = 3.0;           // towards +y
  s.rate_m_s[1][0] = -2.0;          // towards -z
  s.q_m[0][1] = 0.01;               // nose to the left: the flow comes from the right
  s.q_m[1][1] = -0.02;              // nose down: the flow comes from above
  s.q_m[0][0] = s.q_m[1][0] = 5.0;  // being elsewhere changes nothing
  const Incidence straight{0.02, 0.05};
  const Incidence moved{straight.y + 3.0 / kSpeed_m_s + 0.01, straight.z - 2.0 / kSpeed_m_s - 0.02};
  FlowForce<double> flow = LinearAir(straight);
  ModalForce<double> driven{};
  lanes::BendFlow(bending, s, BodySections(), kCg_m, kRound, flow, driven);
  const FlowForce<double> expected = LinearAir(moved);
  EXPECT_EQ(flow.force_n.x, -1e4);
  EXPECT_NEAR(flow.force_n.y, expected.force_n.y, kSmall_n);
  EXPECT_NEAR(flow.force_n.z, expected.force_n.z, kSmall_n);
  EXPECT_NEAR(flow.moment_n_m.y, expected.moment_n_m.y, kSmall_n);
  EXPECT_NEAR(flow.moment_n_m.z, expected.moment_n_m.z, kSmall_n);
  EXPECT_EQ(flow.moment_n_m.x, 0.0);
  // Virtual work: of the whole force for a metre aside, of the whole moment for a radian. Turning by +1 is
  // about +y in plane z, and about -z in plane y.
  EXPECT_NEAR(driven.drive_m_s2[0][0], expected.force_n.y, kSmall_n);
  EXPECT_NEAR(driven.drive_m_s2[1][0], expected.force_n.z, kSmall_n);
  EXPECT_NEAR(driven.drive_m_s2[0][1], -expected.moment_n_m.z, kSmall_n);
  EXPECT_NEAR(driven.drive_m_s2[1][1], expected.moment_n_m.y, kSmall_n);
}

// The forces of the strips by bending alone, in one plane.
std::array<double, kStrips> ForcesByBending(const std::vector<MadeUpMode>& modes,
                                            const BendingState<double>& s, int plane) {
  const LoadTable loads = MadeUpLoads();
  const auto incidence = [&](double place_m) {
    double at = 0.0;
    for (std::size_t mode = 0; mode < modes.size(); ++mode)
      at += s.q_m[plane][mode] * modes[mode].Slope(place_m) +
            s.rate_m_s[plane][mode] * modes[mode].Deflection(place_m) / kSpeed_m_s;
    return at;
  };
  std::array<double, kStrips> force = StripForces(loads, kXcp_m - loads.lift.slender_station_m, incidence);
  for (double& each : force) each *= -kSlope_n;
  return force;
}

// A turning body's places meet the flow at their own speeds, and where the cross-section does not grow the
// incidence does.
TEST(BendingFlow, OfATurningBodyIsThatOfEachPlacesSpeed) {
  const ModeTable table = MadeUpTable(RigidMotions());
  const StackBending<double> bending = BendingOf(table, 0.0);
  const LoadTable loads = MadeUpLoads();
  const double aft_m = kXcp_m - loads.lift.slender_station_m;
  for (int plane = 0; plane < kPlanes; ++plane) {
    BendingState<double> s{};
    s.rate_m_s[plane][1] = 0.3;
    FlowForce<double> flow = LinearAir({0.0, 0.0});
    ModalForce<double> driven{};
    lanes::BendFlow(bending, s, BodySections(), kCg_m, kRound, flow, driven);
    double force = 0.0, moment = 0.0, shares = 0.0;
    for (const LiftPiece& strip : loads.lift.pieces) {
      const double grown = strip.area_to - strip.area_from, middle_m = strip.Middle() - kCg_m;
      const double mean_area = 0.5 * (strip.area_from + strip.area_to);
      // d(A alpha) = alpha dA + A dalpha.
      const double here =
          -kSlope_n * 0.3 / kSpeed_m_s *
          (grown * middle_m + mean_area * (strip.to_m - strip.from_m) + aft_m * strip.shift_1_m * middle_m);
      force += here;
      moment += here * middle_m;
      shares += grown + aft_m * strip.shift_1_m;
    }
    EXPECT_NEAR(plane == 0 ? flow.force_n.y : flow.force_n.z, force, kSmall_n);
    EXPECT_EQ(plane == 0 ? flow.force_n.z : flow.force_n.y, 0.0);
    EXPECT_NEAR(plane == 0 ? -flow.moment_n_m.z : flow.moment_n_m.y, moment, kSmall_n);
    EXPECT_NEAR(shares, 1.0, 1e-14);
  }
}

// A bent body's forces do work on each mode by their places.
TEST(BendingFlow, DrivesEachModeByTheWorkOfItsStrips) {
  const ModeTable table = MadeUpTable(TwoPlanes());
  const StackBending<double> bending = BendingOf(table, 0.0);
  const Sections<double> body = BodySections();
  const Incidence straight{-0.03, 0.04};
  BendingState<double> s{};
  for (int plane = 0; plane < kPlanes; ++plane)
    for (int mode = 0; mode < 2; ++mode) {
      s.q_m[plane][mode] = 0.02 - 0.03 * mode + 0.01 * plane;
      s.rate_m_s[plane][mode] = 2.0 * mode - 0.5 * plane - 0.7;
    }
  FlowForce<double> flow = LinearAir(straight);
  ModalForce<double> driven{};
  driven.drive_m_s2[1][1] = 1e3;  // is added to
  lanes::BendFlow(bending, s, body, kCg_m, kRound, flow, driven);
  const LoadTable loads = MadeUpLoads();
  const double aft_m = kXcp_m - loads.lift.slender_station_m;
  double force[kPlanes] = {}, work[kPlanes][2] = {};
  for (std::size_t plane = 0; plane < kPlanes; ++plane) {
    const std::vector<MadeUpMode> modes = TwoPlanes()[plane];
    const double at = plane == 0 ? straight.y : straight.z;
    const auto by_body = StripForces(loads, aft_m, [&](double) { return at; });
    const auto by_bending = ForcesByBending(modes, s, static_cast<int>(plane));
    for (std::size_t strip = 0; strip < kStrips; ++strip) {
      const double here_n = by_bending[strip] - kSlope_n * by_body[strip];
      force[plane] += here_n;
      for (std::size_t mode = 0; mode < 2; ++mode)
        work[plane][mode] += here_n * modes[mode].Deflection(loads.lift.pieces[strip].Middle());
    }
  }
  EXPECT_NEAR(flow.force_n.y, force[0], kSmall_n);
  EXPECT_NEAR(flow.force_n.z, force[1], kSmall_n);
  EXPECT_NEAR(driven.drive_m_s2[0][0], work[0][0], kSmall_n);
  EXPECT_NEAR(driven.drive_m_s2[0][1], work[0][1], kSmall_n);
  EXPECT_NEAR(driven.drive_m_s2[1][0], work[1][0], kSmall_n);
  EXPECT_NEAR(driven.drive_m_s2[1][1], 1e3 + work[1][1], kSmall_n);
}

TEST(BendingFlow, InVacuumIsNothingHoweverTheBodyRings) {
  const ModeTable table = MadeUpTable(TwoPlanes());
  const StackBending<double> bending = BendingOf(table, 0.0);
  BendingState<double> s{};
  s.q_m[0][0] = s.q_m[1][1] = 0.1;
  s.rate_m_s[0][1] = s.rate_m_s[1][0] = 5.0;
  for (const double airspeed_m_s : {0.0, 7000.0}) {
    FlowForce<double> flow{};
    flow.normal.airspeed_m_s = airspeed_m_s;
    ModalForce<double> driven{};
    lanes::BendFlow(bending, s, BodySections(), kCg_m, kRound, flow, driven);
    for (const double value :
         {flow.force_n.y, flow.force_n.z, flow.moment_n_m.y, flow.moment_n_m.z, driven.drive_m_s2[0][0],
          driven.drive_m_s2[0][1], driven.drive_m_s2[1][0], driven.drive_m_s2[1][1]})
      EXPECT_EQ(value, 0.0) << airspeed_m_s;
  }
}

// A section carries what the masses ahead of it take to be accelerated by the modes, less the flow's forces
// there.
TEST(BendingSections, CarryTheMassesAheadLessTheirAir) {
  const ModeTable table = MadeUpTable(TwoPlanes());
  constexpr double kDamping = 0.04;
  const StackBending<double> bending = BendingOf(table, 0.0, kDamping);
  const Sections<double> body = BodySections();
  BendingState<double> s{};
  ModalForce<double> driven{};
  for (int plane = 0; plane < kPlanes; ++plane)
    for (int mode = 0; mode < 2; ++mode) {
      s.q_m[plane][mode] = 0.01 * (1 + mode) * (plane == 0 ? 1.0 : -1.0);
      s.rate_m_s[plane][mode] = 0.3 - 0.4 * mode + 0.2 * plane;
      driven.drive_m_s2[plane][mode] = 4.0 + 3.0 * mode - 5.0 * plane;
    }
  for (const bool in_air : {false, true}) {
    NormalForce<double> air{};
    if (in_air) air = LinearAir({0.02, -0.01}).normal;
    const SectionMoments moments = MomentsOf(body, {bending, s, driven, body, air, kRound});
    for (std::size_t plane = 0; plane < kPlanes; ++plane) {
      const auto forces = ForcesByBending(TwoPlanes()[plane], s, static_cast<int>(plane));
      double acceleration[2];
      for (std::size_t mode = 0; mode < 2; ++mode) {
        const double w = TwoPlanes()[plane][mode].frequency_rad_s;
        acceleration[mode] = driven.drive_m_s2[plane][mode] -
                             2.0 * kDamping * TwoPlanes()[plane][mode].damping * w * s.rate_m_s[plane][mode] -
                             w * w * s.q_m[plane][mode];
      }
      for (int station = 0; station < body.stations; ++station) {
        const double at_m = 2.5 * (station + 1);
        double carried = 0.0;
        for (int strip = 0; strip <= station; ++strip) {
          const double place_m = 1.25 + 2.5 * strip;
          double force = in_air ? -forces[static_cast<std::size_t>(strip)] : 0.0;
          for (std::size_t mode = 0; mode < 2; ++mode)
            force += BodyMass(static_cast<std::size_t>(strip)) * acceleration[mode] *
                     TwoPlanes()[plane][mode].Deflection(place_m);
          carried += force * (at_m - place_m);
        }
        EXPECT_NEAR(plane == 0 ? moments.y_n_m[station] : moments.z_n_m[station], carried,
                    1e-7)  // of 1e5 N m
            << "plane " << plane << ", station " << station << (in_air ? ", in air" : ", in vacuum");
      }
    }
  }
}

double LargestOf(const SectionMoments& moments) {
  double largest = 0.0;
  for (int i = 0; i < kLoadStations; ++i)
    largest = std::max(largest, std::hypot(moments.y_n_m[i], moments.z_n_m[i]));
  return largest;
}
// What bending adds is nowhere above its bound, and comes near it where no parts cancel.
TEST(BendingSections, HaveNoMoreThanTheirBound) {
  const ModeTable table = MadeUpTable(TwoPlanes());
  const Sections<double> body = BodySections();
  for (const double propellant_kg : {0.0, 300.0}) {
    const StackBending<double> bending = BendingOf(table, propellant_kg);
    double nearest = 0.0;
    for (int swung = 0; swung < 64; ++swung) {
      BendingState<double> s{};
      ModalForce<double> driven{};
      const auto sign = [swung](int bit) { return swung & (1 << bit) ? -1.0 : 1.0; };
      s.q_m[0][0] = 0.01 * sign(0), s.q_m[0][1] = 0.003 * sign(1), s.q_m[1][0] = 0.005 * sign(2);
      s.rate_m_s[0][0] = 0.3 * sign(3), s.rate_m_s[1][1] = 0.4 * sign(4);
      driven.drive_m_s2[0][1] = 4.0 * sign(5);
      const lanes::BendingLoads<double> loads(bending, s, driven, body, LinearAir({0.02, -0.01}).normal,
                                              kRound);
      const double largest = LargestOf(MomentsOf(body, loads));
      EXPECT_LE(largest, loads.Most()) << swung;
      nearest = std::max(nearest, largest / loads.Most());
    }
    EXPECT_GT(nearest, 0.5);
    for (const int plane : {0, 1}) {
      ModalForce<double> driven{};
      driven.drive_m_s2[plane][1] = -4.0;
      const lanes::BendingLoads<double> loads(bending, {}, driven, body, NormalForce<double>{}, kRound);
      EXPECT_NEAR(loads.Most() / LargestOf(MomentsOf(body, loads)), 1.0, 1e-9) << plane;
    }
  }
}

// A body whose air has two planes of symmetry: each plane is that of a body of revolution in that plane's
// air.
TEST(BendingFlow, OfTwoPlanesIsThatOfEach) {
  const ModeTable one = MadeUpTable({TwoPlanes()[0]}), two = MadeUpTable(TwoPlanes());
  const Sections<double> body = BodySections();
  for (const ModeTable* table : {&one, &two}) {
    const StackBending<double> bending = BendingOf(*table, 0.0);
    BendingState<double> s{};
    for (int plane = 0; plane < kPlanes; ++plane)
      for (int mode = 0; mode < 2; ++mode) {
        s.q_m[plane][mode] = 0.01 * (1 + mode) - 0.007 * plane;
        s.rate_m_s[plane][mode] = 0.3 - 0.4 * mode + 0.2 * plane;
      }
    FlowForce<double> along_z = LinearAir({0.02, -0.03}), along_y = along_z;
    along_y.normal.normal_n *= 1.4;
    along_y.normal.slope_n *= 1.3;
    along_y.normal.xcp_station_m += 2.5;
    const lanes::SideForce<double> side{along_y.normal.normal_n, along_y.normal.slope_n,
                                        along_y.normal.xcp_station_m};
    FlowForce<double> both = along_z;
    ModalForce<double> drive_z{}, drive_y{}, drive{};
    lanes::BendFlow(bending, s, body, kCg_m, kRound, along_z, drive_z);
    lanes::BendFlow(bending, s, body, kCg_m, kRound, along_y, drive_y);
    lanes::BendFlow(bending, s, body, kCg_m, &side, both, drive);
    EXPECT_EQ(both.force_n.y, along_y.force_n.y);
    EXPECT_EQ(both.force_n.z, along_z.force_n.z);
    EXPECT_EQ(both.moment_n_m.y, along_z.moment_n_m.y);
    EXPECT_EQ(both.moment_n_m.z, along_y.moment_n_m.z);
    EXPECT_NE(along_y.force_n.y, along_z.force_n.y);
    for (int mode = 0; mode < 2; ++mode) {
      EXPECT_EQ(drive.drive_m_s2[0][mode], drive_y.drive_m_s2[0][mode]);
      EXPECT_EQ(drive.drive_m_s2[1][mode], drive_z.drive_m_s2[1][mode]);
    }
    const auto moments = [&](const NormalForce<double>& air, const lanes::SideForce<double>* of_yaw) {
      return MomentsOf(body, {bending, s, ModalForce<double>{}, body, air, of_yaw});
    };
    const SectionMoments of_both = moments(both.normal, &side), of_y = moments(along_y.normal, kRound),
                         of_z = moments(along_z.normal, kRound);
    for (int station = 0; station < body.stations; ++station) {
      EXPECT_EQ(of_both.y_n_m[station], of_y.y_n_m[station]);
      EXPECT_EQ(of_both.z_n_m[station], of_z.z_n_m[station]);
    }
  }
}

// All that bending says of a body, in body axes.
struct Everything {
  lanes::Bent<double> pivot;
  lanes::Vector<double> unit, unit_rate, gyro_rate;
  FlowForce<double> flow;
  ModalForce<double> drive;
  BendingState<double> later;
  SectionMoments sections;
};
Everything Of(const StackBending<double>& b, const BendingState<double>& s, Incidence at,
              lanes::Vector<double> force, lanes::Vector<double> couple) {
  const Sections<double> body = BodySections();
  Everything o{};
  o.pivot = BentAtPivot(b, s, lanes::Zero<double>(), lanes::Zero<double>());
  o.unit = lanes::UnitTurn(b, s);
  o.unit_rate = lanes::TurnRate(b, s, -1);
  o.gyro_rate = lanes::TurnRate(b, s, 1);
  o.flow = LinearAir(at);
  lanes::BendFlow(b, s, body, kCg_m, kRound, o.flow, o.drive);
  DriveAtPivot(b, s, force, couple, o.drive);
  lanes::FinishDrive(b, s, 2e5, o.drive);
  o.sections = MomentsOf(body, {b, s, o.drive, body, LinearAir(at).normal, kRound});
  o.later = lanes::Swung(b, lanes::SwingOver(b, 0.02), s, o.drive, {}, {});
  return o;
}

// A quarter turn about x takes y to z and z to -y. Results in the turned axes are turned, and otherwise the
// same.
TEST(BendingPlanes, AreOneAnotherTurnedByAQuarterAboutX) {
  const ModeTable table = MadeUpTable({TwoPlanes()[0]});
  const StackBending<double> b = BendingOf(table, 0.0, 0.01);
  BendingState<double> s{}, turned{};
  for (int mode = 0; mode < 2; ++mode) {
    s.q_m[0][mode] = 0.02 - 0.03 * mode;
    s.q_m[1][mode] = 0.01 + 0.04 * mode;
    s.rate_m_s[0][mode] = 0.5 + mode;
    s.rate_m_s[1][mode] = -0.8 + 0.3 * mode;
    turned.q_m[1][mode] = s.q_m[0][mode];
    turned.q_m[0][mode] = -s.q_m[1][mode];
    turned.rate_m_s[1][mode] = s.rate_m_s[0][mode];
    turned.rate_m_s[0][mode] = -s.rate_m_s[1][mode];
  }
  const auto turn = [](lanes::Vector<double> v) { return lanes::Vector<double>{v.x, -v.z, v.y}; };
  const lanes::Vector<double> force{1e5, 800.0, -300.0}, couple{10.0, 70.0, 250.0};
  const Everything before = Of(b, s, {0.02, 0.05}, force, couple);
  const Everything after = Of(b, turned, {-0.05, 0.02}, turn(force), turn(couple));
  const auto expect_turned = [&](lanes::Vector<double> from, lanes::Vector<double> to, double tolerance,
                                 const char* what) {
    EXPECT_NEAR(to.x, from.x, tolerance) << what;
    EXPECT_NEAR(to.y, -from.z, tolerance) << what;
    EXPECT_NEAR(to.z, from.y, tolerance) << what;
  };
  constexpr double kRounding = 1e-13;
  expect_turned({0.0, before.pivot.y_m, before.pivot.z_m}, {0.0, after.pivot.y_m, after.pivot.z_m}, kRounding,
                "moved");
  expect_turned({0.0, before.pivot.about_y_rad, before.pivot.about_z_rad},
                {0.0, after.pivot.about_y_rad, after.pivot.about_z_rad}, kRounding, "turned");
  expect_turned(before.unit, after.unit, kRounding, "unit");
  expect_turned(before.unit_rate, after.unit_rate, kRounding, "unit's rate");
  expect_turned(before.gyro_rate, after.gyro_rate, kRounding, "gyro's rate");
  expect_turned(before.flow.force_n, after.flow.force_n, kSmall_n, "force");
  expect_turned(before.flow.moment_n_m, after.flow.moment_n_m, kSmall_n, "moment");
  for (int mode = 0; mode < 2; ++mode) {
    EXPECT_NEAR(after.drive.drive_m_s2[1][mode], before.drive.drive_m_s2[0][mode], kSmall_n);
    EXPECT_NEAR(after.drive.drive_m_s2[0][mode], -before.drive.drive_m_s2[1][mode], kSmall_n);
    EXPECT_NEAR(after.later.q_m[1][mode], before.later.q_m[0][mode], kRounding);
    EXPECT_NEAR(after.later.q_m[0][mode], -before.later.q_m[1][mode], kRounding);
  }
  for (int i = 0; i < BodySections().stations; ++i) {
    EXPECT_NEAR(after.sections.z_n_m[i], before.sections.y_n_m[i], 1e-7);
    EXPECT_NEAR(after.sections.y_n_m[i], -before.sections.z_n_m[i], 1e-7);
  }
}

}  // namespace
}  // namespace dispersa::dynamics_bending_flow_test
