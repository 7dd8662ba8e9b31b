// Loads of the first stage's sections beside boosters: the balance of what lies behind each section, by hand,
// with two unlike boosters, and the loads of the vehicle without boosters when they have left.
#include "core/dynamics/aero_grid.h"
#include "core/dynamics/jettison.h"
#include "core/flight/flight.h"
#include "core/flight/flight_model.h"
#include "core/flight/simpson_step.h"
#include "core/modes/load_table.h"
#include "core/vehicle/mass.h"
#include "tests/liquid_stage.h"
#include "tests/long.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa::booster_loads_test {
namespace {

constexpr double kDry_kg = 150.0, kPropellant_kg = 900.0, kRadius_m = 0.97, kThrust_n = 80e3,
                 kNozzle_m = 26.4, kTop_m = 21.0, kBottom_m = 26.5, kShell_m = 0.31, kSince_s = 5.0;
// Of the normal force, and how far the core's lies ahead of that of all.
constexpr double kCorePart = 0.6, kCoreAhead_m = 1.5;
constexpr double kAngles_rad[2] = {0.35, 2.2};
constexpr double kDryFactor[2] = {1.08, 0.95}, kThrustFactor[2] = {1.04, 0.93}, kLeft[2] = {0.9, 0.7};

FlightDefinition Boosted(double attachment_m, bool liquid) {
  FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS);
  Boosters& b = definition.vehicle.boosters;
  b = {2,         kDry_kg, kPropellant_kg,          kRadius_m, 2.0 * kShell_m, kTop_m, kBottom_m,
       kNozzle_m, {},      {22.0, 24.05, 0.6, 0.2}, 0.5};
  b.motor.thrust_n = kThrust_n;
  b.motor.burning_time_s = 30.0;
  b.angles_rad = {kAngles_rad[0], kAngles_rad[1]};
  b.attachment_station_m = attachment_m;
  if (liquid) MakeLiquid(b);
  definition.vehicle.stages[0].liftoff_mass_kg += b.LiftOffMass();
  const std::vector<StructProblem> problems = Problems(definition.vehicle);
  EXPECT_TRUE(problems.empty()) << problems[0].path << ": " << problems[0].message;
  return definition;
}

// A part of the vehicle: a body of revolution parallel to the axis, with its place: station, y, z.
struct Part {
  double kg, axial_kg_m2, across_kg_m2;
  Vector3 place;
};

// An instant of a vehicle, its boosters by hand. Nothing flows, so no momentum leaves: what each has left is
// given.
class Instant {
 public:
  // `turns`: in empty space. Else in air, at rest against the Earth's rotation.
  Instant(double attachment_m, bool liquid, bool turns, double sign, unsigned burning, bool apart_air = false)
      : definition_(Boosted(attachment_m, liquid)), burning_(burning) {
    FlightInputs inputs;
    for (std::size_t k = 0; k < 2; ++k) {
      inputs.further[k].booster.dry_mass_factor = kDryFactor[k];
      inputs.further[k].nozzle.thrust_factor = kThrustFactor[k];
    }
    plant = FlightModel(definition_).PlantFor(inputs);
    plant.jet_damping = plant.flow_coriolis = false;
    if (apart_air) {
      part_ = kCorePart;
      ahead_m_ = kCoreAhead_m;
      AeroVariant core{kBoostersGone, false, plant.stacks[0].aerodynamics, nullptr};
      for (double& cn : core.body.cn.table.z) cn *= part_;
      for (double& xcp_m : core.body.xcp_station_m.table.z) xcp_m -= ahead_m_;
      core.grid = std::make_shared<const AeroGrid>(BuildAeroGrid(core.body));
      plant.stacks[0].aero_variants = std::make_shared<const std::vector<AeroVariant>>(1, core);
    }
    const auto hold = [](MotorBurn& burn, double left) {
      burn.full_flow_kg_s = 0.0;
      burn.curve = nullptr;
      burn.propellant_mass_kg *= left;
    };
    hold(plant.stacks[0].burn, 0.6);
    BoosterSet set = *plant.boosters;
    for (std::size_t k = 0; k < 2; ++k) {
      hold(set.each[k].burn, kLeft[k]);
      set.each[k].along = Vector3(0.999, sign * (k == 0 ? 0.03 : -0.01), sign * 0.02);
    }
    plant.boosters = std::make_shared<const BoosterSet>(std::move(set));

    const Earth& earth = plant.environment.earth;
    RigidBodyState s;
    s.p_EoC_I = FromGeodetic(earth, {0.4, 1.1, turns ? 2e6 : 9e3});
    s.q_IB = FromRotationVector(Vector3(0.3, -1.2, 0.4));
    const Vector3 rate_I(0.0, 0.0, earth.rotation_rate_rad_s);
    s.v_IC_I = rate_I.cross(s.p_EoC_I) + Rotate(s.q_IB, Vector3(400.0, sign * 9.0, sign * -14.0));
    s.w_IB_B = turns ? Vector3(0.0, sign * 0.3, -0.2) : Rotate(Inverse(s.q_IB), rate_I);
    WriteState(s, y.data());
    for (int i = 0; i < kNozzles; ++i)
      y[static_cast<std::size_t>(kNozzleAngle + i)] = sign * (i < 2 ? 0.02 : -0.01);
    rate_ = s.w_IB_B;

    LauncherPhase phase;
    phase.burning = true;
    phase.boosters_burning = burning;
    std::array<double, kLauncherSize> dydt{};
    LauncherModel model(plant);
    model.Derivative(phase, kSince_s, y.data(), dydt.data());
    const LauncherInstant now = model.Evaluate(phase, kSince_s, y.data());
    force_n_ = now.loads.force_n;
    specific_ = force_n_ / now.loads.mass_kg;
    turning_ = Vector3(dydt[10], dydt[11], dydt[12]);
    // The centre of gravity by hand.
    Vector3 first = Vector3::Zero();
    double kg = 0.0;
    for (const Part& part : All()) kg += part.kg, first += part.kg * part.place;
    cg_ = first / kg;
    EXPECT_NEAR(kg, now.loads.mass_kg, 1e-9 * kg);
    EXPECT_NEAR(cg_.x(), now.cg_station_m, 1e-9);
    EXPECT_GT(std::hypot(cg_.y(), cg_.z()), 0.02);
  }

