// The look-up and propagation of flights, against their definitions.
#include "core/dynamics/actuators.h"
#include "core/dynamics/air_data.h"
#include "core/dynamics/integrator.h"
#include "core/dynamics/launcher_lanes.h"
#include "core/environment/surroundings.h"
#include "core/math/constants.h"
#include "core/random/draws.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa::lane_models_test {
namespace {

TEST(AirTable, IsWithinItsToleranceOfTheStandardEverywhere) {
  double pressure = 0.0, density = 0.0, sound = 0.0;
  for (double z = -5000.0; z <= 1.0e6; z += 7.3) {
    const AirState air = StandardAtmosphere1976(z);
    const lanes::AirPressure<double> looked_up = lanes::AirAt(StandardAir(), z);
    pressure = std::max(pressure, std::fabs(looked_up.pressure_pa / air.pressure_pa - 1.0));
    density =
        std::max(density, std::fabs(looked_up.pressure_pa / looked_up.energy_j_kg / air.density_kg_m3 - 1.0));
    sound = std::max(sound, std::fabs(Sqrt(1.4 * looked_up.energy_j_kg) / air.speed_of_sound_m_s - 1.0));
  }
  EXPECT_LT(pressure, kAirTableTolerance);
  EXPECT_LT(density, kAirTableTolerance);
  // The root of an energy as exact as the density.
  EXPECT_LT(sound, 0.5 * kAirTableTolerance);
}

// The row that a lane has kept is the one that it would find: also next to its edges, from either side.
TEST(AirTable, AKeptRowChangesNoBit) {
  lanes::AirRows<double> kept;
  kept.range.Forget(0);
  std::vector<double> altitudes;
  for (const double edge : StandardAir().edges)
    for (const double z : {edge, std::nextafter(edge, -1e9), edge, std::nextafter(edge, 1e9)})
      altitudes.push_back(z);
  const std::vector<double> up = altitudes;
  altitudes.insert(altitudes.end(), up.rbegin(), up.rend());
  for (const double z : altitudes) {
    const lanes::AirPressure<double> air = lanes::AirAt(lanes::AirTables<double>{}, z, kept);
    const lanes::AirPressure<double> anew = lanes::AirAt(StandardAir(), z);
    EXPECT_EQ(air.pressure_pa, anew.pressure_pa) << z;
    EXPECT_EQ(air.energy_j_kg, anew.energy_j_kg) << z;
  }
}

TEST(AirTable, HoldsWhatTheStandardDoesOutside) {
  EXPECT_EQ(lanes::AirAt(StandardAir(), -9000.0).pressure_pa,
            lanes::AirAt(StandardAir(), -5000.0).pressure_pa);
  EXPECT_EQ(lanes::AirAt(StandardAir(), 1.1e6).pressure_pa, 0.0);
  EXPECT_GT(lanes::AirAt(StandardAir(), 1.1e6).energy_j_kg, 0.0);
}

TEST(Surroundings, AreThoseOfTheDefinitions) {
  Environment environment;
  environment.wind.jets = {{60.0, 12000.0, 11000.0, 4.0}};
  environment.wind.gusts = {{9.0, 5000.0, 800.0, 1.0}};
  environment.wind.tables = {{{0.0, 4000.0, 15000.0}, {1.0, -5.0, 8.0}, {2.0, 9.0, -3.0}},
                             {{1000.0, 20000.0}, {0.5, 2.5}, {-4.0, 1.0}}};
  environment.wind.steady = {0.3, -0.2};
  environment.density = {1.05, {{0.0, 10000.0, 40000.0}, {0.9, 1.1, 1.0}}};
  const FlightWeather prepared =
      PrepareWeather(environment.wind, environment.density, {}, environment.turbulence.get());
  lanes::FlownWeather<double> weather;
  lanes::SetWeather(weather, 0, prepared);
  Stream draws(3, 0, "places");
  for (int k = 0; k < 20000; ++k) {
    const Geodetic place = {kPi * (draws.Uniform() - 0.5), kTwoPi * (draws.Uniform() - 0.5),
                            120e3 * draws.Uniform() - 500.0};
    const Vector3 p = FromGeodetic(environment.earth, place);
    const AirData air = ComputeAirData(environment, p, Vector3::Zero());
    const AirData calm = [&] {
      Environment still = environment;
      still.wind = {};
      return ComputeAirData(still, p, Vector3::Zero());
    }();
    const auto here = lanes::SurroundingsAt<double>(environment.earth, weather, {p.x(), p.y(), p.z()});
    // Rounding of coordinates of 6e6 m, which is 1e-9 m, and 1e-13 of the air at that.
    ASSERT_NEAR(here.altitude_m, place.altitude_m, 1e-8);
    ASSERT_NEAR(here.pressure_pa, air.pressure_pa, 3e-12 * air.pressure_pa);
    ASSERT_NEAR(here.density_kg_m3, air.density_kg_m3, 5e-12 * air.density_kg_m3);
    ASSERT_NEAR(here.inverse_sound_s_m, 1.0 / air.speed_of_sound_m_s, 3e-12 / air.speed_of_sound_m_s);
    const Vector3 wind = calm.v_AP_I - air.v_AP_I;
    // Winds of 60 m/s whose slopes are 0.07 1/s (the gust's) over the altitude's rounding.
    ASSERT_LT((Vector3(here.wind_m_s.x, here.wind_m_s.y, here.wind_m_s.z) - wind).norm(), 1e-9)
        << place.altitude_m;
    const Vector3 g = Gravitation(environment.earth, p);
    ASSERT_LT((Vector3(here.gravitation_m_s2.x, here.gravitation_m_s2.y, here.gravitation_m_s2.z) - g).norm(),
              1e-14 * g.norm());
  }
}

// The shipped vehicle's build-up, and a body whose tables share no breakpoint.
TEST(AeroGrid, IsTheTablesThemselves) {
  std::vector<BodyAerodynamics> bodies;
  for (const LauncherStack& stack :
       BuildNominalPlant(LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml")).stacks)
    bodies.push_back(stack.aerodynamics);
  BodyAerodynamics mixed = bodies[0];
  mixed.cd.table = {{0.3, 0.9, 4.0}, {0.05, 0.4}, {0.1, 0.2, 0.3, 0.7, 0.5, 0.6}};
  mixed.cl.table = {{0.0, 7.0}, {0.0, 0.3, 1.0}, {0.0, 1.0, 0.5, 0.2, 1.4, 0.9}};
  mixed.cnr.table = {{0.0, 2.0}, {0.0, 1.0}, {-1.0, -1.0, -3.0, -3.0}};
  bodies.push_back(mixed);
  Stream draws(4, 0, "flow");
  for (const BodyAerodynamics& body : bodies) {
    const AeroGrid grid = BuildAeroGrid(body);
    lanes::BodyInFlow<double> one;
    lanes::SetBody(one, 0, body, grid);
    for (int k = 0; k < 5000; ++k) {
      const double mach = 12.0 * draws.Uniform() * draws.Uniform(),
                   incidence = kPi * draws.Uniform() * draws.Uniform();
      const auto c = lanes::CoefficientsAt(one, mach, incidence);
      // Rows of powers of the whole argument lose a few digits to cancellation.
      const auto expect = [&](double value, const Coefficient& table, double at_incidence) {
        const double expected = table.empty() ? 0.0 : table.table(mach, at_incidence);
        ASSERT_NEAR(value, expected, 1e-12 * std::max(1.0, std::fabs(expected)))
            << mach << " " << at_incidence;
      };
      expect(c.ca, body.ca, incidence);
      expect(c.cn, body.cn, incidence);
      expect(c.xcp_station_m, body.xcp_station_m, incidence);
      expect(c.cd, body.cd, incidence);
      expect(c.cl, body.cl, incidence);
      expect(c.cmq, body.cmq, 0.0);
      expect(c.clp, body.clp, 0.0);
      expect(c.cnr, body.cnr, 0.0);
    }
  }
}

// A strip of a bent body takes the normal force by this slope.
TEST(AeroGrid, TheSlopeOfTheNormalForceIsItsDerivative) {
  BodyAerodynamics body =
      BuildNominalPlant(LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml")).stacks[0].aerodynamics;
  body.cn.factor = 1.3;
  const AeroGrid grid = BuildAeroGrid(body);
  lanes::BodyInFlow<double> one;
  lanes::SetBody(one, 0, body, grid);
  Stream draws(8, 0, "flow");
  int within = 0;
  for (int k = 0; k < 2000; ++k) {
    constexpr double kStep_rad = 1e-6;
    const double mach = 10.0 * draws.Uniform(), incidence = 0.01 + 0.5 * draws.Uniform();
    const auto cn = [&](double at) { return lanes::CoefficientsAt(one, mach, at).cn; };
    const double up = (cn(incidence + kStep_rad) - cn(incidence)) / kStep_rad,
                 down = (cn(incidence) - cn(incidence - kStep_rad)) / kStep_rad;
    if (std::fabs(up - down) > 1e-6) continue;  // between two cells of the table
    ++within;
    // Rounding of cn up to 10 over a microradian.
    EXPECT_NEAR(lanes::CoefficientsAt(one, mach, incidence).cn_slope_1_rad, up, 1e-6);
  }
  EXPECT_GT(within, 1500);
}

// One drive from rest under a command, by SUNDIALS on its derivative, and by the engine in steps of half a
// tick.
struct OneDrive {
  lanes::Actuators<double> drives{};
  double command_rad;

  explicit OneDrive(double command, double rate_limit, double damping_ratio) : command_rad(command) {
    Gimbal gimbal;
    gimbal.limit_rad = 0.1;
    gimbal.rate_limit_rad_s = rate_limit;
    gimbal.bandwidth_rad_s = 40.0;
    gimbal.damping_ratio = damping_ratio;
    lanes::SetActuators(drives, 0, gimbal, -1);
  }
  static void Rhs(double, const double* y, double* dydt, void* context) {
    const auto* self = static_cast<const OneDrive*>(context);
    lanes::DriveRates(self->drives, 0, self->command_rad, y[0], y[1], dydt[0], dydt[1]);
  }
  lanes::DriveState<double> Propagated(double step_s, int steps) const {
    const double commands[kNozzles] = {command_rad, 0.0, 0.0, 0.0};
    const auto over = lanes::TransitionOver(drives.bandwidth2_1_s2, drives.twice_damping_1_s, step_s);
    lanes::DriveState<double> state{};
    for (int i = 0; i < steps; ++i) state = lanes::Propagate(drives, commands, over, step_s, state);
    return state;
  }
};

TEST(Actuators, AreExactBelowTheirLimitsForAnyDamping) {
  for (const double damping : {0.3, 0.7, 1.0, 1.6}) {
    OneDrive drive(0.02, 10.0, damping);
    double y[2] = {0.0, 0.0};
    const double tolerances[2] = {1e-16, 1e-16};
    Integrator cvode(Scheme::kCvode, 2, &OneDrive::Rhs, &drive, tolerances);
    ASSERT_TRUE(cvode.Advance(0.0, 0.1, 1, y));
    const auto state = drive.Propagated(0.005, 20);
    // CVODE's relative tolerance of 1e-12, some hundred steps.
    EXPECT_NEAR(state.angle_rad[0], y[0], 1e-11) << damping;
    EXPECT_NEAR(state.rate_rad_s[0], y[1], 1e-9) << damping;
  }
}

TEST(Actuators, NeverExceedTheirRateAndComeToRestAtTheStop) {
  const double limit = 0.5;
  OneDrive drive(0.3, limit, 0.7);  // commanded beyond the stop at 0.1 rad
  double fastest = 0.0;
  for (int steps = 1; steps <= 200; ++steps) {
    const auto state = drive.Propagated(0.005, steps);
    fastest = std::max(fastest, std::fabs(state.rate_rad_s[0]));
    ASSERT_LE(std::fabs(state.rate_rad_s[0]), limit);
    ASSERT_LE(state.angle_rad[0], 0.1);
  }
  EXPECT_EQ(fastest, limit) << "the limit was to be met";
  // At the limit the drive moves at constant rate: from 20 ms, when it has long been there, to 100 ms.
  const double moved = drive.Propagated(0.005, 20).angle_rad[0] - drive.Propagated(0.005, 10).angle_rad[0];
  EXPECT_NEAR(moved, 0.05 * limit, 1e-9);
  const auto end = drive.Propagated(0.005, 200);
  EXPECT_NEAR(end.angle_rad[0], 0.1, 1e-6);
}

TEST(Actuators, TheMechanicalStopTakesTheRate) {
  OneDrive drive(0.0999, 10.0, 0.1);  // overshoots the stop
  bool stopped = false;
  for (int steps = 1; steps <= 100; ++steps) {
    const auto state = drive.Propagated(0.005, steps);
    ASSERT_LE(state.angle_rad[0], 0.1);
    if (state.angle_rad[0] == 0.1) {
      EXPECT_EQ(state.rate_rad_s[0], 0.0);
      stopped = true;
    }
  }
  EXPECT_TRUE(stopped);
}

}  // namespace
}  // namespace dispersa::lane_models_test
