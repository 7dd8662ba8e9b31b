// Flights that nothing controls: against closed forms of spin, oscillation, rail and ballistic flight, and
// against CVODE.
#include "core/dynamics/fall.h"
#include "core/flight/flight.h"
#include "core/flight/tick_sample.h"
#include "core/math/constants.h"
#include "core/math/functions.h"
#include "core/vehicle/fins.h"
#include "tests/test.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::free_flight_test {
namespace {

// The sample without gimbals, on a rail, to its last burnout: the way on to an apogee takes many times as
// long. Its second stage lights `delay_s` after the first has left.
FlightDefinition FreeDefinition(double elevation_rad, double delay_s, double step_s = kFreeStep_s) {
  FlightDefinition definition = SampleDefinition();
  Vehicle& vehicle = definition.vehicle;
  for (Stage& stage : vehicle.stages) stage.gimbal = FixedNozzle(stage.gimbal.pivot_station_m);
  // Stable: pressure acts aft of the centre of gravity.
  vehicle.aerodynamics[0].xcp_station_m = {18.0, 18.0, 18.0, 18.0};
  vehicle.aerodynamics[1].xcp_station_m = {9.0, 9.0, 9.0, 9.0};
  vehicle.stages[1].ignition = IgnitionTrigger::kBurnoutDetection;
  vehicle.stages[1].ignition_delay_s = delay_s;
  vehicle.reaction_control = {};
  vehicle.rail = Rail{0.0, 0.0, 0.5 * kPi, elevation_rad};
  definition.program.knots = {{.time_s = 0.0, .pitch = elevation_rad},
                              {.time_s = 1.0, .pitch = elevation_rad}};
  definition.last_ignition_s = 0.0;
  definition.course = {FlightEnd::kInjection, false, step_s};
  definition.autopilot = {};
  definition.autopilot.tick_s = step_s;
  for (AxisConfig* axis :
       {&definition.autopilot.pitch, &definition.autopilot.yaw, &definition.autopilot.roll})
    axis->gains.assign(2, {});
  return definition;
}

FlightInputs Airless() {
  FlightInputs inputs;
  inputs.air.density_factor = 1e-12;
  return inputs;
}

// Shows each tick to `watch`, if it is given. Keeping them all would take longer than the flight.
FlightResult Watch(const FlightDefinition& definition, const FlightInputs& inputs,
                   std::function<void(const TickSample&)> watch = {}) {
  FlightOptions options;
  options.observe = std::move(watch);
  return Fly(FlightModel(definition), inputs, options);
}

double MetricOf(const FlightResult& result, const char* name) { return result.metrics[MetricColumn(name)]; }

// Between separation and ignition nothing acts on the upper stage but gravitation. Its axis goes round the
// angular momentum at |H| / I_t (Goldstein, Classical Mechanics, section 5-6).
double WorstConeError(double step_s) {
  constexpr double kSpin_rad_s = 5.0 * kTwoPi, kAcross_rad_s = 1.5;
  FlightDefinition definition = FreeDefinition(80.0 * kRadPerDeg, 20.5, step_s);
  definition.vehicle.stages[0].motor.thrust_n = 1.5e6;
  definition.vehicle.stages[0].motor.burning_time_s = 8.0;
  FlightInputs inputs = Airless();
  inputs.stages[0].tip_off_roll_rad_s = kSpin_rad_s;
  inputs.stages[0].tip_off_pitch_rad_s = kAcross_rad_s;
  double worst_rad = 0.0, start_s = 0.0;
  Vector3 axis_I, momentum_I, across_I;
  double rate_rad_s = 0.0, cone_rad = 0.0;
  Watch(definition, inputs, [&](const TickSample& s) {
    if (s.stack != 1 || s.burning) return;
    const Matrix3& inertia = s.instant.loads.inertia_kg_m2;
    const Vector3 axis = Rotate(s.state.q_IB, Vector3(1.0, 0.0, 0.0));
    if (start_s == 0.0) {
      start_s = s.time_s;
      const Vector3 momentum = Rotate(s.state.q_IB, Vector3(inertia * s.state.w_IB_B));
      momentum_I = momentum.normalized();
      rate_rad_s = momentum.norm() / inertia(1, 1);
      cone_rad = std::acos(axis.dot(momentum_I));
      axis_I = axis;
      across_I = momentum_I.cross(axis).normalized();
    }
    const double angle = rate_rad_s * (s.time_s - start_s);
    const Vector3 aside = (axis_I - axis_I.dot(momentum_I) * momentum_I).normalized();
    const Vector3 expected = std::cos(cone_rad) * momentum_I +
                             std::sin(cone_rad) * (std::cos(angle) * aside + std::sin(angle) * across_I);
    worst_rad = std::max(worst_rad, std::acos(std::min(1.0, axis.dot(expected))));
  });
  EXPECT_GT(cone_rad, 0.1);
  return worst_rad / cone_rad;
}

TEST(FreeFlight, TorqueFreeBodyConesAboutItsAngularMomentum) {
  // A hundred turns at 5 Hz, at 0.06 rad a step. The limit is 0.16, where the error is 0.7.
  const double error = WorstConeError(0.002);
  EXPECT_LT(error, 0.06);
  // Half the step: the method is of third order.
  EXPECT_LT(WorstConeError(0.001), error / 6.0);
}

// Fixed coefficients: theory of small oscillations, omega² = q S CN_alpha (x_cp - x_cg) / I.
TEST(FreeFlight, OscillatesAtThePitchFrequencyOfLinearTheory) {
  FlightDefinition definition = FreeDefinition(60.0 * kRadPerDeg, 40.0);
  definition.vehicle.flow_coriolis = false;
  definition.vehicle.stages[0].motor.thrust_n = 1.5e6;
  definition.vehicle.stages[0].motor.burning_time_s = 8.0;
  FlightInputs inputs;
  inputs.stages[0].tip_off_pitch_rad_s = 0.05;
  double phase = 0.0, before = 0.0, before_s = 0.0, last_phase = 0.0;
  int crossings = 0;
  double worst = 0.0;
  Watch(definition, inputs, [&](const TickSample& s) {
    if (s.stack != 1 || s.burning || crossings == 12) return;
    const double omega = std::sqrt(s.instant.air.qbar_pa * 1.0 * 3.0 * (9.0 - s.instant.cg_station_m) /
                                   s.instant.loads.inertia_kg_m2(1, 1));
    const double alpha = std::atan2(s.instant.v_AB_B.z(), s.instant.v_AB_B.x());
    if (before_s > 0.0) {
      const double dphase = omega * (s.time_s - before_s);
      if (before * alpha < 0.0) {
        const double at = phase + dphase * before / (before - alpha);
        if (crossings > 0) worst = std::max(worst, std::fabs((at - last_phase) / kPi - 1.0));
        last_phase = at;
        ++crossings;
      }
      phase += dphase;
    }
    before = alpha;
    before_s = s.time_s;
  });
  ASSERT_EQ(crossings, 12);
  // The speed along the path turns with gravitation, and density falls within a swing: second-order effects.
  EXPECT_LT(worst, 0.05);
}

TEST(FreeFlight, CantedFinsSpinItAsTheirHelix) {
  FlightDefinition definition = FreeDefinition(80.0 * kRadPerDeg, 1.0);
  FinSet fins;
  fins.leading_edge_station_m = 18.5;
  fins.root_chord_m = 1.2;
  fins.tip_chord_m = 0.6;
  fins.span_m = 0.8;
  fins.cant_rad = 0.3 * kRadPerDeg;
  definition.vehicle.stages[0].fins = {fins};
  definition.vehicle.aerodynamics[0].clp_per_rad = {-60.0, -60.0};
  const double radius_m = 0.6;
  // In the steady state the moment of cant is that of damping, strip by strip: integrals over the span by
  // sums.
  double cant_m3 = 0.0, damping_m4 = 0.0;
  constexpr int kStrips = 20000;
  for (int i = 0; i < kStrips; ++i) {
    const double part = (i + 0.5) / kStrips, y_m = radius_m + part * fins.span_m;
    const double chord_m = fins.root_chord_m + part * (fins.tip_chord_m - fins.root_chord_m);
    cant_m3 += chord_m * y_m * fins.span_m / kStrips;
    damping_m4 += chord_m * y_m * y_m * fins.span_m / kStrips;
  }
  const double per_m = fins.cant_rad * cant_m3 / damping_m4;
  double worst = 0.0;
  int seen = 0;
  Watch(definition, {}, [&](const TickSample& s) {
    if (s.stack != 0 || s.time_s < 28.0 || s.time_s > 38.0) return;
    const double wanted = per_m * s.instant.air.airspeed_m_s;
    worst = std::max(worst, std::fabs(s.state.w_IB_B.x() / wanted - 1.0));
    ++seen;
  });
  EXPECT_GT(seen, 1000);
  // It lags behind a speed that grows by some per cent within the time constant of the spin.
  EXPECT_LT(worst, 0.05);
}

TEST(FreeFlight, SpinMotorsGiveTheirAngularMomentum) {
  FlightDefinition definition = FreeDefinition(80.0 * kRadPerDeg, 1.0);
  definition.vehicle.stages[1].spin_motors = SpinMotors{900.0, 1.5};
  double spin = 0.0, axial = 0.0, flow = 0.0;
  Watch(definition, Airless(), [&](const TickSample& s) {
    if (s.stack != 1 || !s.burning || s.since_ignition_s > 1.5) return;
    spin = s.state.w_IB_B.x();
    axial = s.instant.loads.inertia_kg_m2(0, 0);
    flow = s.instant.flow_kg_s;
  });
  ASSERT_GT(axial, 0.0);
  EXPECT_GT(flow, 0.0);
  // Without jet damping the flow takes no angular momentum along. The last sample is up to a step before the
  // end.
  EXPECT_NEAR(spin * axial, 900.0 * 1.5, 0.005 * 900.0 * 1.5);
}

// Without air: v = c ln(m0 / m) - g' t along the rail, in closed form.
TEST(FreeFlight, LeavesTheRailAsInClosedForm) {
  FlightDefinition definition = FreeDefinition(70.0 * kRadPerDeg, 1.0);
  definition.vehicle.rail->length_m = 6.0;
  definition.vehicle.rail->friction = 0.2;
  std::vector<std::pair<double, double>> elevations;  // by time
  const FlightResult result = Watch(definition, Airless(), [&](const TickSample& s) {
    const Vector3 axis = Rotate(s.state.q_IB, Vector3(1.0, 0.0, 0.0));
    elevations.emplace_back(s.time_s, std::asin(axis.dot(s.state.p_EoC_I.normalized())));
  });
  const double t = MetricOf(result, "rail_exit_time_s"), v = MetricOf(result, "rail_exit_speed_m_s");
  const Stage& first = definition.vehicle.stages[0];
  const double flow = first.propellant_mass_kg / first.motor.burning_time_s, m0 = first.liftoff_mass_kg;
  const double c = first.motor.thrust_n / flow;
  const double r = 6378137.0, rate = 7.292115e-5;
  const double g = Gravitation(Wgs84(), Vector3(r, 0.0, 0.0)).norm() - rate * rate * r;  // on the equator
  const double against = g * (std::sin(70.0 * kRadPerDeg) + 0.2 * std::cos(70.0 * kRadPerDeg));
  const double m = m0 - flow * t;
  EXPECT_NEAR(v, c * std::log(m0 / m) - against * t, 1e-4);
  EXPECT_NEAR(c * t - c * m / flow * std::log(m0 / m) - 0.5 * against * t * t, 6.0, 1e-4);
  // Until it leaves, it points where the rail does, and the rail turns with the Earth.
  for (const auto& [time_s, elevation_rad] : elevations) {
    if (time_s >= t) break;
    EXPECT_NEAR(elevation_rad * kDegPerRad, 70.0, 1e-3);
  }
}

// A burn of 0.3 s, without air: v = c ln(m0 / m) - g' t to the burnout, and then g' alone. With a second
// stage, that waits, and without, when the burnout is the last.
struct ShortBurn {
  FlightDefinition definition = FreeDefinition(70.0 * kRadPerDeg, 1.0);
  double against_m_s2, speed_m_s, travel_m, burnt_s = 0.3;

