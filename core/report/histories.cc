#include "core/report/histories.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <filesystem>
#include <set>

#include "core/report/output_file.h"
#include "core/report/text.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;

constexpr double kHistoryStep_s = 0.1;
/// Short against the transients of an ignition (about a second), and a multiple of the other step.
constexpr double kBandStep_s = 0.2;
/// Worst cases of each key metric that get a history.
constexpr std::size_t kWorstWritten = 2;

/// Quantities whose spread over the cases is shown.
const char* const kBandColumns[] = {"altitude_m",
                                    "pitch_launch_deg",
                                    "pitch_program_deg",
                                    "pitch_error_deg",
                                    "yaw_error_deg",
                                    "roll_error_deg",
                                    "deflection_pitch_deg",
                                    "deflection_yaw_deg",
                                    "deflection_roll_deg",
                                    "alpha_deg",
                                    "beta_deg",
                                    "qbar_pa"};

std::vector<int> BandColumns() {
  std::vector<int> columns;
  for (const char* name : kBandColumns) {
    const int column = FindHistoryColumn(name);
    assert(column >= 0);
    columns.push_back(column);
  }
  return columns;
}

void CheckReproduced(const ResultFolder& folder, std::uint64_t case_index, const Digest& flown) {
  const Digest stored = folder.Load(case_index).digest;
  if (stored == flown) return;
  throw ResultError(
      ResultError::Kind::kConflict,
      fmt::format("case {} does not reproduce its stored result: digest {} is stored, {} was flown now",
                  case_index, stored.Hex(), flown.Hex()));
}

/// Other worst cases may have had their histories there before.
void EmptyDirectory(const fs::path& directory) {
  std::error_code error;
  fs::remove_all(directory, error);
  if (!error) fs::create_directories(directory, error);
  if (error) {
    throw ResultError(
        error == std::errc::no_space_on_device ? ResultError::Kind::kDiskFull : ResultError::Kind::kFile,
        fmt::format("{}: cannot be made anew: {}", directory.string(), error.message()));
  }
}

std::vector<std::uint64_t> WorstToWrite(const CampaignSummary& summary) {
  std::set<std::uint64_t> indices;
  for (const WorstCases& worst : summary.worst_cases) {
    for (std::size_t i = 0; i < std::min(kWorstWritten, worst.cases.size()); ++i)
      indices.insert(worst.cases[i].case_index);
  }
  return {indices.begin(), indices.end()};
}

}  // namespace

std::string HistoryCsv(const History& history) {
  const std::vector<std::string>& columns = HistoryColumns();
  std::string csv;
  for (std::size_t i = 0; i < columns.size(); ++i) csv += (i == 0 ? "" : ",") + columns[i];
  csv += "\n";
  for (std::size_t row = 0; row < history.rows(); ++row) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (i > 0) csv += ",";
      csv += ShortestText(history.at(row, static_cast<int>(i)));
    }
    csv += "\n";
  }
  return csv;
}

void RemoveHistories(const ResultFolder& folder) {
  std::error_code ignored;  // what cannot be removed is out of date, and the report does not name it
  fs::remove_all(folder.directory() / "histories", ignored);
}

FlightHistories WriteHistories(const ResultFolder& folder, const Campaign& campaign,
                               const CampaignSummary& summary, const CaseColumns& cases,
                               const ReportOptions& options) {
  const auto progress = [&](const char* what, std::size_t done, std::size_t total) {
    if (options.progress) options.progress(what, done, total);
  };
  const fs::path directory = folder.directory() / "histories";
  EmptyDirectory(directory);
  const CampaignFlights flights(campaign);
  FlightHistories histories;

  progress("nominal flight", 0, 1);
  histories.nominal_history.step_s = kHistoryStep_s;
  histories.nominal = flights.FlyNominal(&histories.nominal_history);
  WriteFile(directory / "nominal.csv", HistoryCsv(histories.nominal_history));

  // Only cases that have a result are flown: a quarantined one may take this process with it.
  histories.written_cases = WorstToWrite(summary);
  const auto banded_end = std::lower_bound(cases.index.begin(), cases.index.end(), options.history_cases);
  const auto banded = static_cast<std::size_t>(banded_end - cases.index.begin());
  std::vector<std::uint64_t> indices(cases.index.begin(), banded_end);
  for (const std::uint64_t index : histories.written_cases) {
    if (index >= options.history_cases) indices.push_back(index);
  }
  const std::vector<int> columns = BandColumns();
  std::vector<SampledFlight> samples(banded);
  std::vector<Digest> digests(indices.size());
  const auto is_written = [&](std::uint64_t index) {
    return std::binary_search(histories.written_cases.begin(), histories.written_cases.end(), index);
  };
  std::vector<CaseOrder> orders;
  for (const std::uint64_t index : indices) orders.push_back({index, is_written(index) ? kHistoryStep_s : kBandStep_s});
  std::size_t flown = 0;
  flights.FlyCases(orders, options.threads, [&](std::size_t i, const CaseResult& result, const History& history) {
    digests[i] = result.digest;
    if (is_written(indices[i])) WriteFile(directory / fmt::format("case_{}.csv", indices[i]), HistoryCsv(history));
    if (i < banded) samples[i] = SampleFlight(history, columns, kBandStep_s);
    progress("time histories", ++flown, indices.size());
  });
  for (std::size_t i = 0; i < indices.size(); ++i) CheckReproduced(folder, indices[i], digests[i]);
  histories.bands = ComputeBands(samples, columns, kBandStep_s);
  WriteFile(directory / "bands.csv", BandsCsv(histories.bands));
  return histories;
}

}  // namespace dispersa
