#include "core/pages/reports.h"

#include <fmt/format.h>

#include "core/cases/campaign_flights.h"
#include "core/control/law_here.h"
#include "core/flight/engine_version.h"
#include "core/input/input_error.h"
#include "core/pages/histories.h"
#include "core/pages/report_page.h"
#include "core/pages/report_sums.h"
#include "core/results/case_columns.h"
#include "core/results/cases_csv.h"
#include "core/results/nominal_json.h"
#include "core/results/output_file.h"
#include "core/results/result_error.h"

namespace dispersa {

namespace {

/// What was flown and reported once is not written over by less: rows that are missing now may be the
/// folder's damage.
void RefuseFewer(const std::filesystem::path& file, std::uint64_t cases) {
  const std::uint64_t there = CountCases(file);
  if (cases >= there) return;
  throw ResultError(
      ResultError::Kind::kFewer,
      fmt::format("{}: it has {} cases and results.sqlite has {}: the reports stay as they are; remove "
                  "cases.csv to have reports of {}",
                  file.string(), there, cases, cases));
}

}  // namespace

CampaignSummary WriteReports(const ResultFolder& folder, const Campaign& campaign,
                             const ReportOptions& options) {
  RequireWhole(folder);
  const std::string engine = folder.Provenance("engine");
  const bool is_ours = engine == EngineVersion();
  if (const auto& law = campaign.autopilot.plugin; options.histories && is_ours && law && IsAbsent(*law)) {
    throw InputError(
        fmt::format("{}: flown with a Python law, '{}', which is not here: its cases cannot be flown again",
                    folder.directory().string(), law->name),
        "--no-histories; with them dispersa.report(DIR, law=...) in Python");
  }
  const std::filesystem::path cases_csv = folder.directory() / "cases.csv";
  CasesCsv csv(cases_csv, folder, StoredColumns(folder, campaign.soundings));
  const CaseColumns cases = ReadColumns(
      folder, DispersedInputs(campaign), [&csv](const CaseResult& result) { csv.Write(result); },
      options.threads);
  RefuseFewer(cases_csv, csv.rows());
  std::error_code ignored;
  std::filesystem::remove(folder.directory() / kSumsName, ignored);  // until all of them are written
  csv.Commit();
  WriteFile(folder.directory() / "nominal.json", NominalJson(folder.inputs()));
  CampaignSummary summary = BuildSummary(folder, campaign, cases, options.threads);
  FlightHistories histories;
  if (options.histories) {
    histories = WriteHistories(folder, campaign, summary, cases, options);
    if (is_ours) summary.nominal = histories.nominal;
    if (histories.nominal_history.rows() > 0)
      summary.envelope = {histories.bands.flights, histories.bands.extreme_flights};
  } else {
    if (is_ours) RemoveHistories(folder);  // those of another engine cannot be made again
    // One flight says whether the campaign disperses about a flight at all.
    summary.nominal = NominalOf(campaign, engine);
  }
  WriteFile(folder.directory() / "summary.json", SummaryJson(summary));
  WriteStanding(folder, summary);
  RecordLooks(folder, campaign, summary);
  WriteFile(folder.directory() / "report.html", ReportPage(campaign, summary, cases, histories));
  WriteSums(folder.directory());
  return summary;
}

}  // namespace dispersa
