// dispersa compare: two campaigns, case by case where their draws match.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <vector>

#include "core/campaign/input_error.h"
#include "core/flight/flight_inputs.h"
#include "core/report/case_columns.h"
#include "core/report/comparison.h"
#include "core/report/metric_catalogue.h"
#include "core/report/text.h"
#include "services/cli/command.h"
#include "services/cli/flight_json.h"
#include "services/cli/stored_campaign.h"

namespace dispersa {
namespace {

struct CompareOptions {
  std::string a;
  std::string b;
  std::vector<std::string> metrics;
};

CaseColumns AllColumns(const ResultFolder& folder) {
  std::vector<int> inputs(InputColumns().size());
  std::iota(inputs.begin(), inputs.end(), 0);
  return ReadColumns(folder, inputs);
}

void CheckMetrics(const std::vector<std::string>& metrics) {
  const std::vector<std::string>& names = MetricNames();
  for (const std::string& metric : metrics) {
    if (std::find(names.begin(), names.end(), metric) == names.end())
      throw InputError("--metric: '" + metric + "' is not a metric",
                       "a name in cases.csv without its prefix 'metric_'");
    if (DescribeMetric(metric).worse != Worse::kLarger)
      throw InputError("--metric: '" + metric + "' cannot be compared", "a metric of which less is better");
  }
}

nlohmann::ordered_json IntervalJson(const Interval& interval) {
  return {JsonNumber(interval.lower), JsonNumber(interval.upper)};
}

void PrintJson(const Comparison& comparison, const std::string& a, const std::string& b) {
  auto metrics = nlohmann::ordered_json::array();
  for (const MetricComparison& metric : comparison.metrics) {
    const PairedDifference& d = metric.difference;
    auto better = nlohmann::ordered_json::array();
    for (const auto& c : metric.better)
      better.push_back({{"case_index", c.case_index}, {"a", JsonNumber(c.a)}, {"b", JsonNumber(c.b)}});
    metrics.push_back({{"metric", metric.metric},
                       {"a_better", d.worse},
                       {"b_better", d.better},
                       {"equal", d.equal},
                       {"lost_a", d.lost_a},
                       {"lost_b", d.lost_b},
                       {"median_difference", JsonNumber(d.median_difference)},
                       {"difference_interval", IntervalJson(d.difference_interval)},
                       {"median_ratio", JsonNumber(d.median_ratio)},
                       {"ratio_interval", IntervalJson(d.ratio_interval)},
                       {"sign_test_p", JsonNumber(d.sign_test_p)},
                       {"b_better_cases", std::move(better)}});
  }
  const nlohmann::ordered_json report = {{"schema", "dispersa/compare/1"},
                                         {"a", a},
                                         {"b", b},
                                         {"confidence", kComparisonConfidence},
                                         {"pairs", comparison.pairs},
                                         {"unpaired", comparison.unpaired},
                                         {"metrics", std::move(metrics)}};
  fmt::print("{}\n", report.dump(2));
}

void PrintText(const Comparison& comparison, const std::string& a, const std::string& b) {
  fmt::print("a: {}\nb: {}\npairs: {}, cases without a pair: {}; intervals of {}\n\n", a, b, comparison.pairs,
             comparison.unpaired, PercentText(kComparisonConfidence));
  fmt::print("{:<32}{:>12}{:>26}{:>9}{:>20}{:>10}{:>10}\n", "metric", "b - a", "interval", "b / a",
             "interval", "a better", "b better");
  for (const MetricComparison& metric : comparison.metrics) {
    const PairedDifference& d = metric.difference;
    const auto interval = [](const Interval& i, const char* format) {
      return fmt::format(fmt::runtime(format), i.lower, i.upper);
    };
    fmt::print("{:<32}{:>12.4g}{:>26}{:>9.3g}{:>20}{:>10}{:>10}\n", metric.metric, d.median_difference,
               interval(d.difference_interval, "{:.4g} to {:.4g}"), d.median_ratio,
               interval(d.ratio_interval, "{:.3g} to {:.3g}"), d.worse, d.better);
  }
}

ExitCode CompareFolders(const CompareOptions& options, const GlobalOptions& global) {
  CheckMetrics(options.metrics);
  const StoredCampaign a = OpenStored(options.a);
  const StoredCampaign b = OpenStored(options.b);
  const Comparison comparison = Compare(AllColumns(a.folder), AllColumns(b.folder),
                                        options.metrics.empty() ? ComparedMetrics() : options.metrics);
  if (comparison.pairs == 0)
    throw InputError("no case of " + options.a + " has the draws of the same case of " + options.b);
  const std::string name_a = a.campaign.name + " (" + a.campaign.autopilot.name + ")";
  const std::string name_b = b.campaign.name + " (" + b.campaign.autopilot.name + ")";
  if (global.json) {
    PrintJson(comparison, name_a, name_b);
  } else {
    PrintText(comparison, name_a, name_b);
  }
  return kExitDone;
}

}  // namespace

void AddCompareCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command =
      app.add_subcommand("compare", "compare two result folders, paired by case where the draws match");
  command->add_option("a", options->a, "result folder")->required();
  command->add_option("b", options->b, "result folder")->required();
  command->add_option("--metric", options->metrics,
                      "metric to compare, instead of the usual ones; may be repeated");
  command->footer("Example: dispersa compare results/controllers-1a2b3c4d results/controllers_pd-5e6f7a8b");
  command->callback([options, &invocation] {
    invocation.command = [options](const GlobalOptions& global) { return CompareFolders(*options, global); };
  });
}

}  // namespace dispersa