  // The engine's, where the table has this station alone (below 0: all of them).
  lanes::LargestMoment<double> Engine(int station) const {
    LauncherPlant one = plant;
    if (station >= 0) {
      LoadTable table = *plant.stacks[0].loads;
      const std::size_t i = static_cast<std::size_t>(station);
      table.station_m[0] = table.station_m[i];
      table.first_kg_m[0] = table.first_kg_m[i];
      table.second_kg_m2[0] = table.second_kg_m2[i];
      table.slender_arm_m[0] = table.slender_arm_m[i];
      table.shift_arm[0] = table.shift_arm[i];
      table.stations = 1;
      one.stacks[0].loads = std::make_shared<const LoadTable>(table);
    }
    static const FlightWeather calm;
    auto step = std::make_unique<lanes::StepState<double>>();
    step->Configure(one, 0.01);
    step->StartFlight(0, calm, y.data());
    step->SetStack(0, one, 0);
    step->Ignite(0, 0.0, true);
    for (int k = 0; k < 2; ++k)
      if (!(burning_ >> k & 1u)) step->BurnOutBooster(0, k);
    step->EvaluateStart(kSince_s);
    air_ = step->now().normal;
    return step->LargestMomentNow(0.0);
  }

  // Of what lies behind a section: forces there less what accelerates the masses there, about the axis at the
  // section. Of air only where Engine() has been asked.
  Vector3 Behind(double station_m) const {
    Vector3 moment = Vector3::Zero();
    Vector3 core_n = force_n_;
    const auto force = [&](const Vector3& at, const Vector3& f) {
      moment += Vector3(station_m - at.x(), at.y(), at.z()).cross(f);
    };
    const bool carries = station_m >= definition_.vehicle.boosters.attachment_station_m;
    for (std::size_t k = 0; k < 2; ++k) {
      if (!(burning_ >> k & 1u)) continue;
      const Vector3 push = kThrust_n * kThrustFactor[k] * plant.boosters->each[k].along;
      core_n -= push;
      if (!carries)
        force(Vector3(kNozzle_m, kRadius_m * std::cos(kAngles_rad[k]), kRadius_m * std::sin(kAngles_rad[k])),
              push);
    }
    const LiftDistribution& lift = plant.stacks[0].loads->lift;
    const Vector3 air_n = -air_.normal_n * Vector3(0.0, air_.across_y, air_.across_z);
    core_n -= air_n;
    const double core_m = air_.xcp_station_m - ahead_m_;
    for (const LiftPiece& piece : lift.pieces) {
      const double share =
          piece.area_to - piece.area_from + (core_m - lift.slender_station_m) * piece.shift_1_m;
      if (piece.Middle() > station_m) force(Vector3(piece.Middle(), 0.0, 0.0), part_ * share * air_n);
    }
    if (!carries && part_ < 1.0)
      force(Vector3((air_.xcp_station_m - part_ * core_m) / (1.0 - part_), 0.0, 0.0), (1.0 - part_) * air_n);
    // What is left besides the drag, which acts along the axis.
    force(Vector3(definition_.vehicle.stages[0].gimbal.pivot_station_m, 0.0, 0.0), core_n);
    std::vector<Part> parts = CoreBehind(station_m);
    if (!carries)
      for (const Part& part : OfBoosters()) parts.push_back(part);
    for (const Part& part : parts) {
      const Vector3 r(cg_.x() - part.place.x(), part.place.y() - cg_.y(), part.place.z() - cg_.z());
      const Vector3 accelerated = specific_ + turning_.cross(r) + rate_.cross(rate_.cross(r));
      force(part.place, -part.kg * accelerated);
      const Vector3 inertia(part.axial_kg_m2, part.across_kg_m2, part.across_kg_m2);
      moment -= inertia.cwiseProduct(turning_) + rate_.cross(Vector3(inertia.cwiseProduct(rate_)));
    }
    return moment;
  }

