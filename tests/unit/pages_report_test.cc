// report.html: every number that it shows is summary.json's, and it needs nothing but itself.
#include "core/pages/report_page.h"

#include "core/pages/glossary.h"
#include "core/pages/html_parts.h"
#include "core/pages/report_sections.h"
#include "core/results/metric_catalogue.h"
#include "core/results/text.h"
#include "tests/test.h"
#include "tests/unit/made_up_results.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::pages_report_test {
namespace {

using namespace report_test;

/// A flight of four stages with a coast before the last; every column is a wave.
History MakeHistory() {
  History history;
  for (int k = 0; k <= 500; ++k) {
    const double time_s = k;
    const int stage = k < 60 ? 1 : k < 110 ? 2 : k < 150 ? 3 : 4;
    const bool coast = k >= 145 && k < 450;
    std::vector<double> row;
    for (std::size_t i = 0; i < HistoryColumns().size(); ++i)
      row.push_back(std::sin(0.02 * time_s + static_cast<double>(i)));
    row[0] = time_s;
    row[static_cast<std::size_t>(FindHistoryColumn("stage"))] = stage;
    row[static_cast<std::size_t>(FindHistoryColumn("thrust_n"))] = coast ? 0.0 : 1000.0;
    row[static_cast<std::size_t>(FindHistoryColumn("qbar_pa"))] =
        60000.0 * std::exp(-0.002 * (time_s - 40) * (time_s - 40));
    history.values.insert(history.values.end(), row.begin(), row.end());
  }
  return history;
}

class ReportPageTest : public testing::Test {
 protected:
  void Build(std::uint64_t cases, std::uint64_t flown) {
    campaign_ = MakeCampaign(cases);
    campaign_.name = "made <up> & \"quoted\"";
    campaign_.requirements = {{.metric = "pitch_error_peak_deg",
                               .below = 12.5,
                               .above = std::nullopt,
                               .probability = 0.9,
                               .consumer_risk = 0.1}};
    Dispersion thrust;
    thrust.name = "thrust/stage1";
    thrust.distribution = {
        .kind = Distribution::kNormal, .nominal = 1.0, .sigma = 0.01, .low = 0, .high = 0, .values = {}};
    thrust.inputs = {FindInput("thrust_factor_stage1")};
    campaign_.dispersions = {thrust};
    ResultFolder folder = ResultFolder::Create(temporary_ / "out", campaign_);
    std::vector<CaseResult> results;
    for (std::uint64_t k = 0; k < flown; ++k) {
      results.push_back(MakeCase(k, folder.inputs()));
      if (k != 3) continue;
      results.back().outcome = Outcome::kLostControl;
      results.back().reason = "rate > 60";
      results.back().metrics[MetricColumn("apogee_km")] = kNaN;
    }
    folder.Append(results);
    if (flown < cases) folder.Quarantine({flown, "killed <three> workers"});
    cases_ = ReadColumns(folder, DispersedInputs(campaign_));
    summary_ = BuildSummary(folder, campaign_, cases_);
    summary_.nominal = MakeCase(1000);
    histories_.nominal = *summary_.nominal;
    histories_.nominal_history = MakeHistory();
    std::vector<int> columns;
    for (int i = 0; i < std::ssize(BandColumnNames()); ++i) columns.push_back(i);
    std::vector<SampledFlight> flights;
    if (flown > 0) flights.push_back(SampleFlight(histories_.nominal_history, columns, 1.0));
    histories_.bands = ComputeBands(flights, columns, 1.0);
    histories_.written_cases = {3};
    histories_.written_flights = {SampleFlight(histories_.nominal_history, columns, 1.0)};
    campaign_.vehicle = SampleVehicle();
    page_ = ReportPage(campaign_, summary_, cases_, histories_);
  }

