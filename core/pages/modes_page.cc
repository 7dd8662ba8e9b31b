#include "core/pages/modes_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/math/constants.h"
#include "core/pages/html_parts.h"
#include "core/pages/svg_chart.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

/// Number of line colours in the style sheet.
constexpr std::size_t kColours = 4;
constexpr char kMoreStyle[] = "svg .empty { stroke-dasharray: 5 3; }";

std::string LineStyle(std::size_t mode) { return fmt::format("line-{}", mode % kColours); }

/// "y, z" if both planes are equal, else the plane's own name.
std::string PlaneText(const StackModes& stack, std::size_t plane) {
  return stack.axisymmetric ? "y, z" : plane == 0 ? "y" : "z";
}

std::size_t PlanesOf(const StackModes& stack) { return stack.axisymmetric ? 1 : 2; }

std::string FrequencyFigure(const StackModes& stack, std::size_t plane) {
  SvgChart chart({.label = "propellant left, kg"}, {.label = "frequency, Hz", .low = 0.0});
  const std::vector<BendingLevel>& levels = stack.levels[plane];
  for (std::size_t mode = 0; mode < levels.front().modes.size(); ++mode) {
    std::vector<double> propellant_kg, frequency_hz;
    for (const BendingLevel& level : levels) {
      propellant_kg.push_back(level.propellant_kg);
      frequency_hz.push_back(level.modes[mode].frequency_rad_s / kTwoPi);
    }
    chart.Line(propellant_kg, frequency_hz, LineStyle(mode), fmt::format("mode {}", mode + 1));
  }
  const std::string caption =
      fmt::format("Frequencies in plane {}; the burn runs from right to left.", PlaneText(stack, plane));
  return Figure(chart.Svg(caption), HtmlText(caption));
}

std::string ShapeFigure(const Vehicle& vehicle, const StackModes& stack, std::size_t plane) {
  constexpr std::size_t kModesShown = 4;
  SvgChart chart({.label = "station aft of the nose tip, m"},
                 {.label = "deflection", .low = -1.05, .high = 1.05});
  const BendingLevel& full = stack.levels[plane].front();
  const BendingLevel& empty = stack.levels[plane].back();
  chart.Mark(vehicle.stages[static_cast<std::size_t>(stack.stage)].gimbal.pivot_station_m, "pivot");
  for (std::size_t mode = 0; mode < std::min(kModesShown, full.modes.size()); ++mode) {
    const auto line = [&](const BendingMode& m, const std::string& style, const std::string& legend) {
      // A shape is smooth between the nodes. A few more points make the curve look smooth.
      std::vector<double> station_m, deflection;
      const std::vector<double>& nodes = stack.station_m[plane];
      for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
        for (const double part : {0.0, 0.5}) station_m.push_back(nodes[i] + part * (nodes[i + 1] - nodes[i]));
      }
      station_m.push_back(nodes.back());
      for (const double station : station_m)
        deflection.push_back(ShapeOf(stack, kBeamPlanes[plane], m, station).deflection);
      chart.Line(station_m, deflection, style, legend);
    };
    line(empty.modes[mode], LineStyle(mode) + " empty", "");
    line(full.modes[mode], LineStyle(mode), fmt::format("mode {}", mode + 1));
  }
  const std::string caption = fmt::format("Shapes in plane {}; dashed: burnt out.", PlaneText(stack, plane));
  return Figure(chart.Svg(caption), HtmlText(caption));
}

std::string TableOfModes(const Vehicle& vehicle, const StackModes& stack) {
  const std::vector<BeamSensor> places = ShownStations(vehicle, stack.stage);
  std::vector<HtmlTable::Column> columns = {{"Propellant, kg", true},
                                            {"mode", true},
                                            {"plane"},
                                            {"frequency, Hz", true},
                                            {"generalised mass, kg", true}};
  for (const BeamSensor& place : places)
    columns.push_back(
        {fmt::format("{}, {} m: deflection, slope 1/m", HtmlText(place.name), ReadableText(place.station_m)),
         true});
  HtmlTable table(columns);
  for (std::size_t plane = 0; plane < PlanesOf(stack); ++plane) {
    const std::vector<BendingLevel>& levels = stack.levels[plane];
    for (std::size_t k = 0; k < levels.size(); k += std::max<std::size_t>(levels.size() - 1, 1)) {
      const BendingLevel& level = levels[k];  // the first and the last
      for (std::size_t mode = 0; mode < level.modes.size(); ++mode) {
        const BendingMode& m = level.modes[mode];
        std::vector<std::string> cells = {ReadableText(level.propellant_kg), std::to_string(mode + 1),
                                          PlaneText(stack, plane), FixedText(m.frequency_rad_s / kTwoPi, 3),
                                          ReadableText(m.generalized_mass_kg)};
        for (const BeamSensor& place : places) {
          const StationShape at = ShapeOf(stack, kBeamPlanes[plane], m, place.station_m);
          cells.push_back(FixedText(at.deflection, 3) + ", " + FixedText(at.slope_1_m, 4));
        }
        table.Row(cells);
      }
    }
  }
  return table.Html();
}

}  // namespace

std::string BeamText(const StructureBeam& beam) {
  if (!beam.table.empty()) return "Modes of a finite-element model, from the vehicle's table";
  return fmt::format("Free beam by {}, {} rotary inertia",
                     beam.timoshenko ? "Timoshenko's theory" : "Euler's and Bernoulli's theory",
                     beam.rotary_inertia ? "with" : "without");
}

std::string MeshText(const StackModes& stack, std::size_t plane) {
  if (!stack.basis) return "";
  return fmt::format("{} elements; twice as long, they change no mode by more than {:.2g} %",
                     stack.station_m[plane].size() - 1, 100.0 * stack.mesh_difference[plane]);
}

std::string ModesPage(const Vehicle& vehicle, const std::vector<StackModes>& stacks) {
  const std::string title = vehicle.name + ": bending modes";
  std::string page =
      PageHead(title, title, kMoreStyle) + "<main>\n<h1>" + HtmlText(title) + "</h1>\n<p>" +
      HtmlText(BeamText(*vehicle.structure_beam)) +
      ". Deflections are scaled to a largest of 1; a slope is the rotation of the cross-section by the "
      "station, which grows aft. A mode is the same one at every propellant level, by the modal "
      "assurance criterion with the mass as weight.</p>\n";
  for (const StackModes& stack : stacks) {
    const bool is_last = LastBurn(vehicle, stack.stage) + 1 == static_cast<int>(vehicle.stages.size());
    page += fmt::format("<h2>Stack of {}{}{}</h2>\n<div class=\"figures\">\n",
                        HtmlText(vehicle.stages[static_cast<std::size_t>(stack.stage)].name),
                        is_last ? "" : " and all above", HtmlText(WithoutText(vehicle, stack)));
    for (std::size_t plane = 0; plane < PlanesOf(stack); ++plane)
      page += ShapeFigure(vehicle, stack, plane) + FrequencyFigure(stack, plane);
    page += "</div>\n" + TableOfModes(vehicle, stack);
    for (std::size_t plane = 0; plane < PlanesOf(stack); ++plane)
      if (const std::string mesh = MeshText(stack, plane); !mesh.empty())
        page += fmt::format("<p>Plane {}: {}.</p>\n", PlaneText(stack, plane), mesh);
  }
  return page + "</main>\n</body>\n</html>\n";
}

}  // namespace dispersa
