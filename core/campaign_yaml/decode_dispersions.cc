#include <cassert>
#include <functional>

#include "core/campaign_yaml/decode.h"
#include "core/campaign_yaml/decode_distribution.h"
#include "core/campaign_yaml/yaml_reader.h"
#include "core/environment/turbulence.h"

namespace dispersa {
namespace {

using ProblemList = std::vector<InputProblem>;

int Column(const std::string& name) {
  const int column = FindInput(name);
  assert(column >= 0);
  return column;
}

std::string StageName(int stage) { return "stage" + std::to_string(stage); }

// The parts of a column's name around its stage: "thrust_offset" "_stage1" "_m".
struct StageColumn {
  std::string stem;
  std::string unit_suffix;

  int Of(int stage) const { return Column(stem + "_" + StageName(stage) + unit_suffix); }
};

class DispersionDecoder {
 public:
  DispersionDecoder(const InputNode& node, const std::string& path, int stages, Campaign& campaign,
                    ProblemList& problems)
      : map_(node, path, problems),
        stages_(stages > 0 ? stages : kMaxStages),
        campaign_(campaign),
        problems_(problems) {}

  void Decode() {
    Lateral("thrust_misalignment", {kAngle, kAnyNumber}, {"thrust_misalignment", "_deg"},
            {"thrust_misalignment_clock", "_deg"}, "nozzle_misalignment");
    Lateral("thrust_offset", {kLength, kAnyNumber}, {"thrust_offset", "_m"}, {"thrust_offset_clock", "_deg"},
            "nozzle_offset");
    Lateral("center_of_gravity_offset", {kLength, kAnyNumber}, {"cg_offset", "_m"}, {"cg_offset_clock", "_deg"});
    Thrust();
    StageFactor("burn_rate", {{"thrust_factor", ""}, {"mass_flow_factor", ""}});
    StageFactor("specific_impulse", {{"specific_impulse_factor", ""}});
    Wind();
    Gust();
    WindProfile();
    Turbulence();
    Scalar("drag_coefficient", kPositiveFactor, "drag_factor");
    Scalar("lift_coefficient", kPositiveFactor, "lift_factor");
    Scalar("center_of_gravity", kPositiveFactor, "cg_factor");
    Scalar("center_of_pressure", kPositiveFactor, "cp_factor");
    Scalar("density", kPositiveFactor, "density_factor");
    Scalar("inertia", kPositiveFactor, "inertia_factor");
    Scalar("actuator_bandwidth", kPositiveFactor, "actuator_bandwidth_factor");
    BendingFrequency();
    Scalar("bending_damping", kPositiveFactor, "bending_damping_factor");
    Scalar("bending_slope", {{}, kNonNegative}, "bending_slope_factor");
    TipOff();
    GyroBias();
    Scalar("gyro_noise", {kAngularRate, kNonNegative}, "gyro_noise_deg_s");
    NavigationError("navigation_position_error", kLength, "_m");
    NavigationError("navigation_velocity_error", kSpeed, "_m_s");
    Scalar("accelerometer_scale", kPositiveFactor, "accelerometer_scale_factor");
    StuckNozzle();
    // A deliberately bad P_n is a study, so any factor is legal.
    Scalar("pn_error", {{}, kAnyNumber}, "pn_error_factor");
    Scalar("pn_rate", {{}, kAnyNumber}, "pn_rate_factor");
    Scalar("loop_gain", kPositiveFactor, "loop_gain_factor");
    Scalar("loop_delay", {kTime, kNonNegative}, "loop_delay_s");
  }

 private:
  void Add(const std::string& name, const ScalarDistribution& distribution, std::vector<int> inputs,
           bool absolute = false) {
    campaign_.dispersions.push_back({name, distribution, std::move(inputs), absolute});
  }

  // One draw a stage, or one for all of them, as `per` says.
  void AddStages(const std::string& name, bool per_stage, const ScalarDistribution& distribution,
                 const std::vector<StageColumn>& columns, bool absolute = false) {
    std::vector<int> all;
    for (int stage = 1; stage <= stages_; ++stage) {
      std::vector<int> inputs;
      for (const StageColumn& column : columns) inputs.push_back(column.Of(stage));
      all.insert(all.end(), inputs.begin(), inputs.end());
      if (per_stage) Add(name + "/" + StageName(stage), distribution, std::move(inputs), absolute);
    }
    if (!per_stage) Add(name, distribution, std::move(all), absolute);
  }

