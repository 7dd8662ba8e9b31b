#include "core/pages/vehicle_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/math/assertion.h"
#include "core/math/functions.h"
#include "core/results/text.h"
#include "core/vehicle/mass.h"
#include "core/vehicle/mould_line.h"

namespace dispersa {
namespace {

constexpr double kLength_px = 1080.0;  ///< length of the vehicle
constexpr double kMargin_px = 60.0;
constexpr double kAbove_px = 78.0;   ///< room for the names of stages and sensors
constexpr double kBelow_px = 132.0;  ///< room for dimensions, scale and legend

constexpr char kStyle[] =
    "text{font:13px 'DejaVu Sans','Liberation "
    "Sans',sans-serif;fill:#1a2230}.soft{fill:#5b6675;font-size:12px}"
    ".body{fill:#f5f7fa;stroke:#1a2230;stroke-width:1.4}.grain{fill:#f0c9a4;stroke:#c8621b;stroke-width:.8}"
    ".bore{fill:#f5f7fa;stroke:#c8621b;stroke-width:.6}.part{fill:none;stroke:#1f5fa8;stroke-width:.7;"
    "stroke-dasharray:3 2}.cut{stroke:#5b6675;stroke-width:.8;stroke-dasharray:5 4}.rule{stroke:#5b6675;"
    "stroke-width:.8}.hinge{stroke:#1a2230;stroke-width:2.2}.cg{fill:#b3242a}.cg-empty{fill:#fff;stroke:#"
    "b3242a;"
    "stroke-width:1.5}.sensor{fill:#1e7a3c}.axis{stroke:#5b6675;stroke-width:.6;stroke-dasharray:12 3 2 3}";

class Drawing {
 public:
  Drawing(const Vehicle& vehicle, bool has_words) : vehicle_(vehicle), has_words_(has_words) {
    length_m_ = vehicle.stages[0].bottom_station_m;
    scale_ = kLength_px / length_m_;
    for (const Stage& stage : vehicle.stages) widest_m_ = std::max(widest_m_, stage.diameter_m);
    if (!vehicle.profile.empty()) body_ = CutMouldLine(vehicle.profile, length_m_);
    for (const MouldSection& section : body_)
      widest_m_ = std::max(widest_m_, 2.0 * std::max(section.fore_radius_m, section.aft_radius_m));
    axis_px_ = kAbove_px + 0.5 * widest_m_ * scale_;
    bottom_px_ = axis_px_ + 0.5 * widest_m_ * scale_;
  }

  std::string Svg() {
    DrawBody();
    for (std::size_t i = 0; i < vehicle_.stages.size(); ++i)
      if (!vehicle_.stages[i].restarts) DrawStage(i);  // one body, however often it burns
    DrawBoosters();
    DrawSensors();
    if (!has_words_) {
      const Boosters& b = vehicle_.boosters;
      const double reach_m =
          b.count == 0 ? 0.0 : std::max(0.0, b.radius_m + 0.5 * b.diameter_m - 0.5 * widest_m_);
      const double room_px = reach_m * scale_ + 36.0;  // dimensions stand below
      return fmt::format(
          "<svg class=\"vehicle\" viewBox=\"0 {:.0f} {:.0f} {:.0f}\" role=\"img\" aria-label=\"{}, {} m "
          "long, to "
          "scale\">{}</svg>\n",
          2.0 * axis_px_ - bottom_px_ - room_px, kLength_px + 2.0 * kMargin_px,
          2.0 * (bottom_px_ - axis_px_ + room_px), HtmlText(vehicle_.name), ReadableText(length_m_), svg_);
    }
    DrawScale();
    const double width = kLength_px + 2.0 * kMargin_px;
    const double height = bottom_px_ + kBelow_px;
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
        "height=\"{1:.0f}\" role=\"img\">\n<title>{2}, {3} m long, to scale</title>\n<style>{4}</style>\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n{5}</svg>\n",
        width, height, HtmlText(vehicle_.name), ReadableText(length_m_), kStyle, svg_);
  }

 private:
  double X(double station_m) const { return kMargin_px + station_m * scale_; }
  double Y(double radius_m) const { return axis_px_ - radius_m * scale_; }

