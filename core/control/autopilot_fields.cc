#include "core/control/autopilot_fields.h"

#include <array>

#include "core/math/stages.h"

namespace dispersa {
namespace {

// What is declared to a visitor, declared to Fields.
class AxisFields {
 public:
  explicit AxisFields(Fields& fields) : fields_(fields) {}

  void Quantity(const char* stem, Dimension dimension, const Range& range, double& value,
                const char* meaning) {
    fields_.Quantity(stem, dimension, range, value, meaning);
  }
  void Guard(const char* stem, Dimension dimension, const Range& range, double& value, const char* meaning) {
    fields_.Quantity(stem, dimension, range, value, meaning, 0.0);
  }
  void Number(const char* key, const Range& range, double& value, const char* meaning) {
    fields_.Number(key, range, value, meaning);
  }
  void NumberGuard(const char* key, const Range& range, double& value, const char* meaning) {
    fields_.Number(key, range, value, meaning, 0.0);
  }
  void Flag(const char* key, bool& value, const char* meaning) { fields_.Flag(key, value, false, meaning); }
  void EachStage(const char* key, const Range& range, std::vector<double>& values, const char* meaning) {
    fields_.Numbers(key, range, 1, kMaxStages, values, meaning);
  }
  void Stage(const char* key, int& stage, const char* meaning) {
    fields_.Integer(key, 1, kMaxStages, stage, meaning, 0);
  }
  void Sections(const char* key, std::vector<FilterSection>& sections, const char* meaning) {
    fields_.List(key, 0, kFilterSections, sections, meaning, [](Fields& fields, FilterSection& section) {
      AxisFields visitor(fields);
      VisitSection(visitor, section);
    });
  }
  void OfOtherLaws(const char* key, const char* meaning) {
    std::optional<double> ignored;
    fields_.OptionalNumber(key, kNonNegative, ignored, meaning);
  }
  void Matrix(const char* key, Matrix2& value, const char* meaning) {
    std::array<std::array<double, 2>, 2> rows{};
    fields_.TwoByTwo(key, rows, "[[q11, q12], [q12, q22]]", meaning);
    value << rows[0][0], rows[0][1], rows[1][0], rows[1][1];
  }
  void OptionalPair(const char* key, std::optional<Vector2>& value, const char* meaning) {
    std::vector<double> pair;
    fields_.OptionalNumbers(key, kAnyNumber, 2, 2, pair, meaning);
    if (pair.size() == 2) value = Vector2(pair[0], pair[1]);
  }