  LauncherPlant plant;
  std::array<double, kLauncherSize> y{};

 private:
  // Shells, and grains or liquids as MakeLiquid makes them.
  std::vector<Part> OfBoosters() const {
    std::vector<Part> parts;
    for (std::size_t k = 0; k < 2; ++k) {
      const double y_m = kRadius_m * std::cos(kAngles_rad[k]), z_m = kRadius_m * std::sin(kAngles_rad[k]);
      const double shell2 = kShell_m * kShell_m, length_m = kBottom_m - kTop_m,
                   dry_kg = kDry_kg * kDryFactor[k];
      parts.push_back({dry_kg, dry_kg * shell2, dry_kg * (0.5 * shell2 + length_m * length_m / 12.0),
                       Vector3(0.5 * (kTop_m + kBottom_m), y_m, z_m)});
      if (!(burning_ >> k & 1u)) continue;  // spent
      const double kg = kLeft[k] * kPropellant_kg;
      const Boosters& b = definition_.vehicle.boosters;
      for (const Tank& tank : b.tanks) {
        const double in_kg = kLeft[k] * tank.propellant_mass_kg;
        const double height_m = 0.9 * (tank.bottom_station_m - tank.top_station_m) * kLeft[k];
        parts.push_back({in_kg, 0.0,
                         in_kg * (tank.diameter_m * tank.diameter_m / 16.0 + height_m * height_m / 12.0),
                         Vector3(tank.bottom_station_m - 0.5 * height_m, y_m, z_m)});
      }
      if (b.is_liquid()) continue;
      const double outer2 = 0.09, inner2 = outer2 - kLeft[k] * (outer2 - 0.01), grain_m = 24.05 - 22.0;
      parts.push_back({kg, 0.5 * kg * (outer2 + inner2),
                       kg * (0.25 * (outer2 + inner2) + grain_m * grain_m / 12.0),
                       Vector3(0.5 * (22.0 + 24.05), y_m, z_m)});
    }
    return parts;
  }
  // The parts of tubes on the axis that lie behind a station.
  std::vector<Part> CoreBehind(double station_m) const {
    std::vector<Part> parts;
    const auto tube = [&](double kg, double top_m, double bottom_m, double outer_m, double inner2_m2) {
      const double from_m = std::max(top_m, station_m), length_m = bottom_m - from_m;
      if (length_m <= 0.0) return;
      kg *= length_m / (bottom_m - top_m);
      const double gyration2 = 0.25 * (0.25 * outer_m * outer_m + inner2_m2);
      parts.push_back({kg, 2.0 * kg * gyration2, kg * (gyration2 + length_m * length_m / 12.0),
                       Vector3(0.5 * (from_m + bottom_m), 0.0, 0.0)});
    };
    const Vehicle& vehicle = definition_.vehicle;
    for (std::size_t i = 0; i < vehicle.stages.size(); ++i) {
      const Stage& stage = vehicle.stages[i];
      for (const MassElement& e : stage.structure)
        tube(DryMass(vehicle, static_cast<int>(i)) * e.fraction, e.top_station_m, e.bottom_station_m,
             e.outer_diameter_m, 0.25 * e.inner_diameter_m * e.inner_diameter_m);
      const Grain& g = stage.grain;
      const double kg = i == 0 ? plant.stacks[0].burn.propellant_mass_kg : stage.propellant_mass_kg;
      const double inner2 = 0.25 * g.outer_diameter_m * g.outer_diameter_m -
                            kg / (kPi * PropellantDensity(stage) * (g.bottom_station_m - g.top_station_m));
      tube(kg, g.top_station_m, g.bottom_station_m, g.outer_diameter_m, inner2);
    }
    return parts;
  }
  std::vector<Part> All() const {
    std::vector<Part> parts = CoreBehind(-1.0);
    for (const Part& part : OfBoosters()) parts.push_back(part);
    return parts;
  }

