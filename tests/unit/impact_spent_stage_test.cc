// A spent stage by hand: its mass, and its position and velocity at separation, from a made-up history.
#include "core/campaign_yaml/load.h"
#include "core/flight/flight_model.h"
#include "core/impact/impact_points.h"
#include "core/math/constants.h"
#include "core/vehicle/mass.h"
#include "tests/liquid_stage.h"
#include "tests/test.h"

namespace dispersa::impact_spent_stage_test {
namespace {

// The shipped vehicle in calm air, stage 1 of which leaves; 40 km over the equator, flying east and up, its
// nose to the east. Then its axis is I's y, and its down I's -x.
struct Separation {
  Campaign campaign = [] {
    Campaign loaded = LoadCampaign(DISPERSA_CAMPAIGNS "/smoke.yaml");
    loaded.dispersions.clear();
    return loaded;
  }();
  double time_s = 75.0;
  double before_kg = 9000.0, after_kg = 8000.0;  // the flight's mass, of the stack before and of that above
  double yaw_rate_rad_s = 0.0;

  Vector3 Position() const { return {Wgs84().equatorial_radius_m + 40e3, 0.0, 0.0}; }
  Vector3 Velocity() const { return {900.0, 1800.0, 0.0}; }
  Stage& First() { return campaign.vehicle.stages[0]; }
  void Disperse(const std::string& input, double value) {
    Dispersion constant;
    constant.name = input;
    constant.distribution.values = {value};
    constant.inputs = {FindInput(input)};
    campaign.dispersions.push_back(constant);
  }

  History Rows() const {
    History history;
    for (const int stage : {1, 2}) {
      std::vector<double> row(HistoryColumns().size(), 0.0);
      const auto set = [&](const char* column, double value) {
        row[static_cast<std::size_t>(FindHistoryColumn(column))] = value;
      };
      set("time_s", time_s);
      set("stage", stage);
      set("mass_kg", stage == 1 ? before_kg : after_kg);
      set("yaw_deg", 90.0);
      set("r_deg_s", stage == 1 ? 0.0 : yaw_rate_rad_s * kDegPerRad);
      const Vector3 p = Position(), v = Velocity();
      set("eci_x_m", p.x());
      set("eci_y_m", p.y());
      set("eci_z_m", p.z());
      set("eci_vx_m_s", v.x());
      set("eci_vy_m_s", v.y());
      set("eci_vz_m_s", v.z());
      history.values.insert(history.values.end(), row.begin(), row.end());
    }
    return history;
  }
  std::vector<ImpactPoint> Points() const {
    CaseResult result;
    result.outcome = Outcome::kCompleted;
    return ImpactPoints(CampaignFlights(campaign), result, Rows());
  }
  // The impact of stage 1 for a given mass, a distance behind the stack above, and a velocity.
  Impact Falling(double mass_kg, double behind_m, const Vector3& v_m_s) const {
    Environment calm;
    const Stage &first = campaign.vehicle.stages[0], &second = campaign.vehicle.stages[1];
    const double length_m = first.bottom_station_m - second.bottom_station_m;
    return Fall(calm, {mass_kg, TumblingCylinderDragArea(length_m, first.diameter_m)},
                {time_s, Position() - Vector3(0.0, behind_m, 0.0), v_m_s})
        .value();
  }
};

// From the centre of gravity of the stack above, full, back to that of the empty stage.
double Behind(const Vehicle& vehicle) {
  double empty_m = 0.0;
  for (const MassElement& e : vehicle.stages[0].structure)
    empty_m += e.fraction * 0.5 * (e.top_station_m + e.bottom_station_m);
  const StackMass above = BuildStackMasses(vehicle)[1];
  return empty_m - above.At(above.propellant_mass_kg).cg_station_m;
}

double Distance(const Impact& a, const Impact& b) {
  return (FromGeodetic(Wgs84(), a.place) - FromGeodetic(Wgs84(), b.place)).norm();
}
// The made-up history has the attitude in degrees and the place as it is: rounding.
constexpr double kSame_m = 1e-3;

// One point, which is where a stage of that mass falls, and not where one of another mass does.
void ExpectMass(const Separation& separation, double mass_kg, double other_kg) {
  const std::vector<ImpactPoint> points = separation.Points();
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].stage, 1);
  EXPECT_FALSE(points[0].lost);
  EXPECT_EQ(points[0].from_time_s, separation.time_s);
  ASSERT_TRUE(points[0].impact);
  const double behind_m = Behind(separation.campaign.vehicle);
  EXPECT_LT(Distance(*points[0].impact, separation.Falling(mass_kg, behind_m, separation.Velocity())),
            kSame_m);
  EXPECT_GT(Distance(*points[0].impact, separation.Falling(other_kg, behind_m, separation.Velocity())),
            100.0);
}

TEST(SpentStage, OfASolidMotorIsEmpty) {
  const Separation separation;
  const double dry_kg = DryMass(separation.campaign.vehicle, 0);
  ExpectMass(separation, dry_kg, 1.1 * dry_kg);
}

