// compare.html.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/analysis/comparison.h"
#include "core/pages/embedded.h"
#include "core/pages/html_parts.h"
#include "core/pages/svg_chart.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

constexpr char kComparisonNavigation[] =
    "<nav><a href=\"#compared\">Compared campaigns</a><a href=\"#requirements\">Requirements</a><a "
    "href=\"#cases\">Harmed and rescued</a><a href=\"#metrics\">Metrics</a><a "
    "href=\"#figures\">Figures</a><a href=\"#changes\">Largest changes</a><a "
    "href=\"#methods\">Methods</a></nav>\n";
/// A longer table can be collapsed. compare.json has all rows.
constexpr std::size_t kOpenRows = 20;
constexpr std::size_t kListedCases = 1000;

std::string Definition(const std::string& html) { return "<span class=\"definition\">" + html + "</span>"; }

std::string BoundText(double value) {
  if (std::isinf(value)) return value > 0.0 ? "∞" : "−∞";
  return ReadableText(value);
}

std::string IntervalText(const Interval& interval) {
  if (!std::isfinite(interval.lower) && !std::isfinite(interval.upper)) return "no limits";
  return BoundText(interval.lower) + " … " + BoundText(interval.upper);
}

/// A path in a campaign file, with line breaks allowed after its dots.
std::string PathCell(const std::string& path) {
  std::string html;
  for (const char c : HtmlText(path)) html += c == '.' ? ".<wbr>" : std::string(1, c);
  return "<code>" + html + "</code>";
}

std::string DifferenceCell(double difference, const Interval& interval) {
  if (!std::isfinite(difference)) return "–";
  return ReadableText(difference) + Definition(IntervalText(interval));
}

std::string PText(double p) {
  if (!std::isfinite(p)) return "–";
  return p < 1e-4 ? fmt::format("{:.0e}", p) : fmt::format("{:.4f}", p);
}

/// `table`, or the table in a part that can be collapsed if it is long.
std::string Folded(const HtmlTable& table, std::size_t rows, const std::string& summary) {
  if (rows <= kOpenRows) return table.Html();
  return "<details open><summary>" + summary + "</summary>\n" + table.Html() + "</details>\n";
}

std::string FindingBadge(const MetricComparison& metric) {
  const std::string_view style = metric.finding == "better"    ? "pass"
                                 : metric.finding == "worse"   ? "fail"
                                 : metric.finding == "differs" ? "inconclusive"
                                                               : "";
  if (style.empty()) return "<span class=\"soft\">not shown</span>";
  return fmt::format("<span class=\"badge {}\">{}</span>", style,
                     metric.finding == "differs" ? "differs" : "B " + metric.finding);
}

std::string Header(const Comparison& c) {
  const auto found = [&](const char* finding) {
    return std::count_if(c.metrics.begin(), c.metrics.end(),
                         [&](const MetricComparison& metric) { return metric.finding == finding; });
  };
  std::string html = fmt::format(
      "<header>\n"
      "<h1>{} against {}</h1>\n"
      "<p class=\"soft\">B is compared with A. Differences are B minus A.</p>\n"
      "<div class=\"headline\"><span class=\"badge design\">{}</span><p>{}</p></div>\n"
      "<div class=\"tiles\">",
      HtmlText(c.b.name), HtmlText(c.a.name), c.pairing.paired ? "paired" : "unpaired", HtmlText(c.sentence));
  html += c.pairing.paired ? Tile(std::to_string(c.pairing.shared), "pairs of flights")
                           : Tile(fmt::format("{} and {}", c.a.flown, c.b.flown), "flights");
  if (c.independent) {
    html += Tile(std::to_string(found("better")), "metrics in which B is better") +
            Tile(std::to_string(found("worse")), "metrics in which B is worse");
  }
  if (c.pairing.paired) {
    html += Tile(std::to_string(c.harmed.size()), "cases harmed") +
            Tile(std::to_string(c.rescued.size()), "cases rescued");
  }
  return html + "</div>\n</header>\n";
}