  FlightDefinition definition_;
  unsigned burning_;
  double part_ = 1.0, ahead_m_ = 0.0;  // of the air that acts on the core
  Vector3 rate_, turning_, specific_, force_n_, cg_;
  mutable lanes::NormalForce<double> air_{};
};

// The core's own formula for a section; of the boosters nothing is told for a section behind their
// attachment. Liquid boosters and solid ones in each case; both of them in all cases in the long test.
TEST(BoosterLoads, HoldTheBalanceOfWhatLiesBehindTheSection) {
  for (const double attachment_m : {12.5, 23.0})
    for (const bool liquid : {false, true})
      for (const bool turns : {false, true})
        for (const double sign : {1.0, -1.0})
          for (const unsigned burning : {3u, 2u}) {
            if (!IsLong() && liquid != (turns == (sign > 0.0))) continue;
            const Instant now(attachment_m, liquid, turns, sign, burning, burning == 3u || sign > 0.0);
            const LoadTable& table = *now.plant.stacks[0].loads;
            ASSERT_GT(table.stations, 10);
            double largest = 0.0, at_m = 0.0;
            int carry = 0;
            for (int i = 0; i < table.stations; ++i) {
              const double station_m = table.station_m[static_cast<std::size_t>(i)];
              const double engine = now.Engine(i).moment_n_m;
              const Vector3 behind = now.Behind(station_m);
              const double size = std::hypot(behind.y(), behind.z());
              EXPECT_NEAR(engine, size, 1e-3)  // of up to 1e5 N m
                  << attachment_m << liquid << turns << sign << burning << ", " << station_m << " m";
              carry += station_m >= attachment_m;
              if (size > largest) largest = size, at_m = station_m;
            }
            EXPECT_GT(carry, 0);
            EXPECT_LT(carry, table.stations);
            EXPECT_GT(largest, 1e3);
            const lanes::LargestMoment<double> found = now.Engine(-1);
            EXPECT_NEAR(found.moment_n_m, largest, 1e-3);
            EXPECT_EQ(found.station_m, at_m);
          }
}

// The separation leaves the loads of a vehicle that never had boosters.
TEST(BoosterLoads, OfTheVehicleWithoutBoostersWhenTheyHaveLeft) {
  for (const double sign : {1.0, -1.0}) {
    const Instant boosted(23.0, false, false, sign, 3u);
    FlightDefinition bare = Boosted(23.0, false);
    bare.vehicle.stages[0].liftoff_mass_kg -= bare.vehicle.boosters.LiftOffMass();
    bare.vehicle.boosters = {};
    LauncherPlant alone = BuildNominalPlant(bare.vehicle);
    alone.jet_damping = alone.flow_coriolis = false;
    alone.stacks[0].burn = boosted.plant.stacks[0].burn;
    // The stations are chosen for other loads.
    LoadTable at_same = BuildLoadTable(bare.vehicle, 0, boosted.plant.stacks[0].loads.get());
    alone.stacks[0].loads = std::make_shared<const LoadTable>(at_same);
    static const FlightWeather calm;
    const auto largest = [&](const LauncherPlant& plant, bool drops) {
      auto step = std::make_unique<lanes::StepState<double>>();
      step->Configure(plant, 0.01);
      step->StartFlight(0, calm, boosted.y.data());
      step->SetStack(0, plant, 0);
      step->Ignite(0, 0.0, plant.boosters != nullptr);
      if (drops) {
        for (int k = 0; k < 2; ++k) step->BurnOutBooster(0, k);
        step->DropBoosters(0);
        step->SetMass(0, MassOf(plant, 0, kBoostersGone), nullptr);
      }
      step->EvaluateStart(kSince_s);
      return step->LargestMomentNow(0.0);
    };
    const lanes::LargestMoment<double> left = largest(boosted.plant, true), never = largest(alone, false),
                                       with = largest(boosted.plant, false);
    EXPECT_NEAR(left.moment_n_m, never.moment_n_m, 1e-9 * never.moment_n_m);
    EXPECT_EQ(left.station_m, never.station_m);
    EXPECT_GT(std::fabs(with.moment_n_m / never.moment_n_m - 1.0), 0.05);
  }
}

