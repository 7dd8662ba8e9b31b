#include "core/vehicle/plausibility.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/math/assertion.h"
#include "core/vehicle/mould_line.h"
#include "core/vehicle/plausibility_checks.h"

namespace dispersa {
namespace plausibility {

double WidestDiameter(const Vehicle& vehicle, double top_m, double bottom_m) {
  constexpr int kSamples = 64;  // sections are far longer than a 64th of a grain
  double widest_m = 0.0;
  if (vehicle.profile.empty()) return widest_m;
  for (const MouldSection& section : CutMouldLine(vehicle.profile, vehicle.stages[0].bottom_station_m)) {
    for (int k = 0; k <= kSamples; ++k) {
      const double station_m = top_m + (bottom_m - top_m) * k / kSamples;
      if (station_m >= section.start_m && station_m <= section.end_m)
        widest_m = std::max(widest_m, 2.0 * section.Radius(station_m));
    }
  }
  return widest_m;
}

namespace {

std::string Readable(double value) {
  char text[32];
  std::snprintf(text, sizeof text, std::fabs(value) >= 1e4 && std::fabs(value) < 1e9 ? "%.0f" : "%.4g",
                value);
  return text;
}

std::string SpanText(const Span& span, const std::string& unit) {
  const std::string end = unit.empty() ? "" : " " + unit;
  if (!(span.high < kAny)) return Readable(span.low) + end + " or more";
  if (!(span.low > -kAny)) return "up to " + Readable(span.high) + end;
  if (span.low == 0.0) return "up to " + Readable(span.high) + end;
  return Readable(span.low) + " to " + Readable(span.high) + end;
}

// A column of an aerodynamic table, and its name in the yaw plane.
struct ColumnOfPlanes {
  const char* field;
  const char* in_yaw_plane;
};
constexpr ColumnOfPlanes kColumnsOfPlanes[] = {
    {"table.incidence_deg", "table.beta_deg"},           {"table.ca", "table.ca"},
    {"table.ca_power_off", "table.ca_power_off"},        {"table.cn", "table.cy"},
    {"table.xcp_station_m", "table.xcp_side_station_m"}, {"table.cmq_per_rad", "table.cnr_per_rad"}};
const char* InYawPlane(const Check& check) {
  for (const ColumnOfPlanes& column : kColumnsOfPlanes)
    if (std::string(column.field) == check.field) return column.in_yaw_plane;
  return nullptr;
}

// A thrust curve or an engine replaces the key of the thrust.
std::string PathOf(const Check& check, const Subject& subject) {
  const std::string field = subject.of_yaw_plane ? InYawPlane(check) : check.field;
  if (field == "table.xcp_side_station_m" && subject.table().is_by_moment) return "table.cln";
  if (field == "table.xcp_station_m" && subject.table().is_by_moment) return "table.cm";
  if (field == "gimbal.pivot_station_m" && subject.stage().gimbal.fixed) return "nozzle_station_m";
  if (field != "motor.thrust_n") return field;
  if (subject.stage().is_liquid()) return "motor.liquid.thrust_n";
  return subject.stage().motor.thrust_curve.empty() ? field : "motor.thrust_curve";
}

void Apply(std::span<const Check> checks, const Subject& subject, const std::string& prefix,
           std::vector<PlausibilityFinding>& findings) {
  for (const Check& check : checks) {
    if (subject.of_yaw_plane && InYawPlane(check) == nullptr) continue;  // the same as of the pitch plane
    const double value = check.value(subject);
    if (std::isnan(value)) continue;
    const bool beyond = !check.spans.possible.Holds(value);
    if (!beyond && check.spans.usual.Holds(value)) continue;
    const bool impossible = beyond && !subject.vehicle.made_up;
    const std::string unit = check.unit;
    findings.push_back(
        {prefix + PathOf(check, subject),
         std::string(check.implies) + " " + Readable(value) + (unit.empty() ? "" : " " + unit) +
             (impossible ? ", which cannot be" : ""),
         SpanText(impossible ? check.spans.possible : check.spans.usual, unit) + " (" + check.source + ")",
         impossible});
  }
}

}  // namespace
}  // namespace plausibility

std::vector<PlausibilityFinding> Plausibility(const Vehicle& vehicle) {
  using namespace plausibility;
  DISPERSA_ASSERT(!vehicle.stages.empty());
  const std::vector<StageFigures> figures = FiguresOf(vehicle);
  std::vector<PlausibilityFinding> findings;
  std::size_t body = 0;
  for (std::size_t i = 0; i < vehicle.stages.size(); ++i) {
    if (!vehicle.stages[i].restarts) body = i;
    // The last burn has what the body jettisons; the file has it where the body is.
    for (std::size_t k = 0; k < vehicle.stages[i].jettisoned.size(); ++k)
      Apply(JettisonChecks(), {vehicle, figures, i, k},
            "stages[" + std::to_string(body) + "].jettisoned[" + std::to_string(k) + "].", findings);
    const std::string index = "[" + std::to_string(i) + "].";
    Apply(CutOffChecks(), {vehicle, figures, i},
          "stages" + index + (vehicle.stages[i].restarts ? "cut_off." : "motor.liquid.cut_off."), findings);
    if (vehicle.stages[i].restarts) continue;  // the same body
    Apply(StageChecks(), {vehicle, figures, i}, "stages" + index, findings);
    Apply(PressureChecks(), {vehicle, figures, i}, "stages" + index + "motor.", findings);
    Apply(GimbalChecks(), {vehicle, figures, i}, "stages" + index + "gimbal.", findings);
    for (std::size_t k = 0; k < vehicle.stages[i].fins.size(); ++k)
      Apply(FinChecks(), {vehicle, figures, i, k}, "stages" + index + "fins[" + std::to_string(k) + "].",
            findings);
    for (std::size_t k = 0; k < vehicle.stages[i].tanks.size(); ++k) {
      const std::string tank = "stages" + index + "tanks[" + std::to_string(k) + "].";
      Apply(TankChecks(), {vehicle, figures, i, k}, tank, findings);
      Apply(TankInStageChecks(), {vehicle, figures, i, k}, tank, findings);
    }
    if (vehicle.stages[i].gimbal.nozzle_mass_kg > 0.0)
      Apply(NozzleChecks(), {vehicle, figures, i}, "nozzles" + index, findings);
  }
  for (std::size_t i = 0; i < vehicle.aerodynamics.size(); ++i)
    for (std::size_t k = 0; k <= vehicle.aerodynamics[i].lighter.size(); ++k) {
      const Subject pitch{vehicle, figures, i, k};
      const std::string prefix = "aerodynamics.tables[" + std::to_string(i) + "]." +
                                 (k == 0 ? "" : "lighter[" + std::to_string(k - 1) + "].");
      Apply(AeroChecks(), pitch, prefix, findings);
      if (!pitch.table().yaw_plane.empty())
        Apply(AeroChecks(), {vehicle, figures, i, k, false, true}, prefix, findings);
    }
  for (std::size_t i = 0; i < vehicle.sensors.rate_gyros.size(); ++i)
    Apply(GyroChecks(), {vehicle, figures, i}, "sensors.rate_gyros[" + std::to_string(i) + "].", findings);
  for (std::size_t k = 0; k < vehicle.boosters.tanks.size(); ++k)
    Apply(TankChecks(), {vehicle, figures, 0, k, true}, "boosters.tanks[" + std::to_string(k) + "].",
          findings);
  if (vehicle.boosters.count > 0) {
    const Subject boosters{vehicle, figures, 0, 0, true};
    Apply(PressureChecks(), boosters, "boosters.motor.", findings);
    Apply(GimbalChecks(), boosters, "boosters.gimbal.", findings);
  }
  Apply(VehicleChecks(), {vehicle, figures}, "", findings);
  return findings;
}

}  // namespace dispersa
