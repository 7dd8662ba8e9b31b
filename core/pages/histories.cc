#include "core/pages/histories.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <utility>

#include "core/analysis/band_counter.h"
#include "core/flight/engine_version.h"
#include "core/math/assertion.h"
#include "core/optimization/parallel_for.h"
#include "core/pages/kept_histories.h"
#include "core/results/file_system.h"
#include "core/results/gzip.h"
#include "core/results/metric_catalogue.h"
#include "core/results/output_file.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;

constexpr double kHistoryStep_s = 0.1;
constexpr int kHistoryDigits = 9;
/// Flights with every tick that are held at the same time: a flight of ten minutes has 30 MB.
constexpr std::size_t kWithEveryTick = 2;
/// Short compared with the transients of an ignition (about 1 s), and a multiple of kHistoryStep_s.
constexpr double kBandStep_s = 0.2;
/// Of a flight's history the rows of events.
constexpr double kEventsOnly_s = 1e6;
/// Worst cases of each key metric that get a history.
constexpr std::size_t kWorstWritten = 2;

/// The report shows the spread of these quantities over the cases.
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
                                    "qbar_pa",
                                    "axial_load_g",
                                    "mass_kg",
                                    "p_deg_s",
                                    "q_deg_s",
                                    "r_deg_s",
                                    "latitude_deg",
                                    "longitude_deg",
                                    "q_alpha_pa_rad",
                                    "pitch_error_powered_deg",
                                    "yaw_error_powered_deg",
                                    "roll_error_powered_deg"};

