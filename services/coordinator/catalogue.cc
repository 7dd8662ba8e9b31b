#include "services/coordinator/catalogue.h"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "core/input/input_error.h"
#include "core/results/file_system.h"
#include "core/results/folder_state.h"
#include "core/results/output_file.h"
#include "core/results/result_error.h"
#include "services/coordinator/sealed_json.h"
#include "services/log/log.h"
#include "services/web/find_by_id.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::array kStates = {"waiting", "flying",  "reporting",  "done",   "cancelled",
                                "failed",  "refused", "unfinished", "damaged"};

constexpr char kDeleted[] = ".deleted-";
constexpr int kSealedSince = 4;

Json ToJson(const RequirementOutcome& one) {
  const auto bound = [](const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); };
  return {{"metric", one.metric},
          {"words", one.words},
          {"probability", one.probability},
          {"n", one.n},
          {"failures", one.failures},
          {"success_lower", bound(one.success_lower)},
          {"success_upper", bound(one.success_upper)},
          {"verdict", one.verdict},
          {"bound", bound(one.bound)},
          {"limits", one.limits}};
}

RequirementOutcome ToOutcome(const Json& json) {
  const auto bound = [](const Json& value) {
    return value.is_null() ? std::nullopt : std::optional(value.get<double>());
  };
  return {json.at("metric"),
          json.at("words"),
          json.at("probability"),
          json.at("n"),
          json.at("failures"),
          bound(json.at("success_lower")),
          bound(json.at("success_upper")),
          json.at("verdict"),
          bound(json.value("bound", Json(nullptr))),  // states of older releases have none
          json.value("limits", std::vector<double>())};
}

CatalogueEntry ParseState(const std::string& text) {
  const Json json = Unseal(text, kSealedSince);
  if (const int version = json.value("version", 1); version > kStateVersion) {
    throw std::runtime_error("was written by a newer dispersa: version " + std::to_string(version) +
                             ", this one reads " + std::to_string(kStateVersion));
  }
  CatalogueEntry entry;
  entry.id = json.at("id").get<std::string>();
  entry.flight_id = json.at("flight_id").get<std::string>();
  entry.name = json.at("name").get<std::string>();
  entry.priority = json.at("priority").get<int>();
  entry.order = json.at("order").get<std::uint64_t>();
  entry.cases = json.at("cases").get<std::uint64_t>();
  entry.done = json.at("done").get<std::uint64_t>();
  entry.quarantined = json.at("quarantined").get<std::uint64_t>();
  entry.conflicts = json.at("conflicts").get<std::uint64_t>();
  entry.code = json.at("code").get<int>();
  entry.problem = json.at("problem").get<std::string>();
  entry.seed = json.value("seed", std::uint64_t{0});
  entry.ended_unix_s = json.value("ended_unix_s", std::int64_t{0});
  entry.distrusted = json.value("distrusted", std::vector<std::string>());
  entry.owner = json.value("owner", "");
  entry.launched_unix_s = json.value("launched_unix_s", std::int64_t{0});
  entry.bytes = json.value("bytes", std::uint64_t{0});
  entry.verdict = json.value("verdict", "");
  entry.labels = json.value("labels", std::vector<std::string>());
  entry.design_id = json.value("design_id", "");
  entry.engine = json.value("engine", "");
  entry.attempts = json.value("attempts", std::int64_t{0});
  for (const Json& one : json.value("requirements", Json::array()))
    entry.requirements.push_back(ToOutcome(one));
  const auto state = std::find(kStates.begin(), kStates.end(), json.at("state").get<std::string>());
  if (state == kStates.end()) throw std::runtime_error("names an unknown state");
  entry.state = static_cast<CampaignState>(state - kStates.begin());
  // What was under way goes on.
  if (entry.state == CampaignState::kFlying || entry.state == CampaignState::kReporting) {
    entry.state = CampaignState::kWaiting;
  }
  return entry;
}

std::int64_t UnixTimeOf(const fs::path& file) {
  struct stat what {};
  return stat(file.c_str(), &what) == 0 ? what.st_mtime : 0;
}

std::uint64_t BytesIn(const fs::path& folder) {
  std::uint64_t bytes = 0;
  std::error_code error;
  for (auto entry = fs::recursive_directory_iterator(folder, error);
       !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    std::error_code unsized;
    if (const auto size = entry->file_size(unsized); !unsized) bytes += size;
  }
  return bytes;
}

