#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "core/environment/atmosphere.h"
#include "tests/tools/sheets.h"
#include "tests/unit/read_csv.h"

namespace dispersa {
namespace {

using Column = std::vector<double>;
using Rows = std::vector<std::vector<double>>;

struct Curve {
  Column altitude_km;
  Column value;
};

Curve Ours(double low_km, double high_km, const std::function<double(const AirState&)>& value) {
  constexpr int kPoints = 600;
  Curve curve;
  for (int i = 0; i <= kPoints; ++i) {
    const double km = low_km + (high_km - low_km) * i / kPoints;
    curve.altitude_km.push_back(km);
    curve.value.push_back(value(StandardAtmosphere1976(1e3 * km)));
  }
  return curve;
}

// Every `stride`-th row whose altitude (column 0, in units of `km`) is in the range.
Curve Points(const Rows& rows, std::size_t column, double km, double low_km, double high_km,
             std::size_t stride = 1) {
  Curve curve;
  for (std::size_t i = 0; i < rows.size(); i += stride) {
    const double at_km = rows[i][0] * km;
    if (at_km < low_km || at_km > high_km) continue;
    curve.altitude_km.push_back(at_km);
    curve.value.push_back(rows[i][column]);
  }
  return curve;
}

// Altitude upwards, as the standard draws it.
void Line(SvgChart& chart, Curve curve, const std::string& style, const std::string& legend) {
  chart.Line(std::move(curve.value), std::move(curve.altitude_km), style, legend);
}
void Dots(SvgChart& chart, Curve curve, const std::string& style, const std::string& legend) {
  chart.Points(std::move(curve.value), std::move(curve.altitude_km), style, legend);
}

double Temperature(const AirState& air) { return air.temperature_k; }
double Pressure(const AirState& air) { return air.pressure_pa; }
double Density(const AirState& air) { return air.density_kg_m3; }
double SpeedOfSound(const AirState& air) { return air.speed_of_sound_m_s; }

// Ours over theirs less 1, in per cent.
Curve Deviation(const Rows& rows, std::size_t column, double km,
                const std::function<double(const AirState&)>& value) {
  Curve curve;
  for (const auto& row : rows) {
    curve.altitude_km.push_back(row[0] * km);
    curve.value.push_back(100.0 * (value(StandardAtmosphere1976(1e3 * km * row[0])) / row[column] - 1.0));
  }
  return curve;
}

constexpr double kMetre = 1e-3;  // the grid's altitudes are in metres

struct References {
  Rows grid, nodes, between;
};

References Read(const std::string& data) {
  References r{ReadCsv(data + "/us76/grid_0_80km.csv"), ReadCsv(data + "/us76/us76_nodes_0_1000km.csv"),
               ReadCsv(data + "/us76/upper_integrated.csv")};
  for (auto& node : r.nodes) {
    if (node[0] != 86.0) continue;
    // The file's temperature at 86 km is molecular-scale, and its density follows from it.
    const double kinetic = node[2] / 28.9644;
    node[1] *= kinetic;
    node[4] /= kinetic;
  }
  return r;
}

}  // namespace

std::string AtmosphereTable(const std::string& data) {
  const auto [grid, nodes, between] = Read(data);
  const auto largest = [](const Curve& curve) {
    double worst = 0.0;
    for (const double percent : curve.value) worst = std::max(worst, 0.01 * std::fabs(percent));
    return fmt::format("{:.1e}", worst);
  };
  const auto row = [&](const char* name, const Rows& rows, double km, std::size_t p, std::size_t rho) {
    return fmt::format("| {} | {} | {} | {} |\n", name, largest(Deviation(rows, 1, km, Temperature)),
                       largest(Deviation(rows, p, km, Pressure)), largest(Deviation(rows, rho, km, Density)));
  };
  return "| reference | temperature | pressure | density |\n|---|---|---|---|\n" +
         row("python3-fluids, 0 to 80 km every km (9 digits)", grid, kMetre, 2, 3) +
         row("the standard's tables, 49 nodes, 0 to 1000 km (5 digits)", nodes, 1.0, 3, 4) +
         row("the standard's equations integrated, midway between the nodes, 88.5 to 975 km", between, 1.0, 3,
             4);
}

FigureSheet AtmosphereSheet(const std::string& data) {
  const auto [grid, nodes, between] = Read(data);
  constexpr double kLow_km = -5.0, kMiddle_km = 120.0, kSoundTop_km = 86.0, kTop_km = 1000.0;
  const ChartAxis low{.label = "geometric altitude, km", .low = -10.0, .high = 120.0};
  const ChartAxis whole{.label = "geometric altitude, km", .low = -50.0, .high = 1000.0};
  FigureSheet sheet{.title = "US Standard Atmosphere 1976, -5 to 1000 km", .panels = {}};

  SvgChart temperature = PanelChart({.label = "kinetic temperature, K"}, low);
  Line(temperature, Ours(kLow_km, kMiddle_km, Temperature), "line-0", "dispersa");
  Dots(temperature, Points(grid, 1, kMetre, 0.0, 80.0, 5), "dots-1", "python3-fluids, every 5 km");
  Dots(temperature, Points(nodes, 1, 1.0, 81.0, kMiddle_km), "public", "table of the standard");
  sheet.panels.push_back({temperature, "Temperature to 120 km."});

  SvgChart sound = PanelChart({.label = "speed of sound, m/s"}, low);
  Line(sound, Ours(kLow_km, kSoundTop_km, SpeedOfSound), "line-0", "dispersa");
  Dots(sound, Points(grid, 4, kMetre, 0.0, 80.0, 5), "dots-1", "python3-fluids, every 5 km");
  sheet.panels.push_back({sound, "Speed of sound; the standard prints none above 86 km."});

  SvgChart upper = PanelChart({.label = "kinetic temperature, K"}, whole);
  Line(upper, Ours(kLow_km, kTop_km, Temperature), "line-0", "dispersa");
  Dots(upper, Points(nodes, 1, 1.0, 0.0, kTop_km), "public", "table of the standard");
  sheet.panels.push_back({upper, "Temperature to 1000 km."});

  SvgChart pressure =
      PanelChart({.label = "pressure, Pa", .low = 1e-9, .high = 1e6, .logarithmic = true}, whole);
  Line(pressure, Ours(kLow_km, kTop_km, Pressure), "line-0", "dispersa");
  Dots(pressure, Points(nodes, 3, 1.0, 0.0, kTop_km), "public", "table of the standard");
  sheet.panels.push_back({pressure, "Pressure."});

  SvgChart density =
      PanelChart({.label = "density, kg/m³", .low = 1e-15, .high = 10.0, .logarithmic = true}, whole);
  Line(density, Ours(kLow_km, kTop_km, Density), "line-0", "dispersa");
  Dots(density, Points(nodes, 4, 1.0, 0.0, kTop_km), "public", "table of the standard");
  sheet.panels.push_back({density, "Density."});

  SvgChart deviation =
      PanelChart({.label = "dispersa over reference - 1, %", .low = -0.1, .high = 0.1}, whole);
  Dots(deviation, Deviation(nodes, 3, 1.0, Pressure), "public", "p, table (5 digits)");
  Dots(deviation, Deviation(nodes, 4, 1.0, Density), "dots-0", "density, table");
  Dots(deviation, Deviation(between, 3, 1.0, Pressure), "dots-1", "p, integrated");
  Dots(deviation, Deviation(between, 4, 1.0, Density), "dots-2", "density, integrated");
  sheet.panels.push_back(
      {deviation,
       "Deviation from the standard's tables at their nodes, and from an integration of its "
       "equations midway between the nodes above 86 km."});
  return sheet;
}

}  // namespace dispersa