std::vector<int> BandColumns() {
  std::vector<int> columns;
  for (const char* name : kBandColumns) {
    const int column = FindBandColumn(name);
    DISPERSA_ASSERT(column >= 0, column);
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

std::vector<std::uint64_t> WorstToWrite(const CampaignSummary& summary) {
  std::set<std::uint64_t> indices;
  for (const WorstCases& worst : summary.worst_cases) {
    for (std::size_t i = 0; i < std::min(kWorstWritten, worst.cases.size()); ++i)
      indices.insert(worst.cases[i].case_index);
  }
  return {indices.begin(), indices.end()};
}

/// Only cases with a result are flown: a quarantined case may kill this process. The first cases are a fair
/// sample, so they give percentiles. The extreme cases are added, so that every peak lies within minimum and
/// maximum.
HistoryFlights ChooseFlights(const CampaignSummary& summary, const CaseColumns& cases,
                             std::uint64_t history_cases) {
  HistoryFlights flights;
  flights.written = WorstToWrite(summary);
  flights.sampled = static_cast<std::size_t>(
      std::lower_bound(cases.index.begin(), cases.index.end(), history_cases) - cases.index.begin());
  const auto sample_end = cases.index.begin() + static_cast<std::ptrdiff_t>(flights.sampled);
  flights.indices.assign(cases.index.begin(), sample_end);
  std::set<std::uint64_t> beyond(flights.written.begin(), flights.written.end());
  for (const std::size_t row : ExtremeRows(cases)) beyond.insert(cases.index[row]);
  for (const std::uint64_t index : beyond)
    if (!std::binary_search(cases.index.begin(), sample_end, index)) flights.indices.push_back(index);
  return flights;
}

/// What the rows and columns of the files are.
std::string LayoutOfFiles(const std::vector<int>& band_columns) {
  std::string layout = fmt::format("gzip impacts {} {} {}", kHistoryDigits, kHistoryStep_s, kBandStep_s);
  for (const int column : band_columns) layout += " " + BandColumnNames()[static_cast<std::size_t>(column)];
  for (const BandStatistic& one : kBandStatistics) layout += fmt::format(" {}", one.name);
  return layout;
}

/// The folder may hold histories of the worst cases of an earlier report.
void EmptyDirectory(const fs::path& directory) {
  std::error_code error;
  fs::remove_all(directory, error);
  if (!error) fs::create_directories(directory, error);
  if (error) FailFile(directory.string(), "cannot be made anew", error.value());
}

}  // namespace

std::string HistoryCsv(const History& history, const AutopilotConfig& autopilot, int digits) {
  const std::vector<int> columns = HistoryColumnsUnder(autopilot);
  std::string csv;
  for (const int column : columns)
    csv += (csv.empty() ? "" : ",") + HistoryColumns()[static_cast<std::size_t>(column)];
  csv += "\n";
  for (std::size_t row = 0; row < history.rows(); ++row) {
    for (const int column : columns) {
      if (column != columns.front()) csv += ",";
      csv +=
          digits == 0 ? ShortestText(history.at(row, column)) : DigitsText(history.at(row, column), digits);
    }
    csv += "\n";
  }
  return csv;
}

History Thinned(const History& ticks, double tick_s, double step_s) {
  constexpr double kSame_s = 1e-6;
  const std::size_t rows = ticks.rows(), columns = HistoryColumns().size();
  const long in_step = std::max(1L, std::lround(step_s / tick_s));
  std::vector<bool> kept(rows);
  const auto value = [&](std::size_t row, std::size_t column) {
    return ticks.values[row * columns + column];
  };
  const auto time_s = [&](std::size_t row) { return value(row, 0); };
  for (std::size_t row = 0; row < rows; ++row) {
    const long tick = std::lround(time_s(row) / tick_s);
    const bool is_tick = std::fabs(time_s(row) - static_cast<double>(tick) * tick_s) < kSame_s;
    // An event on a tick has a row beside the tick's.
    const bool is_double = (row > 0 && time_s(row) - time_s(row - 1) < kSame_s) ||
                           (row + 1 < rows && time_s(row + 1) - time_s(row) < kSame_s);
    kept[row] = !is_tick || is_double || tick % in_step == 0 || row + 1 == rows;
  }
  struct Extremes {
    double min = HUGE_VAL, max = -HUGE_VAL;
    std::size_t least = 0, largest = 0;
  };
  std::vector<Extremes> extremes(columns);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 1; column < columns; ++column) {
      const double here = value(row, column);
      Extremes& of_column = extremes[column];
      if (here < of_column.min && std::isfinite(here)) {
        of_column.min = here;
        of_column.least = row;
      }
      if (here > of_column.max && std::isfinite(here)) {
        of_column.max = here;
        of_column.largest = row;
      }
    }
  }
  for (const Extremes& of_column : extremes)
    if (of_column.min <= of_column.max) kept[of_column.least] = kept[of_column.largest] = true;
  History thinned;
  thinned.step_s = step_s;
  thinned.values.reserve(static_cast<std::size_t>(std::count(kept.begin(), kept.end(), true)) * columns);
  for (std::size_t row = 0; row < rows; ++row)
    if (kept[row])
      thinned.values.insert(thinned.values.end(),
                            ticks.values.begin() + static_cast<std::ptrdiff_t>(row * columns),
                            ticks.values.begin() + static_cast<std::ptrdiff_t>((row + 1) * columns));
  return thinned;
}

