// compare.html.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/analysis/comparison.h"
#include "core/pages/embedded.h"
#include "core/pages/glossary.h"
#include "core/pages/html_parts.h"
#include "core/pages/svg_chart.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

constexpr char kComparisonNavigation[] =
    "<nav><a href=\"#differs\">Differing values</a><a href=\"#cases\">Harmed and rescued</a><a "
    "href=\"#metrics\">Metrics</a><a "
    "href=\"#figures\">Figures</a><a href=\"#changes\">Largest changes</a><a href=\"#compared\">Compared "
    "campaigns</a><a href=\"#methods\">Methods</a><a href=\"#glossary\">Glossary</a></nav>\n";
/// Rows of a long table that are always seen. compare.json has all rows.
constexpr std::size_t kOpenRows = 20;
constexpr std::size_t kListedCases = 1000;

std::string Definition(const std::string& html) { return "<span class=\"definition\">" + html + "</span>"; }

/// Values of one row, to three digits of the difference that the row shows.
std::string ValueText(double value, double difference) {
  if (std::isinf(value)) return value > 0.0 ? "∞" : "−∞";
  return std::isfinite(difference) && difference != 0.0 ? ScatterText(value, 0.1 * std::fabs(difference))
                                                        : RoundedText(value);
}

std::string IntervalText(const Interval& interval) {
  if (!std::isfinite(interval.lower) && !std::isfinite(interval.upper)) return "no limits";
  const auto text = [](double value) { return ValueText(value, 0.0); };
  return text(interval.lower) + " … " + text(interval.upper);
}

/// A path in a campaign file, with line breaks allowed after its dots.
std::string PathCell(const std::string& path) {
  std::string html;
  for (const char c : HtmlText(path)) html += c == '.' ? ".<wbr>" : std::string(1, c);
  return "<code>" + html + "</code>";
}

std::string DifferenceCell(double difference, const Interval& interval) {
  if (!std::isfinite(difference)) return "–";
  return RoundedText(difference) + Definition(IntervalText(interval));
}

std::string PText(double p) { return HtmlText(PValueText(p)); }

/// A table of which the first rows are seen, and the rest can be opened on screen.
class LongTable {
 public:
  LongTable(std::vector<HtmlTable::Column> columns, std::string rest)
      : open_(columns), folded_(std::move(columns)), rest_(std::move(rest)) {}

  void Row(const std::vector<std::string>& cells) { (++rows_ <= kOpenRows ? open_ : folded_).Row(cells); }
  std::string Html() const {
    if (rows_ <= kOpenRows) return open_.Html();
    return open_.Html() + fmt::format("<details><summary>{} more rows{}</summary>\n{}</details>\n",
                                      rows_ - kOpenRows, rest_, folded_.Html());
  }

 private:
  HtmlTable open_;
  HtmlTable folded_;
  std::string rest_;
  std::size_t rows_ = 0;
};

std::string FindingBadge(const std::string& finding) {
  const std::string_view style = finding == "better"                          ? "pass"
                                 : finding == "worse"                         ? "fail"
                                 : finding == "differs" || finding == "mixed" ? "inconclusive"
                                                                              : "";
  if (finding == kTooSmall) return "<span class=\"soft\">certain but too small to matter</span>";
  if (style.empty()) return "<span class=\"soft\">" + finding + "</span>";
  return fmt::format("<span class=\"badge {}\">{}{}</span>", style,
                     finding == "differs" || finding == "mixed" ? "" : "B ", finding);
}

/// What McNemar's or Fisher's test says, for who does not know it.
std::string RateWords(const RequirementComparison& r, bool paired) {
  if (r.n_a == 0 || r.n_b == 0) return "One campaign does not measure it.";
  if (r.failures_a + r.failures_b == 0) return "No flight breaks it.";
  const std::string probability = r.p < 1e-15 ? "below 1e-15" : "of " + PText(r.p);
  if (!paired) {
    if (!std::isfinite(r.p)) return "";
    return fmt::format(
        "If A and B were alike, chance would set the rates so far apart with a probability {} "
        "(Fisher’s test).",
        probability);
  }
  std::string words = fmt::format("Only B breaks it in {} pairs, only A in {}, both in {}.", r.only_b_fails,
                                  r.only_a_fails, r.both_fail);
  if (r.only_a_fails + r.only_b_fails == 0 || !std::isfinite(r.p)) return words;
  return words + fmt::format(
                     " If A and B were alike, chance would split the pairs so unevenly with a "
                     "probability {} (McNemar’s test).",
                     probability);
}