TEST(SpentStage, KeepsTheResidualOfItsTanks) {
  Separation separation;
  MakeLiquid(separation.First());
  separation.First().motor.residual_mass_kg = 300.0;
  const double dry_kg = DryMass(separation.campaign.vehicle, 0);
  ExpectMass(separation, dry_kg + 300.0, dry_kg);
}

// Only the flight knows what an engine that is cut off at a velocity leaves: the mass that it loses as the
// stage goes.
TEST(SpentStage, CutOffAtAVelocityKeepsWhatTheFlightLost) {
  Separation separation;
  MakeLiquid(separation.First());
  separation.First().motor.cut_off = CutOff::kAtVelocity;
  separation.First().motor.cut_off_velocity_m_s = 1500.0;
  separation.before_kg = 9000.0;
  separation.after_kg = 6500.0;
  ExpectMass(separation, 2500.0, 9000.0);
}

TEST(SpentStage, HasItsDispersedMass) {
  Separation separation;
  separation.Disperse("dry_mass_factor_stage1", 1.2);
  const double dry_kg = DryMass(separation.campaign.vehicle, 0);
  ExpectMass(separation, 1.2 * dry_kg, dry_kg);
}

// Of the turning stack its own place moves at its own speed. The tip-off is of the stack above alone.
TEST(SpentStage, MovesWithTheTurningStackWithoutTheTipOff) {
  Separation separation;
  separation.yaw_rate_rad_s = 5.0 * kRadPerDeg;
  separation.Disperse("tip_off_yaw_stage1_deg_s", 2.0 * kRadPerDeg);
  const std::vector<ImpactPoint> points = separation.Points();
  ASSERT_EQ(points.size(), 1u);
  const double behind_m = Behind(separation.campaign.vehicle),
               dry_kg = DryMass(separation.campaign.vehicle, 0);
  // Yawing to the right, nose towards the south, throws the tail to the north.
  const Vector3 aside(0.0, 0.0, 3.0 * kRadPerDeg * behind_m);
  EXPECT_GT(aside.z(), 0.2);
  EXPECT_LT(Distance(*points[0].impact, separation.Falling(dry_kg, behind_m, separation.Velocity() + aside)),
            kSame_m);
}

TEST(SpentStage, IsNoneWhereTheEngineOnlyBurnsAgain) {
  Separation separation;
  MakeLiquid(separation.First());
  separation.campaign.vehicle.stages[1] = separation.First();
  separation.campaign.vehicle.stages[1].restarts = true;
  EXPECT_TRUE(separation.Points().empty());
}

// A step of the air's length in the air, of the vacuum's above: a fall through both takes as many as it
// should.
TEST(SpentStage, FallsInShortStepsThroughTheAir) {
  const Separation separation;
  const FallingBody light{500.0, 8.0};
  const FallState high{0.0, {Wgs84().equatorial_radius_m + 200e3, 0.0, 0.0}, {500.0, 3000.0, 0.0}};
  const auto with = [&](FallSteps steps) { return Fall(Environment{}, light, high, steps).value(); };
  const Impact exact = with({0.01, 0.01});
  // The error is that of the part of the fall with the long steps: of fourth order, next to nothing without
  // air.
  EXPECT_LT(Distance(with({0.01, 1.0}), exact), 0.1);
  EXPECT_GT(Distance(with({1.0, 0.01}), exact), 10.0 * Distance(with({0.01, 1.0}), exact));
}

// Each case has gusts of its own, and what falls meets them as the flight did.
TEST(SpentStage, FallsThroughTheTurbulenceOfItsCase) {
  Separation separation;
  separation.campaign = LoadCampaign(DISPERSA_CAMPAIGNS "/table3_turbulence.yaml");
  separation.campaign.dispersions.clear();
  separation.Disperse("turbulence_exceedance", 1e-3);
  separation.Disperse("turbulence_wind_20ft_m_s", 15.0);
  separation.Disperse("turbulence_scale", 1.0);
  const CampaignFlights flights(separation.campaign);
  const Vehicle& vehicle = separation.campaign.vehicle;
  const double length_m = vehicle.stages[0].bottom_station_m - vehicle.stages[1].bottom_station_m;
  for (const std::uint64_t index : {0u, 5u}) {
    CaseResult result;
    result.outcome = Outcome::kCompleted;
    result.case_index = index;
    const std::vector<ImpactPoint> points = ImpactPoints(flights, result, separation.Rows());
    ASSERT_EQ(points.size(), 1u);
    const auto falling = [&](std::uint64_t through) {
      const LauncherPlant plant = flights.model().PlantFor(flights.Draw(through), through);
      EXPECT_TRUE(plant.environment.turbulence);
      return Fall(plant.environment,
                  {DryMass(vehicle, 0), TumblingCylinderDragArea(length_m, vehicle.stages[0].diameter_m)},
                  {separation.time_s, separation.Position() - Vector3(0.0, Behind(vehicle), 0.0),
                   separation.Velocity()})
          .value();
    };
    EXPECT_LT(Distance(*points[0].impact, falling(index)), kSame_m);
    EXPECT_GT(Distance(*points[0].impact, falling(index + 1)), 1.0) << "another case's gusts lead elsewhere";
  }
}

}  // namespace
}  // namespace dispersa::impact_spent_stage_test
