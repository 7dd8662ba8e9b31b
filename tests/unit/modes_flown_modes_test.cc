// Modes of several sources in one table.
#include "core/modes/flown_modes.h"

#include "core/modes/beam_source.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa::modes_flown_modes_test {
namespace {

// A number of its own in every column, mode and level, linear over the propellant.
double Number(int source, int plane, int mode, int column, double propellant_kg) {
  return 1000.0 * source + 300.0 * plane + 10.0 * mode + 0.1 * column + 0.01 * (mode + 1) * propellant_kg;
}
class MadeUp : public ModeSource {
 public:
  MadeUp(int source, int modes, int planes, std::vector<double> propellant_kg) : source_(source) {
    auto table = std::make_shared<ModeTable>();
    table->modes = modes;
    table->planes = planes;
    table->propellant_kg = std::move(propellant_kg);
    for (int plane = 0; plane < planes; ++plane)
      for (const double kg : table->propellant_kg)
        for (int mode = 0; mode < modes; ++mode)
          for (int column = 0; column < ModeTable::kRowSize; ++column)
            table->rows.push_back(Number(source, plane, mode, column, kg));
    table_ = table;
  }
  std::shared_ptr<const ModeTable> Without(unsigned) const override { return table_; }
  ModalPassage Passage(unsigned, unsigned after, double) const override {
    ModalPassage passage;
    for (std::size_t mode = 0; mode < static_cast<std::size_t>(table_->modes); ++mode) {
      const double number = 100.0 * source_ + 10.0 * static_cast<double>(mode) + after;
      passage.shift[0][mode] = number;
      passage.turn_1_m[1][mode] = -number;
      for (std::size_t old = 0; old < static_cast<std::size_t>(table_->modes); ++old)
        passage.onto[1][mode][old] = number + static_cast<double>(old);
    }
    return passage;
  }
  std::shared_ptr<const ModeSource> Of(std::shared_ptr<const Vehicle>,
                                       std::shared_ptr<const LoadTable>) const override {
    return std::make_shared<const MadeUp>(source_ + 5, table_->modes, table_->planes, table_->propellant_kg);
  }

