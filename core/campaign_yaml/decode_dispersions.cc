#include <algorithm>
#include <cassert>
#include <functional>
#include <limits>
#include <optional>
#include <set>

#include "core/campaign_yaml/decode.h"
#include "core/campaign_yaml/decode_distribution.h"
#include "core/input/number_text.h"
#include "core/input/map_reader.h"
#include "core/control/autopilot.h"
#include "core/environment/turbulence.h"
#include "core/flight/dispersed_vehicle.h"
#include "core/math/functions.h"
#include "core/vehicle/mass.h"

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
  DispersionDecoder(const InputNode& node, const std::string& path, Campaign& campaign, ProblemList& problems)
      : map_(node, path, problems),
        vehicle_(campaign.vehicle),
        is_sound_(problems.empty()),
        stages_(vehicle_.stages.empty() ? kMaxStages : static_cast<int>(vehicle_.stages.size())),
        campaign_(campaign),
        problems_(problems) {}

  void Decode() {
    Lateral("thrust_misalignment", {kAngle, kAnyNumber}, "_deg", "thrust_misalignment",
            "nozzle_misalignment");
    Lateral("thrust_offset", {kLength, kAnyNumber}, "_m", "thrust_offset", "nozzle_offset");
    Lateral("center_of_gravity_offset", {kLength, kAnyNumber}, "_m", "cg_offset");
    Thrust();
    StageFactor("burn_rate", {{"thrust_factor", ""}, {"mass_flow_factor", ""}});
    PropellantTemperature();
    StageFactor("specific_impulse", {{"specific_impulse_factor", ""}});
    StageFactor("dry_mass", {{"dry_mass_factor", ""}});
    PropellantLoad();
    PayloadMass();
    ProductsOfInertia();
    Delay("ignition_delay", 2, stages_, &DispersionDecoder::LeastIgnitionDelay);
    Delay("separation_delay", 1, stages_ - 1, &DispersionDecoder::LeastSeparationDelay);
    Scalar("launch_azimuth_error", {kAngle, kAnyNumber}, "launch_azimuth_error_deg");
    InitialAttitude();
    Wind();
    Gust();
    WindProfile();
    Turbulence();
    VehicleOrStageFactor("drag_coefficient", "drag_factor");
    VehicleOrStageFactor("lift_coefficient", "lift_factor");
    VehicleOrStageFactor("center_of_gravity", "cg_factor");
    VehicleOrStageFactor("center_of_pressure", "cp_factor");
    Scalar("density", kPositiveFactor, "density_factor");
    VehicleOrStageFactor("inertia", "inertia_factor");
    VehicleOrStageFactor("actuator_bandwidth", "actuator_bandwidth_factor");
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

  // ---- stages ----

  // Stages `first` to `last`, counted from 1.
  static std::vector<int> StagesBetween(int first, int last) {
    std::vector<int> stages;
    for (int stage = first; stage <= last; ++stage) stages.push_back(stage);
    return stages;
  }
  std::vector<int> AllStages() const { return StagesBetween(1, stages_); }

  // A dispersion of stages, as one of its maps says: which, and how many draws.
  enum class Per { kStage, kVehicle, kNozzle };
  struct Selection {
    std::vector<int> stages;
    bool all = true;  // `stage` is not given
    Per per = Per::kStage;
  };

  // f(map, stages that it may be about) for the one map of a key, or for each of a list; no stage may come
  // twice.
  template <typename F>
  void EachOfStages(MapReader& parent, const std::string& key, const std::vector<int>& possible, F f) {
    const InputNode* node = parent.Optional(key);
    if (node == nullptr) return;
    std::set<int> taken;
    const auto read = [&](const InputNode& item, const std::string& path) {
      MapReader map(item, path, problems_);
      const std::optional<std::vector<int>> stages = Stages(map, possible);
      Selection selection;
      selection.all = !stages.has_value();
      selection.stages = stages.value_or(possible);
      for (const int stage : selection.stages) {
        if (taken.insert(stage).second) continue;
        const InputNode* named = item.Find("stage");
        AddProblem(problems_, named != nullptr ? *named : item, named != nullptr ? map.PathOf("stage") : path,
                   "stage " + std::to_string(stage) + " is given twice", "each stage in one of the list");
        break;
      }
      f(map, selection);
    };
    if (node->kind != InputNode::Kind::kList) {
      read(*node, parent.PathOf(key));
      return;
    }
    if (node->items.empty())
      AddProblem(problems_, *node, parent.PathOf(key), "the list is empty",
                 "a map, or a list of maps with stage");
    for (std::size_t i = 0; i < node->items.size(); ++i)
      read(node->items[i], parent.PathOf(key) + "[" + std::to_string(i) + "]");
  }
  template <typename F>
  void EachOfStages(const std::string& key, const std::vector<int>& possible, F f) {
    EachOfStages(map_, key, possible, f);
  }

  // `stage: 3` or `stage: [2, 3]`; none if it is not given.
  std::optional<std::vector<int>> Stages(MapReader& map, const std::vector<int>& possible) {
    const InputNode* node = map.Optional("stage");
    if (node == nullptr) return std::nullopt;
    const std::string allowed = possible.empty() ? "no stage of this vehicle"
                                : possible.size() == 1
                                    ? std::to_string(possible[0])
                                    : "one of " + std::to_string(possible.front()) + " to " +
                                          std::to_string(possible.back()) + ", or a list of them";
    std::vector<int> stages;
    const auto read = [&](const InputNode& item, const std::string& path) {
      SayExpects(path, {.kind = Expectation::Kind::kInteger, .low = "1", .high = std::to_string(kMaxStages)});
      const bool plain = item.kind == InputNode::Kind::kScalar && !item.quoted;
      const double number = plain ? ParseNumber(item.text).value_or(0.0) : 0.0;
      const auto found = std::find(possible.begin(), possible.end(), number);
      if (found == possible.end()) {
        AddProblem(problems_, item, path, item.Describe() + " is no stage that this disperses", allowed);
      } else if (std::find(stages.begin(), stages.end(), *found) != stages.end()) {
        AddProblem(problems_, item, path, "stage " + item.text + " is given twice", "each stage once");
      } else {
        stages.push_back(*found);
      }
    };
    if (node->kind != InputNode::Kind::kList) {
      read(*node, map.PathOf("stage"));
      return stages;
    }
    if (node->items.empty()) AddProblem(problems_, *node, map.PathOf("stage"), "the list is empty", allowed);
    for (std::size_t i = 0; i < node->items.size(); ++i)
      read(node->items[i], map.PathOf("stage") + "[" + std::to_string(i) + "]");
    std::sort(stages.begin(), stages.end());
    return stages;
  }

  static Per PerWhat(MapReader& map, bool nozzles) {
    if (!nozzles) return map.Choice<Per>("per", {{"stage", Per::kStage}, {"vehicle", Per::kVehicle}});
    return map.Choice<Per>("per",
                           {{"stage", Per::kStage}, {"vehicle", Per::kVehicle}, {"nozzle", Per::kNozzle}});
  }

  // One draw a stage, or one for all of them, as `per` says. A draw for some of the stages has their numbers
  // in its name: of two of a list each is a draw of its own.
  void AddStages(const std::string& name, const Selection& of, const ScalarDistribution& distribution,
                 const std::vector<StageColumn>& columns, bool absolute = false) {
    std::vector<int> all;
    std::string numbers;
    for (const int stage : of.stages) {
      std::vector<int> inputs;
      for (const StageColumn& column : columns) inputs.push_back(column.Of(stage));
      all.insert(all.end(), inputs.begin(), inputs.end());
      numbers += "_" + std::to_string(stage);
      if (of.per == Per::kStage)
        Add(name + "/" + StageName(stage), distribution, std::move(inputs), absolute);
    }
    if (of.per == Per::kVehicle && !all.empty())
      Add(of.all ? name : name + "/stages" + numbers, distribution, std::move(all), absolute);
  }

  // One draw a nozzle.
  void AddNozzles(const std::string& name, const Selection& of, const ScalarDistribution& distribution,
                  const StageColumn& column, bool absolute = false) {
    for (const int stage : of.stages) {
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
    const std::vector<Stage>& stages = vehicle_.stages;
    if (static_cast<std::size_t>(stage) > stages.size()) return names;
    const std::vector<Nozzle>& list = stages[static_cast<std::size_t>(stage) - 1].gimbal.nozzles;
    if (list.empty()) return names;
    names.clear();
    for (const Nozzle& nozzle : list) names.push_back(nozzle.name);
    return names;
  }

  // A departure from the axis: a magnitude and the direction of it around the axis, or its two components.
  // `of_nozzle`: the stem of a nozzle's own columns, if it has.
  void Lateral(const std::string& key, const DispersedScalar& scalar, const std::string& unit_suffix,
               const std::string& stem, const std::string& of_nozzle = "") {
    EachOfStages(key, AllStages(), [&](MapReader& map, Selection of) {
      const ScalarDistribution distribution = ReadDistribution(map, scalar);
      const bool by_axis = map.Choice<bool>("draw", {{"magnitude", false}, {"per_axis", true}}, false);
      ScalarDistribution direction;
      if (!by_axis) {
        direction = ReadDirection(map.Required("clock_angle", "uniform, {fixed_deg: x} or a distribution"),
                                  map.PathOf("clock_angle"), problems_);
      } else if (const InputNode* clock = map.Optional("clock_angle")) {
        AddProblem(problems_, *clock, map.PathOf("clock_angle"), "components have no direction besides",
                   "draw: magnitude with clock_angle");
      }
      of.per = PerWhat(map, !of_nozzle.empty());
      const auto add = [&](const std::string& name, const std::string& part, const ScalarDistribution& drawn,
                           const std::string& suffix, bool absolute) {
        if (of.per == Per::kNozzle)
          AddNozzles(name, of, drawn, {of_nozzle + part, suffix}, absolute);
        else
          AddStages(name, of, drawn, {{stem + part, suffix}}, absolute);
      };
      if (by_axis) {
        add(key + "/y", "_y", distribution, unit_suffix, false);
        add(key + "/z", "_z", distribution, unit_suffix, false);
        return;
      }
      add(key, "", distribution, unit_suffix, true);
      add(key + "/clock", "_clock", direction, "_deg", false);
    });
  }

  void Thrust() {
    EachOfStages("thrust", AllStages(), [&](MapReader& map, Selection of) {
      const ScalarDistribution distribution = ReadDistribution(map, kPositiveFactor);
      const bool flow_follows =
          map.Choice<bool>("conserve", {{"total_impulse", true}, {"propellant", false}});
      std::vector<StageColumn> columns = {{"thrust_factor", ""}};
      if (flow_follows) columns.push_back({"mass_flow_factor", ""});
      of.per = PerWhat(map, true);
      if (of.per != Per::kNozzle) {
        AddStages("thrust", of, distribution, columns);
        return;
      }
      if (flow_follows)
        AddProblem(problems_, map.node(), map.PathOf("conserve"),
                   "the flow is the whole motor's, not a nozzle's", "conserve: propellant with per: nozzle");
      AddNozzles("thrust", of, distribution, {"nozzle_thrust_factor", ""});
    });
  }

  void StageFactor(const std::string& key, const std::vector<StageColumn>& columns) {
    EachOfStages(key, AllStages(), [&](MapReader& map, Selection of) {
      const ScalarDistribution distribution = ReadDistribution(map, kPositiveFactor);
      of.per = PerWhat(map, false);
      AddStages(key, of, distribution, columns);
    });
  }

  // The whole vehicle's, unless stages or `per: stage` are named.
  void VehicleOrStageFactor(const std::string& key, const std::string& column) {
    EachOfStages(key, AllStages(), [&](MapReader& map, Selection of) {
      const ScalarDistribution distribution = ReadDistribution(map, kPositiveFactor);
      const bool listed = map.node().Find("stage") != nullptr;
      of.per = map.Choice<Per>("per", {{"stage", Per::kStage}, {"vehicle", Per::kVehicle}},
                               listed ? Per::kStage : Per::kVehicle);
      if (of.per == Per::kVehicle && of.all)
        Add(key, distribution, {Column(column)});
      else
        AddStages(key, of, distribution, {{column, ""}});
    });
  }

  // ---- masses ----

  const Stage* StageAt(int stage) const {
    const auto i = static_cast<std::size_t>(stage) - 1;
    return is_sound_ && i < vehicle_.stages.size() ? &vehicle_.stages[i] : nullptr;
  }

  // At most what the grain's case holds.
  void PropellantLoad() {
    EachOfStages("propellant_load", AllStages(), [&](MapReader& map, Selection of) {
      double most = std::numeric_limits<double>::infinity();
      for (const int stage : of.stages)
        if (const Stage* s = StageAt(stage)) most = std::min(most, LargestPropellantFactor(*s));
      const ScalarDistribution distribution = ReadDistribution(map, {{}, Inside(0.0, most)});
      of.per = PerWhat(map, false);
      AddStages("propellant_load", of, distribution, {{"propellant_factor", ""}});
    });
  }

  // So many kilograms more than nominal, of one element of the last stage, which cannot weigh less than
  // nothing.
  void PayloadMass() {
    const InputNode* node = map_.Optional("payload_mass");
    if (node == nullptr) return;
    MapReader map(*node, map_.PathOf("payload_mass"), problems_);
    const std::string name = map.Text("element");
    double element_kg = std::numeric_limits<double>::infinity();
    std::size_t position = 0;
    if (is_sound_ && !vehicle_.stages.empty() && !name.empty()) {
      const std::vector<MassElement>& structure = vehicle_.stages.back().structure;
      std::vector<std::string> names;
      for (const MassElement& element : structure) names.push_back(element.name);
      position = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
      if (position == names.size()) {
        AddProblem(problems_, *node->Find("element"), map.PathOf("element"),
                   "'" + name + "' is no element of the last stage's structure" + DidYouMean(name, names),
                   "one of " + JoinWords(names));
      } else {
        element_kg =
            structure[position].fraction * DryMass(vehicle_, static_cast<int>(vehicle_.stages.size()) - 1);
      }
    }
    Add("payload_mass",
        ReadDistribution(map, {kMass, {-element_kg, std::numeric_limits<double>::infinity(), true, false}}),
        {Column("payload_mass_kg")});
    Add("payload_mass/element", Constant(static_cast<double>(position + 1)), {Column("payload_element")});
  }

  // Half the least moment of inertia at most: with three such products the tensor is still one of a body.
  void ProductsOfInertia() {
    const InputNode* node = map_.Optional("product_of_inertia");
    if (node == nullptr) return;
    MapReader parent(*node, map_.PathOf("product_of_inertia"), problems_);
    bool any = false;
    for (const std::string plane : {"xy", "xz", "yz"}) {
      any = any || node->Find(plane) != nullptr;
      EachOfStages(parent, plane, AllStages(), [&](MapReader& map, Selection of) {
        double most = std::numeric_limits<double>::infinity();
        for (const int stage : of.stages)
          if (StageAt(stage) != nullptr) most = std::min(most, 0.5 * LeastInertia(stage));
        const ScalarDistribution distribution = ReadDistribution(map, {kInertia, Between(-most, most)});
        of.per = PerWhat(map, false);
        AddStages("product_of_inertia/" + plane, of, distribution,
                  {{"product_of_inertia_" + plane, "_kg_m2"}});
      });
    }
    if (!any && node->members.empty())
      AddProblem(problems_, *node, parent.path(), "no product is given", "one or more of xy, xz, yz");
  }
  // Of the stack without what it burns and what may leave it, about either axis.
  double LeastInertia(int stage) const {
    StackMass left = Without(BuildStackMasses(vehicle_)[static_cast<std::size_t>(stage) - 1], stage - 1,
                             BuildJettisonedMasses(vehicle_), ~0u);
    if (stage == 1 && vehicle_.boosters.count > 0) left = Without(left, 0, {BuildBoosterMass(vehicle_.boosters)}, 1u);
    const MassProperties empty = left.At(0.0);
    return std::min(empty.axial_inertia_kg_m2, empty.transverse_inertia_kg_m2);
  }

  // ---- sequence and lift-off ----

  // By how much less than nominal a stage may be late: nothing happens before what triggers it.
  double LeastIgnitionDelay(const Stage& stage) const {
    return stage.ignition == IgnitionTrigger::kBurnoutDetection ? -stage.ignition_delay_s
                                                                : -std::numeric_limits<double>::infinity();
  }
  double LeastSeparationDelay(const Stage& stage) const { return -stage.separation_delay_s; }

  void Delay(const std::string& key, int first, int last,
             double (DispersionDecoder::*least)(const Stage&) const) {
    const InputNode* node = map_.Optional(key);
    if (node == nullptr) return;
    if (first > last) {
      map_.Ignore(key);
      AddProblem(problems_, *node, map_.PathOf(key), "the vehicle has one stage", "a vehicle of two or more");
      return;
    }
    EachOfStages(key, StagesBetween(first, last), [&](MapReader& map, Selection of) {
      double from_s = -std::numeric_limits<double>::infinity();
      for (const int stage : of.stages)
        if (const Stage* s = StageAt(stage)) from_s = std::max(from_s, (this->*least)(*s));
      const ScalarDistribution distribution =
          ReadDistribution(map, {kTime, {from_s, std::numeric_limits<double>::infinity(), false, false}});
      of.per = PerWhat(map, false);
      AddStages(key, of, distribution, {{key, "_s"}});
    });
  }

  void InitialAttitude() {
    EachAxis("initial_attitude_error", [this](const std::string& axis, MapReader& map) {
      Add("initial_attitude_error/" + axis, ReadDistribution(map, {kAngle, kAnyNumber}),
          {Column("initial_" + axis + "_error_deg")});
    });
  }

  // A grain burns the faster the warmer it is: at constant burning surface pressure, thrust and flow grow as
  // exp(pi_K dT), and the total impulse stays (Sutton and Biblarz, Rocket Propulsion Elements, 7th ed., sect. 11.1).
  void PropellantTemperature() {
    EachOfStages("propellant_temperature", AllStages(), [&](MapReader& map, Selection of) {
      const std::size_t before = problems_.size();
      ScalarDistribution rate = ReadDistribution(map, {kTemperatureDifference, Between(-200.0, 200.0)});
      const double sensitivity_1_k = map.Quantity("sensitivity", kPerTemperature, {0.0, 0.02, true, false});
      of.per = PerWhat(map, false);
      for (const int stage : of.stages)
        if (const Stage* s = StageAt(stage); s != nullptr && s->is_liquid())
          AddProblem(problems_, map.node(), map.path(), "stage " + std::to_string(stage) + " is liquid",
                     "stage: those with solid motors");
      if (problems_.size() > before) return;
      const auto rate_at = [&](double warmer_k) { return Exp(sensitivity_1_k * warmer_k); };
      switch (rate.kind) {
        case Distribution::kNormal:  // of the temperature, hence lognormal of the rate
          rate.kind = Distribution::kLogNormal;
          rate.sigma *= sensitivity_1_k;
          break;
        case Distribution::kConstant:
        case Distribution::kTwoPoint:
        case Distribution::kValues:
          rate.low = rate_at(rate.low);
          rate.high = rate_at(rate.high);
          for (double& value : rate.values) value = rate_at(value);
          break;
        default:
          AddProblem(problems_, *map.node().Find("distribution"), map.PathOf("distribution"),
                     "'" + map.node().Find("distribution")->text + "' is not among those of a temperature",
                     "normal, two_point, values or constant");
          return;
      }
      rate.nominal = rate_at(rate.nominal);
      AddStages("propellant_temperature", of, rate, {{"thrust_factor", ""}, {"mass_flow_factor", ""}});
    });
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
    const InputNode* drawn = map.Peek(stem);
    ScalarDistribution distribution;
    if (drawn != nullptr && drawn->kind == InputNode::Kind::kMap) {
      map.Allow(stem);
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
    const bool named = map.Peek("severity") != nullptr || map.Peek("exceedance") == nullptr;
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
    if (table == nullptr && statistics == nullptr) map.NoteMissing({"table", "statistics"});
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
    for (const std::string axis : kAxisNames) {
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

  // The last stage does not separate.
  void TipOff() {
    const InputNode* node = map_.Optional("tip_off_rate");
    if (node == nullptr) return;
    MapReader parent(*node, map_.PathOf("tip_off_rate"), problems_);
    bool any = false;
    for (const std::string axis : kAxisNames) {
      any = any || node->Find(axis) != nullptr;
      EachOfStages(parent, axis, StagesBetween(1, stages_ - 1), [&](MapReader& map, Selection of) {
        AddStages("tip_off_rate/" + axis, of, ReadDistribution(map, {kAngularRate, kAnyNumber}),
                  {{"tip_off_" + axis, "_deg_s"}});
      });
    }
    if (!any && node->members.empty())
      AddProblem(problems_, *node, parent.path(), "no axis is given", "one or more of roll, pitch, yaw");
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
    SayExpects(map.PathOf("nozzle"),
               {.kind = Expectation::Kind::kWords, .open = true});  // a vehicle names its own
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
  const Vehicle& vehicle_;  ///< without stages if it is unknown
  const bool is_sound_;     ///< else nothing is checked against it
  int stages_;
  Campaign& campaign_;
  ProblemList& problems_;
};

}  // namespace

void DecodeDispersions(const InputNode& node, const std::string& path, Campaign& campaign,
                       std::vector<InputProblem>& problems) {
  DispersionDecoder(node, path, campaign, problems).Decode();
}

}  // namespace dispersa
