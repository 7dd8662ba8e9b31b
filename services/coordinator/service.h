// A coordinator of many campaigns: keeps their queue, flies several at once, writes their reports.
#pragma once

#include <atomic>
#include <cstdint>
#include <ctime>
#include <deque>
#include <exception>
#include <filesystem>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "services/coordinator/action_log.h"
#include "services/coordinator/catalogue.h"
#include "services/coordinator/pace.h"
#include "services/coordinator/quota.h"
#include "services/coordinator/retention.h"
#include "services/coordinator/workforce.h"

namespace dispersa {

/// A ledger takes 17 bytes a case, a report 140: with eight such campaigns open and a report 1.5 GB.
inline constexpr std::uint64_t kDefaultMaxCases = 5000000;

struct ServiceOptions {
  std::filesystem::path data;
  int report_threads = 1;          ///< of each report
  std::size_t flying_at_once = 8;  ///< campaigns that fly side by side; the others wait
  std::uint64_t max_cases =
      kDefaultMaxCases;  ///< of a campaign: its ledger and its report take memory for each
  Retention retention = {};
  std::size_t reports_at_once = 2;  ///< each on a thread of its own
  Quotas quotas = {};
  std::uint64_t epoch = 0;  ///< of this start
  std::function<std::int64_t()> unix_time_s = [] { return std::int64_t{std::time(nullptr)}; };
};

/// A request that cannot be granted. `code` is the exit code of the client.
struct Refused : std::runtime_error {
  Refused(int exit_code, const std::string& what) : std::runtime_error(what), code(exit_code) {}
  int code;
};

/// Whether another engine than this has flown cases of it.
bool IsOfAnotherEngine(const CatalogueEntry& entry);

/// Throws Refused if its state is damaged.
void RequireSound(const CatalogueEntry& entry);

/// Whether launching it again puts it into the queue again.
bool IsContinuedByLaunch(const CatalogueEntry& entry);

/// A campaign as it is now.
struct CampaignView {
  const CatalogueEntry* entry = nullptr;
  LedgerProgress progress;
  double rate_per_s = 0.0;
  std::optional<double> eta_s;
  bool is_checked = false;  ///< some worker has found its control law fit to fly: it has begun a case
  std::vector<RequirementStanding> standings;  ///< until it has ended
  std::string problem;  ///< of one that failed or was refused, that no worker here can fly, or that waits for
                        ///< the disk
};

/// Everything that a client was told survives a restart: a campaign is on the disk before its id is answered.
/// One thread talks, another opens campaigns, others write reports, since both may take minutes. An error
/// in one campaign ends that campaign. A full disk delays it.
class Service {
 public:
  /// Throws InputError if the data directory cannot be used.
  Service(const ServiceOptions& options, Workforce& workforce);
  ~Service();

  /// Between two steps of the workforce.
  void Step();
  /// Stores what has gathered, as far as the disk takes it.
  void Flush();

  const Catalogue& catalogue() const { return catalogue_; }
  ActionLog& actions() { return actions_; }
  std::uint64_t max_cases() const { return options_.max_cases; }
  /// Files of the data directory that belong to no campaign: deletions, expelled workers, the last start,
  /// attempts, actions.
  std::vector<std::filesystem::path> Journals() const;
  /// The one with this name. Throws Refused.
  std::filesystem::path JournalAt(const std::filesystem::path& name) const;
  CampaignView View(const std::string& id) const;
  /// The statistics of its results so far, also of one that flew lately; nullptr if unknown.
  const RunningTally* TallyOf(const std::string& id) const;
  /// Whether nobody writes its results, now or soon.
  bool IsAtRest(const std::string& id) const;
  /// Campaigns whose report is being written, and those that wait for that.
  std::size_t reports_under_way() const { return reporting_.size(); }
  std::size_t reports_waiting() const { return to_report_.size(); }
  /// Seconds for which the first of them has waited.
  double report_wait_s() const;
  /// Bytes that are free on the disk of the campaigns; none if the system does not say.
  std::optional<std::uint64_t> free_bytes() const;
  /// Why campaigns wait now: something cannot be stored. Empty: they do not.
  std::string WhyPaused() const;
  /// Whether any campaign has not ended.
  bool HasWork() const;
  /// Whether workers are needed now.
  bool HasWorkToFly() const { return !flying_.empty(); }

  /// From now on no campaign begins to fly: what waits stays stored for the next coordinator. What flies
  /// ends, with its report.
  void Drain() { is_draining_ = true; }
  bool is_draining() const { return is_draining_; }
  bool IsDrained() const;
  std::uint64_t epoch() const { return options_.epoch; }

  // Changes by clients. They are on the disk before the client is told so. These throw ResultError, and have
  // then changed nothing.

