#include "core/analysis/junit.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/results/text.h"

namespace dispersa {
namespace {

/// What a requirement comes to for a continuous-integration service.
struct Finding {
  std::string element;  ///< "failure", "error", "skipped"; empty: it passed
  std::string text;
  std::string type = {};  ///< of a failure or an error
};

Finding FindingOf(const RequirementSummary& requirement, const Standing::Requirement& standing) {
  const std::string text = JudgedSentence(requirement, standing) + AdviceSentence(requirement);
  if (standing.verdict == "pass") return {};
  return {standing.verdict == "fail" ? "failure" : "error", text, standing.verdict};
}

std::string NameOf(const RequirementSummary& requirement) {
  return (requirement.id.empty() ? "" : requirement.id + ": ") + RequirementWords(requirement);
}

std::string TestCase(const std::string& suite, const std::string& name, const Finding& finding) {
  std::string xml =
      fmt::format("    <testcase classname=\"{}\" name=\"{}\" time=\"0\"", HtmlText(suite), HtmlText(name));
  if (finding.element.empty()) return xml + "/>\n";
  const std::string type = finding.element == "skipped" ? "" : fmt::format(" type=\"{}\"", finding.type);
  return xml + fmt::format(">\n      <{}{} message=\"{}\"/>\n    </testcase>\n", finding.element, type,
                           HtmlText(finding.text));
}

}  // namespace

std::string JUnitXml(const CampaignSummary& summary) {
  std::string cases;
  int failures = 0, errors = 0, skipped = 0, tests = 0;
  std::map<std::string, int> named;
  const auto add = [&](std::string name, const Finding& finding) {
    // Services take two tests of one name for one.
    if (const int same = ++named[name]; same > 1) name += fmt::format(" ({})", same);
    ++tests;
    failures += finding.element == "failure";
    errors += finding.element == "error";
    skipped += finding.element == "skipped";
    cases += TestCase(summary.name, name, finding);
  };
  const Standing& standing = summary.standing;
  for (std::size_t i = 0; i < summary.requirements.size(); ++i)
    add(NameOf(summary.requirements[i]), FindingOf(summary.requirements[i], standing.requirements[i]));
  // A check without failures is no test that passed: it was seen, and not required.
  for (const LoadCheck& check : summary.load_checks)
    if (check.failures > 0)
      add("load check: " + check.metric, {"failure", LoadCheckSentence(check), "load_check"});
  if (summary.verdict == CampaignVerdict::kIncomplete)
    add("every case flown", {"error", MissingWords(summary.flown, summary.cases), "incomplete"});
  else if (standing.verdict == StandingVerdict::kNothingJudged && summary.requirements.empty())
    add("requirements", {"skipped", "The campaign states no requirement: nothing is judged."});
  for (const Standing::Dropped& dropped : standing.dropped)
    add(dropped.words, {"error",
                        fmt::format("Changed or left out after its flights were flown. Its last verdict: {}.",
                                    dropped.verdict.empty() ? "none" : dropped.verdict),
                        "post_hoc"});
  const bool judged_otherwise = standing.is_post_hoc && standing.dropped.empty() &&
                                std::none_of(standing.requirements.begin(), standing.requirements.end(),
                                             [](const Standing::Requirement& one) { return one.post_hoc; });
  if (judged_otherwise)
    add("verdicts",
        {"error", "The rules of judgement were changed after the first case was flown.", "post_hoc"});
  std::string notes;
  for (const std::string& note : StandingNotes(standing, summary)) notes += note + "\n";
  for (std::size_t i = 0; i < standing.requirements.size(); ++i)  // a test that passes has no text of its own
    if (standing.requirements[i].verdict == "pass" && !standing.requirements[i].reason.empty())
      notes += NameOf(summary.requirements[i]) + ": " + standing.requirements[i].reason + "\n";
  for (const std::string& warning : Warnings(summary)) notes += warning + "\n";
  for (const LoadCheck& check : summary.load_checks) notes += LoadCheckSentence(check) + "\n";
  if (!notes.empty()) cases += fmt::format("    <system-out>{}</system-out>\n", HtmlText(notes));
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n  <testsuite name=\"{}\" tests=\"{}\" "
      "failures=\"{}\" errors=\"{}\" skipped=\"{}\" time=\"0\">\n{}  </testsuite>\n</testsuites>\n",
      HtmlText(summary.name), tests, failures, errors, skipped, cases);
}

}  // namespace dispersa