  enum class Per { kStage, kVehicle, kNozzle };
  static Per PerWhat(MapReader& map, bool nozzles) {
    if (!nozzles) return PerStage(map) ? Per::kStage : Per::kVehicle;
    return map.Choice<Per>("per",
                           {{"stage", Per::kStage}, {"vehicle", Per::kVehicle}, {"nozzle", Per::kNozzle}});
  }
  static bool PerStage(MapReader& map) {
    return map.Choice<bool>("per", {{"stage", true}, {"vehicle", false}});
  }
  // One draw a nozzle.
  void AddNozzles(const std::string& name, const ScalarDistribution& distribution, const StageColumn& column,
                  bool absolute = false) {
    for (int stage = 1; stage <= stages_; ++stage) {
      const std::vector<std::string> names = NozzleNames(stage);
      for (std::size_t i = 0; i < names.size(); ++i)
        Add(name + "/" + StageName(stage) + "_" + names[i], distribution,
            {Column(column.stem + "_" + StageName(stage) + "_" + kNozzleNames[i] + column.unit_suffix)},
            absolute);
    }
  }
  // Of the cross, or of the stage's list; none of a vehicle that is already refused.
  std::vector<std::string> NozzleNames(int stage) const {
    std::vector<std::string> names(std::begin(kNozzleNames), std::end(kNozzleNames));
    const std::vector<Stage>& stages = campaign_.vehicle.stages;
    if (static_cast<std::size_t>(stage) > stages.size()) return names;
    const std::vector<Nozzle>& list = stages[static_cast<std::size_t>(stage) - 1].gimbal.nozzles;
    if (list.empty()) return names;
    names.clear();
    for (const Nozzle& nozzle : list) names.push_back(nozzle.name);
    return names;
  }

  // A magnitude and the direction of it around the axis; `of_nozzle`: the stem of a nozzle's own columns, if
  // it has.
  void Lateral(const std::string& key, const DispersedScalar& scalar, const StageColumn& magnitude,
               const StageColumn& clock, const std::string& of_nozzle = "") {
    const InputNode* node = map_.Optional(key);
    if (node == nullptr) return;
    MapReader map(*node, map_.PathOf(key), problems_);
    const ScalarDistribution distribution = ReadDistribution(map, scalar);
    const ScalarDistribution direction =
        ReadDirection(map.Required("clock_angle", "uniform, {fixed_deg: x} or a distribution"),
                      map.PathOf("clock_angle"), problems_);
    const Per per = PerWhat(map, !of_nozzle.empty());
    if (per == Per::kNozzle) {
      AddNozzles(key, distribution, {of_nozzle, magnitude.unit_suffix}, true);
      AddNozzles(key + "/clock", direction, {of_nozzle + "_clock", clock.unit_suffix});
      return;
    }
    AddStages(key, per == Per::kStage, distribution, {magnitude}, true);
    AddStages(key + "/clock", per == Per::kStage, direction, {clock});
  }

  void Thrust() {
    const InputNode* node = map_.Optional("thrust");
    if (node == nullptr) return;
    MapReader map(*node, map_.PathOf("thrust"), problems_);
    const ScalarDistribution distribution = ReadDistribution(map, kPositiveFactor);
    const bool flow_follows = map.Choice<bool>("conserve", {{"total_impulse", true}, {"propellant", false}});
    std::vector<StageColumn> columns = {{"thrust_factor", ""}};
    if (flow_follows) columns.push_back({"mass_flow_factor", ""});
    const Per per = PerWhat(map, true);
    if (per != Per::kNozzle) {
      AddStages("thrust", per == Per::kStage, distribution, columns);
      return;
    }
    if (flow_follows)
      AddProblem(problems_, *node, map.PathOf("conserve"), "the flow is the whole motor's, not a nozzle's",
                 "conserve: propellant with per: nozzle");
    AddNozzles("thrust", distribution, {"nozzle_thrust_factor", ""});
  }

  void StageFactor(const std::string& key, const std::vector<StageColumn>& columns) {
    const InputNode* node = map_.Optional(key);
    if (node == nullptr) return;
    MapReader map(*node, map_.PathOf(key), problems_);
    const ScalarDistribution distribution = ReadDistribution(map, kPositiveFactor);
    AddStages(key, PerStage(map), distribution, columns);
  }

