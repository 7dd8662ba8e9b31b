// Look-up of modes in flight: at any propellant, in both planes, with the flight's factors.
#include "tests/test.h"
#include "tests/unit/made_up_bending.h"

namespace dispersa::dynamics_bending_shapes_test {
namespace {

constexpr double kFull_kg = 100.0;

// A number of its own in every column, mode, level and plane.
double Number(int plane, int level, int mode, int column) {
  const double ripple = std::sin(1.0 + 7.0 * plane + 3.0 * level + 11.0 * mode + 0.37 * column);
  return column == ModeTable::kFrequency ? 20.0 + 10.0 * mode + 5.0 * ripple : ripple;
}

// Levels at 100, 60 and 0 kg: a step of 40 and one of 60.
ModeTable NumberTable(int planes, int modes = 2) {
  ModeTable table;
  table.modes = modes;
  table.planes = planes;
  table.propellant_kg = {kFull_kg, 60.0, 0.0};
  for (int plane = 0; plane < planes; ++plane)
    for (int level = 0; level < 3; ++level)
      for (int mode = 0; mode < modes; ++mode)
        for (int column = 0; column < ModeTable::kRowSize; ++column)
          table.rows.push_back(Number(plane, level, mode, column));
  return table;
}

// By hand: between the level `from` and the next one aft of it in the burn, so far.
struct Between {
  double propellant_kg;
  int from;
  double so_far;
};
constexpr Between kPlaces[] = {{130.0, 0, 0.0}, {100.0, 0, 0.0}, {80.0, 0, 0.5}, {60.0, 1, 0.0},
                               {15.0, 1, 0.75}, {0.0, 1, 1.0},   {-5.0, 1, 1.0}};

double Expected(const Between& at, int plane, int mode, int column) {
  return (1.0 - at.so_far) * Number(plane, at.from, mode, column) +
         at.so_far * Number(plane, at.from + 1, mode, column);
}

// Every number that a flight has of one mode, with the column that it comes from. Frequencies are apart.
void ExpectColumns(const lanes::StackBending<double>& bending, int plane, int mode,
                   const std::function<double(int)>& column) {
  constexpr double kRounding = 1e-14;  // of numbers up to 1
  const lanes::ModeNow<double>& now = bending.At(plane, mode);
  EXPECT_NEAR(now.inverse_mass_1_kg, column(ModeTable::kInverseMass), kRounding);
  EXPECT_NEAR(bending.UnitSlope(plane, mode), column(ModeTable::kUnitSlope), kRounding);
  for (int i = 0; i < kRateGyros; ++i)
    EXPECT_NEAR(bending.GyroSlope(plane, mode, i), column(ModeTable::kGyroSlope + i), kRounding) << i;
  const lanes::PlaceShapes<double> pivot = lanes::ShapesOf(bending, lanes::kAtPivot);
  const lanes::OfPlanes<double>&moved = pivot.deflection[mode], &turned = pivot.slope_1_m[mode];
  EXPECT_NEAR(plane == 0 ? moved.y : moved.z, column(ModeTable::kPivotDeflection), kRounding);
  EXPECT_NEAR(plane == 0 ? turned.y : turned.z, column(ModeTable::kPivotSlope), kRounding);
  for (int i = ModeTable::kShortening; i < ModeTable::kUpperTurn; ++i) {
    EXPECT_NEAR(bending.ColumnAt(plane, mode, i), column(i), kRounding) << i;
    const lanes::OfPlanes<double> both = bending.ColumnsAt(mode, i);
    EXPECT_EQ(plane == 0 ? both.y : both.z, bending.ColumnAt(plane, mode, i)) << i;
  }
  constexpr double kAft_m = 0.4;
  for (int effect = 0; effect < kLiftEffects; ++effect) {
    const auto by = [&](int cause) { return column(ModeTable::LiftColumn(cause, effect)); };
    const lanes::LiftNow<double> lift = lanes::LiftOf(bending, plane, mode, effect, kAft_m);
    EXPECT_NEAR(lift.by_slope, by(kSlopeSlender) + kAft_m * by(kSlopeShift), 2.0 * kRounding) << effect;
    EXPECT_NEAR(lift.by_rate, by(kRateSlender) + kAft_m * by(kRateShift), 2.0 * kRounding) << effect;
  }
}

TEST(BendingShapes, AreLinearBetweenLevelsAndHeldBeyond) {
  const ModeTable table = NumberTable(2);
  for (const Between& at : kPlaces) {
    const lanes::StackBending<double> bending = BendingOf(table, at.propellant_kg, 0.02);
    for (int plane = 0; plane < kPlanes; ++plane)
      for (int mode = 0; mode < 2; ++mode) {
        SCOPED_TRACE(testing::Message() << at.propellant_kg << " kg, plane " << plane << ", mode " << mode);
        const lanes::ModeNow<double>& now = bending.At(plane, mode);
        ExpectColumns(bending, plane, mode, [&](int column) { return Expected(at, plane, mode, column); });
        const double frequency = Expected(at, plane, mode, ModeTable::kFrequency);
        EXPECT_NEAR(now.stiffness_1_s2, frequency * frequency, 1e-12 * frequency * frequency);
        const double ratio = 0.02 * Expected(at, plane, mode, ModeTable::kDamping);
        EXPECT_NEAR(now.decay_1_s, ratio * frequency, 1e-13 * frequency);
        EXPECT_NEAR(now.damping_1_s, 2.0 * ratio * frequency, 1e-13 * frequency);
        EXPECT_NEAR(now.damped_frequency_rad_s, std::sqrt(1.0 - ratio * ratio) * frequency,
                    1e-13 * frequency);
      }
  }
}

// Margins and tuning look one column up; a flight must see the same.
TEST(BendingShapes, OfOneColumnAreThoseOfAFlight) {
  const ModeTable table = NumberTable(2);
  for (const Between& at : kPlaces)
    for (int plane = 0; plane < kPlanes; ++plane)
      for (int mode = 0; mode < 2; ++mode)
        for (int column = 0; column < ModeTable::kRowSize; ++column)
          EXPECT_NEAR(table.At(plane, mode, column, at.propellant_kg), Expected(at, plane, mode, column),
                      1e-13)
              << at.propellant_kg << " kg, plane " << plane << ", mode " << mode << ", column " << column;
}

TEST(BendingShapes, OfOneLevelAreTheSameAtAnyPropellant) {
  const ModeTable table = MadeUpTable(TwoPlanes());
  const lanes::StackBending<double> some = BendingOf(table, 0.0), more = BendingOf(table, 77.0);
  for (int plane = 0; plane < kPlanes; ++plane)
    for (int mode = 0; mode < 2; ++mode) {
      const auto of = [&](const lanes::StackBending<double>& bending) {
        return bending.ColumnAt(plane, mode, ModeTable::kPivotDeflection);
      };
      EXPECT_EQ(of(some),
                TwoPlanes()[static_cast<std::size_t>(plane)][static_cast<std::size_t>(mode)].Deflection(
                    kBodyPivot_m));
      EXPECT_EQ(of(more), of(some));
      EXPECT_EQ(table.At(plane, mode, ModeTable::kPivotDeflection, 77.0), of(some));
    }
}

TEST(BendingShapes, OfAnAxisymmetricBodyServeBothPlanes) {
  const ModeTable table = NumberTable(1);
  lanes::StackBending<double> bending = BendingOf(table, 80.0);
  EXPECT_EQ(&bending.At(1, 1), &bending.At(0, 1));
  // Beside a stack whose planes differ, its second plane is looked up too.
  bending.planes = 2;
  lanes::SetTable(bending, 0, &table);
  lanes::ShapesAt(bending, 15.0);
  const Between at = kPlaces[4];
  for (int plane = 0; plane < kPlanes; ++plane)
    for (int mode = 0; mode < 2; ++mode)
      ExpectColumns(bending, plane, mode, [&](int column) { return Expected(at, 0, mode, column); });
}

TEST(BendingShapes, FollowTheFlightsFactors) {
  const ModeTable table = NumberTable(2);
  lanes::StackBending<double> bending = BendingOf(table, 80.0);
  bending.frequency_factor[0] = 1.1;
  bending.frequency_factor[1] = 0.8;
  bending.slope_factor = 1.5;
  lanes::ShapesAt(bending, 80.0);
  for (int plane = 0; plane < kPlanes; ++plane)
    for (int mode = 0; mode < 2; ++mode) {
      const auto nominal = [&](int column) { return Expected(kPlaces[2], plane, mode, column); };
      const double frequency = (mode == 0 ? 1.1 : 0.8) * nominal(ModeTable::kFrequency);
      EXPECT_NEAR(bending.At(plane, mode).stiffness_1_s2, frequency * frequency,
                  1e-12 * frequency * frequency);
      // The factor is of what sensors feel. Forces act on the shapes as they are.
      ExpectColumns(bending, plane, mode, [&](int column) {
        const bool is_felt = column >= ModeTable::kUnitSlope && column < ModeTable::kShortening;
        return (is_felt ? 1.5 : 1.0) * nominal(column);
      });
    }
}

TEST(BendingShapes, OfAModeThatDoesNotFlyAreNone) {
  const ModeTable table = NumberTable(1, 1);
  for (const ModeTable* of_stack : {&table, static_cast<const ModeTable*>(nullptr)}) {
    lanes::StackBending<double> bending = BendingOf(table, 80.0, 0.01);
    bending.modes = 3;  // another stack has so many
    bending.planes = 2;
    lanes::SetTable(bending, 0, of_stack);
    lanes::ShapesAt(bending, 80.0);
    for (int plane = 0; plane < kPlanes; ++plane)
      for (int mode = of_stack ? 1 : 0; mode < 3; ++mode) {
        ExpectColumns(bending, plane, mode, [](int) { return 0.0; });
        EXPECT_EQ(bending.At(plane, mode).stiffness_1_s2, 1.0) << "swings, and nobody feels it";
        EXPECT_GT(bending.At(plane, mode).damped_frequency_rad_s, 0.0);
      }
  }
}

// At the same propellant too, which is between the same levels.
TEST(BendingShapes, AreThoseOfAnotherStackAtOnce) {
  ModeTable another = NumberTable(2);
  for (double& value : another.rows) value *= 3.0;
  lanes::StackBending<double> bending = BendingOf(NumberTable(2), 80.0);
  lanes::SetTable(bending, 0, &another);
  lanes::ShapesAt(bending, 80.0);
  for (int plane = 0; plane < kPlanes; ++plane)
    for (int mode = 0; mode < 2; ++mode)
      ExpectColumns(bending, plane, mode,
                    [&](int column) { return 3.0 * Expected(kPlaces[2], plane, mode, column); });
}

// Side by side: stacks of their own, at propellants of their own.
TEST(BendingShapes, OfALaneAreThoseOfItsStackAlone) {
  using Four = lanes::Pack<4>;
  const ModeTable two_planes = NumberTable(2), one_plane = NumberTable(1), one_mode = NumberTable(2, 1);
  const ModeTable* tables[4] = {&one_plane, nullptr, &two_planes, &one_mode};
  const double propellant_kg[4] = {97.0, 50.0, 33.0, -1.0};
  lanes::StackBending<Four> together{};
  together.modes = together.planes = 2;
  Four propellant(0.0);
  for (int lane = 0; lane < 4; ++lane) {
    lanes::SetTable(together, lane, tables[lane]);
    lanes::Lane(propellant, lane) = propellant_kg[lane];
    for (Four& factor : together.frequency_factor) lanes::Lane(factor, lane) = 1.0 + 0.1 * lane;
    lanes::Lane(together.damping_factor, lane) = 0.01 * lane;
    lanes::Lane(together.slope_factor, lane) = 1.0 - 0.1 * lane;
  }
  lanes::ShapesAt(together, propellant);
  for (int lane = 0; lane < 4; ++lane) {
    lanes::StackBending<double> alone{};
    alone.modes = alone.planes = 2;
    lanes::SetTable(alone, 0, tables[lane]);
    for (double& factor : alone.frequency_factor) factor = 1.0 + 0.1 * lane;
    alone.damping_factor = 0.01 * lane;
    alone.slope_factor = 1.0 - 0.1 * lane;
    lanes::ShapesAt(alone, propellant_kg[lane]);
    for (int plane = 0; plane < kPlanes; ++plane)
      for (int mode = 0; mode < 2; ++mode) {
        // ModeNow holds nothing but numbers of the lane.
        const Four* packed = &together.At(plane, mode).stiffness_1_s2;
        const double* one = &alone.At(plane, mode).stiffness_1_s2;
        for (std::size_t i = 0; i < sizeof(lanes::ModeNow<double>) / sizeof(double); ++i)
          EXPECT_EQ(lanes::Lane(packed[i], lane), one[i]) << "lane " << lane << ", number " << i;
        for (int column = 0; column < ModeTable::kRowSize; ++column)
          EXPECT_EQ(lanes::Lane(together.ColumnAt(plane, mode, column), lane),
                    alone.ColumnAt(plane, mode, column))
              << "lane " << lane << ", column " << column;
        EXPECT_EQ(lanes::Lane(together.UnitSlope(plane, mode), lane), alone.UnitSlope(plane, mode));
      }
  }
}

}  // namespace
}  // namespace dispersa::dynamics_bending_shapes_test