  TemporaryFolder temporary_;
  Campaign campaign_;
  CampaignSummary summary_;
  CaseColumns cases_;
  FlightHistories histories_;
  std::string page_;
};

TEST_F(ReportPageTest, ShowsTheNumbersOfTheSummary) {
  Build(40, 40);
  for (const MetricSummary& metric : summary_.metrics) {
    const Summary& s = metric.statistics;
    const MetricInfo info = DescribeMetric(metric.name);
    if (s.min == s.max) {
      EXPECT_THAT(page_, HasSubstr(HtmlText(info.title) + " " + ReadableText(s.min)));
      continue;
    }
    // The row in one piece, so that a number of another metric cannot stand in.
    const auto value = [&](double number) { return ScatterText(number, s.std); };
    std::string row =
        value(NearTo(s.mean, summary_.nominal->metrics[MetricColumn(metric.name)], info.circle));
    const auto add = [&](const std::string& text) { row += "</td><td class=\"n\">" + text; };
    add(std::to_string(s.n));
    for (const std::string& text :
         {value(s.mean), RoundedText(s.std), RoundedText(metric.skewness), value(s.min), value(s.p50)})
      add(text);
    row += "<span class=\"definition\">" + value(metric.percentiles[3].limits.lower) + " … " +
           value(metric.percentiles[3].limits.upper) + "</span>";
    EXPECT_THAT(page_, HasSubstr(row)) << metric.name;
    // 39 completed flights do not reach so far: only a bound is shown.
    EXPECT_EQ(metric.percentiles[6].name, "p99_73");
    EXPECT_THAT(page_, HasSubstr("≥ " + value(metric.percentiles[6].limits.lower)));
  }
  const RequirementSummary& requirement = summary_.requirements[0];
  for (const std::string& text :
       {ShareText(*requirement.success_lower, Rounding::kDown),
        ShareText(*requirement.success_upper, Rounding::kUp), std::string("below 12.5 °"),
        HtmlText(requirement.sentence),
        std::string("<dt>failures</dt><dd>" + std::to_string(requirement.failures) + "</dd>"),
        std::string("<dt>observed</dt><dd>"), HtmlText(JointRiskSentence(summary_))}) {
    EXPECT_THAT(page_, HasSubstr(text));
  }
  for (const WorstCases& worst : summary_.worst_cases) {
    for (const WorstCase& one : worst.cases) EXPECT_THAT(page_, HasSubstr(ReplayCommand(one.case_index)));
  }
  EXPECT_THAT(page_,
              HasSubstr(ScatterText(summary_.dispersions[0].drawn.mean, summary_.dispersions[0].drawn.std)));
  for (const auto& [name, text] : {std::pair{"Campaign id", Code(summary_.id)},
                                   {"Flight id", Code(summary_.flight_id)},
                                   {"Engine", Code(summary_.engine)},
                                   {"Vehicle", HtmlText(summary_.vehicle) + ", "},
                                   {"Autopilot", HtmlText(summary_.autopilot) + ", tick "}})
    EXPECT_THAT(page_, HasSubstr("<th scope=\"row\">" + std::string(name) + "</th><td>" + text));
}

TEST_F(ReportPageTest, NumbersItsPrintedPagesAndNamesTheCampaignOnEach) {
  Build(40, 40);
  // A name cannot leave the string that it stands in.
  EXPECT_THAT(
      page_,
      HasSubstr("@bottom-left { content: \"Dispersion campaign made \\00003cup> & \\000022quoted\\000022 · " +
                std::string(16, '1') + "\"; }"));
  EXPECT_THAT(page_, HasSubstr("counter(page) \" / \" counter(pages)"));
}

TEST_F(ReportPageTest, NamesMetricAndValueOfEachRequirement) {
  Build(40, 40);
  const RequirementSummary& requirement = summary_.requirements[0];
  ASSERT_TRUE(requirement.bound);
  EXPECT_THAT(page_,
              HasSubstr("<p class=\"value\">With 90 % confidence 90 % of flights stay below " +
                        RoundedText(*requirement.bound, Rounding::kUp, 12.5) + " ° (limit 12.5 °).</p>"));
}

TEST_F(ReportPageTest, ShowsTheWorstFlightByTheLimitsOfTheRequirement) {
  Build(40, 40);
  RequirementSummary& one = summary_.requirements[0];
  one.low_limit = 11.9;
  one.worst_completed = {7, 11.8999};
  const std::string section = RequirementsSection(summary_);
  EXPECT_THAT(section, HasSubstr("<dt>worst completed flight</dt><dd>11.8999 ° (case 7)</dd>"))
      << "with the digits that show on which side of its limit it is";
  one.worst_completed.reset();
  EXPECT_THAT(RequirementsSection(summary_), HasSubstr("<dt>worst completed flight</dt><dd>–</dd>"));
}

TEST_F(ReportPageTest, SaysWhichFlightsTheEnvelopeHolds) {
  Build(40, 40);
  EXPECT_THAT(page_, HasSubstr("Pointwise percentiles over the first 1 of 40 flown cases"));
  EXPECT_THAT(page_, HasSubstr("Minimum and maximum are over the same flights."));
  histories_.bands.flights = 40;
  histories_.bands.extreme_flights = 7;
  const std::string page = ReportPage(campaign_, summary_, cases_, histories_);
  EXPECT_THAT(page, HasSubstr("Pointwise percentiles over all 40 flown cases"));
  EXPECT_THAT(page, HasSubstr("Minimum and maximum are over these and 7 more"));
}

TEST_F(ReportPageTest, DrawsTheWorstCasesOverTheEnvelope) {
  Build(40, 40);  // of the worst cases only the lost one, 3, has a history
  EXPECT_THAT(page_, HasSubstr("Worst cases over the envelope: pitch error, °."));
  EXPECT_THAT(page_, HasSubstr(">case 3</text>"));
}

TEST_F(ReportPageTest, NeedsNothingButItself) {
  Build(40, 40);
  EXPECT_THAT(page_, Not(HasSubstr("://")));
  EXPECT_THAT(page_, Not(HasSubstr(" src=")));
  for (const char* reach :
       {"fetch(", "XMLHttpRequest", "import(", "import ", "eval(", "document.write", "WebSocket"})
    EXPECT_THAT(page_, Not(HasSubstr(reach)));
  EXPECT_THAT(page_, Not(HasSubstr("<link")));
  EXPECT_THAT(page_, Not(HasSubstr("url(")));
  EXPECT_THAT(page_, Not(HasSubstr("@import")));
  const std::regex link("href=\"[^#]");
  EXPECT_FALSE(std::regex_search(page_, link));
}

TEST_F(ReportPageTest, ShowsNoUndefinedNumberAndNoPath) {
  Build(40, 40);
  const std::regex nan("[^a-z](nan|inf)[^a-z]");
  EXPECT_FALSE(std::regex_search(page_, nan));
  EXPECT_THAT(page_, Not(HasSubstr((temporary_ / "out").string())));
}

TEST_F(ReportPageTest, ClosesEveryElementThatItOpens) {
  Build(40, 40);
  for (const std::string tag :
       {"table", "tr", "td", "div", "figure", "svg", "text", "p", "h2", "ul", "code", "html"}) {
    const std::regex open("<" + tag + "[ >]");
    const std::regex close("</" + tag + ">");
    const auto count = [&](const std::regex& expression) {
      return std::distance(std::sregex_iterator(page_.begin(), page_.end(), expression),
                           std::sregex_iterator());
    };
    EXPECT_EQ(count(open), count(close)) << tag;
  }
}

TEST_F(ReportPageTest, EscapesWhatUsersWrote) {
  Build(40, 39);
  EXPECT_THAT(page_, HasSubstr("made &lt;up&gt; &amp; &quot;quoted&quot;"));
  EXPECT_THAT(page_, HasSubstr("killed &lt;three&gt; workers"));
  EXPECT_THAT(page_, HasSubstr("rate &gt; 60"));
  EXPECT_THAT(page_, Not(HasSubstr("<up>")));
}

TEST_F(ReportPageTest, SaysWhatIsMissing) {
  Build(40, 39);
  EXPECT_THAT(page_, HasSubstr("39 of 40 cases have a result; 1 are quarantined."));
  EXPECT_THAT(page_, HasSubstr("<span class=\"badge incomplete\">… incomplete</span>"));
  for (const std::string& warning : Warnings(summary_))
    EXPECT_THAT(page_, HasSubstr("<li>" + HtmlText(warning)));
}

TEST_F(ReportPageTest, StandsWithoutTimeHistories) {
  Build(40, 40);
  summary_.nominal.reset();
  const std::string page = ReportPage(campaign_, summary_, cases_, {});
  EXPECT_THAT(page, HasSubstr("This report was made without time histories"));
  EXPECT_THAT(page, HasSubstr(HtmlText(summary_.requirements[0].sentence)));
}

TEST_F(ReportPageTest, StandsWithoutAnyCase) {
  Build(40, 0);
  EXPECT_THAT(page_, HasSubstr("No case has a result."));
  EXPECT_THAT(page_, HasSubstr("no completed flight defines it"));
}

TEST_F(ReportPageTest, LabelsADesignStudy) {
  Build(40, 40);
  EXPECT_THAT(page_, Not(HasSubstr("design study")));
  summary_.sampling = SamplingMethod::kCorners;
  summary_.verdict = CampaignVerdict::kStudy;
  summary_.requirements[0].verdict = "study";
  EXPECT_THAT(ReportPage(campaign_, summary_, cases_, histories_),
              HasSubstr("<span class=\"badge design\">design study</span>"));
}

TEST_F(ReportPageTest, AFlightBeyondALimitIsInTheHeadAndAmongTheOutcomes) {
  Build(40, 40);
  EXPECT_THAT(page_, Not(HasSubstr("structural limit exceeded</span>")));
  EXPECT_THAT(page_, Not(HasSubstr("Limits of the vehicle")));
  summary_.limits = {{"q_max_pa", 100e3, 0, 97e3, 4}, {"axial_load_max_g", 9.0, 3, 9.5, 17}};
  summary_.beyond_limits = 3;
  summary_.load_checks = {{"structural_limit_exceeded", 40, 3}};
  const std::string page = ReportPage(campaign_, summary_, cases_, histories_);
  const std::size_t head = page.find("<div class=\"headline exceeded\">");
  EXPECT_LT(page.find("<span class=\"badge fail\">structural limit exceeded</span>", head),
            page.find("<nav>"));
  EXPECT_THAT(page, HasSubstr("<li>Structural limits of the vehicle were exceeded in 3 of 40 flights: "));
  EXPECT_THAT(
      page,
      HasSubstr(
          "<th scope=\"row\">a limit of the structure exceeded, however it ended</th><td class=\"n\"><span "
          "class=\"badge fail\">3</span></td><td class=\"n\">7.5 %</td>"));
  EXPECT_THAT(
      page,
      HasSubstr(
          "<th scope=\"row\">Axial load, maximum</th><td class=\"n\">9 g</td><td class=\"n\">9.5 g</td><td "
          "class=\"n\">17</td><td class=\"n\"><span class=\"badge fail\">3</span></td>"));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">Dynamic pressure, maximum</th><td class=\"n\">100000 "
                              "Pa</td><td class=\"n\">97000 Pa"));
  EXPECT_THAT(page,
              HasSubstr("Load check: 3 of 40 flights went beyond a limit of the vehicle. No flight may."));
  // Beside "structural limit 0": what did not end the flights.
  EXPECT_THAT(
      page,
      HasSubstr("<th scope=\"row\">structural limit<span class=\"definition\">ended by it; 3 more exceeded a "
                "limit and flew on</span></th><td class=\"n\">0</td>"));
}