  // One draw a mode, or one for all of them.
  void BendingFrequency() {
    const InputNode* node = map_.Optional("bending_frequency");
    if (node == nullptr) return;
    MapReader map(*node, map_.PathOf("bending_frequency"), problems_);
    const ScalarDistribution distribution = ReadDistribution(map, kPositiveFactor);
    const bool per_mode = map.Choice<bool>("per", {{"mode", true}, {"vehicle", false}});
    std::vector<int> all;
    for (int mode = 1; mode <= kModes; ++mode) {
      all.push_back(Column("bending_frequency_factor_mode" + std::to_string(mode)));
      if (per_mode) Add("bending_frequency/mode" + std::to_string(mode), distribution, {all.back()});
    }
    if (!per_mode) Add("bending_frequency", distribution, all);
  }

  void Scalar(const std::string& key, const DispersedScalar& scalar, const std::string& column) {
    const InputNode* node = map_.Optional(key);
    if (node == nullptr) return;
    MapReader map(*node, map_.PathOf(key), problems_);
    Add(key, ReadDistribution(map, scalar), {Column(column)});
  }

  // "stem_unit: x" or "stem: {distribution: ...}".
  void FixedOrDrawn(MapReader& map, const std::string& name, const std::string& stem,
                    const DispersedScalar& scalar, const std::string& column, bool required) {
    const InputNode* drawn = map.node().Find(stem);
    ScalarDistribution distribution;
    if (drawn != nullptr && drawn->kind == InputNode::Kind::kMap) {
      map.Ignore(stem);
      MapReader inner(*drawn, map.PathOf(stem), problems_);
      distribution = ReadDistribution(inner, scalar);
    } else if (required) {
      distribution = Constant(map.Quantity(stem, scalar.dimension, scalar.range));
    } else {
      const auto value = map.OptionalQuantity(stem, scalar.dimension, scalar.range);
      if (!value) return;
      distribution = Constant(*value);
    }
    Add(name, distribution, {Column(column)});
  }

  void Wind() {
    const InputNode* node = map_.Optional("wind");
    if (node == nullptr) return;
    MapReader map(*node, map_.PathOf("wind"), problems_);
    const double max_speed_m_s = map.Quantity("max_speed", kSpeed, Between(0.0, 200.0));
    const bool is_uniform = map.Choice<bool>("speed", {{"fixed", false}, {"uniform", true}}, false);
    Add("wind/speed", is_uniform ? Uniform(0.0, max_speed_m_s) : Constant(max_speed_m_s),
        {Column("wind_max_speed_m_s")});
    Add("wind/azimuth",
        ReadDirection(map.Required("azimuth", "uniform, {fixed_deg: x} or a distribution"),
                      map.PathOf("azimuth"), problems_),
        {Column("wind_azimuth_deg")});
    FixedOrDrawn(map, "wind/altitude", "altitude", {kLength, Between(0.0, 100e3)}, "wind_altitude_m", false);
    FixedOrDrawn(map, "wind/width", "width", {kLength, Between(100.0, 100e3)}, "wind_width_m", false);
  }

  void Gust() {
    const InputNode* node = map_.Optional("gust");
    if (node == nullptr) return;
    MapReader map(*node, map_.PathOf("gust"), problems_);
    FixedOrDrawn(map, "gust/speed", "speed", {kSpeed, Between(-100.0, 100.0)}, "gust_speed_m_s", true);
    FixedOrDrawn(map, "gust/altitude", "altitude", {kLength, Between(0.0, 100e3)}, "gust_altitude_m", true);
    FixedOrDrawn(map, "gust/length", "length", {kLength, Between(1.0, 10e3)}, "gust_length_m", true);
    Add("gust/azimuth",
        ReadDirection(map.Required("azimuth", "uniform, {fixed_deg: x} or a distribution"),
                      map.PathOf("azimuth"), problems_),
        {Column("gust_azimuth_deg")});
  }