/// A value can come nearer to its limit before any flight breaks it.
std::string TestWords(const RequirementComparison& r, const Comparison& c) {
  std::string words = RateWords(r, c.pairing.paired);
  for (const MetricComparison& metric : c.metrics)
    if (metric.metric == r.metric && !metric.effect_in.empty())
      words += fmt::format(" <b>{}</b>: {}.",
                           metric.finding == "differs" ? "It differs" : "B is " + metric.finding,
                           HtmlText(EffectWords(metric)));
  return words;
}

std::string RequirementsTable(const Comparison& c) {
  if (c.requirements.empty()) return "";
  std::vector<const RequirementComparison*> order;
  for (const RequirementComparison& each : c.requirements) order.push_back(&each);
  const auto rank = [](const RequirementComparison& r) {
    return r.finding == "worse" ? 0 : r.finding == "better" ? 1 : 2;
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](const auto* x, const auto* y) { return rank(*x) < rank(*y); });
  HtmlTable table("In failures|!Requirement|#A breaks it in|#B breaks it in|#B − A|In words|#p, Holm");
  for (const RequirementComparison* each : order) {
    const RequirementComparison& r = *each;
    const auto share = [](std::size_t failures, std::size_t n) {
      return n == 0 ? std::string("–")
                    : fmt::format("{} of {}", failures, n) +
                          Definition(ShareText(static_cast<double>(failures) / static_cast<double>(n)));
    };
    const auto percent = [](double value) {
      if (!std::isfinite(value)) return std::string("–");
      return value == 0.0 ? std::string("0 %") : fmt::format("{:+.3g} %", 100.0 * value);
    };
    table.Row(
        {FindingBadge(r.finding),
         "<b>" + HtmlText(DescribeMetric(r.metric).title) + "</b> " +
             HtmlText(r.words.substr(r.metric.size() + 1)) +
             (r.in_a && r.in_b ? "" : Definition(fmt::format("required by {} alone", r.in_a ? "A" : "B"))),
         share(r.failures_a, r.n_a), share(r.failures_b, r.n_b),
         percent(r.difference) +
             (std::isfinite(r.interval.lower)
                  ? Definition(percent(r.interval.lower) + " … " + percent(r.interval.upper))
                  : ""),
         TestWords(r, c), PText(r.p_holm)});
  }
  return table.Html("first requirements");
}

std::string Header(const Comparison& c) {
  const auto found = [&](const char* finding) {
    return std::count_if(c.metrics.begin(), c.metrics.end(), [&](const MetricComparison& metric) {
      return metric.is_counted && metric.finding == finding;
    });
  };
  const auto side = [&](const char* letter, const Comparison::Side& s) {
    return fmt::format("{}: <b>{}</b>, campaign {}, autopilot {}, vehicle {}, {} of {} flights completed",
                       letter, HtmlText(SideTitle(c, s)), HtmlText(s.name), HtmlText(s.autopilot),
                       HtmlText(s.vehicle), s.completed, s.flown);
  };
  const bool decided = c.finding != "not judged" && c.finding != "no relevant difference";
  std::string html = fmt::format(
      "<header>\n<h1>{} against {}</h1>\n<p class=\"soft what\">{}<br>{}<br>{}Differences are B minus A; "
      "{}.</p>\n"
      "<div class=\"headline\">{}<p>{}</p></div>\n",
      HtmlText(SideTitle(c, c.b)), HtmlText(SideTitle(c, c.a)), side("A", c.a), side("B", c.b),
      c.differs.empty() ? "" : "The campaign files differ in " + HtmlText(c.differs) + ".<br>",
      c.pairing.paired
          ? Term("paired comparison", "paired") + fmt::format(", {} pairs of flights", c.pairing.shared)
          : "unpaired",
      decided ? FindingBadge(c.finding) : "<span class=\"badge design\">" + c.finding + "</span>",
      HtmlText(c.sentence));
  for (const auto& [letter, lost] : {std::pair{"A", &c.a.nominal_loss}, std::pair{"B", &c.b.nominal_loss}})
    if (!lost->empty())
      html += fmt::format("<ul class=\"warnings\"><li>{}: {}</li></ul>\n", letter, HtmlText(*lost));
  if (const std::vector<std::string> incomplete = IncompleteSides(c); !incomplete.empty()) {
    html += "<ul class=\"warnings\">\n";
    for (const std::string& sentence : incomplete) html += "<li>" + HtmlText(sentence) + ".</li>\n";
    html += "</ul>\n";
  }
  html += RequirementsTable(c);
  for (const Comparison::LoadCheck& check : c.load_checks)
    html += fmt::format("<p>{}: a limit of the vehicle. Flights beyond it: {} of A, {} of B.</p>\n",
                        HtmlText(DescribeMetric(check.metric).title), check.failures_a, check.failures_b);
  html += "<div class=\"tiles\">";
  if (c.pairing.paired) {
    html += Tile(std::to_string(c.harmed.size()), "cases " + Term("harmed")) +
            Tile(std::to_string(c.rescued.size()), "cases " + Term("rescued"));
  }
  if (c.independent) {
    html += Tile(std::to_string(found("better")), "metrics in which B is better") +
            Tile(std::to_string(found("worse")), "metrics in which B is worse");
  }
  html += Tile(std::to_string(c.changes.size()), "values of the campaign files differ");
  return html + "</div>\n</header>\n";
}

