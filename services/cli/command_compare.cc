// dispersa compare: two campaigns, case by case where their draws match.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/analysis/comparison.h"
#include "core/results/text.h"
#include "services/cli/command.h"
#include "services/client/folder_comparison.h"
#include "services/client/writable.h"
#include "services/log/log.h"

namespace dispersa {
namespace {

struct CompareOptions {
  std::string a;
  std::string b;
  std::vector<std::string> metrics;
  std::string out;
  double practical_percent = 100.0 * kPracticalShare;
};

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
    fmt::print("{}: {} ({}), {} of {} flights completed{}\n", letter, SideTitle(comparison, *side),
               side->autopilot, side->completed, side->flown,
               side->flown < side->cases ? fmt::format(", {} cases missing", side->cases - side->flown) : "");
  for (const auto& [letter, side] : {std::pair{"A", &comparison.a}, std::pair{"B", &comparison.b}})
    if (!side->nominal_loss.empty()) fmt::print("warning: {}: {}\n", letter, side->nominal_loss);
  if (!comparison.differs.empty()) fmt::print("The campaign files differ in {}.\n", comparison.differs);
  fmt::print("{}\n{}\n\n", comparison.pairing.sentence, comparison.sentence);
  fmt::print("{:<37} {:>10} {:>10} {:>11} {:>26} {:>11} {:>11}  {}\n", "metric", "median A", "median B",
             "B - A", "95 % interval", "p99 B - A", "p, Holm", "B is");
  for (const MetricComparison* ranked : ByEffect(comparison)) {
    const MetricComparison& metric = *ranked;
    const auto tail =
        std::find_if(metric.tails.begin(), metric.tails.end(), [&](const PercentileComparison& each) {
          return each.name == (metric.info.worse == Worse::kSmaller ? "p01" : "p99");
        });
    fmt::print("{:<37} {:>10} {:>10} {:>11} {:>26} {:>11} {:>11}  {}\n", metric.metric,
               NumberText(metric.median_a), NumberText(metric.median_b), NumberText(metric.difference),
               IntervalText(metric.interval), tail == metric.tails.end() ? "–" : NumberText(tail->difference),
               PValueText(metric.found_p),
               metric.finding + (metric.found_in == "median" ? "" : " in " + metric.found_in));
  }
  for (const Comparison::LoadCheck& check : comparison.load_checks)
    fmt::print("\n{}, a limit of the vehicle: exceeded in {} flights of A, in {} of B\n", check.metric,
               check.failures_a, check.failures_b);
  for (const RequirementComparison& requirement : comparison.requirements) {
    fmt::print("\n{}: fails in {} of {} in A, {} of {} in B; {} {}\n", requirement.words,
               requirement.failures_a, requirement.n_a, requirement.failures_b, requirement.n_b,
               comparison.pairing.paired ? fmt::format("only in A {}, only in B {}; McNemar's p",
                                                       requirement.only_a_fails, requirement.only_b_fails)
                                         : "Fisher's p",
               PValueText(requirement.p));
  }
}

ExitCode CompareAndShow(const CompareOptions& options, const GlobalOptions& global) {
  RequireWritableFolder("--out", options.out);
  const FolderComparison compared =
      CompareFolders(options.a, options.b, options.metrics, 0.01 * options.practical_percent);
  if (!options.out.empty()) WriteComparison(compared, options.out);
  if (global.json) {
    fmt::print("{}", ComparisonJson(compared.comparison));
  } else {
    PrintText(compared.comparison);
    if (!options.out.empty())
      fmt::print("\ncomparison: {}\n", (std::filesystem::path(options.out) / "compare.html").string());
  }
  const std::vector<std::string> incomplete = IncompleteSides(compared.comparison);
  for (const std::string& side : incomplete) LogWarning("{}", side);
  return incomplete.empty() ? kExitDone : kExitIncomplete;
}

}  // namespace

void AddCompareCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command =
      app.add_subcommand("compare", "compare two result folders, case by case if their draws are the same");
  command->add_option("a", options->a, "result folder")->required()->type_name(kFolderType);
  command->add_option("b", options->b, "result folder")->required()->type_name(kFolderType);
  command->add_option("--out", options->out, "folder for compare.html and compare.json")
      ->type_name(kFolderType);
  command->add_option("--metric", options->metrics, "metric to compare, instead of all; may be repeated")
      ->type_name(kMetricType);
  command
      ->add_option("--practical", options->practical_percent,
                   "per cent of a requirement's limit, or without one of the metric's spread, from which a "
                   "difference matters; 0: any difference does")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  command->footer(
      "Example: dispersa compare results/controllers-1a2b3c4d results/controllers_pd-5e6f7a8b --out "
      "comparison");
  Bind(command, invocation, options, CompareAndShow);
}

}  // namespace dispersa
