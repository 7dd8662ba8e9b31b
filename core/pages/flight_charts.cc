#include "core/pages/flight_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string_view>
#include <tuple>
#include <vector>

#include "core/math/assertion.h"
#include "core/pages/html_parts.h"
#include "core/pages/svg_chart.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

constexpr char kTimeAxis[] = "time since lift-off, s";
/// Below this dynamic pressure (Pa) incidence has little effect.
constexpr double kThinAir_pa = 1000.0;

std::vector<double> Column(const History& history, const char* name, double factor = 1.0) {
  const int column = FindHistoryColumn(name);
  DISPERSA_ASSERT(column >= 0, column);
  std::vector<double> values(history.rows());
  for (std::size_t row = 0; row < values.size(); ++row) values[row] = history.at(row, column) * factor;
  return values;
}

/// The burns of the stages, from a flight's history.
struct Burns {
  struct Burn {
    int stage;
    double from_s;
    double to_s;
  };
  std::vector<Burn> burns;
  double end_s = 0.0;  ///< of the flight

  explicit Burns(const History& history) {
    const std::vector<double> time_s = Column(history, "time_s");
    const std::vector<double> stage = Column(history, "stage");
    const std::vector<double> thrust_n = Column(history, "thrust_n");
    if (!time_s.empty()) end_s = time_s.back();
    for (std::size_t row = 0; row < time_s.size(); ++row) {
      if (thrust_n[row] <= 0.0) continue;
      const int now = static_cast<int>(stage[row]);
      if (burns.empty() || burns.back().stage != now) burns.push_back({now, time_s[row], time_s[row]});
      burns.back().to_s = time_s[row];
    }
  }

  /// Marks ignitions, and gaps of more than 10 s as coast.
  void AddTo(SvgChart* chart) const {
    for (std::size_t i = 0; i < burns.size(); ++i) {
      if (i > 0 && burns[i].from_s - burns[i - 1].to_s > 10.0)
        chart->Shade(burns[i - 1].to_s, burns[i].from_s, "coast");
      chart->Mark(burns[i].from_s, fmt::format("S{}", burns[i].stage));
    }
  }

  /// The number of burns before the first coast that is longer than a minute and than the flight before it.
  /// On the time axis of the whole flight they would have no room.
  std::size_t Ascending() const {
    std::size_t i = 1;
    while (i < burns.size() && burns[i].from_s - burns[i - 1].to_s <= std::max(60.0, burns[i - 1].to_s)) ++i;
    return std::min(i, burns.size());
  }
  /// None: the whole flight has room on one axis. It has none if most of it follows the last burn.
  std::optional<double> AscentEnd() const {
    const std::size_t ascending = Ascending();
    if (burns.empty() || (ascending == burns.size() && end_s < 2.0 * burns.back().to_s)) return std::nullopt;
    return 10.0 * std::ceil(0.1 * burns[ascending - 1].to_s);
  }
};

bool IsDefined(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

const Band& BandOf(const FlightBands& bands, std::string_view column) {
  const auto band = std::find_if(bands.bands.begin(), bands.bands.end(),
                                 [&](const Band& candidate) { return candidate.column == column; });
  DISPERSA_ASSERT(band != bands.bands.end());
  return *band;
}

/// Undefined where the air is thin. At rest the wind alone is the incidence, and would set the scale.
std::vector<double> InAir(std::vector<double> values, const std::vector<double>& qbar_pa) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!(qbar_pa[i] >= kThinAir_pa)) values[i] = std::nan("");
  return values;
}