  void Line(const char* style, double x1, double y1, double x2, double y2) {
    svg_ += fmt::format("<line class=\"{}\" x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\"/>\n",
                        style, x1, y1, x2, y2);
  }
  void Tube(const char* style, double top_m, double bottom_m, double diameter_m) {
    svg_ +=
        fmt::format("<rect class=\"{}\" x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\"/>\n",
                    style, X(top_m), Y(0.5 * diameter_m), (bottom_m - top_m) * scale_, diameter_m * scale_);
  }
  void Text(const char* style, double x, double y, const std::string& text, const char* anchor = "middle") {
    if (!has_words_) return;
    svg_ += fmt::format("<text class=\"{}\" x=\"{:.2f}\" y=\"{:.2f}\" text-anchor=\"{}\">{}</text>\n", style,
                        x, y, anchor, HtmlText(text));
  }
  void Dot(const char* style, double station_m, double radius_px) {
    svg_ += fmt::format("<circle class=\"{}\" cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{}\"/>\n", style, X(station_m),
                        axis_px_, radius_px);
  }

  // The outline runs up one side and back along the other.
  void DrawBody() {
    std::vector<std::pair<double, double>> line;
    for (const MouldSection& section : body_) {
      const int parts = section.IsCurved() ? 24 : 1;
      for (int k = 0; k <= parts; ++k) {
        const double station_m = section.start_m + (section.end_m - section.start_m) * k / parts;
        line.emplace_back(station_m, k == parts ? section.aft_radius_m : section.Radius(station_m));
      }
    }
    std::string points;
    for (const auto& [station_m, radius_m] : line)
      points += fmt::format("{:.2f},{:.2f} ", X(station_m), Y(radius_m));
    std::reverse(line.begin(), line.end());
    for (const auto& [station_m, radius_m] : line)
      points += fmt::format("{:.2f},{:.2f} ", X(station_m), Y(-radius_m));
    if (!points.empty()) svg_ += "<polygon class=\"body\" points=\"" + points + "\"/>\n";
    Line("axis", X(0.0) - 18.0, axis_px_, X(length_m_) + 18.0, axis_px_);
  }

  void DrawTanks(const std::vector<Tank>& tanks) {
    for (const Tank& tank : tanks) {
      const double height_m = (tank.bottom_station_m - tank.top_station_m) * tank.propellant_mass_kg /
                              (tank.density_kg_m3 * tank.Volume());
      Tube("bore", tank.top_station_m, tank.bottom_station_m, tank.diameter_m);
      Tube("grain", tank.bottom_station_m - height_m, tank.bottom_station_m, tank.diameter_m);
    }
  }

  // A side view shows each at its place to the right.
  void DrawBoosters() {
    const Boosters& b = vehicle_.boosters;
    if (b.count == 0) return;
    const double middle_px = axis_px_;
    for (const double angle_rad : b.angles_rad) {
      axis_px_ = middle_px + Cos(angle_rad) * b.radius_m * scale_;
      Tube("part", b.top_station_m, b.bottom_station_m, b.diameter_m);
      DrawTanks(b.tanks);
      if (b.is_liquid()) continue;
      Tube("grain", b.grain.top_station_m, b.grain.bottom_station_m, b.grain.outer_diameter_m);
      if (b.grain.inner_diameter_m > 0.0)
        Tube("bore", b.grain.top_station_m, b.grain.bottom_station_m, b.grain.inner_diameter_m);
    }
    axis_px_ = middle_px;
  }

  void DrawStage(std::size_t i) {
    const Stage& stage = vehicle_.stages[i];
    const std::size_t above = static_cast<std::size_t>(LastBurn(vehicle_, static_cast<int>(i))) + 1;
    const bool is_last = above == vehicle_.stages.size();
    const double top_m = is_last ? 0.0 : vehicle_.stages[above].bottom_station_m;
    DrawTanks(stage.tanks);
    if (!stage.is_liquid())
      Tube("grain", stage.grain.top_station_m, stage.grain.bottom_station_m, stage.grain.outer_diameter_m);
    if (!stage.is_liquid() && stage.grain.inner_diameter_m > 0.0)
      Tube("bore", stage.grain.top_station_m, stage.grain.bottom_station_m, stage.grain.inner_diameter_m);
    for (const MassElement& element : stage.structure)
      Tube("part", element.top_station_m, element.bottom_station_m, element.outer_diameter_m);
    const Gimbal& gimbal = stage.gimbal;
    std::vector<double> beside_m = {-gimbal.radius_m, 0.0, gimbal.radius_m};
    if (!gimbal.nozzles.empty()) beside_m.clear();
    for (const Nozzle& nozzle : NozzlesOf(gimbal)) beside_m.push_back(nozzle.y_m);
    for (const double at_m : beside_m) {
      const double y = Y(at_m);
      Line("hinge", X(gimbal.pivot_station_m), y - 4.0, X(gimbal.pivot_station_m), y + 4.0);
    }
    const StackMass stack = BuildStackMasses(vehicle_)[i];
    Dot("cg-empty", stack.At(0.0).cg_station_m, 4.0);
    Dot("cg", stack.At(stack.propellant_mass_kg).cg_station_m, 4.5);
    Text("soft", X(stack.At(stack.propellant_mass_kg).cg_station_m), axis_px_ - 8.0, std::to_string(i + 1));

    Line("cut", X(stage.bottom_station_m), kAbove_px - 24.0, X(stage.bottom_station_m), bottom_px_ + 40.0);
    const double middle_px = 0.5 * (X(top_m) + X(stage.bottom_station_m));
    Text("name", middle_px, 22.0, stage.name);
    Text("soft", middle_px, 38.0, ReadableText(stage.liftoff_mass_kg * 1e-3) + " t, with all stages ahead");
    const double rule_px = bottom_px_ + 30.0;
    Line("rule", X(top_m) + 2.0, rule_px, X(stage.bottom_station_m) - 2.0, rule_px);
    Text("soft", middle_px, rule_px + 16.0,
         fmt::format("{} m × ⌀ {} m", ReadableText(stage.bottom_station_m - top_m),
                     ReadableText(stage.diameter_m)));
    if (is_last) Line("cut", X(0.0), axis_px_, X(0.0), bottom_px_ + 40.0);
  }

