#include "services/coordinator/front_desk.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <filesystem>
#include <span>
#include <vector>

#include "core/campaign_yaml/load.h"
#include "core/flight/engine_version.h"
#include "core/results/json_number.h"
#include "services/coordinator/dump_any_text.h"
#include "services/coordinator/outcomes.h"
#include "services/coordinator/packed_files.h"
#include "services/ledger/result_exit_code.h"
#include "services/log/log.h"
#include "services/program/exit_code.h"
#include "services/program/utc.h"
#include "services/transport/permissions.h"
#include "services/transport/validity.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxUploads = 8;
constexpr int kMaxUploadsOfOne = 4;
constexpr int kMostPriority = 1000;
constexpr double kUploadPatience_s = 60.0;
/// In an answer, so that it fits into a sample.
constexpr std::size_t kMaxListed = 500;
constexpr std::size_t kMaxStandings = 1000;
constexpr std::size_t kMaxAnswer = 512 << 10;  // bytes
constexpr std::size_t kMaxIds = 1000;
constexpr std::size_t kFilePart = 256 << 10;
constexpr char kDatabase[] = "results.sqlite";

CatalogueEntry Parse(const std::string& text, std::uint64_t max_cases) {
  const Campaign campaign = ParseCampaign(text, "campaign");
  if (campaign.sampling.cases > max_cases) {
    throw Refused(
        kExitBadInput,
        fmt::format("campaign {} has {} cases, allowed: at most {} (dispersa-coordinator --max-cases)",
                    campaign.id.substr(0, 8), campaign.sampling.cases, max_cases));
  }
  CatalogueEntry entry;
  entry.id = campaign.id;
  entry.flight_id = campaign.flight_id;
  entry.design_id = campaign.design_id;
  entry.name = campaign.name;
  entry.cases = campaign.sampling.cases;
  entry.seed = campaign.sampling.seed;
  return entry;
}

/// 0: not known.
Json UtcOrNull(std::int64_t unix_s) { return unix_s == 0 ? Json(nullptr) : Json(UtcText(unix_s)); }

/// With at most so many requirements.
Json ToJson(const CampaignView& view, std::size_t most) {
  const CatalogueEntry& entry = *view.entry;
  Json standings = Json::array();
  for (const RequirementStanding& standing :
       std::span(view.standings).first(std::min(most, view.standings.size()))) {
    standings.push_back({{"metric", standing.metric},
                         {"requirement", standing.requirement},
                         {"n", standing.n},
                         {"failures", standing.failures},
                         {"so_far", standing.so_far}});
  }
  return {{"id", entry.id},
          {"name", entry.name},
          {"engine", TextOrNull(entry.engine)},
          {"state", CampaignStateName(entry.state)},
          {"done", view.progress.done},
          {"total", view.progress.total},
          {"quarantined", view.progress.quarantined},
          {"checked", view.is_checked},
          {"rate_per_s", view.rate_per_s},
          {"eta_s", view.eta_s ? Json(*view.eta_s) : Json(nullptr)},
          {"priority", entry.priority},
          {"owner", TextOrNull(entry.owner)},
          {"labels", entry.labels},
          {"launched_utc", UtcOrNull(entry.launched_unix_s)},
          {"ended_utc", UtcOrNull(HasEnded(entry.state) ? entry.ended_unix_s : 0)},
          {"bytes", entry.bytes},
          {"verdict", TextOrNull(entry.verdict)},
          {"verdict_words", TextOrNull(VerdictWords(entry))},
          {"code", HasEnded(entry.state) ? Json(entry.code) : Json(nullptr)},
          {"problem", TextOrNull(view.problem)},
          {"requirements", std::move(standings)},
          {"requirements_unlisted", view.standings.size() - std::min(most, view.standings.size())}};
}

Refused SnapshotIsGone(const CatalogueEntry& entry) {
  return Refused(kExitIncomplete, fmt::format("the snapshot of campaign {} is gone: repeat the backup",
                                              entry.id.substr(0, 8)));
}

Refused IsDraining() {
  return Refused(kExitIncomplete,
                 "the coordinator is drained and takes no campaign, ask again when the next one has started");
}