std::vector<double> Scaled(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

/// With fewer flights the outer percentiles lie between the extreme flight and its neighbour.
constexpr std::size_t kForOuterPercentiles = 371;  // 1 / 0.0027

void AddBands(const FlightBands& bands, const Band& band,
              const std::function<std::vector<double>(std::vector<double>)>& shown, SvgChart* chart) {
  chart->Band(bands.time_s, shown(band.min), shown(band.max), "band-outer", "min–max");
  chart->Band(bands.time_s, shown(band.p01), shown(band.p99), "band-inner", "1–99 %");
  if (bands.flights >= kForOuterPercentiles) {
    chart->Line(bands.time_s, shown(band.p00_27), "band-edge", "0.27 and 99.73 %");
    chart->Line(bands.time_s, shown(band.p99_73), "band-edge", "");
  }
}

/// The nominal flight at the steps of the bands. Undefined after the end of the nominal flight.
std::vector<double> AtSteps(const History& nominal, const char* column, const FlightBands& bands) {
  std::vector<double> values = SampleFlight(nominal, {FindBandColumn(column)}, bands.step_s)[0];
  values.resize(bands.time_s.size(), std::nan(""));
  return values;
}

/// The last time at which dynamic pressure is above kThinAir_pa, and a little more.
double AtmosphereEnd(const std::vector<double>& time_s, const std::vector<double>& qbar_pa) {
  double end_s = 0.0;
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    if (qbar_pa[i] >= kThinAir_pa) end_s = time_s[i];
  }
  return 10.0 * std::ceil(0.1 * (end_s + 5.0));
}

}  // namespace

std::string BandFigure(const BandView& view, const FlightHistories& histories, const CampaignSummary& summary,
                       const std::string& caption) {
  const FlightBands& bands = histories.bands;
  const Band& band = BandOf(bands, view.column);
  const std::vector<double>& qbar_pa = BandOf(bands, "qbar_pa").p50;
  // Nothing commands it, or there is no air to speak of.
  if (!IsDefined(view.in_air ? InAir(band.p50, qbar_pa) : band.p50)) return "";
  SvgChart chart({.label = kTimeAxis, .low = view.from_s, .high = view.to_s}, {.label = view.label},
                 view.width, 280);
  const Burns burns(histories.nominal_history);
  burns.AddTo(&chart);
  const std::vector<double> nominal = AtSteps(histories.nominal_history, view.column, bands);
  const auto shown = [&](std::vector<double> values) {
    for (std::size_t i = 0; i < nominal.size() && view.deviation; ++i) values[i] -= nominal[i];
    if (view.in_air) values = InAir(std::move(values), qbar_pa);
    return Scaled(std::move(values), view.factor);
  };
  AddBands(bands, band, shown, &chart);
  chart.Line(bands.time_s, shown(band.p50), "line-0", "median");
  if (!view.deviation) chart.Line(bands.time_s, shown(nominal), "line-1", "nominal");
  if (view.program)
    chart.Line(bands.time_s, AtSteps(histories.nominal_history, "pitch_program_deg", bands), "program",
               "program");
  for (const RequirementSummary& requirement : summary.requirements) {
    if (view.peak == nullptr || requirement.metric != view.peak) continue;
    chart.HorizontalLimit(requirement.limit, "limit of the peak");
    chart.HorizontalLimit(-requirement.limit, "");
  }
  return Figure(chart.Svg(caption), HtmlText(caption), view.style);
}

std::string NominalFigures(const History& nominal) {
  const Burns burns(nominal);
  const std::vector<double> time_s = Column(nominal, "time_s");
  std::string figures = "<div class=\"figures\">\n";
  const auto add = [&](SvgChart chart, const std::string& caption) {
    burns.AddTo(&chart);
    figures += Figure(chart.Svg(caption), HtmlText(caption));
  };
  const bool is_controlled = IsDefined(Column(nominal, "pitch_error_deg"));
  SvgChart pitch({.label = kTimeAxis}, {.label = "pitch from the launch horizon, °"});
  pitch.Line(time_s, Column(nominal, "pitch_launch_deg"), "line-0", is_controlled ? "flown" : "");
  if (is_controlled) pitch.Line(time_s, Column(nominal, "pitch_program_deg"), "program", "program");
  add(pitch, is_controlled ? "Pitch program and pitch in the launch-inertial frame."
                           : "Pitch in the launch-inertial frame.");
  for (const auto& [column, label, factor, caption] :
       {std::tuple{"altitude_m", "altitude, km", 1e-3, "Geodetic altitude."},
        {"inertial_velocity_m_s", "inertial velocity, m/s", 1.0,
         "Inertial speed; at lift-off it is that of the Earth's rotation."},
        {"flight_path_angle_deg", "flight path angle, °", 1.0, "Inertial flight path angle."}}) {
    SvgChart chart({.label = kTimeAxis}, {.label = label});
    chart.Line(time_s, Column(nominal, column, factor), "line-0", "");
    add(chart, caption);
  }
  return figures + "</div>\n";
}

