// Serves campaigns to the workers of a network.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/coordinator/dispatcher.h"
#include "services/coordinator/epoch.h"
#include "services/coordinator/workforce.h"
#include "services/ledger/auditor.h"
#include "services/transport/coordinator_link.h"
#include "services/transport/revocations.h"

namespace dispersa {

/// The dispatcher with a clock and a network. Use it from one thread.
class Coordinator : public Workforce {
 public:
  /// Throws NetworkError. `audit_share` is the share (0 to 1) of all results that is flown again here.
  /// Without a value it is kUsualAuditShare for campaigns without a plug-in. Results under a plug-in may
  /// rightly differ on another machine.
  explicit Coordinator(const NetworkOptions& network, std::optional<double> audit_share = 0.0,
                       std::uint64_t epoch = NextEpoch());
  /// Serves one campaign.
  Coordinator(const NetworkOptions& network, CampaignBook& book, std::optional<double> audit_share = 0.0);

  void BeginCampaign(CampaignBook& book, int priority) override { dispatcher_.BeginCampaign(book, priority); }
  void EndCampaign(const std::string& flight_id) override { dispatcher_.EndCampaign(flight_id); }

  /// One round: waits at most `timeout` for messages, handles them, and sends due messages. Throws
  /// ResultError.
  void Step(std::chrono::milliseconds timeout);

  /// See Dispatcher.
  void Supervise(const std::string& worker) { dispatcher_.Supervise(worker); }
  void WorkerEnded(const std::string& worker, WorkerEnd end, const std::string& reason) {
    dispatcher_.WorkerEnded(worker, end, reason, now_s_);
  }
  std::vector<std::string> TakeUnresponsive() { return dispatcher_.TakeUnresponsive(); }

  /// Tells every worker to leave, and waits until the message has arrived.
  void Dismiss();

  /// Sets the function that answers clients.
  void Serve(std::function<Reply(const Request&)> answer) { answer_ = std::move(answer); }
  void Publish(CampaignProgress progress) override;

  /// For a watchdog: see Pulse.
  std::shared_ptr<const Pulse> StartPulse() { return link_.StartPulse(); }

  std::size_t joined() const { return dispatcher_.joined(); }
  bool ReceivesReports() const { return dispatcher_.ReceivesReports(now_s_); }
  std::vector<Dispatcher::WorkerView> Workers() const override { return dispatcher_.Workers(); }
  std::optional<std::string> RefusalByAll(const std::string& flight_id) const override {
    return dispatcher_.RefusalByAll(flight_id);
  }
  const std::optional<std::string>& refusal() const { return dispatcher_.refusal(); }
  const AuditOptions& audit() const override { return dispatcher_.audit(); }
  std::uint64_t audits() const override { return dispatcher_.audits(); }
  const ExpulsionMap& expelled() const override { return dispatcher_.expelled(); }
  void Expel(const ExpulsionMap& names) override { dispatcher_.Expel(names, false); }
  std::vector<std::string> Readmit(const std::string& name) override { return dispatcher_.Readmit(name); }
  /// Without the seconds for which this process or machine stood still.
  double now_s() const override { return now_s_; }

 private:
  void Advance();
  void Handle(const CoordinatorEvent& event);
  void Answer(const Request& request);
  void ForgetClients();
  void RefuseRevoked(const CoordinatorEvent& event);
  void Send(const std::vector<Orders>& messages);

  std::uint64_t epoch_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  double now_s_ = 0.0;
  Dispatcher dispatcher_;
  std::optional<Auditor> auditor_;
  CoordinatorLink link_;
  std::optional<Revocations> revocations_;
  std::function<Reply(const Request&)> answer_;
  std::map<std::string, double> clients_;  ///< when they asked last
};

}  // namespace dispersa