std::string ComparedSection(const Comparison& c) {
  std::string html = "<h2 id=\"compared\">Compared campaigns</h2>\n";
  HtmlTable table("!|A|B");
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
    LongTable changed({{"Input that was changed", false, true}, {"Shared cases in which it differs", true}},
                      "; compare.json has all of them");
    for (const Pairing::ChangedInput& input : c.pairing.changed)
      changed.Row(
          {InputNames(input.key, input.input), fmt::format("{} of {}", input.cases, c.pairing.shared)});
    html += changed.Html();
  }
  return html;
}

/// The requirements first: they say what A and B were judged by.
std::string DiffersSection(const Comparison& c) {
  std::string html =
      fmt::format("<h2 id=\"differs\">Values of the campaign files that differ: {}</h2>\n", c.changes.size());
  if (c.changes.empty()) return html + "<p>None.</p>\n";
  LongTable changes({{"Value", false, true}, {"A: " + SideTitle(c, c.a)}, {"B: " + SideTitle(c, c.b)}},
                    "; compare.json has all of them");
  for (const bool of_requirements : {true, false}) {
    for (const CampaignChange& change : c.changes) {
      if (change.path.starts_with("requirements") != of_requirements) continue;
      const auto text = [](const std::string& value) { return value.empty() ? "–" : HtmlText(value); };
      changes.Row({PathCell(change.path), text(change.a), text(change.b)});
    }
  }
  return html + "<div class=\"breaking\">" + changes.Html() + "</div>\n";
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
  LongTable table({{"Case", true, true}, {"Requirement"}, {"A", true}, {"B", true}, {"Replay both"}},
                  cases.size() > kListedCases
                      ? fmt::format(" of the first {} cases; compare.json has all of them", kListedCases)
                      : std::string());
  std::size_t listed = 0;
  for (const ChangedCase& one : cases) {
    if (++listed > kListedCases) break;
    for (std::size_t i = 0; i < one.reasons.size(); ++i) {
      const ChangedCase::Reason& reason = one.reasons[i];
      const auto value = [&](double number, Outcome outcome) {
        if (std::isfinite(number))
          return RoundedText(number, Rounding::kNearest, reason.limits.Beside(number));
        std::string words = OutcomeName(outcome);
        std::replace(words.begin(), words.end(), '_', ' ');
        return words;
      };
      table.Row({std::to_string(one.case_index), HtmlText(reason.requirement), value(reason.a, one.outcome_a),
                 value(reason.b, one.outcome_b), i > 0 ? "" : ReplayBoth(c, one.case_index)});
    }
  }
  return html + table.Html();
}

std::string CasesSection(const Comparison& c) {
  std::string html = "<h2 id=\"cases\">Harmed and rescued cases</h2>\n";
  if (!c.pairing.paired)
    return html + "<p>The campaigns are not paired: no case of one has a partner in the other.</p>\n";
  html +=
      "<p>" + Term("harmed", "Harmed") +
      ": the case meets a requirement in A and breaks it in B, or its flight "
      "is lost in B. " +
      Term("rescued", "Rescued") +
      ": the reverse. Run the commands in the folder where the comparison was started. They check that the "
      "flight is the same to the last bit.</p>\n";
  return html + CasesTable(c.harmed, c, "Harmed", "None.") + CasesTable(c.rescued, c, "Rescued", "None.");
}

