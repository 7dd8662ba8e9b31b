// Any quantity in any of its units: read as the same value, written so that it reads back, and limited in
// that unit.
#include "core/campaign_yaml/parse_yaml.h"
#include "core/input/field_reader.h"
#include "core/input/number_text.h"
#include "core/input/units.h"
#include "services/docs/dimensions.h"
#include "tests/test.h"

namespace dispersa::campaign_yaml_units_test {
namespace {

using std::numbers::pi;

/// One of each unit in SI and radians, by the definitions of the units.
const std::map<std::string, double> kInSi = [] {
  std::map<std::string, double> in_si;
  const auto add = [&](double value, const char* units) {
    for (const std::string& unit : Words(units)) in_si[unit] = value;
  };
  add(1.0,
      "m m2 s kg kg_s kg_m2 kg_m pa n_m2 n n_m pa_rad w_m2 m_s g rad rad_s rad_s2 1_s 1_s2 per_m per_m_s "
      "kg_m3 k per_rad");
  add(1e3, "km ton kpa kn_m2 kn kn_m kpa_rad kw_m2 km_s");
  add(1e-3, "mm ms per_km");
  add(1e-6, "um");
  add(1e9, "gpa");
  add(1e6, "mpa mn_m2");
  add(1e2, "hpa");
  add(1e5, "bar");
  add(pi / 180, "pa_deg deg deg_s deg_s2");
  add(1000.0 / 3600.0, "km_h");
  add(2 * pi, "hz");
  add(0.01, "percent percent_per_k");
  add(180 / pi, "per_deg");
  return in_si;
}();

constexpr double kValues[] = {0.0, 1.0, -1.0, 0.1, 7.0, 1.0 / 3.0, 123.456, 6378137.0, 1e-9, -2.5e17};

/// Reads "thing_UNIT: text" as a quantity; problems as a user reads them, one a line.
double Read(const std::string& key, const std::string& text, Dimension dimension, std::string* problems,
            const Range& range = kAnyNumber) {
  std::vector<InputProblem> found;
  InputNode node = ParseYaml(key + ": " + text + "\n", "file", found);
  double value = 0.0;
  ReadFields(node, "", found, nullptr,
             [&](Fields& fields) { fields.Quantity("thing", dimension, range, value, "of a test"); });
  problems->clear();
  for (const InputProblem& problem : found) *problems += problem.Text() + "\n";
  return value;
}

std::string Key(const Unit& unit) { return "thing_" + std::string(unit.suffix); }

class Units : public testing::TestWithParam<std::size_t> {
 protected:
  Dimension dimension_ = kDimensions[GetParam()].second;
  std::string problems_;
};

TEST_P(Units, AreReadAsWhatTheyAre) {
  for (const Unit& unit : dimension_) {
    ASSERT_TRUE(kInSi.contains(std::string(unit.suffix))) << unit.suffix;
    for (const double value : kValues) {
      EXPECT_DOUBLE_EQ(Read(Key(unit), FormatNumber(value), dimension_, &problems_),
                       value * kInSi.at(std::string(unit.suffix)))
          << unit.suffix;
      EXPECT_EQ(problems_, "");
    }
  }
}

TEST_P(Units, AreWrittenSoThatTheyReadBack) {
  for (const Unit& unit : dimension_) {
    for (const double value : kValues) {
      // A value read from a text is written as a text that gives the same bits.
      const double inside = Read(Key(unit), FormatNumber(value), dimension_, &problems_);
      const std::string text = FormatScaled(inside, unit.scale);
      EXPECT_EQ(Read(Key(unit), text, dimension_, &problems_), inside) << text << " " << unit.suffix;
      EXPECT_LE(text.size(), FormatNumber(value).size()) << "longer than what was read";
      // Of any other value the nearest: within the rounding of a division and a product.
      EXPECT_NEAR(Read(Key(unit), FormatScaled(value, unit.scale), dimension_, &problems_), value,
                  std::fabs(value) * 3e-16);
    }
  }
}

TEST_P(Units, StateTheirLimits) {
  const Range range{-2.0, 5.0, false, true};
  for (const Unit& unit : dimension_) {
    const double scale = kInSi.at(std::string(unit.suffix));
    const std::string number = FormatNumber(6.0 / scale);
    EXPECT_EQ(Read(Key(unit), number, dimension_, &problems_, range), 0.0);
    EXPECT_EQ(problems_, "file:1:" + std::to_string(Key(unit).size() + 3) + ": " + Key(unit) + ": " + number +
                             " is out of range, allowed: a number not below " +
                             FormatScaled(-2.0, unit.scale) + " and below " + FormatScaled(5.0, unit.scale) +
                             "\n");
    EXPECT_DOUBLE_EQ(Read(Key(unit), FormatNumber(4.0 / scale), dimension_, &problems_, range), 4.0);
    EXPECT_EQ(problems_, "");
  }
}

TEST_P(Units, AreGivenOnceAndAreOfTheirDimension) {
  std::string keys;
  for (const Unit& unit : dimension_) keys += (keys.empty() ? "" : ", ") + Key(unit);
  if (dimension_.size() > 1) {
    std::vector<InputProblem> found;
    InputNode node = ParseYaml(Key(dimension_[1]) + ": 1\n" + Key(dimension_[0]) + ": 1\n", "file", found);
    double value = 0.0;
    ReadFields(node, "", found, nullptr,
               [&](Fields& fields) { fields.Quantity("thing", dimension_, kAnyNumber, value, "of a test"); });
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].Text(), "file:1:" + std::to_string(Key(dimension_[1]).size() + 3) + ": " +
                                   Key(dimension_[1]) + ": '" + Key(dimension_[0]) +
                                   "' is given too, allowed: one of the two");
  }
  // A unit of something else is told from a wrong name.
  for (const auto& [suffix, si] : kInSi) {
    const auto is_ours = [&](const Unit& unit) { return unit.suffix == suffix; };
    if (std::any_of(dimension_.begin(), dimension_.end(), is_ours)) continue;
    const std::string key = "thing_" + std::string(suffix);
    Read(key, "1", dimension_, &problems_);
    // "ms" is how some write m/s.
    const std::string guess = suffix == "ms" && kDimensions[GetParam()].second.data() == kSpeed
                                  ? " (did you mean 'thing_m_s'?)"
                                  : "";
    EXPECT_EQ(problems_, "file:1:1: " + key + ": the unit of '" + key + "' is not known here" + guess +
                             ", allowed: " + keys + "\n");
  }
  Read("thing", "1", dimension_, &problems_);
  EXPECT_EQ(problems_, "file:1:1: thing: missing unit (did you mean '" + Key(dimension_[0]) +
                           "'?), allowed: " + keys + "\n");
}

