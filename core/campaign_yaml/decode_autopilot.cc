#include "core/campaign_yaml/autopilot_fields.h"
#include "core/campaign_yaml/decode.h"
#include "core/campaign_yaml/inline_files.h"
#include "core/input/struct_problems.h"
#include "core/input/map_reader.h"

namespace dispersa {
namespace {

using ProblemList = std::vector<InputProblem>;

// Reads what it visits from a map.
class FieldReader {
 public:
  FieldReader(const InputNode& node, std::string path, ProblemList& problems)
      : map_(node, std::move(path), problems) {}

  void Quantity(const char* stem, Dimension dimension, const Range& range, double& value) {
    value = map_.Quantity(stem, dimension, range);
  }
  void Guard(const char* stem, Dimension dimension, const Range& range, double& value) {
    value = map_.Quantity(stem, dimension, range, 0.0);
  }
  void Number(const char* key, const Range& range, double& value) { value = map_.Number(key, range); }
  void NumberGuard(const char* key, const Range& range, double& value) {
    value = map_.Number(key, range, 0.0);
  }
  void Flag(const char* key, bool& value) { value = map_.Flag(key, false); }
  void EachStage(const char* key, const Range& range, std::vector<double>& values) {
    values = map_.Numbers(key, range, 1, kMaxStages);
  }
  void Stage(const char* key, int& stage) { stage = static_cast<int>(map_.Integer(key, 1, kMaxStages, 0)); }
  void Sections(const char* key, std::vector<FilterSection>& sections) {
    if (map_.Optional(key) == nullptr) return;
    sections.clear();
    map_.Each(key, 0, kFilterSections, [&](const InputNode& item, const std::string& item_path) {
      FieldReader fields(item, item_path, map_.problems());
      VisitSection(fields, sections.emplace_back());
    });
  }
  void OfOtherLaws(const char* key) { map_.Allow(key); }
  void Matrix(const char* key, Matrix2& value) {
    map_.Each(key, 2, 2, [&](const InputNode& row, const std::string& row_path) {
      SayExpects(row_path, {.kind = Expectation::Kind::kList, .low_count = 2, .high_count = 2});
      if (row.kind != InputNode::Kind::kList || row.items.size() != 2) {
        AddProblem(map_.problems(), row, row_path, row.Describe() + " is not a row of two numbers",
                   "[[q11, q12], [q12, q22]]");
        return;
      }
      const auto index = &row - map_.node().Find(key)->items.data();
      for (int column = 0; column < 2; ++column) {
        value(index, column) = ReadNumber(row.items[static_cast<std::size_t>(column)],
                                          row_path + "[" + std::to_string(column) + "]", map_.problems());
      }
    });
  }
  void OptionalPair(const char* key, std::optional<Vector2>& value) {
    if (map_.Optional(key) == nullptr) return;
    const std::vector<double> pair = map_.Numbers(key, kAnyNumber, 2, 2);
    if (pair.size() == 2) value = Vector2(pair[0], pair[1]);
  }

