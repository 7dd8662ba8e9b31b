// Handles the messages of workers and makes the orders for them. A pure state machine over the books of the
// flying campaigns, without clocks and networks. Time is an argument: seconds from any origin.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "services/coordinator/expulsions.h"
#include "services/ledger/campaign_book.h"
#include "services/transport/messages.h"

namespace dispersa {

struct DispatcherOptions {
  double silence_s = 3.0;         ///< a worker without any message for longer is lost
  double repeat_s = 2.0;          ///< period of repeating an assignment that the status lacks
  double pulse_s = 1.0;           ///< period of empty orders to each worker
  double last_messages_s = 0.2;   ///< messages of an ended process may still arrive for this time
  double report_silence_s = 5.0;  ///< a worker with results reports more often than this
  double load_silence_s = 60.0;   ///< a worker loads a text within this time
  std::size_t max_workers = 2000;
  AuditOptions audit;
};

/// Liveness (services/README.md): no single message has to arrive. An assignment is repeated until the
/// worker's status holds it. Each repetition of a report is acknowledged. A worker is present while its
/// status messages arrive.
class Dispatcher {
 public:
  /// `epoch` differs for each start of a coordinator and is not 0.
  Dispatcher(std::uint64_t epoch, std::string engine_version, const DispatcherOptions& options = {});

  /// Flies the cases of this book until EndCampaign. A higher priority goes first; equal ones share the
  /// workers. Attempt numbers of different books must differ (LedgerOptions::attempt_base).
  void BeginCampaign(CampaignBook& book, int priority = 0);
  void EndCampaign(const std::string& flight_id);

  /// `sender` names the participant that sent the message; a worker cannot choose it.
  void On(const std::string& sender, const WorkerStatus& status, double now_s);
  /// Returns the results that were accepted: the first of their cases.
  std::vector<const FlownCase*> On(const std::string& sender, const Report& report, double now_s);
  void On(const std::string& sender, const CampaignRefusal& refusal, double now_s);
  /// A part of a campaign's text, at most `limit` bytes; nothing if the campaign does not fly.
  std::optional<TextPart> On(const TextRequest& request, std::size_t limit, double now_s);
  /// The participant closed its connection: another participant may now speak for its workers.
  void Gone(const std::string& sender);

  /// Calls `fly` for each campaign with the results to be flown again.
  using OnClaims = std::function<void(const Campaign&, std::vector<Claim>)>;
  void TakeClaims(const OnClaims& fly);
  /// The audit's result. A worker that returned another result is expelled, and others as Sentence() says.
  /// All results of those that are expelled are flown again.
  void Audited(const std::string& flight_id, const Claim& claim, const Digest& truth);

  /// WorkerEnded will report the end of this worker. It is a local process, and its exit status says more
  /// than silence.
  void Supervise(const std::string& worker);
  /// A supervised worker ended. Takes effect after `last_messages_s`, when its last messages have arrived.
  void WorkerEnded(const std::string& worker, WorkerEnd end, const std::string& reason, double now_s);
  /// Supervised workers that hang or are silent. The caller kills them.
  std::vector<std::string> TakeUnresponsive();
  /// Workers to which nothing needs to be sent any more.
  std::vector<std::string> TakeForgotten();

  /// A rule of the program is broken in what concerns this campaign: it ends alone.
  void Break(const std::string& flight_id, const std::string& fault);
  /// The orders to send now. Stores accepted results when due. Throws ResultError.
  std::vector<Orders> Tick(double now_s);
  /// From now on, every worker gets the order to leave.
  void Dismiss();

