// Columns of a history against what flew, computed from other columns and by hand: two stages, the first with
// two nozzles that differ and boosters that differ, the second with a cross of four that differ.
#include "core/environment/earth.h"
#include "core/flight/history.h"
#include "core/math/constants.h"
#include "tests/flown_history.h"
#include "tests/test.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::history_columns_test {
namespace {

constexpr double kBooster_n = 20e3, kBooster_kg_s = 25.0, kFactors[] = {1.1, 0.9};

FlightDefinition Definition() {
  FlightDefinition definition = HighDefinition();  // in next to no air
  definition.program.knots = {{.time_s = 0.0, .pitch = 1.0}, {.time_s = 200.0, .pitch = 1.0}};
  Vehicle& vehicle = definition.vehicle;
  vehicle.flow_coriolis = false;
  vehicle.stages[0].gimbal.nozzles = {{"small", -0.75, 0.0, 0.4, {0.5 * kPi, kPi}, 0.0},
                                      {"large", 0.5, 0.0, 0.6, {0.5 * kPi, kPi}, 0.0}};
  Boosters& b = vehicle.boosters;
  b.count = 2;
  b.dry_mass_kg = 100.0;
  b.propellant_mass_kg = 500.0;
  b.radius_m = 0.9;
  b.diameter_m = 0.5;
  b.top_station_m = 13.0;
  b.bottom_station_m = 19.0;
  b.nozzle_station_m = 19.2;
  b.separation_delay_s = 0.5;
  b.grain = {13.2, 17.6, 0.45, 0.1};
  b.motor.thrust_n = kBooster_n;
  b.motor.burning_time_s = b.propellant_mass_kg / kBooster_kg_s;
  b.angles_rad = {0.0, kPi};
  vehicle.stages[0].liftoff_mass_kg += b.LiftOffMass();
  return definition;
}

FlightInputs Inputs() {
  FlightInputs inputs;
  const double factor[2][kNozzles] = {{0.95, 1.1, 1.0, 1.0}, {1.04, 0.9, 1.0, 1.01}};
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t k = 0; k < kNozzles; ++k) inputs.stages[i].nozzles[k].thrust_factor = factor[i][k];
  for (std::size_t k = 0; k < 2; ++k)
    inputs.further[k].nozzle.thrust_factor = inputs.further[k].nozzle.flow_factor = kFactors[k];
  return inputs;
}

// One row, by names.
class Row {
 public:
  Row(const History& history, std::size_t row) : history_(history), row_(row) {}
  double operator[](const char* name) const { return history_.at(row_, FindHistoryColumn(name)); }
  double Rad(const char* name) const { return (*this)[name] * kRadPerDeg; }

 private:
  const History& history_;
  std::size_t row_;
};

// f(row) of the rows in between two times.
void ForEach(double from_s, double to_s, const std::function<void(const Row&)>& f) {
  static const Flown flown = FlyWith(FlightModel(Definition()), Inputs(), Scheme::kSimpson, 1);
  ASSERT_EQ(flown.result.outcome, Outcome::kCompleted) << flown.result.reason;
  int seen = 0;
  for (std::size_t i = 0; i < flown.history.rows(); ++i) {
    const Row row(flown.history, i);
    if (!(row["time_s"] > from_s && row["time_s"] < to_s)) continue;
    f(row);
    ++seen;
  }
  EXPECT_GT(seen, 20);
}

constexpr double kFirst_n = 200e3 * (0.4 * 0.95 + 0.6 * 1.1);
constexpr double kSecond_n[] = {12.5e3 * 1.04, 12.5e3 * 0.9, 12.5e3 * 1.0, 12.5e3 * 1.01};

TEST(HistoryColumns, ThrustIsThatOfAllNozzlesThatBurn) {
  const double ends_s[] = {20.0 / kFactors[0], 20.0 / kFactors[1]};
  ForEach(0.0, 39.9, [&](const Row& row) {
    double thrust_n = kFirst_n;
    for (int k = 0; k < 2; ++k) {
      if (std::fabs(row["time_s"] - ends_s[k]) < 0.02) return;
      if (row["time_s"] < ends_s[k]) thrust_n += kFactors[k] * kBooster_n;
    }
    EXPECT_NEAR(row["thrust_n"], thrust_n, 1e-6 * thrust_n) << row["time_s"];
    EXPECT_EQ(row["stage"], 1.0);
  });
  ForEach(40.1, 59.9, [](const Row& row) { EXPECT_EQ(row["thrust_n"], 0.0); });
  ForEach(60.1, 79.9, [](const Row& row) {
    EXPECT_NEAR(row["thrust_n"], kSecond_n[0] + kSecond_n[1] + kSecond_n[2] + kSecond_n[3], 0.05);
    EXPECT_EQ(row["stage"], 2.0);
  });
}

TEST(HistoryColumns, MassIsWhatTheFlowsHaveLeft) {
  ForEach(0.0, 18.0, [](const Row& row) {
    const double flow_kg_s = 100.0 + kBooster_kg_s * (kFactors[0] + kFactors[1]);
    EXPECT_NEAR(row["mass_kg"] + row["rcs_propellant_kg"], 14200.0 - flow_kg_s * row["time_s"], 1e-6);
  });
  ForEach(23.0, 39.9, [](const Row& row) {
    EXPECT_NEAR(row["mass_kg"] + row["rcs_propellant_kg"], 13000.0 - 100.0 * row["time_s"], 1e-6);
  });
  ForEach(60.1, 79.9, [](const Row& row) {
    EXPECT_NEAR(row["mass_kg"] + row["rcs_propellant_kg"], 3000.0 - 50.0 * (row["time_s"] - 60.0), 1e-6);
  });
}

