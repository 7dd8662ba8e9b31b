// Columns of results: which numbers count as values.
#include "core/results/case_columns.h"

#include "tests/test.h"
#include "tests/unit/made_up_results.h"

namespace dispersa::results_case_columns_test {
namespace {

using namespace report_test;

TEST(ReportCaseColumns, OnlyCompletedFlightsHaveValues) {
  CaseColumns cases;
  cases.index = {0, 1, 2};
  cases.outcome = {Outcome::kCompleted, Outcome::kLostControl, Outcome::kImpact};
  cases.metrics.resize(MetricCount(kUsualStages));
  cases.metrics[MetricColumn("pitch_error_rms_deg")] = std::vector{0.1, 0.2, 0.3};
  const std::vector<double> values = CompletedValues(cases, "pitch_error_rms_deg");
  EXPECT_EQ(values[0], 0.1);
  EXPECT_TRUE(std::isnan(values[1]));
  EXPECT_TRUE(std::isnan(values[2]));
  EXPECT_EQ(LostCount(cases), 2u);
}

// More rows than a block holds, and a last block that is not full: the file and the memory together.
TEST(ReportCaseColumns, ColumnsOfManyCasesComeBackFromTheDisk) {
  TemporaryFolder temporary;
  constexpr std::size_t kRows = 20000;
  const auto file = std::make_shared<ColumnFile>(temporary / ".", 3);
  for (std::size_t row = 0; row < kRows; ++row) {
    const auto k = static_cast<double>(row);
    file->Append({k, row % 2 == 0 ? kNaN : -k, 0.5 * k});
  }
  const CaseColumn last(file, 2);
  EXPECT_EQ(last.size(), kRows);
  const std::vector<double> first = file->Read(0), second = file->Read(1), third = last;
  ASSERT_EQ(first.size(), kRows);
  for (std::size_t row = 0; row < kRows; ++row) {
    const auto k = static_cast<double>(row);
    ASSERT_EQ(first[row], k);
    ASSERT_TRUE(row % 2 == 0 ? std::isnan(second[row]) : second[row] == -k) << row;
    ASSERT_EQ(third[row], 0.5 * k);
  }
  // Nothing of it has a name.
  EXPECT_TRUE(std::filesystem::is_empty(temporary / "."));
}

// Exactly a block, and no row at all.
TEST(ReportCaseColumns, WholeBlocksAndNone) {
  TemporaryFolder temporary;
  ColumnFile file(temporary / ".", 1);
  EXPECT_TRUE(file.Read(0).empty());
  for (std::size_t row = 0; row < 8192; ++row) file.Append({static_cast<double>(row)});
  EXPECT_EQ(file.Read(0).back(), 8191.0);
  file.Append({8192.0});
  EXPECT_EQ(file.Read(0).at(8191), 8191.0);
  EXPECT_EQ(file.Read(0).at(8192), 8192.0);
}

TEST(ReportCaseColumns, AFolderThatCannotBeWrittenDoesNotMatter) {
  ColumnFile file("/proc/self", 1);
  for (std::size_t row = 0; row < 9000; ++row) file.Append({static_cast<double>(row)});
  EXPECT_EQ(file.Read(0).front(), 0.0);
}

TEST(ReportCaseColumns, OfManyLostFlightsTheFirstAreListed) {
  TemporaryFolder temporary;
  constexpr std::uint64_t kLost = kListedLostFlights + 5;
  ResultFolder folder = ResultFolder::Create(temporary / "out", MakeCampaign(kLost));
  std::vector<CaseResult> results;
  for (std::uint64_t k = 0; k < kLost; ++k) {
    results.push_back(MakeCase(k));
    results.back().outcome = Outcome::kImpact;
  }
  folder.Append(results);
  std::vector<std::uint64_t> all(kLost);
  std::iota(all.begin(), all.end(), std::uint64_t{0});
  for (const int threads : {1, 2}) {
    SCOPED_TRACE(threads);
    std::vector<std::uint64_t> seen;
    const CaseColumns cases = ReadColumns(
        folder, {FindInput("cg_factor"), FindInput("drag_factor")},
        [&seen](const CaseResult& result) { seen.push_back(result.case_index); }, threads);
    EXPECT_EQ(cases.lost_flights.size(), kListedLostFlights);
    EXPECT_EQ(LostCount(cases), kLost);
    EXPECT_EQ(seen, all);
    const auto input = [&cases](const char* name) {
      return cases.inputs[static_cast<std::size_t>(FindInput(name))].Values();
    };
    EXPECT_EQ(input("drag_factor")[7], results[7].inputs[0]);
    EXPECT_EQ(input("drag_factor").back(), results.back().inputs[0]);
    EXPECT_EQ(input("cg_factor"), std::vector<double>(kLost, 1.0)) << "no row holds it";
    EXPECT_TRUE(input("cp_factor").empty()) << "not asked for";
  }
}

}  // namespace
}  // namespace dispersa::results_case_columns_test
