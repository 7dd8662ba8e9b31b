#include "core/analysis/junit.h"

#include <fmt/format.h>

#include "core/results/text.h"

namespace dispersa {
namespace {

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
  std::string xml =
      fmt::format("    <testcase classname=\"{}\" name=\"{}\"", HtmlText(suite), HtmlText(name));
  if (finding.element.empty()) return xml + "/>\n";
  return xml + fmt::format(">\n      <{} message=\"{}\"/>\n    </testcase>\n", finding.element,
                           HtmlText(finding.text));
}

}  // namespace

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