TEST_F(ReportPageTest, TheFirstSentenceSaysWhatFailed) {
  Build(40, 40);
  summary_.standing.verdict = StandingVerdict::kFail;
  const auto head = [&](std::vector<std::string> verdicts) {
    summary_.standing.requirements.resize(verdicts.size());
    for (std::size_t i = 0; i < verdicts.size(); ++i) summary_.standing.requirements[i].verdict = verdicts[i];
    summary_.requirements.resize(verdicts.size());
    return ReportPage(campaign_, summary_, cases_, histories_);
  };
  EXPECT_THAT(head({"fail"}), HasSubstr("<p>The one requirement is not met.</p>"));
  EXPECT_THAT(head({"inconclusive"}), HasSubstr("<p>Flights went beyond a limit of the vehicle. No "
                                                "requirement failed; 1 of 1 cannot be decided.</p>"));
  EXPECT_THAT(head({"pass"}),
              HasSubstr("<p>Flights went beyond a limit of the vehicle. No requirement failed.</p>"));
  EXPECT_THAT(head({}), HasSubstr("<p>Flights went beyond a limit of the vehicle. The campaign states no "
                                  "requirement.</p>"));
}

TEST_F(ReportPageTest, GroupsMetricsAsTheyAreDeclaredAndNamesInputsAsTheFileDoes) {
  Build(40, 40);
  const auto in_group = [&](const char* title, const char* from, const char* to) {
    const std::size_t at = page_.find(std::string("<b>") + title);
    const auto group = [&](const char* name) {
      return page_.find(std::string("class=\"group\"><th scope=\"rowgroup\" colspan=\"11\">") + name + "<");
    };
    EXPECT_LT(group(from), at) << title;
    EXPECT_LT(at, to == nullptr ? std::string::npos : group(to)) << title;
  };
  in_group("Attitude error at the last ignition", "Attitude", "Control effort");
  in_group("Bending moment, maximum, N m", "Loads", "Injection");
  in_group("Semi-major axis error, km", "Injection", "Guidance");
  in_group("Rules fired", "Control law", "Integration");
  EXPECT_THAT(page_, HasSubstr("<code>thrust</code> <span class=\"soft\"><code>thrust_factor_stage1</code>"));
}