std::string MetricsSection(const Comparison& c) {
  std::string html = fmt::format(
      "<h2 id=\"metrics\">Metrics</h2>\n"
      "<p>First those whose change is certain and matters, the largest first. {} Its 95 % limits stand below "
      "it. The tails are on the bad side: 95 and 99 %, or 5 and 1 % if "
      "less is worse. <code>compare.json</code> has the other percentiles. The p is that of the median, or "
      "of the tail that "
      "the finding is about. “Not shown”: Holm’s adjusted p of the median is above 5 %, and that of each "
      "tail "
      "above its part of 5 %. This does not show that the campaigns are equal. A difference matters from {} "
      "of a "
      "requirement’s limit on, or without one of the spread of A from 5 to 95 %.</p>\n",
      c.pairing.paired ? "The difference is the median of B minus A over the pairs."
                       : "The difference is that of the medians.",
      PercentText(c.practical_share));
  const std::string heads = std::string("!Metric|#Unit|#Median A|#Median B|#Difference|#of p95|#of p99|#") +
                            (c.pairing.paired ? "B better : worse" : "Flights") + "|#p, Holm|Finding";
  HtmlTable relevant(heads), rest(heads);
  std::size_t others = 0, too_small = 0;
  for (const MetricComparison* ranked : ByEffect(c)) {
    const MetricComparison& metric = *ranked;
    const bool is_other = c.independent && metric.effect_in.empty();
    others += is_other;
    too_small += is_other && metric.finding == kTooSmall;
    HtmlTable& table = is_other ? rest : relevant;
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
        {title, HtmlText(metric.info.unit), ValueText(metric.median_a, metric.difference),
         ValueText(metric.median_b, metric.difference), DifferenceCell(metric.difference, metric.interval),
         tail("p95", "p05"), tail("p99", "p01"),
         c.pairing.paired ? metric.info.worse == Worse::kNeither
                                ? fmt::format("{} smaller<br>{} larger", metric.b_better, metric.a_better)
                                : fmt::format("{} : {}", metric.b_better, metric.a_better)
                          : fmt::format("{}, {}", metric.n_a, metric.n_b),
         PText(metric.found_p) + (metric.found_in == "median" ? "" : Definition("of " + metric.found_in)),
         FindingBadge(metric.finding) + (metric.effect_in.empty() || !std::isfinite(metric.effect)
                                             ? ""
                                             : Definition(metric.effect_in + ": " + ShareOfScale(metric)))},
        metric.info.is_part ? "screen" : "");
  }
  html += others == c.metrics.size() ? "<p>No metric has a change that is certain and matters.</p>\n"
                                     : relevant.Html("metrics");
  if (others == 0) return html;
  return html + fmt::format(
                    "<details><summary>{} metrics without a change that matters: {} not shown, {} certain "
                    "but too small</summary>\n{}</details>\n",
                    others, others - too_small, too_small, rest.Html("metrics"));
}

