// Figures of a service for monitoring.
#pragma once

#include <string>

#include "services/coordinator/service.h"

namespace dispersa {

/// In Prometheus' text format 0.0.4.
std::string PrometheusText(const Service& service, const Workforce& workforce);

}  // namespace dispersa