TEST_F(ReportPageTest, ARowAnswersByHowMuch) {
  Build(40, 40);
  const auto cells = [&] {
    const std::string page = FirstPage(campaign_, summary_);
    const std::string row = page.substr(page.find("<tbody>"), page.find("</tbody>") - page.find("<tbody>"));
    const std::regex cell("<td class=\"n\">(.*?)</td>");
    std::vector<std::string> found;
    for (std::sregex_iterator at(row.begin(), row.end(), cell), end; at != end; ++at)
      found.push_back((*at)[1]);
    return found;
  };
  // 2 + k / 3 in case k, of which 32 to 39 are above 12.5 and the third is lost.
  EXPECT_THAT(cells(), ElementsAre("9 of 40<span class=\"definition\">1 lost</span>", "≤ 86 %", "90 %", "335",
                                   "8.67", "15 <span class=\"soft\">(39)</span>", "15", "-2.5"));
  summary_.requirements[0].verdict = "inconclusive";
  EXPECT_EQ(cells()[1], "≥ " + ShareText(*summary_.requirements[0].success_lower, Rounding::kDown, 0.9));
  summary_.nominal->outcome = Outcome::kImpact;
  EXPECT_EQ(cells()[3], "lost");
  summary_.nominal.reset();
  EXPECT_EQ(cells()[3], "–");
  RequirementSummary& one = summary_.requirements[0];
  one.lost_flights = 0;
  one.not_measured = 2;
  one.success_lower.reset();
  one.bound.reset();
  one.worst_completed.reset();
  one.every_case = true;
  EXPECT_THAT(cells(), ElementsAre("9 of 40<span class=\"definition\">2 not measured</span>", "–",
                                   "every case", "–", "8.67", "–", "–", "–"));
}

