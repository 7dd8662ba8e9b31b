// The cases that a worker holds, flies and must report. A pure state machine without clocks, threads and
// networks. Time is an argument, in seconds from any origin.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/cases/campaign_flights.h"
#include "services/transport/messages.h"

namespace dispersa {

struct FlightDeskOptions {
  std::string worker;  ///< its UUID
  std::string engine_version;
  std::uint32_t slots = 1;
  std::uint32_t lanes = 1;  ///< cases that a slot flies side by side
  double status_s = 0.5;    ///< between two statuses
  double repeat_s = 2.0;    ///< time after which an unanswered message is repeated
  double deaf_s = 5.0;  ///< time without a message of the coordinator after which the connection is renewed
  double longest_deaf_s = 30.0;  ///< when that does not help, ever later, up to this
  double announce_s = 0.005;     ///< cases that take less together are announced together
  std::size_t max_unstored =
      16384;  ///< results that the coordinator has not stored, beyond which flying waits
};

/// A case to fly.
struct Job {
  std::shared_ptr<const CampaignFlights> flights;
  std::string flight_id;
  std::uint64_t coordinator_epoch = 0;
  std::uint64_t attempt = 0;
  std::uint64_t case_index = 0;
  double started_s = 0.0;
};

/// A campaign's text as it arrived, to be loaded. Its flight id is the coordinator's.
struct CampaignText {
  std::string flight_id;
  std::string name;
  std::string engine_version;
  std::string text;
};

class FlightDesk {
 public:
  /// `now_s`: the connection is new.
  FlightDesk(const FlightDeskOptions& options, double now_s);

  /// Orders of an older coordinator are ignored while the followed one is heard. Epochs grow.
  void On(const Orders& orders, double now_s);
  void On(const TextPart& part, double now_s);
  /// A coordinator has let us in, and may be heard soon.
  void Met(double now_s) { connected_s_ = now_s; }

  /// A complete text that has not been taken, each once.
  std::optional<CampaignText> TakeText();
  /// The outcome of reading it: its flights, or why it cannot be flown here.
  void Loaded(const std::string& flight_id, std::shared_ptr<const CampaignFlights> flights,
              const std::string& problem, bool engine_fault = false);

  /// The next case to fly, if there is one. The caller must then send the output of TakeReports before the
  /// flight. So the coordinator knows which case to blame if the flight ends this process.
  std::optional<Job> Next(double now_s);
  void Done(const Job& job, CaseResult result, double now_s);
  /// It ended every process that flew it.
  void Quarantined(const Job& job, const std::string& reason, double now_s);
  /// Reports that are ready. Results wait for the start of the next case, unless there is none.
  std::vector<Report> TakeReports(double now_s);

  /// Messages that are due, new or repeated.
  struct Due {
    std::optional<WorkerStatus> status;
    std::vector<Report> reports;
    std::vector<TextRequest> text_requests;
    std::vector<CampaignRefusal> refusals;
    bool new_connection = false;  ///< no answers on this connection
  };
  Due Tick(double now_s);
  WorkerStatus Status(WorkerState state) const;

  /// From now on nothing more is begun.
  void Drain();
  bool draining() const { return draining_; }
  /// Nothing is held, flown or owed.
  bool IsIdle() const;
  bool IsFlying() const { return in_flight_ > 0; }
  bool left() const { return leave_; }
  const std::string& refusal() const { return refusal_; }
  /// Whether the coordinator was heard lately.
  bool IsHeard(double now_s) const { return epoch_ != 0 && now_s - heard_s_ < options_.deaf_s; }

 private:
  struct KnownCampaign {
    bool ready = false;  ///< loaded
    std::shared_ptr<const CampaignFlights> flights;
    std::string problem;        ///< not empty: cannot be flown here
    bool engine_fault = false;  ///< the problem is this program's own
    CampaignText text;
    std::uint64_t size = 0;
    bool complete = false, taken = false;
    std::optional<double> requested_s;
    std::uint64_t used = 0;
  };
  struct Attempt {
    std::uint64_t unflown = 0;
    std::uint64_t unstored = 0;  ///< results
  };
  struct Owed {
    Report report;
    std::optional<double> sent_s;
    double made_s = 0.0;
  };

  void Follow(std::uint64_t epoch);
  void Take(const FlyOrder& order);
  void Revoke(std::uint64_t attempt);
  bool Announce(double now_s);
  void Give(const Job& job, FlownCase flown, double now_s);
  void DropAttempt(std::map<std::uint64_t, Attempt>::iterator attempt);
  void Forget();
  void Finish(double now_s);

  FlightDeskOptions options_;
  std::uint64_t epoch_ = 0;
  std::map<std::string, KnownCampaign> campaigns_;  ///< by flight id
  std::set<std::string> refused_;  ///< flight ids of orders that cannot be followed, to be said
  std::deque<Job> queue_;
  std::deque<Job> announced_;                  ///< told to the coordinator as started, taken by the next Next
  std::map<std::uint64_t, Attempt> attempts_;  ///< of epoch_
  std::multiset<std::pair<std::uint64_t, std::uint64_t>> flying_;  ///< attempt, case: of epoch_
  std::uint64_t in_flight_ = 0;                                    ///< of any epoch
  Report next_;                                                    ///< gathers
  std::map<std::uint64_t, Owed> owed_;                             ///< reports with results, by number
  std::vector<std::uint64_t> ready_;                               ///< of owed_, not sent yet
  std::vector<Report> starts_;                                     ///< without results, not sent yet
  std::size_t unstored_ = 0;                                       ///< results in owed_ and next_
  std::uint64_t next_number_ = 1;
  std::uint64_t flown_ = 0;
  double mean_flight_s_ = 0.0;
  double gathered_s_ = 0.0;  ///< since when next_ has results
  double status_due_s_;
  double heard_s_;
  double connected_s_;
  double patience_s_;
  std::uint64_t uses_ = 0;
  bool draining_ = false;
  bool leave_ = false;
  std::string refusal_;
};

}  // namespace dispersa