void RequireListed(const CatalogueEntry& entry, const std::vector<fs::path>& files, const fs::path& path) {
  if (std::find(files.begin(), files.end(), path) != files.end()) return;
  throw Refused(kExitBadInput,
                "campaign " + entry.id.substr(0, 8) + " has no file " + Printable(path.string()));
}

void RefuseAnotherEngine(const std::string& asked, const CatalogueEntry& entry) {
  if (asked == entry.flight_id) return;
  throw Refused(kExitBadInput, fmt::format("campaign {} has the flight id {} here and {} at the client: the "
                                           "engines differ",
                                           entry.id.substr(0, 8), entry.flight_id, Printable(asked)));
}

bool MayChange(const Asker& asker, const CatalogueEntry& entry) {
  if (asker.right != Right::kRun) return asker.right == Right::kAdminister;
  return asker.account == entry.owner && !entry.owner.empty();
}

/// `change`: a verb.
void RequireOwner(const Asker& asker, const CatalogueEntry& entry, const char* change) {
  if (MayChange(asker, entry)) return;
  const std::string owner =
      entry.owner.empty() ? "nobody, since an earlier version launched it" : "'" + entry.owner + "'";
  throw Refused(
      kExitBadInput,
      fmt::format("campaign {} belongs to {}: the keys of '{}' may {} and cannot {} it, allowed: keys of "
                  "its owner that may run, or keys that may administer",
                  entry.id.substr(0, 8), owner, Printable(asker.account), Name(asker.right), change));
}

/// `command`: what asks so.
void RequireRight(const Asker& asker, Right least, const char* command) {
  if (asker.right >= least) return;
  throw Refused(kExitBadInput,
                fmt::format("the keys of '{0}' may {1}, and `{2}` needs the right to {3}, allowed: keys that "
                            "`dispersa keys issue --may {3}` made",
                            Printable(asker.account), Name(asker.right), command, Name(least)));
}

/// A name of keys or of a local user.
bool IsOwner(const std::string& text) {
  return !text.empty() && text.size() <= 64 && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.';
  });
}

constexpr char kLabelRule[] =
    "KEY=VALUE, KEY of 1 to 32 letters, digits, '-' and '_', VALUE of 1 to 100 printable ASCII characters";

bool IsLabel(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals > 32) return false;
  const std::string value = text.substr(equals + 1);
  return std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(equals),
                     [](char c) {
                       return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                              c == '-' || c == '_';
                     }) &&
         !value.empty() && value.size() <= 100 && Printable(value) == value;
}

}  // namespace

FrontDesk::FrontDesk(Service& service, const Workforce& workforce, std::string everybody, WebPages pages,
                     std::string own_keys)
    : service_(service),
      workforce_(workforce),
      everybody_(std::move(everybody)),
      pages_(std::move(pages)),
      own_keys_(std::move(own_keys)) {
  for (const auto& [id, entry] : service.catalogue().entries())
    RemoveDatabaseCopies(service.catalogue().ResultsOf(id));
}

const FrontDesk::Method& FrontDesk::MethodOf(const std::string& name) {
  static constexpr char kBackup[] = "dispersa backup", kLaunch[] = "dispersa launch";
  using enum Right;
  static constexpr Method kMethods[] = {
      {"health", kRead, "", {}, &FrontDesk::Live},
      {"upload", kRun, kLaunch, {}, &FrontDesk::TakePart},
      {"launch", kRun, kLaunch, {.is_noted = true, .begins_flights = true}, &FrontDesk::Launch},
      {"cancel", kRead, "", {.is_noted = true}, &FrontDesk::Cancel},
      {"give", kAdminister, "dispersa give", {.is_noted = true}, &FrontDesk::Give},
      {"repair", kRead, "", {.is_noted = true, .begins_flights = true}, &FrontDesk::Repair},
      {"drain", kAdminister, "dispersa-coordinator --drain", {.is_for_itself = true}, &FrontDesk::Drain},
      {"readmit", kAdminister, "dispersa readmit", {.is_noted = true}, &FrontDesk::Readmit},
      {"expelled", kRead, "", {}, &FrontDesk::Expelled},
      {"delete", kRead, "", {.is_noted = true}, &FrontDesk::Delete},
      // A copy of all that the coordinator has.
      {"ids", kAdminister, kBackup, {}, &FrontDesk::Ids},
      {"list", kRead, "", {}, &FrontDesk::List},
      {"status", kRead, "", {}, &FrontDesk::Status},
      {"files", kRead, kBackup, {.is_for_backups = true}, &FrontDesk::Files},
      {"read", kRead, kBackup, {.is_for_backups = true}, &FrontDesk::Read},
  };
  for (const Method& method : kMethods)
    if (method.name == name) return method;
  throw Refused(kExitBadInput, "the coordinator does not know the request '" + Printable(name) + "'");
}