std::string ComparedSection(const Comparison& c) {
  std::string html = "<h2 id=\"compared\">Compared campaigns</h2>\n";
  HtmlTable table({{""}, {"A"}, {"B"}});
  const auto row = [&](const char* title, const std::string& a, const std::string& b) {
    table.Row({title, HtmlText(a), HtmlText(b)});
  };
  row("Campaign", c.a.name, c.b.name);
  table.Row({"Folder", Code(c.a.folder), Code(c.b.folder)});
  table.Row({"Campaign id", Code(c.a.id), Code(c.b.id)});
  table.Row({"Engine", Code(c.a.engine), Code(c.b.engine)});
  row("Vehicle", c.a.vehicle, c.b.vehicle);
  row("Reference", c.a.reference, c.b.reference);
  row("Autopilot", c.a.autopilot, c.b.autopilot);
  row("Sampling", fmt::format("{}, seed {}", c.a.sampling, c.a.seed),
      fmt::format("{}, seed {}", c.b.sampling, c.b.seed));
  const auto flights = [](const Comparison::Side& side) {
    return fmt::format("{} of {} flown, {} completed, {} lost", side.flown, side.cases, side.completed,
                       side.flown - side.completed);
  };
  row("Flights", flights(c.a), flights(c.b));
  html += table.Html("ids") + "<p>" + HtmlText(c.pairing.sentence) + "</p>\n";
  if (!c.pairing.changed.empty() && c.pairing.shared > 0) {
    HtmlTable changed({{"Input that was changed"}, {"Shared cases in which it differs", true}});
    for (const Pairing::ChangedInput& input : c.pairing.changed)
      changed.Row(
          {InputNames(input.key, input.input), fmt::format("{} of {}", input.cases, c.pairing.shared)});
    html +=
        Folded(changed, c.pairing.changed.size(), fmt::format("{} inputs differ", c.pairing.changed.size()));
  }
  html += "<h3>Differences of the two campaign files</h3>\n";
  if (c.changes.empty()) return html + "<p>None.</p>\n";
  HtmlTable changes({{"Value"}, {"A"}, {"B"}});
  for (const CampaignChange& change : c.changes) {
    const auto text = [](const std::string& value) { return value.empty() ? "–" : HtmlText(value); };
    changes.Row({PathCell(change.path), text(change.a), text(change.b)});
  }
  return html + "<div class=\"breaking\">" +
         Folded(changes, c.changes.size(), fmt::format("{} values differ", c.changes.size())) + "</div>\n";
}

std::string RequirementsSection(const Comparison& c) {
  std::string html = "<h2 id=\"requirements\">Requirements, flight by flight</h2>\n";
  if (c.requirements.empty()) return html + "<p>Neither campaign states any.</p>\n";
  for (const RequirementComparison& r : c.requirements) {
    const auto share = [](std::size_t failures, std::size_t n) {
      return n == 0 ? std::string("–")
                    : fmt::format("{} of {} ({})", failures, n,
                                  PercentText(static_cast<double>(failures) / static_cast<double>(n)));
    };
    const auto fact = [](const std::string& title, const std::string& value) {
      return fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", title, value);
    };
    html += fmt::format(
        "<section class=\"requirement\"><p class=\"claim\"><b>{}</b> {}<br>{}</p>\n<dl class=\"facts\">",
        HtmlText(DescribeMetric(r.metric).title), HtmlText(r.words.substr(r.metric.size() + 1)),
        r.in_a && r.in_b ? Code(r.metric)
                         : Code(r.metric) + fmt::format(" required by {} alone", r.in_a ? "A" : "B"));
    html += fact("fails in A", share(r.failures_a, r.n_a)) + fact("fails in B", share(r.failures_b, r.n_b));
    const auto percent = [](double value) {
      if (!std::isfinite(value)) return BoundText(value);
      return fmt::format("{:+.4g} %", 100.0 * value + 0.0);
    };
    html += fact("difference of the rates", percent(r.difference));
    if (std::isfinite(r.interval.lower))
      html += fact("its 95 % limits", percent(r.interval.lower) + " … " + percent(r.interval.upper));
    if (c.pairing.paired) {
      html += fact("only A fails", std::to_string(r.only_a_fails)) +
              fact("only B fails", std::to_string(r.only_b_fails)) +
              fact("both fail", std::to_string(r.both_fail)) +
              fact("both meet it", std::to_string(r.both_meet));
    }
    html += fact(c.pairing.paired ? "McNemar’s test, p" : "Fisher’s test, p", PText(r.p)) +
            fact("after Holm", PText(r.p_holm)) + "</dl></section>\n";
  }
  return html;
}