TEST_F(ReportPageTest, EachEventHasTheNominalAndTheSpread) {
  Build(40, 40);
  campaign_.vehicle.stages = {Stage{}, Stage{}, Stage{}};
  campaign_.vehicle.stages[0].jettisoned = {{.name = "fairing <1>"}};
  campaign_.vehicle.stages[2].jettisoned = {{.name = "skirt"}};
  summary_.events = {summary_.events.at(0), summary_.events.at(1), summary_.events.at(0),
                     summary_.events.at(0)};
  summary_.events[2].name = "jettison_2";
  summary_.events[3].name = "jettison_1";
  const std::string section = EventsSection(campaign_, summary_);
  const Summary& time = summary_.events[1].values[0];
  EXPECT_EQ(time.p50, 60.0 + 19.5 / 3.0);
  EXPECT_THAT(section, HasSubstr("stage 1 burnout</th><td class=\"n\">40</td><td class=\"n\">" +
                                 ScatterText(60.0 + 1000.0 / 3.0, time.std) + "<span class=\"definition\">" +
                                 ScatterText(time.p01, time.std) + " · " + ScatterText(time.p50, time.std) +
                                 " · " + ScatterText(time.p99, time.std) + "</span></td>"));
  EXPECT_THAT(section, HasSubstr("<td class=\"n\">21.5<span class=\"definition\">21.5</span></td>"))
      << "in km, and one number where all are equal";
  EXPECT_THAT(section, HasSubstr("jettison: skirt</th>"));
  EXPECT_THAT(section, HasSubstr("jettison: fairing &lt;1&gt;</th>"));
  summary_.nominal->events.clear();
  EXPECT_THAT(EventsSection(campaign_, summary_), HasSubstr("<td class=\"n\">–<span class=\"definition\">"));
  summary_.events.clear();
  EXPECT_EQ(EventsSection(campaign_, summary_), "");
}