Reply FrontDesk::Answer(const Request& request) {
  Reply reply;
  reply.client = request.client;
  reply.number = request.number;
  const LogAbout about("", fmt::format("{} {} of {}", request.method, request.number, request.client));
  ForgetUploads();
  copies_.ForgetUnused(workforce_.now_s());
  try {
    const Method& method = MethodOf(request.method);
    const Json arguments = request.arguments.empty() ? Json::object() : Json::parse(request.arguments);
    const Call call{AskerOf(request.client), arguments, request.data, reply.data};
    const bool is_own = !own_keys_.empty() && request.client.starts_with(OwnPrefix(own_keys_));
    if (!is_own || !method.how.is_for_itself) RequireRight(call.asker, method.right, method.command);
    if (method.how.is_for_backups &&
        (call.arguments.at("id") == "" || call.arguments.value("snapshot", "") != ""))
      RequireRight(call.asker, Right::kAdminister, method.command);
    if (service_.is_draining() && method.how.begins_flights) throw IsDraining();
    if (method.how.is_noted) service_.actions().RequireWritten();
    reply.text = (this->*method.answer)(call);
  } catch (const Refused& refused) {
    reply.code = refused.code;
    reply.text = refused.what();
  } catch (const InputError& error) {
    reply.code = kExitBadInput;
    reply.text = error.what();
  } catch (const Json::exception&) {
    reply.code = kExitBadInput;
    reply.text = "the coordinator does not understand the arguments of '" + Printable(request.method) + "'";
  } catch (const ResultError& error) {
    reply.code = ExitCodeOf(error);
    reply.text = error.what();
  } catch (const std::exception& error) {
    reply.code = kExitInternalError;
    reply.text = std::string("the coordinator cannot do that: ") + error.what();
  }
  return reply;
}

void FrontDesk::ForgetUploads() {
  std::erase_if(uploads_, [now_s = workforce_.now_s()](const auto& upload) {
    return now_s - upload.second.used_s > kUploadPatience_s;
  });
}

std::string FrontDesk::Live(const Call&) { return "{}"; }

std::string FrontDesk::TakePart(const Call& call) {
  const Json& json = call.arguments;
  const std::string& data = call.data;
  const std::string id = json.at("id");
  const std::uint64_t size = json.at("size"), offset = json.at("offset");
  if (size > kMaxTextBytes) throw Refused(kExitBadInput, "the campaign's text is larger than 64 MiB");
  if (!uploads_.contains(id) && uploads_.size() >= kMaxUploads) {
    throw Refused(kExitIncomplete,
                  "the coordinator takes " + std::to_string(kMaxUploads) + " texts at a time already");
  }
  const std::string owner = AccountOf(call.asker.client);
  const auto taken = std::count_if(uploads_.begin(), uploads_.end(),
                                   [&](const auto& each) { return each.second.owner == owner; });
  if (!uploads_.contains(id) && taken >= kMaxUploadsOfOne) {
    throw Refused(kExitIncomplete,
                  "this client sends " + std::to_string(kMaxUploadsOfOne) + " texts at a time already");
  }
  Upload& upload = uploads_[id];
  upload.owner = owner;
  upload.used_s = workforce_.now_s();
  if (upload.size != size && !upload.parsed.valid()) {
    upload.text.clear();
    upload.size = size;
  }
  if (offset == upload.text.size() && data.size() <= upload.size - offset) upload.text += data;
  return Json{{"received", upload.text.size()}}.dump();
}

