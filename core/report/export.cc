#include "core/report/export.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/flight/flight_inputs.h"
#include "core/report/json_number.h"
#include "core/report/output_file.h"
#include "core/report/text.h"

namespace dispersa {
namespace {

using Json = nlohmann::ordered_json;

/// What a requirement comes to for a continuous-integration service.
struct Finding {
  std::string element;  ///< "failure", "error", "skipped"; empty: it passed
  std::string text;
};

Finding FindingOf(const RequirementSummary& requirement) {
  if (requirement.verdict == "pass") return {};
  if (requirement.verdict == "fail") return {"failure", requirement.sentence};
  if (requirement.verdict == "study")
    return {requirement.failures > 0 ? "failure" : "skipped", requirement.sentence};
  // What the campaign did not ask itself holds nothing up while nothing has failed it.
  if (requirement.by_default && requirement.failures == 0) return {"skipped", requirement.sentence};
  return {"error", requirement.sentence};
}

std::string TestCase(const std::string& suite, const std::string& name, const Finding& finding) {
  std::string xml = fmt::format("    <testcase classname=\"{}\" name=\"{}\"", HtmlText(suite), HtmlText(name));
  if (finding.element.empty()) return xml + "/>\n";
  return xml + fmt::format(">\n      <{} message=\"{}\"/>\n    </testcase>\n", finding.element,
                           HtmlText(finding.text));
}

}  // namespace

void ExportJsonLines(const ResultFolder& folder, const std::filesystem::path& file) {
  OutputFile output(file);
  folder.ForEach([&](const CaseResult& result) {
    Json line = {{"case_index", result.case_index},
                 {"outcome", OutcomeName(result.outcome)},
                 {"end_time_s", Number(result.end_time_s)},
                 {"end_stage", result.end_stage},
                 {"reason", result.reason}};
    for (std::size_t i = 0; i < result.inputs.size(); ++i)
      line["input_" + InputColumns()[i].name] = Number(result.inputs[i]);
    for (std::size_t i = 0; i < result.metrics.size(); ++i)
      line["metric_" + MetricNames()[i]] = Number(result.metrics[i]);
    line["digest"] = result.digest.Hex();
    output.Write(line.dump() + "\n");
  });
  output.Commit();
}

std::string JUnitXml(const CampaignSummary& summary) {
  std::string cases;
  int failures = 0, errors = 0, skipped = 0, tests = 0;
  const auto add = [&](const std::string& name, const Finding& finding) {
    ++tests;
    failures += finding.element == "failure";
    errors += finding.element == "error";
    skipped += finding.element == "skipped";
    cases += TestCase(summary.name, name, finding);
  };
  for (const RequirementSummary& requirement : summary.requirements)
    add(RequirementWords(requirement), FindingOf(requirement));
  if (summary.verdict == CampaignVerdict::kIncomplete || summary.requirements.empty()) {
    add("every case flown",
        summary.verdict == CampaignVerdict::kIncomplete
            ? Finding{"error", fmt::format("{} of {} cases have a result", summary.flown, summary.cases)}
            : Finding{});
  }
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n  <testsuite name=\"{}\" tests=\"{}\" "
      "failures=\"{}\" errors=\"{}\" skipped=\"{}\">\n{}  </testsuite>\n</testsuites>\n",
      HtmlText(summary.name), tests, failures, errors, skipped, cases);
}

}  // namespace dispersa