// The second stage's forces follow from its four nozzles. The first one's second hinges have no columns.
TEST(HistoryColumns, LoadsAreThoseOfTheNozzlesWhereTheyStand) {
  ForEach(1.0, 39.9, [](const Row& row) {
    const double along = row["axial_load_g"] * row["mass_kg"] * kStandardGravity / row["thrust_n"];
    EXPECT_LE(along, 1.0 + 1e-9);
    EXPECT_GT(along, 0.999);
  });
  ForEach(60.1, 79.9, [](const Row& row) {
    const char* const names[] = {"nozzle1_deg", "nozzle2_deg", "nozzle3_deg", "nozzle4_deg"};
    double x_n = 0.0, y_n = 0.0, z_n = 0.0, sum[4];
    for (int i = 0; i < 4; ++i) {
      const double angle = row.Rad(names[i]);
      sum[i] = row[names[i]];
      x_n += kSecond_n[i] * std::cos(angle);
      (i < 2 ? z_n : y_n) += (i < 2 ? 1.0 : -1.0) * kSecond_n[i] * std::sin(angle);
    }
    const double weight_n = row["mass_kg"] * kStandardGravity;
    EXPECT_NEAR(row["axial_load_g"], x_n / weight_n, 1e-6);
    EXPECT_NEAR(row["lateral_load_g"], std::hypot(y_n, z_n) / weight_n, 1e-6);
    EXPECT_NEAR(row["deflection_pitch_deg"], 0.5 * (sum[0] + sum[1]), 1e-9);
    EXPECT_NEAR(row["deflection_yaw_deg"], 0.5 * (sum[2] + sum[3]), 1e-9);
    EXPECT_NEAR(row["deflection_roll_deg"], 0.25 * (sum[0] - sum[1] + sum[2] - sum[3]), 1e-9);
  });
}

TEST(HistoryColumns, PlacesAndSpeedsAreThoseOfTheInertialState) {
  const Earth earth = Wgs84();
  ForEach(1.0, 79.9, [&](const Row& row) {
    const Vector3 p(row["eci_x_m"], row["eci_y_m"], row["eci_z_m"]);
    const Vector3 v(row["eci_vx_m_s"], row["eci_vy_m_s"], row["eci_vz_m_s"]);
    EXPECT_NEAR(row["inertial_velocity_m_s"], v.norm(), 1e-8);
    EXPECT_NEAR(row.Rad("flight_path_angle_deg"), std::asin(p.dot(v) / (p.norm() * v.norm())), 1e-9);
    // From the place on the ellipsoid, which turns.
    const double lat = row.Rad("latitude_deg");
    const double lon = row.Rad("longitude_deg") + earth.rotation_rate_rad_s * row["time_s"];
    const double a = earth.equatorial_radius_m, f = 1.0 / 298.257223563, e2 = f * (2.0 - f);
    const double n = a / std::sqrt(1.0 - e2 * std::sin(lat) * std::sin(lat)), h = row["altitude_m"];
    const Vector3 place((n + h) * std::cos(lat) * std::cos(lon), (n + h) * std::cos(lat) * std::sin(lon),
                        (n * (1.0 - e2) + h) * std::sin(lat));
    EXPECT_LT((place - p).norm(), 1e-3);
    const Vector3 over_ground = v - Vector3(0.0, 0.0, earth.rotation_rate_rad_s).cross(p);
    const Vector3 north(-std::sin(lat) * std::cos(lon), -std::sin(lat) * std::sin(lon), std::cos(lat));
    const Vector3 east(-std::sin(lon), std::cos(lon), 0.0);
    EXPECT_NEAR(row["ned_v_n_m_s"], over_ground.dot(north), 1e-6);
    EXPECT_NEAR(row["ned_v_e_m_s"], over_ground.dot(east), 1e-6);
    EXPECT_NEAR(row["ned_v_d_m_s"], over_ground.dot(north.cross(east)), 1e-6);
  });
}

// No wind: the air turns with the Earth.
TEST(HistoryColumns, IncidenceIsBetweenTheAxisAndTheWayThroughTheAir) {
  ForEach(1.0, 79.9, [](const Row& row) {
    const double cy = std::cos(row.Rad("yaw_deg")), sy = std::sin(row.Rad("yaw_deg"));
    const double cp = std::cos(row.Rad("pitch_deg")), sp = std::sin(row.Rad("pitch_deg"));
    const double cr = std::cos(row.Rad("roll_deg")), sr = std::sin(row.Rad("roll_deg"));
    const Vector3 v(row["ned_v_n_m_s"], row["ned_v_e_m_s"], row["ned_v_d_m_s"]);
    const Vector3 x(cp * cy, cp * sy, -sp), y(sr * sp * cy - cr * sy, sr * sp * sy + cr * cy, sr * cp),
        z(cr * sp * cy + sr * sy, cr * sp * sy - sr * cy, cr * cp);
    EXPECT_NEAR(row.Rad("alpha_deg"), std::atan2(v.dot(z), v.dot(x)), 1e-7);
    EXPECT_NEAR(row.Rad("beta_deg"), std::asin(v.dot(y) / v.norm()), 1e-7);
    EXPECT_NEAR(row.Rad("incidence_deg"), std::acos(v.dot(x) / v.norm()), 1e-6);
    EXPECT_NEAR(row["pitch_program_deg"], 1.0 * kDegPerRad, 1e-9);
  });
  // Nothing else turns it: small errors are differences of angles.
  ForEach(61.0, 79.9, [](const Row& row) {
    EXPECT_NEAR(row["pitch_error_deg"], row["pitch_launch_deg"] - row["pitch_program_deg"], 2e-3);
  });
}

}  // namespace
}  // namespace dispersa::history_columns_test
