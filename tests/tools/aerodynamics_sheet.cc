#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "core/campaign_yaml/load.h"
#include "core/math/constants.h"
#include "core/vehicle/aerodynamics_build_up.h"
#include "tests/public_launcher.h"
#include "tests/tools/sheets.h"

namespace dispersa {
namespace {

using Column = std::vector<double>;

constexpr double kTopMach = 10.0;
constexpr double kIncidence_deg = 2.0;  // at which the public slopes and centres of pressure are taken

struct Curves {
  Column mach, ca, cn_slope, xcp_lengths;
};

Curves Of(const AeroTable& table, double length_m) {
  constexpr int kPoints = 400;
  Curves curves;
  const auto at = [&](const Column& values, double mach, double incidence_deg) {
    return Table2D{table.mach, table.incidence_rad, values}(mach, incidence_deg * kRadPerDeg);
  };
  for (int i = 0; i <= kPoints; ++i) {
    const double mach = kTopMach * i / kPoints;
    curves.mach.push_back(mach);
    curves.ca.push_back(at(table.ca, mach, 0.0));
    curves.cn_slope.push_back(at(table.cn, mach, kIncidence_deg) / (kIncidence_deg * kRadPerDeg));
    curves.xcp_lengths.push_back(at(table.xcp_station_m, mach, kIncidence_deg) / length_m);
  }
  return curves;
}

Curves Public(const std::string& data, double top_mach) {
  Curves curves;
  for (const PublicAeroRow& row : ReadPublicAero(data + "/aero", "slv_cadac_derived_stability.csv", "slv3")) {
    if (row.at("mach") > top_mach) continue;
    curves.mach.push_back(row.at("mach"));
    curves.ca.push_back(row.at("CA0_power_on"));
    curves.cn_slope.push_back(row.at("CN_alpha_per_rad_0_2deg"));
    curves.xcp_lengths.push_back(row.at("xcp_from_nose_m") / kPublicLauncherLength_m);
  }
  return curves;
}

struct Panels {
  ChartAxis mach{.label = "Mach number", .low = 0.0, .high = kTopMach};
  SvgChart ca = PanelChart(mach, {.label = "axial force CA at zero incidence, power on", .low = 0.0});
  SvgChart slope = PanelChart(mach, {.label = "normal force slope, 1/rad (0 to 2°)", .low = 0.0});
  SvgChart xcp =
      PanelChart(mach, {.label = "centre of pressure from the nose, lengths (2°)", .low = 0.0, .high = 0.8});

  void Line(const Curves& c, const std::string& style, const std::string& legend) {
    ca.Line(c.mach, c.ca, style, legend);
    slope.Line(c.mach, c.cn_slope, style, legend);
    xcp.Line(c.mach, c.xcp_lengths, style, legend);
  }
  void Points(const Curves& c, const std::string& legend) {
    ca.Points(c.mach, c.ca, "public", legend);
    slope.Points(c.mach, c.cn_slope, "public", legend);
    xcp.Points(c.mach, c.xcp_lengths, "public", legend);
  }
};

}  // namespace

std::string AerodynamicsTable(const std::string& data) {
  const AeroTable table = PublicLauncherBuildUp();
  const Curves theirs = Public(data, 20.0);
  const auto at = [&](const Column& values, double mach, double incidence_deg) {
    return Table2D{table.mach, table.incidence_rad, values}(mach, incidence_deg * kRadPerDeg);
  };
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::array<double, 3> low{kInfinity, kInfinity, kInfinity}, high{-kInfinity, -kInfinity, -kInfinity};
  for (std::size_t i = 0; i < theirs.mach.size(); ++i) {
    const double mach = theirs.mach[i];
    const double slope = at(table.cn, mach, kIncidence_deg) / (kIncidence_deg * kRadPerDeg);
    const double xcp = at(table.xcp_station_m, mach, kIncidence_deg) / kPublicLauncherLength_m;
    const std::array<double, 3> percent = {100.0 * (at(table.ca, mach, 0.0) / theirs.ca[i] - 1.0),
                                           100.0 * (slope / theirs.cn_slope[i] - 1.0),
                                           100.0 * (xcp - theirs.xcp_lengths[i])};
    for (std::size_t k = 0; k < percent.size(); ++k) {
      low[k] = std::min(low[k], percent[k]);
      high[k] = std::max(high[k], percent[k]);
    }
  }
  const std::array<const char*, 3> names = {"CA at zero incidence, power on, relative",
                                            "normal force slope, 0 to 2°, relative",
                                            "centre of pressure at 2°, of the length, aft"};
  std::string text = "| build-up less public table, Mach 0.05 to 20 | least | largest |\n|---|---|---|\n";
  for (std::size_t k = 0; k < names.size(); ++k)
    text += fmt::format("| {} | {:+.1f} % | {:+.1f} % |\n", names[k], low[k], high[k]);
  return text;
}

FigureSheet AerodynamicsSheet(const std::string& campaigns, const std::string& data) {
  const Vehicle vehicle = LoadVehicle(campaigns + "/vehicles/slv4.yaml");
  const std::vector<AeroTable> tables = BuildAerodynamics(vehicle);
  const Curves theirs = Public(data, kTopMach);

  Panels stacks;
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const std::string first = std::to_string(i + 1);
    stacks.Line(
        Of(tables[i], vehicle.stages[i].bottom_station_m), "line-" + std::to_string(i),
        i + 1 < tables.size() ? "stages " + first + "-" + std::to_string(tables.size()) : "stage " + first);
  }
  stacks.Points(theirs, "public launcher");
  Panels rebuilt;
  rebuilt.Line(Of(PublicLauncherBuildUp(), kPublicLauncherLength_m), "line-0",
               "build-up on the rebuilt body");
  rebuilt.Points(theirs, "public table (DATCOM)");

  return {.title = "Aerodynamics: the stacks of slv4 (left), the public launcher rebuilt (right)",
          .panels = {
              {stacks.ca,
               "CA of each stack on the cross-section of its lowest stage, and of a public three-stage "
               "launcher of another size and shape: shape and magnitude, not equality."},
              {rebuilt.ca,
               "The build-up on a body rebuilt from the public launcher's masses and inertias, against its "
               "own table."},
              {stacks.slope, "Slope of the normal force. Slender-body theory gives 2 on the base area."},
              {rebuilt.slope, "Slope of the normal force of the rebuilt body."},
              {stacks.xcp,
               "Centre of pressure in lengths of the stack. The public launcher is 8 diameters long and has "
               "a fairing, slv4 21 with a slender nose."},
              {rebuilt.xcp, "Centre of pressure of the rebuilt body."}}};
}

}  // namespace dispersa
