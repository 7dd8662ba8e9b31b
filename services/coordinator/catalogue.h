// The campaigns of a coordinator that runs for weeks: what was launched, in which order, and what became of
// it. Each is a folder of the data directory, so that a restart finds them all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/results/folder_lock.h"
#include "core/results/folder_state.h"
#include "services/web/campaign_row.h"

namespace dispersa {

enum class CampaignState {
  kWaiting,
  kFlying,
  kReporting,
  kDone,
  kCancelled,
  kFailed,
  kRefused,
  kUnfinished,  ///< only the engine that began its flights can go on
  kDamaged      ///< its state.json cannot be trusted
};

/// "waiting", "flying", "reporting", "done", "cancelled", "failed", "refused", "unfinished", "damaged".
const char* CampaignStateName(CampaignState state);
/// Nothing more happens to it by itself.
bool HasEnded(CampaignState state);

/// Of requirements it has the first kMaxOutcomes.
struct CatalogueEntry : CampaignFacts {
  std::string flight_id;
  std::uint64_t conflicts = 0;  ///< results that contradicted others, ever
  CampaignState state = CampaignState::kWaiting;
  std::uint64_t seed = 0;
  std::vector<std::string> distrusted;  ///< workers whose results are still to be removed (dispersa repair)

  bool operator==(const CatalogueEntry&) const = default;
};

/// Labels of a campaign. Older ones are dropped.
inline constexpr std::size_t kMaxLabels = 32;

/// Requirements of a campaign that its entry keeps: it has to stay small.
inline constexpr std::size_t kMaxOutcomes = 20;

/// The order of the queue: by priority, then by age.
bool ComesBefore(const CatalogueEntry& a, const CatalogueEntry& b);

/// Each is the last one now, and was no other before. Beyond kMaxLabels those that were given first go.
void AddLabels(CatalogueEntry* entry, const std::vector<std::string>& labels);

/// Into the queue, as if it had never ended: nothing of its report stands any more.
void QueueAgain(CatalogueEntry* entry);

/// Version of state.json. Version 2 has `seed`, `ended_unix_s` and `distrusted`. Version 3 has all members
/// from `owner` on. Version 4 has a checksum. Earlier versions, which lack them, can be read too.
inline constexpr int kStateVersion = 4;

inline constexpr char kStateFile[] = "state.json", kResultsFolder[] = "results";

/// The id of the campaign, without the engine that flew it.
std::string CampaignIdOf(const std::string& id);

/// What the folder of a campaign says; kDamaged if its state is not as it was written. None: nobody was told
/// of it.
std::optional<CatalogueEntry> ReadEntry(const std::filesystem::path& folder);

/// Throws InputError if it cannot.
void MakeDataFolder(const std::filesystem::path& directory);

/// DIR/<id>/campaign.yaml, state.json and results/. One process at a time, locked. Throws ResultError,
/// InputError.
class Catalogue {
 public:
  /// Reads what is there. A campaign whose state is damaged is listed as that, and never written.
  explicit Catalogue(const std::filesystem::path& directory);

  const std::map<std::string, CatalogueEntry>& entries() const { return entries_; }
  /// Ids of campaigns that had not ended when they were written last. Thousands that have ended are not
  /// looked at twenty times a second.
  const std::set<std::string>& open() const { return open_; }
  /// Grows whenever an entry is written or removed.
  std::uint64_t changes() const { return changes_; }
  CatalogueEntry& At(const std::string& id) { return entries_.at(id); }
  /// The campaign whose id begins so, if it is exactly one.
  const CatalogueEntry* Find(const std::string& prefix) const;
  /// Ids in the order of the queue.
  std::vector<std::string> InOrder() const;

  CatalogueEntry& Add(CatalogueEntry entry, const std::string& text);
  void Write(const CatalogueEntry& entry);
  /// Its folder gets another id, and nothing else changes.
  CatalogueEntry& Rename(const std::string& id, const std::string& to);
  /// Its folder with all results.
  void Remove(const std::string& id);

  std::string TextOf(const std::string& id) const;
  std::string StateTextOf(const std::string& id) const;
  /// Bytes of its files now.
  std::uint64_t CountBytes(const std::string& id) const;
  std::filesystem::path ResultsOf(const std::string& id) const { return directory_ / id / kResultsFolder; }

 private:
  std::filesystem::path directory_;
  std::optional<FolderLock> lock_;
  std::map<std::string, CatalogueEntry> entries_;
  std::set<std::string> open_;
  std::uint64_t next_order_ = 1;
  std::uint64_t changes_ = 0;
};

}  // namespace dispersa
