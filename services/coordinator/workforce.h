// The workers of a service: those of its coordinator, or simulated ones in a test.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "services/coordinator/dispatcher.h"
#include "services/transport/messages.h"

namespace dispersa {

/// The part of a coordinator that service, front desk and Prometheus text use. It needs no network.
class Workforce {
 public:
  virtual ~Workforce() = default;

  /// The book must exist until EndCampaign.
  virtual void BeginCampaign(CampaignBook& book, int priority) = 0;
  virtual void EndCampaign(const std::string& flight_id) = 0;
  /// Sends it to all observers.
  virtual void Publish(CampaignProgress progress) = 0;

  virtual std::vector<Dispatcher::WorkerView> Workers() const = 0;
  /// See Dispatcher.
  virtual std::optional<std::string> RefusalByAll(const std::string& flight_id) const = 0;
  virtual const AuditOptions& audit() const = 0;
  virtual std::uint64_t audits() const = 0;
  virtual const ExpulsionMap& expelled() const = 0;
  virtual void Expel(const ExpulsionMap& names) = 0;
  /// The names that changed.
  virtual std::vector<std::string> Readmit(const std::string& name) = 0;
  /// Seconds since the start.
  virtual double now_s() const = 0;
};

}  // namespace dispersa
