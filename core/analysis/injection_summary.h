// How the injections of the completed flights scatter in altitude, velocity and flight path angle together.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/results/case_columns.h"
#include "core/statistics/point_scatter.h"

namespace dispersa {

/// The coordinates: geodetic altitude, inertial velocity, inertial flight path angle, as the metrics' units
/// have them.
inline constexpr std::array<const char*, 3> kInjectionMetrics = {
    "injection_altitude_km", "injection_velocity_m_s", "injection_flight_path_angle_deg"};

struct InjectionSummary {
  PointScatter scatter;                  ///< mean and covariance in the order of kInjectionMetrics
  std::vector<Containment> containment;  ///< of the ellipsoids; none where the covariance is singular
};

/// None of fewer than two injections.
std::optional<InjectionSummary> SummarizeInjection(const CaseColumns& cases);

}  // namespace dispersa