Asker FrontDesk::AskerOf(const std::string& client) const {
  if (!everybody_.empty()) return {everybody_, client, Right::kAdminister};
  return {AccountOf(client), client, RightOf(client)};
}

// A campaign that is not known is "unknown" until its text is here, and "checked" while it is parsed, which
// takes seconds when it is large.
std::string FrontDesk::Launch(const Call& call) {
  const Asker& asker = call.asker;
  const Json& json = call.arguments;
  const std::string id = json.at("id"), flight_id = json.at("flight_id");
  const auto priority =
      json.contains("priority") ? std::optional(json.at("priority").get<int>()) : std::nullopt;
  if (priority && (*priority < -kMostPriority || *priority > kMostPriority)) {
    throw Refused(kExitBadInput, fmt::format("priority {}, allowed: from {} to {}", *priority, -kMostPriority,
                                             kMostPriority));
  }
  const auto labels = json.value("labels", std::vector<std::string>());
  for (const std::string& label : labels) {
    if (!IsLabel(label))
      throw Refused(kExitBadInput, "'" + Printable(label) + "' is no label, allowed: " + kLabelRule);
  }
  const auto& known = service_.catalogue().entries();
  // One that another engine flew is looked at like a new one: only its text tells its flight id here.
  if (const auto entry = known.find(id); entry != known.end()) {
    RequireSound(entry->second);
    const bool is_ours = entry->second.engine == EngineVersion();
    if (is_ours) RefuseAnotherEngine(flight_id, entry->second);
    if (!is_ours && entry->second.flight_id == flight_id && !entry->second.engine.empty()) {
      throw Refused(kExitBadInput,
                    fmt::format("campaign {} was flown by engine {}, that of the client, and this "
                                "coordinator has engine {}: the engines differ",
                                id.substr(0, 8), entry->second.engine, EngineVersion()));
    }
    if (is_ours || entry->second.flight_id == flight_id) {
      uploads_.erase(id);
      return LaunchAgain(asker, entry->second, priority, labels);
    }
  }
  const auto answer = [&](const char* state) { return Json{{"id", id}, {"state", state}}.dump(); };
  const auto found = uploads_.find(id);
  if (found == uploads_.end() || found->second.text.size() != found->second.size) return answer("unknown");
  Upload& upload = found->second;
  upload.used_s = workforce_.now_s();
  if (!upload.parsed.valid())
    upload.parsed = std::async(std::launch::async, Parse, upload.text, service_.max_cases());
  if (upload.parsed.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready)
    return answer("checked");
  Upload complete = std::move(upload);
  uploads_.erase(found);
  CatalogueEntry entry = complete.parsed.get();
  if (entry.id != id) throw Refused(kExitBadInput, "the text is not that of campaign " + Printable(id));
  RefuseAnotherEngine(flight_id, entry);
  if (known.contains(id)) {
    copies_.Forget(service_.catalogue().ResultsOf(id));
    service_.MakeRoomForEngine(id, flight_id);
    if (known.contains(id)) return LaunchAgain(asker, known.at(id), priority, labels);
  }
  entry.priority = priority.value_or(0);
  entry.owner = asker.account;
  AddLabels(&entry, labels);
  service_.Launch(std::move(entry), complete.text);
  Note("launch", asker, service_.catalogue().entries().at(id));
  return answer("waiting");
}

// Of another owner nothing changes: it is the same campaign, and its results are there for all.
std::string FrontDesk::LaunchAgain(const Asker& asker, const CatalogueEntry& entry,
                                   std::optional<int> priority, const std::vector<std::string>& labels) {
  const std::string id = entry.id;
  if (priority && *priority != entry.priority) RequireOwner(asker, entry, "change the priority of");
  if (entry.state == CampaignState::kCancelled || entry.state == CampaignState::kFailed ||
      entry.state == CampaignState::kRefused)
    RequireOwner(asker, entry, "continue");
  for (const std::string& label : labels) {
    if (std::find(entry.labels.begin(), entry.labels.end(), label) == entry.labels.end())
      RequireOwner(asker, entry, "label");
  }
  if (MayChange(asker, entry)) {
    const CatalogueEntry before = entry;
    copies_.Forget(service_.catalogue().ResultsOf(id));
    service_.Relaunch(id, priority.value_or(entry.priority), labels);
    if (entry != before) Note("launch", asker, entry);
  }
  return Json{{"id", id}, {"state", CampaignStateName(service_.catalogue().entries().at(id).state)}}.dump();
}