  // A severity names a curve of MIL-F-8785C, figure 7, and a wind near the ground (its figure 10); or both
  // are given.
  void Turbulence() {
    const InputNode* node = map_.Optional("turbulence");
    if (node == nullptr) return;
    MapReader map(*node, map_.PathOf("turbulence"), problems_);
    constexpr double kKnot_m_s = 1852.0 / 3600.0;
    struct Severity {
      double exceedance, wind_m_s;
    };
    const bool named = node->Find("severity") != nullptr || node->Find("exceedance") == nullptr;
    Severity severity{kLargestExceedance, 0.0};
    if (named) {
      const int level = map.Choice<int>("severity", {{"light", 0}, {"moderate", 1}, {"severe", 2}});
      constexpr Severity kLevels[] = {
          {1e-2, 15.0 * kKnot_m_s}, {1e-3, 30.0 * kKnot_m_s}, {1e-5, 45.0 * kKnot_m_s}};
      severity = kLevels[level];
    } else {
      severity.exceedance = map.Number("exceedance", Between(kLeastExceedance, kLargestExceedance));
      severity.wind_m_s = map.Quantity("wind_20ft", kSpeed, Between(0.0, 50.0));
    }
    Add("turbulence/exceedance", Constant(severity.exceedance), {Column("turbulence_exceedance")});
    Add("turbulence/wind_20ft", Constant(severity.wind_m_s), {Column("turbulence_wind_20ft_m_s")});
    ScalarDistribution scale = Constant(1.0);
    if (const InputNode* drawn = map.Optional("scale")) {
      MapReader inner(*drawn, map.PathOf("scale"), problems_);
      scale = ReadDistribution(inner, kPositiveFactor);
    }
    Add("turbulence/scale", scale, {Column("turbulence_scale")});
  }

  // Tables are maps of columns: what a CSV file became.
  void WindProfile() {
    const InputNode* node = map_.Optional("wind_profile");
    if (node == nullptr) return;
    MapReader map(*node, map_.PathOf("wind_profile"), problems_);
    const InputNode* table = map.Optional("table");
    const InputNode* statistics = map.Optional("statistics");
    if ((table == nullptr) == (statistics == nullptr)) {
      AddProblem(problems_, *node, map.path(),
                 table == nullptr ? "no profile is given" : "'table' and 'statistics' are both given",
                 "either table: FILE.csv or statistics: FILE.csv");
    }
    if (table != nullptr) WindTableColumns(*table, PathOfTable(*table, *node, map.PathOf("table")));
    if (statistics != nullptr) {
      WindStatistics read;
      read.correlation_ne = map.Number("correlation_ne", Inside(-1.0, 1.0));
      read.correlation_length_m = map.Quantity("correlation_length", kLength, kPositive);
      StatisticsColumns(*statistics, PathOfTable(*statistics, *node, map.PathOf("statistics")), read);
    }
  }

  static std::string PathOfTable(const InputNode& table, const InputNode& parent, const std::string& path) {
    return table.file == parent.file ? path : "";
  }

  // The columns of a table have as many values as the first, and the table has no further problems.
  template <typename Table>
  bool IsUsable(const Table& table, const std::vector<const std::vector<double>*>& columns,
                const InputNode& node, const std::string& path, std::size_t problems_before) {
    if (problems_.size() > problems_before) return false;
    for (const auto* column : columns) {
      if (column->size() == columns.front()->size()) continue;
      AddProblem(problems_, node, path, "the columns have different lengths",
                 "one value an altitude in each column");
      return false;
    }
    if (!CheckIncreasing(node, path, "altitude_m", table.altitude_m, problems_)) return false;
    for (const std::string& sentence : Problems(table)) AddProblem(problems_, node, path, sentence);
    return problems_.size() == problems_before;
  }

  void WindTableColumns(const InputNode& node, const std::string& path) {
    if (node.file == nullptr) return;  // already reported
    const std::size_t before = problems_.size();
    WindTable table;
    {
      MapReader map(node, path, problems_);
      table.altitude_m = map.Numbers("altitude_m", kAnyNumber, 2);
      table.north_m_s = map.Numbers("north_m_s", kAnyNumber, 2);
      table.east_m_s = map.Numbers("east_m_s", kAnyNumber, 2);
    }
    if (IsUsable(table, {&table.altitude_m, &table.north_m_s, &table.east_m_s}, node, path, before)) {
      campaign_.wind_table = std::move(table);
    }
  }

  void StatisticsColumns(const InputNode& node, const std::string& path, WindStatistics& statistics) {
    if (node.file == nullptr) return;  // already reported
    const std::size_t before = problems_.size();
    {
      MapReader map(node, path, problems_);
      statistics.altitude_m = map.Numbers("altitude_m", kAnyNumber, 2, kWindLevels);
      statistics.mean_north_m_s = map.Numbers("mean_north_m_s", kAnyNumber, 2);
      statistics.mean_east_m_s = map.Numbers("mean_east_m_s", kAnyNumber, 2);
      statistics.sigma_north_m_s = map.Numbers("sigma_north_m_s", kNonNegative, 2);
      statistics.sigma_east_m_s = map.Numbers("sigma_east_m_s", kNonNegative, 2);
    }
    if (!IsUsable(statistics,
                  {&statistics.altitude_m, &statistics.mean_north_m_s, &statistics.mean_east_m_s,
                   &statistics.sigma_north_m_s, &statistics.sigma_east_m_s},
                  node, path, before)) {
      return;
    }
    ScalarDistribution standard_normal;
    standard_normal.kind = Distribution::kNormal;
    standard_normal.sigma = 1.0;
    for (std::size_t level = 1; level <= statistics.altitude_m.size(); ++level) {
      for (const std::string component : {"north", "east"}) {
        const std::string number = std::to_string(level);
        Add("wind_profile/" + component + number, standard_normal,
            {Column("wind_profile_" + component + "_" + number)});
      }
    }
    campaign_.wind_statistics = std::move(statistics);
  }