TEST_F(ReportPageTest, SaysAdviceOnceForAllRequirements) {
  Build(20, 20);  // 22 flights are the least that can show 90 %
  campaign_.requirements[0].below = 1000.0;
  campaign_.requirements.push_back(campaign_.requirements[0]);
  campaign_.requirements[1].metric = "yaw_error_peak_deg";
  campaign_.requirements[1].id = "GNC-2";
  campaign_.requirements[1].source = "SRD 3.1";
  campaign_.requirements[1].rationale = "the fairing's clearance";
  cases_.outcome[3] = Outcome::kCompleted;
  summary_ = BuildSummary(ResultFolder::Open(temporary_ / "out"), campaign_, cases_);
  for (Standing::Requirement& one : summary_.standing.requirements) {
    one = {};
    one.verdict = "inconclusive";
  }
  const std::string page = FirstPage(campaign_, summary_);
  const std::string advice = AdviceTogether(summary_);
  EXPECT_THAT(advice,
              testing::StartsWith("To decide all 2 inconclusive requirements: a new campaign needs 22 "
                                  "flights or more."));
  EXPECT_THAT(page, HasSubstr("<p class=\"advice\">" + advice));
  EXPECT_THAT(page.substr(page.find(advice) + advice.size()), Not(HasSubstr("new campaign")));
  EXPECT_THAT(page.substr(0, page.find(advice)), Not(HasSubstr("new campaign")));
  EXPECT_THAT(page,
              HasSubstr("<code>GNC-2</code> <b><a href=\"#of-yaw_error_peak_deg\">Yaw error, peak</a></b> "
                        "below 1000&nbsp;°</span><span "
                        "class=\"soft clip\">&nbsp; · SRD 3.1 · the fairing's clearance</span></span></th>"));
  EXPECT_THAT(RequirementsSection(summary_), HasSubstr("<p>Why: the fairing's clearance</p>"));
}

TEST_F(ReportPageTest, ARowSaysWhatWasRequiredBefore) {
  Build(40, 40);
  Standing& standing = summary_.standing;
  standing.verdict = StandingVerdict::kNotEvidence;
  standing.is_post_hoc = true;
  standing.requirements[0].verdict = "not_evidence";
  standing.requirements[0].post_hoc = true;
  standing.requirements[0].reason = "It was stated after its flights were flown.";
  standing.dropped = {{"", "pitch_error_peak_deg below 0.1 for 90 % of flights at 10 % risk", "fail"},
                      {"", "q_max_pa below 3 in every case", ""}};
  const std::string page = FirstPage(campaign_, summary_);
  EXPECT_THAT(page, HasSubstr("<b>required before the flights: below 0.1 for 90 % of flights at 10 % risk; "
                              "verdict: fail</b>"));
  EXPECT_THAT(
      page, HasSubstr("q_max_pa below 3 in every case<span class=\"definition\"><b>left out after the first "
                      "flight; its last verdict: none</b></span></th>"));
  EXPECT_THAT(page, Not(HasSubstr("It was stated after"))) << "the badge and the note say so";
}

TEST_F(ReportPageTest, DiffersByWhatWasBeforeOnItsFirstPageAlone) {
  Build(40, 40);
  campaign_.requirements.clear();
  summary_.requirements.clear();
  summary_.standing = {};
  const auto rest = [&] {
    const std::string page = ReportPage(campaign_, summary_, cases_, histories_);
    return page.substr(page.find("<!-- run:end -->"));
  };
  const std::string before = rest();
  summary_.standing.verdict = StandingVerdict::kNotEvidence;
  summary_.standing.is_post_hoc = true;
  summary_.standing.dropped = {
      {"", "pitch_error_peak_deg below 0.1 for 90 % of flights at 10 % risk", "fail"}};
  EXPECT_EQ(rest(), before);
  EXPECT_THAT(FirstPage(campaign_, summary_),
              HasSubstr("(<a class=\"term\" href=\"#term-post-hoc\">post hoc</a>)"));
}