std::string EnvelopeFigures(const FlightHistories& histories, const CampaignSummary& summary,
                            double kick_end_s) {
  const Burns burns(histories.nominal_history);
  const std::vector<double> time_s = Column(histories.nominal_history, "time_s");
  const double air_end_s = AtmosphereEnd(time_s, Column(histories.nominal_history, "qbar_pa"));
  const double pitch_over_end_s = 5.0 * std::ceil(0.2 * (kick_end_s + 5.0));
  std::string figures = "<div class=\"figures\">\n";
  const auto add = [&](const BandView& view, const std::string& caption) {
    figures += BandFigure(view, histories, summary, caption);
  };
  // The burns of the ascent on one axis.
  const std::string stages = burns.AscentEnd() ? fmt::format(", until stage {} has burnt out",
                                                             burns.burns[burns.Ascending() - 1].stage)
                                               : "";
  const auto ascent = [&](BandView view, const std::string& what, const std::string& to_see = "") {
    view.from_s = 0.0;
    view.to_s = burns.AscentEnd();
    add(view, what + stages + "." + to_see);
  };
  const bool is_bound =
      std::any_of(summary.requirements.begin(), summary.requirements.end(),
                  [](const RequirementSummary& one) { return one.metric == "pitch_error_peak_deg"; });
  ascent({.column = "pitch_error_powered_deg",
          .label = "pitch error, °",
          .peak = "pitch_error_peak_deg",
          .width = 1060,
          .style = "wide"},
         "Pitch error in powered flight", is_bound ? " The band shall stay inside the limits." : "");
  add({.column = "pitch_error_powered_deg",
       .label = "pitch error, °",
       .from_s = 0.0,
       .to_s = pitch_over_end_s,
       .style = "screen"},
      "Pitch error during lift-off and the initial pitch-over.");
  ascent({.column = "yaw_error_powered_deg", .label = "yaw error, °", .peak = "yaw_error_peak_deg"},
         "Yaw error in powered flight");
  ascent({.column = "roll_error_powered_deg",
          .label = "roll error, °",
          .peak = "roll_error_peak_deg",
          .style = "screen"},
         "Roll error in powered flight");
  for (std::size_t i = burns.Ascending(); i < burns.burns.size(); ++i) {
    const Burns::Burn& burn = burns.burns[i];
    for (const auto& [column, label, title] :
         {std::tuple{"pitch_error_powered_deg", "pitch error, °", "Pitch"},
          {"yaw_error_powered_deg", "yaw error, °", "Yaw"},
          {"roll_error_powered_deg", "roll error, °", "Roll"}})
      add({.column = column,
           .label = label,
           .from_s = 10.0 * std::floor(0.1 * (burn.from_s - 5.0)),
           .to_s = 10.0 * std::ceil(0.1 * burn.to_s),
           .style = "screen"},
          fmt::format("{} error while stage {} burns.", title, burn.stage));
  }
  ascent({.column = "deflection_pitch_deg", .label = "pitch deflection, °"}, "Gimbal deflection in pitch",
         " Its distance to the stop is what is left to steer with.");
  ascent({.column = "deflection_yaw_deg", .label = "yaw deflection, °", .style = "screen"},
         "Gimbal deflection in yaw");
  add({.column = "qbar_pa",
       .label = "dynamic pressure, kPa",
       .factor = 1e-3,
       .from_s = 0.0,
       .to_s = air_end_s},
      "Dynamic pressure: the spread of its peak is that of thrust and density.");
  add({.column = "alpha_deg",
       .label = "angle of attack, °",
       .from_s = 0.0,
       .to_s = air_end_s,
       .in_air = true},
      "Angle of attack against the air, wind included, where the median dynamic pressure is at least 1 kPa.");
  add({.column = "q_alpha_pa_rad", .label = "q·α, kPa rad", .factor = 1e-3, .from_s = 0.0, .to_s = air_end_s},
      "Dynamic pressure times total incidence of each flight, wind included: what bends the vehicle.");
  ascent({.column = "axial_load_g", .label = "axial load, g"}, "Axial load, thrust and drag over mass",
         " It is largest before a burnout.");
  ascent({.column = "mass_kg", .label = "mass, t", .factor = 1e-3, .style = "screen"}, "Mass of the vehicle",
         " Where the band is wide, burnouts and separations differ in time.");
  for (const auto& [column, label] :
       {std::pair{"p_deg_s", "roll rate, °/s"}, std::pair{"q_deg_s", "pitch rate, °/s"},
        std::pair{"r_deg_s", "yaw rate, °/s"}})
    ascent({.column = column, .label = label, .style = "screen"},
           "Inertial rate about the body’s axis, which the gyros measure");
  add({.column = "altitude_m",
       .label = "altitude minus that of the nominal, km",
       .factor = 1e-3,
       .deviation = true,
       .style = "screen"},
      "Altitude of the flights above the nominal flight at the same time.");
  if (burns.burns.size() > 1)
    add({.column = "pitch_error_deg", .label = "pitch error, °", .style = "screen"},
        "Pitch error over the whole flight. In a coast the dead band of the reaction control shows.");
  return figures + "</div>\n";
}