  // f(axis, map) for each axis that a map of axes has; one at least.
  void EachAxis(const std::string& key, const std::function<void(const std::string&, MapReader&)>& f) {
    const InputNode* node = map_.Optional(key);
    if (node == nullptr) return;
    MapReader map(*node, map_.PathOf(key), problems_);
    bool any = false;
    for (const std::string axis : {"roll", "pitch", "yaw"}) {
      const InputNode* axis_node = map.Optional(axis);
      if (axis_node == nullptr) continue;
      any = true;
      MapReader axis_map(*axis_node, map.PathOf(axis), problems_);
      f(axis, axis_map);
    }
    if (!any && node->members.empty()) {
      AddProblem(problems_, *node, map.path(), "no axis is given", "one or more of roll, pitch, yaw");
    }
  }

  void TipOff() {
    EachAxis("tip_off_rate", [this](const std::string& axis, MapReader& map) {
      const ScalarDistribution rate = ReadDistribution(map, {kAngularRate, kAnyNumber});
      const StageColumn column{"tip_off_" + axis, "_deg_s"};
      for (int stage = 1; stage < stages_; ++stage) {
        Add("tip_off_rate/" + axis + "/" + StageName(stage), rate, {column.Of(stage)});
      }
    });
  }

  void GyroBias() {
    EachAxis("gyro_bias", [this](const std::string& axis, MapReader& map) {
      Add("gyro_bias/" + axis, ReadDistribution(map, {kAngularRate, kAnyNumber}),
          {Column("gyro_bias_" + axis + "_deg_s")});
    });
  }

  // One distribution, drawn for each axis of the launch-inertial frame.
  void NavigationError(const std::string& key, Dimension dimension, const std::string& unit_suffix) {
    const InputNode* node = map_.Optional(key);
    if (node == nullptr) return;
    MapReader map(*node, map_.PathOf(key), problems_);
    const ScalarDistribution error = ReadDistribution(map, {dimension, kAnyNumber});
    for (const std::string axis : {"downrange", "right", "down"})
      Add(key + "/" + axis, error, {Column(key + "_" + axis + unit_suffix)});
  }

  void StuckNozzle() {
    const InputNode* node = map_.Optional("stuck_nozzle");
    if (node == nullptr) return;
    MapReader map(*node, map_.PathOf("stuck_nozzle"), problems_);
    const std::uint64_t stage = map.Integer("stage", 1, static_cast<std::uint64_t>(stages_));
    std::vector<std::pair<std::string, double>> choices;
    std::vector<double> numbers;
    for (const std::string& name : NozzleNames(static_cast<int>(stage))) {
      numbers.push_back(static_cast<double>(numbers.size() + 1));
      choices.emplace_back(name, numbers.back());
    }
    choices.emplace_back("any", 0.0);
    ScalarDistribution nozzle = Constant(map.Choice<double>("nozzle", choices));
    if (nozzle.nominal == 0.0) {
      nozzle.kind = Distribution::kValues;
      nozzle.values = numbers;
    }
    Add("stuck_nozzle/nozzle", nozzle, {Column("stuck_nozzle")});
    Add("stuck_nozzle/stage", Constant(static_cast<double>(stage)), {Column("stuck_nozzle_stage")});
    FixedOrDrawn(map, "stuck_nozzle/angle", "angle", {kAngle, Inside(-kPi / 2.0, kPi / 2.0)},
                 "stuck_nozzle_deg", true);
  }

  MapReader map_;
  int stages_;
  Campaign& campaign_;
  ProblemList& problems_;
};

}  // namespace

void DecodeDispersions(const InputNode& node, const std::string& path, int stages, Campaign& campaign,
                       std::vector<InputProblem>& problems) {
  DispersionDecoder(node, path, stages, campaign, problems).Decode();
}

}  // namespace dispersa
