#include "core/pages/kept_histories.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>

#include "core/flight/engine_version.h"
#include "core/math/assertion.h"
#include "core/math/constants.h"
#include "core/results/fingerprint.h"
#include "core/results/gzip.h"
#include "core/results/number_csv.h"
#include "core/results/output_file.h"
#include "core/results/text.h"
#include "core/statistics/summary.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr char kMadeOf[] = "made_of.json";

std::vector<std::string> FilesOf(const HistoryFlights& flights) {
  std::vector<std::string> files = {kNominalHistoryName, kBandsName, kImpactsName};
  for (const std::uint64_t index : flights.written) files.push_back(CaseHistoryName(index));
  return files;
}

/// A file as HistoryCsv and BandsCsv write it.
NumberCsv TableOf(std::string_view csv) {
  std::optional<NumberCsv> table = ReadNumberCsv(csv);
  DISPERSA_ASSERT(table.has_value(), csv.size());
  return *std::move(table);
}

std::vector<fs::path> Others(const fs::path& directory, const std::map<std::string, std::string>& files) {
  std::vector<fs::path> others;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory)) {
    const std::string name = entry.path().filename().string();
    if (name != kMadeOf && !files.contains(name)) others.push_back(entry.path());
  }
  return others;
}

Json MadeOf(const fs::path& directory) {
  return Json::parse(ReadWholeFile(directory / kMadeOf, ""), nullptr, false);
}

// A file that cannot be read as it was written is no reason to fail.
Json Member(const Json& object, const std::string& name) {
  return object.is_object() && object.contains(name) ? object[name] : Json();
}

std::optional<std::uint64_t> CaseOf(const std::string& name) {
  std::uint64_t index = 0;
  constexpr std::string_view kBefore = "case_";
  if (!name.starts_with(kBefore)) return std::nullopt;
  std::from_chars(name.data() + kBefore.size(), name.data() + name.size(), index);
  return CaseHistoryName(index) == name ? std::optional(index) : std::nullopt;
}

/// As it is called today. Release 0.1.0 wrote histories without compression.
std::string NameToday(const std::string& name) { return name.ends_with(".gz") ? name : name + ".gz"; }

/// The texts of these files by their names of today, if each is as it was written.
std::optional<std::map<std::string, std::string>> TextsOf(const fs::path& directory, const Json& fingerprints,
                                                          const std::vector<std::string>& names) {
  std::map<std::string, std::string> texts;
  for (const std::string& name : names) {
    const std::string bytes = ReadWholeFile(directory / name, "");
    std::optional<std::string> text = name == NameToday(name) ? Gunzip(bytes) : bytes;
    if (!text || Member(fingerprints, name) != Fingerprint(bytes).Hex()) return std::nullopt;
    texts[NameToday(name)] = *std::move(text);
  }
  return texts;
}

FlightHistories HistoriesIn(const std::map<std::string, std::string>& texts, const HistoryFlights& flights,
                            const std::vector<int>& columns, double step_s) {
  FlightHistories kept;
  kept.written_cases = flights.written;
  for (const std::uint64_t index : flights.written)
    kept.written_flights.push_back(
        SampleFlight(HistoryIn(texts.at(CaseHistoryName(index))), columns, step_s));
  kept.nominal_history = HistoryIn(texts.at(kNominalHistoryName));
  kept.bands = BandsIn(texts.at(kBandsName), columns, step_s, flights);
  // Another engine may have written none.
  if (const auto impacts = texts.find(kImpactsName); impacts != texts.end())
    kept.impacts = ImpactsIn(impacts->second);
  return kept;
}

}  // namespace

// By their names: another engine may have written other columns.
FlightBands BandsIn(std::string_view csv, const std::vector<int>& columns, double step_s,
                    const HistoryFlights& flights) {
  FlightBands bands;
  bands.flights = flights.sampled;
  bands.extreme_flights = flights.indices.size() - flights.sampled;
  bands.step_s = step_s;
  for (const int column : columns)
    bands.bands.push_back({.column = BandColumnNames()[static_cast<std::size_t>(column)]});
  const NumberCsv table = TableOf(csv);
  for (const std::vector<double>& row : table.rows) {
    bands.time_s.push_back(row[0]);
    bands.flying.push_back(static_cast<std::size_t>(row[1]));
  }
  for (Band& band : bands.bands)
    for (const BandStatistic& one : kBandStatistics) {
      const auto name = std::find(table.columns.begin(), table.columns.end(), band.column + "_" + one.name);
      const auto at = static_cast<std::size_t>(name - table.columns.begin());
      for (const std::vector<double>& row : table.rows)
        (band.*one.values).push_back(at < row.size() ? row[at] : kUndefined);
    }
  return bands;
}