  std::size_t joined() const { return workers_.size(); }
  /// False: status messages arrive but results do not, or there are no workers. Then every worker is overdue:
  /// one that has flown cases after `report_silence_s`, one that holds cases and flies none after
  /// `load_silence_s`.
  bool ReceivesReports(double now_s) const;
  struct WorkerView {
    std::string worker;
    std::string host;
    std::uint32_t slots;
    WorkerState state;
    std::uint64_t flown;
  };
  std::vector<WorkerView> Workers() const;
  /// The flight id of a flying campaign.
  std::string FlightIdOf(const std::string& result_id) const;
  /// The reason of one worker, if every worker refuses this campaign. Nothing without workers.
  std::optional<std::string> RefusalByAll(const std::string& flight_id) const;
  /// The latest reason why a worker was refused, or refused a campaign.
  const std::optional<std::string>& refusal() const { return refusal_; }
  /// Rejected messages: from unknown senders, from another sender than before, about impossible cases.
  std::uint64_t refused_messages() const { return refused_messages_; }
  const AuditOptions& audit() const { return options_.audit; }
  std::uint64_t audits() const { return audits_; }
  const ExpulsionMap& expelled() const { return expelled_; }
  /// Expels workers from now on, if they are not expelled yet: those that an earlier coordinator expelled.
  /// `is_news`: the log tells them one by one.
  void Expel(const ExpulsionMap& names, bool is_news = true);
  /// The issuer of its keys has revoked them. Its results in flying campaigns are flown again.
  void RefuseKeys(const std::string& worker);
  /// See Readmit() of expulsions.h.
  std::vector<std::string> Readmit(const std::string& name) { return dispersa::Readmit(&expelled_, name); }

 private:
  struct FlyingCampaign {
    CampaignBook* book = nullptr;
    int priority = 0;
    std::map<std::string, std::string> refused_by;  ///< workers that cannot fly it, and why
    std::set<std::string> faulty;  ///< workers of which the program broke a rule of its own in its flights
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
    double last_report_s = 0.0;  ///< when the last one came that was no status
    double report_due_s = 0.0;   ///< the next one is due so long after it, by the last status
    std::int64_t results = 0;    ///< that came
    bool is_known = false;       ///< one of them was accepted
    bool is_faulty = false;      ///< its program broke a rule of its own: it leaves
    std::optional<std::int64_t>
        unreported;  ///< cases flown minus `results`: the least value, when all had come
    double last_orders_s = 0.0;
    std::map<std::uint64_t, Sent> sent;  ///< by attempt
    Orders orders;                       ///< messages to send

    void ForgetSent(const std::string& flight_id);
  };

  /// Does something for each flying campaign, guarded by its book.
  template <typename Action>
  void ForEach(Action action) {
    for (auto& [flight_id, campaign] : campaigns_)
      campaign.book->Guard([&, &id = flight_id, &each = campaign] { action(id, each); });
  }
  bool Join(const std::string& sender, const WorkerStatus& status, double now_s);
  void Take(const std::string& sender, const Report& report, Worker& worker, FlyingCampaign& campaign,
            std::vector<const FlownCase*>& accepted, double now_s);
  void NoteFault(const CampaignRefusal& refusal, const std::string& reason, FlyingCampaign& campaign,
                 Worker& worker);
  void LeaveToYounger(const std::string& worker, double now_s);
  void Refuse(const std::string& worker, const std::string& reason);
  /// Whether a result that it returned is to be looked at any further.
  bool MayReturn(const std::string& sender, const Report& report, const FlownCase& flown, CampaignBook& book);
  /// "unknown" if the worker says none: a process that lied has a host.
  std::string HostOf(const std::string& worker) const;
  void TellRefusal(const std::string& worker, const std::string& reason);
  void Compare(Worker& worker, const WorkerStatus& status, double now_s);
  void GiveOrder(Worker& worker, const std::string& flight_id, std::uint64_t attempt,
                 std::vector<std::uint64_t> cases, double now_s);
  /// Acknowledges the stored results of a campaign.
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
  std::set<std::string> led_by_younger_;        ///< workers that follow a coordinator of a larger epoch
  std::optional<double> led_s_;                 ///< when one of them was heard last
  std::map<std::string, std::string> refused_;  ///< worker -> why; told again whenever it speaks
  ExpulsionMap expelled_;
  std::set<std::string> ended_;  ///< supervised workers that ended: later messages from them are old
  std::set<std::string> unresponsive_;
  std::vector<std::string> forgotten_;
  std::vector<Ending> endings_;
  std::vector<Orders> refusals_;
  std::optional<std::string> refusal_;
  std::uint64_t refused_messages_ = 0;
  std::uint64_t audits_ = 0;
  double expired_s_ = 0.0;
  bool dismissed_ = false;
};

}  // namespace dispersa
