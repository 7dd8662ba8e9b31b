// Closed-loop guidance compared with open-loop flight, for motors that are weaker or stronger than nominal.
// SLV-4 on the reference with a reserve of 60 m/s, with the specific impulse of one stage changed at a time.
#pragma once

#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa {

/// The orbit reached by a flight, altitudes above the equatorial radius.
struct ReachedOrbit {
  double velocity_error_m_s = 0.0;
  double axis_km = 0.0, target_axis_km = 0.0;  ///< semi-major axes; the target is circular
  double perigee_km = 0.0;
  double inclination_error_deg = 0.0;
  double excess_m_s = 0.0;  ///< turned away, as planned at ignition
  bool converged = false;
};

struct ReachCase {
  int stage = 0;  ///< from 0
  double percent = 0.0;
  ReachedOrbit open, closed;
  double axis_below_km =
      0.0;  ///< by how much closed loop's is below the lower of open loop's and the target's
  double perigee_below_km = 0.0;  ///< likewise
  double allowed_km = 0.0;
  bool only_axis = false;  ///< open loop does not orbit: energy alone is compared

  bool IsMet() const { return axis_below_km <= allowed_km && (only_axis || perigee_below_km <= allowed_km); }
};

inline ReachedOrbit ReachedBy(const FlightResult& flight) {
  ReachedOrbit orbit;
  orbit.velocity_error_m_s = MetricOf(flight, "injection_velocity_error_m_s");
  orbit.perigee_km = MetricOf(flight, "perigee_km");
  orbit.axis_km = 0.5 * (MetricOf(flight, "apogee_km") + orbit.perigee_km);
  orbit.target_axis_km = orbit.axis_km - MetricOf(flight, "semi_major_axis_error_km");
  orbit.inclination_error_deg = MetricOf(flight, "inclination_error_deg");
  orbit.excess_m_s = MetricOf(flight, "guidance_excess_velocity_m_s");
  orbit.converged = MetricOf(flight, "guidance_converged") == 1.0;
  return orbit;
}

/// Every stage at each of the percentages.
inline std::vector<ReachCase> FlyReach(const std::vector<double>& percentages) {
  FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS, "adaptive_fuzzy", "slv4_500km_reserve");
  const FlightModel open(definition);
  definition.guidance.closed_loop = true;
  const FlightModel closed(definition);
  const int stages = static_cast<int>(definition.vehicle.stages.size());
  std::vector<ReachCase> cases;
  for (int stage = 0; stage < stages; ++stage) {
    for (const double percent : percentages) {
      FlightInputs inputs;
      inputs.stages[static_cast<std::size_t>(stage)].specific_impulse_factor = 1.0 + 0.01 * percent;
      ReachCase each{stage, percent, ReachedBy(Fly(open, inputs)), ReachedBy(Fly(closed, inputs))};
      each.axis_below_km = std::fmin(each.open.axis_km, each.closed.target_axis_km) - each.closed.axis_km;
      each.perigee_below_km =
          std::fmin(each.open.perigee_km, each.closed.target_axis_km) - each.closed.perigee_km;
      // A reserve that is spent before the last motor's estimate stands is not had back.
      each.allowed_km = stage == stages - 1 ? 20.0 : 5.0;
      each.only_axis = each.open.perigee_km < 120.0;
      cases.push_back(each);
    }
  }
  return cases;
}

inline void PrintReach(const std::vector<ReachCase>& cases) {
  std::printf(
      "stage  Isp, %% |  open loop: dv, m/s  axis, km  perigee, km | closed loop: dv, m/s  axis, km  "
      "perigee, km"
      "  inclination, deg  turned away, m/s  converged | below, km: axis  perigee\n");
  int missed = 0;
  double worst_km = 0.0;
  for (const ReachCase& each : cases) {
    std::printf(
        "%5d %7.1f | %19.1f %9.1f %12.1f | %20.2f %9.1f %12.1f %17.3f %17.1f %10d | %15.1f %8.1f%s%s\n",
        each.stage + 1, each.percent, each.open.velocity_error_m_s, each.open.axis_km, each.open.perigee_km,
        each.closed.velocity_error_m_s, each.closed.axis_km, each.closed.perigee_km,
        each.closed.inclination_error_deg, each.closed.excess_m_s, each.closed.converged ? 1 : 0,
        each.axis_below_km, each.perigee_below_km, each.only_axis ? "  (axis only)" : "",
        each.IsMet() ? "" : "  MISSED");
    missed += each.IsMet() ? 0 : 1;
    worst_km = std::fmax(worst_km, each.axis_below_km);
    if (!each.only_axis) worst_km = std::fmax(worst_km, each.perigee_below_km);
  }
  std::printf("%d of %d missed, worst %.1f km below\n", missed, static_cast<int>(cases.size()), worst_km);
}

inline void ExpectReach(const std::vector<ReachCase>& cases) {
  for (const ReachCase& each : cases) {
    SCOPED_TRACE("stage " + std::to_string(each.stage + 1) + ", " + std::to_string(each.percent) + " %");
    EXPECT_LE(each.axis_below_km, each.allowed_km);
    if (!each.only_axis) {
      EXPECT_LE(each.perigee_below_km, each.allowed_km);
    }
    // It says that it arrives when it does: 1 m/s is 2 km of axis.
    if (each.closed.converged) {
      EXPECT_LT(std::fabs(each.closed.axis_km - each.closed.target_axis_km), 2.0);
      EXPECT_LT(std::fabs(each.closed.inclination_error_deg), 0.05);
    }
  }
}

}  // namespace dispersa
