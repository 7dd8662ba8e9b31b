// dispersa compare: two campaigns, case by case where their draws match.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "core/campaign/input_error.h"
#include "core/flight/flight_inputs.h"
#include "core/report/case_columns.h"
#include "core/report/comparison.h"
#include "core/report/output_file.h"
#include "core/report/text.h"
#include "services/cli/campaign_differences.h"
#include "services/cli/command.h"
#include "services/cli/stored_campaign.h"
#include "services/cli/writable.h"

namespace dispersa {
namespace {

struct CompareOptions {
  std::string a;
  std::string b;
  std::vector<std::string> metrics;
  std::string out;
};

CaseColumns AllColumns(const ResultFolder& folder) {
  std::vector<int> inputs(InputCount(folder.stages()));
  std::iota(inputs.begin(), inputs.end(), 0);
  return ReadColumns(folder, inputs);
}

void CheckMetrics(const std::vector<std::string>& metrics) {
  const std::vector<std::string>& names = MetricNames();
  for (const std::string& metric : metrics) {
    if (std::find(names.begin(), names.end(), metric) == names.end())
      throw InputError("--metric: '" + metric + "' is not a metric",
                       "a name in cases.csv without its prefix 'metric_'");
  }
}

std::vector<CampaignChange> ChangesOf(const Campaign& a, const Campaign& b) {
  std::vector<CampaignChange> changes;
  for (const ValueDifference& each : DifferencesOf(a.canonical_yaml, b.canonical_yaml))
    changes.push_back({each.path, each.a, each.b});
  return changes;
}

std::string IntervalText(const Interval& interval) {
  const auto text = [](double value, const char* none) {
    return std::isfinite(value) ? fmt::format("{:.4g}", value) : none;
  };
  if (!std::isfinite(interval.lower) && !std::isfinite(interval.upper)) return "–";
  return text(interval.lower, "-inf") + " to " + text(interval.upper, "inf");
}

std::string NumberText(double value) { return std::isfinite(value) ? fmt::format("{:.4g}", value) : "–"; }

void PrintText(const Comparison& comparison) {
  for (const auto& [letter, side] : {std::pair{"A", &comparison.a}, std::pair{"B", &comparison.b}})
    fmt::print("{}: {} ({}), {} of {} flights completed\n", letter, side->name, side->autopilot,
               side->completed, side->flown);
  fmt::print("{}\n{}\n\n", comparison.pairing.sentence, comparison.sentence);
  fmt::print("{:<37} {:>10} {:>10} {:>11} {:>26} {:>11} {:>11}  {}\n", "metric", "median A", "median B", "B - A",
             "95 % interval", "p99 B - A", "p, Holm", "B is");
  for (const MetricComparison& metric : comparison.metrics) {
    const auto tail =
        std::find_if(metric.tails.begin(), metric.tails.end(), [&](const PercentileComparison& each) {
          return each.name == (metric.info.worse == Worse::kSmaller ? "p01" : "p99");
        });
    fmt::print("{:<37} {:>10} {:>10} {:>11} {:>26} {:>11} {:>11}  {}\n", metric.metric, NumberText(metric.median_a),
               NumberText(metric.median_b), NumberText(metric.difference), IntervalText(metric.interval),
               tail == metric.tails.end() ? "–" : NumberText(tail->difference), NumberText(metric.p_holm),
               metric.finding);
  }
  for (const RequirementComparison& requirement : comparison.requirements) {
    fmt::print("\n{}: fails in {} of {} in A, {} of {} in B; {} {}\n", requirement.words,
               requirement.failures_a, requirement.n_a, requirement.failures_b, requirement.n_b,
               comparison.pairing.paired ? fmt::format("only in A {}, only in B {}; McNemar's p",
                                                       requirement.only_a_fails, requirement.only_b_fails)
                                         : "Fisher's p",
               NumberText(requirement.p));
  }
}

ExitCode CompareFolders(const CompareOptions& options, const GlobalOptions& global) {
  CheckMetrics(options.metrics);
  RequireWritableFolder("--out", options.out);
  const StoredCampaign a = OpenStored(options.a);
  const StoredCampaign b = OpenStored(options.b);
  const CaseColumns cases_a = AllColumns(a.folder);
  const CaseColumns cases_b = AllColumns(b.folder);
  for (const auto& [name, cases] : {std::pair{&options.a, &cases_a}, std::pair{&options.b, &cases_b}})
    if (cases->rows() == 0) throw InputError(*name + ": no case has a result");
  const Comparison comparison = Compare({options.a, a.folder.Provenance("engine"), a.campaign, cases_a},
                                        {options.b, b.folder.Provenance("engine"), b.campaign, cases_b},
                                        options.metrics, ChangesOf(a.campaign, b.campaign));
  const std::string json = ComparisonJson(comparison);
  if (!options.out.empty()) {
    const std::filesystem::path out = options.out;
    std::error_code error;
    std::filesystem::create_directories(out, error);
    if (error)
      throw InputError("--out: " + options.out + ": " + error.message(), "a folder that can be written");
    WriteFile(out / "compare.json", json);
    WriteFile(out / "compare.html", ComparisonPage(comparison, cases_a, cases_b));
  }
  if (global.json) {
    fmt::print("{}", json);
  } else {
    PrintText(comparison);
    if (!options.out.empty())
      fmt::print("\ncomparison: {}\n", (std::filesystem::path(options.out) / "compare.html").string());
  }
  return kExitDone;
}

}  // namespace

void AddCompareCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command =
      app.add_subcommand("compare", "compare two result folders, paired by case where the draws match");
  command->add_option("a", options->a, "result folder")->required()->type_name(kFolderType);
  command->add_option("b", options->b, "result folder")->required()->type_name(kFolderType);
  command->add_option("--out", options->out, "folder for compare.html and compare.json")
      ->type_name(kFolderType);
  command->add_option("--metric", options->metrics, "metric to compare, instead of all; may be repeated");
  command->footer(
      "Example: dispersa compare results/controllers-1a2b3c4d results/controllers_pd-5e6f7a8b --out "
      "comparison");
  command->callback([options, &invocation] {
    invocation.command = [options](const GlobalOptions& global) { return CompareFolders(*options, global); };
  });
}

}  // namespace dispersa