 private:
  Fields& fields_;
};

// What a schedule's next entry has if it names no filters: those of the entry before, else the stage's own.
std::vector<FilterSection> FiltersBefore(const AxisConfig& axis, std::size_t entry) {
  const int stage = axis.schedule[entry].stage;
  if (entry > 0 && axis.schedule[entry - 1].stage == stage) return axis.schedule[entry - 1].filters;
  std::vector<FilterSection> own;
  for (const std::size_t i : FiltersOfStage(axis, stage)) own.push_back(axis.filters[i]);
  return own;
}

void DescribeEntry(Fields& fields, AxisConfig& axis, ScheduleEntry& entry) {
  bool has_filters = false;
  fields.When(HasList("filters"), [&] { has_filters = true; });
  AxisFields visitor(fields);
  VisitScheduleEntry(visitor, InfoOf(axis.law), entry);
  if (!has_filters)
    entry.filters = FiltersBefore(axis, static_cast<std::size_t>(&entry - axis.schedule.data()));
}

// The blocks that a law reads must be there; others may be (the same file with another law is a comparison).
void DescribeBlocks(Fields& fields, AxisConfig& axis) {
  EachBlock(axis, [&](const char* key, bool LawInfo::*needs, auto visit, const char* meaning) {
    std::vector<std::string> laws;
    for (const LawInfo& law : kLaws)
      if (law.*needs) laws.emplace_back(law.name);
    const auto describe = [&] {
      bool is_there = false;
      fields.OptionalMap(key, is_there, meaning, [&](Fields& block) {
        AxisFields visitor(block);
        visit(visitor);
      });
    };
    fields.Either({{Has(key), describe},
                   {Is("law", laws), [&] { fields.Missing({key}, "a map, which this law needs"); }}});
  });
}

void Describe(Fields& fields, AxisConfig& axis) {
  std::vector<std::pair<std::string, ControlLaw>> laws;
  for (const LawInfo& law : kLaws) laws.emplace_back(law.name, law.law);
  fields.Choice<ControlLaw>("law", laws, axis.law, "of the axis");
  fields.List("gains", 1, kMaxStages, axis.gains, "one a stage", [](Fields& map, AxisGains& gains) {
    AxisFields visitor(map);
    VisitGains(visitor, gains);
  });
  fields.List("filters", 0, kFilterSections, axis.filters, "in series, behind the law",
              [](Fields& map, FilterSection& section) {
                AxisFields visitor(map);
                VisitFilter(visitor, section);
              });
  fields.List("schedule", 0, SIZE_MAX, axis.schedule, "what the law holds at times within a stage's burn",
              [&axis](Fields& map, ScheduleEntry& entry) { DescribeEntry(map, axis, entry); });
  bool feeds_forward = false;
  fields.OptionalMap("feed_forward", feeds_forward, "the program's own angular acceleration, behind the law",
                     [&](Fields& map) {
                       AxisFields visitor(map);
                       VisitFeedForward(visitor, axis.feed_forward.emplace());
                     });
  DescribeBlocks(fields, axis);
}

void Describe(Fields& fields, ReactionControlLogic& logic) {
  fields.Quantity("deadband", kAngle, kPositive, logic.deadband_rad, "no firing within");
  fields.Quantity("rate_gain", kTime, kNonNegative, logic.rate_gain_s,
                  "of the switching line e + rate_gain de/dt");
  fields.Integer("cycle_ticks", 1, 100, logic.cycle_ticks,
                 "between decisions: thrusters open for whole cycles");
  fields.Number("hysteresis", {0.0, 1.0, false, true}, logic.hysteresis,
                "fraction of the deadband by which a firing overshoots into it");
}

void Describe(Fields& fields, GyroShare& share) {
  fields.Text("gyro", share.gyro, "of the vehicle's sensors");
  fields.Number("weight", Between(-10.0, 10.0), share.weight, "of what it measures", 1.0);
  fields.Integer("stage", 0, kMaxStages, share.stage, "in whose burn it counts; 0: in all", 0);
}

// The library is asked which parameters it has.
void DescribePlugin(Fields& fields) {
  std::string text;
  const auto digest = [&text](Fields& map, const char* of) { map.Text("sha256", text, of); };
  fields.Either({{Has("python"),
                  [&] {
                    fields.Map("python", "a law in Python, of a campaign that was flown under it",
                               [&](Fields& law) {
                                 law.Text("name", text, "of the law");
                                 digest(law, "of its source");
                               });
                  }},
                 {Else(), [&] {
                    fields.Table("library", "the file name of a shared object",
                                 "a shared object, or its bytes", [&](Fields& library) {
                                   digest(library, "of the bytes");
                                   library.Text("base64", text, "the bytes");
                                 });
                    fields.AnyNumbers("parameters", "a number for each parameter that the law names");
                  }}});
}

}  // namespace

void Describe(Fields& fields, AutopilotConfig& autopilot, const Fields::ReadNode& plugin) {
  fields.Text("name", autopilot.name, "of the autopilot");
  fields.Quantity("tick", kTime, Between(1e-4, 0.1), autopilot.tick_s, "between two commands");
  fields.Map("pitch", "axis", [&](Fields& axis) { Describe(axis, autopilot.pitch); });
  fields.Map("yaw", "axis", [&](Fields& axis) { Describe(axis, autopilot.yaw); });
  fields.Map("roll", "axis", [&](Fields& axis) { Describe(axis, autopilot.roll); });
  fields.List("rate_gyros", 0, SIZE_MAX, autopilot.rate_gyros,
              "whose measurements are the rates; without, the inertial unit's",
              [](Fields& share, GyroShare& gyro) { Describe(share, gyro); });
  fields.MapByHand("plugin", "a control law of your own", DescribePlugin, plugin);
  fields.Map("reaction_control", "in unpowered flight",
             [&](Fields& logic) { Describe(logic, autopilot.reaction_control); });
}

}  // namespace dispersa
