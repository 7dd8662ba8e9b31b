#include "core/input/field_writer.h"

#include <algorithm>
#include <utility>

#include "core/input/number_text.h"
#include "core/input/yaml_text.h"

namespace dispersa {
namespace {

std::string Bracketed(char open, const std::vector<std::string>& items, char close) {
  std::string text(1, open);
  for (std::size_t i = 0; i < items.size(); ++i) text += (i == 0 ? "" : ", ") + items[i];
  return text + close;
}

// The keys of a map; those of a map on one line have no lines of their own.
class FieldWriter : public Fields {
 public:
  explicit FieldWriter(const FileLayout& layout, bool on_one_line) : layout_(layout), flows_(on_one_line) {}

  /// In lines, each with this before it; or {…}.
  std::string Written(const std::string& indent) const {
    if (flows_) return Bracketed('{', lines_, '}');
    std::string text;
    for (const std::string& line : lines_) {
      text += indent;
      for (const char c : line) text += c == '\n' ? "\n" + indent : std::string(1, c);
      text += '\n';
    }
    return text;
  }

  void File(const char* schema, const BaseKeys*) override { Add("schema", schema); }
  void Flag(const char* key, bool& value, bool absent, const char*) override {
    if (value != absent || IsAlways(key)) Add(key, value ? "true" : "false");
  }
  void OneOf(const std::vector<OneQuantity>& quantities, std::size_t& which, double& value) override {
    const OneQuantity& one = quantities[which];
    Quantity(one.stem, one.dimension, one.range, value, one.meaning);
  }
  void Either(const std::vector<Alternative>& alternatives) override {
    for (const Alternative& alternative : alternatives)
      if (alternative.is_so || alternative.condition.key.empty()) return alternative.describe();
  }

 protected:
  void VisitText(const TextKey& key, std::string& value) override {
    if (value != key.absent || IsAlways(key.name))
      Add(key.name, key.words.empty() && key.name_of == nullptr ? Scalar(value) : value);
  }
  void VisitTexts(const TextKey& key, std::size_t, std::size_t, std::vector<std::string>& values) override {
    std::vector<std::string> texts;
    for (const std::string& value : values) texts.push_back(key.words.empty() ? Scalar(value) : value);
    if (!texts.empty()) Add(key.name, Bracketed('[', texts, ']'));
  }
  void VisitWhole(const WholeKey& key, std::vector<std::uint64_t>& values) override {
    std::vector<std::string> texts;
    for (const std::uint64_t value : values) texts.push_back(std::to_string(value));
    if (key.noun == nullptr && (values.front() != key.absent || IsAlways(key.name)))
      Add(key.name, texts.front());
    else if (key.noun != nullptr && !texts.empty())
      Add(key.name, Bracketed('[', texts, ']'));
  }
  void VisitNumber(const NumberKey& key, std::optional<double>& value) override {
    if (!value || (value == key.absent && !IsAlways(key.name))) return;
    const Unit unit = UnitOf(key.dimension);
    Add(KeyIn(key.name, unit), NumberIn(*value, unit));
  }
  void VisitNumbers(const NumbersKey& key, std::vector<double>& values) override {
    if (values.empty()) return;
    const Unit unit = UnitOf(key.dimension);
    std::vector<std::string> texts;
    for (const double value : values) texts.push_back(NumberIn(value, unit));
    Add(KeyIn(key.name, unit), Bracketed('[', texts, ']'));
  }
  void VisitRows(const RowsKey& key, std::vector<std::vector<double>>& rows) override {
    std::vector<std::string> names, texts;
    for (const RowsKey::Column& column : key.columns) names.emplace_back(column.name);
    for (const std::vector<double>& row : rows) {
      std::vector<std::string> numbers;
      for (std::size_t c = 0; c < row.size(); ++c)
        numbers.push_back(FormatScaled(row[c], names.empty() ? 1.0 : key.columns[c].scale));
      texts.push_back(Bracketed('[', numbers, ']'));
    }
    if (!names.empty()) Add("columns", Bracketed('[', names, ']'));
    if (names.empty())
      Add(key.name, Bracketed('[', texts, ']'));
    else
      AddItems(key.name, texts);
  }
  void VisitNode(const NodeKey&, const ReadNode&) override {}
  void VisitMap(const MapKey& key, MapValue& value, const Part& part) override {
    if (!value.is_there) return;
    FieldWriter map(layout_, flows_ || Contains(layout_.on_one_line, key.name));
    part(map);
    if (map.flows_)
      Add(key.name, map.Written(""));
    else
      lines_.push_back(std::string(key.name) + ":\n" + WithoutEnd(map.Written("  ")));
  }
  void VisitMaps(const Key& key, std::size_t, std::size_t, const Items& items) override {
    if (items.count == 0 && !IsAlways(key.name)) return;
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < items.count; ++i) {
      FieldWriter item(layout_, true);
      items.describe(item, i);
      texts.push_back(item.Written(""));
    }
    AddItems(key.name, texts);
  }

 private:
  static bool Contains(const std::vector<std::string>& keys, const char* key) {
    return std::find(keys.begin(), keys.end(), key) != keys.end();
  }
  bool IsAlways(const char* key) const { return Contains(layout_.always, key); }
  static std::string WithoutEnd(std::string lines) {
    if (!lines.empty()) lines.pop_back();
    return lines;
  }
  void Add(const std::string& key, const std::string& value) { lines_.push_back(key + ": " + value); }
  // An item a line.
  void AddItems(const std::string& key, const std::vector<std::string>& items) {
    if (flows_ || items.empty()) return Add(key, Bracketed('[', items, ']'));
    std::string text = key + ":";
    for (const std::string& item : items) text += "\n  - " + item;
    lines_.push_back(std::move(text));
  }

  std::string Scalar(const std::string& text) const {
    return layout_.quotes_all_texts ? SingleQuoted(text) : TextScalar(text);
  }
  Unit UnitOf(Dimension dimension) const {
    if (dimension.empty()) return kNoUnit;
    for (const Unit& unit : dimension)
      if (dimension.data() == std::begin(kLength) && unit.suffix == layout_.length_unit) return unit;
    return dimension.front();
  }
  static std::string KeyIn(const std::string& stem, const Unit& unit) {
    return unit.suffix.empty() ? stem : stem + "_" + std::string(unit.suffix);
  }
  static std::string NumberIn(double value, const Unit& unit) {
    return unit.scale == 1.0 ? FormatNumber(value) : FormatScaled(value, unit.scale);
  }

  const FileLayout& layout_;
  const bool flows_;
  std::vector<std::string> lines_;
};

}  // namespace

std::string WriteFields(const FileLayout& layout, const Fields::Part& describe) {
  FieldWriter writer(layout, false);
  describe(writer);
  return writer.Written("");
}

}  // namespace dispersa
