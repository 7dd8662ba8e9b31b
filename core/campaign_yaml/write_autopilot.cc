#include "core/campaign_yaml/canonical.h"
#include "core/campaign_yaml/inline_files.h"
#include "core/campaign_yaml/load.h"
#include "core/control/autopilot_fields.h"
#include "core/input/number_text.h"
#include "core/math/constants.h"

namespace dispersa {
namespace {

std::string Row(double a, double b) { return "[" + FormatNumber(a) + ", " + FormatNumber(b) + "]"; }

// Texts "key: value" of what it visits, quantities in the first unit of their dimension. What is off is left
// out.
class FieldWriter {
 public:
  std::vector<std::string> texts;
  bool has_lists = false;

  void Quantity(const char* stem, Dimension dimension, const Range&, double value, const char*) {
    const Unit& unit = dimension.front();
    Add(std::string(stem) + "_" + std::string(unit.suffix),
        unit.scale == 1.0 ? FormatNumber(value) : FormatScaled(value, unit.scale));
  }
  void Guard(const char* stem, Dimension dimension, const Range& range, double value, const char* meaning) {
    if (value != 0.0) Quantity(stem, dimension, range, value, meaning);
  }
  void Number(const char* key, const Range&, double value, const char*) { Add(key, FormatNumber(value)); }
  void NumberGuard(const char* key, const Range& range, double value, const char* meaning) {
    if (value != 0.0) Number(key, range, value, meaning);
  }
  void Flag(const char* key, bool value, const char*) {
    if (value) Add(key, "true");
  }
  void EachStage(const char* key, const Range&, const std::vector<double>& values, const char*) {
    std::string list;
    for (const double value : values) list += (list.empty() ? "[" : ", ") + FormatNumber(value);
    Add(key, list + "]");
    has_lists = true;
  }
  void Stage(const char* key, int stage, const char*) {
    if (stage != 0) Add(key, std::to_string(stage));
  }
  void Sections(const char* key, const std::vector<FilterSection>& sections, const char*);
  void OfOtherLaws(const char*, const char*) {}
  void Matrix(const char* key, const Matrix2& value, const char*) {
    Add(key, "[" + Row(value(0, 0), value(0, 1)) + ", " + Row(value(1, 0), value(1, 1)) + "]");
  }
  void OptionalPair(const char* key, const std::optional<Vector2>& value, const char*) {
    if (value) Add(key, Row(value->x(), value->y()));
  }

 private:
  void Add(const std::string& key, const std::string& value) { texts.push_back(key + ": " + value); }
};

std::string OnOneLine(const std::vector<std::string>& texts) {
  std::string line;
  for (const std::string& text : texts) line += (line.empty() ? "{" : ", ") + text;
  return line + "}";
}

void FieldWriter::Sections(const char* key, const std::vector<FilterSection>& sections, const char*) {
  std::string list;
  for (const FilterSection& section : sections) {
    FieldWriter fields;
    VisitSection(fields, section);
    list += (list.empty() ? "[" : ", ") + OnOneLine(fields.texts);
  }
  if (!list.empty()) Add(key, list + "]");
}

std::string AxisText(const char* name, const AxisConfig& axis) {
  std::string text = std::string(name) + ":\n  law: " + InfoOf(axis.law).name + "\n  gains:\n";
  for (const AxisGains& gains : axis.gains) {
    FieldWriter fields;
    VisitGains(fields, gains);
    text += "    - " + OnOneLine(fields.texts) + "\n";
  }
  if (!axis.filters.empty()) text += "  filters:\n";
  for (const FilterSection& section : axis.filters) {
    FieldWriter fields;
    VisitFilter(fields, section);
    text += "    - " + OnOneLine(fields.texts) + "\n";
  }
  if (!axis.schedule.empty()) text += "  schedule:\n";
  for (const ScheduleEntry& entry : axis.schedule) {
    FieldWriter fields;
    VisitScheduleEntry(fields, InfoOf(axis.law), entry);
    text += "    - " + OnOneLine(fields.texts) + "\n";
  }
  if (axis.feed_forward) {
    FieldWriter fields;
    VisitFeedForward(fields, *axis.feed_forward);
    text += "  feed_forward: " + OnOneLine(fields.texts) + "\n";
  }
  EachBlock(axis, [&](const char* key, bool LawInfo::*needs, auto visit, const char*) {
    if (!(InfoOf(axis.law).*needs)) return;
    FieldWriter fields;
    visit(fields);
    text += "  " + std::string(key) + ":";
    if (fields.texts.size() <= 2 && !fields.has_lists) {
      text += " " + OnOneLine(fields.texts) + "\n";
      return;
    }
    text += "\n";
    for (const std::string& field : fields.texts) text += "    " + field + "\n";
  });
  return text;
}

std::string GyrosText(const std::vector<GyroShare>& shares) {
  std::string text;
  for (const GyroShare& share : shares) {
    text += (text.empty() ? "rate_gyros:\n" : "") + std::string("  - {gyro: ") + TextScalar(share.gyro) +
            ", weight: " + FormatNumber(share.weight);
    if (share.stage != 0) text += ", stage: " + std::to_string(share.stage);
    text += "}\n";
  }
  return text;
}

}  // namespace

std::string WriteAutopilot(const AutopilotConfig& autopilot) {
  const ReactionControlLogic& rcs = autopilot.reaction_control;
  return std::string("schema: ") + kAutopilotSchema + "\nname: " + TextScalar(autopilot.name) +
         "\ntick_s: " + FormatNumber(autopilot.tick_s) + "\n" + AxisText("pitch", autopilot.pitch) +
         AxisText("yaw", autopilot.yaw) + AxisText("roll", autopilot.roll) + GyrosText(autopilot.rate_gyros) +
         "reaction_control: {deadband_deg: " + FormatDegrees(rcs.deadband_rad) +
         ", rate_gain_s: " + FormatNumber(rcs.rate_gain_s) + ", hysteresis: " + FormatNumber(rcs.hysteresis) +
         ", cycle_ticks: " + std::to_string(rcs.cycle_ticks) + "}\n";
}

}  // namespace dispersa