/// Share of the flights beyond each value. A lost flight counts as beyond any value.
void AddExceedance(SvgChart& chart, std::vector<double> values, Worse worse, const char* style,
                   const char* legend) {
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

std::string ComparedTitle(const MetricInfo& info) {
  return info.title + (info.worse == Worse::kFartherFromZero ? ", magnitude" : "") +
         (info.unit.empty() ? "" : ", " + info.unit);
}

std::string FiguresSection(const Comparison& c, const CaseColumns& a, const CaseColumns& b) {
  std::string html =
      "<h2 id=\"figures\">Distributions side by side</h2>\n<p>All flights of each campaign, paired or not; a "
      "lost "
      "flight lies beyond any value.</p>\n<div class=\"figures\">\n";
  std::string same;  // one value in all flights of both has no curve
  for (const MetricComparison* metric : ShownMetrics(c)) {
    const MetricInfo& info = metric->info;
    const ComparedValues all = ValuesToCompare(a, b, metric->metric);
    std::vector<double> values = SortedFinite(all.a);
    const std::vector<double> of_b = SortedFinite(all.b);
    values.insert(values.end(), of_b.begin(), of_b.end());
    if (!values.empty() && std::count(values.begin(), values.end(), values.front()) == std::ssize(values)) {
      same += fmt::format("{}{} {}", same.empty() ? "" : "; ", HtmlText(info.title),
                          HtmlText(WithUnit(values.front(), info.unit)));
      continue;
    }
    const std::string axis = ComparedTitle(info);
    const bool smaller = info.worse == Worse::kSmaller;
    SvgChart tail({.label = axis},
                  {.label = smaller ? "share of flights at most this" : "share of flights beyond this",
                   .low = 0.5 / static_cast<double>(std::max(a.rows(), b.rows())),
                   .high = 1.0,
                   .logarithmic = true,
                   .percent = true},
                  520, 260);
    AddExceedance(tail, all.a, info.worse, "line-0", "A");
    AddExceedance(tail, all.b, info.worse, "line-1", "B");
    const std::string title = HtmlText(info.title);
    html += Figure(tail.Svg("Exceedance of " + info.title + " in A and B"),
                   title + ": share of the flights " + (smaller ? "at most" : "beyond") + " each value.");
    if (!c.pairing.paired) continue;
    std::vector<double> x, y;
    for (std::size_t row = 0, other = 0; row < a.rows(); ++row) {
      while (other < b.rows() && b.index[other] < a.index[row]) ++other;
      if (other == b.rows() || b.index[other] != a.index[row]) continue;
      if (!std::isfinite(all.a[row]) || !std::isfinite(all.b[other])) continue;
      x.push_back(all.a[row]);
      y.push_back(all.b[other]);
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
  html += "</div>\n";
  if (!same.empty()) html += "<p>The same in all flights of both: " + same + ".</p>\n";
  return html;
}

std::string ChangesSection(const Comparison& c) {
  std::string html = "<h2 id=\"changes\">Largest changes</h2>\n";
  if (!c.pairing.paired) return html + "<p>The campaigns are not paired.</p>\n";
  html +=
      "<p>The pairs in which B loses most and gains most, with or without a limit between the two "
      "values.</p>\n";
  HtmlTable table("Metric|B is|!#Case|#A|#B|Replay both");
  for (const MetricComparison* metric : ShownMetrics(c)) {
    bool titled = false;
    const bool neither = metric->info.worse == Worse::kNeither;
    for (const auto& [pairs, word] : {std::pair{&metric->losses, neither ? "larger" : "worse"},
                                      std::pair{&metric->gains, neither ? "smaller" : "better"}}) {
      for (std::size_t i = 0; i < std::min<std::size_t>(3, pairs->size()); ++i) {
        const MetricComparison::Pair& pair = (*pairs)[i];
        const auto value = [](double number) { return std::isfinite(number) ? RoundedText(number) : "lost"; };
        table.Row({titled ? "" : HtmlText(ComparedTitle(metric->info)), word, std::to_string(pair.case_index),
                   value(pair.a), value(pair.b), ReplayBoth(c, pair.case_index)});
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
         "of any wrong finding is at most 5 %. The tails of a metric share these 5 %.</li>\n"
         "<li>A lost flight counts as worse than any value (J. M. Lachin, <i>Control. Clin. Trials</i> 20 "
         "(1999) 408), so that no campaign gains by losing its worst flights. If a metric is neither good "
         "nor bad, lost flights are left out. If a metric is worse farther from zero, its magnitude is "
         "compared.</li>\n"
         "</ul>\n";
}

}  // namespace

std::string ComparisonPage(const Comparison& comparison, const CaseColumns& a, const CaseColumns& b) {
  constexpr char kMoreStyle[] =
      "\n.ids code, .breaking td, .breaking th { white-space: normal; overflow-wrap: anywhere; }\n"
      ".breaking table { table-layout: fixed; } .breaking td code, .breaking th code { white-space: normal; "
      "overflow-wrap: normal; }\n"
      ".metrics tbody th { min-width: 11em; } .metrics td.n .definition { white-space: normal; }\n";
  const std::string title =
      SideTitle(comparison, comparison.b) + " against " + SideTitle(comparison, comparison.a);
  std::string page = PageHead(title, title, kMoreStyle) + "<main>\n" + Header(comparison) +
                     kComparisonNavigation + DiffersSection(comparison) + CasesSection(comparison) +
                     MetricsSection(comparison) + FiguresSection(comparison, a, b) +
                     ChangesSection(comparison) + ComparedSection(comparison) + MethodsSection(comparison);
  page += GlossarySection(page);
  return page + "</main>\n<script>" + std::string(ChartScript()) + "</script>\n</body>\n</html>\n";
}

}  // namespace dispersa
