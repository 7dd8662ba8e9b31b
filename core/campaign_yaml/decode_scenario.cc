#include "core/campaign_yaml/decode.h"
#include "core/campaign_yaml/inline_files.h"
#include "core/input/field_reader.h"

namespace dispersa {

void DescribeScenarioFile(Fields& fields, Scenario& scenario) {
  fields.Schema(kScenarioSchema);
  Describe(fields, scenario);
}

Scenario DecodeScenario(const InputNode& node, const std::string& path, std::vector<InputProblem>& problems) {
  Scenario scenario;
  if (node.file == nullptr) return scenario;  // already reported
  if (!CheckSchema(node, kScenarioSchema, false, path, problems)) return scenario;
  ReadFields(node, path, problems, [&](Fields& fields) { DescribeScenarioFile(fields, scenario); });
  return scenario;
}

}  // namespace dispersa