std::string FrontDesk::Cancel(const Call& call) {
  const CatalogueEntry& entry = Named(call.arguments.at("id"));
  RequireOwner(call.asker, entry, "cancel");
  const bool is_new = entry.state != CampaignState::kCancelled;
  service_.Cancel(entry.id);
  if (is_new) Note("cancel", call.asker, entry);
  return Json{{"id", entry.id}}.dump();
}

std::string FrontDesk::Give(const Call& call) {
  const Asker& asker = call.asker;
  const Json& json = call.arguments;
  const CatalogueEntry& entry = Named(json.at("id"));
  const std::string to = json.at("to");
  if (!IsOwner(to)) {
    throw Refused(kExitBadInput, "'" + Printable(to) +
                                     "' cannot own a campaign, allowed: a name of keys or of a local user, 1 "
                                     "to 64 letters, digits, '-', '_' and '.'");
  }
  if (entry.owner == to) return Json{{"id", entry.id}}.dump();
  service_.Give(entry.id, to);
  Action more;
  more.to = to;
  Note("give", asker, entry, more);
  return Json{{"id", entry.id}}.dump();
}

void FrontDesk::Note(const char* what, const Asker& asker, const CatalogueEntry& entry, Action more) {
  more.what = what;
  more.by = asker.account;
  more.client = asker.client;
  more.campaign = entry.id;
  more.name = entry.name;
  service_.actions().Note(more);
}

std::string FrontDesk::Repair(const Call& call) {
  const Asker& asker = call.asker;
  const Json& json = call.arguments;
  const CatalogueEntry& entry = Named(json.at("id"));
  const std::string id = entry.id, worker = json.at("worker");
  if (worker.empty() || worker.size() > 64)
    throw Refused(kExitBadInput, "a worker's name has 1 to 64 characters");
  RequireOwner(asker, entry, "repair");
  copies_.Forget(service_.catalogue().ResultsOf(id));
  service_.Repair(id, worker);
  Action more;
  more.worker = worker;
  Note("repair", asker, entry, more);
  return Json{{"id", id}}.dump();
}

// A client that waits for the end must not drain the coordinator that comes after: it names the one that it
// means.
std::string FrontDesk::Drain(const Call& call) {
  if (call.arguments.value("epoch", service_.epoch()) == service_.epoch()) service_.Drain();
  std::uint64_t waiting = 0, busy = 0;
  for (const std::string& id : service_.catalogue().open())
    ++(service_.catalogue().entries().at(id).state == CampaignState::kWaiting ? waiting : busy);
  return Json{{"epoch", service_.epoch()}, {"busy", busy}, {"waiting", waiting}}.dump();
}

std::string FrontDesk::Readmit(const Call& call) {
  const std::string name = call.arguments.at("name");
  if (!service_.Readmit(name).empty()) {
    readmitted_.insert(name);
    Action action;
    action.worker = name;
    Note("readmit", call.asker, {}, action);
  } else if (!readmitted_.contains(name)) {
    throw Refused(kExitBadInput, "nobody with the name '" + Printable(name) +
                                     "' is expelled, allowed: names that `dispersa "
                                     "readmit` without a name prints");
  }
  return Json{{"name", name}}.dump();
}

std::string FrontDesk::Expelled(const Call&) {
  Json expelled = Json::array();
  std::size_t unlisted = 0;
  for (const auto& [name, expulsion] : workforce_.expelled()) {
    if (expulsion.is_forgiven) continue;
    if (expelled.size() >= kMaxListed) {
      ++unlisted;
    } else {
      expelled.push_back({{"name", Printable(name)}, {"reason", expulsion.reason}});
    }
  }
  return DumpAnyText({{"expelled", std::move(expelled)}, {"unlisted", unlisted}});
}