 private:
  int source_;
  std::shared_ptr<const ModeTable> table_;
};
const auto kFirst = std::make_shared<const MadeUp>(1, 2, 2, std::vector<double>{90.0, 40.0, 0.0});
const auto kSecond = std::make_shared<const MadeUp>(2, 3, 1, std::vector<double>{90.0, 70.0, 10.0});

bool IsOfEachMode(int column, int from) { return column >= from && column < from + kModes; }

TEST(FlownModes, StandSideBySide) {
  const FlownModes modes({kFirst, kSecond});
  const std::shared_ptr<const ModeTable> table = modes.Without(0u);
  EXPECT_EQ(table->modes, 5);
  EXPECT_EQ(table->planes, 2);
  EXPECT_EQ(table->propellant_kg, (std::vector<double>{90.0, 70.0, 40.0, 10.0, 0.0}));
  for (int level = 0; level < 5; ++level)
    for (int plane = 0; plane < 2; ++plane)
      for (int mode = 0; mode < 5; ++mode) {
        const bool second = mode >= 2;
        const int own = second ? mode - 2 : mode;
        // The second's levels end at 10 kg.
        const double all_kg = table->propellant_kg[static_cast<std::size_t>(level)],
                     kg = second && all_kg < 10.0 ? 10.0 : all_kg;
        const double* const row = table->Row(plane, level, mode);
        for (int column = 0; column < ModeTable::kRowSize; ++column) {
          const auto number = [&](int source, int at) {
            return Number(source, second ? 0 : plane, own, at, kg);
          };
          double expected = number(second ? 2 : 1, column);
          for (int from : {int{ModeTable::kShortening}, int{ModeTable::kBehindBoosters},
                           ModeTable::LiftColumn(0, kWorkEffects), ModeTable::LiftColumn(1, kWorkEffects),
                           ModeTable::LiftColumn(2, kWorkEffects), ModeTable::LiftColumn(3, kWorkEffects)})
            if (second && IsOfEachMode(column, from))
              // Its own modes are the third to fifth; before them stands what its table had behind them.
              expected = number(2, from + (column - from + kModes - 2) % kModes);
          if (column >= ModeTable::kResidual && column < ModeTable::kDamping) {
            if (mode > 0 && mode != 1) expected = 0.0;
            if (mode == 0)
              expected += Number(2, 0, 0, column, all_kg < 10.0 ? 10.0 : all_kg) +
                          Number(2, 0, 1, column, all_kg < 10.0 ? 10.0 : all_kg) +
                          Number(2, 0, 2, column, all_kg < 10.0 ? 10.0 : all_kg);
          }
          EXPECT_NEAR(row[column], expected, 1e-9) << level << plane << mode << ", column " << column;
        }
      }
  EXPECT_EQ(modes.Without(0u), table) << "made once";
}

TEST(FlownModes, OfOneSourceAreItsOwn) {
  const FlownModes modes({kSecond});
  EXPECT_EQ(modes.Without(3u), kSecond->Without(3u));
}

TEST(FlownModes, PassTheModesOfEachSource) {
  const FlownModes modes({kFirst, kSecond});
  const ModalPassage all = modes.Passage(0u, 7u, 50.0);
  for (std::size_t mode = 0; mode < 5; ++mode) {
    const bool second = mode >= 2;
    const double number = second ? 200.0 + 10.0 * static_cast<double>(mode - 2) + 7.0
                                 : 100.0 + 10.0 * static_cast<double>(mode) + 7.0;
    EXPECT_EQ(all.shift[0][mode], number);
    EXPECT_EQ(all.turn_1_m[1][mode], -number);
    for (std::size_t old = 0; old < 5; ++old) {
      const bool of_second = old >= 2;
      EXPECT_EQ(all.onto[1][mode][old],
                second == of_second ? number + static_cast<double>(second ? old - 2 : old) : 0.0);
    }
  }
}

TEST(FlownModes, OfOtherMassesComeFromTheSameSources) {
  const FlownModes modes({kFirst, kSecond});
  const std::shared_ptr<const FlownModes> other = modes.Of(nullptr, nullptr);
  const std::shared_ptr<const ModeTable> table = other->Without(0u);
  EXPECT_EQ(table->modes, 5);
  EXPECT_EQ(table->Row(0, 0, 0)[0], Number(6, 0, 0, 0, 90.0));
  EXPECT_EQ(table->Row(0, 0, 2)[0], Number(7, 0, 0, 0, 90.0));
}

// What a vehicle with a beam flies, and one without.
TEST(FlownModes, OfAVehicleAreThoseOfItsBeam) {
  const auto vehicle =
      std::make_shared<const Vehicle>(LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4_flexible.yaml"));
  const auto loads = std::make_shared<const LoadTable>(BuildLoadTable(*vehicle, 0));
  const std::shared_ptr<const FlownModes> modes = FlownModesBelow(kPi / 0.01, vehicle, 0, loads);
  const auto beam = BeamSource::Below(kPi / 0.01, vehicle, 0, loads);
  ASSERT_TRUE(modes);
  EXPECT_EQ(modes->Without(0u)->rows, beam->Without(0u)->rows);
  for (int mode = 0; mode < 3; ++mode)
    EXPECT_EQ(modes->Without(0u)->Row(0, 0, mode)[ModeTable::kDamping],
              vehicle->structure_beam->damping_ratio);
  auto rigid = std::make_shared<Vehicle>(*vehicle);
  rigid->structure_beam->flown_modes = 0;
  EXPECT_EQ(FlownModesBelow(kPi / 0.01, rigid, 0, loads), nullptr);
}

}  // namespace
}  // namespace dispersa::modes_flown_modes_test