  void DrawSensors() {
    const auto mark = [&](double station_m) {
      svg_ += fmt::format("<path class=\"sensor\" d=\"M{:.2f} {:.2f}l-5 -9h10z\"/>\n", X(station_m),
                          kAbove_px - 6.0);
    };
    if (vehicle_.sensors.inertial_unit_station_m > 0.0) mark(vehicle_.sensors.inertial_unit_station_m);
    for (const RateGyro& gyro : vehicle_.sensors.rate_gyros) mark(gyro.station_m);
  }

  // A bar of 1, 2 or 5 times a power of ten, about a fifth of the vehicle, and the legend.
  void DrawScale() {
    const double power = std::pow(10.0, std::floor(std::log10(0.2 * length_m_)));
    const double rest = 0.2 * length_m_ / power;
    const double bar_m = power * (rest >= 5.0 ? 5.0 : rest >= 2.0 ? 2.0 : 1.0);
    const double y = bottom_px_ + 84.0;
    Line("hinge", X(0.0), y, X(bar_m), y);
    for (const double end_m : {0.0, bar_m}) Line("rule", X(end_m), y - 5.0, X(end_m), y + 5.0);
    Text("soft", X(bar_m) + 10.0, y + 4.0, ReadableText(bar_m) + " m", "start");
    const double row = bottom_px_ + 112.0;
    double x = kMargin_px;
    const auto item = [&](const std::string& sign, const std::string& text) {
      svg_ += sign;
      Text("soft", x + 20.0, row + 4.0, text, "start");
      x += 34.0 + 7.2 * static_cast<double>(text.size());
    };
    const auto circle = [&](const char* style) {
      return fmt::format("<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4.5\"/>\n", style, x + 8.0,
                         row);
    };
    const auto box = [&](const char* style) {
      return fmt::format("<rect class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"14\" height=\"9\"/>\n", style,
                         x, row - 4.5);
    };
    item(circle("cg"), "centre of gravity of the stack from stage n on, full");
    item(circle("cg-empty"), "burnt out");
    item(box("grain"), "propellant");
    item(box("part"), "masses of the structure");
    item(fmt::format("<line class=\"hinge\" x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{0:.1f}\" y2=\"{2:.1f}\"/>\n",
                     x + 8.0, row - 5.0, row + 5.0),
         "hinges of the nozzles");
    if (vehicle_.sensors.inertial_unit_station_m > 0.0 || !vehicle_.sensors.rate_gyros.empty())
      item(fmt::format("<path class=\"sensor\" d=\"M{:.1f} {:.1f}l-5 -9h10z\"/>\n", x + 8.0, row + 4.5),
           "sensors");
  }

  const Vehicle& vehicle_;
  const bool has_words_;
  std::vector<MouldSection> body_;
  double length_m_ = 0.0;
  double widest_m_ = 0.0;
  double scale_ = 1.0;  ///< px/m
  double axis_px_ = 0.0;
  double bottom_px_ = 0.0;
  std::string svg_;
};

}  // namespace

std::string VehicleDrawing(const Vehicle& vehicle) {
  DISPERSA_ASSERT(!vehicle.stages.empty() && vehicle.stages.front().bottom_station_m > 0.0);
  return Drawing(vehicle, true).Svg();
}

std::string VehicleSketch(const Vehicle& vehicle) {
  DISPERSA_ASSERT(!vehicle.stages.empty() && vehicle.stages.front().bottom_station_m > 0.0);
  return Drawing(vehicle, false).Svg();
}

}  // namespace dispersa