/// The commands that fly a case again in both campaigns. A campaign that cannot be replayed has none.
std::string ReplayBoth(const Comparison& c, std::uint64_t case_index) {
  std::string html;
  for (const Comparison::Side* side : {&c.a, &c.b}) {
    const std::string command = ReplayCommand(*side, case_index);
    if (command.empty()) continue;
    html += (html.empty() ? "" : "<br>") + ("<code class=\"copy\">" + HtmlText(command) + "</code>");
  }
  return html.empty() ? "–" : html;
}

std::string CasesTable(const std::vector<ChangedCase>& cases, const Comparison& c, const char* title,
                       const char* what) {
  std::string html = fmt::format("<h3>{}: {}</h3>\n", title, cases.size());
  if (cases.empty()) return html + fmt::format("<p>{}</p>\n", what);
  HtmlTable table({{"Case", true}, {"Requirement"}, {"A", true}, {"B", true}, {"Replay both"}});
  std::size_t listed = 0;
  for (const ChangedCase& one : cases) {
    if (++listed > kListedCases) break;
    for (std::size_t i = 0; i < one.reasons.size(); ++i) {
      const ChangedCase::Reason& reason = one.reasons[i];
      const auto value = [](double number, Outcome outcome) {
        if (std::isfinite(number)) return ReadableText(number);
        std::string words = OutcomeName(outcome);
        std::replace(words.begin(), words.end(), '_', ' ');
        return words;
      };
      table.Row({i == 0 ? std::to_string(one.case_index) : "", HtmlText(reason.requirement),
                 value(reason.a, one.outcome_a), value(reason.b, one.outcome_b),
                 i > 0 ? "" : ReplayBoth(c, one.case_index)});
    }
  }
  return html +
         Folded(table, cases.size(),
                cases.size() > kListedCases
                    ? fmt::format("the first {}; <code>compare.json</code> has all of them", kListedCases)
                    : "all of them");
}

std::string CasesSection(const Comparison& c) {
  std::string html = "<h2 id=\"cases\">Harmed and rescued cases</h2>\n";
  if (!c.pairing.paired)
    return html + "<p>The campaigns are not paired: no case of one has a partner in the other.</p>\n";
  html +=
      "<p>Harmed: the case meets a requirement in A and fails it in B, or its flight is lost in B. Rescued: "
      "the reverse. Run the commands in the folder where the comparison was started. They check that the "
      "flight is the same to the last bit.</p>\n";
  return html + CasesTable(c.harmed, c, "Harmed", "None.") + CasesTable(c.rescued, c, "Rescued", "None.");
}

bool IsPart(const std::string& metric) {
  return metric.find("_stage") != std::string::npos || metric.find("_coast") != std::string::npos;
}