// Of lanes side by side, each has the loads that it has alone.
TEST(BoosterLoads, OfALaneAreThoseThatItHasAlone) {
  using Four = lanes::Pack<4>;
  const Instant boosted(23.0, false, false, 1.0, 3u);
  const LauncherPlant& plant = boosted.plant;
  static const FlightWeather calm;
  const auto prepare = [&](auto& step, int lane, bool drops) {
    step.StartFlight(lane, calm, boosted.y.data());
    step.SetStack(lane, plant, 0);
    step.Ignite(lane, 0.0, true);
    if (!drops) return;
    for (int k = 0; k < 2; ++k) step.BurnOutBooster(lane, k);
    step.DropBoosters(lane);
    step.SetMass(lane, MassOf(plant, 0, kBoostersGone), nullptr);
  };
  const double seen_n_m[4] = {0.0, 1e9, 0.0, 1e9};
  auto four = std::make_unique<lanes::StepState<Four>>();
  four->Configure(plant, 0.01);
  for (int lane = 0; lane < 4; ++lane) prepare(*four, lane, lane >= 2);
  four->EvaluateStart(Four(kSince_s));
  Four seen(0.0);
  for (int lane = 0; lane < 4; ++lane) lanes::Lane(seen, lane) = seen_n_m[lane];
  const lanes::LargestMoment<Four> side_by_side = four->LargestMomentNow(seen);
  for (int lane = 0; lane < 4; ++lane) {
    auto one = std::make_unique<lanes::StepState<double>>();
    one->Configure(plant, 0.01);
    prepare(*one, 0, lane >= 2);
    one->EvaluateStart(kSince_s);
    const lanes::LargestMoment<double> alone = one->LargestMomentNow(seen_n_m[lane]);
    EXPECT_EQ(lanes::Lane(side_by_side.moment_n_m, lane), alone.moment_n_m) << lane;
    EXPECT_EQ(lanes::Lane(side_by_side.station_m, lane), alone.station_m) << lane;
  }
}

// A beam a hundred times as stiff as SLV-4's moves with its masses as the rigid body does.
TEST(BoosterLoads, OfAStiffBeamAreThoseOfTheRigidBody) {
  const Vehicle bends = LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4_flexible.yaml");
  const auto largest = [&](double stiffer) {
    FlightDefinition definition = Boosted(23.0, false);
    if (stiffer > 0.0) {
      StructureBeam& beam = definition.vehicle.structure_beam.emplace(*bends.structure_beam);
      beam.flown_modes = 2;
      for (BeamStage& stage : beam.stages)
        for (BeamSection& section : stage.sections) section.modulus_pa *= stiffer;
    }
    FlightInputs inputs;
    inputs.air.gust_speed_m_s = 9.0;
    inputs.air.gust_altitude_m = 1500.0;
    inputs.air.gust_length_m = 200.0;
    const FlightModel model(definition);
    const FlightResult flown = Fly(model, inputs);
    EXPECT_EQ(flown.outcome, Outcome::kCompleted) << flown.reason;
    return MetricOf(flown, "bending_moment_max_n_m");
  };
  const double rigid = largest(0.0), stiff = largest(100.0), less = largest(10.0);
  EXPECT_GT(rigid, 1e4);
  EXPECT_NEAR(stiff, rigid, 0.001 * rigid);  // 3e-4 above; ten times as stiff 1.5e-2
  EXPECT_GT(std::fabs(less - rigid), 2.0 * std::fabs(stiff - rigid));
}

}  // namespace
}  // namespace dispersa::booster_loads_test
