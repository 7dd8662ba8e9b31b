// Guidance to orbits whose node and place of injection the target names. Misses are compared with conics that
// are written here. Flights end in the orbit that a state's two-body elements give.
#include "core/campaign/flight_definition.h"
#include "core/campaign_yaml/load.h"
#include "core/cases/campaign_flights.h"
#include "core/flight/orbit.h"
#include "core/guidance/orbit_miss.h"
#include "core/math/constants.h"
#include "core/trajectory/aim.h"
#include "core/trajectory/optimize.h"
#include "tests/gallery_launcher.h"
#include "tests/long.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa::guidance_orbit_target_test {
namespace {

constexpr double kMu = 3.986004418e14, kEquator_m = 6378137.0, kDeg = kRadPerDeg;

struct Conic {
  double axis_m = 24.4e6, eccentricity = 0.73, inclination_rad = 0.5, node_rad = 2.0, perigee_rad = 3.1;

  Injection At(double anomaly_rad) const {
    const double u = perigee_rad + anomaly_rad;
    const double r =
        axis_m * (1.0 - eccentricity * eccentricity) / (1.0 + eccentricity * std::cos(anomaly_rad));
    const double speed = std::sqrt(kMu * (2.0 / r - 1.0 / axis_m));
    const double angle =
        std::atan2(eccentricity * std::sin(anomaly_rad), 1.0 + eccentricity * std::cos(anomaly_rad));
    const Vector3 node(std::cos(node_rad), std::sin(node_rad), 0.0);
    const Vector3 across(-std::sin(node_rad) * std::cos(inclination_rad),
                         std::cos(node_rad) * std::cos(inclination_rad), std::sin(inclination_rad));
    const Vector3 outward = std::cos(u) * node + std::sin(u) * across;
    const Vector3 onward = -std::sin(u) * node + std::cos(u) * across;
    Injection injection;
    injection.radius_m = r;
    injection.p_EoC_I = r * outward;
    injection.v_IC_I = speed * (std::sin(angle) * outward + std::cos(angle) * onward);
    injection.at = {r - kEquator_m, speed, angle, inclination_rad};
    return injection;
  }
};

constexpr double kSpeed_m_s = 10000.0, kAnomaly_rad = 0.2;

GuidanceMission MissionTo(const Conic& conic, bool with_argument) {
  GuidanceMission mission;
  mission.target.velocity_m_s = kSpeed_m_s;
  mission.target.inclination_rad = conic.inclination_rad;
  mission.orbit = {conic.axis_m, conic.eccentricity, {}, kAnomaly_rad};
  if (with_argument) mission.orbit->argument_of_perigee_rad = conic.perigee_rad;
  mission.node_rad = conic.node_rad;
  return mission;
}

TEST(OrbitTarget, HasNoMissAtItsPlaceAlone) {
  const Conic conic;
  for (const bool with_argument : {true, false}) {
    const GuidanceMission mission = MissionTo(conic, with_argument);
    const OrbitMiss none = OrbitMissOf(mission, conic.At(kAnomaly_rad));
    for (const double miss :
         {none.energy_m_s, none.radial_m_s, none.shape_m_s, none.plane_m_s, none.node_m_s, none.place_m_s})
      EXPECT_NEAR(miss, 0.0, 1e-6);
    // Farther along: nothing else of the orbit is missed.
    for (const double farther_rad : {-0.02, 0.01, 3.0}) {
      const OrbitMiss miss = OrbitMissOf(mission, conic.At(kAnomaly_rad + farther_rad));
      EXPECT_NEAR(miss.place_m_s, kSpeed_m_s * farther_rad * (with_argument ? 1.0 : conic.eccentricity),
                  1e-5);
      for (const double other :
           {miss.energy_m_s, miss.radial_m_s, miss.shape_m_s, miss.plane_m_s, miss.node_m_s})
        EXPECT_NEAR(other, 0.0, 1e-6);
    }
  }
}

// Inclination and node together are the angle between the planes.
TEST(OrbitTarget, MissesAPlaneByTheAngleBetweenThePlanes) {
  const Conic conic;
  const GuidanceMission mission = MissionTo(conic, true);
  const auto normal = [](const Injection& injection) {
    return injection.p_EoC_I.cross(injection.v_IC_I).normalized();
  };
  for (const double by_rad : {-1e-3, 1e-3}) {
    Conic turned = conic;
    turned.node_rad += by_rad;
    turned.inclination_rad += 0.5e-3;
    const OrbitMiss miss = OrbitMissOf(mission, turned.At(kAnomaly_rad));
    const double between_rad =
        std::asin(normal(conic.At(kAnomaly_rad)).cross(normal(turned.At(kAnomaly_rad))).norm());
    EXPECT_NEAR(std::hypot(miss.plane_m_s, miss.node_m_s), kSpeed_m_s * between_rad, 0.01);
    EXPECT_GT(miss.node_m_s * by_rad, 0.0);
    EXPECT_NEAR(miss.place_m_s, 0.0, 1e-6) << "a place counts from the orbit's own node";
  }
  // A node of 359 degrees is near one of 1 degree.
  Conic before = conic, after = conic;
  before.node_rad = -1.0 * kDeg;
  after.node_rad = 1.0 * kDeg;
  EXPECT_NEAR(OrbitMissOf(MissionTo(after, true), before.At(kAnomaly_rad)).node_m_s,
              kSpeed_m_s * std::sin(conic.inclination_rad) * -2.0 * kDeg, 1e-6);
}

// What the search asks of an ellipse at a true anomaly is the state there.
TEST(OrbitTarget, AtATrueAnomalyIsAStateOfItsEllipse) {
  const Conic conic;
  TrajectoryProblem problem;
  problem.target_altitude_m = conic.axis_m * (1.0 - conic.eccentricity) - kEquator_m;
  problem.target_apogee_m = conic.axis_m * (1.0 + conic.eccentricity) - kEquator_m;
  problem.target_inclination_rad = conic.inclination_rad;
  problem.target_argument_of_perigee_rad = conic.perigee_rad;
  for (const double anomaly_rad : {-0.4, 0.0, 0.3, 2.5}) {
    problem.target_true_anomaly_rad = anomaly_rad;
    const AimedPlace place = PlaceAimedAt(problem);
    problem.target_velocity_m_s = place.velocity_m_s;
    problem.target_flight_path_angle_rad = place.flight_path_angle_rad;
    const Injection there = conic.At(anomaly_rad);
    Orbit orbit;
    orbit.radius_m = there.radius_m;
    orbit.altitude_m = there.at.altitude_m;
    orbit.velocity_m_s = there.at.velocity_m_s;
    orbit.flight_path_angle_rad = there.at.flight_path_angle_rad;
    orbit.inclination_rad = conic.inclination_rad;
    orbit.argument_of_latitude_rad = conic.perigee_rad + anomaly_rad;
    const OrbitErrors errors = ErrorsOf(problem, orbit);
    EXPECT_NEAR(errors.altitude_m, 0.0, 1e-5);
    EXPECT_NEAR(errors.velocity_m_s, 0.0, 1e-9);
    EXPECT_NEAR(errors.flight_path_angle_rad, 0.0, 1e-12);
    EXPECT_NEAR(errors.argument_of_perigee_rad, 0.0, 1e-12);
  }
}

struct Launched {
  Campaign campaign;
  CampaignFlights flights;
  FlightDefinition definition;
  OrbitElements nominal;  ///< of the open loop