std::string MetricsSection(const Comparison& c) {
  std::string html = fmt::format(
      "<h2 id=\"metrics\">Every metric</h2>\n"
      "<p>{} Its 95 % limits stand below it. The tails are on the bad side: 95 and 99 %, or 5 and 1 % if "
      "less is worse. <code>compare.json</code> has the other percentiles. “Not shown”: Holm’s adjusted p is "
      "above 5 %. This does not show that the campaigns are equal.</p>\n",
      c.pairing.paired ? "The difference is the median of B minus A over the pairs."
                       : "The difference is that of the medians.");
  HtmlTable table({{"Metric"},
                   {"Unit", true},
                   {"Median A", true},
                   {"Median B", true},
                   {"Difference", true},
                   {"of p95", true},
                   {"of p99", true},
                   {c.pairing.paired ? "B better : worse" : "Flights", true},
                   {"p, Holm", true},
                   {"Finding"}});
  for (const MetricComparison& metric : c.metrics) {
    const auto tail = [&](const char* name, const char* other) {
      for (const PercentileComparison& each : metric.tails)
        if (each.name == name || (metric.info.worse == Worse::kSmaller && each.name == other))
          return DifferenceCell(each.difference, each.interval);
      return std::string("–");
    };
    std::string title = HtmlText(metric.info.title);
    if (metric.info.worse == Worse::kFartherFromZero) title += Definition("magnitude");
    if (metric.lost_a + metric.lost_b > 0)
      title += Definition(fmt::format("lost: {} in A, {} in B", metric.lost_a, metric.lost_b));
    if (metric.undefined > 0) title += Definition(fmt::format("undefined in {}", metric.undefined));
    table.Row(
        {title, HtmlText(metric.info.unit), ReadableText(metric.median_a), ReadableText(metric.median_b),
         DifferenceCell(metric.difference, metric.interval), tail("p95", "p05"), tail("p99", "p01"),
         c.pairing.paired ? metric.info.worse == Worse::kNeither
                                ? fmt::format("{} smaller<br>{} larger", metric.b_better, metric.a_better)
                                : fmt::format("{} : {}", metric.b_better, metric.a_better)
                          : fmt::format("{}, {}", metric.n_a, metric.n_b),
         PText(metric.p_holm), FindingBadge(metric)},
        IsPart(metric.metric) ? "part" : "");
  }
  return html + table.Html("metrics");
}

/// Share of the flights beyond each value. A lost flight counts as beyond any value.
void AddExceedance(SvgChart& chart, const CaseColumns& cases, const std::string& metric, Worse worse,
                   const char* style, const char* legend) {
  std::vector<double> values = CompletedValues(cases, metric);
  if (worse == Worse::kFartherFromZero)
    for (double& value : values) value = std::fabs(value);
  const auto all = static_cast<double>(values.size());
  std::vector<double> sorted = SortedFinite(std::move(values));
  if (worse == Worse::kSmaller) std::reverse(sorted.begin(), sorted.end());
  std::vector<double> x, share;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    x.insert(x.end(), {sorted[i], sorted[i]});
    share.insert(share.end(),
                 {(all - static_cast<double>(i)) / all, (all - static_cast<double>(i) - 1.0) / all});
  }
  chart.Line(x, share, style, legend);
}

/// The metrics of the requirements, then the usual metrics of controllers.
std::vector<const MetricComparison*> ShownMetrics(const Comparison& c) {
  std::vector<std::string> names;
  for (const RequirementComparison& requirement : c.requirements) names.push_back(requirement.metric);
  names.insert(names.end(),
               {"pitch_error_rms_deg", "pitch_error_peak_deg", "deflection_peak_deg", "q_alpha_max_pa_rad"});
  std::vector<const MetricComparison*> shown;
  for (const std::string& name : names) {
    const auto metric = std::find_if(c.metrics.begin(), c.metrics.end(),
                                     [&](const MetricComparison& each) { return each.metric == name; });
    if (metric != c.metrics.end() && std::find(shown.begin(), shown.end(), &*metric) == shown.end())
      shown.push_back(&*metric);
  }
  if (shown.empty())
    for (std::size_t i = 0; i < std::min<std::size_t>(4, c.metrics.size()); ++i)
      shown.push_back(&c.metrics[i]);
  return shown;
}

