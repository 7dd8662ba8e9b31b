// A stack that bends and jettisons a body, or burns again: its modes, what is left of its motion, and flights
// against CVODE.
#include "core/campaign_yaml/load.h"
#include "core/dynamics/jettison.h"
#include "core/flight/flight.h"
#include "core/flight/tick_sample.h"
#include "core/modes/beam_source.h"
#include "core/structure/free_body.h"
#include "core/vehicle/mass.h"
#include "tests/flown_ticks.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa::jettison_bending_test {
namespace {

// SLV-4 that bends, with a part of its last stage's mass as a fairing on the payload's adapter, whose nose
// reaches beyond the beam.
Vehicle WithFairing(double mass_kg, double time_s = 100.0) {
  Vehicle vehicle = LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4_flexible.yaml");
  vehicle.stages[3].jettisoned = {
      {"fairing", mass_kg, 0.1, 1.65, 0.5, 0.48, JettisonTrigger::kAtTime, time_s}};
  LumpedMass fairing;
  fairing.name = fairing.element = "fairing";
  fairing.station_m = 1.65;
  vehicle.structure_beam->stages[3].lumped_masses.push_back(fairing);
  return vehicle;
}

LauncherPlant PlantOf(const Vehicle& vehicle) {
  LauncherPlant plant = BuildNominalPlant(vehicle);
  AddBending(vehicle, 0.01, plant);
  return plant;
}

TEST(JettisonedBending, HasTheModesOfAVehicleThatNeverHadTheBody) {
  constexpr double kFairing_kg = 60.0;
  const Vehicle with = WithFairing(kFairing_kg);
  ASSERT_TRUE(Problems(with).empty()) << Problems(with)[0].path << Problems(with)[0].message;
  Vehicle without = with;
  without.stages[3].jettisoned.clear();
  without.structure_beam->stages[3].lumped_masses.pop_back();
  for (Stage& stage : without.stages) stage.liftoff_mass_kg -= kFairing_kg;
  const std::vector<StackModes> bare = BuildBendingModes(without);
  for (std::size_t stage = 0; stage < 4; ++stage) {
    const StackModes whole = BuildStackModes(with, static_cast<int>(stage)),
                     left = BuildStackModes(with, static_cast<int>(stage), 1u);
    for (std::size_t level = 0; level < bare[stage].levels[0].size(); ++level)
      for (std::size_t mode = 0; mode < 3; ++mode) {
        const BendingMode &expected = bare[stage].levels[0][level].modes[mode],
                          &found = left.levels[0][level].modes[mode];
        EXPECT_NEAR(found.frequency_rad_s, expected.frequency_rad_s, 1e-9 * expected.frequency_rad_s);
        EXPECT_NEAR(found.generalized_mass_kg, expected.generalized_mass_kg,
                    1e-8 * expected.generalized_mass_kg);
        // Less mass, no lower frequency.
        EXPECT_GT(found.frequency_rad_s, whole.levels[0][level].modes[mode].frequency_rad_s * (1.0 - 1e-12))
            << stage << level << mode;
      }
  }
}

// Momentum and angular momentum of the masses that stay, from the moments of a section behind them all at two
// places: sums of m (s - x) w and of m g² theta.
TEST(JettisonedBending, LeavesTheMassesTheirMomentum) {
  const Vehicle vehicle = WithFairing(60.0);
  const LauncherPlant plant = PlantOf(vehicle);
  constexpr int kStage = 1;
  const LauncherStack& stack = plant.stacks[kStage];
  const StackModes whole = BuildStackModes(vehicle, kStage);
  const BendingLevel& burnt = whole.levels[0].back();
  ASSERT_EQ(burnt.propellant_kg, 0.0);
  const BeamMasses rest = BuildBeamMasses(vehicle, kStage, 0.0, 1u);
  const MassProperties mass = MassOf(plant, kStage, 1u).At(0.0);
  for (int plane = 0; plane < kPlanes; ++plane)
    for (int mode = 0; mode < 3; ++mode) {
      const auto shape = [&](double s) {
        return ShapeOf(whole, BeamPlane::kY, burnt.modes[static_cast<std::size_t>(mode)], s);
      };
      const double near_m = 25.0, far_m = 26.0;  // behind all of it
      const double near = InertiaMoment(MassPointsOf(rest, whole.station_m[0]), near_m, AtStations(shape)),
                   far = InertiaMoment(MassPointsOf(rest, whole.station_m[0]), far_m, AtStations(shape));
      const double momentum = (far - near) / (far_m - near_m);
      const double angular = near_m * momentum - near - mass.cg_station_m * momentum;
      double modal[2 * kPlanes * kModes] = {};
      const double q_m = 0.003, rate_m_s = -0.2;
      modal[plane * kModes + mode] = q_m;
      modal[(kPlanes + plane) * kModes + mode] = rate_m_s;
      RigidBodyState state;
      state.q_IB = FromRotationVector(Vector3(0.3, -0.7, 1.1));
      const RigidBodyState before = state;
      LetGoBent(stack, 0u, 1u, 0.0, modal, state);
      const ModalPassage passage = stack.modes->Passage(0u, 1u, 0.0);
      for (int k = 0; k < 3; ++k) {
        const double onto = passage.onto[plane][k][mode];
        EXPECT_DOUBLE_EQ(modal[plane * kModes + k], onto * q_m);
        EXPECT_DOUBLE_EQ(modal[(kPlanes + plane) * kModes + k], onto * rate_m_s);
      }
      const Vector3 along = plane == 0 ? Vector3::UnitY() : Vector3::UnitZ(),
                    about = plane == 0 ? Vector3(-Vector3::UnitZ()) : Vector3(Vector3::UnitY());
      const double move = momentum / mass.mass_kg, turn = angular / mass.transverse_inertia_kg_m2;
      EXPECT_GT(std::fabs(move), 1e-3);
      const auto expect = [&](const Vector3& found, const Vector3& wanted, const char* what) {
        EXPECT_LT((found - wanted).norm(), 2e-3 * wanted.norm())
            << what << ", plane " << plane << ", mode " << mode;
      };
      expect(state.p_EoC_I, Rotate(before.q_IB, Vector3(move * q_m * along)), "place");
      expect(state.v_IC_I, Rotate(before.q_IB, Vector3(move * rate_m_s * along)), "speed");
      expect(RotationVector(Inverse(before.q_IB) * state.q_IB), turn * q_m * about, "turn");
      expect(state.w_IB_B, turn * rate_m_s * about, "rate");
      // The modes of what is left move none of it in the mean: all momentum is in the motion above.
      const StackModes left = BuildStackModes(vehicle, kStage, 1u);
      const FreeBody body(rest, left.station_m[0]);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto its = [&](double s) {
          return ShapeOf(left, BeamPlane::kY, left.levels[0].back().modes[k], s);
        };
        const StationShape mean = body.MeanOf(AtStations(its));
        EXPECT_LT(std::fabs(mean.deflection), 1e-3 * std::fabs(move));
        EXPECT_LT(std::fabs(mean.slope_1_m), 1e-3 * std::max(std::fabs(turn), std::fabs(move)));
      }
    }
}

