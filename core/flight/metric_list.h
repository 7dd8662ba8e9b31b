// The metrics of a campaign's results by position: those of its vehicle, then its own.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/vehicle/vehicle.h"

namespace dispersa {

class MetricList {
 public:
  /// `own`: names of the metrics that the campaign defines itself (own_metrics.h). A number of stages is the
  /// list of a campaign without any.
  MetricList(std::size_t stages = kUsualStages, std::vector<std::string> own = {});

  std::size_t stages() const { return stages_; }
  std::size_t size() const { return of_vehicle_ + own_.size(); }
  const std::vector<std::string>& own() const { return own_; }
  const std::string& NameAt(std::size_t position) const;
  std::optional<std::size_t> Find(const std::string& name) const;
  /// Position of a metric that is in the list.
  std::size_t PositionOf(const std::string& name) const;

 private:
  std::size_t stages_;
  std::size_t of_vehicle_;
  std::vector<std::string> own_;
};

/// All of them.
std::vector<std::string> NamesOf(const MetricList& metrics);

}  // namespace dispersa