/// What is known of a campaign without its state: what its results say. Nothing of it is written.
CatalogueEntry DamagedEntry(const fs::path& folder, const std::string& damage) {
  CatalogueEntry entry;
  entry.id = folder.filename().string();
  entry.state = CampaignState::kDamaged;
  entry.code = 1;
  entry.problem =
      std::string(kStateFile) + " " + damage +
      ": stop the coordinator, and let `dispersa fsck DATA --repair` make it anew from the results";
  entry.ended_unix_s = UnixTimeOf(folder);
  try {
    const FolderState state = ReadFolderState(folder / kResultsFolder);
    entry.name = state.name;
    entry.flight_id = state.flight_id;
    entry.engine = state.engine;
    entry.cases = state.planned;
    entry.done = state.cases;
    entry.quarantined = state.quarantined;
  } catch (const std::exception&) {
    // Its results are damaged too, or there are none.
  }
  return entry;
}

}  // namespace

std::string CampaignIdOf(const std::string& id) { return id.substr(0, id.find('-')); }

std::optional<CatalogueEntry> ReadEntry(const fs::path& folder) {
  const fs::path file = folder / kStateFile, results = folder / kResultsFolder;
  std::error_code error;
  const bool has_state = fs::exists(fs::symlink_status(file, error));
  // A launch that was killed before its state was written has left nothing that anybody was told of.
  if (!has_state && !fs::exists(results / "results.sqlite", error)) return std::nullopt;
  CatalogueEntry entry;
  try {
    if (!has_state) throw std::runtime_error("is missing");
    entry = ParseState(ReadWholeFile(file));
    const std::string id = folder.filename().string();
    if (entry.id != CampaignIdOf(id)) throw std::runtime_error("is that of campaign " + entry.id);
    entry.id = id;
    if (HasEnded(entry.state) && entry.ended_unix_s == 0) entry.ended_unix_s = UnixTimeOf(file);
    return entry;
  } catch (const ResultError&) {
    entry.problem = "cannot be read";
  } catch (const Json::exception&) {
    entry.problem = "lacks a member";
  } catch (const std::exception& damage) {
    entry.problem = damage.what();
  }
  entry = DamagedEntry(folder, entry.problem);
  return entry;
}

const char* CampaignStateName(CampaignState state) { return kStates[static_cast<std::size_t>(state)]; }

bool HasEnded(CampaignState state) {
  return state == CampaignState::kDone || state == CampaignState::kCancelled ||
         state == CampaignState::kFailed || state == CampaignState::kRefused ||
         state == CampaignState::kUnfinished || state == CampaignState::kDamaged;
}

bool ComesBefore(const CatalogueEntry& a, const CatalogueEntry& b) {
  return std::tuple(b.priority, a.order) < std::tuple(a.priority, b.order);
}

void AddLabels(CatalogueEntry* entry, const std::vector<std::string>& labels) {
  for (const std::string& label : labels) {
    std::erase(entry->labels, label);
    entry->labels.push_back(label);
  }
  if (entry->labels.size() > kMaxLabels)
    entry->labels.erase(entry->labels.begin(), entry->labels.end() - std::ptrdiff_t{kMaxLabels});
}

void QueueAgain(CatalogueEntry* entry) {
  entry->state = CampaignState::kWaiting;
  entry->code = 0;
  entry->quarantined = 0;
  entry->ended_unix_s = 0;
  entry->attempts = 0;
  entry->problem.clear();
  entry->verdict.clear();
  entry->requirements.clear();
}

void MakeDataFolder(const fs::path& directory) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (error) FailFolder(directory.string(), error);
}

Catalogue::Catalogue(const fs::path& directory) : directory_(directory) {
  MakeDataFolder(directory);
  std::error_code error;
  lock_.emplace(directory);
  for (const fs::directory_entry& folder : fs::directory_iterator(directory)) {
    if (folder.path().filename().string().starts_with(kDeleted)) {
      fs::remove_all(folder.path(), error);  // of a coordinator that was killed
      continue;
    }
    std::optional<CatalogueEntry> entry = ReadEntry(folder.path());
    if (!entry) continue;
    if (entry->state == CampaignState::kDamaged)
      LogError("campaign {}: {}", entry->id.substr(0, 8), entry->problem);
    if (entry->bytes == 0) entry->bytes = BytesIn(folder.path());
    next_order_ = std::max(next_order_, entry->order + 1);
    if (!HasEnded(entry->state)) open_.insert(entry->id);
    entries_[entry->id] = *std::move(entry);
  }
}