std::string FrontDesk::Delete(const Call& call) {
  const std::string wanted = call.arguments.at("id");
  if (!service_.catalogue().entries().contains(wanted) && wanted.size() >= 64 && deleted_.contains(wanted))
    return Json{{"id", wanted}}.dump();
  const CatalogueEntry entry = Named(wanted);
  const std::string id = entry.id;
  RequireOwner(call.asker, entry, "delete");
  copies_.Forget(service_.catalogue().ResultsOf(id));
  service_.Delete(id);
  deleted_.insert(id);
  Note("delete", call.asker, entry);
  return Json{{"id", id}}.dump();
}

std::string FrontDesk::List(const Call& call) {
  const std::string wanted = call.arguments.value("id", "");
  // Whatever some of them have as requirements and names, the answer fits: fewer are shown, and how many are
  // not.
  for (std::size_t most = kMaxListed, standings = kMaxStandings;; most = (most + 1) / 2, standings /= 2) {
    const std::vector<std::string> ids = wanted.empty() ? Listed(most) : std::vector{Named(wanted).id};
    Json campaigns = Json::array();
    for (const std::string& id : ids)
      campaigns.push_back(ToJson(service_.View(id), standings / std::max(ids.size(), std::size_t{1})));
    const std::size_t unlisted = wanted.empty() ? service_.catalogue().entries().size() - ids.size() : 0;
    std::string text = DumpAnyText(
        {{"schema", "dispersa/list/1"}, {"campaigns", std::move(campaigns)}, {"unlisted", unlisted}});
    if (text.size() <= kMaxAnswer || standings == 0) return text;
  }
}

// All of them, page by page, in the order of their ids: those behind `after`.
std::string FrontDesk::Ids(const Call& call) {
  const auto& entries = service_.catalogue().entries();
  auto next = entries.upper_bound(call.arguments.value("after", ""));
  Json ids = Json::array();
  for (; next != entries.end() && ids.size() < kMaxIds; ++next) ids.push_back(next->first);
  return Json{{"ids", std::move(ids)}, {"more", next != entries.end()}}.dump();
}

// As many as fit into an answer; rather those that have not ended.
std::vector<std::string> FrontDesk::Listed(std::size_t most) const {
  std::vector<std::string> ids = service_.catalogue().InOrder();
  std::size_t surplus = ids.size() - std::min(ids.size(), most);
  std::erase_if(ids, [&](const std::string& id) {
    return surplus > 0 && HasEnded(service_.catalogue().entries().at(id).state) && surplus-- > 0;
  });
  ids.resize(std::min(ids.size(), most));
  return ids;
}

std::string FrontDesk::Status(const Call& call) {
  Json answer = Json::parse(List(call));
  answer["schema"] = "dispersa/status/1";
  Json workers = Json::array();
  for (const Dispatcher::WorkerView& worker : workforce_.Workers()) {
    workers.push_back({{"id", worker.worker},
                       {"host", Printable(worker.host)},
                       {"slots", worker.slots},
                       {"state", WorkerStateName(worker.state)},
                       {"flown", worker.flown}});
  }
  answer["workers"] = std::move(workers);
  answer["web"] = pages_.address.empty()
                      ? Json(nullptr)
                      : Json{{"address", pages_.address}, {"behind_tls", pages_.behind_tls}};
  return answer.dump();
}

// "copying" until the database can be handed out as a whole.
std::string FrontDesk::Files(const Call& call) {
  const Json& json = call.arguments;
  const std::string snapshot = json.value("snapshot", ""), id = json.at("id");
  if (id.empty()) return Journals();
  const CatalogueEntry& entry = Named(id);
  if (!snapshot.empty()) return Snapshot(entry, snapshot);
  RequireSound(entry);
  if (!service_.IsAtRest(entry.id)) {
    throw Refused(kExitIncomplete,
                  fmt::format("campaign {} is {}: its results can be fetched when it has ended",
                              entry.id.substr(0, 8), CampaignStateName(entry.state)));
  }
  const fs::path directory = service_.catalogue().ResultsOf(entry.id);
  const auto database = copies_.Whole(directory, entry.done, workforce_.now_s());
  if (!database) return Json{{"id", entry.id}, {"state", "copying"}}.dump();
  Json files = Json::array();
  for (const fs::path& file : FilesIn(directory)) {
    const fs::path source = file == kDatabase ? *database : directory / file;
    files.push_back({{"path", file.generic_string()}, {"size", SizeOf(source)}});
  }
  return Json{{"id", entry.id}, {"code", entry.code}, {"done", entry.done}, {"files", std::move(files)}}
      .dump();
}

