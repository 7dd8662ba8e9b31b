#include "services/coordinator/service.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <new>
#include <nlohmann/json.hpp>
#include <set>

#include "core/campaign_yaml/load.h"
#include "core/campaign_yaml/sha256.h"
#include "core/cases/plugin_check.h"
#include "core/flight/engine_version.h"
#include "core/input/printable.h"
#include "core/pages/reports.h"
#include "core/results/folder_state.h"
#include "core/results/output_file.h"
#include "services/coordinator/dump_any_text.h"
#include "services/coordinator/epoch.h"
#include "services/coordinator/health.h"
#include "services/coordinator/outcomes.h"
#include "services/coordinator/packed_files.h"
#include "services/coordinator/queue.h"
#include "services/ledger/campaign_attempt.h"
#include "services/ledger/open_book.h"
#include "services/ledger/result_exit_code.h"
#include "services/log/log.h"
#include "services/program/exit_code.h"

namespace dispersa {
namespace {

constexpr double kMeasure_s = 1.0;
constexpr std::size_t kMaxProblem = 1000;
constexpr std::size_t kRemembered = 16;  // tallies of campaigns that fly no more

constexpr double kRetention_s = 60.0;  // what is old is looked for so often
constexpr char kDeletedFile[] = "deleted.jsonl";
constexpr char kExpelledRule[] = "the file of a backup; or none, which readmits everybody";
constexpr char kActionsFile[] = "actions.jsonl";
constexpr double kCount_s = 10.0;  // the bytes of what flies are counted so often
constexpr double kDelay_s = 10.0;  // until a full disk is tried again

struct Stopped {};

/// Of a campaign as this engine flew it, when another one flies it now.
std::string BesideName(const std::string& id, const std::string& engine) {
  return CampaignIdOf(id) + "-" + engine.substr(engine.find('+') + 1);
}

// Reports that are not compressed can be read too.
void TryToPack(const std::filesystem::path& results) {
  try {
    PackReports(results);
  } catch (const std::exception& error) {
    LogWarning("{}: its reports are not compressed: {}", results.string(), error.what());
  }
}

// They are of results that are removed, and may have more cases than are left.
void TryToRemoveReports(const std::filesystem::path& results) {
  try {
    RemoveReports(results);
  } catch (const ResultError& error) {
    LogWarning("a report of results that are removed: {}", error.what());
  }
}

std::string Gigabytes(std::uint64_t bytes) {
  return fmt::format("{:.3g} GB", static_cast<double>(bytes) / 1e9);
}

std::string OwnerOf(const CatalogueEntry& entry) { return entry.owner.empty() ? "nobody" : entry.owner; }

std::string Waiting(const std::string& problem) { return problem + "; it continues by itself"; }

template <typename T>
bool IsReady(const std::future<T>& future) {
  return future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

bool IsOfAnotherEngine(const CatalogueEntry& entry) {
  return !entry.engine.empty() && entry.engine != EngineVersion();
}

bool IsContinuedByLaunch(const CatalogueEntry& entry) {
  return entry.state == CampaignState::kCancelled || entry.state == CampaignState::kFailed ||
         entry.state == CampaignState::kRefused ||
         (entry.state == CampaignState::kDone && entry.quarantined > 0);
}

void RequireSound(const CatalogueEntry& entry) {
  if (entry.state != CampaignState::kDamaged) return;
  throw Refused(kExitInternalError, fmt::format("campaign {}: {}", entry.id.substr(0, 8), entry.problem));
}

Service::Service(const ServiceOptions& options, Workforce& workforce)
    : options_(options),
      workforce_(workforce),
      catalogue_(options.data),
      actions_(options.data / kActionsFile) {
  std::size_t open = 0;
  for (const auto& [id, entry] : catalogue_.entries()) open += !HasEnded(entry.state);
  LogInfo("{}: {} campaigns, {} of them have not ended", options.data.string(), catalogue_.entries().size(),
          open);
  LoadExpelled();
  for (const auto& [id, entry] : catalogue_.entries()) SettleEngine(catalogue_.At(id));
}

// Its stored results decide, and not what its state says. Whatever happens here can be undone by the engine
// that flew it: it finds the same results.
void Service::SettleEngine(CatalogueEntry& entry) {
  if (entry.state == CampaignState::kDamaged) return;
  const bool is_settled = entry.state == CampaignState::kDone || !IsOfAnotherEngine(entry);
  if (HasEnded(entry.state) && entry.state != CampaignState::kUnfinished && !entry.engine.empty() &&
      is_settled)
    return;
  const CatalogueEntry before = entry;
  try {
    const std::filesystem::path results = catalogue_.ResultsOf(entry.id);
    const FolderState state =
        std::filesystem::exists(results / "results.sqlite") ? ReadFolderState(results) : FolderState();
    entry.engine = state.cases + state.quarantined > 0 ? state.engine : "";
    if (!entry.engine.empty()) {
      entry.flight_id = state.flight_id;
      entry.done = state.cases;
      entry.quarantined = state.quarantined;
    }
  } catch (const std::exception&) {
    return;  // opening it says what is wrong with its folder
  }
  if (entry.state == CampaignState::kUnfinished && !IsOfAnotherEngine(entry)) QueueAgain(&entry);
  if (!HasEnded(entry.state) && IsOfAnotherEngine(entry)) {
    if (entry.done + entry.quarantined >= entry.cases) {
      entry.state = CampaignState::kReporting;
      to_report_.push_back({entry.id, workforce_.now_s()});
    } else {
      return End(
          entry, CampaignState::kUnfinished, kExitIncomplete,
          fmt::format("{} of {} cases are stored, flown by engine {}, and this coordinator has engine {}: "
                      "start that one again to go on, or launch the campaign again to fly all cases anew",
                      entry.done, entry.cases, entry.engine, EngineVersion()));
    }
  }
  if (!(entry == before)) Save(entry);
}

Service::~Service() {
  stop_report_ = true;
  for (const Reporting& report : reporting_) report.reported.wait();
  for (auto& [id, flying] : flying_) workforce_.EndCampaign(flying.book->campaign().result_id());
}

void Service::Step() {
  CloseBroken();
  CloseRefused();
  CloseComplete();
  FinishReports();
  StartReports();
  FinishOpening();
  StartOpening();
  Measure();
  DeleteOld();
}

void Service::Flush() {
  for (auto& [id, flying] : flying_) flying.book->TryFlush();
  SaveAgain();
}

// Nothing of it can be stored any more: its folder is gone, not writable, or damaged.
void Service::CloseBroken() {
  std::vector<std::string> broken;
  for (const auto& [id, flying] : flying_) {
    if (!flying.book->breakdown().empty()) broken.push_back(id);
  }
  for (const std::string& id : broken) {
    const Book book = TakeBack(id);
    End(catalogue_.At(id), CampaignState::kFailed, kExitInternalError, book->breakdown());
  }
}

// Its control law is not fit to fly: its results differ, or no worker's check lets it fly. Results stay where
// they are, without a report.
void Service::CloseRefused() {
  std::map<std::string, std::string> refused;  // reason by id
  for (const auto& [id, flying] : flying_) {
    if (flying.book->refusal()) {
      refused[id] = *flying.book->refusal();
    } else if (const auto reason = workforce_.RefusalByAll(flying.book->campaign().result_id());
               reason && IsOfTheLaw(*reason)) {
      refused[id] = *reason;
    }
  }
  for (const auto& [id, reason] : refused) {
    const Book book = TakeBack(id);
    End(catalogue_.At(id), CampaignState::kRefused, kExitBadInput, reason);
  }
}

void Service::CloseComplete() {
  std::vector<std::string> complete;
  for (auto& [id, flying] : flying_) {
    flying.book->Guard([&id = id, &book = *flying.book, &complete] {
      if (book.Complete() && book.TryFlush()) complete.push_back(id);
    });
  }
  for (const std::string& id : complete) {
    const LogAbout about(id);
    if (const CampaignBook& book = *flying_.at(id).book; book.IsAudited()) {
      LogInfo("campaign {} ({}): {} results were flown again and agree", book.campaign().name,
              id.substr(0, 8), book.confirmed());
    }
    // Its files are closed until its report is written: hundreds may wait for that.
    const Book book = TakeBack(id);
    to_report_.push_back({id, workforce_.now_s()});
    CatalogueEntry& entry = catalogue_.At(id);
    entry.cases = book->ledger().Progress().total;
    entry.state = CampaignState::kReporting;
    Save(entry);
  }
}

void Service::StartReports() {
  while (reporting_.size() < options_.reports_at_once && StartReport()) {
  }
}

bool Service::StartReport() {
  const auto next = std::find_if(to_report_.begin(), to_report_.end(),
                                 [this](const Complete& complete) { return !IsDelayed(complete.id); });
  if (next == to_report_.end()) return false;
  const std::string id = next->id;
  to_report_.erase(next);
  CatalogueEntry& entry = catalogue_.At(id);
  try {
    auto reported =
        std::async(std::launch::async, [this, text = SoundTextOf(id), name = entry.name,
                                        results = catalogue_.ResultsOf(id), root = options_.data, id] {
          const LogAbout about(id);
          ReportOptions options;
          options.threads = options_.report_threads;
          options.progress = [this](const std::string&, std::uint64_t, std::uint64_t) {
            if (stop_report_) throw Stopped();  // the next coordinator writes it
          };
          ResultFolder folder = ResultFolder::Open(results);
          folder.Lock();
          Campaign campaign = ParseCampaign(text, name);
          campaign.flight_id = folder.Provenance("flight_id");  // of the engine that flew it
          const CampaignSummary summary = WriteReports(folder, campaign, options);
          NoteEndedIn(root, folder, campaign, summary);
          TryToPack(results);
          return Reported{summary.standing.verdict, summary.engine,
                          static_cast<std::int64_t>(summary.standing.attempts.size()), OutcomesOf(summary),
                          summary.nominal ? NominalLoss(*summary.nominal) : std::string()};
        });
    reporting_.push_back({id, std::move(reported)});
  } catch (...) {
    Fail(entry, std::current_exception());
  }
  return true;
}

void Service::FinishReports() {
  const auto written =
      std::stable_partition(reporting_.begin(), reporting_.end(),
                            [](const Reporting& report) { return !IsReady(report.reported); });
  std::vector<Reporting> ready(std::make_move_iterator(written), std::make_move_iterator(reporting_.end()));
  reporting_.erase(written, reporting_.end());
  for (Reporting& reporting : ready) {
    CatalogueEntry& entry = catalogue_.At(reporting.id);
    try {
      Reported reported = reporting.reported.get();
      entry.verdict = StandingVerdictName(reported.verdict);
      entry.engine = std::move(reported.engine);
      entry.attempts = reported.attempts;
      entry.requirements = std::move(reported.requirements);
      End(entry, CampaignState::kDone, CampaignExitCode(reported.verdict, entry.conflicts),
          reported.nominal_loss);
    } catch (...) {
      Fail(entry, std::current_exception());
    }
  }
}

double Service::report_wait_s() const {
  return to_report_.empty() ? 0.0 : workforce_.now_s() - to_report_.front().since_s;
}

std::optional<std::uint64_t> Service::free_bytes() const {
  std::error_code error;
  const auto space = std::filesystem::space(options_.data, error);
  return error ? std::nullopt : std::optional<std::uint64_t>(space.available);
}

std::string Service::WhyPaused() const {
  for (const auto& [id, flying] : flying_)
    if (!flying.book->pause().empty()) return flying.book->pause();
  return delayed_.empty() ? actions_.problem() : delayed_.begin()->second.problem;
}

// One that flies goes back into the queue if this one has a higher priority.
bool Service::MakeRoomFor(const CatalogueEntry& entry) {
  if (flying_.size() < options_.flying_at_once) return true;
  std::vector<const CatalogueEntry*> flying;
  for (const auto& [id, each] : flying_) flying.push_back(&catalogue_.At(id));
  const CatalogueEntry* last = WhoGivesWayTo(entry, flying);
  if (last == nullptr || !flying_.at(last->id).book->TryFlush()) return false;
  CatalogueEntry& lowest = catalogue_.At(last->id);
  const LogAbout about(lowest.id);
  TakeBack(lowest.id);
  lowest.state = CampaignState::kWaiting;
  Save(lowest);
  LogInfo("campaign {} ({}) waits for one of a higher priority", lowest.name, lowest.id.substr(0, 8));
  return true;
}

void Service::StartOpening() {
  if (opening_ || is_draining_) return;
  std::vector<const CatalogueEntry*> open;
  for (const std::string& id : catalogue_.open()) open.push_back(&catalogue_.At(id));
  const CatalogueEntry* entry =
      NextOf(open, options_.quotas, [this](const std::string& id) { return IsDelayed(id); });
  if (entry == nullptr || !MakeRoomFor(*entry)) return;
  const std::string id = entry->id;
  try {
    BeginToOpen(*entry);
  } catch (...) {
    opening_.reset();
    Fail(catalogue_.At(id), std::current_exception());
  }
}

void Service::BeginToOpen(const CatalogueEntry& entry) {
  BookRequest opening{SoundTextOf(entry.id), entry.name, catalogue_.ResultsOf(entry.id),
                      options_.data,         {},         ++opened_,
                      workforce_.audit()};
  for (const auto& [id, other] : catalogue_.entries()) {
    if (id != entry.id && other.flight_id == entry.flight_id)
      opening.same_flights.push_back(catalogue_.ResultsOf(id));
  }
  opening.distrusted = entry.distrusted;
  for (const auto& [name, reason] : workforce_.expelled()) opening.distrusted.push_back(name);
  opening_.emplace();
  opening_->id = entry.id;
  opening_->book =
      std::async(std::launch::async, [opening = std::move(opening)] { return OpenBook(opening); });
}

void Service::FinishOpening() {
  if (!opening_ || !IsReady(opening_->book)) return;
  Opening opened = *std::move(opening_);
  const LogAbout about(opened.id);
  opening_.reset();
  CatalogueEntry& entry = catalogue_.At(opened.id);
  try {
    Book book = opened.book.get();
    if (entry.state != CampaignState::kWaiting) return;  // cancelled meanwhile
    delayed_.erase(opened.id);
    entry.flight_id = book->campaign().flight_id;
    entry.engine = EngineVersion();  // no engine before this one has flown a case of it
    workforce_.BeginCampaign(*book, entry.priority);
    LogInfo("campaign {} ({}) flies: {} of {} cases have a result", entry.name, opened.id.substr(0, 8),
            book->ledger().Progress().done, book->ledger().Progress().total);
    flying_[opened.id].book = std::move(book);
    entry.state = CampaignState::kFlying;
    entry.distrusted.clear();
    Save(entry);
  } catch (...) {
    if (entry.state == CampaignState::kWaiting) Fail(entry, std::current_exception());
  }
}

// Whoever changed it has another campaign, and its verdict must not stand under this id.
std::string Service::SoundTextOf(const std::string& id) const {
  std::string text = catalogue_.TextOf(id);
  if (Sha256Hex(text) != CampaignIdOf(id))
    throw ResultError(ResultError::Kind::kFile, "its campaign.yaml is not as it was launched");
  return text;
}

// Whatever it is: of this campaign alone. A full disk, and too many open files, are waited for.
void Service::Fail(CatalogueEntry& entry, std::exception_ptr error) {
  const LogAbout about(entry.id);
  // Whatever it is then, it comes of that.
  if (const std::string short_of = WhyDescriptorsAreShort(); !short_of.empty()) return Delay(entry, short_of);
  try {
    std::rethrow_exception(error);
  } catch (const ResultError& problem) {
    if (problem.kind() == ResultError::Kind::kDiskFull) {
      Delay(entry, problem.what());
    } else {
      End(entry, CampaignState::kFailed, ExitCodeOf(problem), problem.what());
    }
  } catch (const InputError& problem) {
    End(entry, CampaignState::kFailed, kExitBadInput, problem.what());
  } catch (const std::bad_alloc&) {
    End(entry, CampaignState::kFailed, kExitInternalError,
        fmt::format("the coordinator has not enough memory for its {} cases", entry.cases));
  } catch (const std::exception& problem) {
    End(entry, CampaignState::kFailed, kExitInternalError, problem.what());
  }
}

void Service::Delay(const CatalogueEntry& entry, const std::string& problem) {
  if (!delayed_.contains(entry.id)) {
    LogError("campaign {} ({}) waits, and continues by itself: {}", entry.name, entry.id.substr(0, 8),
             problem);
  }
  delayed_[entry.id] = {workforce_.now_s() + kDelay_s, problem};
  if (entry.state == CampaignState::kReporting) to_report_.push_back({entry.id, workforce_.now_s()});
}

bool Service::IsDelayed(const std::string& id) const {
  const auto delayed = delayed_.find(id);
  return delayed != delayed_.end() && workforce_.now_s() < delayed->second.until_s;
}

void Service::Save(const CatalogueEntry& entry) {
  const LogAbout about(entry.id);
  try {
    catalogue_.Write(entry);
    unsaved_.erase(entry.id);
  } catch (const ResultError& error) {
    if (unsaved_.insert(entry.id).second) {
      LogError("campaign {} ({}): its state cannot be stored, it is tried again: {}", entry.name,
               entry.id.substr(0, 8), error.what());
    }
  }
}

void Service::SaveAgain() {
  const std::set<std::string> unsaved = unsaved_;
  for (const std::string& id : unsaved) Save(catalogue_.At(id));
}

void Service::Measure() {
  const double now_s = workforce_.now_s();
  if (now_s - measured_s_ < kMeasure_s) return;
  measured_s_ = now_s;
  SaveAgain();
  actions_.Retry();
  NoteExpelled();
  const bool counts = now_s - counted_s_ >= kCount_s;
  if (counts) counted_s_ = now_s;
  for (auto& [id, flying] : flying_) {
    CatalogueEntry& entry = catalogue_.At(id);
    if (counts) entry.bytes = catalogue_.CountBytes(id);
    flying.pace.Measure(now_s, flying.book->ledger().Progress().done);
    NoteConflicts(entry, flying);
    NoteRemoved(entry, flying);
    Publish(entry);
  }
}

// At once and for ever: whoever starts this coordinator again must not make them unseen.
void Service::NoteConflicts(CatalogueEntry& entry, Flying& flying) {
  const std::uint64_t seen = flying.book->ledger().Progress().conflicts;
  if (seen == flying.conflicts_noted) return;
  // One that is settled counts no more, so `seen` falls too.
  entry.conflicts = entry.conflicts + seen - std::min(entry.conflicts, flying.conflicts_noted);
  flying.conflicts_noted = seen;
  Save(entry);
}

// Whoever was expelled stays so when the coordinator is started again, until `dispersa readmit`.
void Service::LoadExpelled() {
  const std::filesystem::path file = options_.data / kExpelledFile;
  std::error_code error;
  if (!std::filesystem::exists(std::filesystem::symlink_status(file, error))) return;
  try {
    workforce_.Expel(ReadExpulsions(ReadWholeFile(file)));
  } catch (const ResultError& unreadable) {
    throw InputError(unreadable.what(), kExpelledRule);
  } catch (const std::runtime_error& damage) {
    throw InputError(file.string() + ": is damaged: it " + damage.what(), kExpelledRule);
  }
  expelled_noted_ = workforce_.expelled();
  std::string names;
  for (const auto& [name, expulsion] : workforce_.expelled()) {
    if (!expulsion.is_forgiven) names += (names.empty() ? "" : ", ") + Printable(name);
  }
  if (!names.empty()) LogInfo("expelled earlier ({}): {}", kExpelledFile, names);
}

void Service::NoteExpelled() {
  if (workforce_.expelled() == expelled_noted_) return;
  try {
    WriteExpelled();
  } catch (const ResultError& error) {
    LogError("who was expelled cannot be stored, it is tried again: {}", error.what());
  }
}

void Service::WriteExpelled() {
  WriteFile(options_.data / kExpelledFile, SealedText(workforce_.expelled()));
  for (const auto& [name, expulsion] : workforce_.expelled()) {
    if (expelled_noted_.contains(name)) continue;
    Action action{.what = "expel"};
    action.worker = name;
    action.reason = expulsion.reason;
    actions_.Note(action);
  }
  expelled_noted_ = workforce_.expelled();
}

std::vector<std::string> Service::Readmit(const std::string& name) {
  const ExpulsionMap before = workforce_.expelled();
  std::vector<std::string> readmitted = workforce_.Readmit(name);
  try {
    // A client whose answer got lost asks again: nothing is left to do then, and it is on the disk.
    if (!readmitted.empty()) WriteExpelled();
  } catch (const ResultError&) {
    workforce_.Expel(before);
    throw;
  }
  for (const std::string& each : readmitted) LogWarning("{} is readmitted", Printable(each));
  return readmitted;
}

// An expelled worker's results: whoever cancels the campaign after a restart must not be promised them.
void Service::NoteRemoved(CatalogueEntry& entry, const Flying& flying) {
  const std::uint64_t done = flying.book->ledger().Progress().done;
  if (done >= entry.done) return;
  entry.done = done;
  Save(entry);
}

// From the workers. Its entry holds what the ledger knew and the disk has.
Service::Book Service::TakeBack(const std::string& id) {
  const auto found = flying_.find(id);
  CatalogueEntry& entry = catalogue_.At(id);
  found->second.book->TryFlush();
  NoteConflicts(entry, found->second);
  workforce_.EndCampaign(found->second.book->campaign().result_id());
  Book book = std::move(found->second.book);
  std::erase_if(flew_, [&](const auto& each) { return each.first == id; });
  flew_.emplace_back(id, book->tally());
  if (flew_.size() > kRemembered) flew_.pop_front();
  const std::uint64_t done = book->ledger().Progress().done;
  entry.done = done - std::min(done, book->unstored());
  entry.quarantined = book->ledger().Progress().quarantined;
  flying_.erase(found);
  return book;
}

void Service::End(CatalogueEntry& entry, CampaignState state, int code, const std::string& problem) {
  const LogAbout about(entry.id);
  entry.state = state;
  entry.code = code;
  entry.problem = problem.substr(0, kMaxProblem);
  entry.ended_unix_s = options_.unix_time_s();
  entry.bytes = catalogue_.CountBytes(entry.id);
  delayed_.erase(entry.id);
  Save(entry);
  Publish(entry);
  if (problem.empty()) {
    LogInfo("campaign {} ({}) of {} is {}, code {}{}", entry.name, entry.id.substr(0, 8), OwnerOf(entry),
            CampaignStateName(state), code, entry.verdict.empty() ? "" : ", verdict " + entry.verdict);
  } else {
    LogError("campaign {} ({}) is {}: {}", entry.name, entry.id.substr(0, 8), CampaignStateName(state),
             problem);
  }
}

void Service::Publish(const CatalogueEntry& entry) {
  const LedgerProgress progress = View(entry.id).progress;
  workforce_.Publish({0, entry.id, entry.flight_id, entry.name, CampaignStateName(entry.state),
                      progress.total, progress.done, progress.quarantined, progress.assigned, 0});
}

CampaignView Service::View(const std::string& id) const {
  CampaignView view;
  const CatalogueEntry& entry = catalogue_.entries().at(id);
  view.entry = &entry;
  view.problem = entry.problem;
  if (const RunningTally* tally = TallyOf(id); tally != nullptr && !HasEnded(entry.state))
    view.standings = tally->Standings();
  const auto flying = flying_.find(id);
  if (const auto delayed = delayed_.find(id); delayed != delayed_.end())
    view.problem = Waiting(delayed->second.problem);
  view.is_checked = entry.done + entry.quarantined > 0;
  if (flying == flying_.end()) {
    view.progress.total = entry.cases;
    view.progress.done = entry.done;
    view.progress.quarantined = entry.quarantined;
    if (!HasEnded(entry.state))
      view.progress.waiting = entry.cases - std::min(entry.cases, entry.done + entry.quarantined);
    return view;
  }
  if (const auto refusal = workforce_.RefusalByAll(flying->second.book->campaign().result_id()))
    view.problem = "no worker here can fly it: " + *refusal;
  if (const std::string& pause = flying->second.book->pause(); !pause.empty()) view.problem = Waiting(pause);
  view.progress = flying->second.book->ledger().Progress();
  view.is_checked = view.progress.done + view.progress.quarantined > 0;
  view.rate_per_s = flying->second.pace.PerSecond();
  view.eta_s = TimeLeft(view.progress, view.rate_per_s);
  return view;
}

const RunningTally* Service::TallyOf(const std::string& id) const {
  if (const auto flying = flying_.find(id); flying != flying_.end()) return &flying->second.book->tally();
  const auto flew =
      std::find_if(flew_.begin(), flew_.end(), [&](const auto& each) { return each.first == id; });
  return flew == flew_.end() ? nullptr : &flew->second;
}

std::vector<std::filesystem::path> Service::Journals() const {
  std::vector<std::filesystem::path> files;
  for (const char* name : {kDeletedFile, kExpelledFile, kActionsFile, kEpochFile, kLedgerName}) {
    std::error_code error;
    if (std::filesystem::is_regular_file(options_.data / name, error)) files.push_back(options_.data / name);
  }
  return files;
}

std::filesystem::path Service::JournalAt(const std::filesystem::path& name) const {
  for (const std::filesystem::path& file : Journals())
    if (file.filename() == name) return file;
  throw Refused(kExitBadInput, "the coordinator has no file " + Printable(name.string()));
}

bool Service::IsAtRest(const std::string& id) const {
  return HasEnded(catalogue_.entries().at(id).state) && !(opening_ && opening_->id == id);
}

bool Service::IsDrained() const {
  return is_draining_ && !opening_ && flying_.empty() && to_report_.empty() && reporting_.empty();
}

bool Service::HasWork() const { return !catalogue_.open().empty(); }

void Service::RequireQuota(const CatalogueEntry& entry) const {
  const Quota quota = options_.quotas.Of(entry.owner);
  std::uint64_t campaigns = 1, cases = entry.cases, bytes = 0;
  for (const auto& [id, other] : catalogue_.entries()) {
    if (id == entry.id || other.owner != entry.owner) continue;
    bytes += other.bytes;
    if (HasEnded(other.state)) continue;
    ++campaigns;
    cases += other.cases;
  }
  const auto refuse = [&](const std::string& what, const std::string& option) {
    throw Refused(kExitBadInput, fmt::format("'{}' would have {} (dispersa-coordinator --quota {})",
                                             entry.owner, what, option));
  };
  if (quota.campaigns && campaigns > *quota.campaigns) {
    refuse(fmt::format("{} campaigns that have not ended, allowed: at most {}; wait, or cancel one",
                       campaigns, *quota.campaigns),
           "campaigns");
  }
  if (quota.cases && cases > *quota.cases) {
    refuse(
        fmt::format("{} cases in campaigns that have not ended, allowed: at most {}; wait, or launch fewer",
                    cases, *quota.cases),
        "cases");
  }
  if (quota.disk && bytes >= *quota.disk) {
    refuse(fmt::format("another campaign beside {} on the coordinator's disk, allowed: less than {}; delete "
                       "campaigns that have ended",
                       Gigabytes(bytes), Gigabytes(*quota.disk)),
           "disk");
  }
}

void Service::MakeRoomForEngine(const std::string& id, const std::string& flight_id) {
  CatalogueEntry& entry = catalogue_.At(id);
  if (entry.flight_id == flight_id) return;
  RequireSound(entry);
  if (entry.engine.empty()) {
    entry.flight_id = flight_id;  // nothing was flown
    Save(entry);
    return;
  }
  if (!IsAtRest(id)) {
    throw Refused(kExitIncomplete,
                  fmt::format("campaign {} of engine {} is {}, try again when it has ended", id.substr(0, 8),
                              entry.engine, CampaignStateName(entry.state)));
  }
  SaveAgain();
  std::erase_if(flew_, [&](const auto& each) { return each.first == id; });
  delayed_.erase(id);
  catalogue_.Rename(id, BesideName(id, entry.engine));
  const std::string ours = BesideName(id, EngineVersion());
  if (catalogue_.entries().contains(ours)) catalogue_.Rename(ours, id);
}

void Service::Relaunch(const std::string& id, int priority, const std::vector<std::string>& labels) {
  RequireSound(catalogue_.At(id));
  CatalogueEntry entry = catalogue_.At(id);
  entry.priority = priority;
  AddLabels(&entry, labels);
  if (IsContinuedByLaunch(entry)) {
    RequireQuota(entry);
    QueueAgain(&entry);
  }
  catalogue_.Write(entry);
  catalogue_.At(id) = entry;
  if (const auto flying = flying_.find(id); flying != flying_.end())
    workforce_.BeginCampaign(*flying->second.book, priority);
}

void Service::Launch(CatalogueEntry entry, const std::string& text) {
  const LogAbout about(entry.id);
  RequireQuota(entry);
  entry.launched_unix_s = options_.unix_time_s();
  entry.engine = EngineVersion();
  LogInfo("campaign {} ({}): launched by {}, {} cases", entry.name, entry.id.substr(0, 8), OwnerOf(entry),
          entry.cases);
  catalogue_.Add(std::move(entry), text);
}

// Neither written nor read: a campaign of the same flights that is being opened takes its results over.
bool Service::MayBeDeleted(const std::string& id) const {
  if (!IsAtRest(id)) return false;
  return !opening_ ||
         catalogue_.entries().at(opening_->id).flight_id != catalogue_.entries().at(id).flight_id;
}

void Service::Delete(const std::string& id) { Delete(id, ""); }

void Service::Delete(const std::string& id, const std::string& why) {
  const LogAbout about(id);
  const CatalogueEntry& entry = catalogue_.At(id);
  if (!MayBeDeleted(id)) {
    throw Refused(
        kExitBadInput,
        fmt::format("campaign {} is {} and cannot be deleted, allowed: a campaign that has ended; `dispersa "
                    "cancel` ends it",
                    id.substr(0, 8), HasEnded(entry.state) ? "being read" : CampaignStateName(entry.state)));
  }
  Remember(entry);
  LogInfo("campaign {} ({}) of {} is deleted{}", entry.name, id.substr(0, 8), OwnerOf(entry), why);
  delayed_.erase(id);
  unsaved_.erase(id);
  std::erase_if(flew_, [&](const auto& each) { return each.first == id; });
  catalogue_.Remove(id);
}

// Who counts attempts at a requirement counts those whose results are gone, too.
void Service::Remember(const CatalogueEntry& entry) const {
  std::string verdict;
  try {
    std::ifstream stream(catalogue_.ResultsOf(entry.id) / "summary.json");
    // Of a campaign that was repaired and then cancelled, it is the report of results that are gone.
    if (stream && entry.state == CampaignState::kDone)
      verdict = nlohmann::json::parse(stream).value("verdict", "");
  } catch (const nlohmann::json::exception&) {
    // A damaged summary has no verdict.
  }
  const nlohmann::ordered_json line = {{"id", entry.id},
                                       {"flight_id", entry.flight_id},
                                       {"name", entry.name},
                                       {"owner", entry.owner},
                                       {"seed", entry.seed},
                                       {"cases", entry.done},
                                       {"state", CampaignStateName(entry.state)},
                                       {"code", entry.code},
                                       {"verdict", verdict},
                                       {"ended_unix_s", entry.ended_unix_s},
                                       {"deleted_unix_s", options_.unix_time_s()}};
  AppendLine(options_.data / kDeletedFile, DumpAnyText(line));
}

void Service::DeleteOld() {
  const Retention& keep = options_.retention;
  if ((!keep.days && !keep.bytes) || workforce_.now_s() - retained_s_ < kRetention_s) return;
  retained_s_ = workforce_.now_s();
  std::vector<Stored> campaigns;
  for (const auto& [id, entry] : catalogue_.entries())
    campaigns.push_back({id, entry.ended_unix_s, entry.bytes, MayBeDeleted(id)});
  DeleteBeyond(keep, std::move(campaigns), options_.unix_time_s(),
               [this](const std::string& id, bool is_old) {
                 try {
                   const std::string why =
                       is_old ? "it ended long ago (--keep)" : "the campaigns take too much space (--keep)";
                   const std::string name = catalogue_.At(id).name;
                   Delete(id, ": " + why);
                   actions_.Note({.what = "delete", .campaign = id, .name = name, .reason = why});
                   return true;
                 } catch (const ResultError& error) {
                   LogError("campaign {} cannot be deleted: {}", id.substr(0, 8), error.what());
                   return false;
                 }
               });
}

void Service::Repair(const std::string& id, const std::string& worker) {
  const LogAbout about(id);
  CatalogueEntry& entry = catalogue_.At(id);
  RequireSound(entry);
  if (IsOfAnotherEngine(entry)) {
    throw Refused(kExitBadInput,
                  fmt::format("campaign {} was flown by engine {} and cannot be repaired by engine "
                              "{}, allowed: the engine that flew it",
                              id.substr(0, 8), entry.engine, EngineVersion()));
  }
  if (entry.state == CampaignState::kReporting || (opening_ && opening_->id == id)) {
    throw Refused(kExitIncomplete,
                  fmt::format("campaign {} is {} and cannot be repaired now, try again", id.substr(0, 8),
                              entry.state == CampaignState::kReporting ? "reporting" : "being opened"));
  }
  CatalogueEntry repaired = entry;
  QueueAgain(&repaired);
  repaired.distrusted.push_back(worker);
  repaired.conflicts = 0;
  catalogue_.Write(repaired);
  if (flying_.contains(id)) {
    TakeBack(id);
    repaired.done = entry.done;
  }
  entry = repaired;
  TryToRemoveReports(catalogue_.ResultsOf(id));
  LogInfo("campaign {} ({}): the results of {} are flown again", entry.name, id.substr(0, 8), worker);
}

void Service::Give(const std::string& id, const std::string& owner) {
  const LogAbout about(id);
  CatalogueEntry given = catalogue_.At(id);
  LogInfo("campaign {} ({}) of {} is given to {}", given.name, id.substr(0, 8), OwnerOf(given), owner);
  given.owner = owner;
  catalogue_.Write(given);
  catalogue_.At(id) = given;
}

void Service::Cancel(const std::string& id) {
  const LogAbout about(id);
  CatalogueEntry& entry = catalogue_.At(id);
  if (entry.state == CampaignState::kCancelled) return;
  RequireSound(entry);
  if (entry.state == CampaignState::kDone || entry.state == CampaignState::kReporting) {
    throw Refused(kExitBadInput, fmt::format("campaign {} is {} and cannot be cancelled", id.substr(0, 8),
                                             CampaignStateName(entry.state)));
  }
  CatalogueEntry cancelled = entry;
  cancelled.state = CampaignState::kCancelled;
  cancelled.code = kExitIncomplete;
  catalogue_.Write(cancelled);
  if (flying_.contains(id)) {
    const Book book = TakeBack(id);
    try {
      NoteCancelledIn(options_.data, catalogue_.ResultsOf(id), *book);
    } catch (const ResultError& error) {
      LogError("campaign {} ({}): that it was cancelled is in no ledger of attempts: {}", entry.name,
               id.substr(0, 8), error.what());
    }
  }
  End(entry, CampaignState::kCancelled, kExitIncomplete, entry.problem);
}

}  // namespace dispersa