namespace {

/// What a metric of a peak is a peak of: in a flight that of the columns with the largest magnitude, of
/// incidence times dynamic pressure.
struct WorstView {
  const char* metrics;  ///< how the names of its metrics begin
  struct Column {
    const char* name;
    const char* label;
  };
  std::vector<Column> columns;
  bool in_air = false;
};

const std::vector<WorstView>& WorstViews() {
  static const std::vector<WorstView> views = {
      {"pitch_error", {{"pitch_error_powered_deg", "pitch error, °"}}},
      {"yaw_error", {{"yaw_error_powered_deg", "yaw error, °"}}},
      {"roll_error", {{"roll_error_powered_deg", "roll error, °"}}},
      {"deflection_peak",
       {{"deflection_pitch_deg", "pitch deflection, °"},
        {"deflection_yaw_deg", "yaw deflection, °"},
        {"deflection_roll_deg", "roll deflection, °"}}},
      {"q_alpha", {{"alpha_deg", "angle of attack, °"}, {"beta_deg", "angle of sideslip, °"}}, true},
      {"alpha_max", {{"alpha_deg", "angle of attack, °"}, {"beta_deg", "angle of sideslip, °"}}, true},
      {"axial_load", {{"axial_load_g", "axial load, g"}}}};
  return views;
}

/// A worst case that has a history, at the steps of the bands.
class WrittenFlight {
 public:
  WrittenFlight(const FlightHistories& histories, std::uint64_t case_index)
      : bands_(histories.bands),
        flight_(histories.written_flights[static_cast<std::size_t>(
            std::lower_bound(histories.written_cases.begin(), histories.written_cases.end(), case_index) -
            histories.written_cases.begin())]) {}

  std::vector<double> Values(const char* column, bool in_air) const {
    return in_air ? InAir(At(column), At("qbar_pa")) : At(column);
  }
  struct Peak {
    std::size_t column = 0;  ///< of the view
    double time_s = 0.0;
  };
  Peak PeakOf(const WorstView& view) const {
    Peak peak;
    double most = -1.0;
    for (std::size_t i = 0; i < view.columns.size(); ++i) {
      const std::vector<double> values = Values(view.columns[i].name, view.in_air);
      const std::vector<double> qbar_pa = At("qbar_pa");
      const bool is_product = std::string_view(view.metrics) == "q_alpha";
      for (std::size_t k = 0; k < values.size(); ++k) {
        const double size = std::fabs(values[k]) * (is_product ? qbar_pa[k] : 1.0);
        if (!(size > most)) continue;
        most = size;
        peak = {i, bands_.time_s[k]};
      }
    }
    return peak;
  }

