#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "core/campaign_yaml/load.h"
#include "core/flight/fly_scenario.h"
#include "core/flight/history_columns.h"
#include "tests/tools/sheets.h"

namespace dispersa {
namespace {

struct Curve {
  std::vector<double> time_s, altitude_km, pitch_deg;
};

Curve Flown(const Scenario& scenario) {
  const std::vector<ScenarioSample> samples = FlyScenario(scenario).samples;
  const std::vector<double> rows = HistoryRows(scenario, samples);
  const std::vector<std::string>& names = KinematicColumnNames();
  Curve curve;
  for (std::size_t i = 0; i < samples.size(); i += 5)
    for (std::size_t c = 0; c < names.size(); ++c) {
      const double value = rows[i * names.size() + c];
      if (names[c] == "time_s") curve.time_s.push_back(value);
      if (names[c] == "altitude_m") curve.altitude_km.push_back(1e-3 * value);
      if (names[c] == "pitch_deg") curve.pitch_deg.push_back(value);
    }
  return curve;
}

/// Every tenth second of simulator 06 (tests/data/nesc/SOURCE.md has the columns).
Curve Recorded(const std::string& data) {
  std::ifstream file(data + "/nesc/Atmos_17_sim_06.csv");
  Curve curve;
  std::string line;
  std::getline(file, line);
  for (int second = 0; std::getline(file, line); ++second) {
    if (second % 10 != 0) continue;
    std::istringstream cells(line);
    std::vector<double> values;
    for (std::string cell; std::getline(cells, cell, ',');) values.push_back(std::stod(cell));
    curve.time_s.push_back(values[0]);
    curve.altitude_km.push_back(0.3048e-3 * values[7]);
    curve.pitch_deg.push_back(values[9]);
  }
  return curve;
}

}  // namespace

FigureSheet TwoStageSheet(const std::string& campaigns, const std::string& data) {
  const Scenario described = LoadScenario(campaigns + "/scenarios/nesc_case17.yaml");
  Scenario as_06 = described;
  as_06.v_EC_N = {0.0, 0.0, -0.1};
  for (ScenarioStage& stage : as_06.stages) {
    stage.aerodynamics.area_m2 = 7.068583470577035;
    stage.motor->inertia_rate = 0.5;
  }
  const ChartAxis time{.label = "time, s", .low = 0.0, .high = 200.0};
  SvgChart altitude = PanelChart(time, {.label = "altitude, km", .low = 0.0});
  SvgChart pitch = PanelChart(time, {.label = "pitch, °", .low = 0.0});
  const auto line = [&](const Curve& curve, const char* style, const char* legend) {
    altitude.Line(curve.time_s, curve.altitude_km, style, legend);
    pitch.Line(curve.time_s, curve.pitch_deg, style, legend);
  };
  line(Flown(described), "line-0", "the description's data");
  line(Flown(as_06), "line-1", "the data of simulator 06");
  const Curve recorded = Recorded(data);
  altitude.Points(recorded.time_s, recorded.altitude_km, "public", "simulator 06");
  pitch.Points(recorded.time_s, recorded.pitch_deg, "public", "simulator 06");
  altitude.Points({193.0, 200.0}, {230.00, 251.4}, "shipped", "04 and 05, second hand");
  return {"Check case 17 of NASA/TM-2015-218675: a two-stage rocket to orbit, without control",
          {{altitude,
            "Altitude. Data that differ by 1 % of area and by half the rate of inertia end 14 km apart."},
           {pitch,
            "Pitch. The air lets go of the body above 60 km: from there it turns as it turned, until stage 2 "
            "burns out."}}};
}

}  // namespace dispersa
