// The data of the page's script: bounded in size, and equal to cases.csv.
#include "core/pages/case_data.h"

#include <nlohmann/json.hpp>

#include "tests/test.h"
#include "tests/unit/made_up_results.h"

namespace dispersa::pages_case_data_test {
namespace {

using Json = nlohmann::json;

/// Apogee rises with the case, perigee falls; every other metric is undefined. Case 7 was lost.
CaseColumns Cases(std::size_t rows) {
  CaseColumns cases;
  cases.metrics.resize(MetricCount(kUsualStages));
  for (std::size_t k = 0; k < rows; ++k) {
    cases.index.push_back(k);
    cases.outcome.push_back(k == 7 ? Outcome::kImpact : Outcome::kCompleted);
    for (CaseColumn& column : cases.metrics) column.push_back(report_test::kNaN);
    cases.metrics[MetricColumn("apogee_km")][k] = 500.0 + 1e-3 * static_cast<double>(k);
    cases.metrics[MetricColumn("perigee_km")][k] = -0.0 - static_cast<double>(k);
  }
  return cases;
}

TEST(CaseData, HoldsEveryCaseOfFew) {
  const Json data = Json::parse(CaseData({}, Cases(100)));
  EXPECT_EQ(data["flown"], 100);
  ASSERT_EQ(data["cases"].size(), 100u);
  EXPECT_EQ(data["lost"], Json::array({7}));
  ASSERT_EQ(data["metrics"].size(), data["values"].size());
  for (std::size_t i = 0; i < data["metrics"].size(); ++i) {
    const std::string name = data["metrics"][i]["name"];
    ASSERT_EQ(data["values"][i].size(), 100u);
    EXPECT_TRUE(data["values"][i][7].is_null()) << "a lost flight has no place among the completed";
    if (name == "apogee_km") {
      EXPECT_DOUBLE_EQ(data["values"][i][12], 500.012);
    } else if (name == "perigee_km") {
      EXPECT_EQ(data["values"][i][0].dump(), "0");
    } else {
      EXPECT_TRUE(data["values"][i][3].is_null()) << name;
    }
  }
}

TEST(CaseData, HoldsTheExtremesOfMany) {
  constexpr std::size_t kMany = 40000;
  const std::string text = CaseData({}, Cases(kMany));
  const Json data = Json::parse(text);
  EXPECT_EQ(data["flown"], kMany);
  EXPECT_LE(data["cases"].size(), kAnsweringCases);
  EXPECT_GE(data["cases"].size(), kAnsweringCases / 8);
  EXPECT_EQ(data["cases"].front(), 0);
  EXPECT_EQ(data["cases"].back(), kMany - 1);
  EXPECT_TRUE(std::is_sorted(data["cases"].begin(), data["cases"].end()));
  EXPECT_LT(text.size(), 400000u);
}

}  // namespace
}  // namespace dispersa::pages_case_data_test
