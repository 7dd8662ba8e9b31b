// A recorded ascent against its flight program: steering of an upper stage over time, and density of the
// attitude knots.
#include "core/campaign_yaml/load.h"
#include "core/math/constants.h"
#include "core/trajectory/ascent.h"
#include "tests/test.h"

namespace dispersa::trajectory_program_test {
namespace {

const Vehicle& Slv4() {
  static const Vehicle vehicle = LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml");
  return vehicle;
}

FlightProgram Shipped() { return LoadReference(DISPERSA_CAMPAIGNS "/references/slv4_500km.yaml").program; }

AscentResult Recorded(const FlightProgram& program) {
  AscentOptions options;
  options.record = true;
  return FlyAscent(BuildAscentModel(Slv4(), 0.01), program, options);
}

// From 0 to 1 over `whole_s` with no rate at the ends: half way at half the time.
double Smooth(double since_s, double whole_s) {
  const double x = std::clamp(since_s / whole_s, 0.0, 1.0);
  return std::pow(x, 3) * (10.0 - 15.0 * x + 6.0 * x * x);
}

// The coast begins with the third stage's burnout; its motor's thrust is constant, so it burnt its burning
// time.
TEST(FlightProgramSteering, SetsInWithin20SecondsAndFadesWithin60) {
  FlightProgram program = Shipped();
  const double begin_rad = 6.0 * kRadPerDeg, end_rad = 2.0 * kRadPerDeg;
  program.steering[2] = {begin_rad, end_rad};
  const AscentResult ascent = Recorded(program);
  const double burnout_s = ascent.last_ignition_s - program.coast_s,
               whole_s = Slv4().stages[2].motor.burning_time_s;
  const double ignition_s = burnout_s - whole_s;
  int rising = 0, fading = 0;
  for (const AscentSample& s : ascent.samples) {
    if (s.time_s < program.t2_s) continue;
    // A burnout is seen on the next tick of 0.01 s: 0.01 / 20 of the incidence at most twice as fast.
    const double share = Smooth(s.time_s - ignition_s, 20.0) * (1.0 - Smooth(s.time_s - burnout_s, 60.0));
    const double part = std::clamp((s.time_s - ignition_s) / whole_s, 0.0, 1.0);
    EXPECT_NEAR(s.alpha_rad, share * (begin_rad + part * (end_rad - begin_rad)), 1e-3 * begin_rad)
        << s.time_s;
    rising += s.time_s > ignition_s && s.time_s < ignition_s + 20.0;
    fading += s.time_s > burnout_s && s.time_s < burnout_s + 60.0;
  }
  EXPECT_GT(rising, 15);
  EXPECT_GT(fading, 10);
}

// The search tries pitch-overs that outlast the first stage. Steering of the second one then waits for their
// end.
TEST(FlightProgramSteering, SetsInAfterAPitchOverThatOutlastsItsIgnition) {
  FlightProgram program = Shipped();
  const double incidence_rad = 6.0 * kRadPerDeg;
  program.steering[1] = {incidence_rad, incidence_rad};
  program.t2_s = Slv4().stages[0].motor.burning_time_s + 12.0;
  const AscentResult ascent = Recorded(program);
  int rising = 0;
  for (const AscentSample& s : ascent.samples) {
    if (s.stage != 2 || s.time_s < program.t2_s || s.time_s > program.t2_s + 25.0) continue;
    EXPECT_NEAR(s.alpha_rad, Smooth(s.time_s - program.t2_s, 20.0) * incidence_rad, 1e-6) << s.time_s;
    ++rising;
  }
  EXPECT_GT(rising, 20);
  program.steering[1] = {};
  EXPECT_EQ(ascent.turn_rate_max_rad_s, Recorded(program).turn_rate_max_rad_s);
}

// A turn of seconds asks for knots much closer than a gravity turn or a coast.
TEST(AttitudeProgramKnots, StandAtTheProgramsTimesAndATenthOfASecondApartBeforeT2) {
  const FlightProgram program = Shipped();
  const AscentResult ascent = Recorded(program);
  const std::vector<AttitudeKnot>& knots = ascent.attitude.knots;
  for (const double time_s : {program.t1_s, program.t3_s, program.t2_s})
    EXPECT_TRUE(std::any_of(knots.begin(), knots.end(), [&](const AttitudeKnot& k) {
      return std::fabs(k.time_s - time_s) < 1e-9;
    })) << time_s;
  for (std::size_t i = 1; i < knots.size() && knots[i].time_s <= ascent.end_time_s; ++i) {
    const double t = knots[i].time_s, burnout_s = ascent.last_ignition_s - program.coast_s;
    const bool coasting = t > burnout_s && t <= ascent.last_ignition_s;
    EXPECT_LE(t - knots[i - 1].time_s, (t <= program.t2_s ? 0.1 : coasting ? 5.0 : 1.0) + 1e-9) << t;
  }
}

}  // namespace
}  // namespace dispersa::trajectory_program_test