  explicit ShortBurn(double rail_m, std::size_t stages = 2) {
    definition.course.ends = FlightEnd::kApogee;  // the last burnout may be on the rail
    Vehicle& vehicle = definition.vehicle;
    vehicle.rail->length_m = rail_m;
    vehicle.rail->friction = 0.2;
    vehicle.stages.resize(stages);
    vehicle.aerodynamics.resize(stages);
    Stage& first = vehicle.stages[0];
    first.separation_delay_s = 1.5;
    first.motor.thrust_n = 800e3;
    first.motor.burning_time_s = burnt_s;
    const double m0 = first.liftoff_mass_kg, m = m0 - first.propellant_mass_kg;
    const double flow = first.propellant_mass_kg / burnt_s, c = first.motor.thrust_n / flow;
    const double r = 6378137.0, rate = 7.292115e-5;
    const double g = Gravitation(Wgs84(), Vector3(r, 0.0, 0.0)).norm() - rate * rate * r;
    against_m_s2 = g * (std::sin(70.0 * kRadPerDeg) + 0.2 * std::cos(70.0 * kRadPerDeg));
    speed_m_s = c * std::log(m0 / m) - against_m_s2 * burnt_s;
    travel_m = c * burnt_s - c * m / flow * std::log(m0 / m) - 0.5 * against_m_s2 * Square(burnt_s);
  }
};

TEST(FreeFlight, SlidesOnAfterABurnoutOnTheRail) {
  for (const std::size_t stages : {1u, 2u}) {
    const ShortBurn burn(15.0, stages);
    ASSERT_LT(burn.travel_m, 10.0);
    const FlightResult result = Watch(burn.definition, Airless());
    EXPECT_EQ(result.outcome, Outcome::kCompleted) << result.reason;
    const double speed = std::sqrt(Square(burn.speed_m_s) - 2.0 * burn.against_m_s2 * (15.0 - burn.travel_m));
    EXPECT_NEAR(MetricOf(result, "rail_exit_speed_m_s"), speed, 1e-4) << stages;
    EXPECT_NEAR(MetricOf(result, "rail_exit_time_s"),
                burn.burnt_s + (burn.speed_m_s - speed) / burn.against_m_s2, 1e-5);
  }
}

// The vehicle's own failure, and where it ends up.
TEST(FreeFlight, WhatDoesNotGetOffTheRailFailsWithItsReason) {
  const auto reason = [](const FlightDefinition& definition) {
    const FlightResult result = Watch(definition, Airless());
    EXPECT_EQ(result.outcome, Outcome::kImpact);
    EXPECT_TRUE(std::isnan(MetricOf(result, "rail_exit_speed_m_s")));
    EXPECT_TRUE(std::isnan(MetricOf(result, "rail_exit_incidence_deg")));
    return result.reason;
  };
  ShortBurn burn(100.0, 1);
  char text[100];
  std::snprintf(
      text, sizeof text,
      "on its rail the vehicle stops and would slide back, %.2f m of 100.00 m from its foot, at %.1f s",
      burn.travel_m + 0.5 * Square(burn.speed_m_s) / burn.against_m_s2,
      burn.burnt_s + burn.speed_m_s / burn.against_m_s2);
  EXPECT_EQ(reason(burn.definition), text);
  ShortBurn weak(2.0, 1);
  weak.definition.vehicle.stages[0].motor.thrust_n = 60e3;
  EXPECT_EQ(reason(weak.definition),
            "on its rail the vehicle stays, 0.00 m of 2.00 m from its foot, at 0.3 s");
  ShortBurn parts(15.0);
  parts.definition.vehicle.stages[0].separation_delay_s = 0.1;
  const std::string parted = reason(parts.definition);
  EXPECT_EQ(parted.substr(0, 34), "on its rail the vehicle separates,") << parted;
}

// Up a vertical rail into a wind across it.
TEST(FreeFlight, MeasuresTheIncidenceOffTheRail) {
  FlightDefinition definition = FreeDefinition(90.0 * kRadPerDeg, 1.0);
  definition.vehicle.rail->length_m = 6.0;
  FlightInputs inputs = Airless();
  inputs.air.wind_max_speed_m_s = 12.0;
  inputs.air.wind_altitude_m = 0.0;
  inputs.air.wind_width_m = 50e3;
  const FlightResult result = Watch(definition, inputs);
  EXPECT_EQ(result.outcome, Outcome::kCompleted) << result.reason;
  EXPECT_NEAR(MetricOf(result, "rail_exit_incidence_deg"),
              std::atan2(12.0, MetricOf(result, "rail_exit_speed_m_s")) * kDegPerRad, 1e-3);
  EXPECT_TRUE(std::isnan(MetricOf(result, "alpha_max_deg")));  // there is no air
}

TEST(FreeFlight, StandsOnTheRailUntilThrustExceedsWeight) {
  FlightDefinition definition = FreeDefinition(90.0 * kRadPerDeg, 1.0);
  definition.vehicle.rail->length_m = 2.0;
  definition.vehicle.stages[0].motor.ignition_rise_s = 2.0;
  double radius_m = 0.0, cg_station_m = 0.0, moved_m = 0.0;
  const FlightResult result = Watch(definition, Airless(), [&](const TickSample& s) {
    if (s.time_s == 0.0) {
      radius_m = s.state.p_EoC_I.norm();
      cg_station_m = s.instant.cg_station_m;
    }
    if (s.time_s > 0.0 && s.time_s < 1.005 && s.instant.thrust_n < 0.95 * 9.78 * 13000.0) {
      EXPECT_LT((s.state.v_IC_I - Vector3(0.0, 0.0, 7.292115e-5).cross(s.state.p_EoC_I)).norm(), 1e-9);
      // The body stands still: its centre of gravity moves up it as propellant at its foot burns.
      moved_m = cg_station_m - s.instant.cg_station_m;
      EXPECT_NEAR(s.state.p_EoC_I.norm() - radius_m, moved_m, 1e-7);
    }
  });
  EXPECT_GT(moved_m, 1e-3);
  EXPECT_GT(MetricOf(result, "rail_exit_time_s"), 2.0 * 0.6);
}

// A rail of no length is none: it says how the vehicle stands, and nothing leaves it.
TEST(FreeFlight, ARailOfNoLengthHasNoExit) {
  const FlightDefinition definition = FreeDefinition(80.0 * kRadPerDeg, 1.0);
  EXPECT_FALSE(KindOf(definition.vehicle, definition.autopilot, definition.course).has_rail);
  const FlightResult result = Watch(definition, Airless());
  for (const char* name : {"rail_exit_time_s", "rail_exit_speed_m_s", "rail_exit_incidence_deg"})
    EXPECT_TRUE(std::isnan(MetricOf(result, name))) << name;
  FlightDefinition bare = definition;
  bare.vehicle.rail.reset();
  const FlightResult same = Watch(bare, Airless());
  EXPECT_EQ(result.digest.Hex(), same.digest.Hex());
}

// A rigid body without air, and a point mass: from the last burnout to the apogee.
TEST(FreeFlight, ReachesTheApogeeOfAPointMass) {
  FlightDefinition definition = FreeDefinition(85.0 * kRadPerDeg, 1.0);
  definition.vehicle.stages[1].motor.thrust_n = 20e3;
  const FlightResult burnout = Watch(definition, Airless());
  definition.course.ends = FlightEnd::kApogee;
  const FlightResult apogee = Watch(definition, Airless());
  ASSERT_EQ(apogee.outcome, Outcome::kCompleted) << apogee.reason;
  Environment none;
  none.density.scale = 0.0;
  const FallPath path =
      FollowFall(none, {1.0, 0.0}, {burnout.end_time_s, burnout.end_state.p_EoC_I, burnout.end_state.v_IC_I},
                 {.at_apogee = true});
  ASSERT_TRUE(path.apogee);
  // The engine looks at ticks: half a tick of a fall from rest is some 1e-4 m.
  EXPECT_NEAR(MetricOf(apogee, "apogee_altitude_km") * 1e3, path.apogee->altitude_m, 0.01);
  EXPECT_NEAR(MetricOf(apogee, "apogee_time_s"), path.apogee->time_s, 0.0051);
}

TEST(FreeFlight, FallsToTheGroundUnderAParachute) {
  FlightDefinition definition = FreeDefinition(85.0 * kRadPerDeg, 1.0);
  definition.course.ends = FlightEnd::kImpact;
  const FlightResult bare = Watch(definition, {});
  definition.vehicle.descent = {0.0, 80.0, 0.8, 4000.0, 0.0};
  const FlightResult slow = Watch(definition, {});
  ASSERT_EQ(slow.outcome, Outcome::kCompleted) << slow.reason;
  EXPECT_EQ(MetricOf(bare, "apogee_altitude_km"), MetricOf(slow, "apogee_altitude_km"));
  // m g = rho/2 v² CD A at the ground; the tumbling stage's own drag adds a little.
  const double m = 2000.0, area = 80.0 * 0.8 + TumblingCylinderDragArea(11.0, 1.0);
  EXPECT_NEAR(MetricOf(slow, "impact_speed_m_s"), std::sqrt(2.0 * m * 9.78 / (1.225 * area)), 0.1);
  EXPECT_GT(MetricOf(bare, "impact_speed_m_s"), 60.0);
  EXPECT_EQ(slow.end_time_s, MetricOf(slow, "impact_time_s"));
}

// CVODE solves the same equations with steps of its own.
TEST(FreeFlight, AgreesWithCvode) {
  FlightDefinition definition = FreeDefinition(80.0 * kRadPerDeg, 2.0);
  definition.course.ends = FlightEnd::kApogee;
  definition.vehicle.rail->length_m = 6.0;
  definition.vehicle.stages[0].motor.thrust_n = 600e3;
  definition.vehicle.stages[0].motor.burning_time_s = 20.0;
  definition.vehicle.stages[1].spin_motors = SpinMotors{900.0, 1.5};
  FlightInputs inputs;
  for (StageInputs& stage : inputs.stages) stage.thrust.misalignment_rad.magnitude = 0.1 * kRadPerDeg;
  inputs.air.wind_max_speed_m_s = 20.0;
  const FlightModel model(definition);
  FlightOptions options;
  const FlightResult engine = Fly(model, inputs, options);
  options.scheme = Scheme::kCvode;
  const FlightResult judge = Fly(model, inputs, options);
  ASSERT_EQ(engine.outcome, Outcome::kCompleted) << engine.reason;
  ASSERT_EQ(judge.outcome, Outcome::kCompleted) << judge.reason;
  EXPECT_NEAR(MetricOf(engine, "apogee_altitude_km"), MetricOf(judge, "apogee_altitude_km"), 1e-3);
  EXPECT_LT((engine.end_state.p_EoC_I - judge.end_state.p_EoC_I).norm(), 10.0);
}

TEST(FreeFlight, TurnsFasterThanStepsFollowIsNoResult) {
  FlightDefinition definition = FreeDefinition(85.0 * kRadPerDeg, 1.0);
  FlightInputs inputs = Airless();
  inputs.stages[0].tip_off_roll_rad_s = 32.5;  // the limit is 0.16 rad in 5 ms
  const FlightResult result = Watch(definition, inputs);
  EXPECT_EQ(result.outcome, Outcome::kNumericalFailure);
  EXPECT_EQ(result.reason, "turns faster than the integration's steps follow");
}

}  // namespace
}  // namespace dispersa::free_flight_test
