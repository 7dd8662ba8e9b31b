// The values that a description reads from a map, and the messages about maps that do not fit it.
#include "core/campaign_yaml/parse_yaml.h"
#include "core/input/field_reader.h"
#include "tests/test.h"

namespace dispersa::input_fields_test {
namespace {

struct Leg {
  std::string name;
  double length_m = 0.0;
};

void Describe(Fields& fields, Leg& leg) {
  fields.Text("name", leg.name, "of the leg");
  fields.Quantity("length", kLength, UpTo(10.0), leg.length_m, "of the leg");
}

enum class Wood { kOak, kPine };

struct Table {
  Wood wood = Wood::kOak;
  bool folds = false;
  int seats = 0;
  double price = 0.0, width_m = 0.0, top_m = 0.0, bottom_m = 0.0, when = 0.0;
  std::size_t trigger = 9;
  std::vector<double> heights_m, marks, weights_kg;
  std::vector<std::size_t> colours;
  std::vector<Leg> legs;
  bool has_drawer = false;
  double drawer_m = 0.0, oil_days = 0.0;
};

void Describe(Fields& fields, Table& table) {
  fields.Choice<Wood>("wood", {{"oak", Wood::kOak}, {"pine", Wood::kPine}}, table.wood, "of the top",
                      Wood::kPine);
  fields.Flag("folds", table.folds, true, "in the middle");
  fields.Integer("seats", 1, 12, table.seats, "at the table", 4);
  fields.Number("price", kNonNegative, table.price, "without tax", 7.5);
  fields.Quantity("width", kLength, kPositive, table.width_m, "of the top", 1.0);
  fields.Ends("edge", kLength, kPositive, table.top_m, table.bottom_m, false, "thickness");
  fields.Quantities("heights", kLength, kPositive, 0, 2, table.heights_m, "of the shelves");
  fields.OptionalQuantities("weights", kMass, kPositive, 2, 3, table.weights_kg, "of the parts");
  fields.Numbers("marks", Between(0.0, 5.0), 0, 9, table.marks, "of buyers");
  fields.List("legs", 0, 3, table.legs, "below", [](Fields& leg, Leg& value) { Describe(leg, value); });
  fields.OptionalMap("drawer", table.has_drawer, "below", [&](Fields& drawer) {
    drawer.Quantity("depth", kLength, kPositive, table.drawer_m, "inside");
  });
  fields.When(Is("wood", {"oak"}),
              [&] { fields.Number("oil_days", kPositive, table.oil_days, "between oilings", 3.0); });
  fields.Unless(Has("drawer"), [&] {
    fields.OneOf(
        {{"delivery", kTime, kPositive, "after the order"}, {"distance", kLength, kPositive, "to the shop"}},
        table.trigger, table.when);
  });
  fields.Check([&fields, &table] {
    if (table.legs.size() == 2) fields.Refuse("legs[1].length", "stands on two legs", "none, one or three");
    CheckIncreasing(fields, "heights", table.heights_m);
  });
}

struct Read {
  Table table;
  std::string texts;
};

Read ReadTable(const std::string& yaml) {
  Read read;
  std::vector<InputProblem> problems;
  InputNode node = ParseYaml(yaml, "t", problems);
  ReadFields(node, "", problems, nullptr, [&](Fields& fields) { Describe(fields, read.table); });
  for (const InputProblem& problem : problems) read.texts += problem.Text() + "\n";
  return read;
}

TEST(FieldReader, FillsAllThatIsGiven) {
  const Read read = ReadTable(
      "wood: oak\nfolds: false\nseats: 6\nprice: 2\nwidth_mm: 900\nedge_mm: [30, 20]\nheights_m: [0.1, 0.2]\n"
      "weights_kg: [1, 2]\nmarks: [3]\nlegs: [{name: one, length_km: 0.001}]\ndrawer: {depth_m: "
      "0.3}\noil_days: 9\n");
  EXPECT_EQ(read.texts, "");
  const Table& t = read.table;
  EXPECT_EQ(t.wood, Wood::kOak);
  EXPECT_FALSE(t.folds);
  EXPECT_EQ(t.seats, 6);
  EXPECT_EQ(t.price, 2.0);
  EXPECT_DOUBLE_EQ(t.width_m, 0.9);
  EXPECT_DOUBLE_EQ(t.top_m, 0.03);
  EXPECT_DOUBLE_EQ(t.bottom_m, 0.02);
  EXPECT_EQ(t.heights_m, (std::vector<double>{0.1, 0.2}));
  EXPECT_EQ(t.weights_kg, (std::vector<double>{1.0, 2.0}));
  EXPECT_EQ(t.marks, std::vector<double>{3.0});
  ASSERT_EQ(t.legs.size(), 1u);
  EXPECT_EQ(t.legs[0].name, "one");
  EXPECT_DOUBLE_EQ(t.legs[0].length_m, 1.0);
  EXPECT_TRUE(t.has_drawer);
  EXPECT_EQ(t.drawer_m, 0.3);
  EXPECT_EQ(t.oil_days, 9.0);
}

TEST(FieldReader, TakesDefaultsOfWhatIsNot) {
  const Read read = ReadTable("distance_km: 2\n");
  EXPECT_EQ(read.texts, "");
  EXPECT_EQ(read.table.wood, Wood::kPine);
  EXPECT_TRUE(read.table.folds);
  EXPECT_EQ(read.table.seats, 4);
  EXPECT_EQ(read.table.price, 7.5);
  EXPECT_EQ(read.table.width_m, 1.0);
  EXPECT_EQ(read.table.trigger, 1u);
  EXPECT_EQ(read.table.when, 2000.0);
  EXPECT_FALSE(read.table.has_drawer);
  EXPECT_TRUE(read.table.legs.empty());
}

TEST(FieldReader, SaysEverythingThatIsWrongAtOnce) {
  EXPECT_EQ(ReadTable("wood: elm\nseats: 13\nwidth_m: 0\nlegs: [{name: 1, length_m: 11}]\ndrawr: {}\n").texts,
            "t:1:7: wood: 'elm' is not a choice, allowed: one of oak, pine\n"
            "t:2:8: seats: 13 is out of range, allowed: a whole number from 1 to 12\n"
            "t:3:10: width_m: 0 is out of range, allowed: a number above 0\n"
            "t:4:15: legs[0].name: '1' is not text, allowed: text; in quotes if it looks like a number\n"
            "t:4:28: legs[0].length_m: 11 is out of range, allowed: a number above 0 and not above 10\n"
            "t:5:1: drawr: unknown key 'drawr' (did you mean 'drawer'?), allowed: delivery_ms, delivery_s, "
            "distance_km, "
            "distance_m, distance_mm, distance_um, drawer, edge_km, edge_m, edge_mm, edge_um, folds, "
            "heights_km, heights_m, "
            "heights_mm, heights_um, legs, marks, oil_days, price, seats, weights_kg, weights_ton, width_km, "
            "width_m, width_mm, "
            "width_um, wood\n"
            "t:1:1: missing key 'delivery_s' or 'distance_m', allowed: one of them\n");
}

TEST(FieldReader, AConditionDecidesWhatElseIsKnown) {
  EXPECT_EQ(ReadTable("wood: oak\ndelivery_s: 1\n").texts, "");
  EXPECT_EQ(ReadTable("wood: oak\ndelivery_s: 1\n").table.oil_days, 3.0);
  EXPECT_NE(ReadTable("wood: pine\noil_days: 2\ndelivery_s: 1\n").texts.find("unknown key 'oil_days'"),
            std::string::npos);
  EXPECT_NE(ReadTable("drawer: {depth_m: 1}\ndelivery_s: 1\n").texts.find("unknown key 'delivery_s'"),
            std::string::npos);
  EXPECT_EQ(ReadTable("delivery_s: 1\ndistance_m: 1\n").texts,
            "t:2:13: distance_m: 'delivery_s' and 'distance_m' are both given, allowed: one of delivery_s, "
            "distance_m\n");
}

TEST(FieldReader, ChecksARelationOfWhatIsSoundAtItsPlace) {
  const std::string two = "distance_m: 1\nlegs: [{name: a, length_m: 1}, {name: b, length_mm: 5}]\n";
  EXPECT_EQ(ReadTable(two).texts,
            "t:2:53: legs[1].length_mm: stands on two legs, allowed: none, one or three\n");
  EXPECT_EQ(ReadTable(two + "seats: 0\n").texts,
            "t:3:8: seats: 0 is out of range, allowed: a whole number from 1 to 12\n");
  EXPECT_EQ(ReadTable("distance_m: 1\nheights_mm: [4, 4]\n").texts,
            "t:2:17: heights_mm[1]: is not above the one before, allowed: values strictly increasing\n");
}

TEST(FieldReader, CountsLists) {
  EXPECT_EQ(ReadTable("distance_m: 1\nweights_kg: [1]\nheights_m: [1, 2, 3]\n").texts,
            "t:3:12: heights_m: the list has 3, allowed: a list of 0 to 2\n"
            "t:2:13: weights_kg: the list has 1, allowed: a list of 2 to 3\n");
}

}  // namespace
}  // namespace dispersa::input_fields_test