INSTANTIATE_TEST_SUITE_P(Each, Units, testing::Range(std::size_t{0}, kDimensions.size()),
                         [](const auto& number) {
                           std::string name = kDimensions[number.param].first;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

// Another spelling is guessed wherever its unit is allowed.
TEST(UnitSpellings, AreUnderstoodWhereTheyAreMeant) {
  for (const UnitSpelling& spelling : kUnitSpellings) {
    ASSERT_TRUE(kInSi.contains(std::string(spelling.meant))) << spelling.written;
    for (const auto& [name, dimension] : kDimensions) {
      const auto has = [&, units = dimension](std::string_view suffix) {
        return std::any_of(units.begin(), units.end(),
                           [&](const Unit& unit) { return unit.suffix == suffix; });
      };
      if (!has(spelling.meant) || has(spelling.written)) continue;
      std::string problems;
      Read("thing_" + std::string(spelling.written), "1", dimension, &problems);
      EXPECT_NE(problems.find("(did you mean 'thing_" + std::string(spelling.meant) + "'?)"),
                std::string::npos)
          << name << ": " << problems;
    }
  }
}

TEST(UnitsOfLists, CountForEveryItem) {
  std::vector<InputProblem> found;
  InputNode node = ParseYaml("times_ms: [0, 250, 1e3]\nwidth_mm: 40\nlength_km: [2, 3]\n", "file", found);
  std::vector<double> times;
  double width[2] = {}, length[2] = {};
  std::optional<double> height;
  ReadFields(node, "", found, nullptr, [&](Fields& fields) {
    fields.Quantities("times", kTime, kAnyNumber, 1, 9, times, "of a test");
    fields.Ends("width", kLength, kAnyNumber, width[0], width[1], true, "of a test");
    fields.Ends("length", kLength, kAnyNumber, length[0], length[1], true, "of a test");
    fields.OptionalQuantity("height", kLength, kAnyNumber, height, "of a test");
  });
  EXPECT_EQ(times, (std::vector<double>{0.0, 0.25, 1.0}));
  EXPECT_EQ(width[0], 0.04);
  EXPECT_EQ(width[1], 0.04);
  EXPECT_EQ(length[0], 2000.0);
  EXPECT_EQ(length[1], 3000.0);
  EXPECT_EQ(height, std::nullopt);
  EXPECT_TRUE(found.empty());
}

}  // namespace
}  // namespace dispersa::campaign_yaml_units_test
