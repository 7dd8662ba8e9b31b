// Joint scatter of the injections of completed flights in altitude, velocity and flight path angle.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/results/case_columns.h"
#include "core/statistics/point_scatter.h"

namespace dispersa {

/// The coordinates, in the units of the metrics: geodetic altitude, inertial velocity, inertial flight path
/// angle.
inline constexpr std::array<const char*, 3> kInjectionMetrics = {
    "injection_altitude_km", "injection_velocity_m_s", "injection_flight_path_angle_deg"};

struct InjectionSummary {
  PointScatter scatter;                  ///< mean and covariance in the order of kInjectionMetrics
  std::vector<Containment> containment;  ///< of the ellipsoids; empty if the covariance is singular
};

/// None with fewer than two injections.
std::optional<InjectionSummary> SummarizeInjection(const CaseColumns& cases);

}  // namespace dispersa
