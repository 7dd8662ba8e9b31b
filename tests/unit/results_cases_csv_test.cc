// cases.csv is the same bytes in whatever order and however often results arrive.
#include "core/results/cases_csv.h"

#include <fstream>

#include "core/results/text.h"
#include "tests/test.h"
#include "tests/unit/made_up_results.h"

namespace dispersa::results_cases_csv_test {

using namespace report_test;

// Of the law that has every metric, and of flights of all kinds.
std::vector<std::size_t> AllMetrics(ControlLaw law = ControlLaw::kAdaptiveFuzzy) {
  return MetricsUnder(kUsualStages, AnyUnder(law));
}
CsvColumns AllColumns() { return {{0}, AllMetrics()}; }
std::string Header() {
  return CasesCsvHeader(RowInputs(MakeLimitedCampaign(1)), MetricList(kUsualStages), AllColumns());
}

TEST(CasesCsv, WritesDoublesThatReadBackToTheSameBits) {
  EXPECT_EQ(ShortestText(0.1 + 0.2), "0.30000000000000004");
  EXPECT_EQ(ShortestText(0.3), "0.3");
  EXPECT_EQ(ShortestText(500.0), "500");
  EXPECT_EQ(ShortestText(-1.5e-300), "-1.5e-300");
  EXPECT_EQ(ShortestText(-0.0), "0");
  EXPECT_EQ(ShortestText(kNaN), "");
  EXPECT_EQ(ShortestText(-std::numeric_limits<double>::infinity()), "");
}

TEST(CasesCsv, QuotesFieldsThatNeedIt) {
  EXPECT_EQ(CsvField("plain text"), "plain text");
  EXPECT_EQ(CsvField("one, two"), "\"one, two\"");
  EXPECT_EQ(CsvField("say \"no\""), "\"say \"\"no\"\"\"");
  EXPECT_EQ(CsvField("two\nlines"), "\"two\nlines\"");
}

TEST(CasesCsv, NamesEveryColumn) {
  const std::string header = Header();
  EXPECT_THAT(header, StartsWith("case_index,outcome,end_time_s,end_stage,reason,input_drag_factor,"));
  EXPECT_THAT(header, EndsWith(",metric_" + MetricNames()[MetricCount(kUsualStages) - 1] + ",digest\n"));
  EXPECT_EQ(static_cast<std::size_t>(std::count(header.begin(), header.end(), ',')),
            5 + 1 + MetricCount(kUsualStages));
}

TEST(CasesCsv, HasTheMetricsOfItsLawAlone) {
  TemporaryFolder temporary;
  Campaign campaign = MakeLimitedCampaign(1);
  campaign.autopilot.pitch.law = ControlLaw::kPd;
  ResultFolder folder = ResultFolder::Create(temporary / "out", campaign);
  folder.Append({{MakeCase(0)}});
  WriteCasesCsv(folder, StoredColumns(folder), temporary / "out" / "cases.csv");
  const std::string csv = TextOfFile(temporary / "out" / "cases.csv");
  EXPECT_THAT(csv, Not(HasSubstr("lyapunov")));
  EXPECT_THAT(csv, Not(HasSubstr("rules_fired")));
  EXPECT_THAT(csv, Not(HasSubstr("adaptation")));
  EXPECT_THAT(csv, HasSubstr(",metric_semi_major_axis_error_km,"));
  EXPECT_THAT(csv, HasSubstr(",metric_node_error_deg,metric_argument_of_perigee_error_deg,"));
  // Nothing of angles that the target does not name.
  campaign.reference.problem = {};
  ResultFolder plain = ResultFolder::Create(temporary / "plain", campaign);
  plain.Append({{MakeCase(0)}});
  WriteCasesCsv(plain, StoredColumns(plain), temporary / "plain" / "cases.csv");
  EXPECT_THAT(TextOfFile(temporary / "plain" / "cases.csv"), Not(HasSubstr("node_error")));
  EXPECT_TRUE(
      std::isnan(ResultFolder::Open(temporary / "plain").Load(0).metrics[MetricColumn("node_error_deg")]));
  // What a folder stores it reads again: of other laws' metrics nothing.
  const std::vector<double> stored = ResultFolder::Open(temporary / "out").Load(0).metrics;
  for (std::size_t i = 0; i < stored.size(); ++i)
    EXPECT_EQ(std::isnan(stored[i]), Metrics()[i].of_law != nullptr) << MetricNames()[i];

  EXPECT_EQ(AllMetrics(ControlLaw::kPd).size() + 4, AllMetrics().size());
  EXPECT_EQ(AllMetrics(ControlLaw::kFrozenFuzzy).size() + 1, AllMetrics().size());
}

TEST(CasesCsv, WritesOneLineACase) {
  CaseResult result = MakeCase(12);
  std::fill(result.inputs.begin(), result.inputs.end(), 0.25);
  std::fill(result.metrics.begin(), result.metrics.end(), kNaN);
  result.outcome = Outcome::kLostControl;
  result.end_time_s = 77.31;
  result.end_stage = 2;
  result.reason = "error above 15 deg, for 0.5 s";
  std::string expected = "12,lost_control,77.31,2,\"error above 15 deg, for 0.5 s\"";
  for (std::size_t i = 0; i < result.inputs.size(); ++i) expected += ",0.25";
  for (std::size_t i = 0; i < result.metrics.size(); ++i) expected += ",";
  EXPECT_EQ(CasesCsvLine(result, AllColumns()), expected + ",000000000000000d0000000000abcdef\n");
}

TEST(CasesCsv, NamesTheSoundingOfItsNumber) {
  CsvColumns columns = AllColumns();
  columns.sounding = 0;
  columns.soundings = {"mean,", "a.txt,2020-01-15", "b.txt,"};
  EXPECT_THAT(CasesCsvHeader(RowInputs(MakeLimitedCampaign(1)), MetricList(kUsualStages), columns),
              EndsWith(",sounding_file,sounding_time,digest\n"));
  CaseResult result = MakeCase(12);
  for (const auto& [number, cells] :
       {std::pair(0.0, ",mean,,"), {1.0, ",a.txt,2020-01-15,"}, {2.0, ",b.txt,,"}}) {
    result.inputs[0] = number;
    EXPECT_THAT(CasesCsvLine(result, columns), HasSubstr(cells)) << number;
  }
}

TEST(CasesCsv, DoesNotDependOnTheOrderOfArrival) {
  TemporaryFolder temporary;
  ResultFolder ascending = ResultFolder::Create(temporary / "ascending", MakeLimitedCampaign(50));
  for (std::uint64_t k = 0; k < 50; ++k) ascending.Append({{MakeCase(k)}});
  ResultFolder shuffled = ResultFolder::Create(temporary / "shuffled", MakeLimitedCampaign(50));
  std::vector<CaseResult> batch;
  for (std::uint64_t k = 0; k < 50; ++k) batch.push_back(MakeCase((k * 37 + 11) % 50));  // 37 is prime to 50
  shuffled.Append(batch);
  shuffled.Append(batch);
  WriteCasesCsv(ascending, StoredColumns(ascending), temporary / "ascending" / "cases.csv");
  WriteCasesCsv(shuffled, StoredColumns(shuffled), temporary / "shuffled" / "cases.csv");
  const std::string csv = TextOfFile(temporary / "ascending" / "cases.csv");
  EXPECT_EQ(csv, TextOfFile(temporary / "shuffled" / "cases.csv"));
  std::string expected = Header();
  for (std::uint64_t k = 0; k < 50; ++k) expected += CasesCsvLine(MakeCase(k), AllColumns());
  EXPECT_EQ(csv, expected);
  CasesCsv again(temporary / "again.csv", ascending, StoredColumns(ascending));
  again.Write(MakeCase(7));
  again.Write(MakeCase(8));
  EXPECT_EQ(again.rows(), 2u);
}

TEST(CasesCsv, LeavesOutWhatIsTheSameInAllCases) {
  TemporaryFolder temporary;
  ResultFolder folder = ResultFolder::Create(temporary / "out", MakeLimitedCampaign(2));
  CaseResult first = MakeCase(0), second = MakeCase(1);
  std::fill(first.metrics.begin(), first.metrics.end(), 2.0);
  second.metrics = first.metrics;
  second.metrics[0] = kNaN;  // defined in one of them
  first.metrics[1] = second.metrics[1] = kNaN;
  folder.Append({{first, second}});
  WriteCasesCsv(folder, VaryingColumns(folder), temporary / "out" / "varying.csv");
  const std::string csv = TextOfFile(temporary / "out" / "varying.csv");
  EXPECT_EQ(csv.substr(0, csv.find('\n')),
            "case_index,outcome,end_time_s,end_stage,reason,input_drag_factor,metric_" + MetricNames()[0] +
                ",digest");
  EXPECT_THAT(csv, HasSubstr(",0.1,2," + first.digest.Hex() + "\n"));
  EXPECT_THAT(csv, HasSubstr(",0.24285714285714285,," + second.digest.Hex() + "\n"));
}

TEST(CasesCsv, CountsTheCasesOfAFileHoweverTheyAreQuoted) {
  TemporaryFolder temporary;
  EXPECT_EQ(CountCases(temporary / "none"), 0u);
  ResultFolder folder = ResultFolder::Create(temporary / "out", MakeLimitedCampaign(3));
  WriteCasesCsv(folder, StoredColumns(folder), temporary / "cases.csv");
  EXPECT_EQ(CountCases(temporary / "cases.csv"), 0u) << "a header alone";
  CaseResult quoted = MakeCase(1);
  quoted.reason = "two\nlines, \"so\nto say\"";
  folder.Append({{MakeCase(0), quoted, MakeCase(2)}});
  WriteCasesCsv(folder, StoredColumns(folder), temporary / "cases.csv");
  EXPECT_EQ(CountCases(temporary / "cases.csv"), 3u);
  std::ofstream(temporary / "cases.csv", std::ios::app) << "3,compl";
  EXPECT_EQ(CountCases(temporary / "cases.csv"), 3u) << "a row without its end";
}

TEST(CasesCsv, ShowsNegativeZeroAsZeroAndUndefinedAsEmpty) {
  TemporaryFolder temporary;
  ResultFolder folder = ResultFolder::Create(temporary / "out", MakeLimitedCampaign(1));
  CaseResult result = MakeCase(0);
  result.metrics[0] = -0.0;
  result.metrics[1] = kNaN;
  folder.Append({{result}});
  WriteCasesCsv(folder, StoredColumns(folder), temporary / "out" / "cases.csv");
  CaseResult normalised = result;
  normalised.metrics[0] = 0.0;
  EXPECT_EQ(TextOfFile(temporary / "out" / "cases.csv"), Header() + CasesCsvLine(normalised, AllColumns()));
}

}  // namespace dispersa::results_cases_csv_test