TEST_F(ReportPageTest, ConvergenceIsDrawnWhereItSaysMoreThanNumbersAndOnce) {
  Build(40, 40);
  RequirementSummary& one = summary_.requirements[0];
  const auto charts = [&] {
    const std::string section = RequirementsSection(summary_);
    const std::regex chart("<svg class=\"chart\"");
    return std::distance(std::sregex_iterator(section.begin(), section.end(), chart), std::sregex_iterator());
  };
  ASSERT_GT(one.failures, 0);
  one.verdict = "fail";
  EXPECT_EQ(charts(), 1);
  one.failures = 0;
  one.verdict = "pass";
  EXPECT_EQ(charts(), 0);
  one.failures = one.n;
  one.verdict = "fail";
  EXPECT_EQ(charts(), 0);
  one.failures = 2;
  summary_.requirements.push_back(one);
  summary_.requirements[1].metric = "yaw_error_peak_deg";
  EXPECT_EQ(charts(), 1) << "the same curve";
  EXPECT_THAT(RequirementsSection(summary_),
              HasSubstr("Pitch error, peak; Yaw error, peak: 2 of 40 flights"));
}

TEST_F(ReportPageTest, ExplainsItsWordsFromTheDocsSitesGlossary) {
  Build(40, 40);
  EXPECT_GT(Glossary().size(), 30u);
  const std::regex link("href=\"#([^\"]+)\"");
  for (std::sregex_iterator at(page_.begin(), page_.end(), link), end; at != end; ++at)
    EXPECT_THAT(page_, HasSubstr("id=\"" + (*at)[1].str() + "\"")) << "a link to nowhere";
  for (const char* word : {"consumer risk", "attained risk", "max q", "q·α", "clock angle", "digest",
                           "attempt", "margin", "bound"}) {
    const auto entry = std::find_if(Glossary().begin(), Glossary().end(),
                                    [&](const GlossaryEntry& one) { return one.word == word; });
    ASSERT_NE(entry, Glossary().end()) << word;
    EXPECT_THAT(page_, HasSubstr("<dfn>" + std::string(word) + "</dfn></dt><dd>" + HtmlText(entry->meaning)));
  }
  EXPECT_THAT(page_, Not(HasSubstr("<dfn>harmed</dfn>"))) << "a word that the page does not use";
  EXPECT_THROW(Term("no such word"), std::logic_error);
}

TEST_F(ReportPageTest, EveryTableHasHeadsForReadersWhoListen) {
  Build(40, 40);
  const std::regex bare("<th(?! scope=)[ >]"), empty_head("<th [^>]*></th>");
  EXPECT_FALSE(std::regex_search(page_, bare));
  EXPECT_FALSE(std::regex_search(page_, empty_head)) << "a head without a word";
  EXPECT_THAT(page_, HasSubstr("<main>"));
}

TEST_F(ReportPageTest, FlightsNearestToSeveralLimitsAreToldOnce) {
  FailureDrivers nearest{
      .metric = "yaw_error_peak_deg", .nearest = true, .flights = 10, .drivers = {}, .pairs = {}};
  nearest.drivers.push_back({.input = "wind_azimuth_deg", .key = "wind.azimuth", .feature = "x"});
  FailureDrivers other = nearest;
  other.drivers[0].p = 0.01;
  summary_.failure_drivers = {nearest, nearest, other};
  const std::string html = CausesSection(summary_);
  const std::string title = "Nearest to failing of Yaw error, peak: 10 flights";
  EXPECT_NE(html.find(title), html.rfind(title));
  EXPECT_EQ(html.find(title, html.find(title) + 1), html.rfind(title)) << "two, not three";
}

TEST_F(ReportPageTest, AMetricOfOneValueIsSaidAndNotDrawn) {
  Build(40, 40);
  campaign_.requirements[0].metric = "deflection_saturated_fraction";
  cases_.metrics[MetricColumn("deflection_saturated_fraction")] = std::vector<double>(40, 0.0);
  summary_.worst_cases = {{"deflection_saturated_fraction", {}}};
  const std::string page = ReportPage(campaign_, summary_, cases_, histories_);
  EXPECT_THAT(
      page,
      HasSubstr(
          "<p id=\"of-deflection_saturated_fraction\">Deflection saturated: 0 in 39 of 40 flown cases.</p>"));
  EXPECT_THAT(page, Not(HasSubstr("Histogram of Deflection saturated")));
}

}  // namespace
}  // namespace dispersa::pages_report_test
