// Table look-up on random grids, against a linear search and the definition of a straight line.
#include "core/math/table.h"
#include "core/random/draws.h"
#include "tests/test.h"

namespace dispersa::tables_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::vector<double> RandomGrid(Stream& random) {
  std::vector<double> grid = {100.0 * random.Normal()};
  const int points = 2 + static_cast<int>(random.Bits() % 9);
  // Spacings over six powers of ten.
  while (static_cast<int>(grid.size()) < points)
    grid.push_back(grid.back() + std::pow(10.0, 6.0 * random.Uniform() - 3.0));
  return grid;
}
std::vector<double> RandomValues(Stream& random, std::size_t count) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(10.0 * random.Normal());
  return values;
}
// Inside, outside, at every point and beside it.
std::vector<double> Arguments(Stream& random, const std::vector<double>& grid) {
  std::vector<double> all = {-kInfinity, kInfinity, grid.front() - 1.0, grid.back() + 1.0};
  for (const double x : grid)
    for (const double at : {x, std::nextafter(x, -kInfinity), std::nextafter(x, kInfinity)})
      all.push_back(at);
  for (int i = 0; i < 20; ++i)
    all.push_back(grid.front() + (grid.back() - grid.front()) * (1.2 * random.Uniform() - 0.1));
  return all;
}

// The straight line through the two neighbours, by a search from the front.
double LineAt(const std::vector<double>& x, const std::vector<double>& y, double at) {
  if (at <= x.front()) return y.front();
  for (std::size_t i = 1; i < x.size(); ++i)
    if (at <= x[i]) return y[i] - (y[i] - y[i - 1]) * (x[i] - at) / (x[i] - x[i - 1]);
  return y.back();
}

TEST(Tables, LocateFindsTheIntervalThatHoldsTheArgument) {
  for (std::uint64_t draw = 0; draw < 300; ++draw) {
    Stream random(1, draw, "grids");
    const std::vector<double> grid = RandomGrid(random);
    for (const double at : Arguments(random, grid)) {
      const GridPosition place = Locate(grid, at);
      ASSERT_LE(place.index + 2, grid.size());
      ASSERT_GE(place.fraction, 0.0);
      ASSERT_LE(place.fraction, 1.0);
      if (at >= grid.back()) {
        EXPECT_EQ(place.index, grid.size() - 2);
        EXPECT_EQ(place.fraction, 1.0);
      } else if (at <= grid.front()) {
        EXPECT_EQ(place.index, 0u);
        EXPECT_EQ(place.fraction, 0.0);
      } else {
        EXPECT_LE(grid[place.index], at);
        EXPECT_LT(at, grid[place.index + 1]) << "a point belongs to the interval that it begins";
        const double width = grid[place.index + 1] - grid[place.index];
        EXPECT_NEAR(place.fraction * width, at - grid[place.index], 1e-15 * width);
      }
    }
    // No number is no place: the first, as every argument that is not above it.
    EXPECT_EQ(Locate(grid, kNaN).index, 0u);
    EXPECT_EQ(Locate(grid, kNaN).fraction, 0.0);
  }
}

TEST(Tables, OfOneArgumentAreStraightBetweenPointsAndHeldOutside) {
  for (std::uint64_t draw = 0; draw < 300; ++draw) {
    Stream random(2, draw, "tables");
    Table1D table;
    table.x = RandomGrid(random);
    table.y = RandomValues(random, table.x.size());
    for (std::size_t i = 0; i < table.x.size(); ++i)
      EXPECT_EQ(table(table.x[i]), table.y[i]) << "exact at its points";
    // Values of 10, of which a few roundings count, and a difference of arguments of 1e2 over intervals of
    // 1e-3.
    for (const double at : Arguments(random, table.x))
      EXPECT_NEAR(table(at), LineAt(table.x, table.y, at), 1e-9) << at;
  }
}

TEST(Tables, OfTwoArgumentsAreStraightAlongEach) {
  for (std::uint64_t draw = 0; draw < 100; ++draw) {
    Stream random(3, draw, "tables");
    Table2D table;
    table.x = RandomGrid(random);
    table.y = RandomGrid(random);
    table.z = RandomValues(random, table.x.size() * table.y.size());
    for (std::size_t i = 0; i < table.x.size(); ++i)
      for (std::size_t j = 0; j < table.y.size(); ++j)
        EXPECT_EQ(table(table.x[i], table.y[j]), table.z[i * table.y.size() + j]);
    for (const double at_x : Arguments(random, table.x)) {
      // First along y in every row, then along x.
      const double at_y = Arguments(random, table.y).back();
      std::vector<double> column;
      for (std::size_t i = 0; i < table.x.size(); ++i) {
        const auto row = table.z.begin() + static_cast<std::ptrdiff_t>(i * table.y.size());
        column.push_back(LineAt(table.y, {row, row + static_cast<std::ptrdiff_t>(table.y.size())}, at_y));
      }
      EXPECT_NEAR(table(at_x, at_y), LineAt(table.x, column, at_x), 1e-9);
    }
  }
}

TEST(Tables, AreLinearInTheirValues) {
  Stream random(4, 0, "tables");
  Table1D a, b, sum;
  a.x = b.x = sum.x = RandomGrid(random);
  a.y = RandomValues(random, a.x.size());
  b.y = RandomValues(random, a.x.size());
  for (std::size_t i = 0; i < a.x.size(); ++i) sum.y.push_back(a.y[i] + 2.0 * b.y[i]);
  for (const double at : Arguments(random, a.x)) EXPECT_NEAR(sum(at), a(at) + 2.0 * b(at), 1e-12);
}

TEST(Tables, StrictlyIncreasingMeansEveryStepAndEveryNumber) {
  EXPECT_TRUE(IsStrictlyIncreasing({}));
  EXPECT_TRUE(IsStrictlyIncreasing({-1.0}));
  for (std::uint64_t draw = 0; draw < 200; ++draw) {
    Stream random(5, draw, "grids");
    const std::vector<double> grid = RandomGrid(random);
    EXPECT_TRUE(IsStrictlyIncreasing(grid));
    const std::size_t at = static_cast<std::size_t>(random.Bits() % grid.size());
    for (const double no : {kNaN, kInfinity, -kInfinity}) {
      std::vector<double> damaged = grid;
      damaged[at] = no;
      EXPECT_FALSE(IsStrictlyIncreasing(damaged)) << at << " is " << no;
    }
    if (at == 0) continue;
    std::vector<double> damaged = grid;
    damaged[at] = grid[at - 1];
    EXPECT_FALSE(IsStrictlyIncreasing(damaged)) << "two are equal";
    damaged = grid;
    std::swap(damaged[at], damaged[at - 1]);
    EXPECT_FALSE(IsStrictlyIncreasing(damaged)) << "two are exchanged";
  }
}

}  // namespace
}  // namespace dispersa::tables_test