std::string FiguresSection(const Comparison& c, const CaseColumns& a, const CaseColumns& b) {
  std::string html =
      "<h2 id=\"figures\">Distributions side by side</h2>\n<p>All flights of each campaign, paired or not; a "
      "lost "
      "flight lies beyond any value.</p>\n<div class=\"figures\">\n";
  for (const MetricComparison* metric : ShownMetrics(c)) {
    const MetricInfo& info = metric->info;
    const std::string axis = info.title + (info.worse == Worse::kFartherFromZero ? ", magnitude" : "") +
                             (info.unit.empty() ? "" : ", " + info.unit);
    const bool smaller = info.worse == Worse::kSmaller;
    SvgChart tail({.label = axis},
                  {.label = smaller ? "share of flights at most this" : "share of flights beyond this",
                   .low = 0.5 / static_cast<double>(std::max(a.rows(), b.rows())),
                   .high = 1.0,
                   .logarithmic = true,
                   .percent = true},
                  520, 260);
    AddExceedance(tail, a, metric->metric, info.worse, "line-0", "A");
    AddExceedance(tail, b, metric->metric, info.worse, "line-1", "B");
    const std::string title = HtmlText(info.title);
    html += Figure(tail.Svg("Exceedance of " + info.title + " in A and B"),
                   title + ": share of the flights " + (smaller ? "at most" : "beyond") + " each value.");
    if (!c.pairing.paired) continue;
    const std::vector<double> all_a = CompletedValues(a, metric->metric);
    const std::vector<double> all_b = CompletedValues(b, metric->metric);
    std::vector<double> x, y;
    for (std::size_t row = 0, other = 0; row < a.rows(); ++row) {
      while (other < b.rows() && b.index[other] < a.index[row]) ++other;
      if (other == b.rows() || b.index[other] != a.index[row]) continue;
      if (!std::isfinite(all_a[row]) || !std::isfinite(all_b[other])) continue;
      x.push_back(all_a[row]);
      y.push_back(all_b[other]);
    }
    if (x.empty()) continue;
    const double low = std::max(*std::min_element(x.begin(), x.end()), *std::min_element(y.begin(), y.end()));
    const double high =
        std::min(*std::max_element(x.begin(), x.end()), *std::max_element(y.begin(), y.end()));
    SvgChart pairs({.label = "A: " + axis}, {.label = "B: " + axis}, 520, 260);
    pairs.Points(x, y, "dots", "pairs");
    if (low < high) pairs.Line({low, high}, {low, high}, "program", "no change");
    html += Figure(pairs.Svg("B against A, pair by pair: " + info.title),
                   title + ": pairs in which both flights were completed.");
  }
  return html + "</div>\n";
}

std::string ChangesSection(const Comparison& c) {
  std::string html = "<h2 id=\"changes\">Largest changes</h2>\n";
  if (!c.pairing.paired) return html + "<p>The campaigns are not paired.</p>\n";
  html +=
      "<p>The pairs in which B loses most and gains most, with or without a limit between the two "
      "values.</p>\n";
  HtmlTable table({{"Metric"}, {""}, {"Case", true}, {"A", true}, {"B", true}, {"Replay both"}});
  for (const MetricComparison* metric : ShownMetrics(c)) {
    bool titled = false;
    const bool neither = metric->info.worse == Worse::kNeither;
    for (const auto& [pairs, word] : {std::pair{&metric->losses, neither ? "larger" : "worse"},
                                      std::pair{&metric->gains, neither ? "smaller" : "better"}}) {
      for (std::size_t i = 0; i < std::min<std::size_t>(3, pairs->size()); ++i) {
        const MetricComparison::Pair& pair = (*pairs)[i];
        const auto value = [](double number) {
          return std::isfinite(number) ? ReadableText(number) : "lost";
        };
        table.Row({titled ? ""
                          : HtmlText(metric->info.title +
                                     (metric->info.unit.empty() ? "" : ", " + metric->info.unit)),
                   word, std::to_string(pair.case_index), value(pair.a), value(pair.b),
                   ReplayBoth(c, pair.case_index)});
        titled = true;
      }
    }
  }
  return html + table.Html();
}

