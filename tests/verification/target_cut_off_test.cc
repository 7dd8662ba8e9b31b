// cut_off: {at: target}, and ellipses that are entered anywhere: energies and elements are those of the
// two-body problem, and an engine is cut off in the target's orbit whatever the flight was.
#include "core/campaign/flight_definition.h"
#include "core/campaign_yaml/load.h"
#include "core/cases/campaign_flights.h"
#include "core/guidance/orbit_miss.h"
#include "core/math/constants.h"
#include "core/trajectory/aim.h"
#include "core/trajectory/ascent.h"
#include "core/trajectory/optimize.h"
#include "core/vehicle/cut_off.h"
#include "tests/gallery_launcher.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa::target_cut_off_test {
namespace {

constexpr double kMu = 3.986004418e14, kEquator_m = 6378137.0;

// An orbit at a true anomaly, its node at the x axis. Written here from the conic section.
struct Conic {
  double axis_m, eccentricity, inclination_rad, perigee_rad;

  double Radius(double anomaly_rad) const {
    return axis_m * (1.0 - eccentricity * eccentricity) / (1.0 + eccentricity * std::cos(anomaly_rad));
  }
  double Speed(double anomaly_rad) const {
    return std::sqrt(kMu * (2.0 / Radius(anomaly_rad) - 1.0 / axis_m));
  }
  double PathAngle(double anomaly_rad) const {
    return std::atan2(eccentricity * std::sin(anomaly_rad), 1.0 + eccentricity * std::cos(anomaly_rad));
  }
  Orbit At(double anomaly_rad) const {
    Orbit orbit;
    orbit.radius_m = Radius(anomaly_rad);
    orbit.altitude_m = orbit.radius_m - kEquator_m;
    orbit.velocity_m_s = Speed(anomaly_rad);
    orbit.flight_path_angle_rad = PathAngle(anomaly_rad);
    orbit.inclination_rad = inclination_rad;
    orbit.argument_of_latitude_rad = perigee_rad + anomaly_rad;
    return orbit;
  }
  Injection InjectionAt(double anomaly_rad) const {
    const double u = perigee_rad + anomaly_rad, r = Radius(anomaly_rad), angle = PathAngle(anomaly_rad);
    const Vector3 across(0.0, std::cos(inclination_rad), std::sin(inclination_rad));
    const Vector3 outward = Vector3(std::cos(u), 0.0, 0.0) + std::sin(u) * across;
    const Vector3 onward = Vector3(-std::sin(u), 0.0, 0.0) + std::cos(u) * across;
    Injection injection;
    injection.radius_m = r;
    injection.p_EoC_I = r * outward;
    injection.v_IC_I = Speed(anomaly_rad) * (std::sin(angle) * outward + std::cos(angle) * onward);
    injection.at = {r - kEquator_m, Speed(anomaly_rad), angle, inclination_rad};
    return injection;
  }
};
Conic Transfer() {
  const double perigee_m = kEquator_m + 185e3, apogee_m = kEquator_m + 35786e3;
  return {0.5 * (perigee_m + apogee_m), (apogee_m - perigee_m) / (apogee_m + perigee_m), 0.5, 3.1};
}
TrajectoryProblem ToTransfer() {
  TrajectoryProblem problem;
  problem.target_altitude_m = 185e3;
  problem.target_apogee_m = 35786e3;
  problem.target_inclination_rad = 0.5;
  problem.target_argument_of_perigee_rad = 3.1;
  problem.is_entered_anywhere = true;
  return problem;
}

TEST(CutOffAtTarget, IsTheSpeedOfTheOrbitAtEachPlace) {
  Vehicle vehicle;
  vehicle.stages.resize(1);
  Motor& engine = vehicle.stages[0].motor;
  engine.cut_off = CutOff::kAtTarget;
  EXPECT_EQ(CutOffSpeed(engine, 7e6, 6e5), HUGE_VAL);
  AimAt(ToTransfer(), vehicle);
  const Conic conic = Transfer();
  for (const double anomaly : {-1.0, 0.0, 0.3, 2.0, kPi}) {
    const double r = conic.Radius(anomaly), angle = conic.PathAngle(anomaly), v = conic.Speed(anomaly);
    EXPECT_NEAR(CutOffSpeed(engine, r, r - kEquator_m), v, 1e-8 * v);
    // Along a coast the speed follows by gravity alone.
    EXPECT_NEAR(CutOffSpeedRate(engine, r, 0.0, v * std::sin(angle)), -kMu / (r * r) * std::sin(angle), 1e-9);
  }
}

// A target of a speed at an altitude: at another altitude above the same place, what a coast would leave of
// it.
TEST(CutOffAtTarget, OfASpeedAtAnAltitudeIsCarriedThereByEnergy) {
  Vehicle vehicle;
  vehicle.stages.resize(1);
  Motor& engine = vehicle.stages[0].motor;
  engine.cut_off = CutOff::kAtTarget;
  TrajectoryProblem problem;
  problem.target_altitude_m = 500e3;
  problem.target_velocity_m_s = 7612.6;
  AimAt(problem, vehicle);
  const double ground_m = 6360e3;  // of a place near a pole
  EXPECT_NEAR(CutOffSpeed(engine, ground_m + 500e3, 500e3), 7612.6, 1e-9);
  const double low = CutOffSpeed(engine, ground_m + 480e3, 480e3);
  EXPECT_NEAR(0.5 * low * low - kMu / (ground_m + 480e3), 0.5 * 7612.6 * 7612.6 - kMu / (ground_m + 500e3),
              1e-4);
  problem.velocity_is_free = true;
  engine.aimed_energy = {};
  AimAt(problem, vehicle);
  EXPECT_EQ(CutOffSpeed(engine, 7e6, 6e5), HUGE_VAL);
}

TEST(EnteredAnywhere, HasNoErrorAllAlongItsOrbit) {
  const Conic conic = Transfer();
  for (const double anomaly : {-1.0, 0.0, 0.02, 2.0}) {
    const OrbitErrors none = ErrorsOf(ToTransfer(), conic.At(anomaly));
    EXPECT_NEAR(none.altitude_m, 0.0, 1e-3);
    EXPECT_NEAR(none.velocity_m_s, 0.0, 1e-7);
    EXPECT_EQ(none.flight_path_angle_rad, 0.0);
    EXPECT_NEAR(none.argument_of_perigee_rad, 0.0, 1e-9);
    Conic other = conic;
    other.perigee_rad += 0.01;
    EXPECT_NEAR(ErrorsOf(ToTransfer(), other.At(anomaly)).argument_of_perigee_rad, 0.01, 1e-9);
    // With the same energy the perigee rises by a times what the eccentricity falls by.
    other = conic;
    other.eccentricity -= 1e-4;
    EXPECT_NEAR(ErrorsOf(ToTransfer(), other.At(anomaly)).altitude_m, 1e-4 * conic.axis_m, 0.1);
    EXPECT_NEAR(ErrorsOf(ToTransfer(), other.At(anomaly)).velocity_m_s, 0.0, 1e-7);
  }
}

// Guidance's misses of the same orbit: none along it, and the eccentricity vector's turn for another perigee.
TEST(EnteredAnywhere, HasNoMissAllAlongItsOrbit) {
  const Conic conic = Transfer();
  GuidanceMission mission;
  mission.target.velocity_m_s = 10000.0;
  mission.target.inclination_rad = conic.inclination_rad;
  mission.orbit = {conic.axis_m, conic.eccentricity, conic.perigee_rad};
  for (const double anomaly : {-0.5, 0.0, 0.02, 1.0}) {
    const OrbitMiss none = OrbitMissOf(mission, conic.InjectionAt(anomaly));
    for (const double miss : {none.energy_m_s, none.radial_m_s, none.shape_m_s, none.plane_m_s})
      EXPECT_NEAR(miss, 0.0, 1e-6) << anomaly;
    Conic turned = conic;
    turned.perigee_rad += 1e-3;
    const OrbitMiss miss = OrbitMissOf(mission, turned.InjectionAt(anomaly));
    EXPECT_NEAR(std::hypot(miss.radial_m_s, miss.shape_m_s), 1e-3 * conic.eccentricity * 10000.0, 1e-3);
    // Where any perigee does, none of that is a miss.
    GuidanceMission any = mission;
    any.orbit->argument_of_perigee_rad.reset();
    const OrbitMiss of_any = OrbitMissOf(any, turned.InjectionAt(anomaly));
    EXPECT_NEAR(std::hypot(of_any.radial_m_s, of_any.shape_m_s), 0.0, 1e-6);
    Conic rounder = conic;
    rounder.eccentricity -= 1e-3;
    const OrbitMiss of_shape = OrbitMissOf(any, rounder.InjectionAt(anomaly));
    EXPECT_NEAR(std::hypot(of_shape.radial_m_s, of_shape.shape_m_s), 10.0, 1e-3);
  }
}

// Electron with at: target. Whatever the program and the case, the axis is the target's when the engine is
// cut off: in the ascent of the optimiser, and in flight under the reference's attitude.
TEST(CutOffAtTarget, EndsInAnOrbitOfTheTargetsAxis) {
  Campaign campaign = GalleryLauncher(DISPERSA_CAMPAIGNS, "electron");
  campaign.vehicle.stages.back().motor.cut_off = CutOff::kAtTarget;
  campaign.guidance.closed_loop = false;
  const TrajectoryProblem& problem = campaign.reference.problem;
  const double axis_m = EllipseOf(problem).semi_major_axis_m;
  AscentModel model = BuildAscentModel(campaign.vehicle, campaign.autopilot.tick_s);
  AimAt(problem, model.vehicle);
  for (const double off : {-0.05, 0.0, 0.05}) {
    FlightProgram program = campaign.reference.program;
    program.alpha_max_rad += off * kRadPerDeg;
    const AscentResult ascent = FlyAscent(model, program, {});
    ASSERT_TRUE(ascent.completed);
    ASSERT_TRUE(std::isfinite(ascent.cut_off_s.at(1)));
    EXPECT_NEAR(PlaceOf(ascent.orbit).semi_major_axis_m, axis_m, 0.01) << off;
  }
  const CampaignFlights flights(campaign);
  const FlightModel flight(DefinitionOf(campaign));
  for (std::uint64_t index = 0; index < 3; ++index) {
    const FlightResult flown = Fly(flight, DrawnWithoutErrorsOfTheComputer(flights, index));
    ASSERT_EQ(flown.outcome, Outcome::kCompleted);
    // A tick's extrapolation of the speed: millimetres a second. 1 mm/s is 2 m of axis.
    const double flown_m =
        kEquator_m + 500.0 * (MetricOf(flown, "perigee_km") + MetricOf(flown, "apogee_km"));
    EXPECT_NEAR(flown_m, axis_m, 2.0) << index;
  }
}

TEST(CutOffAtTarget, IsOfTheLastBurn) {
  Vehicle vehicle = LoadVehicle(DISPERSA_CAMPAIGNS "/gallery/electron/vehicle.yaml");
  vehicle.stages[0].motor.cut_off = CutOff::kAtTarget;
  const std::vector<StructProblem> problems = Problems(vehicle);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].path, "stages[0].motor.liquid.cut_off.at");
  EXPECT_EQ(problems[0].message,
            "is target, but another burn follows: this one does not end in the target orbit");
}

}  // namespace
}  // namespace dispersa::target_cut_off_test
