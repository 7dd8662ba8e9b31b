// Time histories of an earlier report of the same flights: they need not be flown again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/pages/histories.h"

namespace dispersa {

/// The flights that the histories of a report are made of.
struct HistoryFlights {
  std::vector<std::uint64_t> indices;  ///< the sample of the percentiles, then the extremes
  std::size_t sampled = 0;             ///< number of sampled ones
  std::vector<std::uint64_t> written;  ///< cases with a file of their own, ascending
};

// Names of files in histories/.
inline constexpr char kNominalHistoryName[] = "nominal.csv.gz";
inline constexpr char kBandsName[] = "bands.csv.gz";
inline constexpr char kImpactsName[] = "impacts.csv.gz";
std::string CaseHistoryName(std::uint64_t case_index);

/// What HistoryCsv() and BandsCsv() have written.
History HistoryIn(std::string_view csv);
FlightBands BandsIn(std::string_view csv, const std::vector<int>& columns, double step_s,
                    const HistoryFlights& flights);

/// A row for each part that falls: case, stage (0: a booster), whether it is a lost stack, and latitude and
/// longitude of its impact, which are empty if it stays up.
std::string ImpactsCsv(const std::vector<ImpactPoint>& impacts);
/// Without the other values of a point.
std::vector<ImpactPoint> ImpactsIn(std::string_view csv);

/// A text that is the same if, and only if, the histories would have the same bytes: engine, flight id, and
/// the flights with their digests, and the layout of the files, which the engine version does not cover.
std::string KeyOfHistories(const ResultFolder& folder, const Campaign& campaign,
                           const HistoryFlights& flights, const std::string& layout);

/// Writes histories/made_of.json: the key, and a fingerprint of each file.
void KeepHistories(const std::filesystem::path& directory, const std::string& key,
                   const HistoryFlights& flights);

/// Reads the histories in `directory`. The nominal flight has no metrics. None if they are of other flights,
/// or if a file has changed.
std::optional<FlightHistories> ReadKeptHistories(const std::filesystem::path& directory,
                                                 const std::string& key, const HistoryFlights& flights,
                                                 const std::vector<int>& columns, double step_s);

/// The histories that another engine has written. Its flights cannot be repeated, so whatever flights they
/// are of, these are drawn. Undefined is what it did not write. None if a file has changed.
std::optional<FlightHistories> ReadForeignHistories(const std::filesystem::path& directory,
                                                    const std::vector<int>& columns, double step_s);

}  // namespace dispersa