std::string MethodsSection(const Comparison& c) {
  std::string html = "<h2 id=\"methods\">Methods</h2>\n<ul>\n";
  if (!c.independent) {
    html +=
        "<li>The points of at least one campaign are chosen, not drawn independently. There are no limits "
        "and no p-values. Differences hold for these points only.</li>\n";
  }
  html += c.pairing.paired
              ? "<li>Pairs are cases of equal index with the same draws. The limits of the median difference "
                "are order statistics of the pairs’ differences, exact for any distribution (H. A. David and "
                "H. N. Nagaraja, <i>Order Statistics</i>, 2003, 7.1); p is from the exact sign test.</li>\n"
              : "<li>The samples are independent. The limits of the difference of medians join the "
                "order-statistic limits of each (see the tails); p is from Wilcoxon’s rank sum test, by the "
                "normal approximation with ties.</li>\n";
  html += fmt::format(
      "<li>Tails: the limits of each campaign’s percentile are order statistics, valid for any distribution. "
      "Limits of the difference join them by the method of variance estimates recovery (G. Y. Zou and A. "
      "Donner, <i>Statist. Med.</i> 27 (2008) 1693{}). The joined limits hold as the samples grow. "
      "<code>core/statistics/README.md</code> states their simulated coverage. If a sample is too small, "
      "there is no limit. p is exact, for equal shares of flights beyond the pooled percentile ({}).</li>\n",
      c.pairing.paired ? ", with the correlation of the pairs" : "",
      c.pairing.paired ? "McNemar’s test" : "Fisher’s test");
  html += c.pairing.paired ? "<li>Requirements: McNemar’s exact test on the pairs in which only one flight "
                             "fails (<i>Psychometrika</i> "
                             "12 (1947) 153). Limits of the difference of rates join Clopper–Pearson limits "
                             "in the same way.</li>\n"
                           : "<li>Requirements: Fisher’s exact test. Limits of the difference of rates join "
                             "Clopper–Pearson limits in "
                             "the same way.</li>\n";
  return html +
         "<li>Holm’s adjustment (<i>Scand. J. Statist.</i> 6 (1979) 65) is over the metrics for the medians, "
         "over the metrics for each percentile, and over the requirements. In such a family the probability "
         "of any wrong finding is at most 5 %.</li>\n"
         "<li>A lost flight counts as worse than any value (J. M. Lachin, <i>Control. Clin. Trials</i> 20 "
         "(1999) 408), so that no campaign gains by losing its worst flights. If a metric is neither good "
         "nor bad, lost flights are left out. If a metric is worse farther from zero, its magnitude is "
         "compared.</li>\n"
         "</ul>\n";
}

}  // namespace

std::string ComparisonPage(const Comparison& comparison, const CaseColumns& a, const CaseColumns& b) {
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<title>{} against {} – dispersa</title>\n<style>{}\n"
      ".ids code, .breaking td, .breaking td {{ white-space: normal; overflow-wrap: anywhere; }}\n"
      ".breaking td code {{ white-space: normal; overflow-wrap: normal; }}\n"
      ".metrics td:first-child {{ min-width: 11em; }} .metrics td.n .definition {{ white-space: normal; }}\n"
      "</style>\n</head>\n<body>\n",
      HtmlText(comparison.b.name), HtmlText(comparison.a.name), StyleSheet());
  page += Header(comparison) + kComparisonNavigation + ComparedSection(comparison) +
          RequirementsSection(comparison) + CasesSection(comparison) + MetricsSection(comparison) +
          FiguresSection(comparison, a, b) + ChangesSection(comparison) + MethodsSection(comparison);
  return page + "</body>\n</html>\n";
}

}  // namespace dispersa