 private:
  const std::vector<double>& At(const char* column) const {
    return flight_[static_cast<std::size_t>(&BandOf(bands_, column) - bands_.bands.data())];
  }

  const FlightBands& bands_;
  const SampledFlight& flight_;
};

/// The worst cases of a view's metrics that have a history.
std::vector<std::uint64_t> WorstWritten(const WorstView& view, const FlightHistories& histories,
                                        const CampaignSummary& summary) {
  constexpr std::size_t kLines = 4;
  std::vector<std::uint64_t> shown;
  for (const WorstCases& worst : summary.worst_cases) {
    if (!worst.metric.starts_with(view.metrics)) continue;
    for (const WorstCase& one : worst.cases) {
      const bool written =
          std::binary_search(histories.written_cases.begin(), histories.written_cases.end(), one.case_index);
      if (written && shown.size() < kLines &&
          std::find(shown.begin(), shown.end(), one.case_index) == shown.end())
        shown.push_back(one.case_index);
    }
  }
  return shown;
}

}  // namespace

std::string WorstQuantity(const std::string& metric, std::uint64_t case_index,
                          const FlightHistories& histories) {
  const bool is_peak = metric.find("_peak_") != metric.npos || metric.find("_max_") != metric.npos;
  if (!is_peak ||
      !std::binary_search(histories.written_cases.begin(), histories.written_cases.end(), case_index))
    return "";
  for (const WorstView& view : WorstViews()) {
    if (!metric.starts_with(view.metrics)) continue;
    const WrittenFlight::Peak peak = WrittenFlight(histories, case_index).PeakOf(view);
    const std::string label = view.columns[peak.column].label;
    return fmt::format("{} at {:.0f} s", label.substr(0, label.find(',')), peak.time_s);
  }
  return "";
}

std::string WorstFigures(const FlightHistories& histories, const CampaignSummary& summary) {
  const Burns burns(histories.nominal_history);
  const FlightBands& bands = histories.bands;
  const double air_end_s = AtmosphereEnd(Column(histories.nominal_history, "time_s"),
                                         Column(histories.nominal_history, "qbar_pa"));
  std::string figures;
  for (const WorstView& view : WorstViews()) {
    const std::vector<std::uint64_t> worst = WorstWritten(view, histories, summary);
    for (std::size_t i = 0; i < view.columns.size(); ++i) {
      const auto& [name, label] = view.columns[i];
      std::vector<std::uint64_t> shown;
      double last_peak_s = 0.0;
      for (const std::uint64_t one : worst) {
        const WrittenFlight::Peak peak = WrittenFlight(histories, one).PeakOf(view);
        if (peak.column != i) continue;
        shown.push_back(one);
        last_peak_s = std::max(last_peak_s, peak.time_s);
      }
      if (shown.empty()) continue;
      ChartAxis time{.label = kTimeAxis, .low = 0.0};
      const std::optional<double> ascent_end_s = burns.AscentEnd();
      if (view.in_air) {
        time.high = air_end_s;
      } else if (ascent_end_s && last_peak_s <= *ascent_end_s) {
        time.high = ascent_end_s;
      }
      SvgChart chart(time, {.label = label}, 1060, 280);
      burns.AddTo(&chart);
      const Band& band = BandOf(bands, name);
      const auto in_view = [&](const std::vector<double>& values) {
        return view.in_air ? InAir(values, BandOf(bands, "qbar_pa").p50) : values;
      };
      AddBands(bands, band, in_view, &chart);
      for (std::size_t k = 0; k < shown.size(); ++k) {
        const std::vector<double> values = WrittenFlight(histories, shown[k]).Values(name, view.in_air);
        const std::vector<double> time_s(bands.time_s.begin(), bands.time_s.begin() + std::ssize(values));
        chart.CaseLine(time_s, values, fmt::format("line-{}", k), shown[k]);
      }
      const std::string caption = fmt::format("Worst cases over the envelope: {}.", label);
      figures += Figure(chart.Svg(caption), HtmlText(caption), figures.empty() ? "wide" : "wide screen");
    }
  }
  return figures.empty() ? "" : "<div class=\"figures\">\n" + figures + "</div>\n";
}

}  // namespace dispersa