History HistoryIn(std::string_view csv) {
  const NumberCsv table = TableOf(csv);
  std::vector<int> columns;
  for (const std::string& name : table.columns) columns.push_back(FindHistoryColumn(name));
  History history;
  for (const std::vector<double>& row : table.rows) {
    const std::size_t begin = history.values.size();
    history.values.resize(begin + HistoryColumns().size(), kUndefined);
    for (std::size_t i = 0; i < columns.size(); ++i)
      if (columns[i] >= 0) history.values[begin + static_cast<std::size_t>(columns[i])] = row[i];
  }
  return history;
}

std::string ImpactsCsv(const std::vector<ImpactPoint>& impacts) {
  constexpr int kDigits = 9;  // 1e-6 degree is 0.1 m
  std::string csv = "case,stage,lost,latitude_deg,longitude_deg\n";
  for (const ImpactPoint& point : impacts) {
    csv += fmt::format("{},{},{},", point.case_index, point.stage, point.lost ? 1 : 0);
    if (point.impact)
      csv += DigitsText(point.impact->place.latitude_rad * kDegPerRad, kDigits) + "," +
             DigitsText(point.impact->place.longitude_rad * kDegPerRad, kDigits);
    else
      csv += ",";
    csv += "\n";
  }
  return csv;
}

std::vector<ImpactPoint> ImpactsIn(std::string_view csv) {
  std::vector<ImpactPoint> impacts;
  for (const std::vector<double>& row : TableOf(csv).rows) {
    ImpactPoint& point = impacts.emplace_back();
    point.case_index = static_cast<std::uint64_t>(row[0]);
    point.stage = static_cast<int>(row[1]);
    point.lost = row[2] > 0.0;
    if (std::isfinite(row[3]))
      point.impact = Impact{.place = {row[3] / kDegPerRad, row[4] / kDegPerRad, 0.0}};
  }
  return impacts;
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
  nlohmann::ordered_json made_of = {{"schema", "dispersa/histories/2"},
                                    {"key", key},
                                    {"sampled", flights.sampled},
                                    {"extreme", flights.indices.size() - flights.sampled}};
  for (const std::string& name : FilesOf(flights))
    made_of["files"][name] = Fingerprint(ReadWholeFile(directory / name, "")).Hex();
  WriteFile(directory / kMadeOf, made_of.dump(1) + "\n");
}

std::optional<FlightHistories> ReadKeptHistories(const fs::path& directory, const std::string& key,
                                                 const HistoryFlights& flights,
                                                 const std::vector<int>& columns, double step_s) {
  const Json made_of = MadeOf(directory);
  if (Member(made_of, "key") != key) return std::nullopt;
  auto texts = TextsOf(directory, Member(made_of, "files"), FilesOf(flights));
  if (!texts) return std::nullopt;
  // Files of other reports would be taken for some of this one.
  for (const fs::path& file : Others(directory, *texts)) fs::remove_all(file);
  return HistoriesIn(*texts, flights, columns, step_s);
}

std::optional<FlightHistories> ReadForeignHistories(const fs::path& directory,
                                                    const std::vector<int>& columns, double step_s) {
  const Json made_of = MadeOf(directory), files = Member(made_of, "files");
  HistoryFlights flights;
  std::vector<std::string> names;
  if (files.is_object())
    for (const auto& [name, fingerprint] : files.items()) {
      names.push_back(name);
      if (const auto index = CaseOf(NameToday(name))) flights.written.push_back(*index);
    }
  std::sort(flights.written.begin(), flights.written.end());
  const auto texts = TextsOf(directory, files, names);
  if (!texts || !texts->contains(kBandsName) || !texts->contains(kNominalHistoryName)) return std::nullopt;
  const auto count = [&](const char* name, std::size_t otherwise) {
    const Json member = Member(made_of, name);
    return member.is_number_unsigned() ? member.get<std::size_t>() : otherwise;
  };
  FlightHistories kept = HistoriesIn(*texts, flights, columns, step_s);
  // At lift-off all of them fly.
  kept.bands.flights = count("sampled", kept.bands.flying.empty() ? 0 : kept.bands.flying.front());
  kept.bands.extreme_flights = count("extreme", 0);
  return kept;
}

}  // namespace dispersa
