// What a coordinator says to its workers and what follows from what they say. A pure state machine over the
// books of its campaigns: it knows neither clocks nor networks; time is an argument, in seconds from any
// origin.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "services/ledger/campaign_book.h"
#include "services/transport/messages.h"

namespace dispersa {

struct DispatcherOptions {
  double silence_s = 3.0;         ///< a worker that says nothing for so long is lost
  double repeat_s = 2.0;          ///< an assignment that a worker does not know is said again after so long
  double pulse_s = 1.0;           ///< every worker hears something at least so often
  double last_messages_s = 0.2;   ///< what a process that ended has sent may still arrive for so long
  double report_silence_s = 5.0;  ///< results are reported, and repeated, more often than that
  double load_silence_s = 60.0;   ///< a text is loaded within that
  std::size_t max_workers = 2000;
  AuditOptions audit;
};

/// Liveness (services/README.md): nothing depends on a message arriving. Assignments are repeated until the
/// worker's status holds them, acknowledgements follow each repetition of a report, and a worker's presence
/// is its status.
class Dispatcher {
 public:
  /// `epoch` differs for each start of a coordinator and is not 0.
  Dispatcher(std::uint64_t epoch, std::string engine_version, const DispatcherOptions& options = {});

  /// Flies the cases of this book until Close, those of a higher priority first, of equal ones a fair share
  /// each. The book's attempts must differ from those of the others (LedgerOptions::attempt_base).
  void BeginCampaign(CampaignBook& book, int priority = 0);
  void EndCampaign(const std::string& flight_id);

  /// `sender` names the participant that a message came from; a worker cannot choose it.
  void On(const std::string& sender, const WorkerStatus& status, double now_s);
  /// Returns the results that were accepted: the first of their cases.
  std::vector<const FlownCase*> On(const std::string& sender, const Report& report, double now_s);
  void On(const std::string& sender, const CampaignRefusal& refusal, double now_s);
  /// A part of a campaign's text, at most `limit` bytes; none if the campaign is not open.
  std::optional<TextPart> On(const TextRequest& request, std::size_t limit, double now_s);
  /// The participant closed its connection: another one may speak for its workers.
  void Gone(const std::string& sender);

  /// Results to be flown again here, of one campaign after the other.
  using OnClaims = std::function<void(const Campaign&, std::vector<Claim>)>;
  void TakeClaims(const OnClaims& fly);
  /// What that gave. A worker that returned something else is expelled: it may not fly here any more, and
  /// whatever it returned is flown again.
  void Audited(const std::string& flight_id, const Claim& claim, const Digest& truth);

  /// Announces that the end of this worker will be told by WorkerEnded: a local process has an exit status,
  /// which says more than silence.
  void Supervise(const std::string& worker);
  /// A supervised worker ended. Takes effect a moment later, when its last messages have arrived.
  void WorkerEnded(const std::string& worker, WorkerEnd end, const std::string& reason, double now_s);
  /// Supervised workers that hang or are silent: to be killed.
  std::vector<std::string> TakeUnresponsive();
  /// Workers that need no more be talked to.
  std::vector<std::string> TakeForgotten();

  /// What to send now. Stores what is due to be stored. Throws ResultError.
  std::vector<Orders> Tick(double now_s);
  /// From now on every worker is told to leave.
  void Dismiss();

  std::size_t joined() const { return workers_.size(); }
  /// Whether more than statuses gets here. False without workers, and when all of them have had something to
  /// tell for longer than it takes: one that flew (`report_silence_s`), or one that holds cases and flies
  /// none
  /// (`load_silence_s`).
  bool ReceivesReports(double now_s) const;
  struct WorkerView {
    std::string worker;
    std::string host;
    std::uint32_t slots;
    WorkerState state;
    std::uint64_t flown;
  };
  std::vector<WorkerView> Workers() const;
  /// Why no worker can fly this campaign, as one of them says: none while there is one that does not refuse
  /// it, and without workers.
  std::optional<std::string> RefusalByAll(const std::string& flight_id) const;
  /// Why a worker was refused or refused a campaign, most recently.
  const std::optional<std::string>& refusal() const { return refusal_; }
  /// Messages that contradicted what is known: of strangers, of other senders than before, of impossible
  /// cases.
  std::uint64_t refused_messages() const { return refused_messages_; }
  const AuditOptions& audit() const { return options_.audit; }
  std::uint64_t audits() const { return audits_; }
  std::uint64_t expelled() const { return expelled_; }

 private:
  struct FlyingCampaign {
    CampaignBook* book = nullptr;
    int priority = 0;
    std::map<std::string, std::string> refused_by;  ///< workers that cannot fly it, and why
    std::vector<std::pair<std::string, std::uint64_t>>
        unstored;  ///< worker, report: acknowledged when stored
  };
  struct Sent {
    std::string flight_id;
    double at_s = 0.0;
  };
  struct Worker {
    std::string host;
    std::string sender;
    bool sender_gone = false;
    WorkerHello hello;
    WorkerState state = WorkerState::kReady;
    std::uint64_t flown = 0;
    double heard_s = 0.0;
    double last_report_s = 0.0;              ///< when the last one came that was no status
    double report_due_s = 0.0;               ///< the next one is due so long after it, by the last status
    std::int64_t results = 0;                ///< that came
    std::optional<std::int64_t> unreported;  ///< what it has flown less that: the least, when all had come
    double last_orders_s = 0.0;
    std::map<std::uint64_t, Sent> sent;  ///< by attempt
    Orders orders;                       ///< what is to be said

    void ForgetSent(const std::string& flight_id);
  };

  bool Join(const std::string& sender, const WorkerStatus& status, double now_s);
  void Refuse(const std::string& worker, const std::string& reason);
  void Expel(const std::string& worker, const std::string& reason);
  void TellRefusal(const std::string& worker, const std::string& reason);
  void Compare(Worker& worker, const WorkerStatus& status, double now_s);
  void GiveOrder(Worker& worker, const std::string& flight_id, std::uint64_t attempt,
                 std::vector<std::uint64_t> cases, double now_s);
  /// Acknowledges what is stored of a campaign.
  void Acknowledge(FlyingCampaign& campaign);
  void Lose(const std::string& worker, WorkerEnd end, const std::string& reason);
  void LoseSilent(double now_s);
  void Expire(double now_s);
  void Assign(double now_s);
  bool AssignTo(const std::string& id, Worker& worker, double now_s);
  void Disagree(const std::string& sender, const std::string& what);

  struct Ending {
    double due_s;
    std::string worker;
    WorkerEnd end;
    std::string reason;
  };

  std::uint64_t epoch_;
  std::string engine_version_;
  DispatcherOptions options_;
  std::map<std::string, FlyingCampaign> campaigns_;  ///< by flight id
  std::map<std::string, Worker> workers_;
  std::set<std::string> supervised_;
  std::map<std::string, std::string> refused_;  ///< worker -> why; told again whenever it speaks
  std::set<std::string> ended_;  ///< supervised workers that ended: what still arrives of them is old
  std::set<std::string> unresponsive_;
  std::vector<std::string> forgotten_;
  std::vector<Ending> endings_;
  std::vector<Orders> refusals_;
  std::optional<std::string> refusal_;
  std::uint64_t refused_messages_ = 0;
  std::uint64_t audits_ = 0;
  std::uint64_t expelled_ = 0;
  double expired_s_ = 0.0;
  bool dismissed_ = false;
};

}  // namespace dispersa