 private:
  MapReader map_;
};

// What a schedule's next entry has if it names no filters: those of the entry before, else the stage's own.
std::vector<FilterSection> FiltersBefore(const AxisConfig& axis, int stage) {
  if (!axis.schedule.empty() && axis.schedule.back().stage == stage) return axis.schedule.back().filters;
  std::vector<FilterSection> own;
  for (const std::size_t i : FiltersOfStage(axis, stage)) own.push_back(axis.filters[i]);
  return own;
}

// The blocks that a law reads must be there; others may be (the same file with another law is a comparison).
AxisConfig DecodeAxis(const InputNode& node, const std::string& path, ProblemList& problems) {
  MapReader map(node, path, problems);
  AxisConfig axis;
  std::vector<std::pair<std::string, ControlLaw>> laws;
  for (const LawInfo& law : kLaws) laws.emplace_back(law.name, law.law);
  const std::size_t before = problems.size();
  axis.law = map.Choice<ControlLaw>("law", laws);
  const bool is_law = problems.size() == before;  // else nobody knows what it needs
  map.Each("gains", 1, kMaxStages, [&](const InputNode& item, const std::string& item_path) {
    FieldReader fields(item, item_path, problems);
    VisitGains(fields, axis.gains.emplace_back());
  });
  map.Each("filters", 0, kFilterSections, [&](const InputNode& item, const std::string& item_path) {
    FieldReader fields(item, item_path, problems);
    VisitFilter(fields, axis.filters.emplace_back());
  });
  map.Each("schedule", 0, SIZE_MAX, [&](const InputNode& item, const std::string& item_path) {
    ScheduleEntry entry;
    FieldReader fields(item, item_path, problems);
    VisitScheduleEntry(fields, InfoOf(axis.law), entry);
    if (item.Find("filters") == nullptr) entry.filters = FiltersBefore(axis, entry.stage);
    axis.schedule.push_back(entry);
  });
  if (const InputNode* block = map.Optional("feed_forward")) {
    FieldReader fields(*block, map.PathOf("feed_forward"), problems);
    VisitFeedForward(fields, axis.feed_forward.emplace());
  }
  EachBlock(axis, [&](const char* key, bool needed, auto visit) {
    const InputNode* block = needed && is_law ? &map.Required(key, "a map, which this law needs") : map.Optional(key);
    if (block == nullptr) return;
    FieldReader fields(*block, map.PathOf(key), problems);
    visit(fields);
  });
  return axis;
}

ReactionControlLogic DecodeReactionControlLogic(const InputNode& node, const std::string& path,
                                           ProblemList& problems) {
  MapReader map(node, path, problems);
  ReactionControlLogic logic;
  logic.deadband_rad = map.Quantity("deadband", kAngle, kPositive);
  logic.rate_gain_s = map.Quantity("rate_gain", kTime, kNonNegative);
  logic.cycle_ticks = static_cast<int>(map.Integer("cycle_ticks", 1, 100));
  logic.hysteresis = map.Number("hysteresis", {0.0, 1.0, false, true});
  return logic;
}

}  // namespace

AutopilotConfig DecodeAutopilot(const InputNode& node, const std::string& path, int stages,
                                std::vector<InputProblem>& problems, PythonLaws laws) {
  const std::size_t before = problems.size();
  AutopilotConfig autopilot;
  if (node.file == nullptr) return autopilot;  // already reported
  if (!CheckSchema(node, kAutopilotSchema, !path.empty(), path, problems)) return autopilot;
  {
    MapReader map(node, path, problems);
    map.Allow("schema");
    autopilot.name = map.Text("name");
    autopilot.tick_s = map.Quantity("tick", kTime, {1e-4, 0.1, false, false});
    autopilot.pitch = DecodeAxis(map.Required("pitch", "a map"), map.PathOf("pitch"), problems);
    autopilot.yaw = DecodeAxis(map.Required("yaw", "a map"), map.PathOf("yaw"), problems);
    autopilot.roll = DecodeAxis(map.Required("roll", "a map"), map.PathOf("roll"), problems);
    map.Each("rate_gyros", 0, SIZE_MAX, [&](const InputNode& item, const std::string& item_path) {
      MapReader share(item, item_path, problems);
      GyroShare& gyro = autopilot.rate_gyros.emplace_back();
      gyro.gyro = share.Text("gyro");
      gyro.weight = share.Number("weight", Between(-10.0, 10.0), 1.0);
      gyro.stage = static_cast<int>(share.Integer("stage", 0, kMaxStages, 0));
    });
    if (const InputNode* plugin = map.Optional("plugin"))
      autopilot.plugin = DecodePlugin(*plugin, map.PathOf("plugin"), laws, problems);
    autopilot.reaction_control = DecodeReactionControlLogic(map.Required("reaction_control", "a map"),
                                                       map.PathOf("reaction_control"), problems);
  }
  if (stages == 0) stages = static_cast<int>(autopilot.pitch.gains.size());
  if (problems.size() == before) AddStructProblems(Problems(autopilot, stages), node, path, problems);
  return autopilot;
}

}  // namespace dispersa