  explicit Launched(const std::string& launcher)
      : campaign(GalleryLauncher(DISPERSA_CAMPAIGNS, launcher)),
        flights(campaign),
        definition(DefinitionOf(campaign)) {
    FlightDefinition open = definition;
    open.guidance.closed_loop = false;
    nominal = OrbitOf(Fly(FlightModel(open), {}));
  }
  static OrbitElements OrbitOf(const FlightResult& flight) {
    EXPECT_EQ(flight.outcome, Outcome::kCompleted) << flight.reason;
    return ElementsOf(Wgs84(), flight.end_state.p_EoC_I, flight.end_state.v_IC_I);
  }
  FlightInputs Drawn(std::uint64_t index) const { return DrawnWithoutErrorsOfTheVehicle(flights, index); }
};

// Of cases: a guided flight takes a second.
std::uint64_t Some(std::uint64_t all) { return IsLong() ? all : 1; }

double Apart_deg(double a_rad, double b_rad) { return std::remainder(a_rad - b_rad, kTwoPi) / kDeg; }

// A node beside the nominal one. A single burn meets it too: its yaw at the begin and at the end move the
// plane and the place where the planes cross.
class GuidedToANode : public testing::TestWithParam<const char*> {};

TEST_P(GuidedToANode, TurnsThePlane) {
  Launched launched(GetParam());
  FlightDefinition& definition = launched.definition;
  const double wanted_rad = launched.nominal.ascending_node_rad + 0.06 * kDeg;
  definition.target.node_rad = wanted_rad;
  const FlightModel model(definition);
  definition.target.node_rad.reset();
  const FlightModel without(definition);
  double farthest_deg = 0.0;
  for (std::uint64_t index = 0; index < Some(3); ++index) {
    SCOPED_TRACE(index);
    const FlightInputs inputs = launched.Drawn(index);
    const FlightResult flight = Fly(model, inputs), free = Fly(without, inputs);
    const OrbitElements orbit = Launched::OrbitOf(flight);
    std::printf("%s %d: node %9.5f deg, %9.5f without; inclination %8.5f deg, axis %8.3f m, converged %g\n",
                GetParam(), static_cast<int>(index), Apart_deg(orbit.ascending_node_rad, wanted_rad),
                Apart_deg(Launched::OrbitOf(free).ascending_node_rad, wanted_rad),
                MetricOf(flight, "inclination_error_deg"), 1e3 * MetricOf(flight, "semi_major_axis_error_km"),
                MetricOf(flight, "guidance_converged"));
    EXPECT_NEAR(Apart_deg(orbit.ascending_node_rad, wanted_rad), 0.0, 0.01);
    EXPECT_NEAR(MetricOf(flight, "node_error_deg"), Apart_deg(orbit.ascending_node_rad, wanted_rad), 1e-9);
    EXPECT_TRUE(std::isnan(MetricOf(free, "node_error_deg")));
    EXPECT_NEAR(MetricOf(flight, "inclination_error_deg"), 0.0, 0.01);
    EXPECT_EQ(MetricOf(flight, "guidance_converged"), 1.0);
    farthest_deg =
        std::fmax(farthest_deg, std::fabs(Apart_deg(Launched::OrbitOf(free).ascending_node_rad, wanted_rad)));
  }
  EXPECT_GT(farthest_deg, 0.05);
}

// One burn and two.
INSTANTIATE_TEST_SUITE_P(Gallery, GuidedToANode,
                         testing::ValuesIn(IsLong() ? std::vector{"electron", "vega", "falcon9"}
                                                    : std::vector{"electron", "vega"}),
                         [](const auto& launcher) { return std::string(launcher.param); });

// A node so far away that the burn before the last one turns at its bound, and the last one by 25 degrees.
// Plans of the coast's last seconds stay near each other: ignition does not walk away, nor wait for an
// attitude that each plan moves.
TEST(GuidedToAFarNode, WaitsForNoAttitudeThatPlansMove) {
  for (const double off_deg : {0.15, -0.15}) {
    Launched launched("vega");
    const double wanted_rad = launched.nominal.ascending_node_rad + off_deg * kDeg;
    launched.definition.target.node_rad = wanted_rad;
    const FlightModel model(launched.definition);
    for (std::uint64_t index = 0; index < Some(3); ++index) {
      SCOPED_TRACE(std::to_string(off_deg) + " deg, case " + std::to_string(index));
      const FlightResult flight = Fly(model, launched.Drawn(index));
      const double apart_deg = Apart_deg(Launched::OrbitOf(flight).ascending_node_rad, wanted_rad);
      std::printf(
          "node %+.2f deg off, case %d: missed by %8.5f deg, inclination %8.5f deg, postponed %g s, "
          "converged %g\n",
          off_deg, static_cast<int>(index), apart_deg, MetricOf(flight, "inclination_error_deg"),
          MetricOf(flight, "guidance_postponement_s"), MetricOf(flight, "guidance_converged"));
      EXPECT_EQ(MetricOf(flight, "guidance_converged"), 1.0);
      EXPECT_NEAR(apart_deg, 0.0, 0.012);
      EXPECT_NEAR(MetricOf(flight, "inclination_error_deg"), 0.0, 0.003);
      EXPECT_LT(MetricOf(flight, "guidance_postponement_s"), 20.0);
    }
  }
}

// Falcon 9's transfer orbit, with the true anomaly of the injection. With an argument of perigee the coast
// moves; without one the last burn turns the ellipse.
TEST(GuidedToAPlace, ByTheCoastOrByTheEllipsesTurn) {
  for (const bool with_argument : {true, false}) {
    SCOPED_TRACE(with_argument);
    Launched launched("falcon9");
    TargetOrbit& target = *launched.definition.target.orbit;
    const double wanted_rad = launched.nominal.true_anomaly_rad + (with_argument ? 1.0 : 0.3) * kDeg;
    target.true_anomaly_rad = wanted_rad;
    if (!with_argument) target.argument_of_perigee_rad.reset();
    const FlightModel model(launched.definition);
    for (std::uint64_t index = 0; index < Some(2); ++index) {
      SCOPED_TRACE(index);
      const FlightResult flight = Fly(model, launched.Drawn(index));
      const OrbitElements orbit = Launched::OrbitOf(flight);
      std::printf(
          "place %d, case %d: true anomaly %8.5f deg, perigee %9.4f km, ignition %+7.2f s, "
          "converged %g\n",
          with_argument, static_cast<int>(index), Apart_deg(orbit.true_anomaly_rad, wanted_rad),
          MetricOf(flight, "perigee_km"), MetricOf(flight, "guidance_ignition_shift_s"),
          MetricOf(flight, "guidance_converged"));
      EXPECT_NEAR(Apart_deg(orbit.true_anomaly_rad, wanted_rad), 0.0, 0.05);
      EXPECT_NEAR(MetricOf(flight, "true_anomaly_error_deg"), Apart_deg(orbit.true_anomaly_rad, wanted_rad),
                  1e-9);
      EXPECT_NEAR(MetricOf(flight, "perigee_km"), 185.0, 0.5);
      EXPECT_NEAR(MetricOf(flight, "apogee_km"), 35786.0, 2.0);
      EXPECT_EQ(MetricOf(flight, "guidance_converged"), 1.0);
      if (with_argument) {
        EXPECT_NEAR(MetricOf(flight, "argument_of_perigee_error_deg"), 0.0, 0.02);
      }
    }
  }
}

}  // namespace
}  // namespace dispersa::guidance_orbit_target_test