const CatalogueEntry* Catalogue::Find(const std::string& prefix) const {
  const auto found = FindById(entries_, prefix);
  return found == entries_.end() ? nullptr : &found->second;
}

std::vector<std::string> Catalogue::InOrder() const {
  // Of ten thousand, looking each up by its id would take a third of a second.
  std::vector<const CatalogueEntry*> ordered;
  for (const auto& [id, entry] : entries_) ordered.push_back(&entry);
  std::sort(ordered.begin(), ordered.end(),
            [](const CatalogueEntry* a, const CatalogueEntry* b) { return ComesBefore(*a, *b); });
  std::vector<std::string> ids;
  for (const CatalogueEntry* entry : ordered) ids.push_back(entry->id);
  return ids;
}

CatalogueEntry& Catalogue::Add(CatalogueEntry entry, const std::string& text) {
  entry.order = next_order_++;
  std::error_code error;
  fs::create_directories(directory_ / entry.id, error);
  if (error) FailFile((directory_ / entry.id).string(), "cannot be made", error.value());
  WriteFile(directory_ / entry.id / kTextFile, text);
  Write(entry);
  const std::string id = entry.id;
  return entries_[id] = std::move(entry);
}

void Catalogue::Write(const CatalogueEntry& entry) {
  ++changes_;
  if (HasEnded(entry.state))
    open_.erase(entry.id);
  else
    open_.insert(entry.id);
  Json requirements = Json::array();
  for (const RequirementOutcome& one : entry.requirements) requirements.push_back(ToJson(one));
  const Json json = {{"version", kStateVersion},
                     {"id", CampaignIdOf(entry.id)},
                     {"flight_id", entry.flight_id},
                     {"name", entry.name},
                     {"priority", entry.priority},
                     {"order", entry.order},
                     {"cases", entry.cases},
                     {"done", entry.done},
                     {"quarantined", entry.quarantined},
                     {"conflicts", entry.conflicts},
                     {"state", CampaignStateName(entry.state)},
                     {"code", entry.code},
                     {"problem", entry.problem},
                     {"seed", entry.seed},
                     {"ended_unix_s", entry.ended_unix_s},
                     {"distrusted", entry.distrusted},
                     {"owner", entry.owner},
                     {"launched_unix_s", entry.launched_unix_s},
                     {"bytes", entry.bytes},
                     {"verdict", entry.verdict},
                     {"labels", entry.labels},
                     {"design_id", entry.design_id},
                     {"engine", entry.engine},
                     {"attempts", entry.attempts},
                     {"requirements", std::move(requirements)}};
  WriteFile(directory_ / entry.id / kStateFile, Sealed(json));
}

CatalogueEntry& Catalogue::Rename(const std::string& id, const std::string& to) {
  std::error_code error;
  fs::rename(directory_ / id, directory_ / to, error);
  if (error) FailFile((directory_ / id).string(), "cannot be renamed", error.value());
  auto node = entries_.extract(id);
  node.key() = node.mapped().id = to;
  if (open_.erase(id) > 0) open_.insert(to);
  ++changes_;
  return entries_.insert(std::move(node)).position->second;
}

void Catalogue::Remove(const std::string& id) {
  // At once for whoever looks, however long the removal takes.
  const fs::path folder = directory_ / id, deleted = directory_ / (kDeleted + id);
  std::error_code error;
  fs::rename(folder, deleted, error);
  if (error) FailFile(folder.string(), "cannot be removed", error.value());
  entries_.erase(id);
  open_.erase(id);
  ++changes_;
  fs::remove_all(deleted, error);
  if (error) LogError("{}: cannot be removed: {}", deleted.string(), error.message());
}

std::string Catalogue::StateTextOf(const std::string& id) const {
  return ReadWholeFile(directory_ / id / kStateFile);
}

std::uint64_t Catalogue::CountBytes(const std::string& id) const { return BytesIn(directory_ / id); }

std::string Catalogue::TextOf(const std::string& id) const {
  return ReadWholeFile(directory_ / id / kTextFile);
}

}  // namespace dispersa