  /// Afterwards `id` names the flight with this id of this engine, or no campaign. A flight of another engine
  /// stays beside it under a longer id. Throws Refused while that is used.
  void MakeRoomForEngine(const std::string& id, const std::string& flight_id);
  /// Puts a campaign that is known into the queue again if launching it again continues it, changes its
  /// priority and adds labels. Throws Refused beyond its owner's quota.
  void Relaunch(const std::string& id, int priority, const std::vector<std::string>& labels = {});
  /// Takes a new one. Throws Refused beyond its owner's quota.
  void Launch(CatalogueEntry entry, const std::string& text);
  /// Ends it. Stored results stay. Called again it does nothing. Throws Refused if it has ended already.
  void Cancel(const std::string& id);
  /// From now on it is a campaign of this owner.
  void Give(const std::string& id, const std::string& owner);
  /// Results of the workers that `worker` means (IsMeantBy) are removed and flown again. Contradictions,
  /// verdict and report are forgotten: they were with these. Throws Refused while its report is written.
  void Repair(const std::string& id, const std::string& worker);
  /// Lets expelled workers fly again (Readmit() of expulsions.h). The names that changed.
  std::vector<std::string> Readmit(const std::string& name);
  /// Deletes its folder. DATA/deleted.jsonl keeps a line of it. Throws Refused unless it is at rest.
  void Delete(const std::string& id);

 private:
  using Book = std::unique_ptr<CampaignBook>;
  struct Flying {
    Book book;
    std::uint64_t conflicts_noted = 0;
    Pace pace;
  };
  struct Opening {
    std::string id;
    std::future<Book> book;
  };
  /// What the catalogue keeps of a report.
  struct Reported {
    StandingVerdict verdict;
    std::string engine;
    std::int64_t attempts;
    std::vector<RequirementOutcome> requirements;
    std::string nominal_loss;  ///< NominalLoss(); empty: the nominal flight was completed
  };
  struct Reporting {
    std::string id;
    std::future<Reported> reported;
  };

  void SettleEngine(CatalogueEntry& entry);
  std::string SoundTextOf(const std::string& id) const;
  void CloseBroken();
  void CloseRefused();
  void CloseComplete();
  void FinishReports();
  void StartReports();
  bool StartReport();
  void FinishOpening();
  void StartOpening();
  void BeginToOpen(const CatalogueEntry& entry);
  /// Throws Refused if its owner may not have it fly besides its other campaigns.
  void RequireQuota(const CatalogueEntry& entry) const;
  bool MakeRoomFor(const CatalogueEntry& entry);
  void Measure();
  void NoteConflicts(CatalogueEntry& entry, Flying& flying);
  void DeleteOld();
  /// `why`: for the log.
  void Delete(const std::string& id, const std::string& why);
  void Remember(const CatalogueEntry& entry) const;
  bool MayBeDeleted(const std::string& id) const;
  void LoadExpelled();
  void WriteExpelled();
  void NoteExpelled();
  void NoteRemoved(CatalogueEntry& entry, const Flying& flying);
  Book TakeBack(const std::string& id);
  /// In time, when the disk does not take it now.
  void Save(const CatalogueEntry& entry);
  void SaveAgain();
  void Delay(const CatalogueEntry& entry, const std::string& problem);
  bool IsDelayed(const std::string& id) const;
  void Fail(CatalogueEntry& entry, std::exception_ptr error);
  void End(CatalogueEntry& entry, CampaignState state, int code, const std::string& problem = "");
  void Publish(const CatalogueEntry& entry);

  ServiceOptions options_;
  Workforce& workforce_;
  Catalogue catalogue_;
  ActionLog actions_;
  std::map<std::string, Flying> flying_;                   ///< by id
  std::deque<std::pair<std::string, RunningTally>> flew_;  ///< by id: what the last ones came to
  std::optional<Opening> opening_;
  struct Complete {
    std::string id;
    double since_s;
  };
  std::deque<Complete> to_report_;  ///< their folders are closed meanwhile
  std::vector<Reporting> reporting_;
  std::atomic<bool> stop_report_ = false;
  struct Delayed {
    double until_s;
    std::string problem;
  };
  std::map<std::string, Delayed> delayed_;  ///< by id: the disk was full
  std::set<std::string> unsaved_;           ///< ids whose state is not on the disk
  bool is_draining_ = false;
  std::uint64_t opened_ = 0;
  ExpulsionMap expelled_noted_;  ///< what the disk has
  double retained_s_ = -1e9;     ///< when what is old was looked for
  double measured_s_ = -1.0;
  double counted_s_ = -1e9;  ///< when the bytes of what flies were counted
};

}  // namespace dispersa
