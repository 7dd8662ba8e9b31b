// The workers of a service: those of its coordinator, or made-up ones in a test.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/coordinator/dispatcher.h"
#include "services/transport/messages.h"

namespace dispersa {

/// The part of a coordinator that a service, its front desk and its metrics use. It needs no network.
class Workforce {
 public:
  virtual ~Workforce() = default;

  /// A book must stay until it is closed.
  virtual void BeginCampaign(CampaignBook& book, int priority) = 0;
  virtual void EndCampaign(const std::string& flight_id) = 0;
  /// To all observers.
  virtual void Publish(CampaignProgress progress) = 0;

  virtual std::vector<Dispatcher::WorkerView> Workers() const = 0;
  /// See Dispatcher.
  virtual std::optional<std::string> RefusalByAll(const std::string& flight_id) const = 0;
  virtual const AuditOptions& audit() const = 0;
  virtual std::uint64_t audits() const = 0;
  virtual std::uint64_t expelled() const = 0;
  /// Seconds since the start.
  virtual double now_s() const = 0;
};

}  // namespace dispersa