// What a data directory has besides its campaigns.
std::string FrontDesk::Journals() const {
  Json files = Json::array();
  for (const fs::path& file : service_.Journals())
    files.push_back({{"path", file.filename().generic_string()}, {"size", fs::file_size(file)}});
  return Json{{"id", ""}, {"files", std::move(files)}}.dump();
}

// For a backup, whatever the campaign does now. State and list of files are those of the moment before the
// database is copied: so the copy has every case that the state promises. Reports of a campaign that has not
// ended are written again.
std::string FrontDesk::Snapshot(const CatalogueEntry& entry, const std::string& name) {
  const fs::path directory = service_.catalogue().ResultsOf(entry.id);
  CampaignSnapshot& snapshot = snapshots_[entry.id];
  if (snapshot.name != name) {
    const bool is_damaged = entry.state == CampaignState::kDamaged;  // and is so in the copy
    snapshot = {name, is_damaged ? "" : service_.catalogue().StateTextOf(entry.id), {}};
    if (service_.IsAtRest(entry.id)) {
      snapshot.files = StoredFilesIn(directory);
    } else if (fs::exists(directory / kDatabase)) {
      snapshot.files = {"campaign.yaml", kDatabase};
    }
  }
  Json files = Json::array();
  for (const fs::path& file : snapshot.files) {
    fs::path source = directory / file;
    if (file == kDatabase) {
      const auto database = copies_.Snapshot(directory, name, workforce_.now_s());
      if (!database) return Json{{"id", entry.id}, {"state", "copying"}}.dump();
      source = *database;
    }
    files.push_back({{"path", file.generic_string()}, {"size", fs::file_size(source)}});
  }
  return Json{{"id", entry.id},
              {"state_json", snapshot.state_json},
              {"text_size", fs::file_size(directory.parent_path() / "campaign.yaml")},
              {"files", std::move(files)}}
      .dump();
}

// Where a file of a snapshot lies; `path` is relative to the result folder.
fs::path FrontDesk::FindInSnapshot(const CatalogueEntry& entry, const std::string& name,
                                   const fs::path& path) {
  const auto found = snapshots_.find(entry.id);
  if (found == snapshots_.end() || found->second.name != name) throw SnapshotIsGone(entry);
  const fs::path directory = service_.catalogue().ResultsOf(entry.id);
  if (path == "../campaign.yaml") return directory.parent_path() / "campaign.yaml";
  RequireListed(entry, found->second.files, path);
  if (path != kDatabase) return directory / path;
  if (const auto database = copies_.KnownSnapshot(directory, name, workforce_.now_s())) return *database;
  throw SnapshotIsGone(entry);
}

fs::path FrontDesk::FindInResults(const CatalogueEntry& entry, const fs::path& path) {
  const fs::path directory = service_.catalogue().ResultsOf(entry.id);
  RequireListed(entry, service_.IsAtRest(entry.id) ? FilesIn(directory) : std::vector<fs::path>(), path);
  return path == kDatabase ? copies_.Known(directory, workforce_.now_s()) : directory / path;
}

std::string FrontDesk::Read(const Call& call) {
  const Json& json = call.arguments;
  const fs::path path = json.at("path").get<std::string>();
  const std::uint64_t offset = json.at("offset");
  const std::string snapshot = json.value("snapshot", ""), id = json.at("id");
  const fs::path source = id.empty()         ? service_.JournalAt(path)
                          : snapshot.empty() ? FindInResults(Named(id), path)
                                             : FindInSnapshot(Named(id), snapshot, path);
  call.answered = ReadPart(source, offset, kFilePart);
  return "{}";
}

const CatalogueEntry& FrontDesk::Named(const std::string& id) const {
  if (const CatalogueEntry* entry = service_.catalogue().Find(id)) return *entry;
  throw Refused(kExitBadInput, "no campaign, or more than one, has the id '" + Printable(id) + "'");
}

}  // namespace dispersa