// What is left has the shape that it had: a rigid motion and its own modes. The rest, which modes that do not
// fly would hold, shrinks as more of them fly.
TEST(JettisonedBending, KeepsTheShape) {
  double last = 1.0;
  for (const int modes : {1, 3, 5}) {
    Vehicle vehicle = WithFairing(60.0);
    vehicle.structure_beam->modes = vehicle.structure_beam->flown_modes = modes;
    constexpr int kStage = 0;
    const auto kept = std::make_shared<const Vehicle>(vehicle);
    const auto loads = std::make_shared<const LoadTable>(BuildLoadTable(vehicle, kStage));
    const auto whole = std::make_shared<const StackModes>(BuildStackModes(vehicle, kStage));
    const StackModes left = BuildStackModes(vehicle, kStage, 1u);
    // At a level of both tables, whose shapes are then the modes' own.
    const BendingLevel old = whole->levels[0].front(), now = left.levels[0].front();
    const BeamSource bending(kept, whole, loads, modes);
    const ModalPassage passage = bending.Passage(0u, 1u, old.propellant_kg);
    const double cg_m = FreeBody(BuildBeamMasses(vehicle, kStage, old.propellant_kg, 1u), {}).cg_station_m;
    double worst = 0.0;
    for (const double s : {1.65, 5.0, 10.0, 15.0, 20.0, 26.0}) {
      double sum = passage.shift[0][0] + passage.turn_1_m[0][0] * (s - cg_m);
      for (std::size_t k = 0; k < static_cast<std::size_t>(modes); ++k)
        sum += passage.onto[0][k][0] * ShapeOf(left, BeamPlane::kY, now.modes[k], s).deflection;
      worst = std::max(worst, std::fabs(sum - ShapeOf(*whole, BeamPlane::kY, old.modes[0], s).deflection));
    }
    RecordProperty("worst_" + std::to_string(modes), std::to_string(worst));
    EXPECT_LT(worst, 0.5 * last) << modes << " modes";
    last = worst;
  }
  EXPECT_LT(last, 1e-3);
}

FlightDefinition Definition(const Vehicle& vehicle, std::vector<double> jettison_s) {
  FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS, "flexible");
  definition.vehicle = vehicle;
  for (RateGyro& gyro : definition.vehicle.sensors.rate_gyros) gyro.quantum_rad_s = 0.0;
  definition.jettison_s = std::move(jettison_s);
  return definition;
}

// In dense air, where a launcher would keep it: all that the change of modes could spoil is large there.
TEST(JettisonedBending, FliesAsCvodeFliesIt) {
  const FlightModel model(Definition(WithFairing(60.0, 35.0), {35.0}));
  const std::vector<TickSample> by_cvode = TicksBetween(model, Table3Inputs(), 30.0, 42.0, Scheme::kCvode),
                                flown = TicksBetween(model, Table3Inputs(), 30.0, 42.0);
  ASSERT_EQ(flown.size(), by_cvode.size());
  EXPECT_NE(model.nominal_plant().stacks[0].BendingWithout(1u),
            model.nominal_plant().stacks[0].bending.get());
  double largest = 0.0, departure = 0.0, jump = 0.0;
  bool has_left = false;
  for (std::size_t i = 1; i < flown.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      largest = std::max(largest, std::fabs(by_cvode[i].bending[k]));
      departure = std::max(departure, std::fabs(flown[i].bending[k] - by_cvode[i].bending[k]));
    }
    if (flown[i].jettisoned != 0 && !has_left)
      jump = std::fabs(flown[i].bending[0] - flown[i - 1].bending[0]);
    has_left |= flown[i].jettisoned != 0;
  }
  EXPECT_TRUE(has_left);
  EXPECT_GT(largest, 1e-4);
  EXPECT_LT(departure, 1e-3 * largest);
  EXPECT_GT(jump, 0.0);
}

}  // namespace
}  // namespace dispersa::jettison_bending_test
