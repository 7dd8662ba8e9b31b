#include "core/campaign_yaml/text_differences.h"

#include "core/input/input_error.h"
#include "tests/test.h"

namespace dispersa::cli_campaign_differences_test {
namespace {

TEST(Differences, NameEveryValueThatIsNotTheSame) {
  const std::string a =
      "autopilot:\n  name: pd\ndispersions:\n  thrust: {sigma: 1}\n  wind: {speed: 60}\nstages:\n  - {mass: "
      "1}\n  - {mass: 2}\n"
      "table: [1, 2, 3]\n";
  const std::string b =
      "autopilot:\n  name: pid\ndispersions:\n  drag: {sigma: 2, mean: 1}\n  wind: {speed: 60}\nstages:\n  - "
      "{mass: 1}\n  - "
      "{mass: 3}\ntable: [1, 2, 3, 4, 5, 6, 7]\n";
  EXPECT_THAT(
      DifferencesOf(a, b),
      ElementsAre(FieldsAre("autopilot.name", "pd", "pid"),
                  FieldsAre("dispersions.drag", "", "{sigma: 2, mean: 1}"),
                  FieldsAre("dispersions.thrust", "{sigma: 1}", ""), FieldsAre("stages[1].mass", "2", "3"),
                  FieldsAre("table", "[1, 2, 3]", "[1, 2, 3, 4, 5, 6, … (7 in all)]")));
  EXPECT_THAT(DifferencesOf(a, a), IsEmpty());
}

TEST(Differences, OfWhatIsNoYaml) { EXPECT_THROW(DifferencesOf("a: [", "a: 1"), InputError); }

}  // namespace
}  // namespace dispersa::cli_campaign_differences_test
