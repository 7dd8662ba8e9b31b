#include "core/pages/kept_histories.h"

#include <fmt/format.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>

#include "core/flight/engine_version.h"
#include "core/math/assertion.h"
#include "core/results/fingerprint.h"
#include "core/results/gzip.h"
#include "core/results/number_csv.h"
#include "core/results/output_file.h"
#include "core/statistics/summary.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;

constexpr char kMadeOf[] = "made_of.json";

std::string ReadText(const fs::path& file) {
  // In one piece: character by character took longer than the flights of a small campaign.
  std::ostringstream text;
  if (const std::ifstream stream(file, std::ios::binary); stream) text << stream.rdbuf();
  return std::move(text).str();
}

std::vector<std::string> FilesOf(const HistoryFlights& flights) {
  std::vector<std::string> files = {kNominalHistoryName, kBandsName};
  for (const std::uint64_t index : flights.written) files.push_back(CaseHistoryName(index));
  return files;
}

/// The rows of a file as HistoryCsv and BandsCsv write it.
std::vector<std::vector<double>> RowsOf(std::string_view csv) {
  std::optional<NumberCsv> table = ReadNumberCsv(csv);
  DISPERSA_ASSERT(table.has_value(), csv.size());
  return std::move(table->rows);
}

std::vector<fs::path> Others(const fs::path& directory, const std::map<std::string, std::string>& files) {
  std::vector<fs::path> others;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory)) {
    const std::string name = entry.path().filename().string();
    if (name != kMadeOf && !files.contains(name)) others.push_back(entry.path());
  }
  return others;
}

}  // namespace

FlightBands BandsIn(std::string_view csv, const std::vector<int>& columns, double step_s,
                    const HistoryFlights& flights) {
  FlightBands bands;
  bands.flights = flights.sampled;
  bands.extreme_flights = flights.indices.size() - flights.sampled;
  bands.step_s = step_s;
  for (const int column : columns)
    bands.bands.push_back({.column = HistoryColumns()[static_cast<std::size_t>(column)]});
  for (const std::vector<double>& row : RowsOf(csv)) {
    std::size_t at = 0;
    bands.time_s.push_back(row[at++]);
    bands.flying.push_back(static_cast<std::size_t>(row[at++]));
    for (Band& band : bands.bands)
      for (auto* values : {&band.min, &band.p01, &band.p05, &band.p50, &band.p95, &band.p99, &band.max})
        values->push_back(row[at++]);
  }
  return bands;
}

History HistoryIn(std::string_view csv, const AutopilotConfig& autopilot) {
  const std::vector<int> columns = HistoryColumnsUnder(autopilot);
  History history;
  for (const std::vector<double>& row : RowsOf(csv)) {
    const std::size_t begin = history.values.size();
    history.values.resize(begin + HistoryColumns().size(), kUndefined);
    for (std::size_t i = 0; i < columns.size(); ++i)
      history.values[begin + static_cast<std::size_t>(columns[i])] = row[i];
  }
  return history;
}

std::string CaseHistoryName(std::uint64_t case_index) { return fmt::format("case_{}.csv.gz", case_index); }

std::string KeyOfHistories(const ResultFolder& folder, const Campaign& campaign,
                           const HistoryFlights& flights, const std::string& layout) {
  std::string key = fmt::format("{} {} {} {}", EngineVersion(), campaign.flight_id, layout, flights.sampled);
  for (const std::uint64_t index : flights.indices)
    key += fmt::format(" {}:{}", index, folder.Load(index).digest.Hex());
  for (const std::uint64_t index : flights.written) key += fmt::format(" {}", index);
  return Fingerprint(key).Hex();
}

void KeepHistories(const fs::path& directory, const std::string& key, const HistoryFlights& flights) {
  nlohmann::ordered_json made_of = {{"schema", "dispersa/histories/2"}, {"key", key}};
  for (const std::string& name : FilesOf(flights))
    made_of["files"][name] = Fingerprint(ReadText(directory / name)).Hex();
  WriteFile(directory / kMadeOf, made_of.dump(1) + "\n");
}

std::optional<FlightHistories> ReadKeptHistories(const fs::path& directory, const std::string& key,
                                                 const Campaign& campaign, const HistoryFlights& flights,
                                                 const std::vector<int>& columns, double step_s) {
  const auto made_of = nlohmann::json::parse(ReadText(directory / kMadeOf), nullptr, false);
  // A file that cannot be read as it was written is no reason to fail: the flights are flown again.
  const auto member = [](const nlohmann::json& object, const std::string& name) {
    return object.is_object() && object.contains(name) ? object[name] : nlohmann::json();
  };
  if (member(made_of, "key") != key) return std::nullopt;
  const nlohmann::json files = member(made_of, "files");
  std::map<std::string, std::string> texts;
  for (const std::string& name : FilesOf(flights)) {
    const std::string bytes = ReadText(directory / name);
    std::optional<std::string> text = Gunzip(bytes);
    if (!text || member(files, name) != Fingerprint(bytes).Hex()) return std::nullopt;
    texts[name] = *std::move(text);
  }
  // Files of other reports would be taken for some of this one.
  for (const fs::path& file : Others(directory, texts)) fs::remove_all(file);
  FlightHistories kept;
  kept.written_cases = flights.written;
  for (const std::uint64_t index : flights.written)
    kept.written_flights.push_back(
        SampleFlight(HistoryIn(texts[CaseHistoryName(index)], campaign.autopilot), columns, step_s));
  kept.bands = BandsIn(texts[kBandsName], columns, step_s, flights);
  return kept;
}

}  // namespace dispersa