std::vector<std::size_t> ExtremeRows(const CaseColumns& cases) {
  std::set<std::size_t> rows;
  const std::size_t first_own = cases.metrics.size() - cases.own_metrics.size();
  for (std::size_t metric = 0; metric < cases.metrics.size(); ++metric) {
    const Circle circle =
        metric < first_own ? Metrics()[metric].circle : CircleOf(cases.own_metrics[metric - first_own]);
    const std::vector<double> values = Unwrapped(cases.metrics[metric], circle);
    std::size_t least = values.size(), largest = values.size();
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!std::isfinite(values[i])) continue;
      if (least == values.size() || values[i] < values[least]) least = i;
      if (largest == values.size() || values[i] > values[largest]) largest = i;
    }
    if (least < values.size()) rows.insert({least, largest});
  }
  return {rows.begin(), rows.end()};
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
  const std::vector<int> columns = BandColumns();
  if (folder.Provenance("engine") != EngineVersion())
    return ReadForeignHistories(directory, columns, kBandStep_s).value_or(FlightHistories());
  const HistoryFlights wanted = ChooseFlights(summary, cases, options.history_cases);
  const std::vector<std::uint64_t>& indices = wanted.indices;
  const std::vector<std::uint64_t>& written = wanted.written;
  const std::string key = KeyOfHistories(folder, campaign, wanted, LayoutOfFiles(columns));
  std::optional<FlightHistories> kept = ReadKeptHistories(directory, key, wanted, columns, kBandStep_s);
  if (!kept) EmptyDirectory(directory);
  FlightHistories histories = kept ? std::move(*kept) : FlightHistories();

  const CampaignFlights flights(campaign);
  progress("nominal flight", 0, 1);
  histories.nominal_history = {};
  histories.nominal_history.step_s = kHistoryStep_s;
  histories.nominal = flights.FlyNominal(&histories.nominal_history);
  if (kept) return histories;
  const double tick_s = campaign.autopilot.tick_s;
  const auto write = [&](const std::string& name, const History& ticks) {
    std::string csv = HistoryCsv(Thinned(ticks, tick_s, kHistoryStep_s), campaign.autopilot, kHistoryDigits);
    WriteFile(directory / name, Gzip(csv));
    return csv;
  };
  {
    History ticks;
    ticks.step_s = tick_s;
    flights.FlyNominal(&ticks);
    write(kNominalHistoryName, ticks);
  }

  BandCounter counter(columns, kBandStep_s);
  std::size_t flown = 0;
  const auto fly = [&](std::size_t from, std::size_t to) {
    std::vector<CaseOrder> orders;
    for (std::size_t i = from; i < to; ++i) orders.push_back({indices[i], kBandStep_s});
    std::vector<std::pair<CaseResult, History>> to_fall(
        std::min(to, std::max(from, std::min(wanted.sampled, kMostFallen))) - from);
    flights.FlyCases(orders, options.threads,
                     [&](std::size_t i, const CaseResult& result, const History& history) {
                       CheckReproduced(folder, indices[from + i], result.digest);
                       if (i < to_fall.size())
                         to_fall[i] = {result, Thinned(history, kBandStep_s, kEventsOnly_s)};
                       SampledFlight samples = SampleFlight(history, columns, kBandStep_s);
                       if (from + i < wanted.sampled) {
                         counter.Add(std::move(samples));
                       } else {
                         counter.AddExtreme(samples);
                       }
                       progress("time histories", ++flown, indices.size() + written.size());
                     });
    std::vector<std::vector<ImpactPoint>> fallen(to_fall.size());
    ParallelFor(to_fall.size(), static_cast<std::size_t>(std::max(1, options.threads)), [&](std::size_t i) {
      fallen[i] = ImpactPoints(flights, to_fall[i].first, to_fall[i].second);
    });
    for (const auto& of_case : fallen)
      histories.impacts.insert(histories.impacts.end(), of_case.begin(), of_case.end());
  };
  // The flights that the counter keeps are flown first. They may end in any order.
  const std::size_t first = std::min(wanted.sampled, BandCounter::kKept);
  fly(0, first);
  fly(first, indices.size());
  // What is drawn is what the files hold, so that it is the same when they are read again.
  const std::string bands = BandsCsv(counter.Bands(), kHistoryDigits);
  WriteFile(directory / kBandsName, Gzip(bands));
  histories.bands = BandsIn(bands, columns, kBandStep_s, wanted);
  const std::string impacts = ImpactsCsv(histories.impacts);
  WriteFile(directory / kImpactsName, Gzip(impacts));
  histories.impacts = ImpactsIn(impacts);

  histories.written_cases = written;
  histories.written_flights.resize(written.size());
  for (std::size_t at = 0; at < written.size(); at += kWithEveryTick) {
    std::vector<CaseOrder> orders;
    for (std::size_t i = at; i < std::min(at + kWithEveryTick, written.size()); ++i)
      orders.push_back({written[i], tick_s});
    flights.FlyCases(orders, options.threads,
                     [&](std::size_t i, const CaseResult& result, const History& ticks) {
                       CheckReproduced(folder, written[at + i], result.digest);
                       const std::string csv = write(CaseHistoryName(written[at + i]), ticks);
                       histories.written_flights[at + i] = SampleFlight(HistoryIn(csv), columns, kBandStep_s);
                       progress("time histories", ++flown, indices.size() + written.size());
                     });
  }
  KeepHistories(directory, key, wanted);
  return histories;
}

}  // namespace dispersa
