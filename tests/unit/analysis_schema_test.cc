// summary.json conforms to its published schema, core/analysis/summary.schema.json.
#include <nlohmann/json.hpp>

#include "core/analysis/campaign_summary.h"
#include "tests/test.h"
#include "tests/unit/made_up_results.h"

namespace dispersa::analysis_schema_test {

using Json = nlohmann::json;

bool HasType(const Json& value, const std::string& type) {
  if (type == "null") return value.is_null();
  if (type == "boolean") return value.is_boolean();
  if (type == "integer") return value.is_number_integer();
  if (type == "number") return value.is_number();
  if (type == "string") return value.is_string();
  return type == "array" ? value.is_array() : type == "object" && value.is_object();
}

/// The violations of the keywords that the schema uses, one line each with their place.
void Check(const Json& value, const Json& schema, const std::string& path,
           std::vector<std::string>& problems) {
  for (const auto& [keyword, rule] : schema.items()) {
    if (keyword == "const" && value != rule) problems.push_back(path + ": not " + rule.dump());
    if (keyword == "enum" && std::find(rule.begin(), rule.end(), value) == rule.end())
      problems.push_back(path + ": " + value.dump() + " is none of " + rule.dump());
    if (keyword == "type") {
      const Json types = rule.is_array() ? rule : Json::array({rule});
      if (std::none_of(types.begin(), types.end(), [&](const Json& type) { return HasType(value, type); }))
        problems.push_back(path + ": no " + rule.dump());
    }
    if (keyword == "items" && value.is_array()) {
      for (std::size_t i = 0; i < value.size(); ++i)
        Check(value[i], rule, path + "[" + std::to_string(i) + "]", problems);
    }
    if (keyword == "required" && value.is_object()) {
      for (const Json& key : rule)
        if (!value.contains(key.get<std::string>())) problems.push_back(path + ": lacks " + key.dump());
    }
  }
  if (!value.is_object()) return;
  for (const auto& [key, member] : value.items()) {
    const std::string place = path + "." + key;
    if (schema.contains("properties") && schema["properties"].contains(key)) {
      Check(member, schema["properties"][key], place, problems);
    } else if (schema.contains("additionalProperties") && schema["additionalProperties"].is_object()) {
      Check(member, schema["additionalProperties"], place, problems);
    } else if (schema.contains("additionalProperties") && schema["additionalProperties"] == false) {
      problems.push_back(place + ": not in the schema");
    }
  }
}

Json Schema() {
  return Json::parse(std::ifstream(DISPERSA_TEST_DATA "/../../core/analysis/summary.schema.json"));
}

Json SummaryOf(std::uint64_t cases, std::uint64_t flown) {
  TemporaryFolder temporary;
  Campaign campaign = report_test::MakeCampaign(cases);
  campaign.requirements = {report_test::PeakBelow(12.5, 0.9, 0.1)};
  campaign.dispersions = {made_up::Of("drag_coefficient", made_up::Normal(0.0, 0.02), "drag_factor")};
  ResultFolder folder = ResultFolder::Create(temporary / "out", campaign);
  std::vector<CaseResult> results;
  for (std::uint64_t k = 0; k < flown; ++k) results.push_back(report_test::MakeCase(k));
  if (flown > 3) results[3].outcome = Outcome::kImpact;
  folder.Append(results);
  if (flown < cases) folder.Quarantine({flown, "killed its workers"});
  CampaignSummary summary = BuildSummary(folder, campaign);
  if (flown > 0) summary.nominal = report_test::MakeCase(0);
  return Json::parse(SummaryJson(summary));
}

TEST(SummarySchema, HoldsForCompleteIncompleteAndEmptyCampaigns) {
  for (const auto& [cases, flown] : {std::pair{60, 60}, {60, 59}, {5, 0}}) {
    std::vector<std::string> problems;
    Check(SummaryOf(static_cast<std::uint64_t>(cases), static_cast<std::uint64_t>(flown)), Schema(), "$",
          problems);
    EXPECT_THAT(problems, IsEmpty());
  }
}

TEST(SummarySchema, IsDocumentedKeyByKey) {
  const std::string text = TextOfFile(DISPERSA_TEST_DATA "/../../core/analysis/README.md");
  const Json schema = Schema();
  for (const auto& [key, rule] : schema["properties"].items()) EXPECT_THAT(text, HasSubstr("`" + key + "`"));
  for (const auto& [key, rule] : schema["properties"]["requirements"]["items"]["properties"].items())
    EXPECT_THAT(text, HasSubstr("`" + key + "`"));
}

TEST(SummarySchema, SeesWhatIsWrong) {
  Json summary = SummaryOf(60, 60);
  summary["flown"] = "sixty";
  summary["requirements"][0].erase("failures");
  summary["requirements"][0]["verdict"] = "maybe";
  summary["more"] = 1;
  std::vector<std::string> problems;
  Check(summary, Schema(), "$", problems);
  EXPECT_EQ(problems.size(), 4u);
}

}  // namespace dispersa::analysis_schema_test
