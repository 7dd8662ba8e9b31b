// Figures of a service for monitoring.
#pragma once

#include <cstdint>
#include <string>

#include "services/coordinator/service.h"

namespace dispersa {

/// How long the coordinator's thread takes.
struct ServingTimes {
  std::uint64_t requests = 0;
  double requests_s = 0.0;       ///< of all answers
  double longest_round_s = 0.0;  ///< of its loop, lately
};

/// In Prometheus' text format 0.0.4. Campaigns that have ended are counted only.
std::string PrometheusText(const Service& service, const Workforce& workforce, const ServingTimes& times);

}  // namespace dispersa
